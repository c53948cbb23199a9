//! The commands of a room's members, until the sequencer takes them.
//!
//! Each member has a bounded queue of their own, so that a flood of one member's commands never delays those of
//! another. Rejected: one queue for all members, since one of them could fill it. A member may say [`CHAT_BURST`]
//! lines at once and show one emotion, and one of each a second.
//!
//! Intents take effect in the order in which they came, one change in a step, so that a tap begins and ends in steps of
//! its own. If [`MOST_INTENTS`] changes wait, the newest replaces the last one. Sessions limit the rate of changes.

use std::collections::VecDeque;
use std::sync::Mutex;
use std::time::Duration;

use tokio::sync::Notify;

use super::round_log::FinishedRun;
use crate::bucket::Bucket;
use crate::line::Line;
use crate::lock::locked;
use crate::rooms::room::{Command, MemberId, Mode};
use crate::rooms::summary::RoomRefusal;
use cellcaster::game::{PlayerColor, STEPS_PER_SECOND};

/// The time of a step.
pub(crate) const STEP: Duration = Duration::from_nanos(1_000_000_000 / STEPS_PER_SECOND as u64);
/// The lines that a member may say at once.
const CHAT_BURST: f64 = 4.0;
/// The most changes of intents that wait.
const MOST_INTENTS: usize = 8;
/// The most arrivals and departures that wait, each of which takes effect in the next step.
const MOST_MOVES: usize = 64;

/// The commands of a room's members.
#[derive(Debug)]
pub(crate) struct Inbox {
    waiting: Mutex<Waiting>,
    joined: Notify,
}

/// Why a command was not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CommandRefusal {
    /// The member does such things too often.
    TooOften,
    /// There is no such member, or members do not give such commands.
    Impossible,
}

#[derive(Debug)]
struct Waiting {
    is_closed: bool,
    most: usize,
    next: u32,
    /// Members who have joined, whether the room knows it or not.
    seats: Vec<Seat>,
    /// The seats that were ever taken.
    seats_taken: u64,
    moves: VecDeque<(MemberId, Command)>,
    /// The time of the steps in all rounds.
    time: Duration,
    finished: Option<FinishedRun>,
}

#[derive(Debug)]
struct Seat {
    id: MemberId,
    /// A member who loses their seat and returns has another number.
    number: u64,
    color: PlayerColor,
    intents: VecDeque<Command>,
    talk: VecDeque<Command>,
    chat: Bucket,
    emotes: Bucket,
}

impl Inbox {
    /// The inbox of a room without members, whose next member is `next`.
    pub(crate) fn new(mode: Mode, next: MemberId) -> Self {
        let waiting = Waiting {
            is_closed: false,
            most: mode.most(),
            next: next.0,
            seats: Vec::new(),
            seats_taken: 0,
            moves: VecDeque::new(),
            time: Duration::ZERO,
            finished: None,
        };
        Self { waiting: Mutex::new(waiting), joined: Notify::new() }
    }

    /// Adds a member.
    pub(crate) fn join(&self, name: &Line) -> Result<MemberId, RoomRefusal> {
        let id = locked(&self.waiting, |waiting| waiting.join(name))?;
        self.joined.notify_one();
        Ok(id)
    }

    /// Gives a seat to a member who has joined elsewhere.
    pub(crate) fn admit(&self, id: MemberId, color: PlayerColor) {
        locked(&self.waiting, |waiting| {
            waiting.next = waiting.next.max(id.0.saturating_add(1));
            waiting.seat(id, color);
        });
    }

    /// Takes the seat of a member who is not in the room any more.
    pub(crate) fn dismiss(&self, id: MemberId) {
        locked(&self.waiting, |waiting| waiting.seats.retain(|seat| seat.id != id));
    }

    /// Members with a seat.
    pub(crate) fn seated(&self) -> Vec<MemberId> {
        locked(&self.waiting, |waiting| waiting.seats.iter().map(|seat| seat.id).collect())
    }

    /// Takes the seat of a member, who leaves.
    pub(crate) fn leave(&self, id: MemberId) {
        self.unseat(id, Command::Leave);
    }

    /// Takes the seat of a member whose host ends. The room keeps their place.
    pub(crate) fn part(&self, id: MemberId) {
        self.unseat(id, Command::Away);
    }

    fn unseat(&self, id: MemberId, command: Command) {
        locked(&self.waiting, |waiting| {
            let count = waiting.seats.len();
            waiting.seats.retain(|seat| seat.id != id);
            if waiting.seats.len() < count {
                waiting.moves.push_back((id, command));
            }
        });
    }

    /// Accepts a command of a member.
    pub(crate) fn act(&self, id: MemberId, command: Command) -> Result<(), CommandRefusal> {
        locked(&self.waiting, |waiting| {
            let time = waiting.time;
            let seat = waiting.seats.iter_mut().find(|seat| seat.id == id);
            seat.ok_or(CommandRefusal::Impossible)?.act(command, time)
        })
    }

    /// The number of a member's seat, which no other seat ever has; `None` if they have none.
    pub(crate) fn seat_number(&self, id: MemberId) -> Option<u64> {
        locked(&self.waiting, |waiting| {
            waiting.seats.iter().find(|seat| seat.id == id).map(|seat| seat.number)
        })
    }

