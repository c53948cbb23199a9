//! A visitor's place in a room.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use tokio::sync::watch;

use super::Rooms;
use crate::rooms::room::{Command, MemberId, RoomView};
use crate::rooms::sequencer::{CommandRefusal, FinishedRun, RoomInterface, State};
use crate::rooms::summary::RoomId;

/// A visitor's place in a room, as a member or to watch. They leave when it is dropped, or are away if their host ends.
#[derive(Debug)]
pub(crate) struct Place {
    room: RoomId,
    role: Role,
    interface: Arc<RoomInterface>,
    /// The number of the member's seat. One who was removed and has returned by another connection has another one.
    seat: Option<u64>,
    /// Whether the member is away, and does not leave, when the place is dropped.
    is_kept: bool,
    state: watch::Receiver<State>,
}

#[derive(Debug)]
enum Role {
    Member(MemberId),
    Watcher { watchers: Arc<AtomicUsize>, rooms: Rooms },
}

/// What a member reads who was removed.
const DISMISSED: &str = "This host was cut off from the room for too long; enter it again.";

impl Place {
    pub(crate) fn member(room: RoomId, member: MemberId, interface: Arc<RoomInterface>) -> Self {
        Self::new(room, Role::Member(member), interface)
    }

    pub(crate) fn watcher(
        room: RoomId,
        interface: Arc<RoomInterface>,
        watchers: Arc<AtomicUsize>,
        rooms: Rooms,
    ) -> Self {
        Self::new(room, Role::Watcher { watchers, rooms }, interface)
    }

    fn new(room: RoomId, role: Role, interface: Arc<RoomInterface>) -> Self {
        let state = interface.shown.state();
        let seat = match role {
            Role::Member(member) => interface.inbox.seat_number(member),
            Role::Watcher { .. } => None,
        };
        Self { room, role, interface, seat, is_kept: false, state }
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
        self.interface.shown.view()
    }

    /// Why the room is closed, if it is: a sentence.
    pub(crate) fn closed(&self) -> Option<Arc<str>> {
        let closed = self.state.borrow().closed.clone();

        closed.or_else(|| self.is_dismissed().then(|| DISMISSED.into()))
    }

    /// Whether the member was removed from the room, which others have gone on with.
    fn is_dismissed(&self) -> bool {
        self.member_id().is_some_and(|member| {
            self.seat.is_none() || self.interface.inbox.seat_number(member) != self.seat
        })
    }

    /// Sets whether the room keeps the place when it is dropped, since the host ends.
    pub(crate) fn set_kept(&mut self, is_kept: bool) {
        self.is_kept = is_kept;
    }

    /// Waits until there is a newer snapshot than the last [`Place::view`], or the room is closed.
    pub(crate) async fn changed(&mut self) {
        // The place holds the sender.
        _ = self.state.changed().await;
    }

    /// Does something in the room.
    pub(crate) fn act(&self, command: Command) -> Result<(), CommandRefusal> {
        let member = self.member_id().ok_or(CommandRefusal::Impossible)?;
        if self.is_dismissed() {
            return Err(CommandRefusal::Impossible);
        }
        self.interface.inbox.act(member, command)
    }

    /// The run that the visitor has finished since the last call.
    pub(crate) fn finished(&self) -> Option<FinishedRun> {
        self.interface.inbox.finished(self.member_id()?)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        match &self.role {
            Role::Member(_) if self.is_dismissed() => {}
            Role::Member(member) if self.is_kept => self.interface.inbox.part(*member),
            Role::Member(member) => self.interface.inbox.leave(*member),
            Role::Watcher { watchers, rooms } => {
                watchers.fetch_sub(1, Ordering::AcqRel);
                rooms.publish();
            }
        }
    }
}
