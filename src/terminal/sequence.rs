//! Control sequences that crossterm lacks or has in another form.
//!
//! Crossterm provides all others. It couples the keyboard flags with its event reader, which this crate does not use,
//! and formats colours and motions in a way that takes longer than the rest of a cell's encoding.

use std::ops::RangeInclusive;

use crossterm::Command;

/// The sequences of one of crossterm's commands.
pub(crate) fn of(command: impl Command) -> String {
    let mut text = String::new();
    // A write to a string cannot fail.
    _ = command.write_ansi(&mut text);
    text
}

/// Requests all keys as escape codes, with presses, repeats and releases, and with shifted
/// characters: the kitty keyboard protocol's flags 1, 2, 4 and 8.
pub(crate) const PUSH_KEY_FLAGS: &str = "\x1b[>15u";
/// Clears the present keyboard flags, and leaves the pushed ones.
pub(crate) const CLEAR_KEY_FLAGS: &str = "\x1b[=0u";
/// Restores the previous keyboard flags.
pub(crate) const POP_KEY_FLAGS: &str = "\x1b[<u";

/// Enables reports of the window's focus.
pub(crate) const ENABLE_FOCUS_REPORTS: &str = "\x1b[?1004h";
/// Disables reports of the window's focus.
pub(crate) const DISABLE_FOCUS_REPORTS: &str = "\x1b[?1004l";
/// Enables reports of all motions of the mouse and of its buttons, as decimal numbers.
pub(crate) const ENABLE_MOUSE: &str = "\x1b[?1003h\x1b[?1006h";
/// Disables reports of the mouse.
pub(crate) const DISABLE_MOUSE: &str = "\x1b[?1003l\x1b[?1006l";
/// Sets mouse positions to pixels. This mode replaces mode 1006, so it is set after that.
pub(crate) const ENABLE_MOUSE_PIXELS: &str = "\x1b[?1016h";
/// Sets mouse positions to cells.
pub(crate) const DISABLE_MOUSE_PIXELS: &str = "\x1b[?1016l";
/// Queries whether the terminal knows mode 1016 (DECRQM).
pub(crate) const QUERY_MOUSE_PIXELS: &str = "\x1b[?1016$p";

/// Resets colours and modifiers. It is a byte shorter than crossterm's sequence, and in every
/// frame.
pub(crate) const RESET_STYLE: &str = "\x1b[m";

/// Queries the keyboard flags; only a terminal with the kitty protocol answers.
pub(crate) const QUERY_KEY_FLAGS: &str = "\x1b[?u";
/// The name of the capability of 24-bit colours, in hexadecimal digits.
pub(crate) const RGB_CAPABILITY: &str = "524742";
/// Queries the terminal's name and version (XTVERSION). A terminal that knows device control
/// strings answers with one; all others ignore the query, since it is a control sequence.
pub(crate) const QUERY_VERSION: &str = "\x1b[>q";
/// Queries that capability (XTGETTCAP).
pub(crate) const QUERY_TRUE_COLOR: &str = "\x1bP+q524742\x1b\\";
/// Queries the device's status; the terminal answers when it has processed all bytes before.
pub(crate) const QUERY_STATUS: &str = "\x1b[5n";
/// Repeats a half block in the second row, queries the cursor's position, and erases the row.
pub(crate) const PROBE_REPETITION: &str = "\x1b[2;1H\u{2580}\x1b[3b\x1b[6n\x1b[2;1H\x1b[K";
/// The answer if the half block was repeated correctly. No key has this report; F3 has the
/// most similar one, with 1 in place of 2.
pub(crate) const REPEATED: &[u8] = b"\x1b[2;5R";
/// Moves the cursor to the upper left corner and erases the screen.
pub(crate) const ERASE: &str = "\x1b[H\x1b[J";
/// Queries the colour of a palette entry, defines it and another in one sequence, queries it again,
/// resets both, and queries it a third time.
pub(crate) const PROBE_PALETTE: &str = "\x1b]4;255;?\x07\
    \x1b]4;254;#123456;255;#12ab56\x07\x1b]4;255;?\x07\
    \x1b]104;254;255\x07\x1b]4;255;?\x07";
/// The beginning of the answers, before a colour as three hexadecimal numbers.
pub(crate) const PALETTE_REPORT: &[u8] = b"]4;255;rgb:";
/// The colour in the second answer if the definition worked, in 16 bits a channel.
pub(crate) const DEFINED: [u16; 3] = [0x1212, 0xabab, 0x5656];
/// The palette entries that may be defined; those below belong to the user or to themes of shells.
pub(crate) const PALETTE: RangeInclusive<u8> = 24..=255;

/// The sequences that reset the palette entries that may have been defined.
pub(crate) fn give_palette_back() -> String {
    /// Some terminals accept at most sixteen parameters.
    const AT_ONCE: usize = 15;
    let mut text = String::new();
    for (index, entry) in PALETTE.enumerate() {
        text.push_str(if index % AT_ONCE == 0 { "\x1b]104;" } else { ";" });
        text.push_str(&entry.to_string());
        text.push_str(if index % AT_ONCE == AT_ONCE - 1 || entry == u8::MAX { "\x07" } else { "" });
    }
    text
}

/// Queries the device's attributes, which every terminal answers, after all earlier queries.
pub(crate) const QUERY_FENCE: &str = "\x1b[c";

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
