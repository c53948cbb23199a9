//! Entries of a room's log: the commands of its members, each with its step.
//!
//! An entry is a line of text:
//!
//! ```text
//! 0 join 1 red Mara
//! 12 want 1 9 forward run turn:1.5
//! 40 say 1 behind you
//! 41 emote 1 wave
//! 41 keep 1
//! 80 away 1
//! 85 return 1 9f3ac1
//! 90 leave 1
//! ```
//!
//! The first number is the step, before which the entry takes effect; the second is the member. The
//! number after them in `want` is the step in the picture that the member saw. Its angles count in
//! one step, the rest of it until the next `want` of the member: a hand that rests turns nobody,
//! however late the client says so.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::sessions::line::Line;
use cellcaster::game::{Intents, PlayerColor};

/// The number of a member in a room. It is not used again after they leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "u32")]
pub(crate) struct MemberId(pub(crate) u32);

impl MemberId {
    /// The greatest number, which a room that somebody joins each second reaches in 68 years.
    pub(crate) const MOST: Self = Self(i32::MAX as u32);

    /// Reads a number; `None` for one that no room reaches.
    pub(crate) fn parse(word: &str) -> Option<Self> {
        word.parse().ok().map(Self).filter(|id| *id <= Self::MOST)
    }

    /// Reads the number of the next member who joins, which may be one more.
    pub(crate) fn parse_next(word: &str) -> Option<u32> {
        word.parse().ok().filter(|next| *next <= Self::MOST.0 + 1)
    }
}

impl TryFrom<u32> for MemberId {
    type Error = &'static str;

    fn try_from(number: u32) -> Result<Self, &'static str> {
        if number <= Self::MOST.0 { Ok(Self(number)) } else { Err("a member") }
    }
}

impl fmt::Display for MemberId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

/// An entry of a room's log.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    /// The step of the round before which it takes effect.
    pub(crate) step: u64,
    /// Whose entry it is.
    pub(crate) member: MemberId,
    /// The member's command.
    pub(crate) command: Command,
}

/// A command of a member.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Command {
    /// Enters the room.
    Join { color: PlayerColor, name: Line },
    /// Leaves the room.
    Leave,
    /// Has an account, so that their place is kept while they are away.
    Keep,
    /// Is away: their host is gone.
    Away,
    /// Returns from another host. The token is that of no other return.
    Return { token: u64 },
    /// Sets the intents from now on, after a picture of the step `seen` of the game. The angles count in
    /// the next step only.
    Intents { seen: u64, intents: Intents },
    /// Says something to all.
    Say(Line),
    /// Shows all an emotion.
    Emote(Emote),
    /// Wishes to begin the round again, which happens when all do.
    Again,
}

/// The widest line of chat, in columns.
pub(crate) const CHAT_COLUMNS: usize = 60;
/// The widest name, in columns.
pub(crate) const NAME_COLUMNS: usize = 16;

/// An emotion, or a gesture.
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

impl Emote {
    /// All of them, in the order of their keys.
    pub(crate) const ALL: [Self; 6] =
        [Self::Wave, Self::Yes, Self::No, Self::Laugh, Self::Help, Self::Here];

    /// The name in logs.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Wave => "wave",
            Self::Yes => "yes",
            Self::No => "no",
            Self::Laugh => "laugh",
            Self::Help => "help",
            Self::Here => "here",
        }
    }

    /// What others read beside the name.
    pub(crate) const fn text(self) -> &'static str {
        match self {
            Self::Wave => "waves",
            Self::Yes => "nods",
            Self::No => "shakes their head",
            Self::Laugh => "laughs",
            Self::Help => "calls for help",
            Self::Here => "calls: over here!",
        }
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
            Command::Emote(emote) => write!(f, "{step} emote {member} {}", emote.name()),
        }
    }
}

impl Entry {
    /// Reads a line; `None` if it is no entry.
    pub(crate) fn parse(line: &str) -> Option<Self> {
        let (step, rest) = line.split_once(' ')?;
        let (verb, rest) = rest.split_once(' ')?;
        let (member, rest) = rest.split_once(' ').unwrap_or((rest, ""));
        let command = match verb {
            "join" => {
                let (color, name) = rest.split_once(' ')?;
                let color = PlayerColor::ALL.into_iter().find(|it| it.name() == color)?;
                Command::Join { color, name: Line::of(name, NAME_COLUMNS)? }
            }
            "leave" if rest.is_empty() => Command::Leave,
            "keep" if rest.is_empty() => Command::Keep,
            "away" if rest.is_empty() => Command::Away,
            "return" => Command::Return { token: u64::from_str_radix(rest, 16).ok()? },
            "again" if rest.is_empty() => Command::Again,
            "want" => {
                let (seen, words) = rest.split_once(' ')?;
                Command::Intents { seen: seen.parse().ok()?, intents: Intents::from_words(words)? }
            }
            "say" => Command::Say(Line::of(rest, CHAT_COLUMNS)?),
            "emote" => Command::Emote(Emote::ALL.into_iter().find(|it| it.name() == rest)?),
            _ => return None,
        };
        Some(Self { step: step.parse().ok()?, member: MemberId::parse(member)?, command })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
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
            (any::<u64>(), intents).prop_map(|(seen, intents)| Command::Intents { seen, intents }),
            line(CHAT_COLUMNS).prop_map(Command::Say),
            prop::sample::select(&Emote::ALL).prop_map(Command::Emote),
        ]
    }

    proptest! {
        #[test]
        fn what_is_written_reads_as_the_same(
            step: u64,
            member in 0..=MemberId::MOST.0,
            command in command(),
        ) {
            let entry = Entry { step, member: MemberId(member), command };
            prop_assert_eq!(Entry::parse(&entry.to_string()), Some(entry));
        }

        #[test]
        fn no_line_is_a_fault_of_the_program(line in any::<String>()) {
            Entry::parse(&line);
        }
    }

    #[test]
    fn other_lines_are_no_entries() {
        for line in [
            "",
            "0",
            "0 join 1",
            "0 join 1 plaid Mara",
            "x leave 1",
            "0 want 1 2 fly",
            "0 away 1 x",
            "0 leave 2147483648",
        ] {
            assert_eq!(Entry::parse(line), None, "{line}");
        }
    }
}
