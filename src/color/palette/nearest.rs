//! The colour of a palette that is nearest to a given colour.
//!
//! The measure is distance in Oklab. Squared distance of the channels, weighted or not, was
//! refused: in a palette with few dark colours it maps dark bricks to grey and wood to pink.

use std::ops::RangeInclusive;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU16, Ordering};

use super::of_256;
use crate::color::Rgb;
use crate::color::oklab::Oklab;

/// Colours with the same upper 5 bits of each channel share an entry.
const BITS: u32 = 5;
const DROPPED_BITS: u32 = u8::BITS - BITS;
/// The bit that marks an entry as computed.
const FOUND: u16 = 1 << 15;

/// The colours of a palette, each with its index among the 256.
pub(crate) type Palette = Vec<(u8, Oklab)>;

/// A table from the upper bits of the channels to the index of the nearest colour. An entry is
/// computed on its first use: computing all of them would take some milliseconds, which matters to
/// a program that draws one picture.
///
/// It is zeros at first, and the palette is no part of it, so that the program's file has no bytes for it.
pub(crate) struct NearestColors {
    entries: [AtomicU16; 1 << (3 * BITS)],
}

impl NearestColors {
    /// A table without an entry.
    #[expect(clippy::large_stack_arrays, reason = "it is evaluated at compile time")]
    pub(crate) const fn new() -> Self {
        Self { entries: [const { AtomicU16::new(0) }; 1 << (3 * BITS)] }
    }

    /// The index of the colour that is nearest to `color` in `palette`, the same in every call.
    #[inline]
    pub(crate) fn of(&self, color: Rgb, palette: &LazyLock<Palette>) -> u8 {
        let index = color
            .channels()
            .into_iter()
            .fold(0, |index, channel| index << BITS | usize::from(channel >> DROPPED_BITS));
        let entry = self.entries[index].load(Ordering::Relaxed);
        (if entry & FOUND == 0 { self.find(index, color, palette) } else { entry }) as u8
    }

    #[cold]
    fn find(&self, entry_index: usize, color: Rgb, palette: &[(u8, Oklab)]) -> u16 {
        let middle =
            |channel: u8| channel >> DROPPED_BITS << DROPPED_BITS | 1 << (DROPPED_BITS - 1);
        let [red, green, blue] = color.channels().map(middle);
        let color = Oklab::from(Rgb::new(red, green, blue));
        let by_distance = |(_, one): &&(u8, Oklab), (_, other): &&(u8, Oklab)| {
            color.distance_squared(one).total_cmp(&color.distance_squared(other))
        };
        let nearest = palette.iter().min_by(by_distance).map_or(0, |&(index, _)| index);
        let entry = FOUND | u16::from(nearest);
        self.entries[entry_index].store(entry, Ordering::Relaxed);
        entry
    }
}

/// The colours with these indices among the 256, in Oklab.
pub(crate) fn palette(indices: RangeInclusive<u8>) -> Palette {
    indices.map(|index| (index, Oklab::from(of_256(index)))).collect()
}
