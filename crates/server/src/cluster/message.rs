//! Messages and records: the bytes that the hosts of a cluster write for each other.
//!
//! They begin with the versions of the format and of the rules, and continue like a
//! [stored game](cellcaster::game::stored): no bytes make a host fail.
//!
//! - A [`LogMessage`] is a part of a room's log.
//! - A [`PeerMessage`] is a broadcast to the replicas of a room. It may be lost, duplicated or late. Claims and
//!   requests are repeated. Missing messages of the log are read from the log. Lost commands stay lost, like the keys
//!   of a player whose connection stalls.
//! - A [`Record`] describes a room to hosts without a replica.

use serde::{Deserialize, Serialize};

use crate::line::Line;
use crate::rooms::invitation::RoomCode;
use crate::rooms::room::{
    Command, Entry, Header, MemberId, NAME_COLUMNS, Phase, Room, line_within,
};
use crate::rooms::summary::{RoomId, RoomRefusal, RoomSummary};
use cellcaster::game::stored::{Reader, RestoreError, appended, bits, check};
use cellcaster::game::{PlayerColor, RULES_VERSION};

/// The version of the format of messages, records and checkpoints.
const FORMAT: u32 = 4;
/// The most steps in a message: ten seconds.
const MAX_STEPS: u64 = 600;

/// A message of a room's log. A message without steps begins an epoch.
///
/// Rejected: counting steps from the start of the round. A sequencer would have to know the end of a round before the
/// round ends.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LogMessage {
    /// The epoch of the sequencer.
    pub(crate) epoch: u64,
    /// The number of the previous message; 0 for none.
    pub(crate) last: u64,
    /// The steps that the room took before this message, in all its rounds.
    pub(crate) tick: u64,
    /// The steps that this message adds.
    pub(crate) steps: u64,
    /// A checksum of the room, once a second.
    pub(crate) check: Option<Check>,
    /// The entries. Their steps count from the first step of the message.
    pub(crate) entries: Vec<Entry>,
}

/// The checksum of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Check {
    /// The steps that the room has taken, in all its rounds.
    pub(crate) tick: u64,
    #[serde(with = "bits")]
    pub(crate) sum: u64,
}

/// A broadcast to the replicas of a room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum PeerMessage {
    /// A message of the log, with its number.
    Appended(u64, LogMessage),
    /// Commands of the members on a host that is not the sequencer.
    Commands(Vec<(MemberId, Command)>),
    /// The members on the sending host.
    Claim(Vec<MemberId>),
    /// A request to be a member.
    Request(Token, RequestedMember),
    /// The answer to a request to join: the member is in the log.
    Joined(Token, MemberId, PlayerColor),
    /// A refused request. The log itself answers a request to return that is granted.
    Refused(Token, RoomRefusal),
    /// The sender has released the lease of the room.
    Released,
}

/// The random number of a request to be a member. The log stores it when the member returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Token(#[serde(with = "bits")] pub(crate) u64);

/// The member that somebody asks to be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum RequestedMember {
    /// A new member.
    Join {
        #[serde(deserialize_with = "line_within::<NAME_COLUMNS, _>")]
        name: Line,
        /// `true` if the seat is kept while the member is away.
        is_kept: bool,
    },
    /// A member who is away.
    Return(MemberId),
}

/// The record of a room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Record {
    /// `true` for a standing room.
    pub(crate) stands: bool,
    /// `true` while a host runs the room.
    pub(crate) is_running: bool,
    /// The number of previous records, which grows while a host runs the room.
    heartbeat: u64,
    phase: Phase,
    names: Vec<Line>,
    /// The level of the current round.
    pub(crate) level: String,
    /// The header at the beginning of the log, while there is no checkpoint.
    pub(crate) header: Header,
    /// The invitation code of a private room.
    pub(crate) code: Option<RoomCode>,
}

