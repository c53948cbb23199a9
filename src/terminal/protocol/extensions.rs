//! Control sequences that make frames shorter, used if the terminal proves that they work.
//!
//! The program probes two at the beginning. A repeated half block (REP) must move the cursor as far
//! as it should. An entry of the palette, defined in the form that frames use (OSC 4), must be
//! reported as defined, and with its old colour after a reset (OSC 104). Some terminals claim to
//! repeat characters and fail on half blocks, so that no terminal is trusted by its name or
//! version.
//!
//! A terminal of 256 colours whose palette can be defined and reset shows 24-bit colours as entries of
//! its own.
//!
//! Neither is probed in a multiplexer, which would answer for itself, nor if a recorder receives
//! the sent bytes, since a recording must play on any terminal.

use super::Protocol;
use crate::color::palette::ColorDepth;
use crate::terminal::{ColorSource, Detected, Event, sequence};

/// The results of the probes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extensions {
    is_probed: bool,
    palette: Palette,
    /// Whether all colours are shown as entries of the palette.
    owns_palette: bool,
}

/// The reported state of the probed palette entry, as colours of 16 bits a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Palette {
    #[default]
    Unknown,
    /// The terminal's own colour.
    Own([u16; 3]),
    /// The defined colour, in place of the terminal's own.
    Defined { own: [u16; 3] },
    /// The terminal's own colour, after the reset.
    Reset,
    /// A wrong colour.
    Refused,
}

impl Palette {
    /// The state after a report of `color`.
    fn after_report(self, color: [u16; 3]) -> Self {
        match self {
            Self::Unknown => Self::Own(color),
            Self::Own(own) if color == sequence::DEFINED => Self::Defined { own },
            Self::Defined { own } if color == own => Self::Reset,
            Self::Own(_) | Self::Defined { .. } | Self::Reset | Self::Refused => Self::Refused,
        }
    }
}

impl Protocol {
    /// Adds the probes to `queries`.
    pub(crate) fn probe_extensions(&mut self, queries: &mut String) {
        self.extensions.is_probed = true;
        queries.push_str(sequence::PROBE_PALETTE);
        queries.push_str(sequence::PROBE_REPETITION);
        self.changes.palette_defined = true;
    }

    /// Records that the terminal has repeated a half block.
    pub(crate) fn repeats_blocks(&mut self) {
        if self.extensions.is_probed {
            self.writer.set_repeats(true);
        }
    }

    /// Records the terminal's report of the colour of the probed palette entry.
    pub(crate) fn palette_reported(&mut self, color: [u16; 3]) {
        if self.extensions.is_probed {
            self.extensions.palette = self.extensions.palette.after_report(color);
            self.use_palette();
        }
    }

    /// Uses the palette if it can be defined and reset and the terminal shows 24-bit colours.
    pub(crate) fn use_palette(&mut self) {
        let is_true = matches!(self.color_depth, Detected::Certain(ColorDepth::True))
            || self.color_depth() == ColorDepth::True && !self.extensions.owns_palette;
        if self.extensions.palette == Palette::Reset && is_true {
            self.extensions.owns_palette = false;
            self.writer.set_palette(true);
        }
    }

    /// Shows all colours as entries of the palette if they can be defined and reset and the terminal
    /// has not answered that it shows 24-bit colours. Called after all its answers.
    pub(crate) fn use_own_palette(&mut self) {
        let shows_few = self.color_depth == Detected::Guess(ColorDepth::Indexed256);
        if self.extensions.palette == Palette::Reset && shows_few && !self.is_ending {
            self.extensions.owns_palette = true;
            self.writer.set_own_palette();
            self.color_depth = Detected::Guess(ColorDepth::True);
            self.color_source = ColorSource::Palette;
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const OWN: [u16; 3] = [0xeeee; 3];
    const DEFINED: [u16; 3] = sequence::DEFINED;

    fn after(reports: &[[u16; 3]]) -> Palette {
        reports.iter().fold(Palette::default(), |palette, color| palette.after_report(*color))
    }

    #[test]
    fn a_palette_is_usable_that_is_defined_and_reset() {
        assert_eq!(after(&[OWN, DEFINED, OWN]), Palette::Reset);
        for reports in [
            &[OWN][..],
            &[OWN, DEFINED],
            &[OWN, OWN],
            &[OWN, OWN, OWN],
            &[OWN, DEFINED, DEFINED],
            &[OWN, [0; 3], OWN],
            &[DEFINED, DEFINED, OWN],
            &[OWN, DEFINED, OWN, OWN],
        ] {
            assert_ne!(after(reports), Palette::Reset, "{reports:x?}");
        }
    }
}
