//! Colours that may be shown in place of others, their cost in bytes, and the price of errors.

use super::block::MosaicShape;
use super::style::{Notation, PackedColor, PackedColorKind};
use crate::color::Rgb;
use crate::color::lab::PackedLab;
use crate::color::palette;
use crate::terminal::Fidelity;

/// A colour, and its place in CIE L\*a\*b\*.
///
/// Users can redefine the 16 named colours, and the terminal's default colours are unknown. Both
/// are placed far from all other colours, so that no tolerance confuses them with others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ink {
    pub(crate) lab: [f32; 3],
    pub(crate) shade: PackedColor,
}

impl Ink {
    /// The ink of `shade`. An indexed colour counts as xterm's standard colour.
    #[inline(never)]
    pub(crate) fn new(shade: PackedColor) -> Self {
        let lab = match shade.kind() {
            PackedColorKind::Rgb(channels) => PackedLab::of(channels).components(),
            PackedColorKind::Indexed(index) => {
                let [l, a, b] = PackedLab::of(palette::of_256(index).channels()).components();
                if index < FIRST_FIXED { [l + NAMED, a, b] } else { [l, a, b] }
            }
            PackedColorKind::Default => [OWN; 3],
        };
        Self { lab, shade }
    }

    /// The number of bytes of the colour's parameters.
    #[inline]
    pub(crate) fn bytes(self) -> f32 {
        self.shade.bytes() as f32
    }

    /// The distance ΔE of CIE76.
    #[inline]
    pub(crate) fn distance(self, other: Self) -> f32 {
        distance(self.lab, other.lab)
    }
}

/// The first index after the named colours.
const FIRST_FIXED: u8 = 16;
/// The distance of the named colours from all others.
const NAMED: f32 = 20_000.0;
/// The place of the terminal's default colours.
const OWN: f32 = 1e6;

/// The distance ΔE of CIE76.
#[inline]
pub(crate) fn distance(one: [f32; 3], other: [f32; 3]) -> f32 {
    squared_distance(one, other).sqrt()
}

#[inline]
fn squared_distance(one: [f32; 3], other: [f32; 3]) -> f32 {
    let [l, a, b] = [one[0] - other[0], one[1] - other[1], one[2] - other[2]];
    l * l + a * a + b * b
}

/// The nearest of at most 256 points, given component by component, and the square of its distance.
#[inline]
pub(crate) fn nearest([ls, as_, bs]: &[Vec<f32>; 3], [l, a, b]: [f32; 3]) -> (u8, f32) {
    let mut squares = [f32::INFINITY; 256];
    for (square, ((&one, &two), &three)) in squares.iter_mut().zip(ls.iter().zip(as_).zip(bs)) {
        let (l, a, b) = (one - l, two - a, three - b);
        *square = l * l + a * a + b * b;
    }
    let mut nearest = 0;
    for (place, &square) in squares.iter().enumerate() {
        if square < squares[nearest] {
            nearest = place;
        }
    }
    (nearest as u8, squares[nearest])
}

/// The inks of recent colours, in a direct-mapped cache.
///
/// A frame has some hundreds of colours and some ten thousand pixels. Each colour has one place,
/// and a place holds the last requested of the colours that share it.
#[derive(Debug)]
pub(crate) struct Inks {
    places: Box<[Ink; 1 << PLACE_BITS]>,
}

/// The number of bits of a hash that select a place.
const PLACE_BITS: u32 = 11;

impl Inks {
    /// The ink of a colour.
    #[expect(clippy::inline_always, reason = "calls would take longer than what they do")]
    #[inline(always)]
    pub(crate) fn of(&mut self, shade: PackedColor) -> Ink {
        let known = &mut self.places[shade.hash(PLACE_BITS)];
        if known.shade != shade {
            *known = Ink::new(shade);
        }
        *known
    }

    /// The inks of two colours.
    #[inline]
    pub(crate) fn of_both(&mut self, shades: [PackedColor; 2]) -> [Ink; 2] {
        shades.map(|shade| self.of(shade))
    }

