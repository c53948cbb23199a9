//! The control sequences that this program sends, each by its name.
//!
//! Those that change a mode stand beside those that change it back.

/// Starts a control sequence.
pub(super) const INTRODUCER: &str = "\x1b[";
/// Stands between the parameters of a control sequence.
pub(super) const SEPARATOR: &str = ";";

/// Opens the alternate screen, cleared, and keeps the cursor's place in the other one.
pub(super) const ENTER_ALTERNATE_SCREEN: &str = "\x1b[?1049h";
/// Goes back to the screen, and the place in it, that were left.
pub(super) const LEAVE_ALTERNATE_SCREEN: &str = "\x1b[?1049l";

/// Hides the cursor.
pub(super) const HIDE_CURSOR: &str = "\x1b[?25l";
/// Shows the cursor.
pub(super) const SHOW_CURSOR: &str = "\x1b[?25h";

/// What is too long for a line is cut, so a window made narrower does not scroll.
pub(super) const DISABLE_WRAP: &str = "\x1b[?7l";
/// What is too long for a line goes on in the next, which is how terminals start.
pub(super) const ENABLE_WRAP: &str = "\x1b[?7h";

/// Shows nothing of what follows (DEC 2026)...
pub(super) const BEGIN_SYNCHRONIZED: &str = "\x1b[?2026h";
/// ...until here.
pub(super) const END_SYNCHRONIZED: &str = "\x1b[?2026l";

/// Asks for every key as an escape code, with presses, repeats and releases, and with the character
/// that Shift makes of it: the kitty keyboard protocol's flags 1, 2, 4 and 8.
pub(super) const PUSH_KEY_FLAGS: &str = "\x1b[>15u";
/// Goes back to the flags from before.
pub(super) const POP_KEY_FLAGS: &str = "\x1b[<u";

/// Colours and modifiers as they were at the start.
pub(super) const RESET_STYLE: &str = "\x1b[m";
/// Erases the screen, in the current background.
pub(super) const CLEAR: &str = "\x1b[2J";
/// Erases from the cursor to the end of the screen.
pub(super) const CLEAR_AFTER_CURSOR: &str = "\x1b[J";
/// Erases from the start of the screen to the cursor.
pub(super) const CLEAR_BEFORE_CURSOR: &str = "\x1b[1J";
/// Erases the cursor's line.
pub(super) const CLEAR_LINE: &str = "\x1b[2K";
/// Erases from the cursor to the end of its line.
pub(super) const CLEAR_REST_OF_LINE: &str = "\x1b[K";

/// Asks for the keyboard flags; only a terminal that speaks the protocol answers.
pub(super) const QUERY_KEY_FLAGS: &str = "\x1b[?u";
/// The name of the capability to show 24-bit colours, in hexadecimal digits.
pub(super) const RGB_CAPABILITY: &str = "524742";
/// Asks for that capability.
pub(super) const QUERY_TRUE_COLOR: &str = "\x1bP+q524742\x1b\\";
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
