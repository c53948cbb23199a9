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
    if is_of_other_version(text) {
        return Err("it was recorded by another version of Cellcaster".to_owned());
    }
    let rounds = parse_log(text).ok_or("a line is neither part of a header nor an entry")?;
    let last = rounds.len().saturating_sub(1);
    let rounds = rounds.iter().enumerate();
    rounds
        .map(|(index, (header, entries))| play(catalog, (header, entries), index == last, look))
        .collect()
}

fn play(
    catalog: &Arc<Catalog>,
    (header, entries): (&Header, &[Entry]),
    is_last: bool,
    look: &mut dyn FnMut(&Room) -> Result<(), String>,
) -> Result<RoundReport, String> {
    let no_level = || no_level(&header.level);
    let mut room = Room::new(catalog, header.clone()).ok_or_else(no_level)?;
    let end = entries.last().map_or(0, |entry| entry.step);
    let mut entries = entries.iter().peekable();
    let mut last = 0;
    loop {
        while let Some(entry) = entries.next_if(|entry| entry.step <= room.step()) {
            room.apply(entry);
            last = room.step();
        }
        let next = entries.peek().map_or(room.step(), |entry| entry.step);
        let is_over = if is_last { room.step() >= end } else { room.is_over() };
        if is_over && entries.peek().is_none() {
            return Ok(report(&room, header));
        }
        if next - last > MAX_QUIET || cfg!(feature = "fuzzing") && room.step() >= MAX_FUZZED {
            let round = header.round;
            return Err(format!("nothing happens in round {round} for longer than a day"));
        }
        look(&room)?;
        room.advance();
    }
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
