//! A visitor's stay in a room: the ways in and out.
//!
//! # Rules
//!
//! - A visitor who leaves, or whose connection ends, is not in the room any more.
//! - In a cluster, one whose host ends is away. With an account, they are where they were when they connect to any
//!   host, if they are away for no longer than a minute. A visitor to whom this host looks for their place
//!   may go elsewhere meanwhile; then they have left.

use std::time::Duration;

use super::account;
use super::requests::Reply;
use super::visit::Visit;
use crate::cluster::Entrant;
use crate::rooms::directory::{Place, RoomRefusal};
use crate::rooms::summary::{RoomId, RoomWish};
use crate::sessions::session::SessionEvent;

/// A way into a room.
pub(crate) enum Way {
    Watch(RoomId),
    Enter(RoomId),
    Open(RoomWish),
}

/// What a visitor reads while their place is looked for.
const LOOKS: &str = "You were in a room; the host looks for your place.";
/// What they read then.
const WELCOME: &str = "Welcome back: you are where you were.";
const GONE: &str = "Your place in the room is gone.";

impl Visit {
    /// Enters a room. Only a visitor with a name can be a member.
    pub(crate) fn go(&mut self, way: Way) {
        if !matches!(way, Way::Watch(_)) {
            self.leave();
        }
        let name = self.name.as_ref().map(account::line);
        if let Some(rooms) = self.shared.cluster.clone() {
            self.is_returning = false;
            let key = self.account.as_ref().map(|account| account.key);
            let entrant = name.map(|name| Entrant { name, key });
            let replies = self.replies.clone();
            tokio::spawn(async move {
                let place = match (&way, &entrant) {
                    (Way::Watch(room), _) => rooms.watch(*room).await,
                    (Way::Enter(room), Some(entrant)) => rooms.enter(*room, entrant).await,
                    (Way::Open(wish), Some(entrant)) => rooms.open(wish, entrant).await,
                    (_, None) => Err(RoomRefusal::Gone),
                };
                // A visitor who has gone leaves the room when the place is dropped.
                _ = replies.send(Reply::Place(place)).await;
            });
            return;
        }
        let rooms = &self.shared.rooms;
        let place = match (way, &name) {
            (Way::Watch(room), _) => rooms.watch(room),
            (Way::Enter(room), Some(name)) => rooms.enter(room, name),
            (Way::Open(wish), Some(name)) => rooms.open(&wish, name),
            (_, None) => Err(RoomRefusal::Gone),
        };
        self.enter(place);
    }

    pub(crate) fn enter(&mut self, place: Result<Place, RoomRefusal>) {
        match place {
            Ok(place) => {
                let place = self.kept_while_draining(place);
                self.in_lobby = false;
                self.presence.set_room(Some(place.room().place()));
                let event = SessionEvent::Entered { room: place.room(), member: place.member_id() };
                self.place = Some(place);
                self.notify(event);
            }
            Err(refusal) => self.notify(SessionEvent::Refused(refusal.to_string())),
        }
    }

    /// Leaves the room, and submits what was won in it.
    pub(crate) fn leave(&mut self) {
        self.give_place_up();
        self.part();
    }

    /// Ends the stay in the room, and submits what was won in it. If the server ends, the room keeps the place.
    pub(crate) fn part(&mut self) {
        let Some(place) = self.place.take() else { return };
        self.presence.set_room(None);
        if let Some(run) = place.finished() {
            self.submit(run);
        }
    }

    /// The server ends soon.
    pub(crate) fn drain(&mut self, now: Duration) {
        let time = self.shared.config.get().drain;
        self.is_draining = true;
        if let Some(place) = self.place.take() {
            self.place = Some(self.kept_while_draining(place));
        }
        let ends_at = now + time;
        let event = SessionEvent::Draining { ends_at, can_return: self.can_return() };
        self.session.notify(event, now);
        self.ends_at = Some(ends_at);
    }

    /// What a visitor reads at the end of the server.
    pub(crate) fn last_sentence(&self) -> &'static str {
        if self.can_return() {
            "This server has ended. Connect again, and you are where you were."
        } else {
            "The server has ended. Come again!"
        }
    }

    /// Whether a visitor finds the room as it was on another host.
    fn can_return(&self) -> bool {
        self.shared.keeps_places && self.account.is_some()
    }
}

impl Visit {
    /// Takes a visitor with an account back to the room in which their last host has left them.
    pub(crate) fn look_for_place(&mut self) {
        let Some(rooms) = self.shared.cluster.clone() else { return };
        let Some(key) = self.account.as_ref().map(|account| account.key) else { return };
        self.is_returning = true;
        let replies = self.replies.clone();
        tokio::spawn(async move {
            if let Some(at) = rooms.place_of(key).await {
                _ = replies.send(Reply::SessionEvent(SessionEvent::Result(LOOKS.to_owned()))).await;
                _ = replies.send(Reply::Returned(rooms.resume(key, at).await)).await;
            }
        });
    }

    /// Records where a visitor has returned to.
    pub(crate) fn returned(&mut self, place: Result<Place, RoomRefusal>) {
        if !std::mem::take(&mut self.is_returning) {
            return;
        }
        let sentence = match place {
            Ok(place) => {
                self.enter(Ok(place));
                WELCOME.to_owned()
            }
            Err(RoomRefusal::Gone) => GONE.to_owned(),
            Err(refusal) => refusal.to_string(),
        };
        self.notify(SessionEvent::Result(sentence));
    }

    fn kept_while_draining(&self, mut place: Place) -> Place {
        place.set_kept(self.is_draining && self.shared.cluster.is_some());
        place
    }

    /// The room does not keep the place any more.
    fn give_place_up(&mut self) {
        let Some(place) = &mut self.place else { return };
        place.set_kept(false);
        let key = self.account.as_ref().map(|account| account.key);
        // One who was removed may be somewhere else now.
        let is_member = place.member_id().is_some() && place.closed().is_none();
        if let (Some(rooms), Some(key), true) = (self.shared.cluster.clone(), key, is_member) {
            tokio::spawn(async move { rooms.forget_place(key).await });
        }
    }
}
