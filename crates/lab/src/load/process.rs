//! What processes have used, from `/proc`.

use std::collections::BTreeMap;
use std::fs;
use std::process::{Command, Stdio};
use std::time::Duration;

/// What a process and all its descendants have used.
#[derive(Debug)]
pub(crate) struct Usage {
    pub(crate) processor: Duration,
    /// Proportional set size: a page that several processes share counts once in all.
    pub(crate) megabytes: f64,
}

/// What the kernel tells about one process.
struct Stat {
    parent: u32,
    processor: Duration,
}

impl Usage {
    pub(crate) fn of(root: u32) -> Self {
        let stats = stats();
        let mut processes = vec![root];
        let mut next = 0;
        while let Some(&process) = processes.get(next) {
            next += 1;
            processes.extend(stats.iter().filter(|it| it.1.parent == process).map(|it| it.0));
        }
        let processor =
            processes.iter().filter_map(|it| stats.get(it)).map(|it| it.processor).sum();
        let kilobytes: u64 = processes.iter().filter_map(|&it| kilobytes(it)).sum();
        Self { processor, megabytes: (kilobytes as f64 / 102.4).round() / 10.0 }
    }
}

/// The time that each process has used between two measurements of the same processes.
pub(crate) fn between(before: &[Usage], after: &[Usage]) -> Vec<Duration> {
    let pairs = before.iter().zip(after);
    pairs.map(|(before, after)| after.processor.saturating_sub(before.processor)).collect()
}

fn stats() -> BTreeMap<u32, Stat> {
    let Ok(entries) = fs::read_dir("/proc") else { return BTreeMap::new() };
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    names.filter_map(|name| name.parse().ok()).filter_map(|it| Some((it, stat(it)?))).collect()
}

fn stat(process: u32) -> Option<Stat> {
    let text = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let fields: Vec<&str> = text.rsplit(')').next()?.split_whitespace().collect();
    // User and system time, and those of children that have ended, in hundredths of a second.
    let ticks: u64 = fields.get(11..15)?.iter().filter_map(|it| it.parse::<u64>().ok()).sum();
    Some(Stat {
        parent: fields.get(1)?.parse().ok()?,
        processor: Duration::from_millis(ticks * 10),
    })
}

fn kilobytes(process: u32) -> Option<u64> {
    let text = fs::read_to_string(format!("/proc/{process}/smaps_rollup")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("Pss:"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Keeps a process on one processor.
pub(crate) fn pin(process: u32, processor: u32) {
    let arguments = ["-apc".to_owned(), processor.to_string(), process.to_string()];
    _ = Command::new("taskset").args(arguments).stdout(Stdio::null()).status();
}
