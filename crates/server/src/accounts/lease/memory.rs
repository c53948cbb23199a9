//! Leases in memory, with a clock that is set.

use std::collections::BTreeMap;
use std::time::Duration;

use super::{Lease, Leases};
use crate::accounts::StoreFailure;

/// Leases that end with the program, and whose time [passes](Self::pass) when it is told to.
///
/// ```
/// use std::time::Duration;
///
/// use cellcaster_server::accounts::{Leases, MemoryLeases};
///
/// let (mut leases, time) = (MemoryLeases::default(), Duration::from_secs(10));
/// let lease = leases.acquire("cellar", "one", time, 0)?.unwrap();
/// assert_eq!(leases.acquire("cellar", "other", time, 0)?, None);
/// leases.pass(time);
/// let next = leases.acquire("cellar", "other", time, 0)?.unwrap();
/// assert!(next.epoch() > lease.epoch());
/// assert_eq!(leases.renew(&[lease, next])?, [false, true]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct MemoryLeases {
    now: Duration,
    /// The last lease of each room.
    rooms: BTreeMap<String, Kept>,
}

#[derive(Clone, Debug)]
struct Kept {
    lease: Lease,
    is_released: bool,
    ends: Duration,
}

impl MemoryLeases {
    /// Lets time pass.
    pub fn pass(&mut self, time: Duration) {
        self.now += time;
    }

    fn own(&mut self, lease: &Lease) -> Option<&mut Kept> {
        let kept = self.rooms.get_mut(&lease.room)?;
        let is_own = kept.lease.host == lease.host && kept.lease.epoch == lease.epoch;
        (is_own && !kept.is_released).then_some(kept)
    }
}

impl Kept {
    fn is_in_force(&self, now: Duration) -> bool {
        !self.is_released && now < self.ends
    }
}

impl Leases for MemoryLeases {
    fn acquire(
        &mut self,
        room: &str,
        host: &str,
        time: Duration,
        above: u64,
    ) -> Result<Option<Lease>, StoreFailure> {
        let known = self.rooms.get(room);
        if known.is_some_and(|kept| kept.is_in_force(self.now)) {
            return Ok(None);
        }
        let epoch = known.map_or(0, |kept| kept.lease.epoch).max(above) + 1;
        let lease = Lease { room: room.to_owned(), host: host.to_owned(), epoch, time };
        let kept = Kept { lease: lease.clone(), is_released: false, ends: self.now + time };
        self.rooms.insert(room.to_owned(), kept);
        Ok(Some(lease))
    }

    fn renew(&mut self, leases: &[Lease]) -> Result<Vec<bool>, StoreFailure> {
        let now = self.now;
        let renewed =
            |lease: &Lease| self.own(lease).map(|kept| kept.ends = now + lease.time).is_some();
        Ok(leases.iter().map(renewed).collect())
    }

    fn release(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        Ok(self.own(lease).map(|kept| kept.is_released = true).is_some())
    }

    fn forget(&mut self, lease: &Lease) -> Result<bool, StoreFailure> {
        let is_own = self.own(lease).is_some();
        if is_own {
            self.rooms.remove(&lease.room);
        }
        Ok(is_own)
    }

    fn holder(&mut self, room: &str) -> Result<Option<Lease>, StoreFailure> {
        let kept = self.rooms.get(room).filter(|kept| kept.is_in_force(self.now));
        Ok(kept.map(|kept| kept.lease.clone()))
    }
}
