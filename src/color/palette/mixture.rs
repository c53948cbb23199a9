//! Mixtures: the two palette colours and the glyph that make a cell look like given colours.
//!
//! A cell has two parts, such as the halves of a half block. In a small palette, either each part
//! has the palette colour nearest to its own, or one of the shades ░ ▒ ▓ fills the whole cell. A
//! shade mixes two palette colours with a grain of one dot. The 240 fixed colours have no dark
//! hues: the darkest red has an Oklab lightness of 0.31, the darkest brown 0.51. The shades add
//! some 40,000 mixtures of colours that are near each other.
//!
//! - An error is a squared distance in Oklab, with chroma weighted by [`CHROMA_WEIGHT`].
//! - The contrast between the two colours of a shade adds to its error, because the dots are
//!   visible.
//! - Most of a cell's error is the error of its mean, because the eye blurs the parts.
//! - A cell keeps the two colours of the cell to its left unless that adds [`SHARING`] or more to
//!   its error. Colours that are not sent again save bytes, and surfaces look calmer.
//! - All choices are made in integers from tables, so they are the same on every machine.
//!
//! The tables have 64 levels per channel. Their entries are computed on first use: a picture needs
//! some thousands of them, and all 262,144 would take half a second. The levels are equal steps of
//! the cube root of light, and therefore of lightness. Rejected: the upper six bits of sRGB. Its
//! lowest levels are as far apart as black and the darkest grey.

use std::ops::RangeInclusive;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{array, iter};

use super::{CUBE, ColorDepth, ShadeInk, of_256};
use crate::color::Rgb;
use crate::color::oklab::Oklab;
use crate::color::srgb::linear;

/// The look of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CellMixture {
    /// Each part in its own palette colour.
    Parts([u8; 2]),
    /// A shade with this number of quarters of text colour, from 1 to 3, in a text and a background
    /// colour.
    Shade(u8, [u8; 2]),
}

/// Chooses the looks of cells from left to right.
pub(crate) struct Mixer {
    mixtures: &'static Mixtures,
    /// The text and the background colour of the cell to the left.
    left: [u8; 2],
}

/// The share of a cell that is the whole cell, for [`Mixer::look`]. It is divisible by the number
/// of dots of every glyph set.
pub(crate) const WHOLE: u8 = 24;

impl Mixer {
    /// A mixer for `depth`, 256 or 16 colours, on a terminal that draws shades as `ink`.
    pub(crate) fn new(depth: ColorDepth, ink: ShadeInk) -> Self {
        let black = if depth == ColorDepth::Indexed16 { 0 } else { CUBE };
        Self { mixtures: Mixtures::of(depth, ink), left: [black; 2] }
    }

    /// The look of a cell whose parts have these colours. The first part covers `share` of the
    /// cell, from 0 to [`WHOLE`].
    #[inline]
    pub(crate) fn look(&mut self, colors: [Rgb; 2], share: u8) -> CellMixture {
        let shares = [share, WHOLE - share].map(u32::from);
        let (look, pair) = self.mixtures.look(colors, shares, self.left);
        self.left = pair;
        look
    }
}

/// The limits of mixing in a palette.
struct Limits {
    indices: RangeInclusive<u8>,
    /// The largest distances between two mixed colours, in lightness and in chroma.
    lightness: f64,
    chroma: f64,
    /// The error of a shade's contrast, in 4096ths of the squared distance of its two colours.
    contrast: u32,
}

impl Limits {
    /// The error that the contrast between two mixed colours adds.
    #[inline]
    fn contrast(&self, [one, other]: [WeightedOklab; 2]) -> u32 {
        (distance(one, other) >> 12) * self.contrast
    }
}

static LIMITS_OF_256: Limits =
    Limits { indices: CUBE..=u8::MAX, lightness: 0.5, chroma: 0.2, contrast: 10 };
static LIMITS_OF_16: Limits =
    Limits { indices: 0..=CUBE - 1, lightness: 1.0, chroma: 0.35, contrast: 7 };

/// The weight of the red–green and the yellow–blue component, relative to lightness.
const CHROMA_WEIGHT: f64 = 1.5;
/// The error that a cell may add to keep the colours of the cell to its left.
const SHARING: u32 = squared(0.015);
/// The weight of the errors of a cell's parts, in 256ths. The error of the whole has the rest.
const DETAIL_WEIGHT: u32 = 90;

