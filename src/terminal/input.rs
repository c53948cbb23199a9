//! Input: decodes the terminal's bytes to keys and to answers to queries.
//!
//! The decoder first divides the stream into units, and interprets only complete units. Therefore an answer never
//! becomes typed text, however the bytes arrive, and an unknown unit is dropped at its end. A unit is a character, a
//! control sequence or a string. The division uses the forms of ECMA-48 but not their meanings. It always finds the
//! start of the next unit, and never waits for bytes that would complete an unknown one.
//!
//! Rejected: dividing the stream with a key parser. Existing parsers keep a buffer forever after a complete report
//! that they do not recognize.

use std::time::Duration;

use termina::event::{KeyCode, KeyEventKind, ModifierKeyCode, Modifiers as Reported};

use super::event::{Key, KeyEvent, Modifiers, Phase, base_key};
use super::event::{MouseButton, MouseEventKind, MouseReport};
use super::known::{TerminalProperties, known};
use super::sequence;

/// An input from the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TerminalInput {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons was pressed or released.
    Mouse(MouseReport),
    /// The window has received the focus (`true`) or lost it (`false`).
    Focus(bool),
    /// The terminal has answered a query.
    Answer(Answer),
}

/// An answer from the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The terminal supports the kitty keyboard protocol.
    KeyFlags,
    /// The terminal shows 24-bit colours.
    TrueColor,
    /// The terminal can report mouse positions in pixels.
    PixelMouse,
    /// The terminal's name and version.
    Version(TerminalProperties),
    /// The answer to a fence. It follows the answers to all earlier queries.
    Fence,
    /// The answer to a status request.
    Status,
    /// The terminal has repeated a half block, so it supports REP.
    Repeats,
    /// An entry of the terminal's palette has this colour, with 16 bits per channel.
    PaletteEntry([u16; 3]),
}

/// A decoder of a stream of bytes.
#[derive(Debug, Default)]
pub(crate) struct Decoder {
    state: DecoderState,
    /// The bytes of the incomplete unit.
    unit: Vec<u8>,
    is_too_long: bool,
}

/// The kinds of unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum UnitKind {
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

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum DecoderState {
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
    String(UnitKind),
    /// Inside a string, after an escape that may start its terminator.
    StringEscape(UnitKind),
}

/// The effect of a byte on the unit before it.
enum ByteEffect {
    /// The byte belongs to the unit, which continues in this state.
    Continue(DecoderState),
    /// The byte completes the unit.
    Complete(UnitKind),
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

/// The maximum length of a unit. Keys take a dozen bytes and answers a few dozen; longer units are
/// dropped.
const MAX_UNIT_BYTES: usize = 256;

/// The length of an escape and the character that identifies a sequence.
const INTRODUCER_LENGTH: usize = 2;

const ESCAPE: u8 = 0x1b;
const BELL: u8 = 0x07;

impl Decoder {
    /// Decodes the next `bytes` of the stream, and calls `take` with each complete input.
    pub(crate) fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(TerminalInput)) {
        for byte in bytes {
            self.push(*byte, &mut take);
        }
    }

    /// The time to wait for more bytes after the last one. `None` if there is no incomplete unit.
    pub(crate) fn timeout(&self) -> Option<Duration> {
        /// Longer than the gaps within a sequence, and shorter than a noticeable delay.
        const KEY_TIMEOUT: Duration = Duration::from_millis(50);
        /// The unit is certainly a sequence, but the link may be slow.
        const SEQUENCE_TIMEOUT: Duration = Duration::from_secs(1);
        match self.state {
            DecoderState::Ground => None,
            _ if self.may_be_key() => Some(KEY_TIMEOUT),
            _ => Some(SEQUENCE_TIMEOUT),
        }
    }

    /// Ends the wait: an escape without more bytes is the Escape key, and any other incomplete unit is
    /// dropped.
    pub(crate) fn give_up(&mut self, mut take: impl FnMut(TerminalInput)) {
        if self.may_be_key() {
            meaning(UnitKind::Key, &self.unit).into_iter().for_each(&mut take);
        }
        self.reset();
    }

    /// Returns true if the incomplete unit is an escape, or an escape and a character. Either may be the start of a
    /// sequence or a key by itself.
    fn may_be_key(&self) -> bool {
        match self.state {
            DecoderState::Escape
            | DecoderState::SingleShift
            | DecoderState::ControlSequenceStart => true,
            DecoderState::String(_) => self.unit.len() == INTRODUCER_LENGTH,
            _ => false,
        }
    }

