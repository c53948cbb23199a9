//! A limit of lines for events that a flood repeats.

use std::time::Duration;

/// Lets one event a second through, and counts the others.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::server) struct Throttle {
    next: Duration,
    left_out: u64,
}

const PAUSE: Duration = Duration::from_secs(1);

impl Throttle {
    /// Whether an event at `now` is let through: then the number of those that were left out since the
    /// last one that was.
    pub(in crate::server) fn pass(&mut self, now: Duration) -> Option<u64> {
        if now < self.next {
            self.left_out += 1;
            return None;
        }
        self.next = now + PAUSE;
        Some(std::mem::take(&mut self.left_out))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flood_is_one_event_a_second() {
        let mut throttle = Throttle::default();
        let passed: Vec<_> =
            (0..2500).filter_map(|time| throttle.pass(Duration::from_millis(time))).collect();
        assert_eq!(passed, [0, 999, 999]);
        assert_eq!(throttle.pass(Duration::from_mins(1)), Some(499));
    }
}
