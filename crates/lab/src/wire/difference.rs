//! The difference between the colours that a viewer sees and those that were drawn.

use ratatui::buffer::Buffer;
use ratatui::style::{Color, Modifier};

use super::encoder::Encoder;
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::palette::of_256;
use cellcaster::tui::canvas::Mosaic;

/// The sum of the differences of the parts of cells, two by twelve; a character is half text and half background.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Difference {
    parts: u64,
    /// The sum of squared differences of the channels.
    squares: u64,
    distances: f64,
    largest: f64,
}

impl Difference {
    /// The difference of the frame `drawn` to what `encoder` shows.
    pub(crate) fn of(encoder: &dyn Encoder, drawn: &Buffer) -> Self {
        let mut difference = Self::default();
        let columns = usize::from(drawn.area.width).max(1);
        for (row, cells) in (0..).zip(drawn.content.chunks(columns)) {
            for (column, cell) in (0..).zip(cells) {
                difference.parts += 24;
                if let Some((mosaic, colors)) = encoder.shown(column, row)
                    && cell.modifier == Modifier::empty()
                {
                    let wanted = cell.symbol().chars().next().and_then(Mosaic::of_character);
                    // Text is compared with the same text.
                    let mosaics = mosaic.zip(wanted).unwrap_or([Mosaic::UPPER_HALF; 2].into());
                    difference.add_cell(mosaics, [colors, [cell.fg, cell.bg]]);
                }
            }
        }
        difference
    }

    /// Adds a cell by the parts in which each pair of colours meets.
    fn add_cell(&mut self, (shown, wanted): (Mosaic, Mosaic), colors: [[Color; 2]; 2]) {
        let mut parts = [[0; 2]; 2];
        for (x, y) in (0..24).map(|part| (part % 2, part / 2)) {
            parts[usize::from(!shown.has(x, y))][usize::from(!wanted.has(x, y))] += 1;
        }
        for (shown, parts) in colors[0].into_iter().zip(parts) {
            for (wanted, parts) in colors[1].into_iter().zip(parts) {
                // The terminal's own colours are shown as they were drawn.
                if let Some((shown, wanted)) = rgb(shown).zip(rgb(wanted)) {
                    self.add_parts(parts, shown, wanted);
                }
            }
        }
    }

    fn add_parts(&mut self, parts: u64, shown: Rgb, wanted: Rgb) {
        if shown == wanted || parts == 0 {
            return;
        }
        let channels = shown.channels().into_iter().zip(wanted.channels());
        let squares = channels.map(|(one, other)| u64::from(one.abs_diff(other)).pow(2));
        self.squares += parts * squares.sum::<u64>();
        let distance = Lab::from(shown).distance(wanted.into());
        self.distances += parts as f64 * distance;
        self.largest = self.largest.max(distance);
    }

    pub(crate) fn add(&mut self, other: Self) {
        self.parts += other.parts;
        self.squares += other.squares;
        self.distances += other.distances;
        self.largest = self.largest.max(other.largest);
    }

    /// The peak signal-to-noise ratio in decibels; infinite if there is no difference.
    pub(crate) fn signal_to_noise(&self) -> f64 {
        let mean_square = self.squares as f64 / (3 * self.parts.max(1)) as f64;
        10.0 * libm::log10(255.0 * 255.0 / mean_square)
    }

    pub(crate) fn mean_distance(&self) -> f64 {
        self.distances / self.parts.max(1) as f64
    }

    pub(crate) fn largest_distance(&self) -> f64 {
        self.largest
    }
}

fn rgb(color: Color) -> Option<Rgb> {
    match color {
        Color::Rgb(red, green, blue) => Some(Rgb::new(red, green, blue)),
        Color::Indexed(index) => Some(of_256(index)),
        _ => None,
    }
}
