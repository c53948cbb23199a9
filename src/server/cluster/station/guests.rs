//! Those who would like to join on this host, and those who were removed.

use std::time::Duration;

use tokio::sync::oneshot;
use tokio::time::Instant;

use super::Station;
use crate::server::cluster::talk::Talk;
use crate::server::line::Line;
use crate::server::room::MemberId;
use crate::server::rooms::RoomRefusal;

/// Somebody who would like to join.
pub(in crate::server::cluster) struct Asked {
    pub(in crate::server::cluster) name: Line,
    pub(in crate::server::cluster) reply: oneshot::Sender<Result<MemberId, RoomRefusal>>,
}

/// Somebody whom the sequencer was asked to let in.
pub(super) struct Guest {
    token: u64,
    asked: Asked,
    since: Instant,
    last: Instant,
}

/// The time after which the sequencer is asked again.
const AGAIN: Duration = Duration::from_millis(500);
/// The time after which somebody is sent away. Taking over a room takes less.
const PATIENCE: Duration = Duration::from_secs(8);

impl Station {
    pub(super) async fn receive(&mut self, asked: Asked) {
        let (now, token) = (Instant::now(), self.company.chance());
        let name = asked.name.clone();
        self.guests.push(Guest { token, asked, since: now, last: now });
        self.ask(token, &name, now).await;
    }

    /// Asks again for those who have no answer, and sends away who waits too long.
    pub(super) async fn ask_again(&mut self, now: Instant) {
        let is_late = |guest: &mut Guest| now.duration_since(guest.since) >= PATIENCE;
        for late in self.guests.extract_if(.., is_late) {
            _ = late.asked.reply.send(Err(RoomRefusal::NotNow));
        }
        let is_due = |guest: &&mut Guest| now.duration_since(guest.last) >= AGAIN;
        let due = self.guests.iter_mut().filter(is_due).map(|guest| {
            guest.last = now;
            (guest.token, guest.asked.name.clone())
        });
        for (token, name) in due.collect::<Vec<_>>() {
            self.ask(token, &name, now).await;
        }
    }

    async fn ask(&mut self, token: u64, name: &Line, now: Instant) {
        match &mut self.office {
            Some(office) => {
                if let Some(answer) = office.ask(token, name, now) {
                    self.answer(&answer);
                }
            }
            None => self.say(&Talk::Join(token, name.clone())).await,
        }
    }

    /// Passes on the answer of the sequencer, if it is for somebody here.
    pub(super) fn answer(&mut self, talk: &Talk) {
        let (Talk::Joined(token, ..) | Talk::Full(token)) = talk else { return };
        let index = self.guests.iter().position(|guest| guest.token == *token);
        let Some(index) = index else { return };
        let Asked { reply, .. } = self.guests.swap_remove(index).asked;
        match *talk {
            Talk::Joined(_, member, color) => {
                self.doorway.inbox.admit(member, color);
                if reply.send(Ok(member)).is_err() {
                    self.doorway.inbox.leave(member);
                }
            }
            _ => _ = reply.send(Err(RoomRefusal::Full)),
        }
    }

    /// Lets go those who were removed, since their host did not claim them in time.
    pub(super) fn dismiss_removed(&self) {
        let room = self.replica.room();
        for member in self.doorway.inbox.seated() {
            let is_there = room.colors().any(|(other, _)| other == member);
            // Who has the next number or a later one is on the way in.
            if !is_there && member < room.next_member() {
                self.doorway.inbox.dismiss(member);
            }
        }
    }
}
