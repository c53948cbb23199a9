//! Shaded texels: those of columns after lighting, which is applied once for many pixels.
//!
//! All of a batch lie in one piece of memory of a known size: an address is a number whose uppermost
//! bits say which texel it is, and looking that up needs no check. Columns side by side that show the
//! same texels in the same lighting, as a near wall's do, share a range.

use crate::color::Rgb;
use crate::visibility::TextureStepper;

/// From one texel to the next, in [`TexelAddress`]s.
const TEXEL: u64 = 1 << (u64::BITS - BITS);

/// How many texels there is room for: those of a batch, of most textures. What is not used takes no room
/// in a cache.
const TEXELS: usize = 1 << BITS;
const BITS: u32 = 14;

/// The texels of a batch, and room for more.
#[derive(Clone, Debug)]
pub(crate) struct ShadedTexels {
    texels: Box<[Rgb; TEXELS]>,
    used: usize,
}

/// A range of them, by the address of the first texel of its texture, which may be outside it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadedRange(TexelAddress);

/// Which texel, in the uppermost bits, and a place on it in the others.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TexelAddress(u64);

impl Default for ShadedTexels {
    fn default() -> Self {
        let texels = vec![Rgb::BLACK; TEXELS].try_into().expect("it is as long as the array");
        Self { texels, used: 0 }
    }
}

impl ShadedTexels {
    /// The most texels that a range has.
    pub(crate) const MOST: usize = TEXELS - 1;

    /// Whether there is room for `texels` more.
    pub(crate) fn have_room_for(&self, texels: usize) -> bool {
        self.used + texels < TEXELS
    }

    /// A range of those texels, shaded, if there is room.
    #[inline]
    pub(crate) fn make(&mut self, texels: &[Rgb], shaded: impl Fn(Rgb) -> Rgb) -> ShadedRange {
        let range = ShadedRange(self.next());
        self.add(texels, &shaded);
        // Rounding may take the last row one texel too far.
        self.add(&texels[texels.len().saturating_sub(1)..], &shaded);
        range
    }

    /// A range of all texels of `pieces`, shaded, if there is room. The first of them is the one `first`
    /// texels down its texture.
    #[inline]
    pub(crate) fn make_of_pieces<'t>(
        &mut self,
        first: i64,
        pieces: impl Iterator<Item = &'t [Rgb]>,
        shaded: impl Fn(Rgb) -> Rgb,
    ) -> ShadedRange {
        let range =
            ShadedRange(self.next().further((first.wrapping_neg() as u64).wrapping_mul(TEXEL)));
        for texels in pieces {
            self.add(texels, &shaded);
        }
        range
    }

    fn next(&self) -> TexelAddress {
        TexelAddress(self.used as u64 * TEXEL)
    }

    #[inline]
    fn add(&mut self, texels: &[Rgb], shaded: impl Fn(Rgb) -> Rgb) {
        let free = self.texels.get_mut(self.used..).unwrap_or_default();
        for (address, &texel) in free.iter_mut().zip(texels) {
            *address = shaded(texel);
        }
        self.used += texels.len();
    }

    /// Throws all of them away.
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
    /// Where its first texel is.
    pub(crate) fn start(self) -> TexelAddress {
        self.0
    }

    /// Where the centre of `row` is, and how far it is from there to the next row.
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
