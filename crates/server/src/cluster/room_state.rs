//! The state of a room on one host. Only messages of the log change it.
//!
//! The state is a function of a checkpoint, or of the room's first header, and of the messages of the log after that.
//! Each message is applied once, in the order of the log. The state stores its checksum once a second. The message
//! with the sequencer's checksum comes later, so that both are known then.

use std::collections::VecDeque;
use std::io::{Read, Write};
use std::sync::Arc;

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;

use super::message::{Check, LogMessage, reader, to_bytes};
use crate::queue::push_within;
use crate::rooms::room::{Catalog, Entry, Header, Room};
use crate::rooms::sequencer::{Changes, Recording, RoundLog};
use cellcaster::game::STEPS_PER_SECOND;
use cellcaster::game::stored::{MAX_BYTES, RestoreError};

/// The steps between two checksums.
const CHECKED: u64 = STEPS_PER_SECOND as u64;
/// The most checksums that are remembered.
const MAX_SUMS: usize = 8;

/// A room, and the position up to which the log is applied.
pub(crate) struct RoomState {
    pub(crate) room: Room,
    log: RoundLog,
    /// The number of the last message.
    pub(crate) number: u64,
    /// The steps that the room has taken in all rounds.
    pub(crate) tick: u64,
    /// The epoch of the newest message.
    pub(crate) epoch: u64,
    /// The latest checksums, oldest first.
    sums: VecDeque<Check>,
}

/// The position of a message relative to a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Position {
    /// It is the next one.
    Next,
    /// It was already applied.
    Known,
    /// Messages before it are missing.
    Later,
    /// It is the next one, but the sequencer's state was different. That is a bug of the program.
    Differs,
}

impl RoomState {
    /// A room that nobody has entered yet. `None` if the catalog has no such level.
    pub(crate) fn new(catalog: &Arc<Catalog>, header: Header) -> Option<Self> {
        Some(Self::with(Room::new(catalog, header)?, (0, 0, 0)))
    }

    fn with(room: Room, (number, tick, epoch): (u64, u64, u64)) -> Self {
        let log = RoundLog::new(None, &room);
        Self { room, log, number, tick, epoch, sums: VecDeque::new() }
    }

    /// Records the room from now on, or from the next round if the present one has begun.
    pub(crate) fn record(&mut self, recording: Option<Box<dyn Recording>>) {
        self.log = if self.tick == 0 {
            RoundLog::new(recording, &self.room)
        } else {
            RoundLog::of_next_round(recording)
        };
    }

    /// The newest checksum.
    pub(crate) fn sum(&self) -> Option<Check> {
        self.sums.back().copied()
    }

    /// The position of message `number`.
    pub(crate) fn position(&self, number: u64, message: &LogMessage) -> Position {
        let is_equal = |check: Check| {
            let own = self.sums.iter().find(|own| own.tick == check.tick);
            own.is_none_or(|own| *own == check)
        };
        if number <= self.number {
            Position::Known
        } else if message.last != self.number {
            Position::Later
        } else if message.tick == self.tick && message.check.is_none_or(is_equal) {
            Position::Next
        } else {
            Position::Differs
        }
    }

    /// Applies the next message. The message has no number while the log does not have it. A message of an older
    /// epoch changes nothing.
    pub(crate) fn apply(&mut self, number: Option<u64>, message: &LogMessage) -> Changes {
        let mut all = Changes::default();
        self.number = number.unwrap_or(self.number);
        if message.epoch < self.epoch {
            return all;
        }
        self.epoch = message.epoch;
        let mut entries = message.entries.iter().peekable();
        for step in 0..message.steps {
            let changes = self.log.step(&mut self.room, |pass| {
                while let Some(Entry { member, command, .. }) =
                    entries.next_if(|it| it.step <= step)
                {
                    pass(*member, command.clone());
                }
            });
            all.add(changes);
            self.tick += 1;
            if self.tick.is_multiple_of(CHECKED) {
                let check = Check { tick: self.tick, sum: self.room.checksum() };
                push_within(&mut self.sums, check, MAX_SUMS);
            }
        }
        all
    }

