//! Colours that may be shown for each other, what they cost, and what it costs to be off.

use super::lab::Lab;
use super::style::{Kind, Shade};
use crate::terminal::Fidelity;

/// A colour of red, green and blue, and what it costs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ink {
    channels: [u8; 3],
    /// As parameters of a sequence.
    pub(super) bytes: u8,
    lab: Lab,
}

impl Ink {
    /// That colour, if it is one of red, green and blue.
    #[inline]
    pub(super) fn of(shade: Shade) -> Option<Self> {
        match shade.kind() {
            Kind::Rgb(channels) => Some(Self::new(channels)),
            _ => None,
        }
    }

    #[inline]
    fn new(channels: [u8; 3]) -> Self {
        let bytes = Shade::rgb(channels).bytes() as u8;
        Self { channels, bytes, lab: Lab::of(channels) }
    }

    pub(super) fn shade(self) -> Shade {
        Shade::rgb(self.channels)
    }

    /// CIE76's ΔE.
    pub(super) fn distance(self, other: Self) -> f32 {
        self.lab.distance(other.lab)
    }

    /// The colour that is halfway.
    pub(super) fn between(self, other: Self) -> Self {
        let channel = |index: usize| self.channels[index].midpoint(other.channels[index]);
        Self::new([channel(0), channel(1), channel(2)])
    }
}

impl PartialEq for Ink {
    fn eq(&self, other: &Self) -> bool {
        self.channels == other.channels
    }
}

/// The colours of a block's halves, the upper one first.
pub(super) type Halves = [Ink; 2];

/// What an error is worth.
#[derive(Clone, Copy, Debug)]
pub(super) struct Price {
    /// No colour is farther off, in ΔE.
    farthest: f32,
    /// So many bytes are worth a ΔE of one of half a cell.
    bytes: f32,
}

impl Price {
    /// At that fidelity; `None` if it is exact. The less is allowed, the more an error is worth.
    pub(super) fn at(fidelity: Fidelity) -> Option<Self> {
        let farthest = f32::from(fidelity.tolerance());
        (fidelity > Fidelity::EXACT).then(|| Self { farthest, bytes: WORTH / farthest })
    }

    /// What it is worth, in bytes, that one colour is shown for the other; infinite if too much.
    #[inline]
    pub(super) fn of(self, shown: Ink, wanted: Ink) -> f32 {
        let distance = shown.lab.distance(wanted.lab);
        if distance > self.farthest { f32::INFINITY } else { distance * self.bytes }
    }

    /// The same of both halves.
    #[inline]
    pub(super) fn of_halves(self, shown: Halves, wanted: Halves) -> f32 {
        self.of(shown[0], wanted[0]) + self.of(shown[1], wanted[1])
    }
}

/// So many bytes are worth an error as large as any that is allowed, of half a cell.
const WORTH: f32 = 10.5;
