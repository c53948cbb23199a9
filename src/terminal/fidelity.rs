//! The tolerance of colours on a terminal.

use std::fmt;
use std::str::FromStr;

/// The maximum difference between the colours that a terminal shows and the drawn colours. A larger
/// difference saves bytes.
///
/// The tolerance is a distance between two colours in CIE L\*a\*b\*, CIE76's ΔE: 0 is exact, 2 is
/// just noticeable side by side, and 100 is the distance from black to white. No colour exceeds it,
/// and most are much nearer.
///
/// The tolerance holds in every colour depth and glyph set:
///
/// - Half blocks in true colour save the most.
/// - A picture in 256 or 16 colours is compared after the widget has mixed the colours of the
///   palette. An indexed colour counts as xterm's standard one. The 16 named colours, which users
///   can redefine, can only replace each other. They save little, because few of them are near each
///   other.
/// - A character keeps its glyph and its modifiers. If it has no modifiers, its two colours may
///   differ.
/// - Without colours (`mono`), every cell is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fidelity {
    tolerance: u8,
}

impl Fidelity {
    /// All colours are exact.
    pub const EXACT: Self = Self::new(0);
    /// A mean difference of about 1 in true colour. It takes an eighth of the bytes of ratatui's
    /// encoder.
    pub const HIGH: Self = Self::new(10);
    /// A mean difference of about 2 in true colour. It takes a sixteenth of the bytes.
    pub const LOW: Self = Self::new(24);

    /// A fidelity with this tolerance, in ΔE.
    pub const fn new(tolerance: u8) -> Self {
        Self { tolerance }
    }

    /// The maximum distance of a colour from the drawn one, in ΔE.
    pub const fn tolerance(self) -> u8 {
        self.tolerance
    }
}

/// The effort that an encoder spends on finding few bytes within a tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Effort {
    /// A search through the ways to show each row.
    #[default]
    Search,
    /// A choice for each cell by itself, in a third of the time. It takes more bytes at the same
    /// error.
    Greedy,
}

/// The named fidelities.
const NAMED: [(&str, Fidelity); 3] =
    [("exact", Fidelity::EXACT), ("high", Fidelity::HIGH), ("low", Fidelity::LOW)];

/// Writes the name, or the tolerance if the fidelity has no name.
impl fmt::Display for Fidelity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match NAMED.iter().find(|(_, fidelity)| fidelity == self) {
            Some((name, _)) => f.pad(name),
            None => self.tolerance.fmt(f),
        }
    }
}

impl FromStr for Fidelity {
    type Err = UnknownFidelity;

    fn from_str(text: &str) -> Result<Self, UnknownFidelity> {
        match NAMED.iter().find(|(name, _)| *name == text) {
            Some(&(_, fidelity)) => Ok(fidelity),
            None => text.parse().map(Self::new).map_err(|_| UnknownFidelity(text.to_owned())),
        }
    }
}

/// The error for a text that is not a fidelity.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("'{0}' is not a fidelity: write exact, high, low or a number up to 255")]
pub struct UnknownFidelity(String);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fidelity_reads_back_as_written() {
        for tolerance in 0..=u8::MAX {
            let fidelity = Fidelity::new(tolerance);
            assert_eq!(fidelity.to_string().parse(), Ok(fidelity));
            assert_eq!(tolerance.to_string().parse(), Ok(fidelity));
        }
        assert_eq!("exact".parse(), Ok(Fidelity::EXACT));
    }

    #[test]
    fn the_error_names_the_invalid_text() {
        for text in ["", "medium", "256", "-1", "4.5"] {
            let error = text.parse::<Fidelity>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("'{text}' is not a fidelity")), "{error}");
        }
    }
}
