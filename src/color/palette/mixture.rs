//! Dithering: the two colours of a palette that look like a third one where they stand side by side.
//!
//! The search takes each pair of colours near the wanted one, in a few proportions, and keeps the pair whose
//! mixed light is nearest in Oklab. The contrast of the two adds to their cost, since it shows as dots. A
//! colour of another hue than the wanted one is in no mixture: grey and one hue reach all colours
//! between them, and a green dot in a brick is visible. Source: Joel Yliluoma, "Arbitrary-palette positional dithering
//! algorithm" (2011). Sets of four colours were refused: they are a little nearer, but take twice the bytes.
//!
//! A mixture is looked up by the upper six bits of each channel, and computed at its first look-up:
//! a picture has some hundreds of them, and all 262,144 take seconds.

use std::array;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{CUBE, of_256};
use crate::color::oklab::{self, Oklab};
use crate::color::srgb::linear;
use crate::color::{Rgb, product};

/// Two colours and their proportion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mixture {
    /// The indices of the darker and of the brighter colour.
    pub(crate) colors: [u8; 2],
    /// The number of pixels with the brighter colour among [`Mixture::WHOLE`], and fewer than that.
    pub(crate) share: u8,
    /// The index of the best single colour, for pixels that cannot be mixed.
    pub(crate) single: u8,
}

impl Mixture {
    /// The number of pixels that a mixture is made for.
    pub(crate) const WHOLE: u8 = 4;
    const NONE: Self = Self { colors: [0; 2], share: 0, single: 0 };
}

/// The mixtures for all colours, each computed at its first look-up.
pub(crate) struct Mixtures {
    palette: fn() -> Palette,
    entries: [AtomicU32; 1 << (3 * BITS)],
}

/// The upper bits of each channel that the table distinguishes.
pub(crate) const BITS: u32 = 6;
/// The bit that marks a computed entry, in its uppermost byte, beside the share.
const FOUND: u8 = 1 << 7;

/// The mixtures of the 240 fixed colours of xterm.
pub(crate) static OF_256: Mixtures = Mixtures::new(|| {
    static PALETTE: LazyLock<Vec<Paint>> =
        LazyLock::new(|| (CUBE..=u8::MAX).map(Paint::of).collect());
    Palette { paints: &PALETTE, weights: FINE }
});

/// The mixtures of twelve of the 16 named colours, without cyan and magenta: next to nothing in a room has their hues, and
/// they glare as stray dots where stone is a little blue.
pub(crate) static OF_16: Mixtures = Mixtures::new(|| {
    const LEFT_OUT: [u8; 4] = [5, 6, 13, 14];
    static PALETTE: LazyLock<Vec<Paint>> = LazyLock::new(|| {
        (0..CUBE).filter(|index| !LEFT_OUT.contains(index)).map(Paint::of).collect()
    });
    Palette { paints: &PALETTE, weights: COARSE }
});

/// The colours to mix, and the weights of the search.
#[derive(Clone, Copy)]
struct Palette {
    paints: &'static [Paint],
    weights: Weights,
}

/// The weights and limits of the search.
#[derive(Clone, Copy)]
struct Weights {
    /// The weight of a difference in chroma over one in lightness, for mixtures.
    chroma: f32,
    /// The same for single colours.
    single: f32,
    /// The weights of the differences in lightness and in chroma between the two colours.
    contrast: [f32; 2],
    /// The least cosine of the angle between two hues in one mixture.
    hue: f32,
    /// The chroma below which a colour is mixed of greys only.
    least_chroma: f32,
    /// The most chroma that a colour of a mixture may have beyond the wanted one: with more it glares as dots.
    most_excess: f32,
}

/// Found by trying, with `cellcaster wire --palette 256`.
const FINE: Weights = Weights {
    chroma: 2.0,
    single: 1.0,
    contrast: [0.03, 0.01],
    hue: 0.5,
    least_chroma: 0.005,
    most_excess: 0.1,
};
/// These use as few as possible of the glaring colours, which users redefine.
const COARSE: Weights = Weights {
    chroma: 1.0,
    single: 1.0,
    contrast: [0.008, 0.02],
    hue: 0.9,
    least_chroma: 0.045,
    most_excess: 1.0,
};

/// The number of nearest colours that are considered for a mixture.
const CONSIDERED: usize = 40;
/// The chroma below which a colour is grey, and fits every hue.
const GREY: f32 = 0.01;

/// A colour of the palette.
#[derive(Clone, Copy)]
struct Paint {
    index: u8,
    cones: [f32; 3],
    lab: [f32; 3],
}

impl Paint {
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
    #[expect(clippy::large_stack_arrays, reason = "it is made when the program is compiled")]
    const fn new(palette: fn() -> Palette) -> Self {
        Self { palette, entries: [const { AtomicU32::new(0) }; 1 << (3 * BITS)] }
    }

