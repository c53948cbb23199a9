//! What the terminal answers to queries.

use super::super::sequence;

/// An answer of the terminal's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Answer {
    /// It speaks the kitty keyboard protocol.
    KeyFlags,
    /// It shows 24-bit colours.
    TrueColor,
    /// It can report the place of the mouse in pixels.
    PixelMouse,
    /// It has answered all that was asked before the fence.
    Fence,
    /// It has come as far as a status request.
    Status,
    /// It has repeated a half block.
    Repeats,
    /// It has defined entries of the palette.
    Palette,
}

/// Whether `unit`, a control sequence, has a shape that only reports have, and no key.
pub(super) fn is_report(unit: &[u8]) -> bool {
    matches!(unit, [_, _, b'<'..=b'?', ..] | [.., b'n'] | [_, _, b'2', b';', .., b'R'])
}

/// What the report `unit` answers; `None` for what was not asked.
pub(super) fn parse_report(unit: &[u8]) -> Option<Answer> {
    match unit {
        [_, _, b'?', b'0'..=b'9' | b';', .., b'c'] => Some(Answer::Fence),
        [_, _, b'?', b'0'..=b'9', .., b'u'] => Some(Answer::KeyFlags),
        // Set, not set, or set for good; 0 is for a mode that it does not know.
        b"\x1b[?1016;1$y" | b"\x1b[?1016;2$y" | b"\x1b[?1016;3$y" => Some(Answer::PixelMouse),
        [_, _, b'0'..=b'9', b'n'] => Some(Answer::Status),
        _ if unit == sequence::REPEATED => Some(Answer::Repeats),
        _ => None,
    }
}

/// What the string `unit` answers, that is neither a control sequence nor a device control string.
pub(super) fn parse_string(unit: &[u8]) -> Option<Answer> {
    let text = unit.strip_prefix(b"\x1b")?;
    let is_defined = sequence::DEFINED.iter().any(|defined| text.starts_with(defined));
    is_defined.then_some(Answer::Palette)
}

/// What the device control string `unit` answers; `None` for a refusal, and for what was not asked.
pub(super) fn parse_device_control(unit: &[u8]) -> Option<Answer> {
    let capability = unit.strip_prefix(b"\x1bP1+r")?;
    capability.starts_with(sequence::RGB_CAPABILITY.as_bytes()).then_some(Answer::TrueColor)
}
