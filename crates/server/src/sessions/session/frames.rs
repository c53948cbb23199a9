//! The timing of a session's frames: when the next frame may be drawn, which keys it answers, and which step
//! of the game the visitor sees.
//!
//! - **Pace.** A frame that answers a key is drawn early, so that the frame rate does not delay the answer.
//!   It is drawn on credit: no visitor gets more frames than others in the long run. Without this limit, the keys
//!   of 300 visitors triggered all their frames, and the [governor](crate::load) had no effect. Repetitions of a
//!   held key change nothing and use no credit. Each of the next frames pays half of the debt. Rejected: the next frame
//!   pays all. Then motion stands still for up to twice the usual time.
//! - **Answers.** A frame answers a key if it shows the key's effect. A change of the screen appears in the
//!   next picture. A change of intents appears in the first picture of a snapshot in which the room acts on them, or on
//!   later ones, because a tap may be over. Keys without an effect are not counted. When every key counted
//!   until the next frame of any kind, the mean of [`Metrics::key_time`](crate::metrics::Metrics::key_time)
//!   was 2.5 s.
//! - **Steps.** The visitor sees the step of the last frame that their terminal has acknowledged.

use std::collections::VecDeque;
use std::time::Duration;

use crate::rooms::sequencer::STEP;
use cellcaster::game::Intents;

/// The pace of frames.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    frame_time: Duration,
    drawn_at: Option<Duration>,
    /// The time at which all frames would have been drawn at the frame rate.
    paid_at: Duration,
}

/// Half of a step. A frame is drawn right after a step, up to this time early or late.
const HALF_STEP: Duration = Duration::from_nanos(STEP.as_nanos() as u64 / 2);
/// The number of frames that may be drawn on credit.
const CREDIT: u32 = 2;

impl Pace {
    pub(crate) fn new(frame_time: Duration) -> Self {
        Self { frame_time, drawn_at: None, paid_at: Duration::ZERO }
    }

    /// The interval between frames.
    pub(crate) fn frame_time(&self) -> Duration {
        self.frame_time
    }

    /// Sets the interval between frames.
    pub(crate) fn set_frame_time(&mut self, frame_time: Duration) {
        self.frame_time = frame_time;
    }

    /// The time of the next frame, which is earlier if it answers a key.
    pub(crate) fn next(&self, answers_key: bool) -> Duration {
        let Some(drawn_at) = self.drawn_at else { return Duration::ZERO };
        if answers_key {
            self.paid_at.saturating_sub(CREDIT * self.frame_time).max(drawn_at + HALF_STEP)
        } else {
            let due = drawn_at + self.frame_time;
            (due + self.paid_at.saturating_sub(due) / 2).saturating_sub(HALF_STEP)
        }
    }

    /// Records that a frame was drawn.
    pub(crate) fn drawn(&mut self, now: Duration) {
        self.drawn_at = Some(now);
        self.paid_at = now.saturating_sub(HALF_STEP).max(self.paid_at + self.frame_time);
    }
}

/// The arrival times of the oldest unanswered keys.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Unanswered {
    /// The oldest key that has changed the screen.
    shown: Option<Duration>,
    /// The oldest key that has changed the visitor's intents in the room, and the intents after the newest one.
    wanted: Option<(Duration, Intents)>,
}

impl Unanswered {
    /// Records the effects of a key that arrived at `now`: whether it has changed the screen, and the intents if it has
    /// changed them.
    pub(crate) fn press(&mut self, is_shown: bool, wanted: Option<Intents>, now: Duration) {
        if is_shown {
            self.shown.get_or_insert(now);
        }
        if let Some(intents) = wanted {
            self.wanted.get_or_insert((now, intents)).1 = intents;
        }
    }

    /// The intents after the newest key that has changed them.
    pub(crate) fn wanted(&self) -> Option<Intents> {
        self.wanted.map(|(_, intents)| intents)
    }

    /// Returns true if a new picture answers a key. `shows_intents` states whether it shows an effect of intents.
    pub(crate) fn awaits(&self, shows_intents: bool) -> bool {
        self.shown.is_some() || self.wanted.is_some() && shows_intents
    }

