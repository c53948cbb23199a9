//! How many colours a terminal can show, and which of them is nearest to a given one.
//!
//! Both the widgets, which pick colours, and the terminal, which finds out how many there are, need
//! this; so it knows neither of them.

use crate::world::Rgb;

/// How many colours a terminal can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ColorDepth {
    /// 24 bits: every colour as it is.
    #[default]
    True,
    /// The 256 of xterm: 16 named ones, a 6×6×6 cube, and 24 greys.
    Indexed256,
    /// The 16 named ones.
    Indexed16,
    /// None: a cell is lit or it is not.
    Mono,
}

/// The first colour of the cube; those before it are the named ones, which users redefine.
const CUBE: u8 = 16;
/// The first of the greys.
const GREYS: u8 = 232;
const GREY_COUNT: u8 = 24;
/// The channel values of the cube.
const CUBE_LEVELS: [u8; 6] = [0, 95, 135, 175, 215, 255];
/// The named colours as xterm has them.
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

/// The index of the one of the 240 fixed colours of xterm that is nearest to `color`.
///
/// The first 16 of the 256 are left out, because users give them colours of their own.
pub fn nearest_of_256(color: Rgb) -> u8 {
    let [red, green, blue] = color.channels().map(nearest_cube_level);
    let cube = CUBE + 36 * red + 6 * green + blue;
    let mean = color.channels().iter().map(|&channel| u16::from(channel)).sum::<u16>() / 3;
    let grey = GREYS + ((mean.saturating_sub(3)) / 10).min(u16::from(GREY_COUNT) - 1) as u8;
    if difference(color, of_256(grey)) < difference(color, of_256(cube)) { grey } else { cube }
}

/// The index of the one of the 16 named colours that is nearest to `color`.
pub fn nearest_of_16(color: Rgb) -> u8 {
    let nearest = (0u8..).zip(NAMED).min_by_key(|&(_, named)| difference(color, named));
    nearest.map_or(0, |(index, _)| index)
}

/// What colour `index` of the 256 is, by xterm's defaults.
pub fn of_256(index: u8) -> Rgb {
    if let Some(&named) = NAMED.get(usize::from(index)) {
        named
    } else if index >= GREYS {
        let level = 8 + 10 * (index - GREYS);
        Rgb::new(level, level, level)
    } else {
        let index = usize::from(index - CUBE);
        Rgb::new(CUBE_LEVELS[index / 36], CUBE_LEVELS[index / 6 % 6], CUBE_LEVELS[index % 6])
    }
}

fn nearest_cube_level(channel: u8) -> u8 {
    // Half way between two levels: between 0 and 95, between 95 and 135, and every 40 from there.
    match channel {
        0..48 => 0,
        48..115 => 1,
        _ => (channel - 35) / 40,
    }
}

/// How different two colours look: squared distance with the weights that "redmean" gives the
/// channels, times 256.
///
/// Plain squared distance was refused: it takes the browns of brick and wood for greys.
fn difference(one: Rgb, other: Rgb) -> u32 {
    let red_mean = u32::midpoint(one.red().into(), other.red().into());
    let squared = |a: u8, b: u8| u32::from(a.abs_diff(b)).pow(2);
    (512 + red_mean) * squared(one.red(), other.red())
        + 1024 * squared(one.green(), other.green())
        + (767 - red_mean) * squared(one.blue(), other.blue())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn every_fixed_colour_is_nearest_to_itself() {
        for index in 16..=255 {
            assert_eq!(of_256(nearest_of_256(of_256(index))), of_256(index), "{index}");
        }
        for index in 0..16 {
            assert_eq!(nearest_of_16(of_256(index)), index);
        }
    }

    proptest! {
        /// 48 is half the widest gap of the cube; a grey may trade one channel for the others.
        #[test]
        fn nothing_is_far_from_its_nearest(color: [u8; 3]) {
            let color = Rgb::new(color[0], color[1], color[2]);
            let shown = of_256(nearest_of_256(color));
            for (channel, shown) in color.channels().into_iter().zip(shown.channels()) {
                prop_assert!(channel.abs_diff(shown) <= 62, "{color} as {shown}");
            }
        }
    }
}
