//! Papers: the texels of columns as they are shaded, which is done once for many pixels.
//!
//! All papers that are in use lie in one piece of memory, of a size that is known: a place on them is
//! a number whose uppermost bits say which texel of them it is, and to look there needs no check.
//! Columns side by side that show the same texels in the same shade, as a near wall's do, have one
//! paper between them.

use super::texels_down::TexelsDown;
use crate::world::Rgb;

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

/// Where one of them begins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paper(usize);

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
        let start = self.used;
        let papers = self.texels.get_mut(start..).unwrap_or_default();
        for (paper, &texel) in papers.iter_mut().zip(texels) {
            *paper = shaded(texel);
        }
        self.used += texels.len();
        // Rounding may take the last row one texel too far.
        if let (Some(beyond), Some(&last)) = (papers.get_mut(texels.len()), texels.last()) {
            *beyond = shaded(last);
            self.used += 1;
        }
        Paper(start)
    }

    /// Throws all of them away.
    pub(super) fn clear(&mut self) {
        self.used = 0;
    }

    /// The texel at `place`.
    #[inline]
    pub(super) fn at(&self, Place(place): Place) -> Rgb {
        self.texels[(place >> (u64::BITS - BITS)) as usize]
    }
}

impl Paper {
    /// Where its first texel is.
    pub(super) fn start(self) -> Place {
        Place((self.0 as u64) << (u64::BITS - BITS))
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
