//! The directory of a cluster's rooms, on one of its hosts: it lists them, and starts a [`Replica`] of each that
//! somebody enters here.
//!
//! # Rules
//!
//! - Every host knows the record of every room. The number of a room is never used again. A room takes no steps
//!   until somebody enters it.
//! - A standing room is made by the first host that has it in its configuration.
//! - A record that says that the room runs, and that has not changed for [`ABANDONED`], is of a room that has lost
//!   its host. Any other host then runs the room until it is empty.

mod announcing;
mod places;
mod standing;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::{mpsc, oneshot, watch};
use tokio::time::{Instant, interval, sleep, timeout};

pub(crate) use self::places::Entrant;
use super::HostContext;
use super::bus::{BusFault, Key};
use super::record::Record;
use super::replica::{Beginning, JoinRequest, Replica, Wish};
use super::room_state::RoomState;
use crate::lock::locked;
use crate::rooms::directory::{Place, RoomLimits, RoomRefusal, Rooms};
#[cfg(test)]
use crate::rooms::room::RoomView;
use crate::rooms::room::{Header, MemberId, Mode};
use crate::rooms::sequencer::{Inbox, RoomInterface, Shown};
use crate::rooms::summary::{RoomId, RoomWish};

/// The time without a change after which the record of a running room says that its host is gone.
const ABANDONED: Duration = Duration::from_secs(15);
/// The time from one round of maintenance to the next.
const MAINTENANCE_PERIOD: Duration = Duration::from_secs(5);
/// The most join requests that wait in one room.
const MOST_JOIN_REQUESTS: usize = 64;
/// The time in which rooms are left to other hosts.
const ENDING: Duration = Duration::from_secs(2);
/// How often joining is tried if the replica ends at that moment.
const TRIES: usize = 3;

/// The rooms that a host shares. Clones are the same.
#[derive(Clone)]
pub(crate) struct SharedRooms(Arc<Inner>);

struct Inner {
    context: Arc<HostContext>,
    /// The directory of rooms that lobbies show.
    rooms: Rooms,
    standing: Mutex<Vec<RoomWish>>,
    /// The numbers of those rooms.
    own_standing: Mutex<BTreeSet<RoomId>>,
    records: Mutex<BTreeMap<RoomId, Known>>,
    /// Locked while a replica is made, so that a room has one at most.
    replicas: tokio::sync::Mutex<BTreeMap<RoomId, RoomHandle>>,
}

/// A record, and when it was received.
struct Known {
    record: Record,
    since: Instant,
}

/// The handle of a replica on this host.
#[derive(Clone)]
struct RoomHandle {
    interface: Arc<RoomInterface>,
    watchers: Arc<AtomicUsize>,
    join_requests: mpsc::Sender<JoinRequest>,
}

impl SharedRooms {
    /// Starts the directory on the current runtime.
    pub(crate) fn new(context: Arc<HostContext>, rooms: Rooms, standing: Vec<RoomWish>) -> Self {
        let (standing, records) = (Mutex::new(standing), Mutex::default());
        let shared = Self(Arc::new(Inner {
            context,
            rooms,
            standing,
            own_standing: Mutex::default(),
            records,
            replicas: tokio::sync::Mutex::default(),
        }));
        tokio::spawn(shared.clone().follow());
        tokio::spawn(shared.clone().maintain());
        tokio::spawn(shared.clone().announce());
        tokio::spawn(shared.clone().compare_maps());
        shared
    }

    /// Opens a room, and joins it.
    pub(crate) async fn open(
        &self,
        wish: &RoomWish,
        visitor: &Entrant,
    ) -> Result<Place, RoomRefusal> {
        let listed = self.0.rooms.summaries().borrow().len();
        let is_full = listed >= self.0.rooms.limits().most;
        if is_full {
            return Err(RoomRefusal::TooMany);
        }
        let context = &self.0.context;
        let header = self.header(wish).ok_or(RoomRefusal::NoLevel)?;
        let id = RoomId(context.bus.next_number().await.map_err(not_now)?);
        let record = Record::new(header, false).to_bytes();
        context.bus.create(Key::Room(id), record).await.map_err(not_now)?;
        self.join(id, visitor).await
    }

    /// Joins a room.
    pub(crate) async fn enter(&self, id: RoomId, visitor: &Entrant) -> Result<Place, RoomRefusal> {
        let mode = locked(&self.0.records, |it| it.get(&id).map(|it| it.record.header.mode));
        if mode == Some(Mode::Alone) {
            return Err(RoomRefusal::Alone);
        }
        self.join(id, visitor).await
    }

