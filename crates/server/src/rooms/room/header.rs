//! The state of a room at the start of a round.
//!
//! ```text
//! cellcaster-room 2
//! level museum
//! mode tag
//! difficulty normal
//! seed 77
//! round 3
//! member 1 red 250 Mara
//! kept 1 9f3ac1 1200
//! ```
//!
//! A line for each member holds their number, colour, points and name. Lines for the places that are kept follow,
//! each with the number of the member, the token of the last return, and the steps that are left to one who is away.

use std::fmt;

use super::entry::{MemberId, NAME_COLUMNS};
use super::mode::Mode;
use super::presence::KeptPlace;
use crate::sessions::line::Line;
use cellcaster::game::PlayerColor;
use cellcaster::world::Difficulty;

/// The version of the format, and the first line of each log.
const FIRST_LINE: &str = "cellcaster-room 2";

/// The state of a room at the start of a round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Header {
    /// The name of the level in the catalog.
    pub(crate) level: String,
    /// What is played.
    pub(crate) mode: Mode,
    /// How hard it is.
    pub(crate) difficulty: Difficulty,
    /// The seed of all chance in the room.
    pub(crate) seed: u64,
    /// The number of the round, from 1.
    pub(crate) round: u32,
    /// The number of the next member who joins.
    pub(crate) next_member: u32,
    /// The members at the start of the round, in the order of their numbers.
    pub(crate) members: Vec<Seat>,
}

/// A member at the start of a round.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Seat {
    pub(crate) id: MemberId,
    pub(crate) color: PlayerColor,
    /// The points of the rounds before.
    pub(crate) points: u32,
    pub(crate) name: Line,
    /// The place that is kept for the member; `None` if it is not.
    pub(crate) kept: Option<KeptPlace>,
}

impl Header {
    /// The header of a new room.
    pub(crate) fn new(level: &str, mode: Mode, difficulty: Difficulty, seed: u64) -> Self {
        let level = level.to_owned();
        Self { level, mode, difficulty, seed, round: 1, next_member: 1, members: Vec::new() }
    }

    /// Whether `text` begins with the header of another version, in whose rooms the same entries do something else.
    pub(crate) fn is_of_other_version(text: &str) -> bool {
        let first = text.lines().next().unwrap_or_default();
        first.starts_with("cellcaster-room ") && first != FIRST_LINE
    }

    /// Reads the lines of a header; `None` if a line is none of one.
    pub(crate) fn parse<'t>(lines: impl IntoIterator<Item = &'t str>) -> Option<Self> {
        let mut lines = lines.into_iter();
        (lines.next()? == FIRST_LINE).then_some(())?;
        let mut value = |name: &str| lines.next()?.strip_prefix(name)?.strip_prefix(' ');
        let level = value("level")?.to_owned();
        let mode = Mode::named(value("mode")?)?;
        let difficulty = value("difficulty")?;
        let difficulty = Difficulty::ALL.into_iter().find(|it| it.name() == difficulty)?;
        let [seed, round, next_member] = [value("seed")?, value("round")?, value("next")?];
        let mut members: Vec<Seat> = Vec::new();
        for line in lines {
            match line.strip_prefix("kept ") {
                Some(words) => read_kept(&mut members, words)?,
                None => members.push(Seat::parse(line)?),
            }
        }
        let (seed, round) = (seed.parse().ok()?, round.parse().ok()?);
        let next_member = MemberId::parse_next(next_member)?;
        let header = Self { level, mode, difficulty, seed, round, next_member, members };
        header.is_possible().then_some(header)
    }

    /// Whether each member has a number of their own, which was given before.
    fn is_possible(&self) -> bool {
        let is_possible = |(index, seat): (usize, &Seat)| {
            seat.id.0 < self.next_member
                && self.members[..index].iter().all(|other| other.id != seat.id)
                && seat.kept.is_none_or(KeptPlace::is_possible)
        };
        self.members.len() <= self.mode.most() && self.members.iter().enumerate().all(is_possible)
    }
}

impl fmt::Display for Header {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{FIRST_LINE}\nlevel {}\nmode {}", self.level, self.mode.name())?;
        writeln!(f, "difficulty {}\nseed {}", self.difficulty.name(), self.seed)?;
        writeln!(f, "round {}\nnext {}", self.round, self.next_member)?;
        self.members.iter().try_for_each(|seat| writeln!(f, "{seat}"))?;
        self.members.iter().try_for_each(|seat| write_kept(f, seat))
    }
}

impl Seat {
    fn parse(line: &str) -> Option<Self> {
        let mut words = line.strip_prefix("member ")?.splitn(4, ' ');
        let id = MemberId::parse(words.next()?)?;
        let color = words.next()?;
        let color = PlayerColor::ALL.into_iter().find(|it| it.name() == color)?;
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

/// Writes the line of the place that is kept for a member, if it is.
fn write_kept(f: &mut fmt::Formatter<'_>, seat: &Seat) -> fmt::Result {
    match seat.kept {
        None => Ok(()),
        Some(KeptPlace { token, away: None }) => writeln!(f, "kept {} {token:x}", seat.id),
        Some(KeptPlace { token, away: Some(left) }) => {
            writeln!(f, "kept {} {token:x} {left}", seat.id)
        }
    }
}

/// Reads such a line after its first word.
fn read_kept(members: &mut [Seat], words: &str) -> Option<()> {
    let mut words = words.split(' ');
    let id = MemberId::parse(words.next()?)?;
    let token = u64::from_str_radix(words.next()?, 16).ok()?;
    let away = match words.next() {
        Some(left) => Some(left.parse().ok()?),
        None => None,
    };
    let seat = members.iter_mut().find(|seat| seat.id == id)?;
    seat.kept = Some(KeptPlace { token, away });
    words.next().is_none().then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_as_the_same() {
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
        header.members = vec![seat(1, 250, "Mara"), seat(7, 0, "a b c")];
        header.members[0].kept = Some(KeptPlace { token: u64::MAX, away: None });
        header.members[1].kept = Some(KeptPlace { token: 0, away: Some(1_200) });
        header.next_member = 9;
        let text = header.to_string();
        assert_eq!(Header::parse(text.lines()), Some(header));
        assert_eq!(Header::parse(text.lines().skip(1)), None);
    }

    #[test]
    fn what_no_room_reaches_is_no_header() {
        let read = |next: &str, rest: &str| {
            let text = format!(
                "{FIRST_LINE}\nlevel museum\nmode tag\ndifficulty hard\nseed 1\nround 1\nnext {next}\n{rest}"
            );
            Header::parse(text.lines())
        };
        assert!(read("2147483648", "member 2147483647 red 0 Mara").is_some());
        assert_eq!(read("2147483649", ""), None);
        assert_eq!(read("7", "member 7 red 0 Mara"), None);
        assert_eq!(read("7", "member 3 red 0 Mara\nmember 3 red 0 Bo"), None);
        assert_eq!(read("7", "member 3 red 0 Mara\nkept 3 1 3601"), None);
        let many: Vec<String> = (1..=99).map(|id| format!("member {id} red 0 Mara")).collect();
        assert_eq!(read("100", &many.join("\n")), None);
    }
}
