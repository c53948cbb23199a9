//! Figures of frames: their rate, their bytes, and their delay.

use std::fmt;
use std::time::Duration;

use crate::terminal::{Fidelity, Protocol};

/// The current figures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stats {
    /// The rates of frames and bytes.
    pub rates: Rates,
    /// The time from sending a frame to the terminal's answer, if it answers.
    pub round_trip: Option<Duration>,
    /// The fidelity of frames.
    pub fidelity: Fidelity,
    /// Whether the link limits the fidelity, so that compression would help.
    pub wants_compression: bool,
}

/// The rates of frames and bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rates {
    pub(crate) frames_per_second: f64,
    pub(crate) bytes_per_second: f64,
}

impl fmt::Display for Rates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames_per_second, bytes_per_second } = self;
        write!(f, "{frames_per_second:.0} fps  {:.0} kB/s", bytes_per_second / 1000.0)
    }
}

impl fmt::Display for Stats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}  ", self.rates)?;
        if let Some(round_trip) = self.round_trip {
            write!(f, "{} ms  ", round_trip.as_millis())?;
        }
        write!(f, "fidelity {}", self.fidelity)?;
        if self.wants_compression { f.write_str("  (ssh -C helps)") } else { Ok(()) }
    }
}

/// Measures the rates while frames follow one another. Pauses between motions do not count, so that
/// the figures need no update when motion ends.
#[derive(Debug, Default)]
pub struct Meter {
    begun: Duration,
    bytes_before: u64,
    frames: u32,
    last: Duration,
}

/// The time between two figures.
const PERIOD: Duration = Duration::from_millis(500);
/// The shortest time without frames that counts as a pause.
const PAUSE: Duration = Duration::from_millis(500);

impl Meter {
    /// Counts a frame that `protocol` has drawn. Returns new figures when they are due.
    pub fn measure(&mut self, protocol: &Protocol, now: Duration) -> Option<Stats> {
        let rates = self.frame(now, protocol.bytes_drawn())?;
        let (round_trip, fidelity) = (protocol.round_trip(), protocol.fidelity());
        let wants_compression = protocol.is_limited_by_network();
        Some(Stats { rates, round_trip, fidelity, wants_compression })
    }

    /// Counts a frame; `bytes` is the total so far. Returns new rates when they are due.
    fn frame(&mut self, now: Duration, bytes: u64) -> Option<Rates> {
        let pauses = now.saturating_sub(self.last) > PAUSE;
        let elapsed = now.saturating_sub(self.begun);
        self.frames += 1;
        self.last = now;
        if !pauses && elapsed < PERIOD {
            return None;
        }
        let rates = Rates {
            frames_per_second: f64::from(self.frames) / elapsed.as_secs_f64(),
            bytes_per_second: bytes.saturating_sub(self.bytes_before) as f64
                / elapsed.as_secs_f64(),
        };
        *self = Self { begun: now, bytes_before: bytes, frames: 0, last: now };
        (!pauses).then_some(rates)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pauses_do_not_count() {
        let mut meter = Meter::default();
        let figures: Vec<_> = (0..40_u64)
            .filter_map(|frame| {
                // Two times two seconds with ten frames per second, a minute apart.
                let time = frame * 100 + if frame < 20 { 1_000 } else { 61_000 };
                meter.frame(Duration::from_millis(time), frame * 500)
            })
            .collect();
        assert_eq!(figures.len(), 6);
        for Rates { frames_per_second, bytes_per_second } in figures {
            assert!((frames_per_second - 10.0).abs() < 0.1, "{frames_per_second}");
            assert!((bytes_per_second - 5000.0).abs() < 1.0, "{bytes_per_second}");
        }
    }

    #[test]
    fn stats_are_short() {
        let rates = Rates { frames_per_second: 29.6, bytes_per_second: 118_432.0 };
        let round_trip = Some(Duration::from_micros(104_900));
        let fidelity = Fidelity::new(7);
        let stats = Stats { rates, round_trip, fidelity, wants_compression: false };
        assert_eq!(stats.to_string(), "30 fps  118 kB/s  104 ms  fidelity 7");
        let stats = Stats { round_trip: None, fidelity: Fidelity::EXACT, ..stats };
        assert_eq!(stats.to_string(), "30 fps  118 kB/s  fidelity exact");
        let stats = Stats { fidelity: Fidelity::HIGH, wants_compression: true, ..stats };
        assert!(stats.to_string().ends_with("fidelity high  (ssh -C helps)"), "{stats}");
    }
}
