//! Changes of the terminal's state, and the sequences that undo them.

use std::time::Duration;

use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{
    DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate, EnterAlternateScreen,
};

use super::fences::Fences;
use super::reports::{KeyFlags, Reports};
use crate::terminal::sequence;

/// What the program has changed in the terminal, and which answers may still arrive.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Changes {
    pub(crate) reports: Reports,
    pub(crate) fences: Fences,
    /// Whether answers to status requests may arrive.
    pub(crate) awaits_statuses: bool,
    /// Whether entries of the palette may have been defined.
    pub(crate) palette_defined: bool,
}

impl Changes {
    /// Adds the sequences that take the screen: the alternate one, without a cursor.
    pub(crate) fn push_start(&mut self, text: &mut String) {
        text.push_str(&sequence::of(EnterAlternateScreen));
        text.push_str(&sequence::of(Hide));
        // Long lines are cut, so that a narrower window does not scroll.
        text.push_str(&sequence::of(DisableLineWrap));
        text.push_str(sequence::RESET_STYLE);
        self.reports.push_start(text);
    }

    /// The sequences that undo all changes, in reverse order, but leave the alternate screen. If
    /// input may still arrive, a fence is among them, whose answer follows all of it.
    pub(crate) fn end(&mut self, now: Duration) -> String {
        let mut text = self.end_of_frame();
        self.reports.push_end(&mut text);
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
        self.reports.push_end_after_loss(&mut text);
        push_end_of_screen(&mut text);
        self.fences.forget();
        text
    }

    /// Records that no keyboard flags of the program were sent: they need not be undone.
    pub(crate) fn forget_key_flags(&mut self) {
        self.reports.key_flags = KeyFlags::Unset;
    }

    /// Records that the terminal may have received a part of what [`Changes::end`] has returned.
    pub(crate) fn doubt_key_flags(&mut self) {
        if self.reports.key_flags == KeyFlags::Received {
            self.reports.key_flags = KeyFlags::Pushed;
        }
    }

    fn end_of_frame(&self) -> String {
        let mut text = sequence::of(EndSynchronizedUpdate) + sequence::RESET_STYLE;
        if self.palette_defined {
            text.push_str(&sequence::give_palette_back());
        }
        text
    }

    /// Whether the terminal may have sent input that is not read yet: a key release, which it sends
    /// until its flags are popped, a motion of the mouse, or the answer to a frame. Focus reports
    /// do not count: few are sent, and waiting for a terminal that answers nothing takes a second.
    fn has_pending_reports(&self) -> bool {
        self.reports.are_frequent() || self.awaits_statuses || self.fences.are_answered()
    }
}

fn push_end_of_screen(text: &mut String) {
    text.push_str(&sequence::of(EnableLineWrap));
    text.push_str(&sequence::of(Show));
}
