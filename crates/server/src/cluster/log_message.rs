//! Messages of a room's log.
//!
//! A message is a line of numbers, and a line for each entry:
//!
//! ```text
//! 2.2 3 18231 5400 2 5400 9f3ac1
//! 0 want 7 5399 forward
//! ```
//!
//! The line has the versions of the format and of the rules, the epoch of the sequencer, the number of the
//! message before, the number of steps that the room has taken in all its rounds, and how many it takes now; then,
//! once a second, a number of steps and the checksum of the room after them. The step of an entry is counted from the first one of the
//! message. A message without steps begins an epoch.
//!
//! Steps of the round were refused: a sequencer would have to know when the round ends before it does.

use std::fmt::Write;

use crate::rooms::room::Entry;
use cellcaster::game::RULES_VERSION;
use cellcaster::game::stored::MOST_COUNT;

/// The version of the format of messages, records and checkpoints.
const FORMAT: u32 = 2;
/// The most steps of a message: ten seconds.
pub(crate) const MOST_STEPS: u64 = 600;

/// A message of a room's log.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LogMessage {
    /// The epoch of the sequencer.
    pub(crate) epoch: u64,
    /// The number of the message before; 0 for none.
    pub(crate) last: u64,
    /// The steps that the room has taken before.
    pub(crate) tick: u64,
    /// The steps that it takes.
    pub(crate) steps: u64,
    /// The checksum of the room after a number of steps.
    pub(crate) check: Option<Check>,
    /// Their steps are counted from the first one of the message.
    pub(crate) entries: Vec<Entry>,
}

/// The checksum of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Check {
    /// The steps that the room has taken.
    pub(crate) tick: u64,
    pub(crate) sum: u64,
}

/// Why bytes are no message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unreadable {
    /// They are of another version.
    OtherVersion,
    Damaged,
}

impl LogMessage {
    /// The message as bytes.
    pub(crate) fn to_bytes(&self) -> Vec<u8> {
        let Self { epoch, last, tick, steps, check, entries } = self;
        let mut text = format!("{} {epoch} {last} {tick} {steps}", version());
        // Memory accepts every byte.
        if let Some(Check { tick, sum }) = check {
            _ = write!(text, " {tick} {sum:x}");
        }
        text.push('\n');
        for entry in entries {
            _ = writeln!(text, "{entry}");
        }
        text.into_bytes()
    }

    /// Whether another message can follow in this one.
    pub(crate) fn has_room(&self, next: &Self) -> bool {
        self.steps + next.steps <= MOST_STEPS
    }

    /// Appends the steps of the message that follows. Its checksum is left out.
    pub(crate) fn merge(&mut self, next: Self) {
        let steps = self.steps;
        self.entries
            .extend(next.entries.into_iter().map(|it| Entry { step: it.step + steps, ..it }));
        self.steps += next.steps;
    }

    /// The message of those bytes.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, Unreadable> {
        let text = str::from_utf8(bytes).map_err(|_| Unreadable::Damaged)?;
        let (head, rest) = text.split_once('\n').ok_or(Unreadable::Damaged)?;
        let (found, numbers) = head.split_once(' ').ok_or(Unreadable::Damaged)?;
        if found != version() {
            return Err(Unreadable::OtherVersion);
        }
        Self::read(numbers, rest).ok_or(Unreadable::Damaged)
    }

    fn read(numbers: &str, entries: &str) -> Option<Self> {
        let mut words = numbers.split(' ');
        let mut next = || number(words.next()?);
        let [epoch, last, tick, steps] = [next()?, next()?, next()?, next()?];
        let check = match (words.next(), words.next(), words.next()) {
            (None, ..) => None,
            (Some(tick), Some(sum), None) => {
                Some(Check { tick: number(tick)?, sum: u64::from_str_radix(sum, 16).ok()? })
            }
            _ => return None,
        };
        let entries: Vec<Entry> = entries.lines().map(Entry::parse).collect::<Option<_>>()?;
        let is_possible = steps <= MOST_STEPS && entries.iter().all(|entry| entry.step < steps);
        is_possible.then_some(Self { epoch, last, tick, steps, check, entries })
    }
}

/// Reads a number of messages, steps or epochs; `None` for one that no room reaches.
pub(crate) fn number(word: &str) -> Option<u64> {
    word.parse().ok().filter(|number| *number <= MOST_COUNT)
}

/// The versions of the format and of the rules.
pub(crate) fn version() -> String {
    format!("{FORMAT}.{RULES_VERSION}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::room::{Command, MemberId};

    fn message(check: Option<Check>, entries: Vec<Entry>) -> LogMessage {
        LogMessage { epoch: 3, last: 18_231, tick: 5_400, steps: 2, check, entries }
    }

    #[test]
    fn what_is_written_reads_as_the_same() {
        let leave = Entry { step: 1, member: MemberId(7), command: Command::Leave };
        let check = Check { tick: 5_399, sum: u64::MAX };
        for message in [message(None, Vec::new()), message(Some(check), vec![leave])] {
            assert_eq!(LogMessage::parse(&message.to_bytes()), Ok(message));
        }
        assert_eq!(message(None, Vec::new()).to_bytes().len(), 19);
    }

    #[test]
    fn what_is_damaged_or_of_another_version_is_told() {
        let text = |head: &str| LogMessage::parse(format!("{head}\n").as_bytes());
        let version = version();
        for head in [
            "3 1 1",
            "3 1 1 601",
            "3 1 1 2 9",
            "3 1 1 2 9 x",
            "3 1 1 2 9 a b",
            "3 1 1 2\n5 leave 1",
            "18446744073709551615 1 1 2",
            "3 18446744073709551615 1 2",
            "3 1 18446744073709551615 2",
        ] {
            assert_eq!(text(&format!("{version} {head}")), Err(Unreadable::Damaged), "{head}");
        }
        assert_eq!(text("0.1 3 1 1 2"), Err(Unreadable::OtherVersion));
        assert_eq!(LogMessage::parse(b"\xff"), Err(Unreadable::Damaged));
    }
}
