//! Coverings: the surfaces of floors and ceilings.

use super::Paint;

/// The surface of a floor or a ceiling: paints in a pattern, and the scale of the pattern.
///
/// A texture is oriented with its top in the north, and its corner at the corner of the map. A
/// ceiling has the same texel as a floor below it would have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covering {
    /// Which paint is where.
    pub pattern: Pattern,
    /// The size of a piece of the pattern.
    pub scale: Scale,
}

/// An arrangement of paints in pieces. A piece is a square with sides of the covering's [`Scale`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// One paint everywhere.
    Plain(Paint),
    /// Two paints alternating like a chessboard, the first in the north-west corner.
    Checker([Paint; 2]),
    /// Two paints alternating from row to row, the first in the north.
    Stripes([Paint; 2]),
}

/// The number of cells that one repeat of a texture covers along both axes: finite and above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// One cell.
    pub const ONE: Self = Self(1.0);

    /// A scale of `cells`. `None` unless that is finite and above 0.
    pub fn new(cells: f64) -> Option<Self> {
        (cells > 0.0 && cells.is_finite()).then_some(Self(cells))
    }

    /// The number of cells.
    pub fn cells(self) -> f64 {
        self.0
    }
}

impl From<Paint> for Covering {
    /// One paint everywhere, at a scale of one cell.
    fn from(paint: Paint) -> Self {
        Self { pattern: Pattern::Plain(paint), scale: Scale::ONE }
    }
}

impl Pattern {
    /// The paint in the north-west corner.
    pub fn first_paint(&self) -> Paint {
        match *self {
            Self::Plain(paint) | Self::Checker([paint, _]) | Self::Stripes([paint, _]) => paint,
        }
    }

    /// The paints of the pattern.
    pub fn paints(&self) -> &[Paint] {
        match self {
            Self::Plain(paint) => std::slice::from_ref(paint),
            Self::Checker(paints) | Self::Stripes(paints) => paints,
        }
    }
}

/// A ceiling, or its absence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ceiling {
    /// No ceiling: the sky shows.
    Sky,
    /// A ceiling with this covering.
    Covered(Covering),
}
