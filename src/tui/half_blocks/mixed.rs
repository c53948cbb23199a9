//! Half blocks in a small palette: other hues are mixed from two colours side by side.
//!
//! Two neighbouring cells are a block of four pixels that shares two colours: the [`Mixture`] of
//! the block's mean. Each pixel shows one of them. The choice depends on Bayer's 2×2 matrix, which
//! is fixed to the screen, and on the pixel's own colour, so that details of a wall remain visible.
//! The error of the upper of two blocks is added to the lower one, as in error diffusion (R. W.
//! Floyd and L. Steinberg, "An Adaptive Algorithm for Spatial Greyscale", 1976), but goes no
//! further: a changed pixel changes at most the eight pixels of its two blocks. Dark blocks carry no
//! error. A block with an edge shows the nearest colours of both sides.
//!
//! A block takes hardly more bytes than one cell, because its two cells differ in their glyphs
//! only. Independent dithering of each pixel (by Bayer's matrix, or a mask of blue noise) was
//! refused: it looks no better from some distance, and takes twice the bytes. Full error diffusion
//! was refused, too: one changed pixel changes all pixels after it. `cellcaster wire --palette 256`
//! prints the figures.

use std::array;
use std::sync::LazyLock;

use ratatui::layout::Rect;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette;
use crate::color::palette::mixture::{self, Mixture, Mixtures, ToneCurve};
use crate::color::srgb::linear;
use crate::render::Frame;

/// The number of cells of a row that are drawn at a time, and kept in a buffer; even.
const CHUNK: usize = 64;

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
    let first_cells = above / 2;
    let end_cells = first_cells + u32::from(area.height);
    for upper in (first_cells / 2 * 2..end_cells).step_by(2) {
        let rows: [[&[Rgb]; 2]; 2] =
            [upper, upper + 1].map(|cells| [row(2 * cells), row(2 * cells + 1)]);
        for left in (0..usize::from(area.width)).step_by(CHUNK) {
            let width = CHUNK.min(usize::from(area.width) - left);
            let mut shown = [[[0; 2]; CHUNK]; 2];
            for x in (0..width).step_by(2) {
                let mut error = [0; 3];
                for (rows, shown) in rows.iter().zip(&mut shown) {
                    let Some(block) = block(rows, left + x) else { continue };
                    let colors = tables.draw(mixtures, block, &mut error);
                    shown[x] = [colors[0], colors[2]];
                    shown[x + 1] = [colors[1], colors[3]];
                }
            }
            for (cells, shown) in (upper..).zip(&shown) {
                if (first_cells..end_cells).contains(&cells) {
                    let y = area.y + (cells - first_cells) as u16;
                    let halves = shown[..width].iter().map(|halves| halves.map(Color::Indexed));
                    canvas.draw_halves(area.x + left as u16, y, halves);
                }
            }
        }
    }
}

/// The pixels of a block, row by row. If `x` is the last pixel of the row, it is in the block
/// twice.
fn block(rows: &[&[Rgb]; 2], x: usize) -> Option<[Rgb; 4]> {
    let pair = |row: &[Rgb]| {
        let left = *row.get(x)?;
        Some([left, row.get(x + 1).copied().unwrap_or(left)])
    };
    let [[a, b], [c, d]] = [pair(rows[0])?, pair(rows[1])?];
    Some([a, b, c, d])
}

/// Red, green and blue light, each from 0 to [`Tables::WHITE`].
type Light = [i32; 3];

/// Tables that convert between colours and light.
struct Tables {
    of_channel: [i32; 256],
    of_index: [Light; 256],
    /// The [`mixture::level`] of each amount of light.
    levels: [u8; Self::STEPS + 1],
}

static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);

impl Tables {
    const WHITE: i32 = 1 << 15;
    /// The number of steps of light in `levels`.
    const STEPS: usize = 1 << 12;
    /// Two pixels of a block are on different sides of an edge if their brightness, of 255, differs
    /// by more.
    const EDGE: u8 = 46;
    /// The order in which pixels of a block get the brighter colour: Bayer's 2×2 matrix.
    const ORDER: [i32; 4] = [0, 2, 3, 1];
    /// The part of a pixel's difference from the block's mean that counts, in eighths.
    const OWN: i64 = 3;
    /// The same for dark blocks: their mixtures are even, so that only this shows the details.
    const OWN_IF_DARK: i64 = 8;

    fn new() -> Self {
        let scaled = |share: f64| libm::round(share * f64::from(Self::WHITE)) as i32;
        let of = |color| linear(color).map(scaled);
        let of_channel = array::from_fn(|value| of(Rgb::new(value as u8, 0, 0))[0]);
        let of_index = array::from_fn(|index| of(palette::of_256(index as u8)));
        let levels = array::from_fn(|step| mixture::level(step as f64 / Self::STEPS as f64));
        Self { of_channel, of_index, levels }
    }

