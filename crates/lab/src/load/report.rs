//! Counts of clients, and the report about them.

use std::time::Duration;

/// The counts of a client.
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

/// The figures of clients, and of the servers on which they played.
pub(crate) struct Figures {
    pub(crate) sessions: usize,
    pub(crate) walking: usize,
    /// Frames a second for each session: the mean, the least and the most.
    pub(crate) frames: [f64; 3],
    /// Kilobytes a second for each session.
    pub(crate) kilobytes: f64,
    /// The time from a key to the frame that answers it, in milliseconds: the 50th and the 99th percentile.
    pub(crate) key_time: [f64; 2],
    keys: usize,
    unanswered: usize,
    /// The share of a core that each server has used.
    busy: Vec<f64>,
}

impl Figures {
    /// The figures of clients in this time, and the processor time that each server has used meanwhile.
    pub(crate) fn of(tallies: &[Tally], seconds: u64, processor: &[Duration]) -> Self {
        let seconds = seconds as f64;
        let count = tallies.len().max(1) as f64;
        let mut frames: Vec<f64> = tallies.iter().map(|it| it.frames as f64 / seconds).collect();
        frames.sort_by(f64::total_cmp);
        let mean = frames.iter().sum::<f64>() / count;
        let [least, most] = [frames.first(), frames.last()].map(|it| it.copied().unwrap_or(0.0));
        let bytes = tallies.iter().map(|it| it.bytes as f64).sum::<f64>() / seconds;
        let mut delays: Vec<Duration> = tallies.iter().flat_map(|it| it.delays.clone()).collect();
        delays.sort();
        Self {
            sessions: tallies.len(),
            walking: tallies.iter().filter(|it| it.is_walking).count(),
            frames: [mean, least, most],
            kilobytes: bytes / count / 1000.0,
            key_time: [50, 99].map(|percent| percentile(&delays, percent)),
            keys: delays.len(),
            unanswered: tallies.iter().map(|it| it.unanswered).sum(),
            busy: processor.iter().map(|it| it.as_secs_f64() / seconds).collect(),
        }
    }

    /// The share of a core that all servers have used.
    pub(crate) fn busy(&self) -> f64 {
        self.busy.iter().sum()
    }

    /// The processor time of a frame, all told, in microseconds.
    pub(crate) fn micros_a_frame(&self) -> f64 {
        self.busy() * 1e6 / (self.frames[0] * self.sessions as f64).max(1.0)
    }

    /// Prints the figures.
    pub(crate) fn print(&self) {
        let [mean, least, most] = self.frames;
        let [median, worst] = self.key_time;
        println!("sessions      {}, {} of them walking", self.sessions, self.walking);
        println!(
            "frames        {mean:.1} a second for each session (least {least:.1}, most {most:.1})"
        );
        println!("bytes         {:.1} KB a second for each session", self.kilobytes);
        println!(
            "key to frame  p50 {median:.1} ms, p99 {worst:.1} ms, {} keys, {} unanswered",
            self.keys, self.unanswered
        );
        let each: Vec<String> = self.busy.iter().map(|it| format!("{:.1} %", it * 100.0)).collect();
        println!(
            "processor     {} of a core; {:.0} µs a frame",
            each.join(" and "),
            self.micros_a_frame()
        );
    }
}

/// A percentile of sorted times, in milliseconds; 0 if there are none.
pub(crate) fn percentile(times: &[Duration], percent: usize) -> f64 {
    let time = times.get(times.len() * percent / 100);
    time.map_or(0.0, |time| time.as_secs_f64() * 1000.0)
}
