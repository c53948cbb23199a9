//! The table of links in `docs/links.md`, simulated.

use std::fmt::Write;

use super::simulation::{Conditions, Frames, Player, Simulation, UNLIMITED};
use super::*;

const fn milliseconds(time: u64) -> Duration {
    Duration::from_millis(time)
}

const fn seconds(time: u64) -> Duration {
    Duration::from_secs(time)
}

/// How long each scenario takes.
const TIME: Duration = seconds(60);
/// When something happens to the line, where anything does, and when it is over.
const HAPPENS: Duration = seconds(20);
const OVER: Duration = seconds(32);

/// What happens to a line.
struct Scenario {
    name: &'static str,
    conditions: Conditions,
    /// The rate between [`HAPPENS`] and [`OVER`].
    rate_meanwhile: Option<f64>,
    /// The rate after that.
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

/// The value that such a share of all is not above.
fn percentile<T: Copy + Ord + Default>(values: impl Iterator<Item = T>, share: f64) -> T {
    let mut values: Vec<_> = values.collect();
    values.sort_unstable();
    let place = (values.len() as f64 * share).ceil() as usize;
    values.get(place.saturating_sub(1)).copied().unwrap_or_default()
}

fn row(player: &Player) -> String {
    let (begin, end) = (seconds(2), TIME);
    let mut shown = player.shown_since(Duration::ZERO);
    shown.retain(|one| one.at.is_some_and(|at| at >= begin));
    let latencies = || player.latencies.iter().filter(|one| one.pressed_at >= begin);
    let latency = |share| percentile(latencies().map(|one| one.taken), share).as_millis();
    let fidelity = |share| percentile(shown.iter().map(|one| one.fidelity), share).tolerance();
    let frames = shown.len() as f64 / end.saturating_sub(begin).as_secs_f64();
    let freeze = player.longest_freeze(begin, end).as_secs_f64();
    format!(
        "{frames:4.1} | {:4} | {:4} | {:2} | {:2} | {freeze:4.1} | {:3.0}",
        latency(0.5),
        latency(0.95),
        fidelity(0.5),
        fidelity(0.95),
        player.most_in_flight(begin) as f64 / 1000.0,
    )
}

pub(super) fn table() -> String {
    let mut table = String::from(
        "| link | `-C` | frames/s | key to frame, median ms | 95th % | fidelity, median | 95th % | \
         longest freeze, s | most in flight, kB |\n|---|---|---|---|---|---|---|---|---|\n",
    );
    for scenario in Scenario::all() {
        for (compressed, frames) in [("no", Frames::CITADEL), ("yes", Frames::COMPRESSED)] {
            for player in &scenario.play(frames).players {
                let name = scenario.name;
                writeln!(table, "| {name} | {compressed} | {} |", row(player)).unwrap();
            }
        }
    }
    table
}
