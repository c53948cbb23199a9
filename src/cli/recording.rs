//! `--record`: a file that takes note of a game.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use ratatui::layout::Size;

use super::Error;
use super::asciicast::Asciicast;
use crate::{app, game, terminal};

/// What a file holds, by its ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// What the terminal was sent.
    Asciicast,
    /// What the player did.
    Script,
}

/// A file that is written while the game is played.
#[derive(Debug)]
pub(super) struct RecordingFile {
    path: PathBuf,
    kind: Kind,
    output: Output,
}

impl RecordingFile {
    /// Makes the file, empty. One that is there already is replaced only if this `overwrites`.
    pub(super) fn create(path: &Path, overwrites: bool) -> Result<Self, Error> {
        let kind = Kind::of(path)?;
        let mut options = OpenOptions::new();
        if overwrites {
            options.create(true).truncate(true);
        } else {
            options.create_new(true);
        }
        let file = options.write(true).open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::mistake(format!(
                "{} is there already: name another file, or replace it with --force",
                path.display()
            )),
            _ => unwritable(path, &error),
        })?;
        Ok(Self { path: path.to_owned(), kind, output: Output::to(file) })
    }

    /// Whether a file of that name holds what the player did.
    pub(super) fn is_script(path: &Path) -> bool {
        Kind::of(path).is_ok_and(|kind| kind == Kind::Script)
    }

    /// What writes it.
    pub(super) fn recording(&self) -> app::Recording {
        let output = self.output.clone();
        if self.kind == Kind::Asciicast {
            let terminal = TerminalRecorder { output, asciicast: None, start: Instant::now() };
            app::Recording { terminal: Some(Box::new(terminal)), script: None }
        } else {
            let script = game::Recorder::new(Box::new(output) as Box<dyn Write>);
            app::Recording { terminal: None, script: Some(script) }
        }
    }

    /// Whether all could be written. A file that nothing was written to is removed: the game did not
    /// begin.
    pub(super) fn finish(self) -> Result<(), Error> {
        if fs::metadata(&self.path).is_ok_and(|file| file.is_file() && file.len() == 0) {
            // It only would have been in the way of the next one.
            _ = fs::remove_file(&self.path);
        }
        match self.output.lock().fault.take() {
            None => Ok(()),
            Some(error) => Err(unwritable(&self.path, &error)),
        }
    }
}

impl Kind {
    fn of(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("cast") {
            Ok(Self::Asciicast)
        } else if ending.eq_ignore_ascii_case("script") {
            Ok(Self::Script)
        } else {
            Err(Error::mistake(format!(
                "--record takes a file that ends in .cast, for what the terminal is sent, or in \
                 .script, for what you do, not \"{}\"",
                path.display()
            )))
        }
    }
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
