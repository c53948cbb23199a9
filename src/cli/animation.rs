//! The screen of a replay, as an animated PNG, a GIF or an animated SVG.
//!
//! A frame stores the smallest rectangle with all cells that differ from the frame before. A frame without a
//! difference extends the one before. The file begins with the number of frames and their palette, so the
//! frames are kept as cells until the end. The bounds below limit their memory.
//!
//! Rejected: three bytes for each pixel in a PNG. They are exact, but eight seconds of the observatory at 12
//! frames a second in 100x30 cells take 1051 kB in place of 470.

mod palette;
mod svg;

use std::borrow::Cow;
use std::fmt;
use std::io::{self, Write};
use std::num::NonZeroU32;
use std::ops::Range;
use std::path::Path;

use clap::Args;
use png::{BitDepth, ColorType, Compression, EncodingError, Filter};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};

use self::palette::IndexedPalette;
use super::Error;
use super::options::{frames, window};
use super::output_file::OutputFile;
use super::parse::ValidValues;
use crate::app::MAX_PLAYBACK_STEPS;
use crate::game::STEPS_PER_SECOND;
use crate::tui::CellAspect;
use crate::tui::pixels::{self, CellSize, into_io};

/// A part of a replay, and the window in which it is drawn.
#[derive(Args, Clone, Debug)]
pub struct Excerpt {
    /// The start time, in seconds or as 1:05.5 [default: the start]
    #[arg(long, value_name = "TIME", value_parser = time)]
    from: Option<f64>,
    /// The end time [default: the end]
    #[arg(long, value_name = "TIME", value_parser = time)]
    to: Option<f64>,
    /// The size of the window in cells, with sides up to 1000 and up to 200000 cells
    #[arg(long, value_name = "COLSxROWS", default_value = "80x24", value_parser = window)]
    pub size: Size,
    /// At most N frames a second, from 1 to 240
    #[arg(long = "fps", value_name = "N", default_value = "15", value_parser = frames)]
    pub frames_per_second: NonZeroU32,
}

impl Excerpt {
    /// Returns true if the time at which it ends is given.
    pub(crate) fn has_end(&self) -> bool {
        self.to.is_some()
    }

    /// The numbers of the frames.
    ///
    /// # Errors
    /// If there are none.
    pub fn frames(&self) -> Result<Range<u64>, Error> {
        let number =
            |seconds: f64| (seconds * f64::from(self.frames_per_second.get())).round() as u64;
        let (from, to) = (number(self.from.unwrap_or(0.0)), self.to.map_or(u64::MAX, number));
        if from < to { Ok(from..to) } else { Err(Error::mistake("--to must be later than --from")) }
    }
}

/// Parses a time in seconds, as seconds or as minutes and seconds.
fn time(text: &str) -> Result<f64, ValidValues> {
    let (minutes, seconds) = text.split_once(':').unwrap_or(("0", text));
    let most = (MAX_PLAYBACK_STEPS / u64::from(STEPS_PER_SECOND)) as f64;
    let minutes: Option<u32> = minutes.parse().ok();
    let seconds: Option<f64> = seconds.parse().ok();
    let time = minutes.zip(seconds).map(|(minutes, seconds)| f64::from(minutes) * 60.0 + seconds);
    let time = time.filter(|time| (0.0..=most).contains(time));
    time.ok_or(ValidValues(
        "seconds, such as 12.5, or minutes and seconds, such as 1:05.5, up to 24 hours",
    ))
}

/// The format of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum AnimationFormat {
    Png,
    Gif,
    Svg,
}

/// The frames of an animation.
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
/// The longest time for which a frame is shown, in seconds. A GIF has room for 655.
const MAX_SECONDS: u64 = 600;
/// The maximum frame rate of a GIF. Browsers show a frame for a tenth of a second if it is shorter than two
/// hundredths.
pub(crate) const MAX_GIF_RATE: u32 = 50;

impl Frames {
    /// No frames yet of the animation of `excerpt`.
    ///
    /// # Errors
    /// If the excerpt ends before it begins.
    pub fn new(excerpt: &Excerpt) -> Result<Self, Error> {
        let area = Rect::from(excerpt.size);
        Ok(Self {
            changes: Vec::new(),
            last: Buffer::empty(area),
            part: excerpt.frames()?,
            most: (MAX_CELLS / area.area().max(1) as usize).min(MAX_FRAMES),
            rate: excerpt.frames_per_second.get() as u16,
        })
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
        let longest = (MAX_SECONDS * u64::from(self.rate)).min(u16::MAX.into()) as u16;
        let same = self.changes.last_mut().filter(|last| area.is_empty() && last.length < longest);
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

    /// The duration in frames of the replay.
    pub(crate) fn length(&self) -> u64 {
        self.changes.iter().map(|frame| u64::from(frame.length)).sum()
    }

    /// Writes the animated PNG, which browsers show over and over.
    ///
    /// # Errors
    /// If there are no frames, or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        self.check()?;
        OutputFile::create(path)?.write(|output| self.encode(AnimationFormat::Png, output))
    }

    /// Returns an error if there are no frames.
    pub(crate) fn check(&self) -> Result<(), Error> {
        if self.changes.is_empty() { Err(Self::none()) } else { Ok(()) }
    }

    /// The error of an excerpt without frames.
    pub(crate) fn none() -> Error {
        Error::mistake("--from is after the end of the replay")
    }

