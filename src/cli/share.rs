//! `cellcaster share`: part of a script as an animation or an asciicast.
//!
//! The file is made in memory, so it is complete or absent, and its size is known: at most [`MAX_BYTES`].

use std::fmt;
use std::io::{self, IsTerminal, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, ValueEnum, ValueHint};
use crossterm::cursor::{Hide, Show};
use crossterm::queue;
use crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen};
use ratatui::backend::Backend;
use ratatui::buffer::Buffer;

use super::animation::{AnimationFormat, Excerpt, Frames, MAX_GIF_RATE};
use super::options::{LevelOptions, ViewOptions, fidelity};
use super::output_file::{OutputFile, print};
use super::recording::Asciicast;
use super::replay::{is_room_recording, load};
use super::{Error, level};
use crate::app::{MAX_PLAYBACK_STEPS, Replay, Settings};
use crate::game::Script;
use crate::terminal::{CellWriter, Fidelity};

/// Make an animation of part of a script
///
/// Browsers and chat programs show gif and png, with 8x16 pixels for each cell and 256 colours; png is smaller. Browsers
/// show svg, which is sharp at every size. A cast is for asciinema. replay shows the times for --from and --to.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster share walk.script --from 1:05 --to 1:12 --output film.gif
  cellcaster share walk.script my.toml --format png > film.png
  cellcaster share walk.script --output walk.cast")]
pub(crate) struct ShareCommand {
    /// The script
    #[arg(value_hint = ValueHint::FilePath)]
    script: PathBuf,
    /// The output file [default: standard output]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,
    /// The output format [default: from the name of the output file]
    #[arg(long, value_enum)]
    format: Option<ShareFormat>,
    #[command(flatten)]
    excerpt: Excerpt,
    #[command(flatten)]
    view: ViewOptions,
    /// The fidelity of colours in a cast: exact, high, low, or the largest colour error, from 0 to 255
    #[arg(long, value_name = "LEVEL", default_value = "exact", value_parser = fidelity)]
    fidelity: Fidelity,
    #[command(flatten)]
    place: LevelOptions,
}

/// The format of an animation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum ShareFormat {
    Gif,
    Png,
    Svg,
    Cast,
}

/// The maximum size of a file.
const MAX_BYTES: usize = 64 << 20;

/// Writes the animation, and prints its size.
pub(crate) fn run(options: &ShareCommand) -> Result<(), Error> {
    if is_room_recording(&options.script) {
        return Err(Error::mistake(
            "only cellcaster-server can draw the recording of a room: run cellcaster-server replay \
             --png",
        ));
    }
    let format = format(options)?;
    let script = load(&options.script)?;
    if script.steps() > MAX_PLAYBACK_STEPS && !options.excerpt.has_end() {
        return Err(Error::mistake(format!(
            "{} lasts longer than 24 hours: name the end of the part with --to",
            options.script.display()
        )));
    }
    let (bytes, length) = made(options, format, &script)?;
    match &options.output {
        None => print(&bytes),
        Some(path) => {
            OutputFile::create(path)?.write(|output| output.write_all(&bytes))?;
            print(described(path, bytes.len(), length, &options.excerpt).as_bytes())
        }
    }
}

/// The format in the options, or else in the name of the output.
fn format(options: &ShareCommand) -> Result<ShareFormat, Error> {
    let ending = options.output.as_deref().and_then(Path::extension);
    let ending = ending.and_then(|ending| ending.to_str());
    let of_file = ending.and_then(|ending| ShareFormat::from_str(ending, true).ok());
    let format = options.format.or(of_file).ok_or_else(|| {
        Error::mistake(
            "choose a format: --format gif, png, svg or cast, or an --output with that ending",
        )
    })?;
    let rate = options.excerpt.frames_per_second.get();
    if format == ShareFormat::Gif && rate > MAX_GIF_RATE {
        return Err(Error::mistake(format!(
            "a GIF has at most {MAX_GIF_RATE} frames a second: choose a smaller --fps, or png"
        )));
    }
    if format != ShareFormat::Cast && options.output.is_none() && io::stdout().is_terminal() {
        return Err(Error::mistake(
            "standard output is a terminal, which cannot show the picture: name a file with \
             --output",
        ));
    }
    Ok(format)
}

