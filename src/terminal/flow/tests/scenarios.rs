//! Computes the tables of `docs/links.md` by simulation.

use std::fmt::Write;

use super::simulation::{Conditions, Frames, Player, Simulation, UNLIMITED};
use super::*;

const fn milliseconds(time: u64) -> Duration {
    Duration::from_millis(time)
}

const fn seconds(time: u64) -> Duration {
    Duration::from_secs(time)
}

/// The duration of each scenario.
const TIME: Duration = seconds(60);
/// The times at which the rate changes, in the scenarios with a change.
const HAPPENS: Duration = seconds(20);
const OVER: Duration = seconds(32);

/// A link and its changes.
struct Scenario {
    name: &'static str,
    conditions: Conditions,
    /// The rate between [`HAPPENS`] and [`OVER`].
    rate_meanwhile: Option<f64>,
    /// The rate after [`OVER`].
    rate_then: Option<f64>,
    players: usize,
}

impl Scenario {
    const fn steady(name: &'static str, delay: u64, jitter: u64, rate: f64) -> Self {
        let (delay, jitter) = (milliseconds(delay), milliseconds(jitter));
        let conditions = Conditions { delay, jitter, rate };
        Self { name, conditions, rate_meanwhile: None, rate_then: None, players: 1 }
    }

    const fn all() -> [Self; 12] {
        const MEGABIT: f64 = 125_000.0;
        [
            Self::steady("no limit, no delay", 0, 0, UNLIMITED),
            Self::steady("no limit, 20 ms each way", 20, 0, UNLIMITED),
            Self::steady("the same, jitter 0–50 ms", 20, 50, UNLIMITED),
            Self::steady("the same, jitter 0–100 ms", 20, 100, UNLIMITED),
            Self::steady("10 Mbit/s, 20 ms", 20, 0, 10.0 * MEGABIT),
            Self::steady("10 Mbit/s, 50 ms", 50, 0, 10.0 * MEGABIT),
            Self::steady("1 Mbit/s, 50 ms", 50, 0, MEGABIT),
            Self::steady("1 Mbit/s, 50 ms, jitter 0–50 ms", 50, 50, MEGABIT),
            Self::steady("256 kbit/s, 150 ms", 150, 0, 0.256 * MEGABIT),
            Self {
                rate_meanwhile: Some(0.008 * MEGABIT),
                rate_then: Some(10.0 * MEGABIT),
                ..Self::steady("10 Mbit/s, 50 ms, 12 s at 8 kbit/s", 50, 0, 10.0 * MEGABIT)
            },
            Self {
                rate_meanwhile: Some(0.02 * MEGABIT),
                rate_then: Some(10.0 * MEGABIT),
                ..Self::steady("10 Mbit/s, 20 ms, 12 s at 20 kbit/s", 20, 0, 10.0 * MEGABIT)
            },
            Self { players: 2, ..Self::steady("two on 2 Mbit/s, 30 ms", 30, 0, 2.0 * MEGABIT) },
        ]
    }

    fn play(&self, frames: Frames) -> Simulation {
        let mut line = Simulation::new(self.conditions, &vec![frames; self.players]);
        line.walk(HAPPENS);
        line.conditions.rate = self.rate_meanwhile.unwrap_or(line.conditions.rate);
        line.walk(OVER.saturating_sub(HAPPENS));
        line.conditions.rate = self.rate_then.unwrap_or(line.conditions.rate);
        line.walk(TIME.saturating_sub(OVER));
        line
    }
}

/// The least value that at least this share of the values does not exceed.
fn percentile<T: Copy + Ord + Default>(values: impl Iterator<Item = T>, share: f64) -> T {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    let place = (values.len() as f64 * share).ceil() as usize;
    values.get(place.saturating_sub(1)).copied().unwrap_or_default()
}

/// Frames per second, the median and the 95th percentile of the time from a key to its frame in milliseconds, the
/// median fidelity, and the longest freeze in seconds.
fn figures(player: &Player) -> [String; 5] {
    let (begin, end) = (seconds(2), TIME);
    let mut shown = player.shown_since(Duration::ZERO);
    shown.retain(|one| one.at.is_some_and(|at| at >= begin));
    let latencies = || player.latencies.iter().filter(|one| one.pressed_at >= begin);
    let latency = |share| percentile(latencies().map(|one| one.taken), share).as_millis();
    let fidelity = percentile(shown.iter().map(|one| one.fidelity), 0.5).tolerance();
    let frames = shown.len() as f64 / end.saturating_sub(begin).as_secs_f64();
    let freeze = player.longest_freeze(begin, end).as_secs_f64();
    [
        format!("{frames:.1}"),
        latency(0.5).to_string(),
        latency(0.95).to_string(),
        fidelity.to_string(),
        format!("{freeze:.1}"),
    ]
}

/// A row of cells: each figure without compression, then with it.
fn cells<const N: usize>([plain, compressed]: [[String; N]; 2]) -> String {
    let pairs = plain.iter().zip(&compressed);
    let cells: Vec<&str> = pairs.flat_map(|(one, other)| [one.as_str(), other.as_str()]).collect();
    format!(" {} |", cells.join(" | "))
}

pub(crate) fn table() -> String {
    let mut table = String::from(
        "| link | frames/s | `-C` | key to frame, median ms | `-C` | 95th % | `-C` | fidelity, median | `-C` | \
         longest freeze, s | `-C` |\n|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for scenario in Scenario::all() {
        let simulations = [Frames::CITADEL, Frames::COMPRESSED].map(|it| scenario.play(it));
        for player in 0..scenario.players {
            let figures = simulations.each_ref().map(|it| figures(&it.players[player]));
            writeln!(table, "| {} |{}", scenario.name, cells(figures)).unwrap();
        }
    }
    table
}

/// The delay of a link of 10 Mbit/s, in milliseconds, and the rate to which it drops, in kbit/s.
const DROPS: [(u64, u32); 3] = [(20, 20), (50, 20), (50, 8)];

/// The largest number of bytes that wait for a link after its rate has dropped: the median and the
/// maximum over drops at different times.
pub(crate) fn queued_after_drop(delay: u64, kilobits: u32, frames: Frames) -> [f64; 2] {
    let mut queued: Vec<f64> = (0..21)
        .map(|phase| {
            let mut link = Simulation::of_one(milliseconds(delay), 10.0 * 125_000.0, frames);
            link.walk(seconds(5) + milliseconds(37) * phase);
            link.conditions.rate = f64::from(kilobits) * 125.0;
            let waits = (0..100).map(|_| {
                link.walk(milliseconds(10));
                link.queued()
            });
            waits.fold(0.0, f64::max)
        })
        .collect();
    queued.sort_by(f64::total_cmp);
    [queued[10], queued[20]]
}

pub(crate) fn table_of_drops() -> String {
    let mut table = String::from(
        "| 10 Mbit/s, delay | drops to | in flight then, median kB | `-C` | most | `-C` | arrives after, median s | \
         `-C` | at most | `-C` |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n",
    );
    for (delay, kilobits) in DROPS {
        let figures = [Frames::CITADEL, Frames::COMPRESSED].map(|frames| {
            let [median, most] = queued_after_drop(delay, kilobits, frames);
            let seconds = |bytes: f64| bytes / (f64::from(kilobits) * 125.0);
            [median / 1000.0, most / 1000.0, seconds(median), seconds(most)]
                .map(|figure| format!("{figure:.0}"))
        });
        writeln!(table, "| {delay} ms | {kilobits} kbit/s |{}", cells(figures)).unwrap();
    }
    table
}
