//! Mixtures: two colours of a palette that look like a given colour when they alternate in a
//! pattern.
//!
//! Each pair of colours near the wanted one is tried in a few shares. The best mixture is the one
//! whose mean light is nearest to the wanted colour in Oklab; the contrast between its two colours
//! counts as well, because it is visible as dots. Colours of another hue are not used: grey and one
//! hue reach every colour between them, and a green dot on a brick is noticeable.
//!
//! The palette of 256 has few dark hues: its darkest red has a lightness of 0.31, and its darkest
//! yellow 0.47. Three rules keep dark surfaces from becoming grey with bright dots:
//!
//! - A difference in saturation weighs more than one in hue: dark wood is mixed of red and grey in
//!   one block, and of yellow and grey in the next.
//! - A colour that is much lighter or darker than the wanted one is not used.
//! - The largest deviation of a pixel from the mean counts as contrast, too: one orange pixel among
//!   three dark ones costs more than two red and two grey pixels of one lightness.
//!
//! More weight on contrast was refused: it makes dark wood grey again.
//!
//! The idea is Joel Yliluoma's ("Arbitrary-palette positional dithering algorithm", 2011). Sets of
//! four colours were refused: they come a little nearer, for twice the bytes.
//!
//! Mixtures are stored by 64 levels of each channel, and computed on first use: a picture needs some
//! hundreds of them, and computing all 262,144 would take seconds. The levels are equal steps of the
//! cube root of light, which are equal steps of lightness. The upper six bits of sRGB were refused:
//! their lowest levels are as far apart as black and the darkest grey.

mod candidates;

use std::array;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{CUBE, of_256};
use crate::color::oklab::{self, Oklab};
use crate::color::srgb::linear;
use candidates::{Candidate, Candidates};

/// Two colours and their shares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mixture {
    /// The indices of the darker and the brighter colour.
    pub(crate) colors: [u8; 2],
    /// The number of pixels, of [`Mixture::WHOLE`], that have the brighter colour; less than all.
    pub(crate) share: u8,
    /// The index of the nearest single colour, for pixels that are not mixed.
    pub(crate) single: u8,
}

impl Mixture {
    /// The number of pixels of a mixture.
    pub(crate) const WHOLE: u8 = 4;
    const NONE: Self = Self { colors: [0; 2], share: 0, single: 0 };
}

/// The mixtures for all colours, each computed on first use.
pub(crate) struct Mixtures {
    palette: fn() -> Palette,
    /// A static of its own: beside a pointer, its megabyte of zeros would be part of the program's file.
    entries: &'static Entries,
}

type Entries = [AtomicU32; 1 << (3 * BITS)];

/// The number of bits of a channel's level.
const BITS: u32 = 6;
/// The highest level.
const FULL: u8 = (1 << BITS) - 1;
/// The bit that marks an entry as computed, in its uppermost byte, beside the share.
const FOUND: u8 = 1 << 7;

/// The mixtures of the 240 fixed colours of xterm.
pub(crate) static OF_256: Mixtures = {
    static ENTRIES: Entries = [const { AtomicU32::new(0) }; 1 << (3 * BITS)];
    static PALETTE: LazyLock<Vec<PaletteColor>> =
        LazyLock::new(|| (CUBE..=u8::MAX).map(PaletteColor::of).collect());
    Mixtures {
        palette: || Palette { colors: &PALETTE, weights: WEIGHTS_OF_256 },
        entries: &ENTRIES,
    }
};

/// The mixtures of twelve of the 16 named colours. Cyan and magenta are left out: hardly anything
/// in a room has their hue, and they show as stray dots on stone that is slightly blue.
pub(crate) static OF_16: Mixtures = {
    const LEFT_OUT: [u8; 4] = [5, 6, 13, 14];
    static ENTRIES: Entries = [const { AtomicU32::new(0) }; 1 << (3 * BITS)];
    static PALETTE: LazyLock<Vec<PaletteColor>> = LazyLock::new(|| {
        (0..CUBE).filter(|index| !LEFT_OUT.contains(index)).map(PaletteColor::of).collect()
    });
    Mixtures { palette: || Palette { colors: &PALETTE, weights: WEIGHTS_OF_16 }, entries: &ENTRIES }
};

/// The colours to mix, and the weights of differences.
#[derive(Clone, Copy)]
struct Palette {
    colors: &'static [PaletteColor],
    weights: Weights,
}

/// The weights and limits by which mixtures are rated.
#[derive(Clone, Copy)]
struct Weights {
    /// The weight of a difference in chroma relative to one in lightness, for mixtures.
    chroma: f32,
    /// The same for single colours, which would otherwise be grey too often.
    single: f32,
    /// The weight of a difference in hue relative to one in saturation.
    hue_error: f32,
    /// The weights of the differences in lightness and in chroma between the two colours.
    contrast: [f32; 2],
    /// The weight of the largest deviation of a pixel relative to the mean contrast, for black; it
    /// decreases to zero at [`DARK`].
    deviation: f32,
    /// The most by which the lightness of a colour may differ from that of a wanted one that is dark.
    most_difference: f32,
    /// The least cosine between the hues of a colour and of the wanted one.
    hue: f32,
    /// Colours with less chroma are mixed of greys only.
    least_chroma: f32,
    /// The most by which the chroma of a colour may exceed that of the wanted one: more shows as
    /// dots.
    most_excess: f32,
}

