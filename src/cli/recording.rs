//! `--record`: a recording of a game in a file.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use ratatui::layout::Size;

use super::Error;
use super::asciicast::Asciicast;
use super::output_file::unwritable;
use crate::app;
use crate::app::store::private;
use crate::game;
use crate::terminal;

/// The content of a file, by its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// The terminal's output.
    Asciicast,
    /// The player's intents.
    Script,
}

/// A file that is written during the game.
#[derive(Debug)]
pub(crate) struct RecordingFile {
    path: PathBuf,
    kind: Kind,
    output: Output,
}

impl RecordingFile {
    /// Creates an empty file. An existing file is replaced only if `overwrites` is set, and when
    /// the game starts.
    pub(crate) fn create(path: &Path, overwrites: bool) -> Result<Self, Error> {
        let kind = Kind::of(path)?;
        let mut options = OpenOptions::new();
        if overwrites {
            options.create(true).truncate(false);
        } else {
            options.create_new(true);
        }
        // What players say to each other is in it.
        private::restrict_file(&mut options);
        let file = options.write(true).open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::mistake(format!(
                "{} is there already: name another file, or replace it with --force",
                path.display()
            )),
            _ => unwritable(path, &error),
        })?;
        Ok(Self { path: path.to_owned(), kind, output: Output::to(file) })
    }

    /// Whether a file with this name contains intents.
    pub(crate) fn is_script(path: &Path) -> bool {
        Kind::of(path).is_ok_and(|kind| kind == Kind::Script)
    }

    /// The recorder that writes the file.
    /// A script begins with `header`.
    pub(crate) fn recording(&self, header: game::Header) -> app::Recording {
        let output = self.output.clone();
        if self.kind == Kind::Asciicast {
            let terminal = TerminalRecorder { output, asciicast: None, start: Instant::now() };
            app::Recording { terminal: Some(Box::new(terminal)), script: None }
        } else {
            let script = game::Recorder::with_header(Box::new(output) as Box<dyn Write>, header);
            app::Recording { terminal: None, script: Some(script) }
        }
    }

    /// Returns the first error of writing, if there was one. A file without content is removed,
    /// because the game did not start.
    pub(crate) fn finish(self) -> Result<(), Error> {
        let mut state = self.output.lock();
        let is_empty = || fs::metadata(&self.path).is_ok_and(|it| it.is_file() && it.len() == 0);
        if is_empty() {
            // The empty file would prevent the next recording.
            _ = fs::remove_file(&self.path);
        }
        match state.fault.take() {
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

/// A file that accepts all writes and stores the first error. A full disk is reported after the
/// game.
#[derive(Clone, Debug)]
struct Output(Arc<Mutex<State>>);

#[derive(Debug)]
struct State {
    file: File,
    /// Whether nothing has been written yet, and the file may still have its old content.
    is_untouched: bool,
    fault: Option<io::Error>,
}

impl Output {
    fn to(file: File) -> Self {
        Self(Arc::new(Mutex::new(State { file, is_untouched: true, fault: None })))
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        // A pipe or a device has no length.
        if mem::take(&mut self.is_untouched) && self.file.metadata()?.is_file() {
            self.file.set_len(0)?;
        }
        self.file.write_all(bytes)
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut state = self.lock();
        if state.fault.is_none() {
            state.fault = state.write(bytes).err();
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Records the terminal's output with its times.
struct TerminalRecorder {
    output: Output,
    asciicast: Option<Asciicast<Output>>,
    start: Instant,
}

// The output accepts all writes, so there are no errors to handle.
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