impl LogMessage {
    /// Parses a message.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, RestoreError> {
        let message: Self = parse(bytes)?;
        message.check()?;
        Ok(message)
    }

    fn check(&self) -> Result<(), RestoreError> {
        check(self.steps <= MAX_STEPS, "the steps of a message")?;
        check(self.entries.iter().all(|entry| entry.step < self.steps), "an entry")
    }

    /// Returns true if `next` fits into this message.
    pub(crate) fn has_room(&self, next: &Self) -> bool {
        self.steps + next.steps <= MAX_STEPS
    }

    /// Appends the steps of the next message. Drops its checksum.
    pub(crate) fn merge(&mut self, next: Self) {
        let steps = self.steps;
        self.entries
            .extend(next.entries.into_iter().map(|it| Entry { step: it.step + steps, ..it }));
        self.steps += next.steps;
    }
}

impl PeerMessage {
    /// Parses a message.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, RestoreError> {
        let message = parse(bytes)?;
        if let Self::Appended(_, message) = &message {
            message.check()?;
        }
        Ok(message)
    }
}

impl Record {
    /// The record of a room that nobody has entered yet.
    pub(crate) fn new(header: Header, stands: bool, code: Option<RoomCode>) -> Self {
        let level = header.level.clone();
        let (phase, names) = (Phase::Waiting, Vec::new());
        Self { stands, is_running: !stands, heartbeat: 0, phase, names, level, header, code }
    }

    /// Parses a record.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self, RestoreError> {
        let record: Self = parse(bytes)?;
        check(record.header.is_possible(), "the header")?;
        check(record.names.iter().all(|name| name.fits(NAME_COLUMNS)), "a name")?;
        Ok(record)
    }

    /// The next record of the room, in its present state.
    pub(crate) fn next(self, room: &Room, is_running: bool) -> Self {
        let (phase, names) = (room.phase(), room.names().cloned().collect());
        let level = room.header().level.clone();
        Self { is_running, heartbeat: self.heartbeat + 1, phase, names, level, ..self }
    }

    /// The summary of the room for lobbies, without watchers.
    pub(crate) fn summary(&self, id: RoomId) -> RoomSummary {
        RoomSummary {
            id,
            level: self.level.clone(),
            mode: self.header.mode,
            difficulty: self.header.difficulty,
            phase: self.phase,
            members: self.names.as_slice().into(),
            watchers: 0,
            browsers: 0,
            code: self.code,
        }
    }
}

/// The versions of the format and of the rules.
pub(crate) fn version() -> String {
    format!("{FORMAT}.{RULES_VERSION}")
}

/// The bytes of a message or a record, or the beginning of a checkpoint.
pub(crate) fn to_bytes(value: &impl Serialize) -> Vec<u8> {
    appended((version() + "\n").into_bytes(), value)
}

/// A reader of the bytes after the versions.
pub(crate) fn reader(bytes: &[u8]) -> Result<Reader<'_>, RestoreError> {
    let rest = bytes.strip_prefix((version() + "\n").as_bytes());
    Reader::of(rest.ok_or(RestoreError::OtherVersion)?)
}