/// Chosen by experiment with `cellcaster wire --palette 256`.
const WEIGHTS_OF_256: Weights = Weights {
    chroma: 2.0,
    single: 1.0,
    hue_error: 0.7,
    contrast: [0.03, 0.01],
    deviation: 1.5,
    most_difference: 0.18,
    hue: 0.5,
    least_chroma: 0.005,
    most_excess: 0.1,
};
/// For a few saturated colours, which users redefine: they are used sparingly.
const WEIGHTS_OF_16: Weights = Weights {
    chroma: 1.0,
    single: 1.0,
    hue_error: 1.0,
    contrast: [0.008, 0.02],
    deviation: 0.0,
    most_difference: 1.0,
    hue: 0.9,
    least_chroma: 0.045,
    most_excess: 1.0,
};

/// The lightness below which a colour is dark.
const DARK: f32 = 0.45;

/// The level of a channel with that amount of light, from 0 to 1.
pub(crate) fn level(light: f64) -> u8 {
    libm::round(libm::cbrt(light) * f64::from(FULL)) as u8
}

fn light_of_level(level: u8) -> f64 {
    let root = f64::from(level) / f64::from(FULL);
    root * root * root
}

/// A colour of the palette.
#[derive(Clone, Copy)]
struct PaletteColor {
    index: u8,
    cones: [f32; 3],
    lab: [f32; 3],
}

impl PaletteColor {
    fn of(index: u8) -> Self {
        let light = linear(of_256(index));
        let Oklab(lab) = Oklab::from_linear(light);
        Self {
            index,
            cones: oklab::cones(light).map(|share| share as f32),
            lab: lab.map(|part| part as f32),
        }
    }
}

impl Mixtures {
    /// The mixture for a colour, given the [`level`] of red, green and blue.
    #[inline]
    pub(crate) fn of(&self, levels: [u8; 3]) -> Mixture {
        let index =
            levels.iter().fold(0, |index, &level| index << BITS | usize::from(level & FULL));
        // Every thread computes the same entry, so that it does not matter which one stores it.
        let stored = self.entries[index].load(Ordering::Relaxed);
        let entry = if stored == 0 { self.find(index, levels) } else { stored };
        let [share, single, darker, brighter] = entry.to_be_bytes();
        Mixture { colors: [darker, brighter], share: share ^ FOUND, single }
    }

    #[cold]
    fn find(&self, index: usize, levels: [u8; 3]) -> u32 {
        let Mixture { colors: [darker, brighter], share, single } =
            (self.palette)().mixture(levels.map(light_of_level));
        let entry = u32::from_be_bytes([FOUND | share, single, darker, brighter]);
        self.entries[index].store(entry, Ordering::Relaxed);
        entry
    }
}

impl Palette {
    fn mixture(self, light: [f64; 3]) -> Mixture {
        let candidates = Candidates::new(light, self);
        let darkness = (1.0 - candidates.lightness() / DARK).max(0.0) * self.weights.deviation;
        let candidates = candidates.as_slice();
        let single = candidates.iter().min_by(|one, other| {
            let alone = |candidate: &Candidate| cost(candidate.error, self.weights.single);
            alone(one).total_cmp(&alone(other))
        });
        let mut best = Mixture { single: single.map_or(0, |single| single.index), ..Mixture::NONE };
        let mut least = f32::INFINITY;
        let mut consider = |cost: f32, colors: [u8; 2], share: u8| {
            if cost < least {
                least = cost;
                best = Mixture { colors, share, ..best };
            }
        };
        for (index, one) in candidates.iter().enumerate() {
            consider(cost(one.error, self.weights.chroma), [one.index; 2], 0);
            for other in &candidates[index + 1..] {
                let contrast = self.contrast(one, other);
                for share in 1..Mixture::WHOLE {
                    let part = f32::from(share) / f32::from(Mixture::WHOLE);
                    let error =
                        array::from_fn(|i| one.error[i] + (other.error[i] - one.error[i]) * part);
                    let largest = 2.0 * part.max(1.0 - part);
                    let dots = 4.0 * part * (1.0 - part) + darkness * largest * largest;
                    let total = cost(error, self.weights.chroma) + contrast * dots;
                    if one.lab[0] <= other.lab[0] {
                        consider(total, [one.index, other.index], share);
                    } else {
                        consider(total, [other.index, one.index], Mixture::WHOLE - share);
                    }
                }
            }
        }
        best
    }

    fn contrast(&self, one: &Candidate, other: &Candidate) -> f32 {
        let square = |index: usize| (one.lab[index] - other.lab[index]).powi(2);
        self.weights.contrast[0] * square(0) + self.weights.contrast[1] * (square(1) + square(2))
    }
}

/// The cost of a [`Candidate::error`], where `chroma` is the weight of an error in chroma.
fn cost([lightness, saturation, hue]: [f32; 3], chroma: f32) -> f32 {
    lightness * lightness + chroma * chroma * (saturation * saturation + hue * hue)
}

#[cfg(test)]
mod tests;
