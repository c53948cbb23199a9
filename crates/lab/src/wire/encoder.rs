//! Encoders of frames, all with one interface.

use std::cell::RefCell;
use std::io::{self, Write};
use std::rc::Rc;
use std::time::{Duration, Instant};

use flate2::Compression;
use flate2::write::ZlibEncoder;
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use ratatui::style::{Color, Modifier};

use crate::report::{Row, Value};
use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Script;
use cellcaster::terminal::{CellWriter, Effort, Fidelity};
use cellcaster::tui::canvas::Mosaic;
use cellcaster::tui::rgb_of;

/// The changed cells of a frame, in the form of ratatui's backends.
pub(crate) type Changes<'a> = [(u16, u16, &'a Cell)];

/// A writer that is shared with a backend.
#[derive(Clone, Debug, Default)]
struct Sink(Rc<RefCell<Vec<u8>>>);

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.borrow_mut().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Sends one frame as ratatui does without a cursor. A sink accepts everything, so nothing fails.
fn send<B: Backend>(backend: &mut B, changes: &Changes) {
    _ = backend.draw(changes.iter().copied());
    _ = backend.hide_cursor();
    _ = Backend::flush(backend);
}

/// An encoder from cells to bytes.
pub(crate) struct Encoder {
    sink: Sink,
    kind: Kind,
}

enum Kind {
    /// Ratatui's own backend for crossterm.
    Stock(CrosstermBackend<Sink>),
    /// Cellcaster's own writer.
    Ours(Box<CellWriter<Sink>>),
}

impl Encoder {
    pub(crate) fn stock() -> Self {
        let sink = Sink::default();
        Self { kind: Kind::Stock(CrosstermBackend::new(sink.clone())), sink }
    }

    /// With `extensions`, the encoder lets the terminal repeat characters and, in true colour,
    /// defines its palette.
    pub(crate) fn ours(
        size: Size,
        depth: ColorDepth,
        fidelity: Fidelity,
        extensions: bool,
    ) -> Self {
        let sink = Sink::default();
        let mut writer = CellWriter::new(sink.clone(), size);
        writer.set_fidelity(fidelity);
        writer.set_repeats(extensions);
        writer.set_palette(extensions && depth == ColorDepth::True);
        Self { sink, kind: Kind::Ours(Box::new(writer)) }
    }

    /// Sets the effort at fidelities that are not exact.
    pub(crate) fn set_effort(&mut self, effort: Effort) {
        if let Kind::Ours(writer) = &mut self.kind {
            writer.set_effort(effort);
        }
    }

    /// Appends the bytes of a frame to `bytes`, by the calls that ratatui's `Terminal` makes to its
    /// backend.
    pub(crate) fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        match &mut self.kind {
            Kind::Stock(backend) => send(backend, changes),
            Kind::Ours(writer) => send(&mut **writer, changes),
        }
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    /// The colours of the dots of a cell's mosaic and of the rest, or of its text and its
    /// background, as shown. `None` if the requested colours are shown.
    pub(crate) fn shown(&self, column: u16, row: u16) -> Option<(Option<Mosaic>, [Color; 2])> {
        let Kind::Ours(writer) = &self.kind else { return None };
        Some((writer.shown_mosaic(column, row), writer.shown_colors(column, row)?))
    }
}

// The frames of a script through one encoder.

/// The headings of [`EncoderRun::row`].
pub(crate) const COLUMNS: [&str; 15] = [
    "frames",
    "mean bytes",
    "ratio",
    "median bytes",
    "95th % bytes",
    "largest bytes",
    "time, µs",
    "zlib 1, bytes",
    "time of zlib 1, µs",
    "zlib 6, bytes",
    "time of zlib 6, µs",
    "PSNR",
    "mean ΔE",
    "largest ΔE",
    "first frame, bytes",
];

