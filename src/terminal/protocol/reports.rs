//! Reports from the terminal: of the focus always, of keys and the mouse on request.

use crate::terminal::mouse::MouseUnits;
use crate::terminal::sequence;

/// The enabled reports while the terminal is taken.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Reports {
    pub(crate) key_flags: KeyFlags,
    /// The unit of mouse positions; `None` if the mouse is not reported.
    mouse: Option<MouseUnits>,
}

/// What is known about keyboard flags of the program's own, with which keys are reported in the kitty
/// protocol.
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

impl Reports {
    /// Whether a key or mouse report may arrive at any time.
    pub(crate) fn are_frequent(self) -> bool {
        self.key_flags != KeyFlags::Unset || self.mouse.is_some()
    }

    /// Adds the sequences that enable the reports.
    pub(crate) fn push_start(&mut self, text: &mut String) {
        text.push_str(sequence::ENABLE_FOCUS_REPORTS);
        if self.key_flags != KeyFlags::Unset {
            text.push_str(sequence::PUSH_KEY_FLAGS);
            self.key_flags = KeyFlags::Pushed;
        }
        push_mouse(text, None, self.mouse);
    }

    /// Adds the sequences that disable the reports, in reverse order.
    pub(crate) fn push_end(self, text: &mut String) {
        push_mouse(text, self.mouse, None);
        if self.key_flags != KeyFlags::Unset {
            text.push_str(sequence::POP_KEY_FLAGS);
        }
        text.push_str(sequence::DISABLE_FOCUS_REPORTS);
    }

    /// Does the same for a terminal that may have lost what was sent to it. A pop without its push
    /// would take the flags of another program.
    pub(crate) fn push_end_after_loss(self, text: &mut String) {
        let known = match self.key_flags {
            KeyFlags::Pushed => {
                text.push_str(sequence::CLEAR_KEY_FLAGS);
                KeyFlags::Unset
            }
            known => known,
        };
        Self { key_flags: known, ..self }.push_end(text);
    }

    /// Sets whether and in which unit the mouse is reported.
    pub(crate) fn change_mouse(&mut self, mouse: Option<MouseUnits>, text: &mut String) {
        push_mouse(text, self.mouse, mouse);
        self.mouse = mouse;
    }
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
