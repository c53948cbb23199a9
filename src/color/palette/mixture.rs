//! Mixtures: two colours of a palette that look like a given colour when they alternate in a
//! pattern.
//!
//! Each pair of colours near the wanted one is tried. The best mixture is the one whose mean light is
//! nearest to the wanted colour in Oklab; the contrast between its two colours counts almost as much
//! as the error of the mean. A pixel of a half block is large, so that the eye sees the pixels of a
//! mixture and not their mean: a mixture of grey and a bright hue is a chessboard, and a quarter of
//! the pixels is a grid of lone dots. The two colours therefore differ by at most 0.18, and each has
//! half of the pixels.
//!
//! The palette of 256 has few colours between grey and its hues: its darkest red has a lightness of
//! 0.31, its darkest yellow 0.47, and its darkest brown 0.51. The nearest colour of most surfaces in
//! a room is grey. Colours are therefore changed before they are mixed:
//!
//! - [`ToneCurve`] lifts dark colours to where the palette has hues.
//! - Saturation is increased, more in the dark. Colours that are almost grey remain as they are.
//!
//! Hues differ from the wanted one by at most 26 degrees, and colours with little chroma are mixed of
//! greys only.
//!
//! The idea is Joel Yliluoma's ("Arbitrary-palette positional dithering algorithm", 2011), who
//! weighs contrast, too. A weight of a tenth was refused, with one mixture for each two cells: the
//! mean over 2×2 cells is nearer to the wanted colour, but bricks, joints and stones are no longer
//! seen among red, olive and orange dots. Sets of four colours were refused, too.
//!
//! Mixtures are stored by 64 levels of each channel, and computed on first use: a picture needs some
//! hundreds of them, and computing all 262,144 would take seconds. The levels are equal steps of the
//! cube root of light, which are equal steps of lightness. The upper six bits of sRGB were refused:
//! their lowest levels are as far apart as black and the darkest grey.

mod candidates;
mod tone;
mod weights;

use std::array;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{CUBE, of_256};
use crate::color::oklab::{self, Oklab};
use crate::color::srgb::linear;
use candidates::{Candidates, Wanted};
pub(crate) use tone::ToneCurve;
use weights::{WEIGHTS_OF_16, WEIGHTS_OF_256, Weights};

/// Two colours and their shares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mixture {
    /// The indices of the darker and the brighter colour.
    pub(crate) colors: [u8; 2],
    /// The number of pixels, of [`Mixture::WHOLE`], that have the brighter colour; less than all.
    pub(crate) share: u8,
}

impl Mixture {
    /// The number of pixels of a mixture.
    pub(crate) const WHOLE: u8 = 4;
    const NONE: Self = Self { colors: [0; 2], share: 0 };
}

/// The mixtures for all colours, each computed on first use.
pub(crate) struct Mixtures {
    palette: fn() -> Palette,
    /// The tones of the colours that are mixed.
    pub(crate) tones: &'static LazyLock<ToneCurve>,
    /// A static of its own: beside a pointer, its megabyte of zeros would be part of the program's file.
    entries: &'static Entries,
}

type Entries = [AtomicU32; 1 << (3 * BITS)];

/// The number of bits of a channel's level.
const BITS: u32 = 6;
/// The highest level.
const FULL: u8 = (1 << BITS) - 1;
/// The bit that marks an entry as computed, beside the share.
const FOUND: u8 = 1 << 7;

/// The mixtures of the 240 fixed colours of xterm.
pub(crate) static OF_256: Mixtures = {
    static ENTRIES: Entries = [const { AtomicU32::new(0) }; 1 << (3 * BITS)];
    static PALETTE: LazyLock<Vec<PaletteColor>> =
        LazyLock::new(|| (CUBE..=u8::MAX).map(PaletteColor::of).collect());
    static TONES: LazyLock<ToneCurve> = LazyLock::new(ToneCurve::lifted);
    Mixtures {
        palette: || Palette { colors: &PALETTE, weights: &WEIGHTS_OF_256 },
        tones: &TONES,
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
    static TONES: LazyLock<ToneCurve> = LazyLock::new(ToneCurve::unchanged);
    Mixtures {
        palette: || Palette { colors: &PALETTE, weights: &WEIGHTS_OF_16 },
        tones: &TONES,
        entries: &ENTRIES,
    }
};

/// The colours to mix, and the weights of differences.
#[derive(Clone, Copy)]
struct Palette {
    colors: &'static [PaletteColor],
    weights: &'static Weights,
}

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
        let [_, share, darker, brighter] = entry.to_be_bytes();
        Mixture { colors: [darker, brighter], share: share & !FOUND }
    }

    #[cold]
    fn find(&self, index: usize, levels: [u8; 3]) -> u32 {
        let Mixture { colors: [darker, brighter], share } =
            (self.palette)().mixture(levels.map(light_of_level));
        let entry = u32::from_be_bytes([0, FOUND | share, darker, brighter]);
        self.entries[index].store(entry, Ordering::Relaxed);
        entry
    }
}

impl Palette {
    fn mixture(self, light: [f64; 3]) -> Mixture {
        let wanted = Wanted::new(self.saturated(light));
        let candidates = Candidates::new(&wanted, self.colors, self.weights);
        let candidates = candidates.as_slice();
        let mut best = Mixture::NONE;
        let mut least = f32::INFINITY;
        let mut consider = |cost: f32, colors: [u8; 2], share: u8| {
            if cost < least {
                least = cost;
                best = Mixture { colors, share };
            }
        };
        for (index, one) in candidates.iter().enumerate() {
            consider(cost(one.error), [one.index; 2], 0);
            for other in &candidates[index + 1..] {
                let Some(contrast) = self.weights.contrast(one, other) else { continue };
                for share in self.weights.shares.clone() {
                    let part = f32::from(share) / f32::from(Mixture::WHOLE);
                    let error =
                        array::from_fn(|i| one.error[i] + (other.error[i] - one.error[i]) * part);
                    let total = cost(error) + contrast * part * (1.0 - part);
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

    /// More saturated light of the same brightness.
    fn saturated(self, light: [f64; 3]) -> [f64; 3] {
        let Oklab([lightness, red, yellow]) = Oklab::from_linear(light);
        let factor = self.weights.saturation(lightness, libm::hypot(red, yellow));
        let grey = light.iter().sum::<f64>() / 3.0;
        let least = light.into_iter().fold(grey, f64::min);
        // No channel may become negative.
        let factor = if least < grey { factor.min(grey / (grey - least)) } else { 1.0 };
        light.map(|part| (grey + factor * (part - grey)).clamp(0.0, 1.0))
    }
}

/// The cost of a [`Candidate::error`].
fn cost(error: [f32; 3]) -> f32 {
    error.iter().map(|part| part * part).sum()
}

#[cfg(test)]
mod tests;
