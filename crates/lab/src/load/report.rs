//! The report about servers, from their own metrics.

use std::collections::BTreeMap;
use std::time::Duration;

/// The metrics of each server by their names.
pub(crate) type Samples = Vec<BTreeMap<String, f64>>;

/// The figures of servers on which clients played.
pub(crate) struct Figures {
    pub(crate) sessions: usize,
    /// The number of clients in rooms.
    members: f64,
    /// Frames a second for each session.
    pub(crate) frames: f64,
    /// Kilobytes a second for each session.
    pub(crate) kilobytes: f64,
    /// The time from the arrival of a key to the departure of the frame that answers it, in milliseconds: the 50th and
    /// the 99th percentile.
    pub(crate) key_time: [f64; 2],
    /// The share of a core that each server has used.
    busy: Vec<f64>,
}

impl Figures {
    /// The figures of this number of sessions, from the metrics before and after this time, and from the processor
    /// time that each server has used meanwhile.
    pub(crate) fn of(
        sessions: usize,
        seconds: u64,
        [before, after]: [&Samples; 2],
        processor: &[Duration],
    ) -> Self {
        let seconds = seconds as f64;
        let each =
            |name: &str| (sum(after, name) - sum(before, name)) / seconds / sessions.max(1) as f64;
        Self {
            sessions,
            members: sum(after, "cellcaster_members"),
            frames: each("cellcaster_frames_total"),
            kilobytes: each("cellcaster_frame_bytes_total") / 1000.0,
            key_time: [0.5, 0.99].map(|share| key_time(before, after, share) * 1000.0),
            busy: processor.iter().map(|it| it.as_secs_f64() / seconds).collect(),
        }
    }

    /// The share of a core that all servers have used.
    pub(crate) fn busy(&self) -> f64 {
        self.busy.iter().sum()
    }

    /// The processor time of a frame, all told, in microseconds.
    pub(crate) fn micros_a_frame(&self) -> f64 {
        self.busy() * 1e6 / (self.frames * self.sessions as f64).max(1.0)
    }

    /// Prints the figures.
    pub(crate) fn print(&self) {
        let [median, worst] = self.key_time;
        println!("sessions      {}, {} of them in rooms", self.sessions, self.members);
        println!("frames        {:.1} a second for each session", self.frames);
        println!("bytes         {:.1} KB a second for each session", self.kilobytes);
        println!("key to frame  p50 {median:.1} ms, p99 {worst:.1} ms");
        let each: Vec<String> = self.busy.iter().map(|it| format!("{:.1} %", it * 100.0)).collect();
        println!(
            "processor     {} of a core; {:.0} µs a frame",
            each.join(" and "),
            self.micros_a_frame()
        );
    }
}

/// The sum of a figure of all servers. In a cluster, its name is followed by labels.
fn sum(samples: &Samples, name: &str) -> f64 {
    let is_asked =
        |it: &str| it.strip_prefix(name).is_some_and(|it| it.is_empty() || it.starts_with('{'));
    samples.iter().flatten().filter(|it| is_asked(it.0)).map(|it| it.1).sum()
}

/// The time in seconds that this share of the keys does not exceed, interpolated as Prometheus does; 0 without keys.
fn key_time(before: &Samples, after: &Samples, share: f64) -> f64 {
    // The numbers of keys by the upper bound of their times.
    let mut counts: Vec<(f64, f64)> = Vec::new();
    for (samples, sign) in [(before, -1.0), (after, 1.0)] {
        for (name, count) in samples.iter().flatten() {
            let Some(labels) = name.strip_prefix("cellcaster_key_seconds_bucket") else { continue };
            let bound = labels.split_once("le=\"").and_then(|(_, it)| it.split('"').next());
            let bound = bound.and_then(|it| it.parse().ok()).unwrap_or(f64::INFINITY);
            match counts.iter_mut().find(|it| it.0 == bound) {
                Some((_, sum)) => *sum += sign * count,
                None => counts.push((bound, sign * count)),
            }
        }
    }
    counts.sort_by(|one, other| one.0.total_cmp(&other.0));
    let rank = (share * counts.last().map_or(0.0, |it| it.1)).max(1.0);
    let above = counts.partition_point(|&(_, count)| count < rank);
    let Some(&(bound, count)) = counts.get(above) else { return 0.0 };
    let (start, below) = above.checked_sub(1).map_or((0.0, 0.0), |it| counts[it]);
    start + (bound - start) * (rank - below) / (count - below)
}

/// A percentile of sorted times, in milliseconds; 0 if there are none.
pub(crate) fn percentile(times: &[Duration], percent: usize) -> f64 {
    let time = times.get(times.len() * percent / 100);
    time.map_or(0.0, |time| time.as_secs_f64() * 1000.0)
}
