//! The sequencer of a room: decides in which step each member's command takes effect.
//!
//! # Rules
//!
//! - A room takes a step every [`STEP`]. After a delay it catches up on at most [`MAX_CAUGHT_UP`] steps at
//!   once. It skips the rest, so the room's time falls behind.
//! - Only entries of its [log](RoundLog) change a room. The [`Inbox`] rejects or delays excessive commands
//!   before they become entries.
//! - A room without members takes no steps and has no timer. It closes after a while, unless it is a standing room.
//! - A fault in a room, even a panic, ends only this room. Its members are told in a sentence.
//! - If a recording cannot be written, the error is logged and the room goes on.
//!
//! Rejected: a thread per room. Rooms sleep most of the time, and their steps take microseconds.

use std::any::Any;
use std::collections::VecDeque;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::task::Waker;
use std::time::Duration;

use tokio::sync::{Notify, watch};
use tokio::time::{Instant, sleep, sleep_until};

use super::invitation::RoomCode;
use super::summary::RoomRefusal;
use crate::line::Line;
use crate::load::Load;
#[cfg(test)]
use crate::load::Work;
use crate::lock::locked;
use crate::rooms::cast;
use crate::rooms::room::{Command, Entry, Header, MemberId, Mode, Room, RoomView};
use cellcaster::game::{
    self, Intents, LevelName, Outcome, PlayerColor, Rules, STEPS_PER_SECOND, ScriptWriter, Stretch,
};

/// The maximum number of steps to catch up on after a delay.
pub(crate) const MAX_CAUGHT_UP: u32 = 6;
/// Shown to members after a fault.
pub(crate) const FAULT: &str = "The room has ended because of an error in this server.";

/// The interface between a room and its members: commands in, snapshots out.
#[derive(Debug)]
pub(crate) struct RoomInterface {
    /// The members' commands.
    pub(crate) inbox: Inbox,
    /// The latest snapshot. It is locked during a step, so a reader that arrives during the step waits for
    /// the new snapshot.
    ///
    /// The previous snapshot is dropped before the step, so the step copies the game only if a session is
    /// drawing from it at that moment. Rejected: a `watch` channel of snapshots. The channel would keep the
    /// snapshot alive, and every step would copy the game.
    view: Mutex<Option<Arc<RoomView>>>,
    /// The number of snapshots.
    snapshots: AtomicU64,
    /// The reason why the room is closed, if it is.
    closed: OnceLock<Arc<str>>,
    alarms: Mutex<Vec<Arc<StepAlarm>>>,
    /// How long the room stays open without members; `None` if it never closes.
    pub(crate) closes_after: watch::Sender<Option<Duration>>,
    /// The number of watchers.
    watchers: AtomicUsize,
    /// The invitation code of a private room.
    pub(crate) code: Option<RoomCode>,
}

/// Wakes a visitor's driver at the first step from a time on, so that the members of a room are drawn one after the
/// other, while the room is in the processor's cache. Rejected: a timer for each driver, which then waited for the
/// next step. Each frame took two turns of the driver.
#[derive(Debug, Default)]
pub(crate) struct StepAlarm(Mutex<Option<(Instant, Waker)>>);

impl StepAlarm {
    /// Wakes `waker` at the first step from `due` on, or when the room closes.
    pub(crate) fn set(&self, due: Instant, waker: &Waker) {
        locked(&self.0, |alarm| *alarm = Some((due, waker.clone())));
    }

    fn ring(&self, now: Instant, is_closed: bool) {
        let due = locked(&self.0, |alarm| alarm.take_if(|(due, _)| is_closed || *due <= now));
        if let Some((_, waker)) = due {
            waker.wake();
        }
    }
}

/// A room with its log. Only the sequencer changes them.
pub(crate) struct Sequencer {
    pub(crate) room: Room,
    pub(crate) log: RoundLog,
    pub(crate) interface: Arc<RoomInterface>,
    pub(crate) load: Arc<Load>,
}

impl Sequencer {
    /// Runs the room until it closes. Calls `on_change` when the room's entry in the lobby changes.
    ///
    /// # Errors
    /// The message of a panic. The room is closed then.
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

    /// Waits until somebody joins; returns false if the room has closed instead.
    async fn somebody_joins(&mut self) -> bool {
        self.log.flush();
        let RoomInterface { inbox, closes_after, .. } = &*self.interface;
        let mut patience = closes_after.subscribe();
        loop {
            let wait = *patience.borrow_and_update();
            tokio::select! {
                biased;
                () = inbox.joined() => return !inbox.is_closed(),
                // This cannot fail, because the interface owns the sender.
                _ = patience.changed() => {}
                () = sleep(wait.unwrap_or_default()), if wait.is_some() => {
                    if inbox.close_if_empty() {
                        self.interface.close("The room was empty and is closed.");
                    }
                    return !inbox.is_closed();
                }
            }
        }
    }

