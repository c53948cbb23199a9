//! The log of a room: the header of each round and the entries after it.
//!
//! Nothing else changes a room, so the header and the entries reproduce the round, bit for bit. Rejected:
//! hosts that exchange the states of rooms. A state has a thousand times the bytes of the members' intents.
//!
//! In a recording, a log is text. The line of a header contains it as JSON:
//!
//! ```text
//! cellcaster-room 3 {"level":"museum","mode":"Tag","difficulty":"Normal","seed":[77,0,0,0,0,0,0,0],"round":3,…}
//! 12 want 1 9 forward run turn:1.5
//! 40 say 1 behind you
//! 41 emote 1 wave
//! 90 leave 1
//! 95 join 2 green Jon
//! 99 day 2 2026-11-28
//! ```
//!
//! An entry begins with the step before which it takes effect, then a verb and the member's number. In
//! `want`, the next number is the step of the frame that the member saw. The angles of `want` apply in one
//! step only. Its other intents last until the member's next `want`. A hand at rest therefore turns nobody,
//! however late the client says so. `day` tells a room with a daily level of a later day.
//!
//! Rejected: entries as JSON. They are most of a recording, and would take twice as many bytes.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::member::{KeptPlace, MemberId, NAME_COLUMNS, line_within};
use super::mode::Mode;
use crate::accounts::Day;
use crate::line::Line;
use cellcaster::app::parts::{Choice, Value as _};
use cellcaster::cli::ROOM_RECORDING;
use cellcaster::game::stored::bits;
use cellcaster::game::{Intents, PlayerColor};
use cellcaster::world::Difficulty;

/// The widest line of chat, in columns.
pub(crate) const CHAT_COLUMNS: usize = 60;
/// The version of the format. It also changes when the same entries have a different effect.
const VERSION: &str = "3";

/// The state of a room at the start of a round.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Header {
    /// The name of the level in the catalog.
    pub(crate) level: String,
    pub(crate) mode: Mode,
    pub(crate) difficulty: Difficulty,
    /// The seed for all chance in the room.
    #[serde(with = "bits")]
    pub(crate) seed: u64,
    /// The number of the round, from 1.
    pub(crate) round: u32,
    /// The number that the next new member gets.
    pub(crate) next_member: u32,
    /// The members at the start of the round, ordered by number.
    pub(crate) members: Vec<Seat>,
}

/// A member at the start of a round.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Seat {
    pub(crate) id: MemberId,
    pub(crate) color: PlayerColor,
    /// The points from earlier rounds.
    pub(crate) points: u32,
    #[serde(deserialize_with = "line_within::<NAME_COLUMNS, _>")]
    pub(crate) name: Line,
    /// The seat that is kept for the member; `None` for a guest.
    pub(crate) kept: Option<KeptPlace>,
}

/// An entry of a room's log.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Entry {
    /// The step of the round before which the entry takes effect.
    pub(crate) step: u64,
    pub(crate) member: MemberId,
    pub(crate) command: Command,
}

/// A member's command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum Command {
    /// Enters the room.
    Join {
        color: PlayerColor,
        #[serde(deserialize_with = "line_within::<NAME_COLUMNS, _>")]
        name: Line,
    },
    /// Leaves the room.
    Leave,
    /// Keeps the member's seat while they are away, because they have an account.
    Keep,
    /// Marks the member away: their host is gone.
    Away,
    /// Returns from another host. Each return has a unique token.
    Return {
        #[serde(with = "bits")]
        token: u64,
    },
    /// Sets the intents from now on. `seen` is the step of the game in the frame that the member saw. The
    /// angles apply in the next step only.
    Intents { seen: u64, intents: Intents },
    /// Sends a chat line to everybody.
    Say(#[serde(deserialize_with = "line_within::<CHAT_COLUMNS, _>")] Line),
    /// Shows an emote to everybody.
    Emote(Emote),
    /// Asks to restart the round, which happens once all members have asked.
    Again,
    /// Tells the room the day, by the clock of the member's host. A room with a daily level plays the next round in
    /// the level of the latest day that it was told.
    Day(Day),
}

/// An emote: an emotion or a gesture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Emote {
    /// Greets, or says goodbye.
    Wave,
    /// Agrees.
    Yes,
    /// Disagrees.
    No,
    /// Laughs.
    Laugh,
    /// Calls for help.
    Help,
    /// Calls the others here.
    Here,
}

impl Header {
    /// The header of a new room.
    pub(crate) fn new(level: &str, mode: Mode, difficulty: Difficulty, seed: u64) -> Self {
        let level = level.to_owned();
        Self { level, mode, difficulty, seed, round: 1, next_member: 1, members: Vec::new() }
    }

