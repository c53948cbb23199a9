//! Replaying recorded rooms.
//!
//! The time that a recording takes is bounded by its entries: between two of them, and after the last one, at most
//! [`MAX_QUIET`] steps pass. Rejected: a limit on the length of a round. A round of tag begins when a second member
//! comes, and a standing room may wait for days until then.

use std::sync::Arc;

use crate::rooms::room::{
    Catalog, Entry, Header, Mode, Room, SECOND, is_of_other_version, no_level, parse_log,
};

/// The maximum size of a room's recording, both written and replayed, in bytes.
pub(crate) const MAX_RECORDED_BYTES: u64 = 64 << 20;

/// The result of a recorded round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct RoundReport {
    /// The number of the round, from 1.
    pub(crate) round: u32,
    pub(crate) level: String,
    pub(crate) mode: Mode,
    /// The length of the recorded round, in steps.
    pub(crate) steps: u64,
    /// The names with their points in the round, winner first. If the round did not end: all members, with 0 points.
    pub(crate) standings: Vec<(String, u32)>,
    /// The checksum of the room's last state. It is the same on every machine.
    pub(crate) checksum: u64,
}

/// The maximum number of steps without an entry: a day and an hour. A member leaves after a day without a key, the
/// greatest limit that a host can set, and a room without members takes no steps.
const MAX_QUIET: u64 = 25 * 60 * 60 * SECOND;
/// The maximum length of a round in a fuzz target, where it takes time from other inputs: 20 seconds.
const MAX_FUZZED: u64 = 20 * SECOND;

/// Replays the rounds of a recording. Each round lasts until the next one begins, and the last round until
/// its last entry. `look` receives the room before each step.
///
/// # Errors
/// A sentence fragment, if the text is not a recording, has another version, or needs a level that is not in
/// the catalog; or the first error of `look`.
pub(crate) fn replayed(
    text: &str,
    catalog: &Arc<Catalog>,
    look: &mut dyn FnMut(&Room) -> Result<(), String>,
) -> Result<Vec<RoundReport>, String> {
    let mut replay = RoomReplay::new(text, catalog)?;
    let mut reports = Vec::new();
    loop {
        while replay.is_playing()? {
            look(&replay.room)?;
            replay.room.advance();
        }
        reports.push(report(&replay.room, replay.room.header()));
        if !replay.next_round()? {
            return Ok(reports);
        }
    }
}

/// The replay of a recording, at one of its steps. Clones share the recording.
#[derive(Clone, Debug)]
pub(crate) struct RoomReplay {
    catalog: Arc<Catalog>,
    rounds: Arc<[(Header, Vec<Entry>)]>,
    /// The room in the current round.
    pub(crate) room: Room,
    /// The index of the round, and of its next entry.
    round: usize,
    next: usize,
    /// The step of the last entry.
    last: u64,
}

impl RoomReplay {
    /// The replay of `text`, before the first step.
    ///
    /// # Errors
    /// A sentence fragment, if the text is not a recording, has another version, or needs a level that is not in the
    /// catalog.
    pub(crate) fn new(text: &str, catalog: &Arc<Catalog>) -> Result<Self, String> {
        if is_of_other_version(text) {
            return Err("it was recorded by another version of Cellcaster".to_owned());
        }
        let rounds = parse_log(text).ok_or("a line is neither part of a header nor an entry")?;
        let (header, _) = rounds.first().ok_or("it is empty")?;
        let room = begin(catalog, header)?;
        let (catalog, rounds) = (Arc::clone(catalog), rounds.into());
        Ok(Self { catalog, rounds, room, round: 0, next: 0, last: 0 })
    }

    /// The headers of all rounds.
    pub(crate) fn headers(&self) -> impl Iterator<Item = &Header> {
        self.rounds.iter().map(|(header, _)| header)
    }

    /// Applies the entries that are due. Returns true if the round has another step.
    ///
    /// # Errors
    /// A sentence fragment, if nothing happens in the round for too long.
    pub(crate) fn is_playing(&mut self) -> Result<bool, String> {
        let Self { rounds, room, round, next, last, .. } = self;
        let (header, entries) = &rounds[*round];
        while let Some(entry) = entries.get(*next).filter(|entry| entry.step <= room.step()) {
            room.apply(entry);
            *next += 1;
            *last = room.step();
        }
        let entry = entries.get(*next);
        let is_last = *round + 1 == rounds.len();
        let end = entries.last().map_or(0, |entry| entry.step);
        let is_over = if is_last { room.step() >= end } else { room.is_over() };
        if is_over && entry.is_none() {
            return Ok(false);
        }
        let step = entry.map_or(room.step(), |entry| entry.step);
        if step - *last > MAX_QUIET || cfg!(feature = "fuzzing") && room.step() >= MAX_FUZZED {
            let round = header.round;
            return Err(format!("nothing happens in round {round} for longer than a day"));
        }
        Ok(true)
    }

    /// Begins the next round. Returns false if there is none.
    ///
    /// # Errors
    /// A sentence fragment, if it needs a level that is not in the catalog.
    pub(crate) fn next_round(&mut self) -> Result<bool, String> {
        let Some((header, _)) = self.rounds.get(self.round + 1) else { return Ok(false) };
        self.room = begin(&self.catalog, header)?;
        (self.round, self.next, self.last) = (self.round + 1, 0, 0);
        Ok(true)
    }

    /// Takes the next step, of the next round if need be. Returns false if there is none.
    ///
    /// # Errors
    /// See [`is_playing`](Self::is_playing) and [`next_round`](Self::next_round).
    pub(crate) fn step(&mut self) -> Result<bool, String> {
        while !self.is_playing()? {
            if !self.next_round()? {
                return Ok(false);
            }
        }
        self.room.advance();
        Ok(true)
    }
}

/// The room at the beginning of a round.
fn begin(catalog: &Arc<Catalog>, header: &Header) -> Result<Room, String> {
    Room::new(catalog, header.clone()).ok_or_else(|| no_level(&header.level))
}

fn report(room: &Room, header: &Header) -> RoundReport {
    let view = room.view();
    let name = |id| view.member(id).map(|member| member.name.to_string());
    let ranked = view.standings.iter();
    let ranked = ranked.filter_map(|standing| Some((name(standing.member)?, standing.points)));
    let all = view.members.iter().map(|member| (member.name.to_string(), 0));
    let standings: Vec<_> = ranked.collect();
    RoundReport {
        round: header.round,
        level: header.level.clone(),
        mode: header.mode,
        steps: room.step(),
        standings: if standings.is_empty() { all.collect() } else { standings },
        checksum: room.checksum(),
    }
}
