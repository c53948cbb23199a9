//! Encoders of frames behind one trait.

use std::cell::RefCell;
use std::io;
use std::io::Write;
use std::rc::Rc;
use std::time::{Duration, Instant};

use flate2::{Compress, Compression, FlushCompress, Status};
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Size;
use ratatui::style::{Color, Modifier};

use cellcaster::color::Rgb;
use cellcaster::color::lab::Lab;
use cellcaster::color::palette::{ColorDepth, of_256};
use cellcaster::game::Script;
use cellcaster::terminal::{CellWriter, Fidelity};
use cellcaster::tui::canvas::Mosaic;

/// The changed cells of a frame, in the form of ratatui's backends.
pub(crate) type Changes<'a> = [(u16, u16, &'a Cell)];

/// An encoder from cells to bytes.
pub(crate) trait Encoder {
    /// Appends the bytes of a frame to `bytes`, with the calls that ratatui's `Terminal` makes to
    /// its backend.
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>);

    /// The colours shown by the dots of a cell's mosaic and by the rest, or by its text and its background;
    /// `None` if they are the requested ones.
    fn shown(&self, column: u16, row: u16) -> Option<(Option<Mosaic>, [Color; 2])>;
}

/// A writer shared with a backend.
#[derive(Clone, Debug, Default)]
pub(crate) struct Sink(Rc<RefCell<Vec<u8>>>);

impl Sink {
    /// The number of bytes written since the last call.
    pub(crate) fn drain(&self) -> usize {
        self.0.borrow_mut().drain(..).len()
    }
}

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

/// Ratatui's own backend for crossterm.
pub(crate) struct Stock {
    sink: Sink,
    backend: CrosstermBackend<Sink>,
}

impl Stock {
    pub(crate) fn new() -> Self {
        let sink = Sink::default();
        let backend = CrosstermBackend::new(sink.clone());
        Self { sink, backend }
    }
}

impl Encoder for Stock {
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        send(&mut self.backend, changes);
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    fn shown(&self, _: u16, _: u16) -> Option<(Option<Mosaic>, [Color; 2])> {
        None
    }
}

/// Whether the terminal repeats characters and, in true colour, has its palette defined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Extensions {
    Off,
    On,
}

impl Extensions {
    /// The name of Cellcaster's encoder at `fidelity`.
    pub(crate) fn name(self, fidelity: Fidelity) -> String {
        match self {
            Self::Off => fidelity.to_string(),
            Self::On => format!("{fidelity}+"),
        }
    }
}

/// Cellcaster's encoder.
pub(crate) struct Writer {
    sink: Sink,
    backend: CellWriter<Sink>,
}

impl Writer {
    pub(crate) fn new(
        size: Size,
        depth: ColorDepth,
        fidelity: Fidelity,
        extensions: Extensions,
    ) -> Self {
        let sink = Sink::default();
        let mut backend = CellWriter::new(sink.clone(), size);
        backend.set_fidelity(fidelity);
        backend.set_repeats(extensions == Extensions::On);
        backend.set_palette(extensions == Extensions::On && depth == ColorDepth::True);
        Self { sink, backend }
    }
}

impl Encoder for Writer {
    fn encode(&mut self, changes: &Changes, bytes: &mut Vec<u8>) {
        send(&mut self.backend, changes);
        bytes.append(&mut self.sink.0.borrow_mut());
    }

    fn shown(&self, column: u16, row: u16) -> Option<(Option<Mosaic>, [Color; 2])> {
        let colors = self.backend.shown_colors(column, row)?;
        Some((self.backend.shown_mosaic(column, row), colors))
    }
}

// The frames of a script through one encoder.

/// The results of one encoder.
#[derive(Clone, Debug)]
pub struct EncoderReport {
    /// The name: `stock`, a fidelity, or a fidelity and `+`, which means with repeated characters
    /// and a defined palette.
    pub name: String,
    /// The size of the first frame, in bytes.
    pub first_frame: usize,
    /// The named sections of the script, in order. Sections with the same name are one.
    pub sections: Vec<Part>,
    /// All frames but the first.
    pub all: Part,
}

/// The results of a part of a script.
#[derive(Clone, Debug)]
pub struct Part {
    /// The section's name; `all` for all of them.
    pub name: String,
    /// The number of frames.
    pub frames: usize,
    /// The number of bytes per frame.
    pub bytes: Bytes,
    /// The ratio of the mean number of bytes to that of ratatui's own encoder; NaN if both are 0.
    pub ratio: f64,
    /// The compressed frames, by zlib at level 1, and at level 6 as with `ssh -C`.
    pub compressed: [Compressed; 2],
    /// The mean time to encode a frame.
    pub time: Duration,
    /// The colour errors that the viewer sees.
    pub seen: Seen,
}

/// The mean of a compressed frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compressed {
    /// The number of bytes.
    pub bytes: f64,
    /// The time to compress.
    pub time: Duration,
}

/// The number of bytes per frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bytes {
    /// The mean.
    pub mean: f64,
    /// The median.
    pub median: usize,
    /// The 95th percentile.
    pub percentile_95: usize,
    /// The maximum.
    pub largest: usize,
}

