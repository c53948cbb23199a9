//! A visitor's place in a room.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use tokio::sync::watch;

use super::Rooms;
use crate::server::room::{Deed, MemberId, RoomView};
use crate::server::sequencer::{DeedRefusal, Doorway, FinishedRun, State};
use crate::server::summary::RoomId;

/// A visitor's place in a room, as a member or to watch. They leave when it is dropped.
#[derive(Debug)]
pub(crate) struct Place {
    room: RoomId,
    role: Role,
    doorway: Arc<Doorway>,
    state: watch::Receiver<State>,
}

#[derive(Debug)]
enum Role {
    Member(MemberId),
    Watcher { watchers: Arc<AtomicUsize>, rooms: Rooms },
}

impl Place {
    pub(super) fn member(room: RoomId, member: MemberId, doorway: Arc<Doorway>) -> Self {
        Self::new(room, Role::Member(member), doorway)
    }

    pub(super) fn watcher(
        room: RoomId,
        doorway: Arc<Doorway>,
        watchers: Arc<AtomicUsize>,
        rooms: Rooms,
    ) -> Self {
        Self::new(room, Role::Watcher { watchers, rooms }, doorway)
    }

    fn new(room: RoomId, role: Role, doorway: Arc<Doorway>) -> Self {
        let state = doorway.shown.state();
        Self { room, role, doorway, state }
    }

    pub(crate) fn room(&self) -> RoomId {
        self.room
    }

    /// The number of the member; `None` if the visitor watches.
    pub(crate) fn member_id(&self) -> Option<MemberId> {
        match self.role {
            Role::Member(member) => Some(member),
            Role::Watcher { .. } => None,
        }
    }

    /// The newest snapshot; `None` after a fault of the room.
    pub(crate) fn view(&mut self) -> Option<Arc<RoomView>> {
        self.state.mark_unchanged();
        self.doorway.shown.view()
    }

    /// Why the room is closed, if it is: a sentence.
    pub(crate) fn closed(&self) -> Option<Arc<str>> {
        self.state.borrow().closed.clone()
    }

    /// Waits until there is a newer snapshot than the last [`Place::view`], or the room is closed.
    pub(crate) async fn changed(&mut self) {
        // The place holds the sender.
        _ = self.state.changed().await;
    }

    /// Does something in the room.
    pub(crate) fn act(&self, deed: Deed) -> Result<(), DeedRefusal> {
        let member = self.member_id().ok_or(DeedRefusal::Impossible)?;
        self.doorway.inbox.act(member, deed)
    }

    /// The run that the visitor has finished since the last call.
    pub(crate) fn finished(&self) -> Option<FinishedRun> {
        self.doorway.inbox.finished(self.member_id()?)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        match &self.role {
            Role::Member(member) => self.doorway.inbox.leave(*member),
            Role::Watcher { watchers, rooms } => {
                watchers.fetch_sub(1, Ordering::AcqRel);
                rooms.publish();
            }
        }
    }
}