/// A weighted colour in Oklab, in steps of 1 / [`UNIT`].
type WeightedOklab = [i16; 3];

const UNIT: f64 = 8192.0;

/// The squared distance between two places.
#[inline]
fn distance(one: WeightedOklab, other: WeightedOklab) -> u32 {
    (0..3).fold(0, |sum, i| {
        let part = i32::from(one[i]) - i32::from(other[i]);
        sum + (part * part) as u32
    })
}

/// The square of a distance in Oklab, as an error.
const fn squared(distance: f64) -> u32 {
    (distance * distance * UNIT * UNIT) as u32
}

fn place(Oklab([lightness, red, yellow]): Oklab) -> WeightedOklab {
    [lightness, CHROMA_WEIGHT * red, CHROMA_WEIGHT * yellow]
        .map(|part| libm::round(part * UNIT) as i16)
}

/// The mixtures of one palette on one kind of terminal, with tables of computed results.
struct Mixtures {
    limits: &'static Limits,
    ink: ShadeInk,
    shades: Shades,
    /// By level: the place of the colour, and the index of the palette colour nearest to it.
    nearest: Table,
    /// By level: the quarters and the colours of the shade nearest to the colour.
    mixed: Table,
    /// By text colour, background colour and quarters: the place of a shade.
    places: Table,
}

/// Words that are zero until they are computed. Every thread computes the same word, so it does not
/// matter which thread stores it.
struct Table(Box<[AtomicU64]>);

impl Table {
    fn new(bits: u32) -> Self {
        Self(iter::repeat_with(|| AtomicU64::new(0)).take(1 << bits).collect())
    }

    /// The word at `index`. Calls `compute` on first use, which must not return zero.
    #[inline]
    fn get(&self, index: usize, compute: impl FnOnce() -> u64) -> u64 {
        let word = self.0[index].load(Ordering::Relaxed);
        if word != 0 {
            return word;
        }
        let word = compute();
        self.0[index].store(word, Ordering::Relaxed);
        word
    }
}

/// The number of bits of a channel's level.
const BITS: u32 = 6;
/// A bit that is set in every word of a table.
const FOUND: u64 = 1 << 63;

fn pack(place: WeightedOklab, index: u8) -> u64 {
    let [l, a, b] = place.map(|part| u64::from(part as u16));
    FOUND | u64::from(index) << 48 | l << 32 | a << 16 | b
}

#[inline]
fn unpack(word: u64) -> (WeightedOklab, u8) {
    ([32, 16, 0].map(|bits| (word >> bits) as i16), (word >> 48) as u8)
}

