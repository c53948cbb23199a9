//! Colour depths of terminals, and the palette colour that is nearest to a given colour.
//!
//! The widgets choose colours, and the terminal detects the colour depth. Both need this module, and it
//! depends on neither.
//!
//! Nearness is distance in Oklab. Rejected: the squared distance of the channels, weighted or not. In a
//! palette with few dark colours it maps dark bricks to grey and wood to pink.

#[cfg(feature = "tui")]
pub(crate) mod mixture;

use std::ops::RangeInclusive;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU16, Ordering};

use serde::{Deserialize, Serialize};

use super::Rgb;
use super::oklab::Oklab;

/// The number of colours that a terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum ColorDepth {
    /// 24 bits: every colour is exact.
    #[default]
    True,
    /// The 256 colours of xterm: 16 named ones, a 6×6×6 cube, and 24 greys.
    Indexed256,
    /// The 16 named colours.
    Indexed16,
    /// No colours: a pixel is lit or unlit.
    Mono,
}

/// The way in which a terminal draws the shades ░, ▒ and ▓.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ShadeInk {
    /// As dots of the text colour. The eye mixes their light with the light of the background.
    Dots,
    /// As one colour between the text colour and the background colour, which the terminal mixes in sRGB.
    Flat,
    /// Not known: as dots or as one colour.
    #[default]
    Unknown,
}

/// The index of the cube's first colour. The colours before it are the named ones, which users can
/// redefine.
const CUBE: u8 = 16;
/// The index of the first grey.
const GREYS: u8 = 232;
/// The channel values of the cube.
const CUBE_LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
/// The named colours, by xterm's defaults.
const NAMED: [Rgb; 16] = [
    Rgb::new(0, 0, 0),
    Rgb::new(205, 0, 0),
    Rgb::new(0, 205, 0),
    Rgb::new(205, 205, 0),
    Rgb::new(0, 0, 238),
    Rgb::new(205, 0, 205),
    Rgb::new(0, 205, 205),
    Rgb::new(229, 229, 229),
    Rgb::new(127, 127, 127),
    Rgb::new(255, 0, 0),
    Rgb::new(0, 255, 0),
    Rgb::new(255, 255, 0),
    Rgb::new(92, 92, 255),
    Rgb::new(255, 0, 255),
    Rgb::new(0, 255, 255),
    Rgb::new(255, 255, 255),
];

/// The index of the colour nearest to `color` in Oklab, among the 240 fixed colours of xterm.
///
/// The first 16 of the 256 are left out, because users can redefine them.
pub fn nearest_of_256(color: Rgb) -> u8 {
    static NEAREST: NearestColors = NearestColors::new();
    static PALETTE: LazyLock<Palette> = LazyLock::new(|| palette(CUBE..=u8::MAX));
    NEAREST.of(color, &PALETTE)
}

/// The index of the colour nearest to `color` in Oklab, among the 16 named colours.
pub fn nearest_of_16(color: Rgb) -> u8 {
    static NEAREST: NearestColors = NearestColors::new();
    static PALETTE: LazyLock<Palette> = LazyLock::new(|| palette(0..=CUBE - 1));
    NEAREST.of(color, &PALETTE)
}

/// The colour with this index among the 256, by xterm's defaults.
pub fn of_256(index: u8) -> Rgb {
    if let Some(&named) = NAMED.get(usize::from(index)) {
        named
    } else if index >= GREYS {
        let level = 8 + 10 * (index - GREYS);
        Rgb::new(level, level, level)
    } else {
        // Red, green and blue are the digits of a number to the base 6.
        let index = usize::from(index - CUBE);
        Rgb::new(CUBE_LEVELS[index / 36], CUBE_LEVELS[index / 6 % 6], CUBE_LEVELS[index % 6])
    }
}

/// Colours with the same upper 5 bits of each channel share an entry.
const BITS: u32 = 5;
const DROPPED_BITS: u32 = u8::BITS - BITS;
/// The bit that marks an entry as computed.
const FOUND: u16 = 1 << 15;

/// The colours of a palette, each with its index among the 256.
pub(crate) type Palette = Vec<(u8, Oklab)>;

/// A table from the upper bits of the channels to the index of the nearest colour. An entry is computed on
/// its first use: computing all of them would take some milliseconds, which matters to a program that
/// draws one picture.
///
/// The table starts as zeros and does not contain the palette. It therefore takes no bytes in the
/// executable.
struct NearestColors {
    entries: [AtomicU16; 1 << (3 * BITS)],
}

impl NearestColors {
    /// An empty table.
    #[expect(clippy::large_stack_arrays, reason = "it is evaluated at compile time")]
    pub(crate) const fn new() -> Self {
        Self { entries: [const { AtomicU16::new(0) }; 1 << (3 * BITS)] }
    }

    /// The index of the colour in `palette` that is nearest to `color`. Each call must pass the same
    /// palette.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_palette_colour_maps_to_itself_or_nearly_so() {
        for index in 16..=255 {
            let shown = of_256(nearest_of_256(of_256(index)));
            for (channel, shown) in of_256(index).channels().into_iter().zip(shown.channels()) {
                assert!(channel.abs_diff(shown) <= 10, "{index}");
            }
        }
        for index in 0..16 {
            assert_eq!(nearest_of_16(of_256(index)), index);
        }
    }

    #[test]
    fn browns_and_dark_reds_keep_their_hue() {
        let hue_is_kept = |color: Rgb| {
            let [red, green, blue] = of_256(nearest_of_256(color)).channels();
            red > green && green >= blue
        };
        assert!(hue_is_kept(Rgb::new(133, 90, 50)));
        assert!(hue_is_kept(Rgb::new(80, 32, 24)));
    }
}