    /// Watches a room.
    pub(crate) async fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let handle = self.handle(id).await?;
        if handle.watchers.fetch_add(1, Ordering::AcqRel) >= self.0.rooms.limits().most_watchers {
            handle.watchers.fetch_sub(1, Ordering::AcqRel);
            return Err(RoomRefusal::Full);
        }
        Ok(Place::watcher(id, handle.interface, handle.watchers, self.0.rooms.clone()))
    }

    /// Replaces what the host allows.
    pub(crate) fn set_limits(&self, mut limits: RoomLimits) {
        let standing = std::mem::take(&mut limits.standing);
        locked(&self.0.standing, |it| *it = standing);
        self.0.rooms.set_limits(limits);
    }

    /// Hands all rooms over to the other hosts, of which this one is none any more.
    pub(crate) async fn end(&self) {
        self.0.context.ending.send_replace(true);
        let all_ended = async {
            for handle in self.0.replicas.lock().await.values() {
                handle.join_requests.closed().await;
            }
            self.visits().leave().await;
        };
        _ = timeout(ENDING, all_ended).await;
    }

    /// The snapshot of a room on this host.
    #[cfg(test)]
    pub(crate) fn view(&self, id: RoomId) -> Option<Arc<RoomView>> {
        let replicas = self.0.replicas.try_lock().ok()?;
        let handle = replicas.get(&id).filter(|handle| !handle.join_requests.is_closed())?;
        handle.interface.shown.view()
    }

    /// Becomes the member of a room that `wish` says.
    async fn be_member(&self, id: RoomId, wish: Wish) -> Result<Place, RoomRefusal> {
        for _ in 0..TRIES {
            let handle = self.handle(id).await?;
            let (reply, answer) = oneshot::channel::<Result<MemberId, RoomRefusal>>();
            let request = JoinRequest { wish: wish.clone(), reply };
            if handle.join_requests.send(request).await.is_err() {
                continue;
            }
            if let Ok(answer) = answer.await {
                return Ok(Place::member(id, answer?, handle.interface));
            }
        }
        Err(RoomRefusal::Gone)
    }

    /// The handle of a room's replica, which is started if this host has none.
    async fn handle(&self, id: RoomId) -> Result<RoomHandle, RoomRefusal> {
        let Inner { context, replicas, .. } = &*self.0;
        if *context.ending.borrow() {
            return Err(RoomRefusal::NotNow);
        }
        let mut replicas = replicas.lock().await;
        if let Some(handle) = replicas.get(&id).filter(|handle| !handle.join_requests.is_closed()) {
            return Ok(handle.clone());
        }
        let broadcasts = context.bus.subscribe(id).await.map_err(not_now)?;
        let (state, record) = context.load_state(id).await?;
        let (join_requests, receiver) = mpsc::channel(MOST_JOIN_REQUESTS);
        let (watchers, room) = (Arc::<AtomicUsize>::default(), state.room());
        let closes_after = match room.header().mode {
            Mode::Alone => Some(Duration::ZERO),
            _ => (!record.stands).then(|| self.0.rooms.limits().closes_after),
        };
        let interface = Arc::new(RoomInterface {
            inbox: Inbox::new(room.header().mode, room.next_member()),
            shown: Shown::new(room.view()),
            closes_after: watch::Sender::new(closes_after),
        });
        let handle = RoomHandle {
            interface: Arc::clone(&interface),
            watchers: Arc::clone(&watchers),
            join_requests,
        };
        let beginning = Beginning {
            id,
            record,
            interface,
            watchers,
            state,
            broadcasts,
            join_requests: receiver,
        };
        tokio::spawn(Replica::new(Arc::clone(context), beginning).run());
        replicas.insert(id, handle.clone());
        Ok(handle)
    }

    /// Keeps the records of all rooms up to date.
    async fn follow(self) {
        let mut pause = MAINTENANCE_PERIOD;
        loop {
            let Ok(mut changes) = self.0.context.bus.watch().await else {
                sleep(std::mem::replace(&mut pause, MAINTENANCE_PERIOD)).await;
                continue;
            };
            while let Some((id, bytes)) = changes.recv().await {
                self.note(id, bytes.as_deref());
            }
            sleep(pause).await;
        }
    }

    fn note(&self, id: RoomId, bytes: Option<&[u8]>) {
        // A record that cannot be read is of a room of another version, which is none for this host.
        let record = bytes.and_then(Record::parse);
        let now = Instant::now();
        locked(&self.0.records, |records| match record {
            Some(record) => _ = records.insert(id, Known { record, since: now }),
            None => _ = records.remove(&id),
        });
        self.show();
    }

    /// Makes the standing rooms, forgets replicas that have ended, and runs rooms that have lost their host,
    /// again and again.
    async fn maintain(self) {
        let mut periods = interval(MAINTENANCE_PERIOD);
        loop {
            periods.tick().await;
            if *self.0.context.ending.borrow() {
                return;
            }
            self.make_standing().await;
            self.0.replicas.lock().await.retain(|_, handle| !handle.join_requests.is_closed());
            for id in self.abandoned() {
                if let Err(refusal) = self.handle(id).await {
                    tracing::warn!(room = %id, "a room has no host: {refusal}");
                }
            }
        }
    }

    fn abandoned(&self) -> Vec<RoomId> {
        let now = Instant::now();
        let catalog = &self.0.context.catalog;
        // A host that does not have the level leaves the room to others.
        let is_abandoned = |known: &Known| {
            known.record.is_running
                && now.duration_since(known.since) >= ABANDONED
                && catalog.world(known.record.level()).is_some()
        };
        locked(&self.0.records, |records| {
            let abandoned = records.iter().filter(|(_, known)| is_abandoned(known));
            abandoned.map(|(id, _)| *id).collect()
        })
    }

    /// The header of a new room. `None` if there is no such level.
    fn header(&self, wish: &RoomWish) -> Option<Header> {
        let catalog = &self.0.context.catalog;
        let level = catalog.named(&wish.level).unwrap_or(&wish.level);
        let header = Header::new(level, wish.mode, wish.difficulty, self.0.context.chance());
        RoomState::new(catalog, header.clone()).map(|_| header)
    }
}

impl fmt::Debug for SharedRooms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedRooms").finish_non_exhaustive()
    }
}

fn not_now(_: BusFault) -> RoomRefusal {
    RoomRefusal::NotNow
}