    /// Parses the line of a header; `None` if it is invalid.
    fn parse(line: &str) -> Option<Self> {
        let json = line.strip_prefix(ROOM_RECORDING)?.strip_prefix(VERSION)?;
        serde_json::from_str(json).ok().filter(Self::is_possible)
    }

    /// Returns true if a room can begin with this header. Each member must have a unique number below `next_member`.
    pub(crate) fn is_possible(&self) -> bool {
        let is_possible = |(index, seat): (usize, &Seat)| {
            seat.id.0 < self.next_member
                && self.members[..index].iter().all(|other| other.id != seat.id)
                && seat.kept.is_none_or(KeptPlace::is_possible)
        };
        self.next_member <= MemberId::MAX.0 + 1
            && self.members.len() <= self.mode.most()
            && self.members.iter().enumerate().all(is_possible)
    }
}

impl fmt::Display for Header {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Texts and numbers always have a form in JSON.
        let json = serde_json::to_string(self).unwrap_or_default();
        writeln!(f, "{ROOM_RECORDING}{VERSION} {json}")
    }
}

impl Choice for Emote {
    const ALL: &'static [(Self, &'static str, &'static str)] = &[
        (Self::Wave, "wave", "waves"),
        (Self::Yes, "yes", "nods"),
        (Self::No, "no", "shakes their head"),
        (Self::Laugh, "laugh", "laughs"),
        (Self::Help, "help", "calls for help"),
        (Self::Here, "here", "calls: over here!"),
    ];
}

impl Emote {
    /// The text that others read after the member's name, as in "Mara waves".
    pub(crate) fn text(self) -> String {
        self.label()
    }
}

impl fmt::Display for Entry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, member, command } = self;
        match command {
            Command::Join { color, name } => {
                write!(f, "{step} join {member} {} {name}", color.name())
            }
            Command::Leave => write!(f, "{step} leave {member}"),
            Command::Keep => write!(f, "{step} keep {member}"),
            Command::Away => write!(f, "{step} away {member}"),
            Command::Return { token } => write!(f, "{step} return {member} {token:x}"),
            Command::Intents { seen, intents } => {
                write!(f, "{step} want {member} {seen} {}", intents.words())
            }
            Command::Say(line) => write!(f, "{step} say {member} {line}"),
            Command::Again => write!(f, "{step} again {member}"),
            Command::Day(day) => write!(f, "{step} day {member} {day}"),
            Command::Emote(emote) => write!(f, "{step} emote {member} {}", emote.name()),
        }
    }
}

impl Entry {
    /// Parses a line; `None` if it is not an entry.
    pub(crate) fn parse(line: &str) -> Option<Self> {
        let (step, rest) = line.split_once(' ')?;
        let (verb, rest) = rest.split_once(' ')?;
        let (member, rest) = rest.split_once(' ').unwrap_or((rest, ""));
        let command = match verb {
            "join" => {
                let (color, name) = rest.split_once(' ')?;
                Command::Join { color: color_named(color)?, name: Line::of(name, NAME_COLUMNS)? }
            }
            "leave" if rest.is_empty() => Command::Leave,
            "keep" if rest.is_empty() => Command::Keep,
            "away" if rest.is_empty() => Command::Away,
            "return" => Command::Return { token: u64::from_str_radix(rest, 16).ok()? },
            "again" if rest.is_empty() => Command::Again,
            "day" => Command::Day(Day::parse(rest)?),
            "want" => {
                let (seen, words) = rest.split_once(' ')?;
                Command::Intents { seen: seen.parse().ok()?, intents: Intents::from_words(words)? }
            }
            "say" => Command::Say(Line::of(rest, CHAT_COLUMNS)?),
            "emote" => Command::Emote(Emote::named(rest)?),
            _ => return None,
        };
        Some(Self { step: step.parse().ok()?, member: MemberId::parse(member)?, command })
    }
}

/// Returns true if `text` begins with the header of another version.
pub(crate) fn is_of_other_version(text: &str) -> bool {
    let version = text.strip_prefix(ROOM_RECORDING).and_then(|rest| rest.split_whitespace().next());
    version.is_some_and(|version| version != VERSION)
}

/// The header at the beginning of a recording. `text` is the first part of it.
pub(crate) fn first_header(text: &str) -> Option<Header> {
    Header::parse(text.lines().next()?)
}

/// Parses a recording into rounds: headers with their entries. `None` if a line is neither.
pub(crate) fn parse_log(text: &str) -> Option<Vec<(Header, Vec<Entry>)>> {
    let mut rounds: Vec<(Header, Vec<Entry>)> = Vec::new();
    for line in text.lines() {
        if line.starts_with(ROOM_RECORDING) {
            rounds.push((Header::parse(line)?, Vec::new()));
        } else {
            rounds.last_mut()?.1.push(Entry::parse(line)?);
        }
    }
    Some(rounds)
}

