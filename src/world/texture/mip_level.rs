//! Mip levels: a texture at half its size, a quarter, and so on.
//!
//! Each level is the level before, halved. A texel of the half is the mean of the texels that it
//! covers, weighted by area, so odd sides lose nothing. The mean is taken in linear light, as the
//! eye does at a distance. The mean of stored values would make a black and white chessboard too
//! dark. Texels are also weighted by their alpha, so transparent texels have no influence on the
//! colour. Mip mapping is by Lance Williams, "Pyramidal Parametrics", SIGGRAPH 1983.

use std::num::NonZeroU32;
use std::ops::Range;

use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};

/// A picture of one size, at least one texel wide and high.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MipLevel {
    width: NonZeroU32,
    height: NonZeroU32,
    /// The columns from the left, each from top to bottom.
    texels: Vec<Rgb>,
    /// The same texels at half brightness.
    halved: Vec<Rgb>,
    /// The alpha of the texels in the same order, 0 for transparent, 255 for opaque; empty if all
    /// texels are opaque.
    alpha: Vec<u8>,
}

impl MipLevel {
    /// A level with these texels, column by column. `alpha` is in the same order, or empty if all texels are
    /// opaque.
    pub(crate) fn new(
        width: NonZeroU32,
        height: NonZeroU32,
        texels: Vec<Rgb>,
        alpha: Vec<u8>,
    ) -> Self {
        let halved = texels.iter().map(|texel| texel.halved()).collect();
        Self { width, height, texels, halved, alpha }
    }

    /// The width in texels.
    pub fn width(&self) -> u32 {
        self.width.get()
    }

    /// The height in texels.
    pub fn height(&self) -> u32 {
        self.height.get()
    }

    /// The column at `u`, from 0 at the left edge to 1 at the right one, from top to bottom. A `u`
    /// outside that range, or NaN, selects the nearest column.
    pub fn column(&self, u: f64) -> &[Rgb] {
        &self.texels[self.column_range(u)]
    }

    /// The index of the column at `u`, from the left.
    #[inline]
    pub(crate) fn column_index(&self, u: f64) -> usize {
        texel_index(u, self.width.get())
    }

    /// The alpha of the texels of [`MipLevel::column`]; `None` if all texels of the level are
    /// opaque.
    pub fn alpha_column(&self, u: f64) -> Option<&[u8]> {
        self.alpha.get(self.column_range(u))
    }

    /// The colour of the texel at `(x, y)`, and its alpha.
    pub(crate) fn texel(&self, x: u32, y: u32) -> (Rgb, u8) {
        let index = x as usize * self.height.get() as usize + y as usize;
        (self.texels[index], self.alpha.get(index).copied().unwrap_or(u8::MAX))
    }

    /// The colours of all texels, column by column.
    pub(crate) fn texels(&self) -> &[Rgb] {
        &self.texels
    }

    /// All texels at [half brightness](Rgb::halved), as a y-side shows them.
    pub(crate) fn halved_texels(&self) -> &[Rgb] {
        &self.halved
    }

    pub(crate) fn has_alpha(&self) -> bool {
        !self.alpha.is_empty()
    }

    /// The indices of the texels of the column at `u`.
    fn column_range(&self, u: f64) -> Range<usize> {
        let height = self.height.get() as usize;
        let start = self.column_index(u) * height;
        start..start + height
    }

    /// The texel at a position in 2⁻⁶⁴ths of the width and the height, from the left and from the
    /// top.
    #[inline]
    pub fn at_fraction(&self, x: u64, y: u64) -> Rgb {
        self.at_short_fraction((x >> u32::BITS) as u32, (y >> u32::BITS) as u32)
    }

    /// The texel at a position in 2⁻³²ths of the width and the height.
    #[inline]
    pub(crate) fn at_short_fraction(&self, x: u32, y: u32) -> Rgb {
        let index = |fraction: u32, count: NonZeroU32| {
            ((u64::from(fraction) * u64::from(count.get())) >> u32::BITS) as usize
        };
        self.texels[index(x, self.width) * self.height.get() as usize + index(y, self.height)]
    }

    /// The level for lookups without multiplication, if both sides are powers of two.
    #[inline]
    pub(crate) fn by_shifts(&self) -> Option<MipLevelByShifts<'_>> {
        let bits = |side: NonZeroU32| side.is_power_of_two().then(|| side.trailing_zeros());
        let (width, height) = (bits(self.width)?, bits(self.height)?);
        (width + height < u32::BITS).then(|| MipLevelByShifts {
            texels: &self.texels,
            // Shifting by all 32 bits is not possible. The surplus bits are masked away.
            shift_x: (u32::BITS - width - height).min(u32::BITS - 1),
            mask_x: (self.width.get() - 1) << height,
            shift_y: (u32::BITS - height).min(u32::BITS - 1),
            mask_y: self.height.get() - 1,
        })
    }
}

/// A mip level whose width and height are powers of two. The index of a texel therefore consists of
/// bits of its position along both axes.
#[derive(Clone, Copy)]
pub(crate) struct MipLevelByShifts<'a> {
    texels: &'a [Rgb],
    shift_x: u32,
    mask_x: u32,
    shift_y: u32,
    mask_y: u32,
}

