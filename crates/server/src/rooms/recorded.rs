//! Recordings of rooms, as `serve --record-room` writes them.

use std::sync::Arc;

use crate::rooms::maps::HostMaps;
use crate::rooms::room::{Catalog, replayed};

/// The largest recording that is played again.
pub const MOST_RECORDED_BYTES: u64 = 64 << 20;

/// What came out of a round that was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordedRound {
    /// The number of the round, from 1.
    pub number: u32,
    /// The mode and the level.
    pub about: String,
    /// The length, in steps.
    pub steps: u64,
    /// The names with the points of the round, the winner first.
    pub standings: Vec<(String, u32)>,
    /// The checksum of the room's last state. It is the same wherever the recording is played.
    pub checksum: u64,
}

/// Whether `text` begins as a recording of a room.
pub fn is_room_recording(text: &str) -> bool {
    text.starts_with("cellcaster-room ")
}

/// Plays a recording of a room again, in the built-in levels and in `maps`.
///
/// # Errors
/// A part of a sentence: why it cannot be played.
pub fn replay_room(text: &str, maps: &HostMaps) -> Result<Vec<RecordedRound>, String> {
    let catalog = Arc::new(Catalog::with(maps));
    let rounds = replayed(text, &catalog)?.into_iter();
    Ok(rounds
        .map(|round| RecordedRound {
            number: round.round,
            about: format!("{} in {}", round.mode.title(), catalog.title(&round.level)),
            steps: round.steps,
            standings: round.standings,
            checksum: round.checksum,
        })
        .collect())
}