    /// Adds one byte, and calls `take` with the input that it completes, if any.
    fn push(&mut self, byte: u8, take: &mut impl FnMut(TerminalInput)) {
        match step(self.state, byte) {
            ByteEffect::Continue(next) => {
                self.state = next;
                self.store(byte);
            }
            ByteEffect::Complete(kind) => {
                self.store(byte);
                if !self.is_too_long {
                    meaning(kind, &self.unit).into_iter().for_each(take);
                }
                self.reset();
            }
            ByteEffect::Abandon => self.reset(),
            ByteEffect::Restart => {
                self.reset();
                self.push(byte, take);
            }
            ByteEffect::RestartEscaped => {
                self.reset();
                self.push(ESCAPE, take);
                self.push(byte, take);
            }
            ByteEffect::Split => {
                meaning(UnitKind::Key, &[ESCAPE]).into_iter().for_each(&mut *take);
                self.reset();
                self.push(byte, take);
            }
        }
    }

    fn store(&mut self, byte: u8) {
        if self.unit.len() < MAX_UNIT_BYTES {
            self.unit.push(byte);
        } else {
            self.is_too_long = true;
        }
    }

    fn reset(&mut self) {
        self.state = DecoderState::Ground;
        self.unit.clear();
        self.is_too_long = false;
    }
}

/// The effect of `byte` on a unit in this state.
fn step(state: DecoderState, byte: u8) -> ByteEffect {
    match (state, byte) {
        (DecoderState::Ground, ESCAPE) => ByteEffect::Continue(DecoderState::Escape),
        (DecoderState::Ground | DecoderState::Escape, 0xc2..=0xdf) => {
            ByteEffect::Continue(DecoderState::Character { missing: 1 })
        }
        (DecoderState::Ground | DecoderState::Escape, 0xe0..=0xef) => {
            ByteEffect::Continue(DecoderState::Character { missing: 2 })
        }
        (DecoderState::Ground | DecoderState::Escape, 0xf0..=0xf4) => {
            ByteEffect::Continue(DecoderState::Character { missing: 3 })
        }
        (DecoderState::Ground | DecoderState::Escape, 0x80..) => ByteEffect::Abandon,
        (DecoderState::Character { missing: 1 }, 0x80..=0xbf)
        | (DecoderState::SingleShift | DecoderState::ConsoleKey, b' '..=b'~') => {
            ByteEffect::Complete(UnitKind::Key)
        }
        (DecoderState::Character { missing }, 0x80..=0xbf) => {
            ByteEffect::Continue(DecoderState::Character { missing: missing - 1 })
        }
        (DecoderState::Escape, ESCAPE) => ByteEffect::Split,
        (DecoderState::Escape, b'O') => ByteEffect::Continue(DecoderState::SingleShift),
        (DecoderState::Escape, b'[') => ByteEffect::Continue(DecoderState::ControlSequenceStart),
        (DecoderState::Escape, b'P') => {
            ByteEffect::Continue(DecoderState::String(UnitKind::DeviceControl))
        }
        (DecoderState::Escape, b']' | b'_' | b'^' | b'X') => {
            ByteEffect::Continue(DecoderState::String(UnitKind::OtherString))
        }
        (DecoderState::Ground | DecoderState::Escape, _) => ByteEffect::Complete(UnitKind::Key),
        (DecoderState::ControlSequenceStart, b'[') => {
            ByteEffect::Continue(DecoderState::ConsoleKey)
        }
        (DecoderState::ControlSequenceStart, b'M') => {
            ByteEffect::Continue(DecoderState::MouseBytes { missing: 3 })
        }
        (DecoderState::ControlSequenceStart | DecoderState::ControlSequence, b' '..=b'?') => {
            ByteEffect::Continue(DecoderState::ControlSequence)
        }
        (DecoderState::ControlSequenceStart | DecoderState::ControlSequence, b'@'..=b'~') => {
            ByteEffect::Complete(UnitKind::ControlSequence)
        }
        (DecoderState::MouseBytes { missing: 1 }, b' '..) => {
            ByteEffect::Complete(UnitKind::MouseBytes)
        }
        (DecoderState::MouseBytes { missing }, b' '..) => {
            ByteEffect::Continue(DecoderState::MouseBytes { missing: missing - 1 })
        }
        (DecoderState::String(kind), ESCAPE) => {
            ByteEffect::Continue(DecoderState::StringEscape(kind))
        }
        (DecoderState::String(kind), BELL) | (DecoderState::StringEscape(kind), b'\\') => {
            ByteEffect::Complete(kind)
        }
        (DecoderState::String(kind), b' '..=b'~' | 0x80..) => {
            ByteEffect::Continue(DecoderState::String(kind))
        }
        (DecoderState::StringEscape(_), _) => ByteEffect::RestartEscaped,
        _ => ByteEffect::Restart,
    }
}

