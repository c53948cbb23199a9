//! Linear light: the colour space in which pictures are halved.
//!
//! A texel of the half is the mean of the texels that it covers, weighted by area, so that sides
//! which are not even lose nothing. The mean is taken in linear light, as the eye does at a
//! distance; the mean of stored values would make a black and white chessboard too dark. Texels are
//! also weighted by their alpha, so that transparent ones have no influence on the colour.

use std::num::NonZeroU32;

/// A picture in linear light: 16 bits for each of red, green and blue.
pub(crate) struct Light {
    pub(crate) width: NonZeroU32,
    pub(crate) height: NonZeroU32,
    pub(crate) texels: Vec<[u16; 3]>,
    /// As in a [`MipLevel`](super::MipLevel).
    pub(crate) alpha: Vec<u8>,
}

impl Light {
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

    /// The means of squares of four opaque texels, for even sides.
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

/// The texels, of `from` in a row, that texel `index` of `to` covers, with their weights.
fn covered(
    index: u32,
    from: NonZeroU32,
    to: NonZeroU32,
) -> impl Iterator<Item = (u32, u64)> + Clone {
    let (from, to) = (u64::from(from.get()), u64::from(to.get()));
    // In units in which both kinds of texel have integer sizes.
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
            let whole = Light { width, height, texels, alpha: vec![] };
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
            let whole = Light { width, height, texels, alpha: vec![] };
            let half = whole.halved();
            let mean = |light: &Light| {
                let sum: f64 = light.texels.iter().map(|texel| f64::from(texel[0])).sum();
                sum / light.texels.len() as f64
            };
            prop_assert!((mean(&whole) - mean(&half)).abs() <= 0.5);
        }
    }
}
