//! Logs: the ordered entries of a round.
//!
//! A log with the header of its round is the round: whoever has both has the room, bit for bit. A
//! room is changed by nothing else. Copies of a room that send each other their states were
//! refused: a state has a thousand times the bytes of what the members want.

use std::collections::VecDeque;
use std::io::{self, Write};

use super::entry::Entry;
use super::header::Header;

/// An ordered log of a room.
pub(crate) trait Log: Send {
    /// Begins the log of a round.
    ///
    /// # Errors
    /// If the log cannot be written.
    fn begin(&mut self, header: &Header) -> io::Result<()>;

    /// Adds an entry after all others. Its step is not before that of the last one.
    ///
    /// # Errors
    /// If the log cannot be written.
    fn append(&mut self, entry: Entry) -> io::Result<()>;

    /// Writes out what waits in memory.
    ///
    /// # Errors
    /// If the log cannot be written.
    fn flush(&mut self) -> io::Result<()>;

    /// The next entry that takes effect at `step` or before; `None` if there is none.
    fn next(&mut self, step: u64) -> Option<Entry>;
}

/// The log of a room in one process: a queue.
#[derive(Debug, Default)]
pub(crate) struct Queue {
    entries: VecDeque<Entry>,
}

impl Log for Queue {
    fn begin(&mut self, _: &Header) -> io::Result<()> {
        self.entries.clear();
        Ok(())
    }

    fn append(&mut self, entry: Entry) -> io::Result<()> {
        self.entries.push_back(entry);
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }

    fn next(&mut self, step: u64) -> Option<Entry> {
        self.entries.pop_front_if(|entry| entry.step <= step)
    }
}

/// A log that is written as text, too, so that the room can be played again.
#[derive(Debug)]
pub(crate) struct Recorded<L, W> {
    log: L,
    output: W,
}

impl<L: Log, W: Write> Recorded<L, W> {
    /// Records `log` in `output`.
    pub(crate) fn new(log: L, output: W) -> Self {
        Self { log, output }
    }

    /// Where it is recorded.
    pub(crate) fn output(&self) -> &W {
        &self.output
    }
}

impl<L: Log, W: Write + Send> Log for Recorded<L, W> {
    fn begin(&mut self, header: &Header) -> io::Result<()> {
        self.log.begin(header)?;
        self.output.write_all(header.to_string().as_bytes())?;
        self.output.flush()
    }

    /// An entry that cannot be recorded is in the log nevertheless.
    fn append(&mut self, entry: Entry) -> io::Result<()> {
        let line = format!("{entry}\n");
        self.log.append(entry)?;
        self.output.write_all(line.as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.output.flush()
    }

    fn next(&mut self, step: u64) -> Option<Entry> {
        self.log.next(step)
    }
}

/// The rounds of a recorded log: headers, each with its entries. `None` if a line is neither.
pub(crate) fn parse(text: &str) -> Option<Vec<(Header, Vec<Entry>)>> {
    let mut rounds = Vec::new();
    let mut lines = text.lines().peekable();
    while lines.peek().is_some() {
        let is_header = |line: &&str| !line.starts_with(|first: char| first.is_ascii_digit());
        let mut head = Vec::new();
        while let Some(line) = lines.next_if(is_header) {
            if line.starts_with("cellcaster-room") && !head.is_empty() {
                // A round without entries.
                rounds.push((Header::parse(head.drain(..))?, Vec::new()));
            }
            head.push(line);
        }
        let mut entries = Vec::new();
        while let Some(line) = lines.next_if(|line| !is_header(line)) {
            entries.push(Entry::parse(line)?);
        }
        rounds.push((Header::parse(head)?, entries));
    }
    Some(rounds)
}