fn meaning(kind: UnitKind, unit: &[u8]) -> Option<TerminalInput> {
    match kind {
        UnitKind::ControlSequence if unit.starts_with(b"\x1b[<") => {
            mouse_report(unit).map(TerminalInput::Mouse)
        }
        UnitKind::MouseBytes => mouse_bytes(unit).map(TerminalInput::Mouse),
        UnitKind::ControlSequence if matches!(unit, b"\x1b[I" | b"\x1b[O") => {
            Some(TerminalInput::Focus(unit.ends_with(b"I")))
        }
        UnitKind::ControlSequence if is_report(unit) => report(unit).map(TerminalInput::Answer),
        UnitKind::Key | UnitKind::ControlSequence => key_event(unit).map(TerminalInput::Key),
        UnitKind::DeviceControl => device_control(unit).map(TerminalInput::Answer),
        UnitKind::OtherString => string_answer(unit).map(TerminalInput::Answer),
    }
}

/// Returns true if the control sequence `unit` has the form of a report. No key has this form.
fn is_report(unit: &[u8]) -> bool {
    matches!(unit, [_, _, b'<'..=b'?', ..] | [.., b'n'] | [_, _, b'2', b';', .., b'R'])
}

/// The answer in the report `unit`. `None` if it answers no query of this program.
fn report(unit: &[u8]) -> Option<Answer> {
    match unit {
        [_, _, b'?', b'0'..=b'9' | b';', .., b'c'] => Some(Answer::Fence),
        [_, _, b'?', b'0'..=b'9', .., b'u'] => Some(Answer::KeyFlags),
        // Set, not set, and permanently set; 0 means an unknown mode.
        b"\x1b[?1016;1$y" | b"\x1b[?1016;2$y" | b"\x1b[?1016;3$y" => Some(Answer::PixelMouse),
        [_, _, b'0'..=b'9', b'n'] => Some(Answer::Status),
        _ if unit == sequence::REPEATED => Some(Answer::Repeats),
        _ => None,
    }
}

/// The answer in the string `unit`, which is neither a control sequence nor a device control
/// string.
fn string_answer(unit: &[u8]) -> Option<Answer> {
    let color = unit.strip_prefix(b"\x1b")?.strip_prefix(sequence::PALETTE_REPORT)?;
    let end = color.iter().position(|byte| !byte.is_ascii_hexdigit() && *byte != b'/');
    let mut channels = color[..end.unwrap_or(color.len())].split(|byte| *byte == b'/').map(channel);
    let color = [channels.next()??, channels.next()??, channels.next()??];
    channels.next().is_none().then_some(Answer::PaletteEntry(color))
}

/// A channel of one to four hexadecimal digits, scaled to 16 bits (Xlib's `XParseColor`).
fn channel(digits: &[u8]) -> Option<u16> {
    let most = (1_u32 << (4 * u32::try_from(digits.len()).ok().filter(|count| *count <= 4)?)) - 1;
    let value = u32::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?;
    u16::try_from(value * u32::from(u16::MAX) / most).ok()
}

/// The answer in the device control string `unit`. `None` if the terminal refuses, or if the string answers no query
/// of this program.
fn device_control(unit: &[u8]) -> Option<Answer> {
    if let Some(name) = unit.strip_prefix(b"\x1bP>|") {
        let name = name.strip_suffix(b"\x1b\\").unwrap_or(name);
        return str::from_utf8(name).ok().map(|name| Answer::Version(known(name)));
    }
    let capability = unit.strip_prefix(b"\x1bP1+r")?;
    capability.starts_with(sequence::RGB_CAPABILITY.as_bytes()).then_some(Answer::TrueColor)
}

/// The key event of `unit`. `None` if the unit is not a key, or is a key that cannot be bound.
fn key_event(unit: &[u8]) -> Option<KeyEvent> {
    match unit {
        [0x1b, character] => {
            let event = key_event(&[*character])?;
            Some(KeyEvent { modifiers: Modifiers { alt: true, ..event.modifiers }, ..event })
        }
        _ => translate(reported(unit)?, told_base(unit)),
    }
}

/// The third part of the first number of `CSI … u` in the kitty protocol: the character of the key
/// in the US layout.
fn told_base(unit: &[u8]) -> Option<char> {
    let numbers = unit.strip_prefix(b"\x1b[")?.strip_suffix(b"u")?;
    let number = numbers.split(|&byte| byte == b';').next()?.split(|&byte| byte == b':').nth(2)?;
    char::from_u32(str::from_utf8(number).ok()?.parse().ok()?)
}