impl Mixtures {
    fn of(depth: ColorDepth, ink: ShadeInk) -> &'static Self {
        use ShadeInk::{Dots, Flat, Unknown};
        static MIXTURES: [LazyLock<Mixtures>; 6] = [
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_256, Dots)),
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_256, Flat)),
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_256, Unknown)),
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_16, Dots)),
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_16, Flat)),
            LazyLock::new(|| Mixtures::new(&LIMITS_OF_16, Unknown)),
        ];
        let of_ink = match ink {
            Dots => 0,
            Flat => 1,
            Unknown => 2,
        };
        &MIXTURES[if depth == ColorDepth::Indexed16 { 3 + of_ink } else { of_ink }]
    }

    fn new(limits: &'static Limits, ink: ShadeInk) -> Self {
        Self {
            limits,
            ink,
            shades: Shades::new(limits, ink),
            nearest: Table::new(3 * BITS),
            mixed: Table::new(3 * BITS),
            places: Table::new(18),
        }
    }

    /// The look of a cell to the right of a cell in the colours `left`, and the two colours of the
    /// cell.
    #[inline]
    fn look(&self, colors: [Rgb; 2], shares: [u32; 2], left: [u8; 2]) -> (CellMixture, [u8; 2]) {
        let light = LightTables::get();
        let nearest = colors.map(|color| self.nearest(light.level(color)));
        let level = light.level_of_mean(colors, shares);
        let wanted = TargetColors {
            parts: nearest.map(|(place, _)| place),
            mean: self.nearest(level).0,
            shares,
        };
        let indices = nearest.map(|(_, index)| index);
        let parts = (self.error_of_parts(&wanted, indices), CellMixture::Parts(indices));
        let (quarters, pair) = self.mixed(level);
        let shade =
            (self.error_of_shade(&wanted, quarters, pair), CellMixture::Shade(quarters, pair));
        let best = if shade.0 < parts.0 { shade } else { parts };

        let mut shared = (best.0 + SHARING, best.1);
        let mut offer = |error, look| {
            if error < shared.0 {
                shared = (error, look);
            }
        };
        let [text, ground] = left;
        for pair in [[ground; 2], [text; 2], left, [ground, text]] {
            offer(self.error_of_parts(&wanted, pair), CellMixture::Parts(pair));
        }
        if text != ground {
            for quarters in 1..=3 {
                let error = self.error_of_shade(&wanted, quarters, left);
                offer(error, CellMixture::Shade(quarters, left));
            }
        }
        let look = shared.1;
        (look, colors_after(look, left))
    }

    /// The error of drawing the parts in these palette colours.
    #[inline]
    fn error_of_parts(&self, wanted: &TargetColors, colors: [u8; 2]) -> u32 {
        let [one, other] = colors.map(|color| self.place(color));
        let shown = array::from_fn(|i| {
            let [one, other] = [one[i], other[i]].map(i32::from);
            let sum = one * wanted.shares[0] as i32 + other * wanted.shares[1] as i32;
            (sum / i32::from(WHOLE)) as i16
        });
        wanted.error(shown, [one, other])
    }

    /// The error of a shade, including the error of its contrast.
    #[inline]
    fn error_of_shade(&self, wanted: &TargetColors, quarters: u8, colors: [u8; 2]) -> u32 {
        let shown = self.place_of_shade(quarters, colors);
        let contrast = self.limits.contrast(colors.map(|color| self.place(color)));
        wanted.error(shown, [shown; 2]) + contrast
    }

    /// The place of the colour at that level, and the palette colour nearest to it.
    #[inline]
    fn nearest(&self, level: usize) -> (WeightedOklab, u8) {
        unpack(self.nearest.get(level, || {
            let place = place(Oklab::from_linear(light_of_level(level)));
            pack(place, self.shades.nearest_color(place))
        }))
    }

    /// The quarters and the colours of the shade nearest to the colour at that level.
    #[inline]
    fn mixed(&self, level: usize) -> (u8, [u8; 2]) {
        let word = self.mixed.get(level, || {
            let Shade { quarters, colors: [text, ground], .. } =
                *self.shades.nearest(self.nearest(level).0);
            FOUND | u64::from(u32::from_be_bytes([0, quarters, text, ground]))
        });
        let [_, quarters, text, ground] = (word as u32).to_be_bytes();
        (quarters, [text, ground])
    }

    /// The place of a palette colour.
    #[inline]
    fn place(&self, index: u8) -> WeightedOklab {
        self.place_of_shade(0, [index; 2])
    }

    /// The place of a shade.
    #[inline]
    fn place_of_shade(&self, quarters: u8, colors: [u8; 2]) -> WeightedOklab {
        let [text, ground] = colors.map(usize::from);
        let index = text << 10 | ground << 2 | usize::from(quarters);
        unpack(self.places.get(index, || pack(place(self.ink.mixed(quarters, colors)), 0))).0
    }
}

/// The look that a cell should have.
struct TargetColors {
    parts: [WeightedOklab; 2],
    /// The place of the mean light.
    mean: WeightedOklab,
    shares: [u32; 2],
}

impl TargetColors {
    /// The error of a cell whose parts look like `parts` and that looks like `mean` as a whole.
    /// Most of it is the error of the whole, because the eye blurs the parts.
    #[inline]
    fn error(&self, mean: WeightedOklab, parts: [WeightedOklab; 2]) -> u32 {
        let apart = [0, 1].map(|i| self.shares[i] * (distance(self.parts[i], parts[i]) >> 8));
        let apart = (apart[0] + apart[1]) / u32::from(WHOLE);
        apart * DETAIL_WEIGHT + (distance(self.mean, mean) >> 8) * (256 - DETAIL_WEIGHT)
    }
}

