//! Papers: the texels of columns as they are shaded, which is done once for many pixels.
//!
//! All papers that are in use lie in one piece of memory, of a size that is known: a place on them is
//! a number whose uppermost bits say which texel of them it is, and to look there needs no check.
//! Columns side by side that show the same texels in the same shade, as a near wall's do, have one
//! paper between them.

use super::texels_down::TexelsDown;
use crate::color::Rgb;

/// From one texel to the next, in [`Place`]s.
const TEXEL: u64 = 1 << (u64::BITS - BITS);

/// So many texels are on all papers together at most: those of as many columns as are drawn at once,
/// of most textures. What of it is not used takes no room where a processor has things at hand.
const TEXELS: usize = 1 << BITS;
const BITS: u32 = 14;

/// Papers that are in use, and room for more.
#[derive(Clone, Debug)]
pub(super) struct Papers {
    texels: Box<[Rgb; TEXELS]>,
    used: usize,
}

/// One of them, by where the first texel of its texture is, or would be.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper(Place);

/// A texel on one of them, in the uppermost bits, and a place on it in the others.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Place(u64);

impl Default for Papers {
    fn default() -> Self {
        let texels = vec![Rgb::BLACK; TEXELS].try_into().expect("it is as long as the array");
        Self { texels, used: 0 }
    }
}

impl Papers {
    /// As many texels as any of them has at most.
    pub(super) const MOST: usize = TEXELS - 1;

    /// Whether there is room for one of so many texels.
    pub(super) fn have_room_for(&self, texels: usize) -> bool {
        self.used + texels < TEXELS
    }

    /// One with those texels, shaded, if there is room.
    #[inline]
    pub(super) fn make(&mut self, texels: &[Rgb], shaded: impl Fn(Rgb) -> Rgb) -> Paper {
        let paper = Paper(self.next());
        self.add(texels, &shaded);
        // Rounding may take the last row one texel too far.
        self.add(&texels[texels.len().saturating_sub(1)..], &shaded);
        paper
    }

    /// One with all texels of `pieces`, shaded, if there is room. The first of them is the one at place `first`
    /// down its texture.
    #[inline]
    pub(super) fn make_of_pieces<'t>(
        &mut self,
        first: i64,
        pieces: impl Iterator<Item = &'t [Rgb]>,
        shaded: impl Fn(Rgb) -> Rgb,
    ) -> Paper {
        let paper = Paper(self.next().further((first.wrapping_neg() as u64).wrapping_mul(TEXEL)));
        for texels in pieces {
            self.add(texels, &shaded);
        }
        paper
    }

    fn next(&self) -> Place {
        Place(self.used as u64 * TEXEL)
    }

    #[inline]
    fn add(&mut self, texels: &[Rgb], shaded: impl Fn(Rgb) -> Rgb) {
        let papers = self.texels.get_mut(self.used..).unwrap_or_default();
        for (paper, &texel) in papers.iter_mut().zip(texels) {
            *paper = shaded(texel);
        }
        self.used += texels.len();
    }

    /// Throws all of them away.
    pub(super) fn clear(&mut self) {
        self.used = 0;
    }

    /// The texel at `place`.
    #[inline]
    pub(super) fn at(&self, Place(place): Place) -> Rgb {
        self.texels[(place / TEXEL) as usize]
    }
}

impl Paper {
    /// Where its first texel is.
    pub(super) fn start(self) -> Place {
        self.0
    }

    /// Where the centre of `row` is, and how far it is from there to the next row.
    #[inline]
    pub(super) fn down(self, down: TexelsDown, row: u32) -> (Place, u64) {
        let (place, step) = down.in_uppermost::<BITS>(row);
        (self.start().further(place), step)
    }
}

impl Place {
    #[inline]
    pub(super) fn further(self, by: u64) -> Self {
        Self(self.0.wrapping_add(by))
    }
}
