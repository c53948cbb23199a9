//! Coverings: what a floor or a ceiling is laid with.

use super::Paint;

/// What a floor or a ceiling is laid with: paints, and how large they are laid.
///
/// A texture lies as it looks from above, north up, with its corner at the map's; a ceiling shows
/// the same texel as a floor would, straight above it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covering {
    /// Which paint lies where.
    pub pattern: Pattern,
    /// How large a piece of the pattern is.
    pub scale: Scale,
}

/// Which paint lies where. A piece is a square of the covering's [`Scale`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// The same everywhere.
    Plain(Paint),
    /// By turns from piece to piece, like a chessboard; the first in the north-west corner.
    Checker([Paint; 2]),
    /// By turns from one row of pieces to the next, the first in the north.
    Stripes([Paint; 2]),
}

/// Cells that one repeat of a texture stretches over, along both axes: above 0, and finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// A cell for each repeat.
    pub const ONE: Self = Self(1.0);

    /// A scale of `cells`. `None` where that is not above 0 and finite.
    pub fn new(cells: f64) -> Option<Self> {
        (cells > 0.0 && cells.is_finite()).then_some(Self(cells))
    }

    /// Cells for each repeat.
    pub fn cells(self) -> f64 {
        self.0
    }
}

impl From<Paint> for Covering {
    /// One paint everywhere, in its own size.
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

    /// The paints it consists of.
    pub fn paints(&self) -> &[Paint] {
        match self {
            Self::Plain(paint) => std::slice::from_ref(paint),
            Self::Checker(paints) | Self::Stripes(paints) => paints,
        }
    }
}

/// What is overhead.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ceiling {
    /// Nothing but the sky.
    Sky,
    /// A ceiling.
    Covered(Covering),
}