    /// Takes the steps that are due, and advances `next` to the time of the following step.
    fn catch_up(&mut self, next: &mut Instant, on_change: &mut impl FnMut(&Room)) {
        let now = Instant::now();
        self.load.note_lateness(now.saturating_duration_since(*next));
        for _ in 0..MAX_CAUGHT_UP {
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
        let changes = interface.replace_view(|| {
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
    /// The interface of `room`, which has no members yet. Unless `is_standing`, the room closes after
    /// `closes_after` without members. A room with a `code` is private.
    pub(crate) fn new(
        room: &Room,
        is_standing: bool,
        closes_after: Duration,
        code: Option<RoomCode>,
    ) -> Arc<Self> {
        let mode = room.header().mode;
        let closes_after = match mode {
            // Nobody else can continue a game that a member plays alone.
            Mode::Alone => Some(Duration::ZERO),
            _ => (!is_standing).then_some(closes_after),
        };
        Arc::new(Self {
            inbox: Inbox::new(mode, room.next_member()),
            view: Mutex::new(Some(Arc::new(room.view()))),
            snapshots: AtomicU64::new(0),
            closed: OnceLock::new(),
            alarms: Mutex::default(),
            closes_after: watch::Sender::new(closes_after),
            watchers: AtomicUsize::new(0),
            code,
        })
    }

    /// Closes the room for everybody. `sentence` states the reason.
    pub(crate) fn close(&self, sentence: &str) {
        self.inbox.close();
        self.closed.get_or_init(|| sentence.into());
        self.ring_alarms();
    }

    /// The latest snapshot. During a step, waits for the next one. `None` after a fault.
    pub(crate) fn view(&self) -> Option<Arc<RoomView>> {
        locked(&self.view, |view| view.clone())
    }

    /// The number of snapshots up to now.
    pub(crate) fn snapshots(&self) -> u64 {
        self.snapshots.load(Ordering::Acquire)
    }

    /// The reason why the room is closed, if it is.
    pub(crate) fn closed(&self) -> Option<&Arc<str>> {
        self.closed.get()
    }

    /// A new alarm.
    pub(crate) fn alarm(&self) -> Arc<StepAlarm> {
        let alarm = Arc::<StepAlarm>::default();
        locked(&self.alarms, |alarms| alarms.push(Arc::clone(&alarm)));
        alarm
    }

    pub(crate) fn remove_alarm(&self, alarm: &Arc<StepAlarm>) {
        locked(&self.alarms, |alarms| alarms.retain(|it| !Arc::ptr_eq(it, alarm)));
    }

    fn ring_alarms(&self) {
        let (now, is_closed) = (Instant::now(), self.closed.get().is_some());
        locked(&self.alarms, |alarms| alarms.iter().for_each(|it| it.ring(now, is_closed)));
    }

    /// Runs `step` and replaces the snapshot with its result.
    pub(crate) fn replace_view<T>(&self, step: impl FnOnce() -> (RoomView, T)) -> T {
        let result = locked(&self.view, |shown| {
            *shown = None;
            let (view, result) = step();
            *shown = Some(Arc::new(view));
            result
        });
        self.snapshots.fetch_add(1, Ordering::AcqRel);
        self.ring_alarms();
        result
    }

    pub(crate) fn watchers(&self) -> usize {
        self.watchers.load(Ordering::Acquire)
    }

    /// Adds a watcher if there are fewer than `most`; returns whether it did.
    pub(crate) fn add_watcher(&self, most: usize) -> bool {
        let more = |count| (count < most).then_some(count + 1);
        self.watchers.fetch_update(Ordering::AcqRel, Ordering::Acquire, more).is_ok()
    }

    pub(crate) fn remove_watcher(&self) {
        self.watchers.fetch_sub(1, Ordering::AcqRel);
    }
}

/// The message of a panic.
pub(crate) fn message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied();
    let text = text.or_else(|| panic.downcast_ref().map(String::as_str));
    text.unwrap_or("a panic without a message").to_owned()
}

/// A recording of a room's log.
pub(crate) trait Recording: Send {
    /// Begins a round.
    ///
    /// # Errors
    /// If the header cannot be written.
    fn begin(&mut self, header: &Header) -> io::Result<()>;

    /// Appends an entry, whose step is not before the step of the previous entry.
    ///
    /// # Errors
    /// If the entry cannot be written.
    fn append(&mut self, entry: &Entry) -> io::Result<()>;

    /// Draws the room for the cast, every [`cast::INTERVAL`] steps.
    ///
    /// # Errors
    /// If the picture cannot be written.
    fn look(&mut self, _: &RoomView) -> io::Result<()> {
        Ok(())
    }

    /// Writes out the entries that are buffered in memory.
    ///
    /// # Errors
    /// If they cannot be written.
    fn flush(&mut self) -> io::Result<()>;
}

/// The log of a round, by which a room takes its steps. If the room is recorded, all entries of a step are
/// written before they change the room.
pub(crate) struct RoundLog {
    recording: Option<Box<dyn Recording>>,
    /// The recording that begins with the next round.
    next: Option<Box<dyn Recording>>,
    /// Whether a write error was reported. A full disk is reported only once.
    has_failed: bool,
    run: SoloRun,
}

/// A level that a member has won while playing alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FinishedRun {
    pub(crate) member: MemberId,
    /// The name of the level.
    pub(crate) level: String,
    /// The script, not verified yet.
    pub(crate) script: String,
}

/// The changes of a step.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// The number of entries.
    pub(crate) entries: u64,
    /// Whether the room's entry in the lobby changes.
    pub(crate) summary: bool,
    pub(crate) finished: Option<FinishedRun>,
}

/// The intents of a member who plays alone, since the start of the round.
#[derive(Debug, Default)]
struct SoloRun {
    stretches: Vec<Stretch>,
    is_finished: bool,
}

/// The number of steps between flushes of a recording. A killed server loses at most the entries of one second.
const FLUSHED: u64 = STEPS_PER_SECOND as u64;

impl RoundLog {
    /// Begins the log of the current round of `room`.
    pub(crate) fn new(recording: Option<Box<dyn Recording>>, room: &Room) -> Self {
        let mut log = Self::of_next_round(recording);
        log.begin(room);
        log
    }

