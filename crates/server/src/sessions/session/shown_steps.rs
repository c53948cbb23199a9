//! Which step of the game a visitor sees: that of the newest frame that their terminal has answered.

use std::collections::VecDeque;

/// The most frames that are remembered: more than can be unanswered.
const MOST: usize = 8;

/// The steps that the last frames showed.
#[derive(Clone, Debug, Default)]
pub(crate) struct ShownSteps {
    /// The number of the frame, and the step; the newest frame last.
    frames: VecDeque<(u64, u64)>,
}

impl ShownSteps {
    /// Records that after `frame` frames, the last one shows the state after `step`. A frame that
    /// has changed nothing has no number of its own: the last one shows the new step, too.
    pub(crate) fn drawn(&mut self, frame: u64, step: u64) {
        match self.frames.back_mut() {
            Some(last) if last.0 == frame => last.1 = step,
            _ => self.frames.push_back((frame, step)),
        }
        if self.frames.len() > MOST {
            self.frames.pop_front();
        }
    }

    /// The step that the visitor sees if `answered` frames are answered. Before the first answer it
    /// is that of the first frame.
    pub(crate) fn seen(&self, answered: u64) -> u64 {
        let seen = self.frames.iter().rfind(|frame| frame.0 <= answered);
        seen.or(self.frames.front()).map_or(0, |&(_, step)| step)
    }

    /// Forgets all frames, at the beginning of a game.
    pub(crate) fn forget(&mut self) {
        self.frames.clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_of_the_newest_answered_frame_is_seen() {
        let mut shown = ShownSteps::default();
        assert_eq!(shown.seen(7), 0);
        for (frame, step) in [(4, 100), (5, 102), (5, 104), (6, 110)] {
            shown.drawn(frame, step);
        }
        assert_eq!([3, 4, 5, 6, 9].map(|answered| shown.seen(answered)), [100, 100, 104, 110, 110]);
        for frame in 7..30 {
            shown.drawn(frame, frame * 10);
        }
        assert_eq!(shown.frames.len(), MOST);
        assert_eq!(shown.seen(28), 280);
    }
}
