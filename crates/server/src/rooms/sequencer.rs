//! The sequencer of a room: it decides in which step each command of a member takes effect.
//!
//! # Rules
//!
//! - A room takes a step each [`STEP`]. If a step is late, at most [`MOST_CAUGHT_UP`] follow at once; further ones are
//!   left out, so that the room's time slips.
//! - A room is changed by entries of its [log](RoundLog) alone. Commands that come too often are refused or delayed
//!   before they become entries, see [`Inbox`].
//! - A room without members takes no steps and has no timer. After a while it is closed, unless it is a standing room.
//! - A fault in a room, even a panic, ends this room with a sentence to its members, and no other.
//! - A recording that cannot be written is reported, and the room goes on.
//!
//! Rejected: a thread for each room. Rooms sleep most of the time, and their steps take microseconds.

mod inbox;
mod round_log;

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::{Instant, sleep, sleep_until};

pub(crate) use self::inbox::{CommandRefusal, Inbox, STEP};
pub(crate) use self::round_log::{Changes, FinishedRun, Recording, RoundLog};
use crate::load::Load;
#[cfg(test)]
use crate::load::Work;
use crate::lock::locked;
use crate::rooms::room::{Mode, Room, RoomView};

/// The most steps that follow at once after a delay.
pub(crate) const MOST_CAUGHT_UP: u32 = 6;
/// Shown to members after a fault.
pub(crate) const FAULT: &str = "The room has ended because of a fault of this server.";

/// The interface between a room and its members: commands in, snapshots out.
#[derive(Debug)]
pub(crate) struct RoomInterface {
    /// The commands of the members.
    pub(crate) inbox: Inbox,
    /// The newest snapshot.
    pub(crate) shown: Shown,
    /// How long the room stays open without members; `None` if it always does.
    pub(crate) closes_after: watch::Sender<Option<Duration>>,
    /// The number of watchers.
    watchers: AtomicUsize,
}

/// The newest snapshot of a room, and news of the next one.
///
/// The snapshot before is dropped before a step, so that the step copies the game only if a session draws from it at
/// that moment. Rejected: a `watch` channel of snapshots, which would keep the snapshot, so that each step would copy
/// the game.
#[derive(Debug)]
pub(crate) struct Shown {
    view: Mutex<Option<Arc<RoomView>>>,
    /// Why the room is closed, if it is: a sentence. It is sent again with each snapshot, and so wakes sessions.
    closed: watch::Sender<Option<Arc<str>>>,
}

/// A room with its log, which the sequencer alone changes.
pub(crate) struct Sequencer {
    room: Room,
    log: RoundLog,
    interface: Arc<RoomInterface>,
    load: Arc<Load>,
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

    /// Runs the room until it is closed. `on_change` is called when a lobby would show the room differently.
    ///
    /// # Errors
    /// The message of a panic, after which the room is closed.
    pub(crate) async fn run(
        mut self,
        mut on_change: impl FnMut(&Room) + Send,
    ) -> Result<(), String> {
        let mut next = Instant::now();
        loop {
            if self.room.len() > 0 || !self.interface.inbox.is_empty() {
                sleep_until(next).await;
            } else if self.somebody_joins().await {
                next = Instant::now();
            } else {
                return Ok(());
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

    /// Waits until somebody joins; returns whether the room still exists then.
    async fn somebody_joins(&mut self) -> bool {
        self.log.flush();
        let RoomInterface { inbox, shown, closes_after, .. } = &*self.interface;
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
        self.load.metrics.entries.inc_by(changes.entries);
        if let Some(run) = changes.finished {
            interface.inbox.finish(run);
        }
        if changes.summary {
            on_change(&self.room);
        }
    }
}

impl RoomInterface {
    /// The interface of `room`, which nobody has entered yet. A room that is not `standing` closes after that time
    /// without members.
    pub(crate) fn new(room: &Room, is_standing: bool, closes_after: Duration) -> Arc<Self> {
        let mode = room.header().mode;
        let closes_after = match mode {
            // Nobody else can go on with a game that a member plays alone.
            Mode::Alone => Some(Duration::ZERO),
            _ => (!is_standing).then_some(closes_after),
        };
        Arc::new(Self {
            inbox: Inbox::new(mode, room.next_member()),
            shown: Shown::new(room.view()),
            closes_after: watch::Sender::new(closes_after),
            watchers: AtomicUsize::new(0),
        })
    }

    /// Closes the room for everybody, with a sentence.
    pub(crate) fn close(&self, sentence: &str) {
        self.inbox.close();
        self.shown.close(sentence);
    }

    /// The number of watchers.
    pub(crate) fn watchers(&self) -> usize {
        self.watchers.load(Ordering::Acquire)
    }

    /// Adds a watcher, if there are fewer than `most`; returns whether it did.
    pub(crate) fn add_watcher(&self, most: usize) -> bool {
        let more = |count| (count < most).then_some(count + 1);
        self.watchers.fetch_update(Ordering::AcqRel, Ordering::Acquire, more).is_ok()
    }

    /// Removes a watcher.
    pub(crate) fn remove_watcher(&self) {
        self.watchers.fetch_sub(1, Ordering::AcqRel);
    }
}

impl Shown {
    fn new(view: RoomView) -> Self {
        let view = Mutex::new(Some(Arc::new(view)));
        Self { view, closed: watch::Sender::default() }
    }

    /// The newest snapshot. During a step, it waits for the next one. `None` after a fault.
    pub(crate) fn view(&self) -> Option<Arc<RoomView>> {
        locked(&self.view, |view| view.clone())
    }

    /// Changes with the next snapshot, and when the room is closed.
    pub(crate) fn closed(&self) -> watch::Receiver<Option<Arc<str>>> {
        self.closed.subscribe()
    }

    /// Replaces the snapshot by the one after `step`.
    pub(crate) fn replace<T>(&self, step: impl FnOnce() -> (RoomView, T)) -> T {
        let result = locked(&self.view, |shown| {
            *shown = None;
            let (view, result) = step();
            *shown = Some(Arc::new(view));
            result
        });
        self.closed.send_modify(|_| {});
        result
    }

    /// Tells everybody that the room is closed.
    fn close(&self, sentence: &str) {
        self.closed.send_modify(|closed| {
            closed.get_or_insert_with(|| sentence.into());
        });
    }
}

/// The message of a panic.
pub(crate) fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref().map(String::as_str));
    text.unwrap_or("a panic without a message").to_owned()
}