fn color_named(name: &str) -> Option<PlayerColor> {
    PlayerColor::ALL.into_iter().find(|color| color.name() == name)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::accounts::UnixTime;
    use cellcaster::game::{Intent, Look};

    fn command() -> impl Strategy<Value = Command> {
        let line =
            |columns| any::<String>().prop_filter_map("text", move |it| Line::of(&it, columns));
        let intents = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=5);
        let intents = (intents, any::<i16>(), any::<i16>()).prop_map(|(intents, turn, tilt)| {
            let look = Look { turn: turn.max(-i16::MAX), tilt: tilt.max(-i16::MAX) };
            intents.into_iter().collect::<Intents>().with_look(look)
        });
        prop_oneof![
            (prop::sample::select(&PlayerColor::ALL), line(NAME_COLUMNS))
                .prop_map(|(color, name)| Command::Join { color, name }),
            Just(Command::Leave),
            Just(Command::Keep),
            Just(Command::Away),
            any::<u64>().prop_map(|token| Command::Return { token }),
            Just(Command::Again),
            any::<u64>()
                .prop_map(|seconds| Command::Day(Day::of(UnixTime::new(seconds % (1 << 38))))),
            (any::<u64>(), intents).prop_map(|(seen, intents)| Command::Intents { seen, intents }),
            line(CHAT_COLUMNS).prop_map(Command::Say),
            prop::sample::select(Emote::ALL).prop_map(|it| Command::Emote(it.0)),
        ]
    }

    proptest! {
        #[test]
        fn entries_round_trip(
            step: u64,
            member in 0..=MemberId::MAX.0,
            command in command(),
        ) {
            let entry = Entry { step, member: MemberId(member), command };
            prop_assert_eq!(Entry::parse(&entry.to_string()), Some(entry));
        }

        #[test]
        fn no_line_panics(line in any::<String>()) {
            Entry::parse(&line);
        }
    }

    #[test]
    fn invalid_lines_are_not_entries() {
        for line in [
            "",
            "0",
            "0 join 1",
            "0 join 1 plaid Mara",
            "x leave 1",
            "0 want 1 2 fly",
            "0 away 1 x",
            "0 leave 2147483648",
            "0 day 1",
            "0 day 1 2026-02-30",
        ] {
            assert_eq!(Entry::parse(line), None, "{line}");
        }
    }

    #[test]
    fn headers_round_trip() {
        let seat = |id, points, name| {
            let name = Line::of(name, NAME_COLUMNS).unwrap();
            Seat {
                id: MemberId(id),
                color: PlayerColor::ALL[id as usize % 8],
                points,
                name,
                kept: None,
            }
        };
        let mut header = Header::new("museum", Mode::Tag, Difficulty::Hard, u64::MAX);
        header.members = vec![seat(1, 250, "Mara"), seat(7, 0, "a b c"), seat(8, 0, "Jon")];
        header.members[0].kept = Some(KeptPlace { token: u64::MAX, away: Some(300) });
        header.members[2].kept = Some(KeptPlace::default());
        header.next_member = 9;
        let text = header.to_string();
        assert_eq!(text.lines().count(), 1);
        assert_eq!(Header::parse(&text), Some(header));
        assert_eq!(Header::parse(&text[..text.len() - 2]), None);
    }

    #[test]
    fn impossible_headers_are_refused() {
        let read = |next: u32, members: &[(u32, KeptPlace)]| {
            let mut header = Header::new("museum", Mode::Tag, Difficulty::Hard, 1);
            header.next_member = next;
            let name = Line::of("Mara", NAME_COLUMNS).unwrap();
            header.members = members
                .iter()
                .map(|&(id, kept)| Seat {
                    id: MemberId(id),
                    color: PlayerColor::Red,
                    points: 0,
                    name: name.clone(),
                    kept: Some(kept),
                })
                .collect();
            Header::parse(&header.to_string())
        };
        let kept = KeptPlace::default();
        assert!(read(2_147_483_648, &[(2_147_483_647, kept)]).is_some());
        assert_eq!(read(2_147_483_649, &[]), None);
        assert_eq!(read(7, &[(7, kept)]), None);
        assert_eq!(read(7, &[(3, kept), (3, kept)]), None);
        for away in [0, 99_999_999] {
            assert_eq!(read(7, &[(1, KeptPlace { away: Some(away), ..kept })]), None, "{away}");
        }
        let many: Vec<_> = (1..=99).map(|id| (id, kept)).collect();
        assert_eq!(read(100, &many), None);
        for line in ["", "cellcaster-room 3", "cellcaster-room 3 {}", "cellcaster-room 2 {}"] {
            assert_eq!(Header::parse(line), None, "{line}");
        }
    }
}
