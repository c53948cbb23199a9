//! Changes to the terminal's state and the sequences that undo them, and the control sequences that crossterm lacks or
//! writes in another form.
//!
//! Crossterm couples the keyboard flags with its event reader, which this crate does not use. It also formats colours
//! and motions in a way that takes longer than the rest of a cell's encoding.

use std::ops::RangeInclusive;
use std::time::Duration;

use crossterm::Command;
use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{
    DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate, EnterAlternateScreen,
};

use crate::terminal::event::MouseUnits;

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
/// Clears the current keyboard flags, and leaves the stack of pushed flags.
pub(crate) const CLEAR_KEY_FLAGS: &str = "\x1b[=0u";
/// Restores the previous keyboard flags.
pub(crate) const POP_KEY_FLAGS: &str = "\x1b[<u";

/// Enables reports of the window's focus.
const ENABLE_FOCUS_REPORTS: &str = "\x1b[?1004h";
/// Disables reports of the window's focus.
const DISABLE_FOCUS_REPORTS: &str = "\x1b[?1004l";
/// Enables reports of all motions of the mouse and of its buttons, as decimal numbers.
pub(crate) const ENABLE_MOUSE: &str = "\x1b[?1003h\x1b[?1006h";
/// Disables reports of the mouse.
pub(crate) const DISABLE_MOUSE: &str = "\x1b[?1003l\x1b[?1006l";
/// Sets mouse positions to pixels. This mode replaces mode 1006, so it is set after mode 1006.
const ENABLE_MOUSE_PIXELS: &str = "\x1b[?1016h";
/// Sets mouse positions to cells.
const DISABLE_MOUSE_PIXELS: &str = "\x1b[?1016l";
/// Queries whether the terminal supports mode 1016 (DECRQM).
pub(crate) const QUERY_MOUSE_PIXELS: &str = "\x1b[?1016$p";

/// Resets colours and modifiers. The sequence is a byte shorter than crossterm's, and every frame contains it.
pub(crate) const RESET_STYLE: &str = "\x1b[m";

/// Queries the keyboard flags. Only a terminal with the kitty protocol answers.
pub(crate) const QUERY_KEY_FLAGS: &str = "\x1b[?u";
/// The name of the capability of 24-bit colours, in hexadecimal digits.
pub(crate) const RGB_CAPABILITY: &str = "524742";
/// Queries the terminal's name and version (XTVERSION). A terminal that supports device control strings answers with
/// one. All other terminals ignore the query, because it is a control sequence.
pub(crate) const QUERY_VERSION: &str = "\x1b[>q";
/// Queries the capability of 24-bit colours (XTGETTCAP).
pub(crate) const QUERY_TRUE_COLOR: &str = "\x1bP+q524742\x1b\\";
/// Queries the device's status. The terminal answers when it has processed all earlier bytes.
pub(crate) const QUERY_STATUS: &str = "\x1b[5n";
/// Repeats a half block in the second row, queries the cursor's position, and erases the row.
pub(crate) const PROBE_REPETITION: &str = "\x1b[2;1H\u{2580}\x1b[3b\x1b[6n\x1b[2;1H\x1b[K";
/// The answer if the half block was repeated correctly. No key sends this report. F3 sends the most similar one, with
/// 1 in place of 2.
pub(crate) const REPEATED: &[u8] = b"\x1b[2;5R";
/// Moves the cursor to the upper left corner and erases the screen.
pub(crate) const ERASE: &str = "\x1b[H\x1b[J";
/// Queries the colour of a palette entry, defines it and another in one sequence, queries it again,
/// resets both, and queries it a third time.
pub(crate) const PROBE_PALETTE: &str = "\x1b]4;255;?\x07\
    \x1b]4;254;#123456;255;#12ab56\x07\x1b]4;255;?\x07\
    \x1b]104;254;255\x07\x1b]4;255;?\x07";
/// The beginning of each answer to [`PROBE_PALETTE`], before a colour as three hexadecimal numbers.
pub(crate) const PALETTE_REPORT: &[u8] = b"]4;255;rgb:";
/// The colour in the second answer if the definition worked, with 16 bits per channel.
pub(crate) const DEFINED: [u16; 3] = [0x1212, 0xabab, 0x5656];
/// The palette entries that may be defined. Lower entries belong to the user or to themes of shells.
pub(crate) const PALETTE: RangeInclusive<u8> = 24..=255;

/// The sequences that reset the palette entries that may have been defined.
fn give_palette_back() -> String {
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

/// Queries the device's attributes. Every terminal answers this, after all earlier queries.
pub(crate) const QUERY_FENCE: &str = "\x1b[c";

/// The program's changes to the terminal, and the answers that may still arrive.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TerminalChanges {
    pub(crate) key_flags: KeyFlags,
    /// The unit of mouse positions. `None` if the mouse is not reported.
    pub(crate) mouse: Option<MouseUnits>,
    pub(crate) fences: Fences,
    /// `true` while answers to status requests may arrive.
    pub(crate) awaits_statuses: bool,
    /// `true` if entries of the palette may have been defined.
    pub(crate) palette_defined: bool,
}

/// The state of the program's own keyboard flags, which make the terminal report keys in the kitty protocol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum KeyFlags {
    /// No flags were pushed.
    #[default]
    Unset,
    /// The flags were pushed, behind a frame that the terminal may not have read.
    Pushed,
    /// The flags were pushed, and the terminal has answered all frames before them.
    Received,
}