    /// A log that is recorded from the next round on.
    pub(crate) fn of_next_round(recording: Option<Box<dyn Recording>>) -> Self {
        Self { recording: None, next: recording, has_failed: false, run: SoloRun::default() }
    }

    /// Takes a step: turns the commands from `take` into entries, applies them to the room, and advances it.
    pub(crate) fn step(
        &mut self,
        room: &mut Room,
        take: impl FnOnce(&mut dyn FnMut(MemberId, Command)),
    ) -> Changes {
        let mut changes = Changes::default();
        if room.is_over() {
            room.begin_next();
            self.begin(room);
            changes.summary = true;
        }
        let step = room.step();
        let mut entries = Vec::new();
        take(&mut |member, command| entries.push(Entry { step, member, command }));
        for entry in &entries {
            self.record(|recording| recording.append(entry));
        }
        if step.is_multiple_of(FLUSHED) {
            self.flush();
        }
        let count = room.len();
        for entry in &entries {
            changes.summary |= matches!(entry.command, Command::Join { .. } | Command::Leave);
            room.apply(entry);
        }
        changes.entries = entries.len() as u64;
        let phase = room.phase();
        room.advance();
        if room.step().is_multiple_of(cast::INTERVAL) {
            self.record(|recording| recording.look(&room.view()));
        }
        changes.summary |= phase != room.phase() || count != room.len();
        if room.header().mode == Mode::Alone {
            changes.finished = self.run.step(room);
        }
        changes
    }

    /// Writes out the entries that are buffered in memory.
    pub(crate) fn flush(&mut self) {
        self.record(|recording| recording.flush());
    }

    fn begin(&mut self, room: &Room) {
        self.run = SoloRun::default();
        self.recording = self.next.take().or(self.recording.take());
        self.record(|recording| recording.begin(room.header()));
    }

    fn record(&mut self, write: impl FnOnce(&mut dyn Recording) -> io::Result<()>) {
        if let Some(recording) = &mut self.recording
            && let Err(error) = write(&mut **recording)
            && !self.has_failed
        {
            self.has_failed = true;
            tracing::error!(%error, "a recording of a room cannot be written");
        }
    }
}

impl Changes {
    /// Merges the changes of a later step into these.
    pub(crate) fn add(&mut self, later: Self) {
        self.entries += later.entries;
        self.summary |= later.summary;
        self.finished = later.finished.or(self.finished.take());
    }
}

impl SoloRun {
    /// Records the step that the room has taken; returns the run once the member has reached the exit.
    fn step(&mut self, room: &Room) -> Option<FinishedRun> {
        let (member, player, intents) = room.first_member().filter(|_| !self.is_finished)?;
        self.record(intents);
        let outcome = room.game().seen_by(player)?.outcome();
        self.is_finished = outcome == Outcome::Won;
        let level = &room.header().level;
        self.is_finished.then(|| FinishedRun {
            member,
            level: level.clone(),
            script: self.script(room),
        })
    }