/// An encoder and its totals.
pub(crate) struct EncoderRun {
    /// The method and its fidelity.
    name: (&'static str, String),
    encoder: Encoder,
    streams: [Stream; 2],
    /// For each section of the script, its index in `parts`.
    places: Vec<usize>,
    /// A part for each name of a section, and then one for all sections.
    parts: Vec<PartTotals>,
    first_frame: usize,
    /// The bytes of the last frame.
    bytes: Vec<u8>,
}

impl EncoderRun {
    pub(crate) fn new(name: (&'static str, String), encoder: Encoder, script: &Script) -> Self {
        let mut parts: Vec<PartTotals> = Vec::new();
        let places = script.sections().iter().map(|section| {
            let known = parts.iter().position(|sums| sums.name == section.name);
            known.unwrap_or_else(|| {
                parts.push(PartTotals::new(&section.name));
                parts.len() - 1
            })
        });
        let places = places.collect();
        parts.push(PartTotals::new("all"));
        let streams = LEVELS.map(Stream::new);
        Self { name, encoder, streams, places, parts, first_frame: 0, bytes: Vec::new() }
    }

    /// Encodes the frame `drawn`, which belongs to this section of the script. The first frame has
    /// no section.
    pub(crate) fn take(&mut self, section: Option<usize>, changes: &Changes, drawn: &Buffer) {
        self.bytes.clear();
        let start = Instant::now();
        self.encoder.encode(changes, &mut self.bytes);
        let time = start.elapsed();
        let compressed = self.streams.each_mut().map(|stream| {
            let start = Instant::now();
            (stream.size_of(&self.bytes), start.elapsed())
        });
        let Some(section) = section else {
            self.first_frame = self.bytes.len();
            return;
        };
        let difference = Difference::of(&self.encoder, drawn);
        for part in [self.places[section], self.parts.len() - 1] {
            let sums = &mut self.parts[part];
            sums.bytes.push(self.bytes.len());
            for (sum, (bytes, time)) in sums.compressed.iter_mut().zip(compressed) {
                sum.0 += bytes;
                sum.1 += time;
            }
            sums.times.push(time);
            sums.difference.add(difference);
        }
    }

    /// The indices of the parts that have a name. Parts without a name are not reported.
    pub(crate) fn parts(&self) -> impl Iterator<Item = usize> {
        (0..self.parts.len()).filter(|&part| !self.parts[part].name.is_empty())
    }

    /// The mean number of bytes per frame of a part.
    pub(crate) fn mean_bytes(&self, part: usize) -> f64 {
        let bytes = &self.parts[part].bytes;
        bytes.iter().sum::<usize>() as f64 / bytes.len().max(1) as f64
    }

    /// The figures of a part. Ratatui's own encoder writes `stock` bytes per frame.
    pub(crate) fn row(&self, part: usize, stock: f64) -> Row {
        let PartTotals { name, bytes, compressed, times, difference } = &self.parts[part];
        let mut bytes = bytes.clone();
        bytes.sort_unstable();
        let count = bytes.len().max(1) as f64;
        let micros = |time: Duration| Value::Number(time.as_secs_f64() * 1e6 / count);
        let mean = self.mean_bytes(part);
        let mut values = vec![
            Value::Count(bytes.len() as u64),
            Value::Number(mean),
            Value::maybe(Some(mean / stock).filter(|ratio| ratio.is_finite())),
        ];
        values.extend([50, 95, 100].map(|percent| Value::Count(share(&bytes, percent) as u64)));
        values.push(Value::of(times.iter().map(|time| time.as_secs_f64() * 1e6).collect()));
        for (bytes, time) in compressed {
            values.extend([Value::Number(*bytes as f64 / count), micros(*time)]);
        }
        let seen = [
            difference.signal_to_noise(),
            difference.distances / difference.parts.max(1) as f64,
            difference.largest,
        ];
        values.extend(seen.map(Value::Number));
        values.push(Value::Count(self.first_frame as u64));
        Row::new([name, self.name.0, &self.name.1], values)
    }
}

/// The totals over the frames of a part.
struct PartTotals {
    name: String,
    bytes: Vec<usize>,
    compressed: [(usize, Duration); 2],
    /// The time of each frame.
    times: Vec<Duration>,
    difference: Difference,
}

impl PartTotals {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            bytes: Vec::new(),
            compressed: [(0, Duration::ZERO); 2],
            times: Vec::new(),
            difference: Difference::default(),
        }
    }
}

