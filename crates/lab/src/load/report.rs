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

/// Prints the counts of clients in this time, and the processor time that each server has used
/// meanwhile.
pub(crate) fn print(tallies: &[Tally], seconds: u64, processor: &[Duration]) {
    let seconds = seconds as f64;
    let count = tallies.len().max(1) as f64;
    let mut frames: Vec<f64> = tallies.iter().map(|it| it.frames as f64 / seconds).collect();
    frames.sort_by(f64::total_cmp);
    let mean = frames.iter().sum::<f64>() / count;
    let bytes = tallies.iter().map(|it| it.bytes as f64).sum::<f64>() / seconds;
    let mut delays: Vec<Duration> = tallies.iter().flat_map(|it| it.delays.clone()).collect();
    delays.sort();
    let walking = tallies.iter().filter(|it| it.is_walking).count();
    println!("sessions      {}, {walking} of them walking", tallies.len());
    println!(
        "frames        {mean:.1} a second for each session (least {:.1}, most {:.1})",
        frames.first().unwrap_or(&0.0),
        frames.last().unwrap_or(&0.0)
    );
    println!("bytes         {:.1} KB a second for each session", bytes / count / 1000.0);
    println!(
        "key to frame  p50 {:.1} ms, p99 {:.1} ms, {} keys, {} unanswered",
        percentile(&delays, 50),
        percentile(&delays, 99),
        delays.len(),
        tallies.iter().map(|it| it.unanswered).sum::<usize>()
    );
    let busy: Vec<f64> = processor.iter().map(|it| it.as_secs_f64() / seconds).collect();
    let each: Vec<String> = busy.iter().map(|it| format!("{:.1} %", it * 100.0)).collect();
    println!(
        "processor     {} of a core; {:.0} µs a frame",
        each.join(" and "),
        busy.iter().sum::<f64>() * 1e6 / (mean * count).max(1.0)
    );
}

/// A percentile of sorted times, in milliseconds; 0 if there are none.
pub(crate) fn percentile(times: &[Duration], percent: usize) -> f64 {
    let time = times.get(times.len() * percent / 100);
    time.map_or(0.0, |time| time.as_secs_f64() * 1000.0)
}
