//! What hosts say to each other in a room.
//!
//! A line says what it is; for some, more lines follow:
//!
//! ```text
//! news 18240
//! wants
//! claim 1 4 7
//! join 9f3ac1 Mara
//! joined 9f3ac1 7 amber
//! full 9f3ac1
//! ```
//!
//! Each of them may be lost, come twice, or come late. Claims and questions are said again; news that are
//! missing are read in the log; a change of intents that is lost is followed by others, as keys are.

use std::fmt::Write;

use super::message::{Message, Unreadable};
use crate::game::PlayerColor;
use crate::server::line::Line;
use crate::server::room::{Deed, Entry, MemberId, NAME_COLUMNS};

/// Something that is said in a room.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Talk {
    /// A message of the log, with its number.
    News(u64, Message),
    /// What members on another host than the sequencer's want.
    Wants(Vec<(MemberId, Deed)>),
    /// Members whose players are on the host that says so.
    Claim(Vec<MemberId>),
    /// Somebody would like to join. The token names the question.
    Join(u64, Line),
    /// They have joined: the log has it.
    Joined(u64, MemberId, PlayerColor),
    /// They cannot join.
    Full(u64),
}

impl Talk {
    /// It as bytes.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        match self {
            Self::News(number, message) => {
                let mut bytes = format!("news {number}\n").into_bytes();
                bytes.extend(message.to_bytes());
                bytes
            }
            Self::Wants(wants) => {
                let mut text = "wants\n".to_owned();
                for (member, deed) in wants {
                    let entry = Entry { step: 0, member: *member, deed: deed.clone() };
                    // Memory accepts every byte.
                    _ = writeln!(text, "{entry}");
                }
                text.into_bytes()
            }
            Self::Claim(members) => {
                let words: Vec<String> = members.iter().map(MemberId::to_string).collect();
                format!("claim {}\n", words.join(" ")).into_bytes()
            }
            Self::Join(token, name) => format!("join {token:x} {name}\n").into_bytes(),
            Self::Joined(token, member, color) => {
                format!("joined {token:x} {member} {}\n", color.name()).into_bytes()
            }
            Self::Full(token) => format!("full {token:x}\n").into_bytes(),
        }
    }

    /// What those bytes say.
    pub(super) fn parse(bytes: &[u8]) -> Result<Self, Unreadable> {
        let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let rest = bytes.get(line.len() + 1..).unwrap_or_default();
        let line = str::from_utf8(line).map_err(|_| Unreadable::Damaged)?;
        if let Some(number) = line.strip_prefix("news ") {
            let number = number.parse().map_err(|_| Unreadable::Damaged)?;
            return Message::parse(rest).map(|message| Self::News(number, message));
        }
        Self::read(line, rest).ok_or(Unreadable::Damaged)
    }

    fn read(line: &str, rest: &[u8]) -> Option<Self> {
        let (verb, words) = line.split_once(' ').unwrap_or((line, ""));
        let token = |word| u64::from_str_radix(word, 16).ok();
        let member = |word: &str| word.parse().ok().map(MemberId);
        match verb {
            "wants" => {
                let lines = str::from_utf8(rest).ok()?.lines().map(Entry::parse);
                let wants = lines.map(|entry| entry.map(|entry| (entry.member, entry.deed)));
                Some(Self::Wants(wants.collect::<Option<_>>()?))
            }
            "claim" => {
                let words = words.split_ascii_whitespace();
                Some(Self::Claim(words.map(member).collect::<Option<_>>()?))
            }
            "join" => {
                let (word, name) = words.split_once(' ')?;
                Some(Self::Join(token(word)?, Line::of(name, NAME_COLUMNS)?))
            }
            "joined" => {
                let [word, id, color] = words.splitn(3, ' ').collect::<Vec<_>>().try_into().ok()?;
                let color = PlayerColor::ALL.into_iter().find(|it| it.name() == color)?;
                Some(Self::Joined(token(word)?, member(id)?, color))
            }
            "full" => Some(Self::Full(token(words)?)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::Intents;

    #[test]
    fn what_is_written_reads_as_the_same() {
        let message =
            Message { epoch: 1, last: 0, tick: 0, steps: 0, check: None, entries: Vec::new() };
        let name = Line::of("a b", NAME_COLUMNS).unwrap();
        let want = Deed::Want { seen: 3, intents: Intents::new() };
        let wants = vec![(MemberId(1), want), (MemberId(2), Deed::Leave)];
        for talk in [
            Talk::News(9, message),
            Talk::Wants(wants),
            Talk::Claim(vec![MemberId(1), MemberId(7)]),
            Talk::Claim(Vec::new()),
            Talk::Join(u64::MAX, name),
            Talk::Joined(7, MemberId(3), PlayerColor::ALL[2]),
            Talk::Full(0),
        ] {
            assert_eq!(Talk::parse(&talk.to_bytes()), Ok(talk));
        }
    }

    #[test]
    fn other_bytes_say_nothing() {
        for bytes in ["", "join", "join x a", "joined 1 2", "claim x", "wants\nx", "\n"] {
            assert_eq!(Talk::parse(bytes.as_bytes()), Err(Unreadable::Damaged), "{bytes}");
        }
    }
}