/// The two colours of a cell to the right of a cell in the colours `left`. A cell of a single
/// colour keeps one colour of `left` beside its own.
#[inline]
fn colors_after(look: CellMixture, left: [u8; 2]) -> [u8; 2] {
    match look {
        CellMixture::Parts([one, other]) if one == other => {
            if left.contains(&one) {
                left
            } else {
                [left[0], one]
            }
        }
        CellMixture::Parts([one, other]) if left == [other, one] => left,
        CellMixture::Parts(pair) | CellMixture::Shade(_, pair) => pair,
    }
}

/// A shade of two palette colours.
#[derive(Clone, Copy)]
struct Shade {
    place: WeightedOklab,
    contrast: u32,
    quarters: u8,
    colors: [u8; 2],
}

/// All shades of a palette, and its colours.
struct Shades {
    colors: Vec<(u8, WeightedOklab)>,
    /// In the order of their bins.
    all: Vec<Shade>,
    /// The index of the first shade of each bin. The last entry is the number of shades.
    starts: Vec<u32>,
}

/// The number of bins along each axis of Oklab, and their width in steps.
const BINS: i32 = 17;
const BIN_WIDTH: i32 = UNIT as i32 / 16;

/// The bin of a place, along each axis.
fn bin([l, a, b]: WeightedOklab) -> [i32; 3] {
    let middle = BINS / 2;
    let along = |part: i16| i32::from(part).div_euclid(BIN_WIDTH);
    [along(l), along(a) + middle, along(b) + middle].map(|bin| bin.clamp(0, BINS - 1))
}

fn bin_index([l, a, b]: [i32; 3]) -> usize {
    ((l * BINS + a) * BINS + b) as usize
}

impl Shades {
    fn new(limits: &Limits, ink: ShadeInk) -> Self {
        let colors: Vec<(u8, Oklab)> =
            limits.indices.clone().map(|index| (index, of_256(index).into())).collect();
        let mut shades = Vec::new();
        for (text, one) in &colors {
            for (ground, other) in &colors {
                let [l, a, b] = array::from_fn(|i| one.0[i] - other.0[i]);
                // The text is the lighter colour.
                let is_near = l <= limits.lightness && libm::hypot(a, b) <= limits.chroma;
                if is_near && (l, text) > (0.0, ground) {
                    let colors = [*text, *ground];
                    let contrast = limits.contrast([place(*one), place(*other)]);
                    shades.extend([1, 2, 3].map(|quarters| {
                        let place = place(ink.mixed(quarters, colors));
                        Shade { place, contrast, quarters, colors }
                    }));
                }
            }
        }
        shades.sort_by_key(|shade| bin_index(bin(shade.place)));
        let starts = (0..=(BINS * BINS * BINS) as usize).map(|index| {
            shades.partition_point(|shade| bin_index(bin(shade.place)) < index) as u32
        });
        let starts = starts.collect();
        let colors = colors.into_iter().map(|(index, color)| (index, place(color))).collect();
        Self { colors, all: shades, starts }
    }

    fn nearest_color(&self, place: WeightedOklab) -> u8 {
        let by_distance = |&&(_, color): &&(u8, WeightedOklab)| distance(place, color);
        self.colors.iter().min_by_key(by_distance).map_or(0, |&(index, _)| index)
    }

    /// The shade with the least sum of error and contrast. The search starts in the bin of the
    /// place and continues in bins that are farther and farther away, until none of them can
    /// contain a better shade.
    fn nearest(&self, place: WeightedOklab) -> &Shade {
        let mut best = (u32::MAX, &self.all[0]);
        let middle = bin(place);
        for radius in 0..BINS {
            let outside = (radius - 1).max(0) * BIN_WIDTH;
            if radius > 0 && best.0 <= (outside * outside) as u32 {
                break;
            }
            let along = |axis: usize| {
                (middle[axis] - radius).max(0)..=(middle[axis] + radius).min(BINS - 1)
            };
            for l in along(0) {
                for a in along(1) {
                    for b in along(2) {
                        let at = [l, a, b];
                        if (0..3).all(|axis| (at[axis] - middle[axis]).abs() < radius) {
                            continue;
                        }
                        let index = bin_index(at);
                        let range = self.starts[index] as usize..self.starts[index + 1] as usize;
                        for shade in &self.all[range] {
                            let error = distance(place, shade.place) + shade.contrast;
                            if error < best.0 {
                                best = (error, shade);
                            }
                        }
                    }
                }
            }
        }
        best.1
    }
}