impl TerminalChanges {
    /// The sequences that take the alternate screen, hide the cursor and enable the reports.
    pub(crate) fn start(&mut self) -> String {
        let mut text = of(EnterAlternateScreen) + &of(Hide);
        // Long lines are cut, so that a narrower window does not scroll.
        text.push_str(&of(DisableLineWrap));
        text.push_str(RESET_STYLE);
        text.push_str(ENABLE_FOCUS_REPORTS);
        if self.key_flags != KeyFlags::Unset {
            text.push_str(PUSH_KEY_FLAGS);
            self.key_flags = KeyFlags::Pushed;
        }
        text + &mouse_change(None, self.mouse)
    }

    /// Sets whether and in which unit the mouse is reported, and returns the sequences for it.
    pub(crate) fn change_mouse(&mut self, mouse: Option<MouseUnits>) -> String {
        mouse_change(std::mem::replace(&mut self.mouse, mouse), mouse)
    }

    /// The sequences that undo all changes, in reverse order, except for the alternate screen. If input may still
    /// arrive, they include a fence. Its answer follows all other input.
    pub(crate) fn end(&mut self, now: Duration) -> String {
        let mut text = self.end_of_frame();
        self.push_end_of_reports(self.key_flags, &mut text);
        if self.has_pending_reports() {
            text.push_str(QUERY_FENCE);
            self.fences.sent(now);
            self.awaits_statuses = false;
        }
        text + &end_of_screen()
    }

    /// The same sequences for a terminal that does not read, after some bytes for it were discarded. They include no
    /// fence, because its answer would arrive too late.
    pub(crate) fn end_after_loss(&mut self) -> String {
        let mut text = self.end_of_frame();
        let mut key_flags = self.key_flags;
        if key_flags == KeyFlags::Pushed {
            // A pop without its push would take the flags of another program.
            text.push_str(CLEAR_KEY_FLAGS);
            key_flags = KeyFlags::Unset;
        }
        self.push_end_of_reports(key_flags, &mut text);
        self.fences.forget();
        text + &end_of_screen()
    }

    /// Records that no keyboard flags of the program were sent, so they need not be undone.
    pub(crate) fn forget_key_flags(&mut self) {
        self.key_flags = KeyFlags::Unset;
    }

    /// Records that the terminal may have received a part of the sequences from [`TerminalChanges::end`].
    pub(crate) fn mark_key_flags_uncertain(&mut self) {
        if self.key_flags == KeyFlags::Received {
            self.key_flags = KeyFlags::Pushed;
        }
    }

    fn end_of_frame(&self) -> String {
        let mut text = of(EndSynchronizedUpdate) + RESET_STYLE;
        if self.palette_defined {
            text.push_str(&give_palette_back());
        }
        text
    }

    /// Adds the sequences that disable the reports.
    fn push_end_of_reports(&self, key_flags: KeyFlags, text: &mut String) {
        text.push_str(&mouse_change(self.mouse, None));
        if key_flags != KeyFlags::Unset {
            text.push_str(POP_KEY_FLAGS);
        }
        text.push_str(DISABLE_FOCUS_REPORTS);
    }

    /// Returns true if the terminal may have sent input that is not read yet: a key release, which it sends until the
    /// flags are popped, a motion of the mouse, or the answer to a frame. Focus reports do not count, because few are
    /// sent, and waiting for a terminal that never answers takes a second.
    fn has_pending_reports(&self) -> bool {
        let has_frequent_reports = self.key_flags != KeyFlags::Unset || self.mouse.is_some();
        has_frequent_reports || self.awaits_statuses || self.fences.are_answered
    }
}

fn end_of_screen() -> String {
    of(EnableLineWrap) + &of(Show)
}

/// The sequences that change mouse reports from `before` to `after`.
fn mouse_change(before: Option<MouseUnits>, after: Option<MouseUnits>) -> String {
    let reports = match (before, after) {
        (None, Some(_)) => ENABLE_MOUSE,
        (Some(_), None) => DISABLE_MOUSE,
        _ => "",
    };
    let units = match [before, after].map(|units| units == Some(MouseUnits::Pixels)) {
        [false, true] => ENABLE_MOUSE_PIXELS,
        [true, false] => DISABLE_MOUSE_PIXELS,
        _ => "",
    };
    [reports, units].concat()
}

/// The time to wait for the answer of a terminal that has never answered.
const TIMEOUT: Duration = Duration::from_secs(1);
/// The time to wait for a terminal that has answered before, and that will therefore answer again. A shell would print
/// a later answer.
const TIMEOUT_AFTER_ANSWER: Duration = Duration::from_secs(5);

/// The unanswered fences. A fence is a query that every terminal answers.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fences {
    open: u32,
    last_sent: Duration,
    /// `true` if the terminal has ever answered a fence.
    are_answered: bool,
}

impl Fences {
    pub(crate) fn sent(&mut self, now: Duration) {
        self.open += 1;
        self.last_sent = now;
    }

    pub(crate) fn answered(&mut self) {
        self.open = self.open.saturating_sub(1);
        self.are_answered = true;
    }

    /// Stops expecting answers.
    pub(crate) fn forget(&mut self) {
        self.open = 0;
    }

    /// Returns true while a fence is unanswered.
    pub(crate) fn are_open(&self) -> bool {
        self.open > 0
    }

    /// The remaining time to wait for an answer. `None` if no more answers are expected.
    pub(crate) fn time_left(&self, now: Duration) -> Option<Duration> {
        let timeout = if self.are_answered { TIMEOUT_AFTER_ANSWER } else { TIMEOUT };
        let left = timeout.checked_sub(now.saturating_sub(self.last_sent))?;
        self.are_open().then_some(left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colour_query_names_the_rgb_capability() {
        assert!(QUERY_TRUE_COLOR.contains(RGB_CAPABILITY));
        let name = b"RGB".map(|byte| format!("{byte:02x}")).concat();
        assert_eq!(RGB_CAPABILITY, name);
    }
}
