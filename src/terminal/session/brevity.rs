//! What makes frames shorter where the terminal proves that it understands it.
//!
//! Two things are tried at the start, and used once the answer shows that they worked: a half block that is
//! repeated (REP) must move the cursor as far as it should, and an entry of the palette that is defined
//! (OSC 4) must be answered as it was defined, in the very form that frames use. Terminals that claim the one
//! and get it wrong for half blocks are known; so no name or version of a terminal is trusted.
//!
//! Neither is tried in a multiplexer, which would answer for itself, nor while everything that is sent is
//! recorded: a recording is to play on any terminal.

use super::Session;
use crate::color::palette::ColorDepth;
use crate::terminal::sequence;

/// What is known of it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Brevity {
    /// Whether it was tried.
    tried: bool,
    /// Whether the palette is as it was defined.
    defines_palette: bool,
}

impl Session {
    /// Adds what tries it to `queries`.
    pub(super) fn try_brevity(&mut self, queries: &mut String) {
        self.brevity.tried = true;
        queries.push_str(sequence::TRY_PALETTE);
        queries.push_str(sequence::TRY_REPETITION);
        self.guard.palette_defined();
    }

    /// A half block was repeated.
    pub(super) fn repeats_blocks(&mut self) {
        if self.brevity.tried {
            self.writer.set_repeats(true);
        }
    }

    /// The palette was defined.
    pub(super) fn defines_palette(&mut self) {
        self.brevity.defines_palette = self.brevity.tried;
        self.use_palette();
    }

    /// Uses the palette where it may be defined, and all colours are shown.
    pub(super) fn use_palette(&mut self) {
        if self.brevity.defines_palette && self.color_depth() == ColorDepth::True {
            self.writer.set_palette(true);
        }
    }
}
