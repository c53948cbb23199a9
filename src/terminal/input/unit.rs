//! Divides a stream of bytes into complete units: characters, control sequences and strings.
//!
//! It knows the forms of ECMA-48 but not their meanings, so that it always finds the start of the
//! next unit: it continues after unknown bytes, and never waits for bytes that would complete them.
//! A parser that keeps unknown bytes swallows all later keys.

/// The kinds of unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A character, possibly after an escape; an escape alone; or a function key in `ESC O`.
    Key,
    /// `ESC [` up to its final byte.
    ControlSequence,
    /// `ESC [ M` and three bytes.
    MouseBytes,
    /// `ESC P` up to its terminator.
    DeviceControl,
    /// Any other string, such as a window's title.
    OtherString,
}

/// The maximum length of a unit. Keys take a dozen bytes and answers a few dozen; longer units are
/// dropped.
const LONGEST_UNIT: usize = 256;

/// The length of an escape and the character that identifies a sequence.
const INTRODUCER_LENGTH: usize = 2;

const ESCAPE: u8 = 0x1b;
const BELL: u8 = 0x07;

/// Divides bytes into units.
#[derive(Debug, Default)]
pub(crate) struct Cutter {
    state: State,
    bytes: Vec<u8>,
    overlong: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// Between units.
    #[default]
    Ground,
    /// Inside a character that lacks this number of bytes.
    Character { missing: u8 },
    /// After an escape.
    Escape,
    /// After `ESC O`.
    SingleShift,
    /// After `ESC [`.
    ControlSequenceStart,
    /// Inside a control sequence.
    ControlSequence,
    /// After `ESC [ [`, which the Linux console sends before a letter.
    ConsoleKey,
    /// After `ESC [ M`, before this number of bytes.
    MouseBytes { missing: u8 },
    /// Inside a string.
    String(Kind),
    /// Inside a string, after an escape that may start its terminator.
    StringEscape(Kind),
}

/// The effect of a byte on the unit before it.
enum Step {
    /// The byte belongs to the unit, which continues in this state.
    Continue(State),
    /// The byte completes the unit.
    Complete(Kind),
    /// The byte and the unit are dropped.
    Abandon,
    /// The unit is incomplete and dropped; the byte starts the next unit.
    Restart,
    /// The unit is incomplete and dropped; an escape and the byte start the next unit.
    RestartEscaped,
    /// The byte is an escape after an escape: the first one was the key, and this one starts the
    /// next unit.
    Split,
}

impl Cutter {
    /// Adds one byte, and calls `take` with the unit that it completes, if any.
    pub(crate) fn push(&mut self, byte: u8, take: &mut impl FnMut(Kind, &[u8])) {
        match step(self.state, byte) {
            Step::Continue(next) => {
                self.state = next;
                self.store(byte);
            }
            Step::Complete(kind) => {
                self.store(byte);
                if !self.overlong {
                    take(kind, &self.bytes);
                }
                self.reset();
            }
            Step::Abandon => self.reset(),
            Step::Restart => {
                self.reset();
                self.push(byte, take);
            }
            Step::RestartEscaped => {
                self.reset();
                self.push(ESCAPE, take);
                self.push(byte, take);
            }
            Step::Split => {
                take(Kind::Key, &[ESCAPE]);
                self.reset();
                self.push(byte, take);
            }
        }
    }

    /// The state of the incomplete unit.
    pub(crate) fn rest(&self) -> Rest {
        match self.state {
            State::Ground => Rest::Nothing,
            State::Escape | State::SingleShift | State::ControlSequenceStart => Rest::PerhapsKey,
            State::String(_) if self.bytes.len() == INTRODUCER_LENGTH => Rest::PerhapsKey,
            _ => Rest::Sequence,
        }
    }

    /// Ends the wait for the rest of a unit: a possible key is taken as one, any other unit is
    /// dropped.
    pub(crate) fn give_up(&mut self, take: &mut impl FnMut(Kind, &[u8])) {
        if self.rest() == Rest::PerhapsKey {
            take(Kind::Key, &self.bytes);
        }
        self.reset();
    }