impl<'a> MipLevelByShifts<'a> {
    /// The texels, by their indices.
    #[inline]
    pub(crate) fn texels(self) -> &'a [Rgb] {
        self.texels
    }

    /// The index of the texel that [`MipLevel::at_fraction`] returns.
    #[inline]
    pub(crate) fn index(self, x: u64, y: u64) -> u32 {
        let (x, y) = ((x >> u32::BITS) as u32, (y >> u32::BITS) as u32);
        x >> self.shift_x & self.mask_x | y >> self.shift_y & self.mask_y
    }

    /// The texel at an index.
    #[inline]
    pub(crate) fn at_index(self, index: u32) -> Rgb {
        self.texels[index as usize]
    }
}

/// The index, below `count`, of the texel at `coordinate`, a number from 0 to 1. Outside that
/// range, returns the nearest texel.
#[inline]
fn texel_index(coordinate: f64, count: u32) -> usize {
    let index = (coordinate * f64::from(count)) as u32;
    index.min(count - 1) as usize
}

/// The mip levels after `level`, down to one texel.
pub(crate) fn smaller(level: &MipLevel) -> Vec<MipLevel> {
    let &MipLevel { width, height, ref texels, ref alpha, .. } = level;
    let texels = texels.iter().copied().map(linear_16).collect();
    let mut light = LinearPicture { width, height, texels, alpha: alpha.clone() };
    let mut levels = Vec::new();
    while light.texels.len() > 1 {
        light = light.halved();
        let texels = light.texels.iter().copied().map(from_linear_16).collect();
        levels.push(MipLevel::new(light.width, light.height, texels, light.alpha.clone()));
    }
    levels
}

/// A picture in linear light: 16 bits for each of red, green and blue.
pub(crate) struct LinearPicture {
    pub(crate) width: NonZeroU32,
    pub(crate) height: NonZeroU32,
    pub(crate) texels: Vec<[u16; 3]>,
    /// The alpha, stored as in a [`MipLevel`](MipLevel).
    pub(crate) alpha: Vec<u8>,
}

impl LinearPicture {
    /// A picture of half the width and height.
    pub(crate) fn halved(&self) -> Self {
        let half = |side: NonZeroU32| NonZeroU32::new(side.get() / 2).unwrap_or(NonZeroU32::MIN);
        let (width, height) = (half(self.width), half(self.height));
        let is_even = |side: NonZeroU32| side.get().is_multiple_of(2);
        if self.alpha.is_empty() && is_even(self.width) && is_even(self.height) {
            Self { width, height, texels: self.means_of_four(), alpha: Vec::new() }
        } else {
            self.resized(width, height)
        }
    }

    /// The means of squares of four opaque texels. Both sides must be even.
    fn means_of_four(&self) -> Vec<[u16; 3]> {
        let height = self.height.get() as usize;
        let pairs = self.texels.chunks_exact(2 * height).flat_map(|columns| {
            let (left, right) = columns.split_at(height);
            left.as_chunks::<2>().0.iter().zip(right.as_chunks::<2>().0)
        });
        let mean = |(left, right): (&[[u16; 3]; 2], &[[u16; 3]; 2])| {
            std::array::from_fn(|channel| {
                let texels = left.iter().chain(right);
                let sum: u32 = texels.map(|texel| u32::from(texel[channel])).sum();
                ((sum + 2) / 4) as u16
            })
        };
        pairs.map(mean).collect()
    }

    /// A picture of this width and height.
    fn resized(&self, width: NonZeroU32, height: NonZeroU32) -> Self {
        let places = (0..width.get()).flat_map(|x| (0..height.get()).map(move |y| (x, y)));
        let (texels, mut alpha): (Vec<_>, Vec<u8>) = places
            .map(|(x, y)| {
                self.mean(covered(x, self.width, width), &covered(y, self.height, height))
            })
            .unzip();
        if self.alpha.is_empty() {
            alpha = Vec::new();
        }
        Self { width, height, texels, alpha }
    }

    /// The weighted mean of the texels in some columns and rows, and of their alpha.
    fn mean(
        &self,
        columns: impl Iterator<Item = (u32, u64)>,
        rows: &(impl Iterator<Item = (u32, u64)> + Clone),
    ) -> ([u16; 3], u8) {
        const OPAQUE: u64 = u8::MAX as u64;
        let (mut sums, mut weights, mut total) = ([0; 3], 0, 0);
        for (x, share_of_column) in columns {
            let start = x as usize * self.height.get() as usize;
            for (y, share_of_row) in rows.clone() {
                let index = start + y as usize;
                let area = share_of_column * share_of_row;
                let weight = area * self.alpha.get(index).map_or(OPAQUE, |&alpha| alpha.into());
                total += area;
                weights += weight;
                for (sum, channel) in sums.iter_mut().zip(self.texels[index]) {
                    *sum += weight * u64::from(channel);
                }
            }
        }
        let shown = weights.max(1);
        let color = sums.map(|sum| ((sum + shown / 2) / shown) as u16);
        (color, ((weights + total / 2) / total) as u8)
    }
}

