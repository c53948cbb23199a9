//! `snapshot --watch`: the frame again whenever the map changes.
//!
//! Text in a terminal is drawn in the same place each time, and faults over it. Anywhere else, one
//! picture follows the other, and faults go to standard error. Nothing about the terminal is changed, so
//! there is nothing to give back when Ctrl-C ends it.

use std::io::{self, IsTerminal, Write};
use std::thread;
use std::time::Duration;

use ratatui::layout::Size;

use super::draw;
use crate::cli::arguments::{self, Format, Snapshot};
use crate::cli::{Error, level};
use crate::fault::Faults;
use crate::map::Level;

/// Between two looks for changes.
const INTERVAL: Duration = Duration::from_millis(200);

/// Shows the frame, and shows it again, until somebody ends the program.
pub(super) fn run(mut options: Snapshot) -> Result<(), Error> {
    let (mut level, mut watch) = level::watch(options.map.as_deref(), options.generated)?;
    let place = Place::of(&options);
    place.show(&level, &mut options)?;
    loop {
        thread::sleep(INTERVAL);
        match watch.change() {
            Some(Ok(changed)) => {
                level = changed;
                place.show(&level, &mut options)?;
            }
            Some(Err(faults)) => place.tell(&faults)?,
            None if place.has_another_size(&options) => place.show(&level, &mut options)?,
            None => {}
        }
    }
}

/// Where the pictures go.
struct Place {
    /// Whether that is a terminal, in which they have one place.
    is_terminal: bool,
    /// Whether they are as large as its window.
    fits_window: bool,
}

impl Place {
    fn of(options: &Snapshot) -> Self {
        let is_text = matches!(options.format, Format::Text | Format::Ansi) || options.explain;
        let is_terminal = is_text && io::stdout().is_terminal();
        Self { is_terminal, fits_window: is_terminal && options.size.is_none() }
    }

    fn show(&self, level: &Level, options: &mut Snapshot) -> Result<(), Error> {
        if self.fits_window {
            options.size = window();
        }
        if self.is_terminal {
            write("\x1b[2J\x1b[H")?;
        }
        draw(level, options)
    }

    fn has_another_size(&self, options: &Snapshot) -> bool {
        self.fits_window
            && window().map(arguments::Size::cells) != options.size.map(arguments::Size::cells)
    }

    fn tell(&self, faults: &Faults) -> Result<(), Error> {
        if !self.is_terminal || !io::stderr().is_terminal() {
            // Where even that is closed, nobody is there to be told.
            _ = writeln!(io::stderr(), "{faults}");
            return Ok(());
        }
        // Over the picture's head: the cursor is kept below it.
        write("\x1b7\x1b[H")?;
        let report = faults.to_string();
        let room = window().map_or(10, |size| usize::from(size.rows) / 2).max(1);
        for line in report.lines().take(room) {
            _ = write!(io::stderr(), "\x1b[2K{line}\r\n");
        }
        if report.lines().count() > room {
            _ = write!(io::stderr(), "\x1b[2K{}\r\n", faults.summary());
        }
        write("\x1b8")
    }
}

/// The size of the window, but for a row that the cursor stands in.
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