impl ShadeInk {
    /// The colour of a shade with this number of quarters of text colour.
    pub(crate) fn mixed(self, quarters: u8, colors: [u8; 2]) -> Oklab {
        let share = f64::from(quarters) / 4.0;
        let colors = colors.map(of_256);
        let between = |text: f64, ground: f64| ground + (text - ground) * share;
        let dots = || {
            let [text, ground] = colors.map(linear);
            Oklab::from_linear(array::from_fn(|i| between(text[i], ground[i])))
        };
        let flat = || {
            let [text, ground] = colors.map(|color| color.channels().map(f64::from));
            let [red, green, blue] =
                array::from_fn(|i| libm::round(between(text[i], ground[i])) as u8);
            Oklab::from(Rgb::new(red, green, blue))
        };
        match self {
            Self::Dots => dots(),
            Self::Flat => flat(),
            Self::Unknown => {
                let (dots, flat) = (dots().0, flat().0);
                Oklab(array::from_fn(|i| f64::midpoint(dots[i], flat[i])))
            }
        }
    }
}

/// Tables from channel values and from steps of light to levels.
struct LightTables {
    of_channel: [u32; 256],
    level_of_channel: [u8; 256],
    /// The level of each step of light.
    levels: [u8; Self::STEPS + 1],
}

impl LightTables {
    const STEPS: usize = 1 << 12;
    /// Full light. The sum of [`WHOLE`] shares of it has at most 32 bits.
    const FULL: f64 = (Self::STEPS << 3) as f64;

    #[inline]
    fn get() -> &'static Self {
        static LIGHT: LazyLock<LightTables> = LazyLock::new(|| {
            let of_channel = |value: usize| linear(Rgb::new(value as u8, 0, 0))[0];
            let level =
                |light: f64| libm::round(libm::cbrt(light) * f64::from((1 << BITS) - 1)) as u8;
            LightTables {
                of_channel: array::from_fn(|value| {
                    libm::round(of_channel(value) * LightTables::FULL) as u32
                }),
                level_of_channel: array::from_fn(|value| level(of_channel(value))),
                levels: array::from_fn(|step| level(step as f64 / LightTables::STEPS as f64)),
            }
        });
        &LIGHT
    }

    /// The level of a colour, as an index of a table.
    #[inline]
    fn level(&self, color: Rgb) -> usize {
        index(color.channels().map(|channel| self.level_of_channel[usize::from(channel)]))
    }

    /// The level of the mean light of two colours.
    #[inline]
    fn level_of_mean(&self, colors: [Rgb; 2], shares: [u32; 2]) -> usize {
        let [one, other] = colors.map(Rgb::channels);
        index(array::from_fn(|i| {
            let light = [one, other].map(|color| self.of_channel[usize::from(color[i])]);
            let sum = light[0] * shares[0] + light[1] * shares[1];
            self.levels[(sum / (u32::from(WHOLE) << 3)) as usize]
        }))
    }
}

#[inline]
fn index(levels: [u8; 3]) -> usize {
    levels.into_iter().fold(0, |index, level| index << BITS | usize::from(level))
}

