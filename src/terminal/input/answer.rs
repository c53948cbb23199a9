//! Answers of the terminal to queries.

use super::super::known::{Known, known};
use super::super::sequence;

/// An answer of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Answer {
    /// The terminal supports the kitty keyboard protocol.
    KeyFlags,
    /// The terminal shows 24-bit colours.
    TrueColor,
    /// The terminal can report mouse positions in pixels.
    PixelMouse,
    /// The terminal's name and version.
    Version(Known),
    /// The answer to a fence, after those to all earlier queries.
    Fence,
    /// The answer to a status request.
    Status,
    /// The terminal has repeated a half block.
    Repeats,
    /// An entry of the terminal's palette has this colour, in 16 bits a channel.
    PaletteEntry([u16; 3]),
}

/// Whether `unit`, a control sequence, has the form of a report, which no key has.
pub(crate) fn is_report(unit: &[u8]) -> bool {
    matches!(unit, [_, _, b'<'..=b'?', ..] | [.., b'n'] | [_, _, b'2', b';', .., b'R'])
}

/// The answer in the report `unit`; `None` if it answers no query of this program.
pub(crate) fn parse_report(unit: &[u8]) -> Option<Answer> {
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
pub(crate) fn parse_string(unit: &[u8]) -> Option<Answer> {
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

/// The answer in the device control string `unit`; `None` for a refusal, and if it answers no query
/// of this program.
pub(crate) fn parse_device_control(unit: &[u8]) -> Option<Answer> {
    if let Some(name) = unit.strip_prefix(b"\x1bP>|") {
        let name = name.strip_suffix(b"\x1b\\").unwrap_or(name);
        return str::from_utf8(name).ok().map(|name| Answer::Version(known(name)));
    }
    let capability = unit.strip_prefix(b"\x1bP1+r")?;
    capability.starts_with(sequence::RGB_CAPABILITY.as_bytes()).then_some(Answer::TrueColor)
}
