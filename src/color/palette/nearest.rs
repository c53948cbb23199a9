//! The nearest colour of a palette to any colour, from a table.
//!
//! Distance is measured in Oklab. Squared distance of the channels, weighted or not, was refused: in a
//! palette with few dark colours it takes dark bricks for grey and wood for pink.

use std::ops::RangeInclusive;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU16, Ordering};

use super::of_256;
use crate::color::Rgb;
use crate::color::oklab::Oklab;

/// The upper bits of each channel that the table distinguishes.
const BITS: u32 = 5;
const DROPPED_BITS: u32 = u8::BITS - BITS;
/// The bit that marks a computed entry.
const FOUND: u16 = 1 << 15;

/// The index of the nearest colour for every colour, by the upper bits of its channels. An entry is computed when it is
/// first looked up: all of them take some milliseconds, which is long for a program that draws one picture.
pub(super) struct NearestColors {
    palette: LazyLock<Vec<(u8, Oklab)>>,
    entries: [AtomicU16; 1 << (3 * BITS)],
}

impl NearestColors {
    /// The table for a palette that [`palette`] makes.
    #[expect(clippy::large_stack_arrays, reason = "it is made when the program is compiled")]
    pub(super) const fn among(palette: fn() -> Vec<(u8, Oklab)>) -> Self {
        Self {
            palette: LazyLock::new(palette),
            entries: [const { AtomicU16::new(0) }; 1 << (3 * BITS)],
        }
    }

    /// The index of the colour nearest to `color`.
    #[inline]
    pub(super) fn of(&self, color: Rgb) -> u8 {
        let place = color
            .channels()
            .into_iter()
            .fold(0, |place, channel| place << BITS | usize::from(channel >> DROPPED_BITS));
        let known = self.entries[place].load(Ordering::Relaxed);
        (if known & FOUND == 0 { self.find(place, color) } else { known }) as u8
    }

    #[cold]
    fn find(&self, place: usize, color: Rgb) -> u16 {
        let middle =
            |channel: u8| channel >> DROPPED_BITS << DROPPED_BITS | 1 << (DROPPED_BITS - 1);
        let [red, green, blue] = color.channels().map(middle);
        let color = Oklab::from(Rgb::new(red, green, blue));
        let by_distance = |(_, one): &&(u8, Oklab), (_, other): &&(u8, Oklab)| {
            color.distance_squared(one).total_cmp(&color.distance_squared(other))
        };
        let nearest = self.palette.iter().min_by(by_distance).map_or(0, |&(index, _)| index);
        let entry = FOUND | u16::from(nearest);
        self.entries[place].store(entry, Ordering::Relaxed);
        entry
    }
}

/// The colours with these indices among the 256, in Oklab.
pub(super) fn palette(indices: RangeInclusive<u8>) -> Vec<(u8, Oklab)> {
    indices.map(|index| (index, Oklab::from(of_256(index)))).collect()
}