    /// Writes the animation.
    pub(crate) fn encode(&self, format: AnimationFormat, output: impl Write) -> io::Result<()> {
        let cell = CellSize::of(self.last.area.as_size(), CellAspect::default());
        let cells = self.changes.iter().flat_map(|frame| &frame.cells);
        let palette = IndexedPalette::of(cells.flat_map(pixels::colors), format.max_colors());
        match format {
            AnimationFormat::Png => self.encode_png(cell, &palette, output).map_err(into_io),
            AnimationFormat::Gif => self.encode_gif(cell, &palette, output).map_err(from_gif),
            AnimationFormat::Svg => self.encode_svg(cell, &palette, output),
        }
    }

    fn encode_png(
        &self,
        cell: CellSize,
        palette: &IndexedPalette,
        output: impl Write,
    ) -> Result<(), EncodingError> {
        let Rect { width, height, .. } = in_pixels(self.last.area, cell);
        let mut encoder = png::Encoder::new(output, width.into(), height.into());
        encoder.set_color(ColorType::Indexed);
        encoder.set_depth(BitDepth::Eight);
        encoder.set_palette(palette.entries.as_flattened());
        encoder.set_compression(Compression::High);
        // Neighbouring indices are unrelated numbers, so filters only hide what repeats.
        encoder.set_filter(Filter::NoFilter);
        encoder.set_animated(self.changes.len() as u32, 0)?;
        let mut writer = encoder.write_header()?;
        let mut data = Vec::new();
        for change in &self.changes {
            let Rect { x, y, width, height } = in_pixels(change.area, cell);
            writer.reset_frame_position()?;
            writer.set_frame_dimension(width.into(), height.into())?;
            writer.set_frame_position(x.into(), y.into())?;
            writer.set_frame_delay(change.length, self.rate)?;
            change.draw(cell, palette, &mut data);
            writer.write_image_data(&data)?;
        }
        writer.finish()
    }

    fn encode_gif(
        &self,
        cell: CellSize,
        palette: &IndexedPalette,
        output: impl Write,
    ) -> Result<(), gif::EncodingError> {
        let Rect { width, height, .. } = in_pixels(self.last.area, cell);
        let entries = [&palette.entries[..], &[[0; 3]]].concat();
        let transparent = palette.entries.len() as u8;
        let mut encoder = gif::Encoder::new(output, width, height, entries.as_flattened())?;
        encoder.set_repeat(gif::Repeat::Infinite)?;
        let mut shown = vec![transparent; usize::from(width) * usize::from(height)];
        let (mut data, mut frames) = (Vec::new(), 0);
        for change in &self.changes {
            // The times are rounded, not the intervals, because rounding errors of intervals would add up.
            let hundredths = |frames: u64| frames * 100 / u64::from(self.rate);
            let begun = hundredths(frames);
            frames += u64::from(change.length);
            let area = in_pixels(change.area, cell);
            change.draw(cell, palette, &mut data);
            let rows = shown.chunks_exact_mut(width.into()).skip(area.y.into());
            for (row, data) in rows.zip(data.chunks_exact_mut(area.width.into())) {
                for (shown, pixel) in row[area.x.into()..].iter_mut().zip(data) {
                    let is_same = *shown == *pixel;
                    *shown = *pixel;
                    *pixel = if is_same { transparent } else { *pixel };
                }
            }
            encoder.write_frame(&gif::Frame {
                delay: (hundredths(frames) - begun) as u16,
                dispose: gif::DisposalMethod::Keep,
                transparent: Some(transparent),
                left: area.x,
                top: area.y,
                width: area.width,
                height: area.height,
                buffer: Cow::Borrowed(&data),
                ..gif::Frame::default()
            })?;
        }
        Ok(())
    }
}

impl AnimationFormat {
    /// The maximum number of colours. In a GIF, one entry of the palette is for pixels that stay.
    fn max_colors(self) -> usize {
        match self {
            Self::Png | Self::Svg => 256,
            Self::Gif => 255,
        }
    }
}

impl FrameChange {
    /// Draws the cells into `data`, as indices into `palette`.
    fn draw(&self, cell: CellSize, palette: &IndexedPalette, data: &mut Vec<u8>) {
        data.clear();
        for row in self.cells.chunks_exact(self.area.width.into()) {
            cell.draw_row(row, |color| [palette.index(color)], data);
        }
    }
}

/// An area of cells in pixels. A window has at most 1000 cells from side to side.
fn in_pixels(area: Rect, cell: CellSize) -> Rect {
    let [across, down] = [cell.width, cell.height].map(|pixels| pixels as u16);
    Rect {
        x: area.x * across,
        y: area.y * down,
        width: area.width * across,
        height: area.height * down,
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
            "an animation has at most {most} frames of {width}x{height} cells: show less with --from \
             and --to, or choose a smaller --fps or --size"
        )
    }
}

impl From<TooManyFrames> for Error {
    fn from(error: TooManyFrames) -> Self {
        Self::mistake(error.to_string())
    }
}

fn from_gif(error: gif::EncodingError) -> io::Error {
    match error {
        gif::EncodingError::Io(error) => error,
        other => io::Error::other(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_in_seconds_or_minutes() {
        for (text, expected) in [
            ("0", Some(0.0)),
            ("12.5", Some(12.5)),
            ("1:05.5", Some(65.5)),
            ("90:00", Some(5400.0)),
        ] {
            assert_eq!(time(text).ok(), expected, "{text}");
        }
        for text in ["", "-1", "nan", "inf", "1e9", "1:2:3", ":", "2000:00", "-1:30"] {
            assert!(time(text).is_err(), "{text}");
        }
    }
}
