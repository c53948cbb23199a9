//! Which two colours of a palette, side by side, look like a given one from a little farther away.
//!
//! Of every pair of colours that are near the wanted one, in each of a few shares, the one is taken whose
//! sum of light looks nearest, in Oklab; what differs between the two counts as well, since it shows as dots. A
//! colour of another hue than the wanted one is in no mixture: grey and one hue reach all that is
//! between them, and a green dot in a brick is seen. The idea is Joel Yliluoma's ("Arbitrary-palette positional dithering
//! algorithm", 2011). Sets of four colours were refused: a little nearer, but twice the bytes.
//!
//! A mixture is looked up by the upper six bits of each channel, and found when it is first asked for:
//! some hundreds of them are in a picture, and all 262,144 would take seconds.

use std::array;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};

use super::{CUBE, of_256};
use crate::color::oklab::{self, Oklab};
use crate::color::srgb::linear;
use crate::color::{Rgb, product};

/// Two colours and how much there is of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Mixture {
    /// The indices of the darker and of the brighter colour.
    pub(crate) colors: [u8; 2],
    /// So many of [`Mixture::WHOLE`] pixels have the brighter one; fewer than all.
    pub(crate) share: u8,
    /// The index of the one colour to show where there is room for one only.
    pub(crate) single: u8,
}

impl Mixture {
    /// How many pixels a mixture is made for.
    pub(crate) const WHOLE: u8 = 4;
    const NONE: Self = Self { colors: [0; 2], share: 0, single: 0 };
}

/// The mixtures for all colours, each found when it is first asked for.
pub(crate) struct Mixtures {
    palette: fn() -> Palette,
    entries: [AtomicU32; 1 << (3 * BITS)],
}

/// So many bits of each channel are told apart.
pub(crate) const BITS: u32 = 6;
/// Entries that have been found have this bit in their uppermost byte, beside the share.
const FOUND: u8 = 1 << 7;

/// The mixtures of the 240 fixed colours of xterm.
pub(crate) static OF_256: Mixtures = Mixtures::new(|| {
    static PALETTE: LazyLock<Vec<Paint>> =
        LazyLock::new(|| (CUBE..=u8::MAX).map(Paint::of).collect());
    Palette { paints: &PALETTE, taste: FINE }
});

/// The mixtures of twelve of the 16 named colours. Cyan and magenta are the hue of next to nothing in a room, and glare
/// as stray dots where stone is a little blue.
pub(crate) static OF_16: Mixtures = Mixtures::new(|| {
    const LEFT_OUT: [u8; 4] = [5, 6, 13, 14];
    static PALETTE: LazyLock<Vec<Paint>> = LazyLock::new(|| {
        (0..CUBE).filter(|index| !LEFT_OUT.contains(index)).map(Paint::of).collect()
    });
    Palette { paints: &PALETTE, taste: COARSE }
});

/// What is mixed, and how.
#[derive(Clone, Copy)]
struct Palette {
    paints: &'static [Paint],
    taste: Taste,
}

/// What counts how much.
#[derive(Clone, Copy)]
struct Taste {
    /// Of a difference in chroma, over one in lightness: of mixtures, and of single colours, which would
    /// else be grey too often.
    chroma: f32,
    single: f32,
    /// Of the differences in lightness and in chroma between the two colours.
    contrast: [f32; 2],
    /// How near the hue must be, as a cosine.
    hue: f32,
    /// What has less chroma is mixed of greys only.
    least_chroma: f32,
    /// How much more chroma a colour of a mixture may have than the wanted one: what has more glares as dots.
    most_excess: f32,
}

/// Found by trying, with `cellcaster wire --palette 256`.
const FINE: Taste = Taste {
    chroma: 2.0,
    single: 1.0,
    contrast: [0.03, 0.01],
    hue: 0.5,
    least_chroma: 0.005,
    most_excess: 0.1,
};
/// Of a few glaring colours, which users give shades of their own, as few as possible.
const COARSE: Taste = Taste {
    chroma: 1.0,
    single: 1.0,
    contrast: [0.008, 0.02],
    hue: 0.9,
    least_chroma: 0.045,
    most_excess: 1.0,
};

