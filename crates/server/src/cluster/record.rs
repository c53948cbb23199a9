//! Records of rooms: what every host knows of a room, also without a replica of it.
//!
//! ```text
//! 2.2 standing running 17
//! playing 5400
//! museum
//! name Mara
//! cellcaster-room 2
//! …
//! ```
//!
//! The first line has the versions, whether the room is a standing one, whether a host runs it, and the heartbeat.
//! The phase, the level, the names of the members, and the header with which the log begins follow.

use std::sync::Arc;

use super::log_message::{number, version};
use crate::rooms::room::{Header, NAME_COLUMNS, Phase, Room};
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::line::Line;

/// The record of a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Record {
    /// Whether the room is always there.
    pub(crate) stands: bool,
    /// Whether a host runs it.
    pub(crate) is_running: bool,
    /// The number of records that were put so far, which grows while a host runs the room.
    pub(crate) heartbeat: u64,
    phase: Phase,
    names: Arc<[Line]>,
    /// The level of the present round.
    level: String,
    /// The header with which the log begins, as long as there is no checkpoint.
    pub(crate) header: Header,
}

impl Record {
    /// That of a room that nobody has entered yet.
    pub(crate) fn new(header: Header, stands: bool) -> Self {
        let (names, level) = (Arc::from([]), header.level.clone());
        Self {
            stands,
            is_running: !stands,
            heartbeat: 0,
            phase: Phase::Waiting,
            names,
            level,
            header,
        }
    }

    /// The next one, of the room as it is.
    pub(crate) fn next(self, room: &Room, is_running: bool) -> Self {
        let (phase, names) = (room.phase(), room.names().cloned().collect());
        let level = room.header().level.clone();
        Self { is_running, heartbeat: self.heartbeat + 1, phase, names, level, ..self }
    }

    /// The level of the present round.
    pub(crate) fn level(&self) -> &str {
        &self.level
    }

    /// The room as lobbies show it, without those who watch.
    pub(crate) fn summary(&self, id: RoomId) -> RoomSummary {
        RoomSummary {
            id,
            level: self.level.clone(),
            mode: self.header.mode,
            difficulty: self.header.difficulty,
            phase: self.phase,
            members: Arc::clone(&self.names),
            watchers: 0,
        }
    }

    /// The record as bytes.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let stands = if self.stands { "standing" } else { "opened" };
        let running = if self.is_running { "running" } else { "idle" };
        let (phase, ends) = match self.phase {
            Phase::Waiting => ("waiting", 0),
            Phase::Countdown { ends } => ("countdown", ends),
            Phase::Playing { ends } => ("playing", ends),
            Phase::Over { ends } => ("over", ends),
        };
        let names: Vec<String> = self.names.iter().map(|name| format!("name {name}\n")).collect();
        let names = names.concat();
        let Self { heartbeat, level, header, .. } = self;
        format!(
            "{} {stands} {running} {heartbeat}\n{phase} {ends}\n{level}\n{names}{header}",
            version()
        )
        .into_bytes()
    }

    /// The record of those bytes; `None` if they are none, or of another version.
    pub(crate) fn parse(bytes: &[u8]) -> Option<Self> {
        let mut lines = str::from_utf8(bytes).ok()?.lines().peekable();
        let words: Vec<&str> = lines.next()?.split(' ').collect();
        let [found, stands, running, heartbeat] = words.try_into().ok()?;
        (found == version()).then_some(())?;
        let (phase, ends) = lines.next()?.split_once(' ')?;
        let ends = number(ends)?;
        let phase = match phase {
            "waiting" => Phase::Waiting,
            "countdown" => Phase::Countdown { ends },
            "playing" => Phase::Playing { ends },
            "over" => Phase::Over { ends },
            _ => return None,
        };
        let level = lines.next()?.to_owned();
        let mut names = Vec::new();
        while let Some(line) = lines.next_if(|line| line.starts_with("name ")) {
            names.push(Line::of(line.strip_prefix("name ")?, NAME_COLUMNS)?);
        }
        Some(Self {
            stands: stands == "standing",
            is_running: running == "running",
            heartbeat: number(heartbeat)?,
            phase,
            names: names.into(),
            level,
            header: Header::parse(lines)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::room::Mode;
    use cellcaster::world::Difficulty;

    #[test]
    fn what_is_written_reads_as_the_same() {
        let header = Header::new("museum", Mode::Tag, Difficulty::Hard, 77);
        let new = Record::new(header, true);
        let names = ["Mara", "a b"].map(|name| Line::of(name, NAME_COLUMNS).unwrap());
        let used = Record {
            stands: false,
            is_running: true,
            heartbeat: 9,
            phase: Phase::Playing { ends: 99 },
            names: names.into(),
            ..new.clone()
        };
        for record in [new, used] {
            let bytes = record.to_bytes();
            assert_eq!(Record::parse(&bytes).as_ref(), Some(&record));
            let other = [b"0.0".as_slice(), &bytes[version().len()..]].concat();
            assert_eq!(Record::parse(&other), None);
            let text = String::from_utf8(bytes).unwrap();
            let beyond =
                text.replacen(&format!(" {}\n", record.heartbeat), " 18446744073709551615\n", 1);
            assert_ne!(beyond, text);
            assert_eq!(Record::parse(beyond.as_bytes()), None);
        }
    }
}
