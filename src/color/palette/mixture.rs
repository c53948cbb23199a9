//! Mixtures: two colours of a palette that look like a given colour when they alternate in a
//! pattern.
//!
//! Each pair of colours near the wanted one is tried in a few shares. The best mixture is the one
//! whose mean light is nearest to the wanted colour in Oklab; the contrast between its two colours
//! counts as well, because it is visible as dots. Colours of another hue are not used: grey and one
//! hue reach every colour between them, and a green dot on a brick is noticeable.
//!
//! The idea is Joel Yliluoma's ("Arbitrary-palette positional dithering algorithm", 2011). Sets of
//! four colours were refused: they come a little nearer, for twice the bytes.
//!
//! Mixtures are stored by the upper six bits of each channel, and computed on first use: a picture
//! needs some hundreds of them, and computing all 262,144 would take seconds.

use std::array;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{CUBE, of_256};
use crate::color::oklab::{self, Oklab};
use crate::color::srgb::linear;
use crate::color::{Rgb, product};

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

/// The number of bits of each channel by which mixtures are stored.
pub(crate) const BITS: u32 = 6;
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
    /// The weights of the differences in lightness and in chroma between the two colours.
    contrast: [f32; 2],
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
    contrast: [0.03, 0.01],
    hue: 0.5,
    least_chroma: 0.005,
    most_excess: 0.1,
};
/// For a few saturated colours, which users redefine: they are used sparingly.
const WEIGHTS_OF_16: Weights = Weights {
    chroma: 1.0,
    single: 1.0,
    contrast: [0.008, 0.02],
    hue: 0.9,
    least_chroma: 0.045,
    most_excess: 1.0,
};

/// The most candidates for a mixture: the nearest colours.
const MOST_CANDIDATES: usize = 40;
/// Colours with less chroma are grey and fit every hue.
const GREY: f32 = 0.01;

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
    /// The mixture for a colour, given the upper bits of red, green and blue.
    #[inline]
    pub(crate) fn of(&self, [red, green, blue]: [u8; 3]) -> Mixture {
        let mask = (1 << BITS) - 1;
        let index = [red, green, blue]
            .iter()
            .fold(0, |index, &channel| index << BITS | usize::from(channel) & mask);
        // Every thread computes the same entry, so that it does not matter which one stores it.
        let stored = self.entries[index].load(Ordering::Relaxed);
        let entry = if stored == 0 { self.find(index, [red, green, blue]) } else { stored };
        let [share, single, darker, brighter] = entry.to_be_bytes();
        Mixture { colors: [darker, brighter], share: share ^ FOUND, single }
    }

    #[cold]
    fn find(&self, index: usize, levels: [u8; 3]) -> u32 {
        // Repeating the bits makes the lowest level black and the highest white.
        let [red, green, blue] = levels.map(|level| level << 2 | level >> (BITS - 2));
        let Mixture { colors: [darker, brighter], share, single } =
            (self.palette)().mixture(Rgb::new(red, green, blue));
        let entry = u32::from_be_bytes([FOUND | share, single, darker, brighter]);
        self.entries[index].store(entry, Ordering::Relaxed);
        entry
    }
}

impl Palette {
    fn mixture(self, color: Rgb) -> Mixture {
        let Candidates { nearest, count } = Candidates::new(color, self);
        let candidates = &nearest[..count];
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
                    let total =
                        cost(error, self.weights.chroma) + contrast * 4.0 * part * (1.0 - part);
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

/// The cost of an error in Oklab, where `chroma` is the weight of an error in chroma.
fn cost([lightness, red, yellow]: [f32; 3], chroma: f32) -> f32 {
    lightness * lightness + chroma * chroma * (red * red + yellow * yellow)
}

/// The colours that may be mixed to give a colour.
struct Candidates {
    nearest: [Candidate; MOST_CANDIDATES],
    count: usize,
}

/// A colour that may be part of a mixture, and its difference from the wanted colour. The error of
/// a mixture is the weighted mean of the errors of its colours: errors are linear in the responses
/// of the cones, and only scaled to perceived differences.
#[derive(Clone, Copy, Default)]
struct Candidate {
    index: u8,
    distance: f32,
    error: [f32; 3],
    lab: [f32; 3],
}

impl Candidates {
    fn new(color: Rgb, Palette { colors, weights }: Palette) -> Self {
        let light = linear(color);
        let Oklab(wanted) = Oklab::from_linear(light);
        let wanted = wanted.map(|part| part as f32);
        let cones = oklab::cones(light).map(|share| share as f32);
        // The derivative of the cube root, bounded near zero.
        let slopes = cones.map(|share| {
            let root = libm::cbrtf(share + 0.003);
            1.0 / (3.0 * root * root)
        });
        let chroma = |lab: [f32; 3]| libm::sqrtf(lab[1] * lab[1] + lab[2] * lab[2]);
        let own_chroma = chroma(wanted);
        let fits = |lab: [f32; 3]| {
            let cosine = lab[1] * wanted[1] + lab[2] * wanted[2];
            let chroma_of_other = chroma(lab);
            chroma_of_other < GREY
                || own_chroma >= weights.least_chroma
                    && chroma_of_other <= own_chroma + weights.most_excess
                    && cosine >= weights.hue * chroma_of_other * own_chroma
        };
        let from_cone_roots = oklab::FROM_CONE_ROOTS.map(|row| row.map(|factor| factor as f32));
        let mut nearest = [Candidate::default(); MOST_CANDIDATES];
        let mut count = 0;
        for other in colors.iter().filter(|other| fits(other.lab)) {
            let distance =
                other.lab.iter().zip(wanted).map(|(part, wanted)| (part - wanted).powi(2)).sum();
            if count == MOST_CANDIDATES && distance >= nearest[count - 1].distance {
                continue;
            }
            let roots = array::from_fn(|i| (other.cones[i] - cones[i]) * slopes[i]);
            let error = product(&from_cone_roots, roots);
            let candidate = Candidate { index: other.index, distance, error, lab: other.lab };
            count = (count + 1).min(MOST_CANDIDATES);
            nearest[count - 1] = candidate;
            let mut at = count - 1;
            while at > 0 && nearest[at - 1].distance > distance {
                nearest.swap(at - 1, at);
                at -= 1;
            }
        }
        Self { nearest, count }
    }
}

#[cfg(test)]
mod tests;