/// So many colours are considered for a mixture: those that are nearest.
const CONSIDERED: usize = 40;
/// What has less chroma is grey, and of every hue.
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
        // Whoever finds an entry finds the same one, so it does not matter who is first.
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
            let alone = |candidate: &Candidate| cost(candidate.error, self.taste.single);
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
            consider(cost(one.error, self.taste.chroma), [one.index; 2], 0);
            for other in &considered[place + 1..] {
                let contrast = self.contrast(one, other);
                for share in 1..Mixture::WHOLE {
                    let part = f32::from(share) / f32::from(Mixture::WHOLE);
                    let error =
                        array::from_fn(|i| one.error[i] + (other.error[i] - one.error[i]) * part);
                    let price =
                        cost(error, self.taste.chroma) + contrast * 4.0 * part * (1.0 - part);
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
        self.taste.contrast[0] * square(0) + self.taste.contrast[1] * (square(1) + square(2))
    }
}

/// What an error costs where one in chroma counts so much.
fn cost([lightness, red, yellow]: [f32; 3], chroma: f32) -> f32 {
    lightness * lightness + chroma * chroma * (red * red + yellow * yellow)
}

/// A colour to be mixed, and what it may be mixed of.
struct Target {
    considered: [Candidate; CONSIDERED],
    count: usize,
}

/// A colour that may be in a mixture, and how far it is from the wanted one. Errors of a mixture are the
/// mixed errors of its colours, since they are as cones take them, and only scaled as people see them.
#[derive(Clone, Copy, Default)]
struct Candidate {
    index: u8,
    distance: f32,
    error: [f32; 3],
    lab: [f32; 3],
}

impl Target {
    fn new(color: Rgb, Palette { paints, taste }: Palette) -> Self {
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
                || own_chroma >= taste.least_chroma
                    && its_chroma <= own_chroma + taste.most_excess
                    && cosine >= taste.hue * its_chroma * own_chroma
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
mod tests {
    use super::*;

    fn mixture(red: u8, green: u8, blue: u8) -> Mixture {
        OF_256.of([red, green, blue].map(|channel| channel >> (u8::BITS - BITS)))
    }

    #[test]
    fn dark_bricks_are_mixed_of_red_and_grey() {
        let Mixture { colors, share, .. } = mixture(80, 32, 24);
        let [darker, brighter] = colors.map(|index| Oklab::from(of_256(index)));
        assert!(share > 0 && share < Mixture::WHOLE);
        assert!(darker.0[0] <= brighter.0[0]);
        assert!(darker.0[1].max(brighter.0[1]) > 0.05, "{colors:?}");
    }

    #[test]
    fn greys_are_mixed_of_greys() {
        for level in (0..=255).step_by(4) {
            let Mixture { colors, single, .. } = mixture(level, level, level);
            for index in [colors[0], colors[1], single] {
                let [red, green, blue] = of_256(index).channels();
                assert!(red == green && green == blue, "{level}: {index}");
            }
        }
    }

    #[test]
    fn a_mixture_looks_more_like_the_colour_than_the_nearest_colour_does() {
        let mut better = 0;
        for color in [[100, 40, 30], [90, 80, 60], [60, 90, 120], [140, 130, 115], [40, 60, 40]] {
            let wanted = Oklab::from(Rgb::new(color[0], color[1], color[2]));
            let [red, green, blue] = color;
            let Mixture { colors, share, .. } = mixture(red, green, blue);
            let part = f64::from(share) / f64::from(Mixture::WHOLE);
            let [darker, brighter] = colors.map(|index| linear(of_256(index)));
            let mixed: [f64; 3] = array::from_fn(|i| darker[i] + (brighter[i] - darker[i]) * part);
            let mixed = Oklab::from_linear(mixed).distance_squared(&wanted);
            let nearest = (CUBE..=u8::MAX)
                .map(|index| Oklab::from(of_256(index)).distance_squared(&wanted))
                .fold(f64::INFINITY, f64::min);
            better += u32::from(mixed < 0.5 * nearest);
        }
        assert!(better >= 4, "{better} of 5");
    }
}