/// The bytes of the animation, and its number of frames.
fn made(
    options: &ShareCommand,
    format: ShareFormat,
    script: &Script,
) -> Result<(Vec<u8>, u64), Error> {
    let ShareCommand { excerpt, view, .. } = options;
    let (header, part) = (script.header(), excerpt.frames()?);
    let levels = level::of_script(&options.place, header)?;
    let settings = Settings {
        field_of_view: view.field_of_view.unwrap_or_default(),
        depth: Some(view.depth.unwrap_or_default()),
        difficulty: Some(header.rules().difficulty),
        ..Settings::default()
    };
    let mut replay = Replay::new(levels, settings, excerpt.size);
    let mut output = Limited::default();
    let mut show = |show: &mut dyn FnMut(u64, &Buffer) -> Result<(), Error>| {
        let shown =
            replay.play_from(script, excerpt.frames_per_second, part.start, |frame, _, picture| {
                // No error ends the part early.
                if frame < part.end { show(frame, picture).map_err(Some) } else { Err(None) }
            });
        shown.or_else(|error| error.map_or(Ok(()), Err))
    };
    let animation = match format {
        ShareFormat::Gif => AnimationFormat::Gif,
        ShareFormat::Png => AnimationFormat::Png,
        ShareFormat::Svg => AnimationFormat::Svg,
        ShareFormat::Cast => {
            let mut cast = limited(CastWriter::begin(&mut output, options))?;
            show(&mut |frame, picture| limited(cast.draw(frame - part.start, picture)))?;
            let frames = limited(cast.finish())?;
            return if frames > 0 { Ok((output.bytes, frames)) } else { Err(Frames::none()) };
        }
    };
    let mut frames = Frames::new(excerpt)?;
    show(&mut |frame, picture| Ok(frames.push(frame, picture)?))?;
    frames.check()?;
    limited(frames.encode(animation, &mut output))?;
    Ok((output.bytes, frames.length()))
}

/// A cast that is being written.
struct CastWriter<'o> {
    asciicast: Asciicast<&'o mut Limited>,
    writer: CellWriter<Vec<u8>>,
    before: Buffer,
    frames: u64,
    frames_per_second: u32,
}

impl<'o> CastWriter<'o> {
    fn begin(output: &'o mut Limited, options: &ShareCommand) -> io::Result<Self> {
        let Excerpt { size, frames_per_second, .. } = options.excerpt;
        let (mut asciicast, mut bytes) = (Asciicast::begin(output, size)?, Vec::new());
        queue!(bytes, EnterAlternateScreen, Hide)?;
        asciicast.sent(Duration::ZERO, &bytes)?;
        let mut writer = CellWriter::new(Vec::new(), size);
        writer.set_fidelity(options.fidelity);
        let before = Buffer::empty(size.into());
        let frames_per_second = frames_per_second.get();
        Ok(Self { asciicast, writer, before, frames: 0, frames_per_second })
    }

    /// Draws frame `frame` of the part.
    fn draw(&mut self, frame: u64, picture: &Buffer) -> io::Result<()> {
        let Self { asciicast, writer, before, .. } = self;
        writer.draw(before.diff(picture).into_iter())?;
        writer.flush()?;
        before.clone_from(picture);
        let bytes = mem::take(writer.output_mut());
        self.frames = frame + 1;
        if bytes.is_empty() {
            return Ok(());
        }
        asciicast.sent(Duration::from_secs(frame) / self.frames_per_second, &bytes)
    }

    /// Ends the cast, and returns its number of frames.
    fn finish(self) -> io::Result<u64> {
        let Self { mut asciicast, frames, frames_per_second, .. } = self;
        let Some(last) = frames.checked_sub(1) else { return Ok(0) };
        let mut bytes = Vec::new();
        queue!(bytes, Show, LeaveAlternateScreen)?;
        asciicast.sent(Duration::from_secs(last) / frames_per_second, &bytes)?;
        Ok(frames)
    }
}

/// An output in memory that takes at most [`MAX_BYTES`].
#[derive(Debug, Default)]
struct Limited {
    bytes: Vec<u8>,
}

impl Write for Limited {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.bytes.len() + bytes.len() > MAX_BYTES {
            return Err(io::Error::from(io::ErrorKind::FileTooLarge));
        }
        self.bytes.extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The result of writing to an output in memory, with a sentence if the output is full.
fn limited<T>(result: io::Result<T>) -> Result<T, Error> {
    result.map_err(|error| match error.kind() {
        io::ErrorKind::FileTooLarge => Error::mistake(format!(
            "the file would be larger than {} MB: show less with --from and --to, or choose a smaller \
             --fps or --size",
            MAX_BYTES >> 20
        )),
        _ => Error::machine(error.to_string()),
    })
}

/// A line about a file of `bytes` bytes that shows `frames` frames of the replay.
fn described(path: &Path, bytes: usize, frames: u64, excerpt: &Excerpt) -> String {
    let rate = excerpt.frames_per_second.get();
    let (width, height) = (excerpt.size.width, excerpt.size.height);
    let seconds = (frames * 10 / u64::from(rate)) as f64 / 10.0;
    let path = path.display().to_string().replace(char::is_control, "?");
    let size = fmt::from_fn(|f| match bytes {
        0..10_000_000 => write!(f, "{} kB", bytes.div_ceil(1000)),
        _ => write!(f, "{} MB", bytes.div_ceil(1_000_000)),
    });
    format!("{path}: {size}, {seconds} s, {width}×{height} cells, {rate} frames a second\n")
}
