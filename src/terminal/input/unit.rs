//! Cuts a stream of bytes into complete units: a character, a control sequence, a string.
//!
//! It knows the shapes of ECMA-48 and nothing of their meaning, so it always knows where the next
//! unit starts: after what it cannot read it goes on, rather than waiting for a byte that makes
//! sense of it. A parser that keeps what it does not know swallows every later key.

/// The kinds of unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A character, possibly after an escape; the escape alone; or a function key in `ESC O`.
    Key,
    /// `ESC [` to its final byte.
    ControlSequence,
    /// `ESC [ M` and three bytes.
    MouseBytes,
    /// `ESC P` to its terminator.
    DeviceControl,
    /// Any other string, such as a window's title.
    OtherString,
}

/// The longest unit kept. Keys take a dozen bytes, answers a few dozen; the rest is dropped.
const LONGEST_UNIT: usize = 256;

/// The length of an escape and the character that says what starts here.
const INTRODUCER_LENGTH: usize = 2;

const ESCAPE: u8 = 0x1b;
const BELL: u8 = 0x07;

/// A cutter of bytes into units.
#[derive(Debug, Default)]
pub(super) struct Cutter {
    state: State,
    bytes: Vec<u8>,
    overlong: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum State {
    /// Between units.
    #[default]
    Ground,
    /// Inside a character, of which so many bytes are missing.
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
    /// After `ESC [ M`; so many bytes are missing.
    MouseBytes { missing: u8 },
    /// Inside a string.
    String(Kind),
    /// Inside a string, after an escape that may start its terminator.
    StringEscape(Kind),
}

/// What a byte does to the unit before it.
enum Step {
    /// It belongs to the unit, which goes on in this state.
    Continue(State),
    /// It completes the unit.
    Complete(Kind),
    /// It is nothing, and so is the unit.
    Abandon,
    /// It is no part of the unit, which is nothing without it; the byte starts the next one.
    Restart,
    /// It is no part of the unit, which is nothing without it; an escape and the byte start the
    /// next one.
    RestartEscaped,
    /// It is an escape after an escape: that was the key, and this starts the next unit.
    Split,
}

impl Cutter {
    /// Takes one byte, and hands the unit that it completes, if any, to `take`.
    pub(super) fn push(&mut self, byte: u8, take: &mut impl FnMut(Kind, &[u8])) {
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

    /// What there is of a unit that has not been completed.
    pub(super) fn rest(&self) -> Rest {
        match self.state {
            State::Ground => Rest::Nothing,
            State::Escape | State::SingleShift | State::ControlSequenceStart => Rest::PerhapsKey,
            State::String(_) if self.bytes.len() == INTRODUCER_LENGTH => Rest::PerhapsKey,
            _ => Rest::Sequence,
        }
    }

    /// Stops waiting for the rest of a unit: what could be a key is one, the remainder nothing.
    pub(super) fn give_up(&mut self, take: &mut impl FnMut(Kind, &[u8])) {
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

/// What there is of a unit that has not been completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    /// Nothing: the last byte completed a unit.
    Nothing,
    /// An escape, or one and a character: the start of a sequence, or a key pressed alone.
    PerhapsKey,
    /// Part of a sequence or a character, which is no key as it is.
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
