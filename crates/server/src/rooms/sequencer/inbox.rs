//! The commands of a room's members, until the sequencer takes them.
//!
//! Each member has a bounded place of their own: what one floods it with is refused or replaces what
//! they wanted before, and never waits in another's way. Of chat and emotions only as many are
//! accepted as [`Pace`] allows. A queue for all members was refused: one of them could fill it.
//!
//! Intents take effect in the order in which they were wanted, one change in [`INTENT_PAUSE`] steps. If
//! more than [`MOST_INTENTS`] changes wait, the newest replaces the last one.

mod away;

use std::collections::VecDeque;
use std::sync::Mutex;

use tokio::sync::Notify;

use super::FinishedRun;
use crate::lock::locked;
use crate::rooms::room::{Command, MemberId, Mode};
use crate::sessions::line::Line;
use cellcaster::game::{PlayerColor, STEPS_PER_SECOND};

/// The least number of steps between two changes of a member's intents: 30 changes a second.
const INTENT_PAUSE: u64 = STEPS_PER_SECOND as u64 / 30;
/// The most changes that wait.
const MOST_INTENTS: usize = 8;
/// The most arrivals and departures that wait, each of which takes effect in the next step.
const MOST_MOVES: usize = 64;

/// The commands of a room's members.
#[derive(Debug)]
pub(crate) struct Inbox {
    waiting: Mutex<Waiting>,
    joined: Notify,
}

/// Why somebody cannot join.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum JoinRefusal {
    Closed,
    Full,
}

/// Why a command was not accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CommandRefusal {
    /// The member does such things too often.
    TooOften,
    /// There is no such member, or the command is none of a member's.
    Impossible,
}

#[derive(Debug)]
struct Waiting {
    is_closed: bool,
    most: usize,
    next: u32,
    /// Those who have joined, whether the room knows it or not.
    seats: Vec<Seat>,
    /// The seats that were ever taken.
    seats_taken: u64,
    moves: VecDeque<(MemberId, Command)>,
    /// The number of steps so far, over all rounds.
    steps: u64,
    finished: Option<FinishedRun>,
}

#[derive(Debug)]
struct Seat {
    id: MemberId,
    /// Who loses a seat and returns has another one.
    number: u64,
    color: PlayerColor,
    intents: VecDeque<Command>,
    /// The step after which the next change of intents takes effect.
    next_intents: u64,
    talk: VecDeque<Command>,
    chat: Pace,
    emotes: Pace,
}

/// How often a member may do something: a token bucket, counted in steps.
#[derive(Debug)]
struct Pace {
    most: u64,
    /// Steps that are not used up; one command uses a second's.
    credit: u64,
    counted: u64,
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
            steps: 0,
            finished: None,
        };
        Self { waiting: Mutex::new(waiting), joined: Notify::new() }
    }

    /// Somebody joins.
    pub(crate) fn join(&self, name: &Line) -> Result<MemberId, JoinRefusal> {
        let id = locked(&self.waiting, |waiting| waiting.join(name))?;
        self.joined.notify_one();
        Ok(id)
    }

    /// Gives a seat to somebody who has joined elsewhere.
    pub(crate) fn admit(&self, id: MemberId, color: PlayerColor) {
        locked(&self.waiting, |waiting| {
            waiting.next = waiting.next.max(id.0.saturating_add(1));
            waiting.seat(id, color);
        });
    }

    /// Takes a seat from somebody who is not in the room any more.
    pub(crate) fn dismiss(&self, id: MemberId) {
        locked(&self.waiting, |waiting| waiting.seats.retain(|seat| seat.id != id));
    }

    /// Those who have a seat.
    pub(crate) fn seated(&self) -> Vec<MemberId> {
        locked(&self.waiting, |waiting| waiting.seats.iter().map(|seat| seat.id).collect())
    }

    /// A member leaves. It is always accepted.
    pub(crate) fn leave(&self, id: MemberId) {
        locked(&self.waiting, |waiting| {
            let count = waiting.seats.len();
            waiting.seats.retain(|seat| seat.id != id);
            if waiting.seats.len() < count {
                waiting.moves.push_back((id, Command::Leave));
            }
        });
    }

    /// A member does something.
    pub(crate) fn act(&self, id: MemberId, command: Command) -> Result<(), CommandRefusal> {
        locked(&self.waiting, |waiting| {
            let steps = waiting.steps;
            let seat = waiting.seats.iter_mut().find(|seat| seat.id == id);
            seat.ok_or(CommandRefusal::Impossible)?.act(command, steps)
        })
    }

    /// Whether nobody is in the room or on the way to it, and nobody is about to leave it.
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

    /// Passes on what takes effect in the next step, in its order.
    pub(crate) fn take(&self, mut pass: impl FnMut(MemberId, Command)) {
        locked(&self.waiting, |waiting| {
            let steps = waiting.steps;
            waiting.moves.drain(..).for_each(|(id, command)| pass(id, command));
            for seat in &mut waiting.seats {
                if seat.next_intents <= steps
                    && let Some(intents) = seat.intents.pop_front()
                {
                    seat.next_intents = steps + INTENT_PAUSE;
                    pass(seat.id, intents);
                }
                seat.talk.drain(..).for_each(|command| pass(seat.id, command));
            }
            waiting.steps += 1;
        });
    }
}

impl Waiting {
    fn join(&mut self, name: &Line) -> Result<MemberId, JoinRefusal> {
        if self.is_closed {
            return Err(JoinRefusal::Closed);
        }
        if self.seats.len() >= self.most || self.moves.len() >= MOST_MOVES {
            return Err(JoinRefusal::Full);
        }
        let worn = |color: &PlayerColor| self.seats.iter().filter(|it| it.color == *color).count();
        let color = PlayerColor::ALL.into_iter().min_by_key(worn).ok_or(JoinRefusal::Full)?;
        let id = MemberId(self.next);
        if id > MemberId::MOST {
            return Err(JoinRefusal::Full);
        }
        self.next += 1;
        self.moves.push_back((id, Command::Join { color, name: name.clone() }));
        self.seat(id, color);
        Ok(id)
    }

    fn seat(&mut self, id: MemberId, color: PlayerColor) {
        {
            self.seats_taken += 1;
        }
        self.seats.push(Seat {
            id,
            number: self.seats_taken,
            color,
            intents: VecDeque::new(),
            next_intents: 0,
            talk: VecDeque::new(),
            chat: Pace::new(4, self.steps),
            emotes: Pace::new(1, self.steps),
        });
    }
}

impl Seat {
    fn act(&mut self, command: Command, steps: u64) -> Result<(), CommandRefusal> {
        let pace = match command {
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
        if !pace.allows(steps) {
            return Err(CommandRefusal::TooOften);
        }
        self.talk.push_back(command);
        Ok(())
    }
}

impl Pace {
    /// One a second, and `burst` at once.
    fn new(burst: u64, steps: u64) -> Self {
        let most = burst * u64::from(STEPS_PER_SECOND);
        Self { most, credit: most, counted: steps }
    }

    fn allows(&mut self, steps: u64) -> bool {
        self.credit = (self.credit + steps - self.counted).min(self.most);
        self.counted = steps;
        let is_allowed = self.credit >= u64::from(STEPS_PER_SECOND);
        self.credit -= if is_allowed { u64::from(STEPS_PER_SECOND) } else { 0 };
        is_allowed
    }
}

#[cfg(test)]
mod tests;
