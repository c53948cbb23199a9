//! `--record`: a file that takes note of a game.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use ratatui::layout::Size;

use super::Error;
use super::asciicast::Asciicast;
use crate::{game, terminal, tui};

/// The ending of the files that hold what the terminal was sent; all others hold scripts.
const ASCIICAST_ENDING: &str = "cast";

/// A file that is written while the game is played.
#[derive(Debug)]
pub(super) struct RecordingFile {
    path: PathBuf,
    output: Output,
}

impl RecordingFile {
    /// Makes the file, empty.
    pub(super) fn create(path: &Path) -> Result<Self, Error> {
        let file = File::create(path).map_err(|error| unwritable(path, &error))?;
        Ok(Self { path: path.to_owned(), output: Output::to(file) })
    }

    /// What writes it.
    pub(super) fn recording(&self) -> tui::Recording {
        let output = self.output.clone();
        if is_asciicast(&self.path) {
            let terminal = TerminalRecorder { output, asciicast: None, start: Instant::now() };
            tui::Recording { terminal: Some(Box::new(terminal)), script: None }
        } else {
            let script = game::Recorder::new(Box::new(output) as Box<dyn Write>);
            tui::Recording { terminal: None, script: Some(script) }
        }
    }

    /// Whether all could be written.
    pub(super) fn finish(self) -> Result<(), Error> {
        match self.output.lock().fault.take() {
            None => Ok(()),
            Some(error) => Err(unwritable(&self.path, &error)),
        }
    }
}

/// Whether a file of that name holds what a terminal was sent.
fn is_asciicast(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(ASCIICAST_ENDING))
}

/// That a file can't be written.
pub(super) fn unwritable(path: &Path, error: &io::Error) -> Error {
    Error::machine(format!("{} can't be written: {error}", path.display()))
}

/// A file that takes everything, and keeps to itself what it could not: a full disk is told of when
/// the game is over.
#[derive(Clone, Debug)]
struct Output(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    file: File,
    fault: Option<io::Error>,
}

impl Output {
    fn to(file: File) -> Self {
        Self(Arc::new(Mutex::new(State { file, fault: None })))
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut state = self.lock();
        if state.fault.is_none() {
            state.fault = state.file.write_all(bytes).err();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Writes what the terminal is sent, at the time when it is.
struct TerminalRecorder {
    output: Output,
    asciicast: Option<Asciicast<Output>>,
    start: Instant,
}

// The output takes everything, so there are no errors to look at.
impl terminal::Recorder for TerminalRecorder {
    fn resized(&mut self, size: Size) {
        let now = self.start.elapsed();
        match &mut self.asciicast {
            Some(asciicast) => _ = asciicast.resized(now, size),
            None => self.asciicast = Asciicast::begin(self.output.clone(), size).ok(),
        }
    }

    fn sent(&mut self, bytes: &[u8]) {
        let now = self.start.elapsed();
        if let Some(asciicast) = &mut self.asciicast {
            _ = asciicast.sent(now, bytes);
        }
    }
}
