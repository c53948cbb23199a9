//! The difference between the colours that a viewer sees and those that were drawn.

use ratatui::buffer::{Buffer, Cell};
use ratatui::style::{Color, Modifier};

use super::encoder::Encoder;
use crate::color::Rgb;
use crate::color::lab::Lab;
use crate::color::palette::of_256;

/// The sum of pixel differences. A cell has two pixels: its halves, or the colours of its text and its background.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Difference {
    pixels: u64,
    /// The sum of squared differences of the channels.
    squares: u64,
    distances: f64,
    largest: f64,
}

impl Difference {
    /// The difference of the frame `drawn` to what `encoder` shows.
    pub(super) fn of(encoder: &dyn Encoder, drawn: &Buffer) -> Self {
        let mut difference = Self::default();
        let columns = usize::from(drawn.area.width).max(1);
        for (row, cells) in (0..).zip(drawn.content.chunks(columns)) {
            for (column, cell) in (0..).zip(cells) {
                difference.pixels += 2;
                let shown = encoder.shown(column, row);
                let shown = shown.and_then(|[upper, lower]| Some([rgb(upper)?, rgb(lower)?]));
                if let Some((shown, wanted)) = shown.zip(pixels(cell)) {
                    difference.add_pixel(shown[0], wanted[0]);
                    difference.add_pixel(shown[1], wanted[1]);
                }
            }
        }
        difference
    }

    fn add_pixel(&mut self, shown: Rgb, wanted: Rgb) {
        if shown == wanted {
            return;
        }
        let channels = shown.channels().into_iter().zip(wanted.channels());
        let squares = channels.map(|(one, other)| u64::from(one.abs_diff(other)).pow(2));
        self.squares += squares.sum::<u64>();
        let distance = Lab::from(shown).distance(wanted.into());
        self.distances += distance;
        self.largest = self.largest.max(distance);
    }

    pub(super) fn add(&mut self, other: Self) {
        self.pixels += other.pixels;
        self.squares += other.squares;
        self.distances += other.distances;
        self.largest = self.largest.max(other.largest);
    }

    /// The peak signal-to-noise ratio in decibels; infinite if there is no difference.
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