/// The value that this percentage of the `sorted` numbers does not exceed; 0 if there are none.
fn share(sorted: &[usize], percent: usize) -> usize {
    let rank = (sorted.len() * percent).div_ceil(100);
    sorted.get(rank.saturating_sub(1)).copied().unwrap_or_default()
}

// The compression of `ssh -C`: one zlib stream that is flushed after each frame. OpenSSH uses
// level 6; another server could choose level 1.

/// The reported levels: the fastest one, and OpenSSH's.
const LEVELS: [u32; 2] = [1, 6];

/// A compressed stream.
struct Stream(ZlibEncoder<Vec<u8>>);

impl Stream {
    fn new(level: u32) -> Self {
        Self(ZlibEncoder::new(Vec::new(), Compression::new(level)))
    }

    /// The number of bytes sent for `frame`; 0 for an empty frame.
    fn size_of(&mut self, frame: &[u8]) -> usize {
        if !frame.is_empty() {
            // Writing to memory cannot fail.
            _ = self.0.write_all(frame).and_then(|()| self.0.flush());
        }
        self.0.get_mut().drain(..).len()
    }
}

// The difference between the colours that a viewer sees and the drawn colours.

/// The sum of the differences over the parts of cells, two by twelve in each cell. A character
/// counts as half text and half background.
#[derive(Clone, Copy, Debug, Default)]
struct Difference {
    parts: u64,
    /// The sum of squared differences of the channels.
    squares: u64,
    distances: f64,
    largest: f64,
}

impl Difference {
    /// The difference between the frame `drawn` and the frame that `encoder` shows.
    fn of(encoder: &Encoder, drawn: &Buffer) -> Self {
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

    /// Adds a cell, by the number of parts in which each pair of colours meets.
    fn add_cell(&mut self, (shown, wanted): (Mosaic, Mosaic), colors: [[Color; 2]; 2]) {
        let mut parts = [[0; 2]; 2];
        for (x, y) in (0..24).map(|part| (part % 2, part / 2)) {
            parts[usize::from(!shown.has(x, y))][usize::from(!wanted.has(x, y))] += 1;
        }
        for (shown, parts) in colors[0].into_iter().zip(parts) {
            for (wanted, parts) in colors[1].into_iter().zip(parts) {
                // The terminal's own colours are shown as they were drawn.
                if let Some((shown, wanted)) = rgb_of(shown).zip(rgb_of(wanted)) {
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

    fn add(&mut self, other: Self) {
        self.parts += other.parts;
        self.squares += other.squares;
        self.distances += other.distances;
        self.largest = self.largest.max(other.largest);
    }

    /// The peak signal-to-noise ratio in decibels; infinite if there is no difference.
    fn signal_to_noise(&self) -> f64 {
        let mean_square = self.squares as f64 / (3 * self.parts.max(1)) as f64;
        10.0 * libm::log10(255.0 * 255.0 / mean_square)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repeated_bytes_compress_well() {
        let mut stream = Stream::new(6);
        let noise: Vec<u8> =
            (0..5000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 11) as u8).collect();
        let (first, again) = (stream.size_of(&noise), stream.size_of(&noise));
        assert!(first > 500 && again < first / 5, "{first} {again}");
        assert_eq!(stream.size_of(&[]), 0);
        assert!(stream.size_of(b"x") < 20);
    }
}
