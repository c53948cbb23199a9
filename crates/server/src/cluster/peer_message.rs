//! Messages that the replicas of a room broadcast to each other.
//!
//! The first line names the kind; for some kinds, more lines follow:
//!
//! ```text
//! appended 18240
//! commands
//! claim 1 4 7
//! join 9f3ac1 kept Mara
//! joined 9f3ac1 7 red
//! full 9f3ac1
//! return 9f3ac2 7
//! taken 9f3ac2
//! released
//! ```
//!
//! A message may be lost, come twice, or come late. Claims and requests to join or to return are repeated; appended messages
//! that are missing are read from the log; commands that are lost are lost, as input of a player whose connection
//! stalls.

use std::fmt::Write;

use super::log_message::{self, LogMessage, Unreadable};
use crate::rooms::room::{Command, Entry, MemberId, NAME_COLUMNS};
use crate::sessions::line::Line;
use cellcaster::game::PlayerColor;

/// A broadcast to the replicas of a room.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PeerMessage {
    /// A message that the log has, with its number.
    Appended(u64, LogMessage),
    /// Commands of the members on a host that is not the sequencer.
    Commands(Vec<(MemberId, Command)>),
    /// The members on the host that sends it.
    Claim(Vec<MemberId>),
    /// A request to join, and whether the place is kept. The token identifies it.
    Join(u64, bool, Line),
    /// The answer: they are in the log.
    Joined(u64, MemberId, PlayerColor),
    /// The answer: the room is full.
    Full(u64),
    /// A request to return to a member. The token identifies it, and the log has it if it is granted.
    Return(u64, MemberId),
    /// The answer: the member has a host.
    Taken(u64),
    /// The sender has released the lease of the room.
    Released,
}

impl PeerMessage {
    /// The message as bytes.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        match self {
            Self::Appended(number, message) => {
                let mut bytes = format!("appended {number}\n").into_bytes();
                bytes.extend(message.to_bytes());
                bytes
            }
            Self::Commands(commands) => {
                let mut text = "commands\n".to_owned();
                for (member, command) in commands {
                    let entry = Entry { step: 0, member: *member, command: command.clone() };
                    // Memory accepts every byte.
                    _ = writeln!(text, "{entry}");
                }
                text.into_bytes()
            }
            Self::Claim(members) => {
                let words: Vec<String> = members.iter().map(MemberId::to_string).collect();
                format!("claim {}\n", words.join(" ")).into_bytes()
            }
            Self::Join(token, is_kept, name) => {
                let place = if *is_kept { "kept" } else { "guest" };
                format!("join {token:x} {place} {name}\n").into_bytes()
            }
            Self::Joined(token, member, color) => {
                format!("joined {token:x} {member} {}\n", color.name()).into_bytes()
            }
            Self::Full(token) => format!("full {token:x}\n").into_bytes(),
            Self::Return(token, member) => format!("return {token:x} {member}\n").into_bytes(),
            Self::Taken(token) => format!("taken {token:x}\n").into_bytes(),
            Self::Released => b"released\n".to_vec(),
        }
    }

    /// Reads the bytes of a message.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, Unreadable> {
        let line = bytes.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let rest = bytes.get(line.len() + 1..).unwrap_or_default();
        let line = str::from_utf8(line).map_err(|_| Unreadable::Damaged)?;
        if let Some(number) = line.strip_prefix("appended ") {
            let number = log_message::number(number).ok_or(Unreadable::Damaged)?;
            return LogMessage::parse(rest).map(|message| Self::Appended(number, message));
        }
        Self::read(line, rest).ok_or(Unreadable::Damaged)
    }

    fn read(line: &str, rest: &[u8]) -> Option<Self> {
        let (verb, words) = line.split_once(' ').unwrap_or((line, ""));
        let token = |word| u64::from_str_radix(word, 16).ok();
        let member = MemberId::parse;
        match verb {
            "commands" => {
                let lines = str::from_utf8(rest).ok()?.lines().map(Entry::parse);
                let commands = lines.map(|entry| entry.map(|entry| (entry.member, entry.command)));
                Some(Self::Commands(commands.collect::<Option<_>>()?))
            }
            "claim" => {
                let words = words.split_ascii_whitespace();
                Some(Self::Claim(words.map(member).collect::<Option<_>>()?))
            }
            "join" => {
                let [word, place, name] =
                    words.splitn(3, ' ').collect::<Vec<_>>().try_into().ok()?;
                let is_kept = match place {
                    "kept" => true,
                    "guest" => false,
                    _ => return None,
                };
                Some(Self::Join(token(word)?, is_kept, Line::of(name, NAME_COLUMNS)?))
            }
            "joined" => {
                let [word, id, color] = words.splitn(3, ' ').collect::<Vec<_>>().try_into().ok()?;
                let color = PlayerColor::ALL.into_iter().find(|it| it.name() == color)?;
                Some(Self::Joined(token(word)?, member(id)?, color))
            }
            "full" => Some(Self::Full(token(words)?)),
            "return" => {
                let (word, id) = words.split_once(' ')?;
                Some(Self::Return(token(word)?, member(id)?))
            }
            "taken" => Some(Self::Taken(token(words)?)),
            "released" if words.is_empty() => Some(Self::Released),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::game::Intents;

    #[test]
    fn what_is_written_reads_as_the_same() {
        let message =
            LogMessage { epoch: 1, last: 0, tick: 0, steps: 0, check: None, entries: Vec::new() };
        let name = Line::of("a b", NAME_COLUMNS).unwrap();
        let want = Command::Intents { seen: 3, intents: Intents::new() };
        let commands = vec![(MemberId(1), want), (MemberId(2), Command::Leave)];
        for message in [
            PeerMessage::Appended(9, message),
            PeerMessage::Commands(commands),
            PeerMessage::Claim(vec![MemberId(1), MemberId(7)]),
            PeerMessage::Claim(Vec::new()),
            PeerMessage::Join(u64::MAX, true, name.clone()),
            PeerMessage::Join(3, false, name),
            PeerMessage::Joined(7, MemberId(3), PlayerColor::ALL[2]),
            PeerMessage::Full(0),
            PeerMessage::Return(u64::MAX, MemberId(3)),
            PeerMessage::Taken(7),
            PeerMessage::Released,
        ] {
            assert_eq!(PeerMessage::parse(&message.to_bytes()), Ok(message));
        }
    }

    #[test]
    fn other_bytes_say_nothing() {
        for bytes in [
            "",
            "join",
            "join x a",
            "join 1 x a",
            "return 1",
            "released 1",
            "joined 1 2",
            "claim x",
            "claim 4294967295",
            "appended 18446744073709551615",
            "commands\nx",
            "\n",
        ] {
            assert_eq!(PeerMessage::parse(bytes.as_bytes()), Err(Unreadable::Damaged), "{bytes}");
        }
    }
}
