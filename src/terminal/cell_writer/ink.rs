//! Colours that may be shown for each other, what they cost, and what it costs to be off.

use super::style::{Kind, Shade};
use crate::color::lab::PackedLab;
use crate::terminal::Fidelity;

/// A colour, and where it lies in CIE L\*a\*b\*.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ink {
    pub(super) lab: [f32; 3],
    pub(super) shade: Shade,
}

impl Ink {
    /// That colour, if it is one of red, green and blue.
    #[inline]
    fn new(shade: Shade) -> Option<Self> {
        let Kind::Rgb(channels) = shade.kind() else { return None };
        let lab = PackedLab::of(channels).components();
        Some(Self { lab, shade })
    }

    /// How many bytes it takes as parameters.
    #[inline]
    pub(super) fn bytes(self) -> f32 {
        self.shade.bytes() as f32
    }

    /// CIE76's ΔE.
    #[inline]
    pub(super) fn distance(self, other: Self) -> f32 {
        distance(self.lab, other.lab)
    }
}

/// CIE76's ΔE.
#[inline]
pub(super) fn distance(one: [f32; 3], other: [f32; 3]) -> f32 {
    let [l, a, b] = [one[0] - other[0], one[1] - other[1], one[2] - other[2]];
    (l * l + a * a + b * b).sqrt()
}

/// The colours of a block's halves, the upper one first.
pub(super) type Halves = [Ink; 2];

/// The inks of the colours that were asked for of late.
///
/// A frame has some hundreds of colours and some ten thousand pixels. Each colour has one place, which
/// the last one takes that was asked for.
#[derive(Debug)]
pub(super) struct Inks {
    places: Vec<Ink>,
}

/// So many bits of a hash tell a colour's place.
const PLACE_BITS: u32 = 10;

impl Inks {
    /// That of a colour, if it is one of red, green and blue.
    #[inline]
    pub(super) fn of(&mut self, shade: Shade) -> Option<Ink> {
        let place =
            (shade.in_bits().wrapping_mul(0x9E37_79B1) >> (u32::BITS - PLACE_BITS)) as usize;
        let known = self.places.get_mut(place)?;
        if known.shade != shade {
            *known = Ink::new(shade)?;
        }
        Some(*known)
    }

    /// Those of two halves.
    #[inline]
    pub(super) fn of_halves(&mut self, [upper, lower]: [Shade; 2]) -> Option<Halves> {
        Some([self.of(upper)?, self.of(lower)?])
    }

    /// The colour that is halfway between two.
    pub(super) fn between(&mut self, one: Ink, other: Ink) -> Ink {
        match (one.shade.kind(), other.shade.kind()) {
            (Kind::Rgb([r, g, b]), Kind::Rgb([red, green, blue])) => {
                let middle = [r.midpoint(red), g.midpoint(green), b.midpoint(blue)];
                self.of(Shade::rgb(middle)).unwrap_or(one)
            }
            _ => one,
        }
    }
}

impl Default for Inks {
    fn default() -> Self {
        // No place knows a colour that has not been asked for.
        let nothing = Ink { lab: [0.0; 3], shade: Shade::NONE };
        Self { places: vec![nothing; 1 << PLACE_BITS] }
    }
}

/// What an error is worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Price {
    /// No colour is farther off, in ΔE.
    pub(super) farthest: f32,
    /// So many bytes are worth a ΔE of one of half a cell. Chosen so that the mean error at high and low
    /// fidelity is what it is said to be.
    pub(super) bytes: f32,
}

impl Price {
    /// At that fidelity, with a palette or without; `None` if it is exact. The less is allowed, the more an
    /// error is worth; and the less colours cost, the less.
    pub(super) fn at(fidelity: Fidelity, has_palette: bool) -> Option<Self> {
        let farthest = f32::from(fidelity.tolerance());
        let worth = if has_palette { (9.2 - farthest / 14.0).max(5.0) } else { 10.5 };
        (fidelity > Fidelity::EXACT).then(|| Self { farthest, bytes: worth / farthest })
    }

    /// What it is worth, in bytes, to be off by `distance`; infinite if too much.
    #[inline]
    pub(super) fn of_distance(self, distance: f32) -> f32 {
        if distance > self.farthest { f32::INFINITY } else { distance * self.bytes }
    }

    /// What it is worth, in bytes, that one colour is shown for the other; infinite if too much.
    #[inline]
    pub(super) fn of(self, shown: Ink, wanted: Ink) -> f32 {
        self.of_distance(shown.distance(wanted))
    }
}