    /// Whether somebody is about to join or leave.
    pub(crate) fn has_moves(&self) -> bool {
        locked(&self.waiting, |waiting| !waiting.moves.is_empty())
    }

    /// Marks a member away. They have their seat until the room removes them.
    pub(crate) fn set_away(&self, id: MemberId) {
        locked(&self.waiting, |waiting| {
            if let Some(seat) = waiting.seats.iter_mut().find(|seat| seat.id == id) {
                seat.intents.clear();
                seat.talk.clear();
            }
            waiting.moves.push_back((id, Command::Away));
        });
    }

    /// Keeps the place of a member who has just joined.
    pub(crate) fn keep(&self, id: MemberId) {
        locked(&self.waiting, |waiting| waiting.moves.push_back((id, Command::Keep)));
    }

    /// Has a member go on, on another host.
    pub(crate) fn take_back(&self, id: MemberId, token: u64) {
        locked(&self.waiting, |waiting| waiting.moves.push_back((id, Command::Return { token })));
    }

    /// Whether nobody is in the room, and nobody is about to join or leave it.
    pub(crate) fn is_empty(&self) -> bool {
        locked(&self.waiting, |waiting| waiting.seats.is_empty() && waiting.moves.is_empty())
    }

    /// Waits until somebody joins, or the room is closed.
    pub(crate) async fn joined(&self) {
        while self.is_empty() && !self.is_closed() {
            self.joined.notified().await;
        }
    }

    pub(crate) fn is_closed(&self) -> bool {
        locked(&self.waiting, |waiting| waiting.is_closed)
    }

    /// Nobody may join any more.
    pub(crate) fn close(&self) {
        locked(&self.waiting, |waiting| waiting.is_closed = true);
        self.joined.notify_one();
    }

    /// Closes the room, unless somebody joins; returns whether it is closed.
    pub(crate) fn close_if_empty(&self) -> bool {
        locked(&self.waiting, |waiting| {
            waiting.is_closed |= waiting.seats.is_empty();
            waiting.is_closed
        })
    }

    /// Keeps a run until its member takes it.
    pub(crate) fn finish(&self, run: FinishedRun) {
        locked(&self.waiting, |waiting| waiting.finished = Some(run));
    }

    /// The run that a member has finished since the last call.
    pub(crate) fn finished(&self, id: MemberId) -> Option<FinishedRun> {
        locked(&self.waiting, |waiting| waiting.finished.take_if(|run| run.member == id))
    }

    /// Passes on the commands that take effect in the next step, in their order.
    pub(crate) fn take(&self, mut pass: impl FnMut(MemberId, Command)) {
        locked(&self.waiting, |waiting| {
            waiting.moves.drain(..).for_each(|(id, command)| pass(id, command));
            for seat in &mut waiting.seats {
                let intents = seat.intents.pop_front();
                intents.into_iter().chain(seat.talk.drain(..)).for_each(|it| pass(seat.id, it));
            }
            waiting.time += STEP;
        });
    }
}

impl Waiting {
    fn join(&mut self, name: &Line) -> Result<MemberId, RoomRefusal> {
        if self.is_closed {
            return Err(RoomRefusal::Gone);
        }
        if self.seats.len() >= self.most || self.moves.len() >= MOST_MOVES {
            return Err(RoomRefusal::Full);
        }
        let worn = |color: &PlayerColor| self.seats.iter().filter(|it| it.color == *color).count();
        let color = PlayerColor::ALL.into_iter().min_by_key(worn).ok_or(RoomRefusal::Full)?;
        let id = MemberId(self.next);
        if id > MemberId::MOST {
            return Err(RoomRefusal::Full);
        }
        self.next += 1;
        self.moves.push_back((id, Command::Join { color, name: name.clone() }));
        self.seat(id, color);
        Ok(id)
    }

    fn seat(&mut self, id: MemberId, color: PlayerColor) {
        self.seats_taken += 1;
        self.seats.push(Seat {
            id,
            number: self.seats_taken,
            color,
            intents: VecDeque::new(),
            talk: VecDeque::new(),
            chat: Bucket::new(1.0, CHAT_BURST, self.time),
            emotes: Bucket::new(1.0, 1.0, self.time),
        });
    }
}

impl Seat {
    fn act(&mut self, command: Command, time: Duration) -> Result<(), CommandRefusal> {
        let bucket = match command {
            Command::Intents { .. } => {
                if self.intents.len() >= MOST_INTENTS {
                    self.intents.pop_back();
                }
                self.intents.push_back(command);
                return Ok(());
            }
            Command::Say(_) => &mut self.chat,
            Command::Emote(_) | Command::Again => &mut self.emotes,
            Command::Join { .. }
            | Command::Leave
            | Command::Keep
            | Command::Away
            | Command::Return { .. } => return Err(CommandRefusal::Impossible),
        };
        if !bucket.takes_one(time) {
            return Err(CommandRefusal::TooOften);
        }
        self.talk.push_back(command);
        Ok(())
    }
}

#[cfg(test)]
mod tests;
