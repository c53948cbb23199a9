//! A parser for recordings in the format asciicast v3.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use serde_json::Value;

/// A recording.
pub(crate) struct Asciicast {
    pub(crate) columns: u64,
    pub(crate) rows: u64,
    pub(crate) events: Vec<Event>,
}

/// An event and its time.
#[derive(Clone, Debug)]
pub(crate) struct Event {
    /// The time since the start, in milliseconds.
    pub(crate) time: u64,
    pub(crate) code: String,
    pub(crate) data: String,
}

impl Asciicast {
    /// Parses `file`, each line of which is JSON.
    pub(crate) fn read(file: &str) -> Self {
        let mut lines = file.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let header = lines.next().unwrap();
        assert_eq!(header["version"], 3);
        let mut time = 0;
        let events = lines.map(|line| {
            time += (line[0].as_f64().unwrap() * 1000.0).round() as u64;
            let text = |index: usize| line[index].as_str().unwrap().to_owned();
            Event { time, code: text(1), data: text(2) }
        });
        let number = |name: &str| header["term"][name].as_u64().unwrap();
        Self { columns: number("cols"), rows: number("rows"), events: events.collect() }
    }

    /// Everything that was sent to the terminal.
    pub(crate) fn sent(&self) -> String {
        let sent = self.events.iter().filter(|event| event.code == "o");
        sent.map(|event| event.data.as_str()).collect()
    }
}