/// The texels that texel `index` covers, with their weights, if a row of `from` texels is resized
/// to `to`.
fn covered(
    index: u32,
    from: NonZeroU32,
    to: NonZeroU32,
) -> impl Iterator<Item = (u32, u64)> + Clone {
    let (from, to) = (u64::from(from.get()), u64::from(to.get()));
    // Lengths are in units in which both kinds of texel have integer sizes.
    let (start, end) = (u64::from(index) * from, (u64::from(index) + 1) * from);
    (start / to..end.div_ceil(to)).map(move |texel| {
        let covered = end.min((texel + 1) * to) - start.max(texel * to);
        (texel as u32, covered)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn size(side: u32) -> NonZeroU32 {
        NonZeroU32::new(side).unwrap()
    }

    #[test]
    fn a_chessboard_becomes_gray_of_equal_light() {
        let texels = (0..16).map(|index| if (index + index / 4) % 2 == 0 { 0 } else { 255 });
        let texels = texels.map(|gray| Rgb::new(gray, gray, gray)).collect();
        let levels = smaller(&MipLevel::new(size(4), size(4), texels, vec![]));
        assert_eq!(levels.len(), 2);
        // Half of the light is much more than half of the value.
        assert!(
            levels
                .iter()
                .flat_map(|level| &level.texels)
                .all(|&texel| { texel == Rgb::new(188, 188, 188) })
        );
    }

    #[test]
    fn a_fraction_selects_the_texel_that_contains_it() {
        let level = MipLevel::new(size(2), size(1), vec![Rgb::BLACK, Rgb::WHITE], vec![]);
        let half = 1 << 63;
        let seen = [0, half - 1, half, u64::MAX].map(|x| level.at_fraction(x, u64::MAX));
        assert_eq!(seen, [Rgb::BLACK, Rgb::BLACK, Rgb::WHITE, Rgb::WHITE]);
    }

    proptest! {
        #[test]
        fn shifts_select_the_same_texel_as_fractions(
            sides in (0_u32..8, 0_u32..8),
            places in prop::collection::vec(any::<(u64, u64)>(), 1..20),
        ) {
            let (width, height) = (1 << sides.0, 1 << sides.1);
            let texels = (0..width * height).map(|texel| Rgb::new(0, (texel >> 8) as u8, texel as u8));
            let texels: Vec<_> = texels.collect();
            let level = MipLevel::new(size(width), size(height), texels, vec![]);
            let shifts = level.by_shifts().unwrap();
            for (x, y) in places.into_iter().chain([(0, u64::MAX), (u64::MAX, 0)]) {
                prop_assert_eq!(shifts.at_index(shifts.index(x, y)), level.at_fraction(x, y));
            }
        }
    }

    #[test]
    fn transparent_texels_do_not_affect_the_colour() {
        let texels = vec![Rgb::WHITE, Rgb::BLACK, Rgb::WHITE, Rgb::BLACK];
        let of_four = MipLevel::new(size(2), size(2), texels, vec![255, 0, 255, 0]);
        let level = &smaller(&of_four)[0];
        assert_eq!(level.texel(0, 0), (Rgb::WHITE, 128));
        let of_two = MipLevel::new(size(2), size(1), vec![Rgb::WHITE; 2], vec![0, 0]);
        let level = &smaller(&of_two)[0];
        assert_eq!(level.texel(0, 0).1, 0);
    }

    proptest! {
        #[test]
        fn a_square_of_four_is_halved_like_any_other_size(
            width in 1_u32..6,
            height in 1_u32..6,
            seed in prop::collection::vec(any::<[u16; 3]>(), 100),
        ) {
            let texels = seed[..4 * (width * height) as usize].to_vec();
            let [half_width, half_height, width, height] =
                [width, height, 2 * width, 2 * height].map(|side| NonZeroU32::new(side).unwrap());
            let whole = LinearPicture { width, height, texels, alpha: vec![] };
            let expected = whole.resized(half_width, half_height).texels;
            prop_assert_eq!(whole.halved().texels, expected);
        }

        /// A halving conserves light: all levels have the same mean, for any sides.
        #[test]
        fn a_halving_preserves_the_mean_light(
            width in 1_u32..20,
            height in 1_u32..20,
            seed in prop::collection::vec(any::<u16>(), 400),
        ) {
            let count = (width * height) as usize;
            let [width, height] = [width, height].map(|side| NonZeroU32::new(side).unwrap());
            let texels = seed[..count].iter().map(|&light| [light; 3]).collect();
            let whole = LinearPicture { width, height, texels, alpha: vec![] };
            let half = whole.halved();
            let mean = |light: &LinearPicture| {
                let sum: f64 = light.texels.iter().map(|texel| f64::from(texel[0])).sum();
                sum / light.texels.len() as f64
            };
            prop_assert!((mean(&whole) - mean(&half)).abs() <= 0.5);
        }
    }
}
