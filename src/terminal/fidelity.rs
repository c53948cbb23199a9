//! How near to what is wanted a terminal must show it.

use std::fmt;
use std::str::FromStr;

/// How far the colours that are shown may be from those that are wanted, to spare bytes.
///
/// The tolerance is a distance between two colours in CIE L\*a\*b\*, CIE76's ΔE: 0 is exact, 2 can just be
/// told apart side by side, and 100 is from black to white. No pixel is farther off; most are much
/// nearer. Text and indexed colours are always exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Fidelity {
    tolerance: u8,
}

impl Fidelity {
    /// What is shown is what is wanted.
    pub const EXACT: Self = Self::new(0);
    /// In the mean a difference of less than 1, for an eighth of the bytes of ratatui's encoder.
    pub const HIGH: Self = Self::new(10);
    /// In the mean a difference of less than 2, for a seventeenth of the bytes.
    pub const LOW: Self = Self::new(24);

    /// Colours up to `tolerance` from those that are wanted.
    pub const fn new(tolerance: u8) -> Self {
        Self { tolerance }
    }

    /// How far a colour may be from the one that is wanted.
    pub const fn tolerance(self) -> u8 {
        self.tolerance
    }
}

/// The fidelities that have a name.
const NAMED: [(&str, Fidelity); 3] =
    [("exact", Fidelity::EXACT), ("high", Fidelity::HIGH), ("low", Fidelity::LOW)];

/// The name, or the tolerance where it has none.
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

/// A text that is no fidelity.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnknownFidelity(String);

impl fmt::Display for UnknownFidelity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "'{}' is no fidelity: write exact, high, low or a number up to 255", self.0)
    }
}

impl std::error::Error for UnknownFidelity {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fidelity_is_read_as_it_is_written() {
        for tolerance in 0..=u8::MAX {
            let fidelity = Fidelity::new(tolerance);
            assert_eq!(fidelity.to_string().parse(), Ok(fidelity));
            assert_eq!(tolerance.to_string().parse(), Ok(fidelity));
        }
        assert_eq!("exact".parse(), Ok(Fidelity::EXACT));
    }

    #[test]
    fn what_is_no_fidelity_is_named() {
        for text in ["", "medium", "256", "-1", "4.5"] {
            let error = text.parse::<Fidelity>().unwrap_err().to_string();
            assert!(error.starts_with(&format!("'{text}' is no fidelity")), "{error}");
        }
    }
}