/// Red, green and blue light in the middle of a level.
fn light_of_level(level: usize) -> [f64; 3] {
    [2, 1, 0].map(|channel| {
        let level = level >> (channel * BITS) & ((1 << BITS) - 1);
        let root = level as f64 / f64::from((1 << BITS) - 1);
        root * root * root
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOOKS: [(ColorDepth, ShadeInk); 4] = [
        (ColorDepth::Indexed256, ShadeInk::Dots),
        (ColorDepth::Indexed256, ShadeInk::Flat),
        (ColorDepth::Indexed256, ShadeInk::Unknown),
        (ColorDepth::Indexed16, ShadeInk::Dots),
    ];

    /// The colour that a cell shows for one given colour.
    fn shown(color: Rgb, (depth, ink): (ColorDepth, ShadeInk)) -> Oklab {
        match Mixer::new(depth, ink).look([color; 2], WHOLE / 2) {
            CellMixture::Parts([one, other]) => {
                assert_eq!(one, other, "{color:?}");
                of_256(one).into()
            }
            CellMixture::Shade(quarters, colors) => ink.mixed(quarters, colors),
        }
    }

    /// Colours of every hue and lightness.
    fn colors() -> impl Iterator<Item = Rgb> {
        let channel = |digit: usize| (36 * digit) as u8;
        (0..512).map(move |n| Rgb::new(channel(n / 64), channel(n / 8 % 8), channel(n % 8)))
    }

    fn error(one: Oklab, other: Oklab) -> f64 {
        let [l, a, b] = array::from_fn(|i| one.0[i] - other.0[i]);
        libm::sqrt(l * l + (CHROMA_WEIGHT * CHROMA_WEIGHT) * (a * a + b * b))
    }

    #[test]
    fn no_palette_colour_or_shade_is_much_nearer_than_the_look() {
        for look in LOOKS {
            let (depth, ink) = look;
            let limits =
                if depth == ColorDepth::Indexed16 { &LIMITS_OF_16 } else { &LIMITS_OF_256 };
            let mut all: Vec<(Oklab, f64)> = Vec::new();
            for text in limits.indices.clone() {
                all.push((of_256(text).into(), 0.0));
                for ground in limits.indices.clone() {
                    let [one, other] = [text, ground].map(|index| Oklab::from(of_256(index)));
                    let [l, a, b] = array::from_fn(|i| one.0[i] - other.0[i]);
                    if l.abs() <= limits.lightness && libm::hypot(a, b) <= limits.chroma {
                        let contrast =
                            error(one, other) * libm::sqrt(f64::from(limits.contrast)) / 64.0;
                        all.extend([1, 2, 3].map(|q| (ink.mixed(q, [text, ground]), contrast)));
                    }
                }
            }
            for color in colors().step_by(5) {
                let wanted = Oklab::from(color);
                let cost =
                    |&(shown, contrast): &(Oklab, f64)| libm::hypot(error(shown, wanted), contrast);
                let least = all.iter().map(cost).fold(f64::INFINITY, f64::min);
                // A level is up to 0.008 off in lightness, and a dark cell may keep the black to
                // its left.
                assert!(error(shown(color, look), wanted) < least + 0.02, "{look:?} {color:?}");
            }
        }
    }

    #[test]
    fn dark_wood_is_brown_and_dark_brick_red() {
        let chroma = |color| {
            let Oklab([_, redness, yellowness]) = color;
            (redness, yellowness)
        };
        for look in &LOOKS[..3] {
            for wood in [Rgb::new(96, 64, 36), Rgb::new(80, 52, 28), Rgb::new(72, 46, 26)] {
                let (redness, yellowness) = chroma(shown(wood, *look));
                assert!(redness > 0.0 && yellowness > 0.03, "{look:?} {wood:?}");
            }
            for brick in [Rgb::new(110, 48, 38), Rgb::new(90, 38, 30), Rgb::new(140, 70, 56)] {
                assert!(chroma(shown(brick, *look)).0 > 0.05, "{look:?} {brick:?}");
            }
            for joint in [Rgb::new(92, 84, 80), Rgb::new(120, 112, 106), Rgb::new(70, 66, 64)] {
                assert!(chroma(shown(joint, *look)).0 < 0.02, "{look:?} {joint:?}");
            }
        }
    }

    #[test]
    fn a_cell_reuses_the_colours_to_its_left_except_at_an_edge() {
        let mut mixer = Mixer::new(ColorDepth::Indexed256, ShadeInk::Dots);
        let pair = |look| match look {
            CellMixture::Shade(_, pair) | CellMixture::Parts(pair) => pair,
        };
        let wall = |shade: u8| [Rgb::new(90 + shade, 60 + shade, 36 + shade); 2];
        let pairs: Vec<_> = (0..40).map(|shade| pair(mixer.look(wall(shade), 12))).collect();
        let changes = pairs.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes < 15, "{pairs:?}");
        let edge = mixer.look([Rgb::new(230, 220, 200), Rgb::new(20, 20, 20)], 12);
        assert!(matches!(edge, CellMixture::Parts([top, bottom]) if top != bottom), "{edge:?}");
    }
}