/// The parser's event for `unit`. The parser is new for each unit, because a parser that has kept bytes of an unknown
/// unit would put them before the next one. It allocates kilobytes, which a single character does not need.
fn reported(unit: &[u8]) -> Option<termina::event::KeyEvent> {
    if let &[byte @ b' '..=b'~'] = unit {
        return Some(KeyCode::Char(char::from(byte)).into());
    }
    let mut parser = termina::Parser::default();
    parser.parse(unit, false);
    match parser.pop() {
        Some(termina::Event::Key(event)) => Some(event),
        _ => None,
    }
}

fn translate(event: termina::event::KeyEvent, told_base: Option<char>) -> Option<KeyEvent> {
    // The parser drops Shift if the terminal also reports the character that Shift and the key type.
    let is_upper = matches!(event.code, KeyCode::Char(character) if character.is_uppercase());
    let modifiers = Modifiers {
        shift: is_upper || event.modifiers.contains(Reported::SHIFT),
        control: event.modifiers.contains(Reported::CONTROL),
        alt: event.modifiers.contains(Reported::ALT),
    };
    let phase = match event.kind {
        KeyEventKind::Press => Phase::Press,
        KeyEventKind::Repeat => Phase::Repeat,
        KeyEventKind::Release => Phase::Release,
    };
    let key = name(event.code)?;
    Some(KeyEvent { key, base: base_key(key, told_base), modifiers, phase })
}

fn name(code: KeyCode) -> Option<Key> {
    Some(match code {
        KeyCode::Char(character) if character.is_control() => return None,
        KeyCode::Char(character) => Key::typing(character),
        KeyCode::Enter => Key::Enter,
        KeyCode::Backspace => Key::Backspace,
        KeyCode::Tab | KeyCode::BackTab => Key::Tab,
        KeyCode::Escape => Key::Escape,
        KeyCode::Left => Key::Left,
        KeyCode::Right => Key::Right,
        KeyCode::Up => Key::Up,
        KeyCode::Down => Key::Down,
        KeyCode::Home => Key::Home,
        KeyCode::End => Key::End,
        KeyCode::PageUp => Key::PageUp,
        KeyCode::PageDown => Key::PageDown,
        KeyCode::Insert => Key::Insert,
        KeyCode::Delete => Key::Delete,
        KeyCode::Function(number) => Key::Function(number),
        KeyCode::Modifier(ModifierKeyCode::LeftShift | ModifierKeyCode::RightShift) => Key::Shift,
        KeyCode::Modifier(ModifierKeyCode::LeftControl | ModifierKeyCode::RightControl) => {
            Key::Control
        }
        KeyCode::Modifier(ModifierKeyCode::LeftAlt | ModifierKeyCode::RightAlt) => Key::Alt,
        _ => return None,
    })
}

/// The bit that marks a motion, in a report's first number.
const MOTION: u32 = 32;
/// The bits that mark the wheel and the buttons beyond the third.
const OTHERS: u32 = 64 | 128;

/// The report in `unit`, a control sequence: `CSI < button ; column ; row` and `M`, or `m` for a
/// released button (xterm's control sequences, "Extended coordinates").
fn mouse_report(unit: &[u8]) -> Option<MouseReport> {
    let text = str::from_utf8(unit.strip_prefix(b"\x1b[<")?).ok()?;
    let (numbers, is_release) = match text.strip_suffix('M') {
        Some(numbers) => (numbers, false),
        None => (text.strip_suffix('m')?, true),
    };
    let mut numbers = numbers.split(';').map(|number| number.parse().ok());
    let [code, column, row] = [numbers.next()??, numbers.next()??, numbers.next()??];
    let kind = kind(code, is_release)?;
    numbers.next().is_none().then_some(MouseReport { kind, place: [column, row] })
}

/// The report in `unit`: `CSI M` and three bytes. Old terminals without the other form send it.
fn mouse_bytes(unit: &[u8]) -> Option<MouseReport> {
    let &[code, column, row] = unit.strip_prefix(b"\x1b[M")? else { return None };
    let [code, column, row] = [code, column, row].map(|byte| u32::from(byte.saturating_sub(32)));
    Some(MouseReport { kind: kind(code, false)?, place: [column, row] })
}

fn kind(code: u32, is_release: bool) -> Option<MouseEventKind> {
    Some(match code & 3 {
        _ if code & OTHERS != 0 => return None,
        _ if code & MOTION != 0 => MouseEventKind::Moved,
        _ if is_release => MouseEventKind::Released,
        0 => MouseEventKind::Pressed(MouseButton::Left),
        1 => MouseEventKind::Pressed(MouseButton::Middle),
        2 => MouseEventKind::Pressed(MouseButton::Right),
        _ => MouseEventKind::Released,
    })
}

#[cfg(test)]
mod tests;
