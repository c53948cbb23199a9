//! `--record`: records a game in a file, as a script or in asciicast v3 format.
//!
//! The first line of an asciicast is a header. Each later line is an event: the seconds since the
//! previous event, the kind of event, and its data. Each line is written immediately and without
//! buffering, so the file is valid after each line, even if the program is killed. A file does not
//! contain the time of day, so the same play produces the same file.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use serde_json::json;

use super::Error;
use super::output_file::unwritable;
use crate::app;
use crate::app::store::private;
use crate::game;
use crate::terminal;

/// The kind of content in a file, according to its extension.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RecordingKind {
    /// The terminal's output.
    Asciicast,
    /// The player's intents.
    Script,
}

/// A file that is written during the game.
#[derive(Debug)]
pub(crate) struct RecordingFile {
    path: PathBuf,
    kind: RecordingKind,
    output: RecordingOutput,
}

impl RecordingFile {
    /// Creates an empty file. Replaces an existing file only if `overwrites` is set, and only once
    /// the game starts.
    pub(crate) fn create(path: &Path, overwrites: bool) -> Result<Self, Error> {
        let kind = RecordingKind::of(path)?;
        let mut options = OpenOptions::new();
        if overwrites {
            options.create(true).truncate(false);
        } else {
            options.create_new(true);
        }
        // A recording may contain chat messages between players.
        private::restrict_file(&mut options);
        let file = options.write(true).open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => Error::mistake(format!(
                "{} already exists: name another file, or replace it with --force",
                path.display()
            )),
            _ => unwritable(path, &error),
        })?;
        Ok(Self { path: path.to_owned(), kind, output: RecordingOutput::to(file) })
    }

    /// Returns true if a file with this name contains intents.
    pub(crate) fn is_script(path: &Path) -> bool {
        RecordingKind::of(path).is_ok_and(|kind| kind == RecordingKind::Script)
    }

    /// The recorder that writes the file. A script begins with `header`.
    pub(crate) fn recording(&self, header: game::Header) -> app::Recording {
        let output = self.output.clone();
        if self.kind == RecordingKind::Asciicast {
            let terminal = TerminalRecorder { output, asciicast: None, start: Instant::now() };
            app::Recording { terminal: Some(Box::new(terminal)), script: None }
        } else {
            let script =
                game::ScriptWriter::with_header(Box::new(output) as Box<dyn Write>, header);
            app::Recording { terminal: None, script: Some(script) }
        }
    }

    /// Returns the first write error, if there was one. Removes an empty file, because the game did
    /// not start.
    pub(crate) fn finish(self) -> Result<(), Error> {
        let mut state = self.output.lock();
        let is_empty = || fs::metadata(&self.path).is_ok_and(|it| it.is_file() && it.len() == 0);
        if is_empty() {
            // An empty file would stand in the way of the next recording.
            _ = fs::remove_file(&self.path);
        }
        match state.fault.take() {
            None => Ok(()),
            Some(error) => Err(unwritable(&self.path, &error)),
        }
    }
}

impl RecordingKind {
    fn of(path: &Path) -> Result<Self, Error> {
        let ending = path.extension().unwrap_or_default();
        if ending.eq_ignore_ascii_case("cast") {
            Ok(Self::Asciicast)
        } else if ending.eq_ignore_ascii_case("script") {
            Ok(Self::Script)
        } else {
            Err(Error::mistake(format!(
                "--record takes a file that ends in .cast (for the terminal's output) or in \
                 .script (for your actions), not \"{}\"",
                path.display()
            )))
        }
    }
}

/// A file that accepts all writes and stores the first error. A full disk is reported after the
/// game.
#[derive(Clone, Debug)]
struct RecordingOutput(Arc<Mutex<RecordingState>>);

#[derive(Debug)]
struct RecordingState {
    file: File,
    /// `true` while nothing has been written and the file may still have its old content.
    is_untouched: bool,
    fault: Option<io::Error>,
}

impl RecordingOutput {
    fn to(file: File) -> Self {
        Self(Arc::new(Mutex::new(RecordingState { file, is_untouched: true, fault: None })))
    }

