//! Half blocks from a small palette: hues that it lacks are mixed from colours side by side.
//!
//! Two cells, one beside the other, are a block of four pixels that shares two colours. Of them, the [`Mixture`] of
//! the block's mean, each pixel shows the one or the other: by a pattern that stands still on the screen, and
//! by how near to either its own colour is, so that what is drawn on a wall remains. What the upper of two blocks is off, the lower one
//! makes good, and then it ends: a pixel that changes changes no more than the eight of its two blocks. A block with an edge in
//! it shows the nearest colours of either side.
//!
//! Since its colours are two, a block costs hardly more bytes than one cell: an encoder need but pick the glyphs. A
//! pattern of its own for each pixel (Bayer's, or a mask of blue noise) was refused: it looks no better from
//! a little farther away, and takes twice the bytes. So was error diffusion: there, one pixel changes all
//! that follow. `cellcaster wire --palette 256` has the figures.

use std::array;
use std::sync::LazyLock;

use ratatui::layout::Rect;
use ratatui::style::Color;

use crate::canvas::Canvas;
use crate::color::Rgb;
use crate::color::palette;
use crate::color::palette::mixture::{self, Mixture, Mixtures};
use crate::color::srgb::linear;
use crate::render::Frame;

/// So many cells are drawn at a time, and so need room: an even number.
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
                let mut owed = [0; 3];
                for (rows, shown) in rows.iter().zip(&mut shown) {
                    let Some(block) = block(rows, left + x) else { continue };
                    let colors = tables.draw(mixtures, block, &mut owed);
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

/// The pixels of a block, row by row. The last one of a row may have to be both.
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

/// What colours are in light, and back.
struct Tables {
    of_channel: [i32; 256],
    of_index: [Light; 256],
    /// The upper bits of the channel that gives off so much light.
    levels: [u8; Self::STEPS + 1],
}

static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);

impl Tables {
    const WHITE: i32 = 1 << 15;
    /// Light is told apart in so many steps where it becomes a channel again.
    const STEPS: usize = 1 << 12;
    /// What is this much brighter than another pixel of its block, in parts of 255, is beyond an edge.
    const EDGE: u8 = 46;
    /// In this order the pixels of a block get the brighter colour.
    const ORDER: [i32; 4] = [0, 2, 3, 1];

    fn new() -> Self {
        let scaled = |share: f64| libm::round(share * f64::from(Self::WHITE)) as i32;
        let of = |color| linear(color).map(scaled);
        let of_channel = array::from_fn(|value| of(Rgb::new(value as u8, 0, 0))[0]);
        let of_index = array::from_fn(|index| of(palette::of_256(index as u8)));
        let mut levels = [0; Self::STEPS + 1];
        let mut channel = 0;
        for (step, level) in levels.iter_mut().enumerate() {
            let light = (step << 3) as i32;
            while channel < 255 && of_channel[channel + 1] <= light {
                channel += 1;
            }
            *level = (channel >> (u8::BITS - mixture::BITS)) as u8;
        }
        Self { of_channel, of_index, levels }
    }

    /// What the pixels of a block show. It is drawn brighter by what is `owed`, and owes three quarters of what
    /// it is off then: all of it would cost more bytes than it is worth.
    fn draw(&self, mixtures: &Mixtures, block: [Rgb; 4], owed: &mut Light) -> [u8; 4] {
        let lumas = block.map(Rgb::luma);
        let [darkest, brightest] =
            lumas.iter().fold([u8::MAX, 0], |[low, high], &luma| [low.min(luma), high.max(luma)]);
        let lights = block
            .map(|pixel| pixel.channels().map(|channel| self.of_channel[usize::from(channel)]));
        let colors = if brightest - darkest > Self::EDGE {
            self.draw_edge(mixtures, lumas.map(|luma| luma > darkest.midpoint(brightest)), &lights)
        } else {
            self.mix(mixtures, &lights, *owed)
        };
        *owed = array::from_fn(|i| {
            let shown = |pixel: usize| self.of_index[usize::from(colors[pixel])][i];
            (0..4).map(|pixel| lights[pixel][i] - shown(pixel)).sum::<i32>() * 3 / 16
        });
        colors
    }

    /// The colours nearest to the means of what is on either side of an edge.
    fn draw_edge(&self, mixtures: &Mixtures, is_bright: [bool; 4], lights: &[Light; 4]) -> [u8; 4] {
        let [dark, bright] = [false, true].map(|side| {
            let on_side =
                || lights.iter().zip(is_bright).filter(|&(_, is_bright)| is_bright == side);
            let count = on_side().count().max(1) as i32;
            let mean =
                array::from_fn(|i| on_side().map(|(light, _)| light[i]).sum::<i32>() / count);
            mixtures.of(self.levels(mean)).single
        });
        is_bright.map(|is_bright| if is_bright { bright } else { dark })
    }

    /// The mixture of the mean.
    fn mix(&self, mixtures: &Mixtures, lights: &[Light; 4], owed: Light) -> [u8; 4] {
        let mean: Light = array::from_fn(|i| lights.iter().map(|light| light[i]).sum::<i32>() / 4);
        let wanted = paid(mean, owed);
        let Mixture { colors, share, .. } = mixtures.of(self.levels(wanted));
        if share == 0 {
            return [colors[0]; 4];
        }
        let [darker, brighter] = colors.map(|index| self.of_index[usize::from(index)]);
        let way: [i64; 3] = array::from_fn(|i| i64::from(brighter[i] - darker[i]));
        let length: i64 = way.iter().map(|part| part * part).sum();
        array::from_fn(|pixel| {
            let along: i64 = (0..3).map(|i| i64::from(lights[pixel][i] - mean[i]) * way[i]).sum();
            // In eighths: what the mixture wants, and three eighths of what the pixel itself does, against
            // the pattern.
            let wish = 2 * i64::from(share) * length + 3 * along;
            let threshold = i64::from(2 * Self::ORDER[pixel] + 1) * length;
            colors[usize::from(wish > threshold)]
        })
    }

    fn levels(&self, light: Light) -> [u8; 3] {
        light.map(|part| self.levels[(part >> 3) as usize])
    }
}

/// `mean` and what is owed: of about the same hue, or grey.
fn paid(mean: Light, owed: Light) -> Light {
    let sum: Light = array::from_fn(|i| (mean[i] + owed[i]).clamp(0, Tables::WHITE));
    let grey = |light: Light| light.iter().sum::<i32>() / 3;
    let hue = |light: Light| light.map(|part| f64::from(part - grey(light)));
    let dot = |one: [f64; 3], other: [f64; 3]| (0..3).map(|i| one[i] * other[i]).sum::<f64>();
    let (wanted, summed) = (hue(mean), hue(sum));
    let agreement = dot(wanted, summed);
    // Within 45 degrees.
    let agrees = agreement >= 0.0
        && 2.0 * agreement * agreement >= dot(wanted, wanted) * dot(summed, summed);
    if agrees { sum } else { [grey(sum); 3] }
}
