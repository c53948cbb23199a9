//! The log of a room: the header of each round and the entries after it.
//!
//! Nothing else changes a room, so the header and the entries reproduce the round, bit for bit. Rejected:
//! hosts that exchange the states of rooms. A state has a thousand times the bytes of the members' intents.
//!
//! In a recording, a log is text:
//!
//! ```text
//! cellcaster-room 2
//! level museum
//! mode tag
//! difficulty normal
//! seed 77
//! round 3
//! next 2
//! member 1 red 250 Mara
//! 12 want 1 9 forward run turn:1.5
//! 40 say 1 behind you
//! 41 emote 1 wave
//! 90 leave 1
//! 95 join 2 green Jon
//! 99 day 2 2026-11-28
//! ```
//!
//! A `member` line contains a member's number, colour, points and name. In clusters, a line such as `kept 1 1f 300`
//! follows for each member with an account: the number, the token of the latest return, and for a member who is away
//! the steps until they leave.
//!
//! An entry begins with the step before which it takes effect, then a verb and the member's number. In
//! `want`, the next number is the step of the frame that the member saw. The angles of `want` apply in one
//! step only. Its other intents last until the member's next `want`. A hand at rest therefore turns nobody,
//! however late the client says so. `day` tells a room with a daily level of a later day.

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
const VERSION: &str = "2";

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

    /// Parses the lines of a header; `None` if a line is invalid.
    fn parse<'t>(lines: impl IntoIterator<Item = &'t str>) -> Option<Self> {
        let mut lines = lines.into_iter();
        (lines.next()?.strip_prefix(ROOM_RECORDING)? == VERSION).then_some(())?;
        let mut value = |name: &str| lines.next()?.strip_prefix(name)?.strip_prefix(' ');
        let level = value("level")?.to_owned();
        let mode = Mode::named(value("mode")?)?;
        let difficulty = Difficulty::named(value("difficulty")?)?;
        let seed = value("seed")?.parse().ok()?;
        let round = value("round")?.parse().ok()?;
        let next_member = value("next")?.parse().ok()?;
        let mut members: Vec<Seat> = Vec::new();
        for line in lines {
            if let Some(kept) = line.strip_prefix("kept ") {
                let (id, place) = kept_place(kept)?;
                members.iter_mut().find(|seat| seat.id == id)?.kept = Some(place);
            } else {
                members.push(Seat::parse(line)?);
            }
        }
        let header = Self { level, mode, difficulty, seed, round, next_member, members };
        header.is_possible().then_some(header)
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
        writeln!(f, "{ROOM_RECORDING}{VERSION}\nlevel {}\nmode {}", self.level, self.mode.name())?;
        writeln!(f, "difficulty {}\nseed {}", self.difficulty.name(), self.seed)?;
        writeln!(f, "round {}\nnext {}", self.round, self.next_member)?;
        self.members.iter().try_for_each(|seat| writeln!(f, "{seat}"))?;
        let mut kept = self.members.iter().filter_map(|seat| Some((seat.id, seat.kept?)));
        kept.try_for_each(|(id, KeptPlace { token, away })| {
            write!(f, "kept {id} {token:x}")?;
            away.map_or(Ok(()), |steps| write!(f, " {steps}"))?;
            writeln!(f)
        })
    }
}

/// Parses the rest of a `kept` line.
fn kept_place(rest: &str) -> Option<(MemberId, KeptPlace)> {
    let mut words = rest.split(' ');
    let id = MemberId::parse(words.next()?)?;
    let token = u64::from_str_radix(words.next()?, 16).ok()?;
    let away = words.next().map(|steps| steps.parse().ok());
    let away = away.map_or(Some(None), |steps: Option<u64>| steps.map(Some))?;
    words.next().is_none().then_some((id, KeptPlace { token, away }))
}

impl Seat {
    fn parse(line: &str) -> Option<Self> {
        let mut words = line.strip_prefix("member ")?.splitn(4, ' ');
        let id = MemberId::parse(words.next()?)?;
        let color = color_named(words.next()?)?;
        let points = words.next()?.parse().ok()?;
        Some(Self { id, color, points, name: Line::of(words.next()?, NAME_COLUMNS)?, kept: None })
    }
}

impl fmt::Display for Seat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { id, color, points, name, kept: _ } = self;
        write!(f, "member {id} {} {points} {name}", color.name())
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
    let first = text.lines().next().unwrap_or_default();
    first.strip_prefix(ROOM_RECORDING).is_some_and(|version| version != VERSION)
}

/// The header at the beginning of a recording. `text` is the first part of it.
pub(crate) fn first_header(text: &str) -> Option<Header> {
    let mut lines = text.lines();
    let first = lines.next()?;
    let rest = lines.take_while(|line| !is_entry(line) && !line.starts_with(ROOM_RECORDING));
    Header::parse(std::iter::once(first).chain(rest))
}

fn is_entry(line: &str) -> bool {
    line.starts_with(|first: char| first.is_ascii_digit())
}

/// Parses a recording into rounds: headers with their entries. `None` if a line is neither.
pub(crate) fn parse_log(text: &str) -> Option<Vec<(Header, Vec<Entry>)>> {
    let mut rounds = Vec::new();
    let mut lines = text.lines().peekable();
    while lines.peek().is_some() {
        let mut head = vec![lines.next()?];
        let goes_on = |line: &&str| !is_entry(line) && !line.starts_with(ROOM_RECORDING);
        head.extend(std::iter::from_fn(|| lines.next_if(goes_on)));
        let entries = std::iter::from_fn(|| lines.next_if(|line| is_entry(line))).map(Entry::parse);
        let entries = entries.collect::<Option<Vec<Entry>>>()?;
        rounds.push((Header::parse(head)?, entries));
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
        assert_eq!(Header::parse(text.lines()), Some(header));
        assert_eq!(Header::parse(text.lines().skip(1)), None);
    }

    #[test]
    fn impossible_headers_are_refused() {
        let read = |next: &str, rest: &str| {
            let text = format!(
                "{ROOM_RECORDING}{VERSION}\nlevel museum\nmode tag\ndifficulty hard\nseed 1\nround 1\nnext {next}\n{rest}"
            );
            Header::parse(text.lines())
        };
        assert!(read("2147483648", "member 2147483647 red 0 Mara").is_some());
        assert_eq!(read("2147483649", ""), None);
        assert_eq!(read("7", "member 7 red 0 Mara"), None);
        for kept in ["", " ", "1", "1 x", "1 7 x", "1 7 0", "1 7 99999999", "1 7 8 9", "2 7"] {
            assert_eq!(read("7", &format!("member 1 red 0 Mara\nkept {kept}")), None, "{kept}");
        }
        assert_eq!(read("7", "member 3 red 0 Mara\nmember 3 red 0 Bo"), None);
        let many: Vec<String> = (1..=99).map(|id| format!("member {id} red 0 Mara")).collect();
        assert_eq!(read("100", &many.join("\n")), None);
    }
}