    /// The mixture for a colour of which the upper bits of red, green and blue are given.
    #[inline]
    pub(crate) fn of(&self, [red, green, blue]: [u8; 3]) -> Mixture {
        let mask = (1 << BITS) - 1;
        let place = [red, green, blue]
            .iter()
            .fold(0, |place, &channel| place << BITS | usize::from(channel) & mask);
        // Every thread computes the same entry, so it does not matter which one is first.
        let known = self.entries[place].load(Ordering::Relaxed);
        let entry = if known == 0 { self.find(place, [red, green, blue]) } else { known };
        let [share, single, darker, brighter] = entry.to_be_bytes();
        Mixture { colors: [darker, brighter], share: share ^ FOUND, single }
    }

    #[cold]
    fn find(&self, place: usize, levels: [u8; 3]) -> u32 {
        // Repeating the bits makes the lowest level black and the highest white.
        let [red, green, blue] = levels.map(|level| level << 2 | level >> (BITS - 2));
        let Mixture { colors: [darker, brighter], share, single } =
            (self.palette)().mixture(Rgb::new(red, green, blue));
        let entry = u32::from_be_bytes([FOUND | share, single, darker, brighter]);
        self.entries[place].store(entry, Ordering::Relaxed);
        entry
    }
}

impl Palette {
    fn mixture(self, color: Rgb) -> Mixture {
        let Target { considered, count } = Target::new(color, self);
        let considered = &considered[..count];
        let single = considered.iter().min_by(|one, other| {
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
        for (place, one) in considered.iter().enumerate() {
            consider(cost(one.error, self.weights.chroma), [one.index; 2], 0);
            for other in &considered[place + 1..] {
                let contrast = self.contrast(one, other);
                for share in 1..Mixture::WHOLE {
                    let part = f32::from(share) / f32::from(Mixture::WHOLE);
                    let error =
                        array::from_fn(|i| one.error[i] + (other.error[i] - one.error[i]) * part);
                    let price =
                        cost(error, self.weights.chroma) + contrast * 4.0 * part * (1.0 - part);
                    if one.lab[0] <= other.lab[0] {
                        consider(price, [one.index, other.index], share);
                    } else {
                        consider(price, [other.index, one.index], Mixture::WHOLE - share);
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

/// The cost of an error, with the weight of an error in chroma.
fn cost([lightness, red, yellow]: [f32; 3], chroma: f32) -> f32 {
    lightness * lightness + chroma * chroma * (red * red + yellow * yellow)
}

/// A colour to be mixed, and what it may be mixed of.
struct Target {
    considered: [Candidate; CONSIDERED],
    count: usize,
}

/// A colour that may be in a mixture, and its error against the wanted one. Errors are linear in light, and only scaled
/// to Oklab, so the error of a mixture is the mixture of the errors.
#[derive(Clone, Copy, Default)]
struct Candidate {
    index: u8,
    distance: f32,
    error: [f32; 3],
    lab: [f32; 3],
}

impl Target {
    fn new(color: Rgb, Palette { paints, weights }: Palette) -> Self {
        let light = linear(color);
        let Oklab(wanted) = Oklab::from_linear(light);
        let wanted = wanted.map(|part| part as f32);
        let cones = oklab::cones(light).map(|share| share as f32);
        // The slope of the cube root, which is none at zero.
        let slopes = cones.map(|share| {
            let root = libm::cbrtf(share + 0.003);
            1.0 / (3.0 * root * root)
        });
        let chroma = |lab: [f32; 3]| libm::sqrtf(lab[1] * lab[1] + lab[2] * lab[2]);
        let own_chroma = chroma(wanted);
        let fits = |lab: [f32; 3]| {
            let cosine = lab[1] * wanted[1] + lab[2] * wanted[2];
            let its_chroma = chroma(lab);
            its_chroma < GREY
                || own_chroma >= weights.least_chroma
                    && its_chroma <= own_chroma + weights.most_excess
                    && cosine >= weights.hue * its_chroma * own_chroma
        };
        let from_cone_roots = oklab::FROM_CONE_ROOTS.map(|row| row.map(|factor| factor as f32));
        let mut considered = [Candidate::default(); CONSIDERED];
        let mut count = 0;
        for paint in paints.iter().filter(|paint| fits(paint.lab)) {
            let distance =
                paint.lab.iter().zip(wanted).map(|(one, other)| (one - other).powi(2)).sum();
            if count == CONSIDERED && distance >= considered[count - 1].distance {
                continue;
            }
            let roots = array::from_fn(|i| (paint.cones[i] - cones[i]) * slopes[i]);
            let error = product(&from_cone_roots, roots);
            let candidate = Candidate { index: paint.index, distance, error, lab: paint.lab };
            count = (count + 1).min(CONSIDERED);
            considered[count - 1] = candidate;
            let mut at = count - 1;
            while at > 0 && considered[at - 1].distance > distance {
                considered.swap(at - 1, at);
                at -= 1;
            }
        }
        Self { considered, count }
    }
}

#[cfg(test)]
mod tests;
