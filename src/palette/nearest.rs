//! A table of which colour of a palette looks nearest to any colour.
//!
//! Nearness is distance in Oklab (Björn Ottosson, "A perceptual color space for image processing",
//! 2020). Squared distance of the channels, weighted or not, was refused: in a palette with few dark
//! colours it takes dark bricks for grey and wood for pink.

use std::ops::RangeInclusive;

use super::of_256;
use crate::world::Rgb;

/// How much of each channel the table tells apart: 5 bits of 8. Its 32 KiB then stay in the cache,
/// and it is made in a few milliseconds.
const BITS: u32 = 5;
const LEVELS: u8 = 1 << BITS;
const DROPPED_BITS: u32 = u8::BITS - BITS;

/// The index of the nearest colour for every colour, by the upper bits of its channels.
pub(super) struct NearestColors {
    indices: Vec<u8>,
}

impl NearestColors {
    /// The table for those of the 256 colours.
    pub(super) fn among(palette: RangeInclusive<u8>) -> Self {
        let palette: Vec<(u8, Oklab)> =
            palette.map(|index| (index, Oklab::from(of_256(index)))).collect();
        let linear: Vec<f64> = (0..=u8::MAX).map(linear).collect();
        let middle = |level: u8| usize::from(level << DROPPED_BITS | 1 << (DROPPED_BITS - 1));
        let nearest = |red, green, blue| {
            let channels = [red, green, blue].map(|level| linear[middle(level)]);
            let color = Oklab::from_linear(channels);
            let by_distance = |(_, one): &&(u8, Oklab), (_, other): &&(u8, Oklab)| {
                color.distance(one).total_cmp(&color.distance(other))
            };
            palette.iter().min_by(by_distance).map_or(0, |&(index, _)| index)
        };
        let levels = || 0..LEVELS;
        let indices = levels()
            .flat_map(|red| levels().map(move |green| (red, green)))
            .flat_map(|(red, green)| levels().map(move |blue| (red, green, blue)))
            .map(|(red, green, blue)| nearest(red, green, blue))
            .collect();
        Self { indices }
    }

    /// The index of the one that is nearest to `color`.
    pub(super) fn of(&self, color: Rgb) -> u8 {
        let place = color
            .channels()
            .into_iter()
            .fold(0, |place, channel| place << BITS | usize::from(channel >> DROPPED_BITS));
        self.indices[place]
    }
}

/// A colour by how light, how red and how yellow it looks.
#[derive(Clone, Copy)]
struct Oklab([f64; 3]);

impl Oklab {
    fn from_linear([red, green, blue]: [f64; 3]) -> Self {
        let long = libm::cbrt(0.412_221_47 * red + 0.536_332_54 * green + 0.051_445_99 * blue);
        let medium = libm::cbrt(0.211_903_5 * red + 0.680_699_55 * green + 0.107_396_96 * blue);
        let short = libm::cbrt(0.088_302_46 * red + 0.281_718_84 * green + 0.629_978_7 * blue);
        Self([
            0.210_454_26 * long + 0.793_617_8 * medium - 0.004_072_05 * short,
            1.977_998_5 * long - 2.428_592_2 * medium + 0.450_593_7 * short,
            0.025_904_04 * long + 0.782_771_77 * medium - 0.808_675_77 * short,
        ])
    }

    fn distance(&self, other: &Self) -> f64 {
        self.0.iter().zip(other.0).map(|(one, other)| (one - other) * (one - other)).sum()
    }
}

impl From<Rgb> for Oklab {
    fn from(color: Rgb) -> Self {
        Self::from_linear(color.channels().map(linear))
    }
}

/// A channel of sRGB as an amount of light, from 0 to 1.
fn linear(channel: u8) -> f64 {
    let share = f64::from(channel) / 255.0;
    if share <= 0.040_45 { share / 12.92 } else { libm::pow((share + 0.055) / 1.055, 2.4) }
}