fn parse<'b, T: Deserialize<'b>>(bytes: &'b [u8]) -> Result<T, RestoreError> {
    let mut input = reader(bytes)?;
    let value = input.read()?;
    if input.rest().is_empty() { Ok(value) } else { Err(RestoreError::Longer) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::room::Mode;
    use cellcaster::game::Intents;
    use cellcaster::game::stored::MAX_COUNT;
    use cellcaster::world::Difficulty;

    fn message(check: Option<Check>, entries: Vec<Entry>) -> LogMessage {
        LogMessage { epoch: 3, last: 18_231, tick: 5_400, steps: 2, check, entries }
    }

    fn leave(step: u64) -> Entry {
        Entry { step, member: MemberId(7), command: Command::Leave }
    }

    #[test]
    fn log_messages_round_trip() {
        let check = Check { tick: 5_399, sum: u64::MAX };
        for message in [message(None, Vec::new()), message(Some(check), vec![leave(1)])] {
            assert_eq!(LogMessage::parse(&to_bytes(&message)), Ok(message));
        }
        assert_eq!(to_bytes(&message(None, Vec::new())).len(), 13);
    }

    #[test]
    fn broadcasts_round_trip() {
        let name = Line::of("a b", NAME_COLUMNS).unwrap();
        let want = Command::Intents { seen: 3, intents: Intents::new() };
        let join = |is_kept| RequestedMember::Join { name: name.clone(), is_kept };
        for message in [
            PeerMessage::Appended(9, message(None, vec![leave(0)])),
            PeerMessage::Commands(vec![(MemberId(1), want), (MemberId(2), Command::Leave)]),
            PeerMessage::Claim(vec![MemberId(1), MemberId(7)]),
            PeerMessage::Claim(Vec::new()),
            PeerMessage::Request(Token(u64::MAX), join(true)),
            PeerMessage::Request(Token(3), join(false)),
            PeerMessage::Request(Token(u64::MAX), RequestedMember::Return(MemberId(3))),
            PeerMessage::Joined(Token(7), MemberId(3), PlayerColor::ALL[2]),
            PeerMessage::Refused(Token(0), RoomRefusal::Full),
            PeerMessage::Refused(Token(7), RoomRefusal::Taken),
            PeerMessage::Released,
        ] {
            let bytes = to_bytes(&message);
            assert_eq!(PeerMessage::parse(&bytes).as_ref(), Ok(&message));
            for end in 0..bytes.len() {
                assert!(PeerMessage::parse(&bytes[..end]).is_err(), "{message:?}, {end} bytes");
            }
            let longer = [&bytes[..], b"x"].concat();
            assert_eq!(PeerMessage::parse(&longer), Err(RestoreError::Longer));
        }
    }

    #[test]
    fn records_round_trip() {
        let header = Header::new("museum", Mode::Tag, Difficulty::Hard, u64::MAX);
        let new = Record::new(header, true, None);
        let names = ["Mara", "a b"].map(|name| Line::of(name, NAME_COLUMNS).unwrap());
        let used = Record {
            stands: false,
            is_running: true,
            heartbeat: 9,
            phase: Phase::Playing { ends: 99 },
            code: RoomCode::parse("BCDFGH"),
            names: names.into(),
            ..new.clone()
        };
        for record in [new, used] {
            assert_eq!(Record::parse(&to_bytes(&record)).as_ref(), Ok(&record));
            let wide =
                Record { names: vec![Line::of(&"x".repeat(17), 17).unwrap()], ..record.clone() };
            assert!(Record::parse(&to_bytes(&wide)).is_err());
            assert_eq!(record.summary(RoomId(1)).code, record.code);
            let beyond = Record { heartbeat: u64::MAX, ..record };
            assert!(Record::parse(&to_bytes(&beyond)).is_err());
        }
    }

    #[test]
    fn damaged_bytes_and_other_versions_are_refused() {
        let good = message(None, vec![leave(1)]);
        let check = Check { tick: MAX_COUNT + 1, sum: 0 };
        for damaged in [
            LogMessage { steps: MAX_STEPS + 1, ..good.clone() },
            LogMessage { steps: 1, ..good.clone() },
            LogMessage { epoch: u64::MAX, ..good.clone() },
            LogMessage { last: u64::MAX, ..good.clone() },
            LogMessage { tick: u64::MAX, ..good.clone() },
            message(Some(check), Vec::new()),
        ] {
            assert!(LogMessage::parse(&to_bytes(&damaged)).is_err(), "{damaged:?}");
            assert!(PeerMessage::parse(&to_bytes(&PeerMessage::Appended(1, damaged))).is_err());
        }
        let wide = Line::of(&"x".repeat(99), 99).unwrap();
        let color = PlayerColor::ALL[0];
        for command in [Command::Say(wide.clone()), Command::Join { color, name: wide }] {
            let entry = Entry { step: 0, member: MemberId(1), command };
            assert!(LogMessage::parse(&to_bytes(&message(None, vec![entry]))).is_err());
        }
        let member = MemberId(MemberId::MAX.0 + 1);
        assert!(PeerMessage::parse(&to_bytes(&PeerMessage::Claim(vec![member]))).is_err());
        let bytes = to_bytes(&good);
        let other = [b"0.1", &bytes[version().len()..]].concat();
        assert_eq!(LogMessage::parse(&other), Err(RestoreError::OtherVersion));
        assert_eq!(LogMessage::parse(b"\xff"), Err(RestoreError::OtherVersion));
    }
}