    /// The colour halfway between two colours, or the colour nearest to that in their common
    /// palette. If they have no common palette, `one`.
    pub(crate) fn between(&mut self, one: Ink, other: Ink) -> Ink {
        let middle = |one: [u8; 3], other: [u8; 3]| -> [u8; 3] {
            std::array::from_fn(|channel| one[channel].midpoint(other[channel]))
        };
        let of_indices = |one: u8, other: u8| {
            let [one, other] = [one, other].map(|index| palette::of_256(index).channels());
            let [red, green, blue] = middle(one, other);
            Rgb::new(red, green, blue)
        };
        self.of(match (one.shade.kind(), other.shade.kind()) {
            (PackedColorKind::Rgb(one), PackedColorKind::Rgb(other)) => {
                PackedColor::rgb(middle(one, other))
            }
            (
                PackedColorKind::Indexed(one @ FIRST_FIXED..),
                PackedColorKind::Indexed(other @ FIRST_FIXED..),
            ) => PackedColor::indexed(palette::nearest_of_256(of_indices(one, other))),
            (
                PackedColorKind::Indexed(one @ ..FIRST_FIXED),
                PackedColorKind::Indexed(other @ ..FIRST_FIXED),
            ) => PackedColor::indexed(palette::nearest_of_16(of_indices(one, other))),
            _ => one.shade,
        })
    }
}

impl Default for Inks {
    fn default() -> Self {
        // No requested colour is equal to this one.
        let nothing = Ink { lab: [0.0; 3], shade: PackedColor::NONE };
        let places = vec![nothing; 1 << PLACE_BITS].try_into();
        Self { places: places.expect("a place for each hash") }
    }
}

/// A colour that may be sent in place of another.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ColorCode {
    pub(crate) ink: Ink,
    /// The number of bytes of its parameters.
    pub(crate) bytes: f32,
    /// The price of its error, in bytes.
    pub(crate) error: f32,
}

impl ColorCode {
    /// The sum of the bytes and the price.
    #[inline]
    pub(crate) fn cost(self) -> f32 {
        self.bytes + self.error
    }
}

/// The price of errors.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Price {
    /// The maximum error, in ΔE.
    pub(crate) farthest: f32,
    /// The price in bytes of a ΔE of one in half a cell. It was chosen so that the mean errors at
    /// high and low fidelity match the documentation.
    pub(crate) bytes: f32,
}

impl Price {
    /// The price at `fidelity`, which must not be exact. It is higher for lower tolerances, and
    /// lower for shorter notations.
    pub(crate) fn at(fidelity: Fidelity, notation: Notation) -> Self {
        let farthest = f32::from(fidelity.tolerance());
        let worth = match notation {
            Notation::Named => 2.0,
            Notation::Indexed => 6.0,
            Notation::Entry => (9.2 - farthest / 14.0).max(5.0),
            Notation::Rgb => 10.5,
        };
        Self { farthest, bytes: worth / farthest }
    }

    /// The price in this number of parts of a cell, as [`MosaicShape`] counts them.
    #[inline]
    pub(crate) fn of_parts(self, parts: u8) -> Self {
        const HALF: f32 = MosaicShape::PARTS as f32 / 2.0;
        Self { bytes: self.bytes * f32::from(parts) / HALF, ..self }
    }

    /// The price of an error of `distance`, in bytes. Infinite if the error exceeds the maximum.
    #[inline]
    pub(crate) fn of_distance(self, distance: f32) -> f32 {
        if distance > self.farthest { f32::INFINITY } else { distance * self.bytes }
    }

    /// Returns true if one colour may be shown in place of another.
    #[inline]
    pub(crate) fn allows(self, shown: Ink, wanted: Ink) -> bool {
        squared_distance(shown.lab, wanted.lab) <= self.farthest * self.farthest
    }

    /// The price of showing one colour in place of another, in bytes. Infinite if the error exceeds
    /// the maximum.
    #[inline]
    pub(crate) fn of(self, shown: Ink, wanted: Ink) -> f32 {
        self.of_distance(shown.distance(wanted))
    }
}
