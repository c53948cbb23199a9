//! What frames take: how many there are, how large, and how long until they are seen.

use std::fmt;
use std::time::Duration;

use crate::terminal::Fidelity;

/// What frames take at present.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stats {
    pub(super) pace: Pace,
    /// From sending a frame to the terminal's answer, where it answers.
    pub(super) round_trip: Option<Duration>,
    pub(super) fidelity: Fidelity,
    /// Whether the link makes frames coarse, and compression would help.
    pub(super) wants_compression: bool,
}

/// How many frames there are, and of how many bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pace {
    pub(super) frames_per_second: f64,
    pub(super) bytes_per_second: f64,
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Pace { frames_per_second, bytes_per_second } = self.pace;
        write!(f, "{frames_per_second:.0} fps  {:.0} kB/s  ", bytes_per_second / 1000.0)?;
        if let Some(round_trip) = self.round_trip {
            write!(f, "{} ms  ", round_trip.as_millis())?;
        }
        write!(f, "fidelity {}", self.fidelity)?;
        if self.wants_compression { f.write_str("  (ssh -C helps)") } else { Ok(()) }
    }
}

/// Measures the pace while frames follow one another. What is between two motions does not count,
/// so nobody has to look again when nothing moves any more.
#[derive(Debug, Default)]
pub(super) struct Meter {
    begun: Duration,
    bytes_before: u64,
    frames: u32,
    last: Duration,
}

/// How often figures are renewed.
const PERIOD: Duration = Duration::from_millis(500);
/// How long there is no frame where one motion has ended.
const PAUSE: Duration = Duration::from_millis(500);

impl Meter {
    /// Takes note of a frame, with which there have been `bytes` in all. Returns new figures when it
    /// is time for some.
    pub(super) fn frame(&mut self, now: Duration, bytes: u64) -> Option<Pace> {
        let pauses = now.saturating_sub(self.last) > PAUSE;
        let elapsed = now.saturating_sub(self.begun);
        self.frames += 1;
        self.last = now;
        if !pauses && elapsed < PERIOD {
            return None;
        }
        let pace = Pace {
            frames_per_second: f64::from(self.frames) / elapsed.as_secs_f64(),
            bytes_per_second: bytes.saturating_sub(self.bytes_before) as f64
                / elapsed.as_secs_f64(),
        };
        *self = Self { begun: now, bytes_before: bytes, frames: 0, last: now };
        (!pauses).then_some(pace)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pace_is_that_of_motion() {
        let mut meter = Meter::default();
        let figures: Vec<_> = (0..40_u64)
            .filter_map(|frame| {
                // Two seconds of ten frames each second, a minute apart.
                let time = frame * 100 + if frame < 20 { 1_000 } else { 61_000 };
                meter.frame(Duration::from_millis(time), frame * 500)
            })
            .collect();
        assert_eq!(figures.len(), 6);
        for Pace { frames_per_second, bytes_per_second } in figures {
            assert!((frames_per_second - 10.0).abs() < 0.1, "{frames_per_second}");
            assert!((bytes_per_second - 5000.0).abs() < 1.0, "{bytes_per_second}");
        }
    }

    #[test]
    fn stats_are_short() {
        let pace = Pace { frames_per_second: 29.6, bytes_per_second: 118_432.0 };
        let round_trip = Some(Duration::from_micros(104_900));
        let fidelity = Fidelity::new(7);
        let stats = Stats { pace, round_trip, fidelity, wants_compression: false };
        assert_eq!(stats.to_string(), "30 fps  118 kB/s  104 ms  fidelity 7");
        let stats = Stats { round_trip: None, fidelity: Fidelity::EXACT, ..stats };
        assert_eq!(stats.to_string(), "30 fps  118 kB/s  fidelity exact");
        let stats = Stats { fidelity: Fidelity::HIGH, wants_compression: true, ..stats };
        assert!(stats.to_string().ends_with("fidelity high  (ssh -C helps)"), "{stats}");
    }
}
