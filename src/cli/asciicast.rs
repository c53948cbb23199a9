//! Recordings of a terminal's output in the format asciicast v3.
//!
//! The first line is a header. Each following line is an event: the seconds since the previous
//! event, the kind of event, and its data. Each line is written at once and without buffering, so
//! that the file is valid after each line, even if the program is killed.
//!
//! A file does not contain the time of day: the same play makes the same file.

use std::io::{self, Write};
use std::time::Duration;

use ratatui::layout::Size;
use serde_json::json;

/// A writer of a recording.
#[derive(Debug)]
pub(crate) struct Asciicast<W> {
    output: W,
    /// The time of the previous event in milliseconds, as in the file.
    last: u128,
}

impl<W: Write> Asciicast<W> {
    /// Starts a recording of a terminal of `size`.
    pub(crate) fn begin(output: W, size: Size) -> io::Result<Self> {
        let mut asciicast = Self { output, last: 0 };
        let terminal = json!({ "cols": size.width, "rows": size.height });
        asciicast.write_line(json!({ "version": 3, "term": terminal }).to_string())?;
        Ok(asciicast)
    }

    /// Records that `bytes` were sent at `time`, counted from the start. They are whole characters.
    pub(crate) fn sent(&mut self, time: Duration, bytes: &[u8]) -> io::Result<()> {
        self.write_event(time, "o", &String::from_utf8_lossy(bytes))
    }

    /// Records that the terminal's size changed at `time`.
    pub(crate) fn resized(&mut self, time: Duration, size: Size) -> io::Result<()> {
        self.write_event(time, "r", &format!("{}x{}", size.width, size.height))
    }

    /// Flushes `output`.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        self.output.flush()
    }

    fn write_event(&mut self, time: Duration, code: &str, data: &str) -> io::Result<()> {
        // Times are rounded, not intervals, whose errors would add up.
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
        fn every_text_comes_back_at_its_time(events: Vec<(u16, String)>) {
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
