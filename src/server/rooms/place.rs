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

/// What a member reads who was removed.
#[cfg(feature = "cluster")]
const DISMISSED: &str = "This host was cut off from the room for too long; enter it again.";

impl Place {
    pub(in crate::server) fn member(room: RoomId, member: MemberId, doorway: Arc<Doorway>) -> Self {
        Self::new(room, Role::Member(member), doorway)
    }

    pub(in crate::server) fn watcher(
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
        let closed = self.state.borrow().closed.clone();
        #[cfg(feature = "cluster")]
        let closed = closed.or_else(|| self.is_dismissed().then(|| DISMISSED.into()));
        closed
    }

    /// Whether the member was removed from the room, which others have gone on with.
    #[cfg(feature = "cluster")]
    fn is_dismissed(&self) -> bool {
        self.member_id().is_some_and(|member| !self.doorway.inbox.seated().contains(&member))
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
