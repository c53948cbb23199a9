//! `snapshot --watch`: the frame is drawn again whenever the map changes.
//!
//! In a terminal, text is drawn in the same place each time, with faults over it. In any other
//! output, pictures follow each other, and faults go to standard error. The terminal's modes are
//! not changed, so that nothing has to be restored when Ctrl-C ends the program.

use std::io::{self, IsTerminal, Write};
use std::thread;
use std::time::Duration;

use ratatui::layout::Size;

use super::draw;
use crate::cli::arguments::{self, Format, Snapshot};
use crate::cli::{Error, level};
use crate::fault::{Faults, printable, printable_lines};
use crate::map::Level;
use crate::render::DynCaster;

/// The interval between checks for changes.
const INTERVAL: Duration = Duration::from_millis(200);

/// Draws the frame, and draws it again after each change, until the program is ended.
pub(crate) fn run(mut options: Snapshot, caster: &DynCaster) -> Result<(), Error> {
    let (mut level, mut watch) = level::watch(options.map.as_deref(), options.generated)?;
    let output = Output::of(&options);
    output.show(&level, &mut options, caster)?;
    loop {
        thread::sleep(INTERVAL);
        match watch.change() {
            Some(Ok(changed)) => {
                level = changed;
                output.show(&level, &mut options, caster)?;
            }
            Some(Err(faults)) => output.report(faults)?,
            None if output.has_another_size(&options) => {
                output.show(&level, &mut options, caster)?;
            }
            None => {}
        }
    }
}

/// The output of the pictures.
struct Output {
    /// Whether the output is a terminal, where all pictures have the same place.
    is_terminal: bool,
    /// Whether pictures have the size of the window.
    fits_window: bool,
}

impl Output {
    fn of(options: &Snapshot) -> Self {
        let is_text = matches!(options.format, Format::Text | Format::Ansi) || options.explain;
        let is_terminal = is_text && io::stdout().is_terminal();
        Self { is_terminal, fits_window: is_terminal && options.size.is_none() }
    }

    fn show(&self, level: &Level, options: &mut Snapshot, caster: &DynCaster) -> Result<(), Error> {
        if self.fits_window {
            options.size = window();
        }
        if self.is_terminal {
            write("\x1b[2J\x1b[H")?;
        }
        draw(level, options, caster)
    }

    fn has_another_size(&self, options: &Snapshot) -> bool {
        self.fits_window
            && window().map(arguments::Size::cells) != options.size.map(arguments::Size::cells)
    }

    fn report(&self, faults: Faults) -> Result<(), Error> {
        if !self.is_terminal || !io::stderr().is_terminal() {
            Error::from(faults).warn();
            return Ok(());
        }
        // At the top of the picture. The cursor stays below the picture.
        write("\x1b7\x1b[H")?;
        let report = printable_lines(&faults.to_string());
        let room = window().map_or(10, |size| usize::from(size.rows) / 2).max(1);
        for line in report.lines().take(room) {
            _ = write!(io::stderr(), "\x1b[2K{line}\r\n");
        }
        if report.lines().count() > room {
            _ = write!(io::stderr(), "\x1b[2K{}\r\n", printable(&faults.summary()));
        }
        write("\x1b8")
    }
}

/// The size of the window, less one row for the cursor.
fn window() -> Option<arguments::Size> {
    let (columns, rows) = crossterm::terminal::size().ok()?;
    let Size { width, height } = Size::new(columns.clamp(1, 4096), rows.clamp(2, 4096) - 1);
    Some(arguments::Size { columns: width, rows: height })
}

fn write(text: &str) -> Result<(), Error> {
    let mut output = io::stdout().lock();
    let written = output.write_all(text.as_bytes()).and_then(|()| output.flush());
    written.map_err(|error| Error::of_output(&error))
}