    fn record(&mut self, intents: Intents) {
        match self.stretches.last_mut() {
            Some(last) if last.intents == intents && last.steps < Stretch::MAX_STEPS => {
                last.steps += 1;
            }
            _ => self.stretches.push(Stretch { steps: 1, intents }),
        }
    }

    fn script(&self, room: &Room) -> String {
        let header = room.header();
        let rules =
            Rules { difficulty: header.difficulty, seed: header.mode.game_seed(header.seed) };
        let header = game::Header::of(LevelName::new(&header.level), rules);
        let mut text = Vec::new();
        let mut recorder = ScriptWriter::with_header(&mut text, header);
        for stretch in &self.stretches {
            // Writing to memory cannot fail.
            _ = recorder.record(stretch.intents, u64::from(stretch.steps));
        }
        drop(recorder);
        String::from_utf8(text).unwrap_or_default()
    }
}

/// The duration of a step.
pub(crate) const STEP: Duration = Duration::from_nanos(1_000_000_000 / STEPS_PER_SECOND as u64);
/// The maximum number of queued changes of intents per member.
const MAX_INTENTS: usize = 8;
/// The maximum number of queued arrivals and departures. All of them take effect in the next step.
const MAX_MOVES: usize = 64;

/// The commands of a room's members that the sequencer has not taken yet.
///
/// Each member has a bounded queue, so that a flood from one member never delays another. Rejected: one queue
/// for all members. A single member could fill it.
///
/// Intents take effect in the order of arrival, one change per step, so that a tap begins and ends in
/// separate steps. If [`MAX_INTENTS`] changes are queued, a new one replaces the last. Sessions limit the
/// rate of changes, and drivers the rate of talk.
#[derive(Debug)]
pub(crate) struct Inbox {
    waiting: Mutex<InboxState>,
    joined: Notify,
}

#[derive(Debug)]
struct InboxState {
    is_closed: bool,
    most: usize,
    next: u32,
    /// Members who have joined, including members that the room does not know yet.
    seats: Vec<InboxSeat>,
    /// The number of seats that were ever taken.
    seats_taken: u64,
    moves: VecDeque<(MemberId, Command)>,
    finished: Option<FinishedRun>,
}

#[derive(Debug)]
struct InboxSeat {
    id: MemberId,
    /// A number unique to this seat. A member who loses their seat and returns gets another one.
    number: u64,
    color: PlayerColor,
    intents: VecDeque<Command>,
    talk: VecDeque<Command>,
}

impl Inbox {
    /// The inbox of a room without members, whose next member is `next`.
    pub(crate) fn new(mode: Mode, next: MemberId) -> Self {
        let waiting = InboxState {
            is_closed: false,
            most: mode.most(),
            next: next.0,
            seats: Vec::new(),
            seats_taken: 0,
            moves: VecDeque::new(),
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

    /// Assigns a seat to a member who has joined on another host.
    pub(crate) fn admit(&self, id: MemberId, color: PlayerColor) {
        locked(&self.waiting, |waiting| {
            waiting.next = waiting.next.max(id.0.saturating_add(1));
            waiting.seat(id, color);
        });
    }

    /// Removes the seat of a member who is no longer in the room.
    pub(crate) fn dismiss(&self, id: MemberId) {
        locked(&self.waiting, |waiting| waiting.seats.retain(|seat| seat.id != id));
    }

    /// Members with a seat.
    pub(crate) fn seated(&self) -> Vec<MemberId> {
        locked(&self.waiting, |waiting| waiting.seats.iter().map(|seat| seat.id).collect())
    }

    /// Removes a member's seat and lets the member leave.
    pub(crate) fn leave(&self, id: MemberId) {
        self.unseat(id, Command::Leave);
    }

    /// Removes the seat of a member whose host is shutting down. The room keeps their place.
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

    /// Takes a member's command. Returns false if there is no such member, or members cannot send this command.
    pub(crate) fn act(&self, id: MemberId, command: Command) -> bool {
        locked(&self.waiting, |waiting| {
            let seat = waiting.seats.iter_mut().find(|seat| seat.id == id);
            seat.is_some_and(|seat| seat.act(command))
        })
    }

    /// The number of a member's seat, which is never reused; `None` if they have no seat.
    pub(crate) fn seat_number(&self, id: MemberId) -> Option<u64> {
        locked(&self.waiting, |waiting| {
            waiting.seats.iter().find(|seat| seat.id == id).map(|seat| seat.number)
        })
    }

    /// Returns true if a member is about to join or leave.
    pub(crate) fn has_moves(&self) -> bool {
        locked(&self.waiting, |waiting| !waiting.moves.is_empty())
    }

    /// Marks a member away. They keep their seat until the room removes them.
    pub(crate) fn set_away(&self, id: MemberId) {
        locked(&self.waiting, |waiting| {
            if let Some(seat) = waiting.seats.iter_mut().find(|seat| seat.id == id) {
                seat.intents.clear();
                seat.talk.clear();
            }
            waiting.moves.push_back((id, Command::Away));
        });
    }

    /// Adds a command that keeps a member's seat, or brings the member back on another host.
    pub(crate) fn push_move(&self, id: MemberId, command: Command) {
        locked(&self.waiting, |waiting| waiting.moves.push_back((id, command)));
    }

    /// Returns true if the room has no members and nobody is about to join or leave.
    pub(crate) fn is_empty(&self) -> bool {
        locked(&self.waiting, |waiting| waiting.seats.is_empty() && waiting.moves.is_empty())
    }

    /// Waits until somebody joins or the room closes.
    pub(crate) async fn joined(&self) {
        while self.is_empty() && !self.is_closed() {
            self.joined.notified().await;
        }
    }

    pub(crate) fn is_closed(&self) -> bool {
        locked(&self.waiting, |waiting| waiting.is_closed)
    }

    /// Closes the room to new members.
    pub(crate) fn close(&self) {
        locked(&self.waiting, |waiting| waiting.is_closed = true);
        self.joined.notify_one();
    }

    /// Closes the room if it has no members; returns whether it is closed.
    pub(crate) fn close_if_empty(&self) -> bool {
        locked(&self.waiting, |waiting| {
            waiting.is_closed |= waiting.seats.is_empty();
            waiting.is_closed
        })
    }

    /// Stores a run until its member collects it.
    pub(crate) fn finish(&self, run: FinishedRun) {
        locked(&self.waiting, |waiting| waiting.finished = Some(run));
    }

    /// The run that a member has finished since the last call, if any.
    pub(crate) fn finished(&self, id: MemberId) -> Option<FinishedRun> {
        locked(&self.waiting, |waiting| waiting.finished.take_if(|run| run.member == id))
    }

    /// Passes on the commands that take effect in the next step, in order.
    pub(crate) fn take(&self, mut pass: impl FnMut(MemberId, Command)) {
        locked(&self.waiting, |waiting| {
            waiting.moves.drain(..).for_each(|(id, command)| pass(id, command));
            for seat in &mut waiting.seats {
                let intents = seat.intents.pop_front();
                intents.into_iter().chain(seat.talk.drain(..)).for_each(|it| pass(seat.id, it));
            }
        });
    }
}

impl InboxState {
    fn join(&mut self, name: &Line) -> Result<MemberId, RoomRefusal> {
        if self.is_closed {
            return Err(RoomRefusal::Gone);
        }
        if self.seats.len() >= self.most || self.moves.len() >= MAX_MOVES {
            return Err(RoomRefusal::Full);
        }
        let worn = |color: &PlayerColor| self.seats.iter().filter(|it| it.color == *color).count();
        let color = PlayerColor::ALL.into_iter().min_by_key(worn).ok_or(RoomRefusal::Full)?;
        let id = MemberId(self.next);
        if id > MemberId::MAX {
            return Err(RoomRefusal::Full);
        }
        self.next += 1;
        self.moves.push_back((id, Command::Join { color, name: name.clone() }));
        self.seat(id, color);
        Ok(id)
    }

    fn seat(&mut self, id: MemberId, color: PlayerColor) {
        self.seats_taken += 1;
        self.seats.push(InboxSeat {
            id,
            number: self.seats_taken,
            color,
            intents: VecDeque::new(),
            talk: VecDeque::new(),
        });
    }
}

impl InboxSeat {
    fn act(&mut self, command: Command) -> bool {
        match command {
            Command::Intents { .. } => {
                if self.intents.len() >= MAX_INTENTS {
                    self.intents.pop_back();
                }
                self.intents.push_back(command);
            }
            Command::Day(_) => {
                self.talk.retain(|waiting| !matches!(waiting, Command::Day(_)));
                self.talk.push_back(command);
            }
            Command::Say(_) | Command::Emote(_) | Command::Again => self.talk.push_back(command),
            Command::Join { .. }
            | Command::Leave
            | Command::Keep
            | Command::Away
            | Command::Return { .. } => return false,
        }
        true
    }
}

#[cfg(test)]
mod tests;
