//! Changes of the terminal's state, and the sequences that undo them.

use std::time::Duration;

use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{
    DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate, EnterAlternateScreen,
};

use crate::terminal::event::MouseUnits;
use crate::terminal::sequence;

/// The program's changes to the terminal, and the answers that may still arrive.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Changes {
    pub(crate) key_flags: KeyFlags,
    /// The unit of mouse positions; `None` if the mouse is not reported.
    mouse: Option<MouseUnits>,
    pub(crate) fences: Fences,
    /// Whether answers to status requests may arrive.
    pub(crate) awaits_statuses: bool,
    /// Whether entries of the palette may have been defined.
    pub(crate) palette_defined: bool,
}

/// The state of the program's own keyboard flags, with which the terminal reports keys in the kitty protocol.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum KeyFlags {
    /// There are none.
    #[default]
    Unset,
    /// They were pushed, behind a frame that the terminal may not have read.
    Pushed,
    /// They were pushed, and the terminal has answered all frames before them.
    Received,
}

impl Changes {
    /// Adds the sequences that take the screen, which is the alternate one, without a cursor, and that enable the
    /// reports.
    pub(crate) fn push_start(&mut self, text: &mut String) {
        text.push_str(&sequence::of(EnterAlternateScreen));
        text.push_str(&sequence::of(Hide));
        // Long lines are cut, so that a narrower window does not scroll.
        text.push_str(&sequence::of(DisableLineWrap));
        text.push_str(sequence::RESET_STYLE);
        text.push_str(sequence::ENABLE_FOCUS_REPORTS);
        if self.key_flags != KeyFlags::Unset {
            text.push_str(sequence::PUSH_KEY_FLAGS);
            self.key_flags = KeyFlags::Pushed;
        }
        push_mouse(text, None, self.mouse);
    }

    /// Sets whether and in which unit the mouse is reported.
    pub(crate) fn change_mouse(&mut self, mouse: Option<MouseUnits>, text: &mut String) {
        push_mouse(text, self.mouse, mouse);
        self.mouse = mouse;
    }

    /// The sequences that undo all changes, in reverse order, but leave the alternate screen. If
    /// input may still arrive, a fence is among them, whose answer follows all of it.
    pub(crate) fn end(&mut self, now: Duration) -> String {
        let mut text = self.end_of_frame();
        self.push_end_of_reports(self.key_flags, &mut text);
        if self.has_pending_reports() {
            text.push_str(sequence::QUERY_FENCE);
            self.fences.sent(now);
            self.awaits_statuses = false;
        }
        push_end_of_screen(&mut text);
        text
    }

    /// The same sequences for a terminal that does not read, some of whose input was discarded before
    /// it was read. There is no fence among them, whose answer would arrive too late.
    pub(crate) fn end_after_loss(&mut self) -> String {
        let mut text = self.end_of_frame();
        let mut key_flags = self.key_flags;
        if key_flags == KeyFlags::Pushed {
            // A pop without its push would take the flags of another program.
            text.push_str(sequence::CLEAR_KEY_FLAGS);
            key_flags = KeyFlags::Unset;
        }
        self.push_end_of_reports(key_flags, &mut text);
        push_end_of_screen(&mut text);
        self.fences.forget();
        text
    }

    /// Records that no keyboard flags of the program were sent: they need not be undone.
    pub(crate) fn forget_key_flags(&mut self) {
        self.key_flags = KeyFlags::Unset;
    }

    /// Records that the terminal may have received a part of what [`Changes::end`] has returned.
    pub(crate) fn doubt_key_flags(&mut self) {
        if self.key_flags == KeyFlags::Received {
            self.key_flags = KeyFlags::Pushed;
        }
    }

    fn end_of_frame(&self) -> String {
        let mut text = sequence::of(EndSynchronizedUpdate) + sequence::RESET_STYLE;
        if self.palette_defined {
            text.push_str(&sequence::give_palette_back());
        }
        text
    }

    /// Adds the sequences that disable the reports.
    fn push_end_of_reports(&self, key_flags: KeyFlags, text: &mut String) {
        push_mouse(text, self.mouse, None);
        if key_flags != KeyFlags::Unset {
            text.push_str(sequence::POP_KEY_FLAGS);
        }
        text.push_str(sequence::DISABLE_FOCUS_REPORTS);
    }

    /// Whether the terminal may have sent input that is not read yet: a key release, which it sends
    /// until its flags are popped, a motion of the mouse, or the answer to a frame. Focus reports
    /// do not count: few are sent, and waiting for a terminal that answers nothing takes a second.
    fn has_pending_reports(&self) -> bool {
        let has_frequent_reports = self.key_flags != KeyFlags::Unset || self.mouse.is_some();
        has_frequent_reports || self.awaits_statuses || self.fences.are_answered()
    }
}

fn push_end_of_screen(text: &mut String) {
    text.push_str(&sequence::of(EnableLineWrap));
    text.push_str(&sequence::of(Show));
}

/// Adds the sequences that change mouse reports from `before` to `mouse`.
fn push_mouse(text: &mut String, before: Option<MouseUnits>, mouse: Option<MouseUnits>) {
    match (before, mouse) {
        (None, Some(_)) => text.push_str(sequence::ENABLE_MOUSE),
        (Some(_), None) => text.push_str(sequence::DISABLE_MOUSE),
        _ => {}
    }
    let [was_in_pixels, is_in_pixels] =
        [before, mouse].map(|units| units == Some(MouseUnits::Pixels));
    match (was_in_pixels, is_in_pixels) {
        (false, true) => text.push_str(sequence::ENABLE_MOUSE_PIXELS),
        (true, false) => text.push_str(sequence::DISABLE_MOUSE_PIXELS),
        _ => {}
    }
}

/// How long to wait for the answer of a terminal that has never answered.
const TIMEOUT: Duration = Duration::from_secs(1);
/// How long to wait for a terminal that has answered before, and so will again. A shell would print a later answer.
const TIMEOUT_AFTER_ANSWER: Duration = Duration::from_secs(5);

/// Fences: queries that every terminal answers. Here, those without an answer yet.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fences {
    open: u32,
    last_sent: Duration,
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

    /// Expects no answer any more.
    pub(crate) fn forget(&mut self) {
        self.open = 0;
    }

    /// Whether the terminal has ever answered a fence.
    fn are_answered(&self) -> bool {
        self.are_answered
    }

    /// Whether a fence is unanswered.
    pub(crate) fn are_open(&self) -> bool {
        self.open > 0
    }

    /// The remaining time to wait for an answer; `None` if no answer is expected any more.
    pub(crate) fn time_left(&self, now: Duration) -> Option<Duration> {
        let timeout = if self.are_answered { TIMEOUT_AFTER_ANSWER } else { TIMEOUT };
        let left = timeout.checked_sub(now.saturating_sub(self.last_sent))?;
        self.are_open().then_some(left)
    }
}
