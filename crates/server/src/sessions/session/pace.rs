//! When a session may draw its next frame.
//!
//! The answer to a key is drawn early, so that the frame rate does not delay it, but on credit: a
//! visitor who holds a key gets no more frames in the long run than others. Without credit, the keys of
//! 300 visitors drew all their frames, and the [governor](crate::sessions::governor) governed nothing.

use std::time::Duration;

/// The pace of frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    frame_time: Duration,
    drawn_at: Option<Duration>,
    /// When all frames so far would have been drawn at the frame rate.
    paid_at: Duration,
}

/// The least time between two frames.
const PROMPT: Duration = Duration::from_millis(16);

impl Pace {
    pub(crate) fn new(frame_time: Duration) -> Self {
        Self { frame_time, drawn_at: None, paid_at: Duration::ZERO }
    }

    /// Sets the time between two frames.
    pub(crate) fn set_frame_time(&mut self, frame_time: Duration) {
        self.frame_time = frame_time;
    }

    /// The time of the next frame, earlier if it answers a key.
    pub(crate) fn next(&self, answers_key: bool) -> Duration {
        let Some(drawn_at) = self.drawn_at else { return Duration::ZERO };
        if answers_key {
            let credit = self.paid_at.saturating_sub(self.frame_time);
            credit.max(drawn_at + PROMPT.min(self.frame_time))
        } else {
            self.paid_at.max(drawn_at + self.frame_time)
        }
    }

    /// Records a frame.
    pub(crate) fn drawn(&mut self, now: Duration) {
        self.drawn_at = Some(now);
        self.paid_at = now.max(self.paid_at + self.frame_time);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    #[test]
    fn a_key_after_a_pause_is_answered_at_once() {
        let mut pace = Pace::new(100 * MILLISECOND);
        assert_eq!(pace.next(false), Duration::ZERO);
        pace.drawn(1000 * MILLISECOND);
        assert_eq!(pace.next(false), 1100 * MILLISECOND);
        assert_eq!(pace.next(true), 1016 * MILLISECOND);
    }

    #[test]
    fn an_early_frame_delays_the_next_one() {
        let mut pace = Pace::new(100 * MILLISECOND);
        pace.drawn(1000 * MILLISECOND);
        pace.drawn(pace.next(true));
        assert_eq!(pace.next(true), 1032 * MILLISECOND);
        assert_eq!(pace.next(false), 1116 * MILLISECOND);
        pace.drawn(pace.next(true));
        assert_eq!(pace.next(true), 1100 * MILLISECOND);
        assert_eq!(pace.next(false), 1200 * MILLISECOND);
    }

    proptest! {
        /// Whatever asks for frames, there are two more than the rate allows at most.
        #[test]
        fn keys_draw_no_more_frames_in_the_long_run(
            frame_time in 20_u32..500,
            waits in prop::collection::vec((0_u32..400, any::<bool>()), 1..200),
        ) {
            let mut pace = Pace::new(frame_time * MILLISECOND);
            let mut frames: Vec<Duration> = Vec::new();
            let mut now = 1000 * MILLISECOND;
            for (wait, answers_key) in waits {
                now = pace.next(answers_key).max(now + wait * MILLISECOND);
                pace.drawn(now);
                frames.push(now);
                for (count, first) in frames.iter().rev().enumerate() {
                    let time = now.saturating_sub(*first);
                    let allowed = time.as_millis() / u128::from(frame_time) + 2;
                    prop_assert!(count as u128 <= allowed, "{count} frames in {time:?}");
                }
            }
        }
    }
}
