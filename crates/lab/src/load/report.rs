//! Counts of clients, and the report about them.

use std::time::Duration;

/// What a client has counted.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    pub(crate) is_walking: bool,
    pub(crate) frames: u64,
    pub(crate) bytes: u64,
    /// The times from keys to the frames that answer them.
    pub(crate) delays: Vec<Duration>,
    /// The number of timed keys that no frame has answered.
    pub(crate) unanswered: usize,
}

pub(crate) struct Report {
    walking: usize,
    /// Of each session.
    frames: Vec<f64>,
    bytes: f64,
    delays: Vec<Duration>,
    unanswered: usize,
    /// The share of a processor that each server takes.
    busy: Vec<f64>,
}

impl Report {
    pub(crate) fn new(tallies: &[Tally], seconds: u64, processor: &[Duration]) -> Self {
        let seconds = seconds as f64;
        let mut frames: Vec<f64> = tallies.iter().map(|it| it.frames as f64 / seconds).collect();
        frames.sort_by(f64::total_cmp);
        let mut delays: Vec<Duration> =
            tallies.iter().flat_map(|tally| tally.delays.iter().copied()).collect();
        delays.sort();
        Self {
            walking: tallies.iter().filter(|tally| tally.is_walking).count(),
            frames,
            bytes: tallies.iter().map(|it| it.bytes as f64).sum::<f64>() / seconds,
            delays,
            unanswered: tallies.iter().map(|tally| tally.unanswered).sum(),
            busy: processor.iter().map(|it| it.as_secs_f64() / seconds).collect(),
        }
    }

    pub(crate) fn print(&self) {
        let count = self.frames.len().max(1) as f64;
        let mean = self.frames.iter().sum::<f64>() / count;
        println!("sessions      {}, of which {} walk", self.frames.len(), self.walking);
        println!(
            "frames        {mean:.1} a second and session (least {:.1}, most {:.1})",
            self.frames.first().unwrap_or(&0.0),
            self.frames.last().unwrap_or(&0.0)
        );
        println!("bytes         {:.1} KB a second and session", self.bytes / count / 1000.0);
        println!(
            "key to frame  p50 {:.1} ms, p99 {:.1} ms, {} keys, {} without an answer",
            percentile(&self.delays, 50),
            percentile(&self.delays, 99),
            self.delays.len(),
            self.unanswered
        );
        let busy: f64 = self.busy.iter().sum();
        let each: Vec<String> = self.busy.iter().map(|it| format!("{:.1} %", it * 100.0)).collect();
        println!(
            "processor     {} of one; {:.0} µs a frame",
            each.join(" and "),
            busy * 1e6 / (mean * count).max(1.0)
        );
    }
}

/// A percentile of times that are in order, in milliseconds; 0 if there is none.
pub(crate) fn percentile(times: &[Duration], percent: usize) -> f64 {
    let time = times.get(times.len() * percent / 100);
    time.map_or(0.0, |time| time.as_secs_f64() * 1000.0)
}
