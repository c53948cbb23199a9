//! How far what a viewer sees is from what was drawn.

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use super::encoder::Encoder;
use super::lab;
use crate::palette::of_256;
use crate::world::Rgb;

/// Differences of pixels, added up. A cell is two pixels: its halves, or the colours of its text and its ground.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Difference {
    pixels: u64,
    /// Of the differences of the channels.
    squares: u64,
    distances: f64,
    largest: f64,
}

impl Difference {
    /// Of the frame `drawn`, as `encoder` has shown it.
    pub(super) fn of(encoder: &dyn Encoder, drawn: &Buffer) -> Self {
        let mut difference = Self::default();
        let columns = usize::from(drawn.area.width).max(1);
        for (row, cells) in (0..).zip(drawn.content.chunks(columns)) {
            for (column, cell) in (0..).zip(cells) {
                difference.pixels += 2;
                let shown = encoder.shown(column, row);
                let shown = shown.and_then(|[upper, lower]| Some([rgb(upper)?, rgb(lower)?]));
                if let Some((shown, wanted)) = shown.zip(pixels(cell)) {
                    difference.note(shown[0], wanted[0]);
                    difference.note(shown[1], wanted[1]);
                }
            }
        }
        difference
    }

    fn note(&mut self, shown: Rgb, wanted: Rgb) {
        if shown == wanted {
            return;
        }
        let channels = shown.channels().into_iter().zip(wanted.channels());
        let squares = channels.map(|(one, other)| u64::from(one.abs_diff(other)).pow(2));
        self.squares += squares.sum::<u64>();
        let distance = lab::distance(shown, wanted);
        self.distances += distance;
        self.largest = self.largest.max(distance);
    }

    pub(super) fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.squares += other.squares;
        self.distances += other.distances;
        self.largest = self.largest.max(other.largest);
    }

    /// The peak signal-to-noise ratio in decibels; infinite where nothing differs.
    pub(super) fn signal_to_noise(&self) -> f64 {
        let mean_square = self.squares as f64 / (3 * self.pixels.max(1)) as f64;
        10.0 * libm::log10(255.0 * 255.0 / mean_square)
    }

    pub(super) fn mean_distance(&self) -> f64 {
        self.distances / self.pixels.max(1) as f64
    }

    pub(super) fn largest_distance(&self) -> f64 {
        self.largest
    }
}

/// The two pixels of a cell, unless it is in the terminal's own colours or has modifiers, and so is shown as it was
/// drawn.
fn pixels(cell: &Cell) -> Option<[Rgb; 2]> {
    if cell.modifier != Modifier::empty() {
        return None;
    }
    let (foreground, background) = (rgb(cell.fg), rgb(cell.bg));
    match cell.symbol() {
        "▄" => Some([background?, foreground?]),
        "█" => Some([foreground?; 2]),
        " " => Some([background?; 2]),
        _ => Some([foreground?, background?]),
    }
}

fn rgb(color: Color) -> Option<Rgb> {
    match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        Color::Indexed(index) => Some(of_256(index)),
        _ => None,
    }
}
