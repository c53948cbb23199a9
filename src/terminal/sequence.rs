//! The control sequences that crossterm has no command for, or not the one that this program sends.
//!
//! Crossterm names all others. It keeps the keyboard's flags together with the reader of events that
//! was refused, and formats colours and motions in a way that would cost more than all else that a
//! cell does.

use std::ops::RangeInclusive;

use crossterm::Command;

/// The sequences of one of crossterm's commands.
pub(super) fn of(command: impl Command) -> String {
    let mut text = String::new();
    // A string takes everything.
    _ = command.write_ansi(&mut text);
    text
}

/// Asks for every key as an escape code, with presses, repeats and releases, and with the character
/// that Shift makes of it: the kitty keyboard protocol's flags 1, 2, 4 and 8.
pub(super) const PUSH_KEY_FLAGS: &str = "\x1b[>15u";
/// Goes back to the flags from before.
pub(super) const POP_KEY_FLAGS: &str = "\x1b[<u";

/// Asks for reports of when the window gains or loses the focus.
pub(super) const ENABLE_FOCUS_REPORTS: &str = "\x1b[?1004h";
/// Ends them.
pub(super) const DISABLE_FOCUS_REPORTS: &str = "\x1b[?1004l";
/// Asks for reports of every motion of the mouse and of its buttons, as decimal numbers.
pub(super) const ENABLE_MOUSE: &str = "\x1b[?1003h\x1b[?1006h";
/// Ends them.
pub(super) const DISABLE_MOUSE: &str = "\x1b[?1003l\x1b[?1006l";
/// Has places of the mouse be in pixels: in place of mode 1006, so it is set after that.
pub(super) const ENABLE_MOUSE_PIXELS: &str = "\x1b[?1016h";
/// Ends that.
pub(super) const DISABLE_MOUSE_PIXELS: &str = "\x1b[?1016l";
/// Asks whether the terminal knows that mode (DECRQM).
pub(super) const QUERY_MOUSE_PIXELS: &str = "\x1b[?1016$p";

/// Colours and modifiers as they were at the start: a byte shorter than crossterm's, and in every
/// frame.
pub(super) const RESET_STYLE: &str = "\x1b[m";

/// Asks for the keyboard flags; only a terminal that speaks the protocol answers.
pub(super) const QUERY_KEY_FLAGS: &str = "\x1b[?u";
/// The name of the capability to show 24-bit colours, in hexadecimal digits.
pub(super) const RGB_CAPABILITY: &str = "524742";
/// Asks for the terminal's name and version (XTVERSION), which a terminal that knows device control strings
/// answers with one. As a control sequence, it is passed over by all others.
pub(super) const QUERY_VERSION: &str = "\x1b[>q";
/// Asks for that capability (XTGETTCAP).
pub(super) const QUERY_TRUE_COLOR: &str = "\x1bP+q524742\x1b\\";
/// Asks for the device's status; the answer tells that all before the query has been taken in.
pub(super) const QUERY_STATUS: &str = "\x1b[5n";
/// Repeats a half block in the second row, asks where the cursor is then, and erases it all.
pub(super) const PROBE_REPETITION: &str = "\x1b[2;1H\u{2580}\x1b[3b\x1b[6n\x1b[2;1H\x1b[K";
/// The answer where it was repeated as often. No key is reported like this: F3, which is much alike, says 1.
pub(super) const REPEATED: &[u8] = b"\x1b[2;5R";
/// Moves the cursor to the upper left corner, and erases the screen.
pub(super) const ERASE: &str = "\x1b[H\x1b[J";
/// Asks for the colour of an entry of the palette, defines it and another in one sequence, asks again, resets both
/// and asks once more.
pub(super) const PROBE_PALETTE: &str = "\x1b]4;255;?\x07\
    \x1b]4;254;#123456;255;#12ab56\x07\x1b]4;255;?\x07\
    \x1b]104;254;255\x07\x1b]4;255;?\x07";
/// How the answers begin; a colour follows as `rgb:` and three hexadecimal numbers.
pub(super) const PALETTE_REPORT: &[u8] = b"]4;255;rgb:";
/// The colour that the second answer reports where they were defined, in 16 bits a channel.
pub(super) const DEFINED: [u16; 3] = [0x1212, 0xabab, 0x5656];
/// The entries of the palette that may be defined; those below are the user's, or of themes for shells.
pub(super) const PALETTE: RangeInclusive<u8> = 24..=255;

/// Gives back the entries of the palette that may have been defined.
pub(super) fn give_palette_back() -> String {
    /// There are terminals that take sixteen parameters at most.
    const AT_ONCE: usize = 15;
    let mut text = String::new();
    for (index, entry) in PALETTE.enumerate() {
        text.push_str(if index % AT_ONCE == 0 { "\x1b]104;" } else { ";" });
        text.push_str(&entry.to_string());
        text.push_str(if index % AT_ONCE == AT_ONCE - 1 || entry == u8::MAX { "\x07" } else { "" });
    }
    text
}

/// Asks for the device's attributes, which every terminal answers, and after all earlier queries.
pub(super) const QUERY_FENCE: &str = "\x1b[c";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_query_for_colours_names_their_capability() {
        assert!(QUERY_TRUE_COLOR.contains(RGB_CAPABILITY));
        let name = b"RGB".map(|byte| format!("{byte:02x}")).concat();
        assert_eq!(RGB_CAPABILITY, name);
    }
}
