//! Shaded texels: the texels of columns after lighting, which is applied once for many pixels.
//!
//! All texels of a batch are in one array of constant size. An address is an integer whose
//! uppermost bits are the index, so a lookup needs no bounds check. Neighbouring columns with the
//! same texels and the same lighting, such as the columns of a near wall, share a range.

use crate::color::Rgb;
use crate::visibility::{Lighting, TextureStepper};

/// The step from one texel to the next, as a difference of two [`TexelAddress`]es.
const TEXEL: u64 = 1 << (u64::BITS - BITS);

/// The number of texels in the array: enough for a batch, with most textures. Unused texels occupy
/// no cache.
const TEXELS: usize = 1 << BITS;
const BITS: u32 = 14;

/// The texels of a batch.
#[derive(Clone, Debug)]
pub(crate) struct ShadedTexels {
    texels: Box<[Rgb; TEXELS]>,
    used: usize,
}

/// A range of the texels, stored as the address of the first texel of its texture. That texel may
/// be outside the range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadedRange(TexelAddress);

/// The index of a texel, in the uppermost bits, and a position on the texel, in the others.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TexelAddress(u64);

impl Default for ShadedTexels {
    fn default() -> Self {
        let texels = vec![Rgb::BLACK; TEXELS].try_into().expect("it is as long as the array");
        Self { texels, used: 0 }
    }
}

impl ShadedTexels {
    /// The most texels of a range.
    pub(crate) const MAX: usize = TEXELS - 2;

    /// Whether there is room for another range of `texels` texels.
    pub(crate) fn have_room_for(&self, texels: usize) -> bool {
        self.used + texels <= Self::MAX
    }

    /// Adds a range of these texels after lighting. There must be room for them.
    #[inline]
    pub(crate) fn make<L: Lighting>(&mut self, texels: &[Rgb], lighting: L) -> ShadedRange {
        // Rounding may move the first and the last row one texel too far.
        self.add(&texels[..texels.len().min(1)], lighting);
        let range = ShadedRange(self.next());
        self.add(texels, lighting);
        self.add(&texels[texels.len().saturating_sub(1)..], lighting);
        range
    }

    /// Adds a range of all texels of `pieces` after lighting. There must be room for them. The
    /// first texel is `first` texels down its texture.
    #[inline]
    pub(crate) fn make_of_pieces<'t, L: Lighting>(
        &mut self,
        first: i64,
        pieces: impl Iterator<Item = &'t [Rgb]>,
        lighting: L,
    ) -> ShadedRange {
        let range =
            ShadedRange(self.next().further((first.wrapping_neg() as u64).wrapping_mul(TEXEL)));
        for texels in pieces {
            self.add(texels, lighting);
        }
        range
    }

    fn next(&self) -> TexelAddress {
        TexelAddress(self.used as u64 * TEXEL)
    }

    #[inline]
    fn add<L: Lighting>(&mut self, texels: &[Rgb], lighting: L) {
        let free = self.texels.get_mut(self.used..self.used + texels.len()).unwrap_or_default();
        if free.len() == texels.len() {
            free.copy_from_slice(texels);
            lighting.apply_to_all(free);
        }
        self.used += texels.len();
    }

    /// Removes all texels.
    pub(crate) fn clear(&mut self) {
        self.used = 0;
    }

    /// The texel at `address`.
    #[inline]
    pub(crate) fn at(&self, TexelAddress(address): TexelAddress) -> Rgb {
        self.texels[(address / TEXEL) as usize]
    }
}

impl ShadedRange {
    /// The address of the first texel of its texture.
    pub(crate) fn start(self) -> TexelAddress {
        self.0
    }

    /// The address of the texel at the centre of `row`, and the step from each row to the next.
    #[inline]
    pub(crate) fn address_and_step(self, stepper: TextureStepper, row: u32) -> (TexelAddress, u64) {
        let (address, step) = stepper.in_uppermost::<BITS>(row);
        (self.start().further(address), step)
    }
}

impl TexelAddress {
    #[inline]
    pub(crate) fn further(self, by: u64) -> Self {
        Self(self.0.wrapping_add(by))
    }
}
