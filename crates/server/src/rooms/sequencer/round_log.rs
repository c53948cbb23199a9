//! The log of a round: a room takes its steps by it, and it may be recorded.
//!
//! - All entries of a step are recorded before they change the room.
//! - A recording that cannot be written is reported once, and the room goes on.

use std::io;

use crate::rooms::room::{Command, Entry, Header, MemberId, Mode, Room};
use cellcaster::game::{
    self, Intents, LevelName, Outcome, Recorder, Rules, STEPS_PER_SECOND, Stretch,
};

/// A recording of a room's log.
pub(crate) trait Recording: Send {
    /// Begins a round.
    ///
    /// # Errors
    /// If the header cannot be written.
    fn begin(&mut self, header: &Header) -> io::Result<()>;

    /// Adds an entry, whose step is not before the step of the last entry.
    ///
    /// # Errors
    /// If the entry cannot be written.
    fn append(&mut self, entry: &Entry) -> io::Result<()>;

    /// Writes out what waits in memory.
    ///
    /// # Errors
    /// If it cannot be written.
    fn flush(&mut self) -> io::Result<()>;
}

/// The log of a round, by which a room takes its steps.
pub(crate) struct RoundLog {
    recording: Option<Box<dyn Recording>>,
    /// Whether a fault was reported, so that a full disk is reported once.
    has_failed: bool,
    run: Run,
}

/// A level that somebody has won alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FinishedRun {
    pub(crate) member: MemberId,
    /// The name of the level.
    pub(crate) level: String,
    /// The script, which is still to be verified.
    pub(crate) script: String,
}

/// The changes of a step.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// The number of entries.
    pub(crate) entries: u64,
    /// Whether a lobby would show the room otherwise.
    pub(crate) summary: bool,
    pub(crate) finished: Option<FinishedRun>,
}

/// The intents of a member who plays alone, from the start of the round.
#[derive(Debug, Default)]
struct Run {
    stretches: Vec<Stretch>,
    is_finished: bool,
}

/// The steps after which a recording is written out: a killed server loses at most the entries of a
/// second.
const FLUSHED: u64 = STEPS_PER_SECOND as u64;

impl RoundLog {
    /// Begins the log of the round that `room` is in.
    pub(crate) fn new(recording: Option<Box<dyn Recording>>, room: &Room) -> Self {
        let mut log = Self { recording, has_failed: false, run: Run::default() };
        log.begin(room);
        log
    }

    /// Takes a step: the commands that `take` passes on become entries, the entries change the room, and the room
    /// advances.
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
        changes.summary |= phase != room.phase() || count != room.len();
        if room.header().mode == Mode::Alone {
            changes.finished = self.run.step(room);
        }
        changes
    }

    /// Writes out what waits in memory.
    pub(crate) fn flush(&mut self) {
        self.record(|recording| recording.flush());
    }

    fn begin(&mut self, room: &Room) {
        self.run = Run::default();
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
    /// Adds the changes of a later step.
    pub(crate) fn add(&mut self, later: Self) {
        self.entries += later.entries;
        self.summary |= later.summary;
        self.finished = later.finished.or(self.finished.take());
    }
}

impl Run {
    /// Records the step that the room has taken; returns the run when it has reached the exit.
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
            Some(last) if last.intents == intents && last.steps < Stretch::MOST_STEPS => {
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
        let mut recorder = Recorder::with_header(&mut text, header);
        for stretch in &self.stretches {
            // Memory accepts every byte.
            _ = recorder.record(stretch.intents, u64::from(stretch.steps));
        }
        drop(recorder);
        String::from_utf8(text).unwrap_or_default()
    }
}
