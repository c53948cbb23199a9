//! Reports from the terminal: of the focus always, of keys and the mouse on request.

use crate::terminal::mouse::MouseUnits;
use crate::terminal::sequence;

/// The enabled reports while the terminal is taken.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reports {
    /// Whether keys are reported in the kitty protocol.
    pub(super) has_key_flags: bool,
    /// The unit of mouse positions; `None` if the mouse is not reported.
    mouse: Option<MouseUnits>,
}

impl Reports {
    /// Whether a key or mouse report may arrive at any time.
    pub(super) fn are_frequent(self) -> bool {
        self.has_key_flags || self.mouse.is_some()
    }

    /// Adds the sequences that enable the reports.
    pub(super) fn push_start(self, text: &mut String) {
        text.push_str(sequence::ENABLE_FOCUS_REPORTS);
        if self.has_key_flags {
            text.push_str(sequence::PUSH_KEY_FLAGS);
        }
        push_mouse(text, None, self.mouse);
    }

    /// Adds the sequences that disable the reports, in reverse order.
    pub(super) fn push_end(self, text: &mut String) {
        push_mouse(text, self.mouse, None);
        if self.has_key_flags {
            text.push_str(sequence::POP_KEY_FLAGS);
        }
        text.push_str(sequence::DISABLE_FOCUS_REPORTS);
    }

    /// Sets whether and in which unit the mouse is reported.
    pub(super) fn change_mouse(&mut self, mouse: Option<MouseUnits>, text: &mut String) {
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
