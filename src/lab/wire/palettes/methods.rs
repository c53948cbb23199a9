//! Methods to choose colours from a small palette: that of the game, and others for comparison.

use std::collections::HashMap;

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;
use ratatui::style::Color;
use ratatui::widgets::StatefulWidget;

use crate::color::Rgb;
use crate::color::oklab::Oklab;
use crate::color::palette::{self, ColorDepth};
use crate::render::Frame;
use crate::tui::{FirstPerson, View};
use crate::world::{Camera, World};

/// The names of the methods; the others are compared with the first.
pub(super) const NAMES: &[&str] = &["nearest", "chroma", "bayer", "mixed"];

/// A method to choose colours from a small palette.
pub(super) trait Method {
    /// Appends the palette indices of the pixels of `frame` to `indices`, row by row. The frame is
    /// the view of `camera` into `world`.
    fn draw(&mut self, world: &World, camera: &Camera, frame: &Frame, indices: &mut Vec<u8>);
}

/// The method with this name, one of [`NAMES`].
pub(super) fn method(name: &str, depth: ColorDepth) -> Box<dyn Method> {
    let nearest = match depth {
        ColorDepth::Indexed16 => palette::nearest_of_16,
        _ => palette::nearest_of_256,
    };
    let colors = if depth == ColorDepth::Indexed16 { 0..=15 } else { 16..=u8::MAX };
    match name {
        "nearest" => Box::new(Pixels(move |pixel, _, _| nearest(pixel))),
        "bayer" => Box::new(Pixels(move |pixel, x, y| nearest(offset(pixel, x, y)))),
        "chroma" => {
            let colors: Vec<(u8, Oklab)> =
                colors.map(|index| (index, weighted(palette::of_256(index)))).collect();
            let mut known: HashMap<Rgb, u8> = HashMap::new();
            Box::new(Pixels(move |pixel, _, _| {
                *known.entry(pixel).or_insert_with(|| {
                    let pixel = weighted(pixel);
                    let distance = |color: &Oklab| pixel.distance_squared(color);
                    let nearest = colors
                        .iter()
                        .min_by(|one, other| distance(&one.1).total_cmp(&distance(&other.1)));
                    nearest.map_or(0, |&(index, _)| index)
                })
            }))
        }
        _ => Box::new(Mixed { depth, view: View::default(), buffer: Buffer::default() }),
    }
}

/// A method that needs only the pixel and its position.
struct Pixels<F>(F);

impl<F: FnMut(Rgb, usize, usize) -> u8> Method for Pixels<F> {
    fn draw(&mut self, _: &World, _: &Camera, frame: &Frame, indices: &mut Vec<u8>) {
        for (y, row) in frame.rows().enumerate() {
            indices.extend(row.iter().enumerate().map(|(x, &pixel)| (self.0)(pixel, x, y)));
        }
    }
}

/// The colour in Oklab with its chroma doubled.
fn weighted(color: Rgb) -> Oklab {
    let Oklab([lightness, red, yellow]) = color.into();
    Oklab([lightness, 2.0 * red, 2.0 * yellow])
}

/// The colour made lighter or darker by the 4×4 matrix of ordered dithering (Bayer, "An Optimum
/// Method for Two-Level Rendition of Continuous-Tone Pictures", 1973). The matrix spans about one
/// step of the colour cube.
fn offset(color: Rgb, x: usize, y: usize) -> Rgb {
    const ORDER: [[i16; 4]; 4] = [[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]];
    const SPAN: i16 = 40;
    let offset = (2 * ORDER[y % 4][x % 4] - 15) * SPAN / 32;
    let [red, green, blue] =
        color.channels().map(|channel| (i16::from(channel) + offset).clamp(0, 255) as u8);
    Rgb::new(red, green, blue)
}

/// The game's method.
struct Mixed {
    depth: ColorDepth,
    view: View,
    buffer: Buffer,
}

impl Method for Mixed {
    fn draw(&mut self, world: &World, camera: &Camera, frame: &Frame, indices: &mut Vec<u8>) {
        let area = Rect::new(0, 0, frame.width() as u16, (frame.height() / 2) as u16);
        self.buffer.resize(area);
        let widget = FirstPerson::new(world, camera).color_depth(self.depth);
        widget.render(area, &mut self.buffer, &mut self.view);
        for cells in self.buffer.content().chunks_exact(frame.width() as usize) {
            for half in [0, 1] {
                indices.extend(cells.iter().map(|cell| halves(cell)[half]));
            }
        }
    }
}

fn halves(cell: &Cell) -> [u8; 2] {
    let index = |color| if let Color::Indexed(index) = color { index } else { 0 };
    let (text, ground) = (index(cell.fg), index(cell.bg));
    match cell.symbol() {
        "▀" => [text, ground],
        "▄" => [ground, text],
        _ => [ground; 2],
    }
}
