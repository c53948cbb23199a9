//! `cellcaster replay`: plays a script off screen into a recording.

use std::cell::Cell;
use std::fs::File;
use std::io::{self, BufWriter, Read, Write};
use std::path::Path;
use std::rc::Rc;
use std::time::Duration;

use crossterm::cursor::{Hide, Show};
use crossterm::queue;
use crossterm::terminal::{EnterAlternateScreen, LeaveAlternateScreen};
use ratatui::backend::Backend;
use ratatui::buffer::Buffer;

use super::arguments::Replay;
use super::asciicast::Asciicast;
use super::external::External;
use super::output_file::OutputFile;
use super::{Error, level, script, verify};
use crate::app;
use crate::app::Settings;
use crate::game::Script;
use crate::terminal::CellWriter;

/// The beginning of the recording of a server's room, which its version follows.
pub const ROOM_RECORDING: &str = "cellcaster-room ";

/// Writes the recording that `options` request.
pub(crate) fn run(options: &Replay) -> Result<(), Error> {
    if is_room_recording(&options.script) {
        let words = [Some(options.script.clone().into_os_string()), options.map.clone()];
        return External::room_replay(words.into_iter().flatten()).run();
    }
    let script = script::load(&options.script)?;
    if options.verifies {
        return verify::run(options, &script);
    }
    let levels = level::of_script(options.map.as_deref(), options.generated, script.header())?;
    let settings = Settings {
        field_of_view: options.field_of_view,
        depth: Some(options.depth),
        ..Settings::default()
    };
    let size = options.size.cells();
    let mut replay = app::Replay::new(levels, settings, size);
    match &options.cast {
        None => write(&mut replay, &script, options, BufWriter::new(io::stdout().lock()))
            .map_err(|error| Error::of_output(&error)),
        Some(path) => {
            OutputFile::create(path)?.write(|output| write(&mut replay, &script, options, output))
        }
    }
}

fn write(
    replay: &mut app::Replay,
    script: &Script,
    options: &Replay,
    output: impl Write,
) -> io::Result<()> {
    let size = options.size.cells();
    let now = Rc::new(Cell::new(Duration::ZERO));
    let mut screen = Screen { asciicast: Asciicast::begin(output, size)?, now: Rc::clone(&now) };
    screen.send(|bytes| queue!(bytes, EnterAlternateScreen, Hide))?;
    let mut writer = CellWriter::new(screen, size);
    writer.set_fidelity(options.fidelity);
    let mut before = Buffer::empty(size.into());
    let frames_per_second = options.frames_per_second.get();
    replay.play(script, frames_per_second, |frame, _, picture| {
        now.set(Duration::from_secs(frame) / frames_per_second.get());
        writer.draw(before.diff(picture).into_iter())?;
        writer.flush()?;
        before.clone_from(picture);
        Ok::<(), io::Error>(())
    })?;
    let mut screen = writer.into_output();
    screen.send(|bytes| queue!(bytes, Show, LeaveAlternateScreen))?;
    screen.asciicast.finish()
}

/// A terminal whose output becomes events: each write is one event at the time `now`.
struct Screen<W> {
    asciicast: Asciicast<W>,
    now: Rc<Cell<Duration>>,
}

impl<W: Write> Screen<W> {
    fn send(&mut self, queue: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> io::Result<()> {
        let mut bytes = Vec::new();
        queue(&mut bytes)?;
        self.write_all(&bytes)
    }
}

impl<W: Write> Write for Screen<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.asciicast.sent(self.now.get(), bytes)?;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Whether the file is the recording of a server's room, which has the game's rules and more.
fn is_room_recording(path: &Path) -> bool {
    let mut beginning = [0; ROOM_RECORDING.len()];
    // A file that cannot be read is reported where scripts are read.
    path.is_file()
        && File::open(path).is_ok_and(|mut file| file.read_exact(&mut beginning).is_ok())
        && beginning == ROOM_RECORDING.as_bytes()
}
