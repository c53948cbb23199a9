//! Standing rooms, and changes of what a host allows.

use super::{RoomLimits, Rooms};
use crate::lock::locked;

impl Rooms {
    /// Replaces what the host allows. New standing rooms open. Those that do not stand any more are
    /// closed when nobody is in them, as other rooms are. All else is true of what happens from now on.
    pub(crate) fn set_limits(&self, limits: RoomLimits) {
        locked(&self.0.limits, |it| *it = limits);
        self.open_standing();
        self.publish();
    }

    /// Opens the standing rooms that are missing, and lets the superfluous ones close.
    pub(crate) fn open_standing(&self) {
        let (mut missing, closes_after) =
            locked(&self.0.limits, |limits| (limits.standing.clone(), limits.closes_after));
        locked(&self.0.open, |open| {
            for room in open.rooms.values() {
                let Some(wish) = &room.stood_for else { continue };
                let wanted = missing.iter().position(|missing| missing == wish);
                match wanted.filter(|_| !room.interface.inbox.is_closed()) {
                    Some(index) => {
                        missing.remove(index);
                        room.interface.closes_after.send_replace(None);
                    }
                    None => _ = room.interface.closes_after.send_replace(Some(closes_after)),
                }
            }
        });
        for wish in missing {
            match self.add(&wish, true) {
                Ok(room) => self.spawn(room),
                Err(refusal) => tracing::error!(level = wish.level, "no standing room: {refusal}"),
            }
        }
    }
}