    /// Chooses the colours of a block's pixels. `error` is added to the block, and is set to three
    /// quarters of the error that remains: all of it would cost more bytes than it is worth. A dark
    /// block leaves no error: it would show as lone dots in the block below.
    fn draw(&self, mixtures: &Mixtures, block: [Rgb; 4], error: &mut Light) -> [u8; 4] {
        let lumas = block.map(Rgb::luma);
        let [darkest, brightest] =
            lumas.iter().fold([u8::MAX, 0], |[low, high], &luma| [low.min(luma), high.max(luma)]);
        let lights = block.map(|pixel| self.light(mixtures, pixel));
        let (colors, is_dark) = if brightest - darkest > Self::EDGE {
            self.draw_edge(mixtures, lumas.map(|luma| luma > darkest.midpoint(brightest)), &lights)
        } else {
            self.mix(mixtures, &lights, *error)
        };
        *error = array::from_fn(|i| {
            let shown = |pixel: usize| self.of_index[usize::from(colors[pixel])][i];
            let remains = || (0..4).map(|pixel| lights[pixel][i] - shown(pixel)).sum::<i32>();
            if is_dark { 0 } else { remains() * 3 / 16 }
        });
        colors
    }

    /// The light of a pixel, in the tones of the palette.
    fn light(&self, mixtures: &Mixtures, pixel: Rgb) -> Light {
        let factor = mixtures.tones.factor(pixel);
        pixel.channels().map(|channel| {
            let light = self.of_channel[usize::from(channel)];
            (light * factor / ToneCurve::ONE).min(Self::WHITE)
        })
    }

    /// The nearest colour of each side of an edge, to the mean of its pixels, and whether one side is
    /// dark.
    fn draw_edge(
        &self,
        mixtures: &Mixtures,
        is_bright: [bool; 4],
        lights: &[Light; 4],
    ) -> ([u8; 4], bool) {
        let [dark, bright] = [false, true].map(|side| {
            let on_side =
                || lights.iter().zip(is_bright).filter(|&(_, is_bright)| is_bright == side);
            let count = on_side().count().max(1) as i32;
            let mean =
                array::from_fn(|i| on_side().map(|(light, _)| light[i]).sum::<i32>() / count);
            mixtures.of(self.levels(mean))
        });
        let colors = is_bright.map(|is_bright| if is_bright { bright.single } else { dark.single });
        (colors, dark.is_dark)
    }

    /// Mixes the mean of the block and `error`, and whether the mixture is dark.
    fn mix(&self, mixtures: &Mixtures, lights: &[Light; 4], error: Light) -> ([u8; 4], bool) {
        let mean: Light = array::from_fn(|i| lights.iter().map(|light| light[i]).sum::<i32>() / 4);
        let wanted = with_error(mean, error);
        let Mixture { colors, share, is_dark, .. } = mixtures.of(self.levels(wanted));
        if share == 0 {
            return ([colors[0]; 4], is_dark);
        }
        let [darker, brighter] = colors.map(|index| self.of_index[usize::from(index)]);
        let difference: [i64; 3] = array::from_fn(|i| i64::from(brighter[i] - darker[i]));
        let length: i64 = difference.iter().map(|part| part * part).sum();
        let own = if is_dark { Self::OWN_IF_DARK } else { Self::OWN };
        let colors = array::from_fn(|pixel| {
            let along: i64 =
                (0..3).map(|i| i64::from(lights[pixel][i] - mean[i]) * difference[i]).sum();
            // In eighths: the share of the brighter colour and a part of the pixel's own difference,
            // compared with the pixel's threshold.
            let level = 2 * i64::from(share) * length + own * along;
            let threshold = i64::from(2 * Self::ORDER[pixel] + 1) * length;
            colors[usize::from(level > threshold)]
        });
        (colors, is_dark)
    }

    fn levels(&self, light: Light) -> [u8; 3] {
        let step = Self::WHITE / Self::STEPS as i32;
        light.map(|part| self.levels[((part + step / 2) / step) as usize])
    }
}

/// The sum of `mean` and `error`. If its hue differs much from that of `mean`, the sum is grey.
fn with_error(mean: Light, error: Light) -> Light {
    let sum: Light = array::from_fn(|i| (mean[i] + error[i]).clamp(0, Tables::WHITE));
    let grey = |light: Light| light.iter().sum::<i32>() / 3;
    let hue = |light: Light| light.map(|part| f64::from(part - grey(light)));
    let dot = |one: [f64; 3], other: [f64; 3]| (0..3).map(|i| one[i] * other[i]).sum::<f64>();
    let (wanted, summed) = (hue(mean), hue(sum));
    let agreement = dot(wanted, summed);
    // The hues differ by at most 45 degrees.
    let agrees = agreement >= 0.0
        && 2.0 * agreement * agreement >= dot(wanted, wanted) * dot(summed, summed);
    if agrees { sum } else { [grey(sum); 3] }
}