    /// The whole state, compressed.
    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let head = to_bytes(&(self.number, self.tick, self.epoch));
        let mut encoder = ZlibEncoder::new(head, Compression::fast());
        // Writing to memory cannot fail.
        _ = encoder.write_all(&self.room.checkpoint());
        encoder.finish().unwrap_or_default()
    }

    /// Restores a state from a checkpoint.
    ///
    /// # Errors
    /// A sentence, if the bytes are damaged or of another version, or if the catalog does not have the level.
    pub(crate) fn restore(catalog: &Arc<Catalog>, bytes: &[u8]) -> Result<Self, String> {
        let sentence = |error: RestoreError| error.to_string();
        let mut input = reader(bytes).map_err(sentence)?;
        let numbers = input.read().map_err(sentence)?;
        let mut room = Vec::new();
        let mut decoder = ZlibDecoder::new(input.rest()).take(MAX_BYTES as u64 + 1);
        decoder.read_to_end(&mut room).map_err(|_| "the checkpoint is damaged".to_owned())?;
        Ok(Self::with(Room::restore(catalog, &room)?, numbers))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accounts::Day;
    use crate::line::Line;
    use crate::rooms::room::{Command, MemberId, Mode, parse_log};
    use crate::rooms::summary::RoomId;
    use crate::simulation::{RoomLogs, replayed};
    use cellcaster::game::PlayerColor;
    use cellcaster::game::stored::MAX_COUNT;
    use cellcaster::world::Difficulty;

    fn state() -> RoomState {
        let header = Header::new("museum", Mode::Roam, Difficulty::Normal, 7);
        RoomState::new(&Arc::new(Catalog::builtin()), header).unwrap()
    }

    fn message(state: &RoomState, epoch: u64, check: Option<Check>) -> LogMessage {
        let command =
            Command::Join { color: PlayerColor::ALL[0], name: Line::of("Mara", 16).unwrap() };
        let entries = vec![Entry { step: 1, member: MemberId(1), command }];
        let (last, tick) = (state.number, state.tick);
        LogMessage { epoch, last, tick, steps: 2, check, entries }
    }

    #[test]
    fn messages_are_applied_once_and_in_order() {
        let mut state = state();
        let first = message(&state, 1, None);
        assert_eq!(state.position(5, &first), Position::Next);
        assert!(state.apply(Some(5), &first).summary);
        assert_eq!((state.number, state.tick, state.room.len()), (5, 2, 1));
        assert_eq!(state.position(5, &first), Position::Known);
        let next = message(&state, 1, None);
        assert_eq!(state.position(9, &LogMessage { last: 8, ..next.clone() }), Position::Later);
        assert_eq!(state.position(9, &LogMessage { tick: 3, ..next.clone() }), Position::Differs);
        // A message of an older epoch only advances the number.
        state.epoch = 2;
        state.apply(Some(9), &next);
        assert_eq!((state.number, state.tick), (9, 2));
    }

    #[test]
    fn the_log_says_on_which_day_the_next_round_is() {
        let level = "daily-2026-11-27";
        let replica = || {
            let header = Header::new(level, Mode::Race, Difficulty::Normal, 7);
            RoomState::new(&Arc::new(Catalog::builtin()), header).unwrap()
        };
        let (mut one, mut other) = (replica(), replica());
        let join =
            Command::Join { color: PlayerColor::ALL[0], name: Line::of("Mara", 16).unwrap() };
        let day = |text| Command::Day(Day::of_level(text).unwrap());
        // A member's host with a slow clock changes nothing.
        let days = [day("daily-2026-11-28"), day("daily-2026-11-27")];
        let commands = [join].into_iter().chain(days).chain([Command::Again]);
        let entry = |command| Entry { step: 0, member: MemberId(1), command };
        let (epoch, last, tick, steps) = (1, one.number, one.tick, 90);
        let entries = commands.map(entry).collect();
        let message = LogMessage { epoch, last, tick, steps, check: None, entries };
        let sent = LogMessage::parse(&to_bytes(&message)).unwrap();
        one.apply(Some(1), &message);
        other.apply(Some(1), &sent);
        let header = one.room.header();
        assert_eq!((header.round, header.level.as_str()), (2, "daily-2026-11-28"));
        assert_eq!((header, one.room.checksum()), (other.room.header(), other.room.checksum()));
    }

    #[test]
    fn a_different_checksum_is_detected() {
        let mut state = state();
        for number in 1..=30 {
            let next = message(&state, 1, None);
            state.apply(Some(number), &next);
        }
        let sum = state.sum().unwrap();
        assert_eq!(sum.tick, 60);
        let other = Check { sum: !sum.sum, ..sum };
        for (check, position) in [(sum, Position::Next), (other, Position::Differs)] {
            assert_eq!(state.position(31, &message(&state, 1, Some(check))), position);
        }
    }

    #[test]
    fn a_checkpoint_restores_the_replica() {
        let catalog = Arc::new(Catalog::builtin());
        let mut state = state();
        let next = message(&state, 3, None);
        state.apply(Some(4), &next);
        let bytes = state.checkpoint();
        let again = RoomState::restore(&catalog, &bytes).unwrap();
        assert_eq!((again.number, again.tick, again.epoch), (4, 2, 3));
        assert_eq!(again.room.checksum(), state.room.checksum());
        for damaged in [&bytes[..bytes.len() / 2], b"", b"\n", &to_bytes(&(1_u64, 2_u64))] {
            assert!(RoomState::restore(&catalog, damaged).is_err());
        }
    }

    #[test]
    fn a_recorded_replica_replays_with_kept_seats() {
        let catalog = Arc::new(Catalog::builtin());
        let [whole, part] = [RoomLogs::default(), RoomLogs::default()];
        let mut state = state();
        state.record(whole.recordings().open(RoomId(7), false));
        let apply = |state: &mut RoomState, commands: Vec<Command>| {
            let (last, tick) = (state.number, state.tick);
            let entry = |command| Entry { step: 0, member: MemberId(1), command };
            let entries = commands.into_iter().map(entry).collect();
            let message = LogMessage { epoch: 1, last, tick, steps: 90, check: None, entries };
            state.apply(Some(last + 1), &message);
        };
        let join =
            Command::Join { color: PlayerColor::ALL[0], name: Line::of("Mara", 16).unwrap() };
        apply(&mut state, vec![join, Command::Keep]);
        // A host that comes later records the next round.
        let mut later = RoomState::restore(&catalog, &state.checkpoint()).unwrap();
        later.record(part.recordings().open(RoomId(7), false));
        for commands in [vec![Command::Again], vec![Command::Return { token: 9 }], vec![]] {
            apply(&mut state, commands.clone());
            apply(&mut later, commands);
        }
        assert_eq!(state.room.header().round, 2);
        for (logs, rounds) in [(whole, 2), (part, 1)] {
            let text = logs.text(RoomId(7));
            assert!(text.contains("\"kept\":{\"token\":"), "{text}");
            assert_eq!(parse_log(&text).unwrap().len(), rounds);
            let room = replayed(&text, &catalog, state.room.step());
            assert_eq!(room.checksum(), state.room.checksum());
        }
    }

    #[test]
    fn impossible_numbers_are_refused() {
        let catalog = Arc::new(Catalog::builtin());
        let bytes = state().checkpoint();
        let mut input = reader(&bytes).unwrap();
        let _numbers: (u64, u64, u64) = input.read().unwrap();
        for (numbers, is_possible) in [
            ((MAX_COUNT - 1, MAX_COUNT - 1, MAX_COUNT - 1), true),
            ((u64::MAX, 2, 3), false),
            ((4, u64::MAX, 3), false),
            ((4, 2, u64::MAX), false),
        ] {
            let changed = [&to_bytes(&numbers), input.rest()].concat();
            let state = RoomState::restore(&catalog, &changed);
            assert_eq!(state.is_ok(), is_possible, "{numbers:?}");
            if let Ok(mut state) = state {
                let next = message(&state, state.epoch + 1, None);
                state.apply(Some(state.number + 1), &next);
            }
        }
    }
}
