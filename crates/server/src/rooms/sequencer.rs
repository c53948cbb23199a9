//! The sequencer of a room: it decides in which step each command of a member takes effect.
//!
//! # Rules
//!
//! - A room takes [`STEPS_PER_SECOND`] steps a second. If a step is late, at most [`MOST_CAUGHT_UP`]
//!   follow at once; further ones are left out, so that the room's time slips.
//! - All that changes the room is an entry of its `Log`, which is applied from the log. Commands
//!   that come too often are refused or delayed before they reach the log, see [`Inbox`].
//! - A room without members takes no steps and has no timer. After a while it is closed, if it is no
//!   standing room.
//! - A fault in a room, even a panic, ends this room with a sentence to its members, and no other.
//! - A recording that cannot be written is reported, and the room goes on.
//!
//! A thread for each room was refused: rooms sleep most of the time, and their steps take microseconds.

mod inbox;
mod round_log;
mod shown;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::{Instant, sleep, sleep_until};

pub(crate) use self::inbox::{CommandRefusal, Inbox, JoinRefusal};
pub(crate) use self::round_log::Changes;
pub(crate) use self::round_log::{FinishedRun, RoundLog};
pub(crate) use self::shown::{Shown, State};
use crate::rooms::room::Room;
use crate::sessions::load::Load;
#[cfg(test)]
use crate::sessions::load::Work;
use cellcaster::game::STEPS_PER_SECOND;

/// The most steps that follow at once after a delay.
pub(crate) const MOST_CAUGHT_UP: u32 = 6;
/// What members read after a fault.
pub(crate) const FAULT: &str = "The room has ended because of a fault of this server.";

/// The interface between a room and its members: commands in, snapshots out.
#[derive(Debug)]
pub(crate) struct RoomInterface {
    /// The commands of the members.
    pub(crate) inbox: Inbox,
    /// The newest snapshot.
    pub(crate) shown: Shown,
    /// The time without members after which the room is closed; `None` as long as it stands.
    pub(crate) closes_after: watch::Sender<Option<Duration>>,
}

/// A room with its log, of which the sequencer alone is in charge.
pub(crate) struct Sequencer {
    room: Room,
    log: RoundLog,
    interface: Arc<RoomInterface>,
    load: Arc<Load>,
}

/// The next thing that a sequencer waits for.
enum Pause {
    /// The time of the next step.
    Until(Instant),
    /// Somebody who joins.
    Member,
}

impl Sequencer {
    pub(crate) fn new(
        room: Room,
        log: RoundLog,
        interface: Arc<RoomInterface>,
        load: Arc<Load>,
    ) -> Self {
        Self { room, log, interface, load }
    }

    /// Runs the room until it is closed. `on_change` is called when a lobby would show it otherwise.
    ///
    /// # Errors
    /// The message of a panic, after which the room is closed.
    pub(crate) async fn run(
        mut self,
        mut on_change: impl FnMut(&Room) + Send,
    ) -> Result<(), String> {
        let mut next = Instant::now();
        loop {
            match self.pause(next) {
                Pause::Until(time) => sleep_until(time).await,
                Pause::Member => {
                    if !self.somebody_joins().await {
                        return Ok(());
                    }
                    next = Instant::now();
                }
            }
            let caught =
                catch_unwind(AssertUnwindSafe(|| self.catch_up(&mut next, &mut on_change)));
            if let Err(panic) = caught {
                self.interface.close(FAULT);
                return Err(message(&*panic));
            }
            if self.interface.inbox.is_closed() {
                return Ok(());
            }
        }
    }

    fn pause(&self, next: Instant) -> Pause {
        let is_empty = self.room.len() == 0 && self.interface.inbox.is_empty();
        if is_empty { Pause::Member } else { Pause::Until(next) }
    }

    /// Waits until somebody joins; returns whether the room still exists then.
    async fn somebody_joins(&mut self) -> bool {
        self.log.flush();
        let RoomInterface { inbox, shown, closes_after } = &*self.interface;
        let mut patience = closes_after.subscribe();
        loop {
            let wait = *patience.borrow_and_update();
            tokio::select! {
                biased;
                () = inbox.joined() => return !inbox.is_closed(),
                // The sender is in the interface.
                _ = patience.changed() => {}
                () = sleep(wait.unwrap_or_default()), if wait.is_some() => {
                    if inbox.close_if_empty() {
                        shown.close("The room was empty and is closed.");
                    }
                    return !inbox.is_closed();
                }
            }
        }
    }

    /// Takes the steps that are due, and moves `next` to the time of the one after them.
    fn catch_up(&mut self, next: &mut Instant, on_change: &mut impl FnMut(&Room)) {
        let now = Instant::now();
        self.load.note_lateness(now.saturating_duration_since(*next));
        for _ in 0..MOST_CAUGHT_UP {
            if *next > now {
                return;
            }
            *next += STEP;
            self.step(on_change);
        }
        *next = (*next).max(now);
    }

    fn step(&mut self, on_change: &mut impl FnMut(&Room)) {
        let Self { room, log, interface, .. } = self;
        let changes = interface.shown.replace(|| {
            let changes = log.step(room, |pass| interface.inbox.take(pass));
            (room.view(), changes)
        });
        #[cfg(test)]
        self.load.spend(Work::Step);
        self.load.metrics().entries.inc_by(changes.entries);
        if let Some(run) = changes.finished {
            interface.inbox.finish(run);
        }
        if changes.summary {
            on_change(&self.room);
        }
    }
}

/// The message of a panic.
pub(crate) fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref().map(String::as_str));
    text.unwrap_or("a panic without a message").to_owned()
}

/// The time of a step.
pub(crate) const STEP: Duration = Duration::from_nanos(1_000_000_000 / STEPS_PER_SECOND as u64);

impl RoomInterface {
    /// Closes the room for all, with a sentence.
    pub(crate) fn close(&self, sentence: &str) {
        self.inbox.close();
        self.shown.close(sentence);
    }
}