    /// Records that the room has acted on all intents without a visible change.
    pub(crate) fn forget_wanted(&mut self) {
        self.wanted = None;
    }

    /// Returns the arrival time of the oldest key that a new picture answers. `shows_intents` states whether it shows
    /// an effect of intents.
    pub(crate) fn answer(&mut self, shows_intents: bool) -> Option<Duration> {
        let wanted = self.wanted.take_if(|_| shows_intents).map(|(time, _)| time);
        self.shown.take().into_iter().chain(wanted).min()
    }
}

/// The number of frames that are remembered. It exceeds the number that can be unacknowledged.
const MAX_FRAMES: usize = 8;

/// The steps shown in the latest frames.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShownSteps {
    /// The frame's number and its step, newest last.
    frames: VecDeque<(u64, u64)>,
}

impl ShownSteps {
    /// Records that after `frame` frames, the last one shows the state after `step`. A frame without changes
    /// has no number of its own; the last numbered frame then shows the new step, too.
    pub(crate) fn drawn(&mut self, frame: u64, step: u64) {
        match self.frames.back_mut() {
            Some(last) if last.0 == frame => last.1 = step,
            _ => self.frames.push_back((frame, step)),
        }
        if self.frames.len() > MAX_FRAMES {
            self.frames.pop_front();
        }
    }

    /// The step that the visitor sees when `answered` frames have been acknowledged. Before the first
    /// acknowledgement, it is the step of the first frame.
    pub(crate) fn seen(&self, answered: u64) -> u64 {
        let seen = self.frames.iter().rfind(|frame| frame.0 <= answered);
        seen.or(self.frames.front()).map_or(0, |&(_, step)| step)
    }

    /// Forgets all frames, at the start of a game.
    pub(crate) fn forget(&mut self) {
        self.frames.clear();
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    fn early(milliseconds: u32) -> Duration {
        (milliseconds * MILLISECOND).saturating_sub(HALF_STEP)
    }

    #[test]
    fn a_key_after_a_pause_is_answered_at_once() {
        let mut pace = Pace::new(100 * MILLISECOND);
        assert_eq!(pace.next(false), Duration::ZERO);
        pace.drawn(1000 * MILLISECOND);
        assert_eq!(pace.next(false), early(1100));
        assert_eq!(pace.next(true), 1000 * MILLISECOND + HALF_STEP);
    }

    #[test]
    fn early_frames_delay_the_next_ones() {
        let mut pace = Pace::new(100 * MILLISECOND);
        pace.drawn(1000 * MILLISECOND);
        let mut draw = |answers_key| {
            let before = pace.drawn_at.unwrap();
            let now = pace.next(answers_key);
            pace.drawn(now);
            now.saturating_sub(before).as_millis()
        };
        assert_eq!([true; 4].map(&mut draw), [8, 8, 8, 66]);
        assert_eq!([false; 6].map(draw), [191, 145, 122, 111, 105, 102]);
    }

    proptest! {
        /// Any sequence of requests draws at most three frames more than the frame rate allows.
        #[test]
        fn keys_do_not_raise_the_frame_rate_in_the_long_run(
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
                    let time = time + 2 * HALF_STEP;
                    let allowed = time.as_millis() / u128::from(frame_time) + 3;
                    prop_assert!(count as u128 <= allowed, "{count} frames in {time:?}");
                }
            }
        }
    }

    #[test]
    fn the_seen_step_belongs_to_the_last_acknowledged_frame() {
        let mut shown = ShownSteps::default();
        assert_eq!(shown.seen(7), 0);
        for (frame, step) in [(4, 100), (5, 102), (5, 104), (6, 110)] {
            shown.drawn(frame, step);
        }
        assert_eq!([3, 4, 5, 6, 9].map(|answered| shown.seen(answered)), [100, 100, 104, 110, 110]);
        for frame in 7..30 {
            shown.drawn(frame, frame * 10);
        }
        assert_eq!(shown.frames.len(), MAX_FRAMES);
        assert_eq!(shown.seen(28), 280);
    }
}
