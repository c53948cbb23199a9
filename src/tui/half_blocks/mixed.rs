//! Half blocks in a small palette: other colours are mixed from two colours side by side.
//!
//! Each pixel has one of the two colours of its [`Mixture`], chosen by Bayer's 2×2 matrix, which is
//! fixed to the screen. A pixel's colour depends on nothing else, so that the details of textures
//! remain visible, and a changed pixel changes no other.
//!
//! A mixture of halves is a chessboard: the cells in a row have the same two colours, and glyphs that
//! differ, which take three bytes each. One mixture for the four pixels of two cells, with the error
//! carried to the next two, was refused: joints and stones vanish.

use std::array;
use std::sync::LazyLock;

use ratatui::layout::Rect;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette::mixture::{self, Mixture, Mixtures, ToneCurve};
use crate::color::srgb::linear;
use crate::render::Frame;

/// Draws the pixels of `frame` as [`super::draw_frame`] does.
pub(super) fn draw(
    area: Rect,
    canvas: &mut impl Canvas,
    mixtures: &Mixtures,
    above: u32,
    frame: &Frame,
) {
    let tables = &*TABLES;
    let row = |y: u32| if y < frame.height() { frame.row_slice(y) } else { &[] };
    for (y, upper) in (area.top()..area.bottom()).zip((above..).step_by(2)) {
        let halves = row(upper).iter().zip(row(upper + 1)).zip(ORDER.iter().cycle());
        let halves = halves.map(|((&upper, &lower), &[upper_threshold, lower_threshold])| {
            [
                Color::Indexed(tables.index(mixtures, upper, upper_threshold)),
                Color::Indexed(tables.index(mixtures, lower, lower_threshold)),
            ]
        });
        canvas.draw_halves(area.x, y, halves.take(usize::from(area.width)));
    }
}

/// The order in which pixels get the brighter colour: Bayer's 2×2 matrix, by the column and by the
/// half of the cell.
const ORDER: [[u8; 2]; 2] = [[0, 3], [2, 1]];

/// Red, green and blue light, each from 0 to [`Tables::WHITE`].
type Light = [i32; 3];

/// Tables that convert between colours and light.
struct Tables {
    of_channel: [i32; 256],
    /// The [`mixture::level`] of each amount of light.
    levels: [u8; Self::STEPS + 1],
}

static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);

impl Tables {
    const WHITE: i32 = 1 << 15;
    /// The number of steps of light in `levels`.
    const STEPS: usize = 1 << 12;

    fn new() -> Self {
        let of_channel = array::from_fn(|value| {
            let [share, ..] = linear(Rgb::new(value as u8, 0, 0));
            libm::round(share * f64::from(Self::WHITE)) as i32
        });
        let levels = array::from_fn(|step| mixture::level(step as f64 / Self::STEPS as f64));
        Self { of_channel, levels }
    }

    /// The index of the colour that a pixel has, if it gets the brighter colour of a mixture from a
    /// share above `threshold`.
    #[inline]
    fn index(&self, mixtures: &Mixtures, pixel: Rgb, threshold: u8) -> u8 {
        let Mixture { colors, share } = mixtures.of(self.levels(self.light(mixtures, pixel)));
        colors[usize::from(share > threshold)]
    }

    /// The light of a pixel, in the tones of the palette.
    fn light(&self, mixtures: &Mixtures, pixel: Rgb) -> Light {
        let factor = mixtures.tones.factor(pixel);
        pixel.channels().map(|channel| {
            let light = self.of_channel[usize::from(channel)];
            (light * factor / ToneCurve::ONE).min(Self::WHITE)
        })
    }

    fn levels(&self, light: Light) -> [u8; 3] {
        let step = Self::WHITE / Self::STEPS as i32;
        light.map(|part| self.levels[((part + step / 2) / step) as usize])
    }
}