    fn lock(&self) -> MutexGuard<'_, RecordingState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl RecordingState {
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        // A pipe or a device has no length.
        if mem::take(&mut self.is_untouched) && self.file.metadata()?.is_file() {
            self.file.set_len(0)?;
        }
        self.file.write_all(bytes)
    }
}

impl Write for RecordingOutput {
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

/// Records the terminal's output with the time of each write.
struct TerminalRecorder {
    output: RecordingOutput,
    asciicast: Option<Asciicast<RecordingOutput>>,
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

/// A writer for asciicasts.
#[derive(Debug)]
pub(crate) struct Asciicast<W> {
    output: W,
    /// The time of the previous event as written to the file, in milliseconds.
    last: u128,
}

impl<W: Write> Asciicast<W> {
    /// Starts the recording of a terminal with this size.
    pub(crate) fn begin(output: W, size: Size) -> io::Result<Self> {
        let mut asciicast = Self { output, last: 0 };
        let terminal = json!({ "cols": size.width, "rows": size.height });
        asciicast.write_line(json!({ "version": 3, "term": terminal }).to_string())?;
        Ok(asciicast)
    }

    /// Records that `bytes` were sent at `time`, counted from the start. The bytes must be whole
    /// characters.
    pub(crate) fn sent(&mut self, time: Duration, bytes: &[u8]) -> io::Result<()> {
        self.write_event(time, "o", &String::from_utf8_lossy(bytes))
    }

    /// Records that the terminal's size changed at `time`.
    pub(crate) fn resized(&mut self, time: Duration, size: Size) -> io::Result<()> {
        self.write_event(time, "r", &format!("{}x{}", size.width, size.height))
    }

    fn write_event(&mut self, time: Duration, code: &str, data: &str) -> io::Result<()> {
        // The times are rounded, not the intervals, because rounding errors of intervals would add
        // up.
        let now = time.as_millis().max(self.last);
        let interval = now - self.last;
        self.last = now;
        let data = json!(data);
        let (seconds, milliseconds) = (interval / 1000, interval % 1000);
        self.write_line(format!("[{seconds}.{milliseconds:03}, \"{code}\", {data}]"))
    }

    fn write_line(&mut self, mut line: String) -> io::Result<()> {
        line.push('\n');
        self.output.write_all(line.as_bytes())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use serde_json::Value;

    use super::*;

    #[test]
    fn the_format_is_asciicast_v3() {
        let mut file = Vec::new();
        let mut asciicast = Asciicast::begin(&mut file, Size::new(80, 24)).unwrap();
        asciicast.sent(Duration::from_micros(33_333), "\x1b[1;1H▀\"".as_bytes()).unwrap();
        asciicast.resized(Duration::from_micros(66_666), Size::new(100, 50)).unwrap();
        asciicast.sent(Duration::from_secs(61), b"").unwrap();
        insta::assert_snapshot!(String::from_utf8(file).unwrap(), @r#"
        {"term":{"cols":80,"rows":24},"version":3}
        [0.033, "o", "\u001b[1;1H▀\""]
        [0.033, "r", "100x50"]
        [60.934, "o", ""]
        "#);
    }

    proptest! {
        #[test]
        fn every_text_is_recorded_at_its_time(events: Vec<(u16, String)>) {
            let mut file = Vec::new();
            let mut asciicast = Asciicast::begin(&mut file, Size::new(1, 1))?;
            let mut now = Duration::ZERO;
            for (microseconds, text) in &events {
                now += Duration::from_micros((*microseconds).into());
                asciicast.sent(now, text.as_bytes())?;
            }
            let file = String::from_utf8(file)?;
            let lines: Vec<Value> =
                file.lines().skip(1).map(|line| serde_json::from_str(line).unwrap()).collect();
            let texts: Vec<&str> = lines.iter().map(|line| line[2].as_str().unwrap()).collect();
            prop_assert!(texts.iter().eq(events.iter().map(|(_, text)| text)));
            let total: f64 = lines.iter().map(|line| line[0].as_f64().unwrap()).sum();
            prop_assert!((total - now.as_secs_f64()).abs() < 0.0011);
        }
    }
}
