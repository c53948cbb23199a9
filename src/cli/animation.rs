//! `--png`: what the screen of a replay shows, as an animated PNG.
//!
//! A frame stores the smallest rectangle with all cells that differ from the frame before. A frame without a
//! difference extends the one before. The file begins with the number of frames and their palette, so the
//! frames are kept as cells until the end. The bounds below limit their memory.
//!
//! Rejected: three bytes for each pixel. They are exact, but eight seconds of the observatory at 12 frames
//! a second take 1051 kB in place of 470: `replay maps/scripts/observatory.normal.script --part 32-40 --size
//! 100x30 --fps 12`.

mod palette;

use std::fmt;
use std::io::{self, Write};
use std::num::NonZeroU32;
use std::ops::Range;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};

use self::palette::IndexedPalette;
use super::Error;
use super::options::{frames, pair, window};
use super::output_file::OutputFile;
use super::parse::Takes;
use super::pixels::{self, CellSize};
use crate::tui::CellAspect;

/// The window in which a replay is drawn, and the animated PNG of it.
#[derive(Args, Clone, Debug)]
pub struct Animation {
    /// Write the screen as an animated PNG
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub png: Option<PathBuf>,
    /// The part of the replay to show, in seconds, such as 12.5-20 [default: all]
    #[arg(long, value_name = "FROM-TO", value_parser = part, requires = "png")]
    pub part: Option<(f64, f64)>,
    /// The size of the window in cells, with sides up to 1000 and up to 200000 cells
    #[arg(long, value_name = "COLSxROWS", default_value = "80x24", value_parser = window)]
    pub size: Size,
    /// At most N frames a second, from 1 to 240
    #[arg(long = "fps", value_name = "N", default_value = "30", value_parser = frames)]
    pub frames_per_second: NonZeroU32,
}

fn part(text: &str) -> Result<(f64, f64), Takes> {
    let part = pair(text, '-').filter(|&(from, to)| 0.0 <= from && from < to);
    part.ok_or(Takes("FROM-TO in seconds, such as 12.5-20"))
}

/// The frames of an animated PNG.
#[derive(Debug)]
pub struct Frames {
    changes: Vec<FrameChange>,
    last: Buffer,
    part: Range<u64>,
    /// The maximum length of `changes`.
    most: usize,
    /// Frames per second.
    rate: u16,
}

/// The change from one frame to the next.
#[derive(Debug)]
struct FrameChange {
    area: Rect,
    /// The cells of the area, row by row.
    cells: Vec<Cell>,
    /// How long the frame is shown, in frames of the replay.
    length: u16,
}

/// The maximum number of frames.
const MAX_FRAMES: usize = 1000;
/// The maximum number of cells in all frames, which take 40 bytes each.
const MAX_CELLS: usize = 1 << 21;

impl Frames {
    /// No frames yet of the animation that `options` describe.
    pub fn new(options: &Animation) -> Self {
        let frames_per_second = options.frames_per_second.get() as u16;
        let number = |seconds: f64| (seconds * f64::from(frames_per_second)).round() as u64;
        let area = Rect::from(options.size);
        Self {
            changes: Vec::new(),
            last: Buffer::empty(area),
            part: options.part.map_or(0..u64::MAX, |(from, to)| number(from)..number(to)),
            most: (MAX_CELLS / area.area().max(1) as usize).min(MAX_FRAMES),
            rate: frames_per_second,
        }
    }

    /// Returns true if the animation ends before frame `number` of the replay.
    pub fn end_before(&self, number: u64) -> bool {
        self.part.end <= number
    }

    /// Adds frame `number` of the replay, if it belongs to the animation.
    ///
    /// # Errors
    /// If there are too many frames.
    pub fn push(&mut self, number: u64, picture: &Buffer) -> Result<(), TooManyFrames> {
        if !self.part.contains(&number) {
            return Ok(());
        }
        let is_first = self.changes.is_empty();
        let area = if is_first { picture.area } else { difference(&self.last, picture) };
        let same = self.changes.last_mut().filter(|last| area.is_empty() && last.length < u16::MAX);
        if let Some(last) = same {
            last.length += 1;
            return Ok(());
        }
        if self.changes.len() == self.most {
            return Err(TooManyFrames { most: self.most, size: self.last.area.as_size() });
        }
        // After the longest time that a frame can be shown, the same frame begins again.
        let area = if area.is_empty() { Rect::new(0, 0, 1, 1) } else { area };
        let cells = area.positions().map(|position| picture[position].clone()).collect();
        self.changes.push(FrameChange { area, cells, length: 1 });
        self.last.clone_from(picture);
        Ok(())
    }

    /// Writes the animated PNG, which browsers show over and over.
    ///
    /// # Errors
    /// If there are no frames, or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        if self.changes.is_empty() {
            return Err(Error::mistake("--part begins after the end of the replay"));
        }
        OutputFile::create(path)?.write(|output| self.encode(output).map_err(into_io))
    }

    fn encode(&self, output: impl Write) -> Result<(), EncodingError> {
        let size = self.last.area.as_size();
        let cell = CellSize::of(size, CellAspect::default());
        let in_pixels = |columns: u16, rows: u16| {
            (u32::from(columns) * cell.width, u32::from(rows) * cell.height)
        };
        let cells = self.changes.iter().flat_map(|frame| &frame.cells);
        let palette = IndexedPalette::of(cells.flat_map(pixels::colors));
        let (width, height) = in_pixels(size.width, size.height);
        let mut encoder = Encoder::new(output, width, height);
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(palette.entries.as_flattened());
        encoder.set_compression(Compression::High);
        // Neighbouring indices are unrelated numbers, so filters only hide what repeats.
        encoder.set_filter(Filter::NoFilter);
        encoder.set_animated(self.changes.len() as u32, 0)?;
        let mut writer = encoder.write_header()?;
        let mut data = Vec::new();
        for FrameChange { area, cells, length } in &self.changes {
            let (width, height) = in_pixels(area.width, area.height);
            let (x, y) = in_pixels(area.x, area.y);
            writer.reset_frame_position()?;
            writer.set_frame_dimension(width, height)?;
            writer.set_frame_position(x, y)?;
            writer.set_frame_delay(*length, self.rate)?;
            data.clear();
            for row in cells.chunks_exact(area.width.into()) {
                cell.draw_row(row, |color| [palette.index(color)], &mut data);
            }
            writer.write_image_data(&data)?;
        }
        writer.finish()
    }
}

/// The smallest area with all cells that differ.
fn difference(before: &Buffer, after: &Buffer) -> Rect {
    let cells = before.diff(after).into_iter().map(|(x, y, _)| Rect::new(x, y, 1, 1));
    cells.reduce(Rect::union).unwrap_or_default()
}

/// The error of an animation that is too long for its size.
#[derive(Clone, Copy, Debug)]
pub struct TooManyFrames {
    most: usize,
    size: Size,
}

impl fmt::Display for TooManyFrames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { most, size: Size { width, height } } = self;
        write!(
            f,
            "an animated PNG has at most {most} frames of {width}x{height} cells: show less with \
             --part, such as --part 0-10, or choose a smaller --fps or --size"
        )
    }
}

impl From<TooManyFrames> for Error {
    fn from(error: TooManyFrames) -> Self {
        Self::mistake(error.to_string())
    }
}

/// The error of the output behind `error`, if there is one.
pub(crate) fn into_io(error: EncodingError) -> io::Error {
    match error {
        EncodingError::IoError(error) => error,
        other => io::Error::other(other),
    }
}