    fn store(&mut self, byte: u8) {
        if self.bytes.len() < LONGEST_UNIT {
            self.bytes.push(byte);
        } else {
            self.overlong = true;
        }
    }

    fn reset(&mut self) {
        self.state = State::Ground;
        self.bytes.clear();
        self.overlong = false;
    }
}

/// The state of an incomplete unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rest {
    /// No unit: the last byte completed one.
    Nothing,
    /// An escape, or one and a character: the start of a sequence, or a key by itself.
    PerhapsKey,
    /// A part of a sequence or a character, which is not a key by itself.
    Sequence,
}

fn step(state: State, byte: u8) -> Step {
    match state {
        State::Ground => between_units(byte),
        State::Character { missing } => in_character(missing, byte),
        State::Escape => after_escape(byte),
        State::SingleShift | State::ConsoleKey => before_last_of_key(byte),
        State::ControlSequenceStart if byte == b'[' => Step::Continue(State::ConsoleKey),
        State::ControlSequenceStart if byte == b'M' => {
            Step::Continue(State::MouseBytes { missing: 3 })
        }
        State::MouseBytes { missing } => in_mouse_bytes(missing, byte),
        State::ControlSequenceStart | State::ControlSequence => in_control_sequence(byte),
        State::String(kind) => in_string(kind, byte),
        State::StringEscape(kind) if byte == b'\\' => Step::Complete(kind),
        State::StringEscape(_) => Step::RestartEscaped,
    }
}

fn between_units(byte: u8) -> Step {
    match byte {
        ESCAPE => Step::Continue(State::Escape),
        0x80.. => character_start(byte),
        _ => Step::Complete(Kind::Key),
    }
}

fn character_start(byte: u8) -> Step {
    match byte {
        0xc2..=0xdf => Step::Continue(State::Character { missing: 1 }),
        0xe0..=0xef => Step::Continue(State::Character { missing: 2 }),
        0xf0..=0xf4 => Step::Continue(State::Character { missing: 3 }),
        _ => Step::Abandon,
    }
}

fn in_character(missing: u8, byte: u8) -> Step {
    match (missing, byte) {
        (1, 0x80..=0xbf) => Step::Complete(Kind::Key),
        (_, 0x80..=0xbf) => Step::Continue(State::Character { missing: missing - 1 }),
        _ => Step::Restart,
    }
}

fn after_escape(byte: u8) -> Step {
    match byte {
        ESCAPE => Step::Split,
        b'O' => Step::Continue(State::SingleShift),
        b'[' => Step::Continue(State::ControlSequenceStart),
        b'P' => Step::Continue(State::String(Kind::DeviceControl)),
        b']' | b'_' | b'^' | b'X' => Step::Continue(State::String(Kind::OtherString)),
        0x80.. => character_start(byte),
        _ => Step::Complete(Kind::Key),
    }
}

fn before_last_of_key(byte: u8) -> Step {
    match byte {
        b' '..=b'~' => Step::Complete(Kind::Key),
        _ => Step::Restart,
    }
}

fn in_control_sequence(byte: u8) -> Step {
    match byte {
        b' '..=b'?' => Step::Continue(State::ControlSequence),
        b'@'..=b'~' => Step::Complete(Kind::ControlSequence),
        _ => Step::Restart,
    }
}

fn in_mouse_bytes(missing: u8, byte: u8) -> Step {
    match (missing, byte) {
        (_, ..b' ') => Step::Restart,
        (1, _) => Step::Complete(Kind::MouseBytes),
        _ => Step::Continue(State::MouseBytes { missing: missing - 1 }),
    }
}

fn in_string(kind: Kind, byte: u8) -> Step {
    match byte {
        ESCAPE => Step::Continue(State::StringEscape(kind)),
        BELL => Step::Complete(kind),
        b' '..=b'~' | 0x80.. => Step::Continue(State::String(kind)),
        _ => Step::Restart,
    }
}