/// The difference between the colours on the terminal and those that were drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The peak signal-to-noise ratio, in decibels; infinite if there is no difference.
    pub signal_to_noise: f64,
    /// The mean distance of a pixel's colour, in ΔE of CIE76.
    pub mean_distance: f64,
    /// The largest distance.
    pub largest_distance: f64,
}

/// An encoder and its sums so far.
pub(crate) struct EncoderRun {
    name: String,
    encoder: Box<dyn Encoder>,
    streams: [Stream; 2],
    /// For each section of the script, the index in `sections`.
    places: Vec<usize>,
    sections: Vec<Sums>,
    all: Sums,
    first_frame: usize,
    /// The bytes of the last frame.
    bytes: Vec<u8>,
}

impl EncoderRun {
    pub(crate) fn new(name: String, encoder: Box<dyn Encoder>, script: &Script) -> Self {
        let mut sections: Vec<Sums> = Vec::new();
        let places = script.sections().iter().map(|section| {
            let known = sections.iter().position(|sums| sums.name == section.name);
            known.unwrap_or_else(|| {
                sections.push(Sums::new(&section.name));
                sections.len() - 1
            })
        });
        let places = places.collect();
        Self {
            name,
            encoder,
            streams: LEVELS.map(Stream::new),
            places,
            sections,
            all: Sums::new("all"),
            first_frame: 0,
            bytes: Vec::new(),
        }
    }

    /// Encodes the frame `drawn`, which belongs to this section of the script; the first frame has
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
        let difference = Difference::of(&*self.encoder, drawn);
        for sums in [&mut self.sections[self.places[section]], &mut self.all] {
            sums.bytes.push(self.bytes.len());
            for (sum, (bytes, time)) in sums.compressed.iter_mut().zip(compressed) {
                sum.0 += bytes;
                sum.1 += time;
            }
            sums.time += time;
            sums.difference.add(difference);
        }
    }

    /// The results, relative to those of the first encoder; `None` for the first encoder itself.
    pub(crate) fn finish(self, first: Option<&EncoderReport>) -> EncoderReport {
        let sections = self.sections.into_iter().filter(|sums| !sums.name.is_empty());
        let sections = sections.enumerate();
        EncoderReport {
            name: self.name,
            first_frame: self.first_frame,
            sections: sections
                .map(|(index, sums)| sums.finish(first.map(|first| &first.sections[index])))
                .collect(),
            all: self.all.finish(first.map(|first| &first.all)),
        }
    }
}

/// The sums over the frames of a part.
struct Sums {
    name: String,
    bytes: Vec<usize>,
    compressed: [(usize, Duration); 2],
    time: Duration,
    difference: Difference,
}

impl Sums {
    fn new(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            bytes: Vec::new(),
            compressed: [(0, Duration::ZERO); 2],
            time: Duration::ZERO,
            difference: Difference::default(),
        }
    }

    fn finish(mut self, first: Option<&Part>) -> Part {
        self.bytes.sort_unstable();
        let frames = self.bytes.len();
        let count = frames.max(1) as f64;
        let mean = self.bytes.iter().sum::<usize>() as f64 / count;
        Part {
            name: self.name,
            frames,
            bytes: Bytes {
                mean,
                median: share(&self.bytes, 50),
                percentile_95: share(&self.bytes, 95),
                largest: share(&self.bytes, 100),
            },
            ratio: mean / first.map_or(mean, |first| first.bytes.mean),
            compressed: self.compressed.map(|(bytes, time)| Compressed {
                bytes: bytes as f64 / count,
                time: time.div_f64(count),
            }),
            time: self.time.div_f64(count),
            seen: Seen {
                signal_to_noise: self.difference.signal_to_noise(),
                mean_distance: self.difference.mean_distance(),
                largest_distance: self.difference.largest_distance(),
            },
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

/// The reported levels: the fastest one, and that of OpenSSH.
pub(crate) const LEVELS: [u32; 2] = [1, 6];
/// More bytes than zlib adds to incompressible data.
const OVERHEAD: usize = 256;

/// A compressed stream.
#[derive(Debug)]
pub(crate) struct Stream {
    compress: Compress,
    output: Vec<u8>,
}

impl Stream {
    pub(crate) fn new(level: u32) -> Self {
        Self { compress: Compress::new(Compression::new(level), true), output: Vec::new() }
    }

    /// The number of bytes sent for `frame`; 0 for an empty one.
    pub(crate) fn size_of(&mut self, frame: &[u8]) -> usize {
        if frame.is_empty() {
            return 0;
        }
        let (read, written) = (self.compress.total_in(), self.compress.total_out());
        loop {
            let rest = &frame[(self.compress.total_in() - read) as usize..];
            self.output.clear();
            self.output.reserve(rest.len() + OVERHEAD);
            let status = self.compress.compress_vec(rest, &mut self.output, FlushCompress::Sync);
            let is_full = self.output.len() == self.output.capacity();
            if !is_full || !matches!(status, Ok(Status::Ok)) {
                return (self.compress.total_out() - written) as usize;
            }
        }
    }
}

// The difference between the colours that a viewer sees and those that were drawn.

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
