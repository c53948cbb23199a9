//! Steps of a room from its log, and the script of a run that counts.

use std::io;

use crate::rooms::room::{Command, Entry, Log, MemberId, Mode, Room};
use cellcaster::game::{
    self, Intents, LevelName, Outcome, Recorder, Rules, STEPS_PER_SECOND, Stretch,
};

/// The log of a room, from which it takes its steps.
pub(crate) struct RoundLog {
    log: Box<dyn Log>,
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

/// What a step has changed.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// The entries that the step has.
    pub(crate) entries: u64,
    /// Whether a lobby would show the room otherwise.
    pub(crate) summary: bool,
    pub(crate) finished: Option<FinishedRun>,
}

/// What a member who plays alone has wanted in the round so far.
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
    pub(crate) fn new(log: Box<dyn Log>, room: &Room) -> Self {
        let mut log = Self { log, has_failed: false, run: Run::default() };
        log.begin(room);
        log
    }

    /// Takes a step: what `take` passes on becomes entries, the entries change the room, and the room
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
        take(&mut |member, command| {
            let result = self.log.append(Entry { step, member, command });
            self.report(result);
        });
        if step.is_multiple_of(FLUSHED) {
            let result = self.log.flush();
            self.report(result);
        }
        let count = room.len();
        while let Some(entry) = self.log.next(step) {
            changes.summary |= matches!(entry.command, Command::Join { .. } | Command::Leave);
            room.apply(&entry);
            changes.entries += 1;
        }
        let phase = room.phase();
        room.advance();
        changes.summary |= phase != room.phase() || count != room.len();
        if room.header().mode == Mode::Alone {
            changes.finished = self.run.step(room);
        }
        changes
    }

    /// Writes out what waits in memory, since no step follows for a while.
    pub(crate) fn flush(&mut self) {
        let result = self.log.flush();
        self.report(result);
    }

    fn begin(&mut self, room: &Room) {
        self.run = Run::default();
        let result = self.log.begin(room.header());
        self.report(result);
    }

    /// Reports the first fault of the log: it is one of a recording, without which the room goes on.
    fn report(&mut self, result: io::Result<()>) {
        if let Err(error) = result
            && !self.has_failed
        {
            self.has_failed = true;
            tracing::error!(%error, "a recording of a room cannot be written");
        }
    }
}

impl Changes {
    /// Adds what a later step has changed.
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
