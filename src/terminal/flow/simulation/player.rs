//! A player, the game that is played, and what the terminal has shown.

use std::collections::VecDeque;

use super::super::*;
use super::FrameSource;

/// A player in motion, and the flow control of the game.
pub(in super::super) struct Player {
    pub(in super::super) flow: Flow,
    pub(in super::super) shown: Vec<Shown>,
    /// From pressing a key to the first frame that reflects it, in order of pressing.
    pub(in super::super) latencies: Vec<Latency>,
    pub(super) frames: Box<dyn FrameSource>,
    pub(super) due: Duration,
    pub(super) next_key: Duration,
    /// Answers and keys that are sent to the game, and when they arrive.
    pub(super) upward: VecDeque<(Duration, Upward)>,
    /// When the latest packet arrives, upward and downward.
    pub(super) last: [Duration; 2],
    /// Which keys are in the next frame.
    pub(super) pressed: Vec<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Upward {
    Answer(Request),
    Key(Duration),
}

/// A key that was pressed, and how long it took to be seen.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Latency {
    pub(in super::super) pressed_at: Duration,
    pub(in super::super) taken: Duration,
}

/// A frame that was sent.
#[derive(Clone, Debug)]
pub(in super::super) struct Shown {
    pub(in super::super) sent_at: Duration,
    /// When it is on the screen; `None` where it has not arrived.
    pub(in super::super) at: Option<Duration>,
    pub(in super::super) fidelity: Fidelity,
    pub(in super::super) bytes: usize,
    pub(super) keys: Vec<Duration>,
    pub(super) request: Request,
}

impl Shown {
    /// How old it is when it is seen; for ever where it is not.
    pub(in super::super) fn age(&self) -> Duration {
        self.at.map_or(Duration::MAX, |at| at.saturating_sub(self.sent_at))
    }
}

impl Player {
    pub(super) fn new(frames: Box<dyn FrameSource>) -> Self {
        Self {
            flow: Flow::new(true),
            shown: Vec::new(),
            latencies: Vec::new(),
            frames,
            due: Duration::ZERO,
            next_key: Duration::ZERO,
            upward: VecDeque::new(),
            last: [Duration::ZERO; 2],
            pressed: Vec::new(),
        }
    }

    pub(super) fn receive(&mut self, now: Duration, upward: Upward) {
        match upward {
            Upward::Answer(Request::Status) => self.flow.answered(now),
            Upward::Answer(Request::Fence) => self.flow.fence_answered(now),
            Upward::Answer(Request::Nothing) => {}
            Upward::Key(pressed_at) => {
                self.flow.received_input();
                self.pressed.push(pressed_at);
            }
        }
    }

    /// The frames that were sent after `time`.
    pub(in super::super) fn shown_since(&self, time: Duration) -> Vec<&Shown> {
        self.shown.iter().filter(|shown| shown.bytes > 0 && shown.sent_at >= time).collect()
    }

    /// The longest time between two frames that arrive from `begin` until `end`.
    pub(in super::super) fn longest_freeze(&self, begin: Duration, end: Duration) -> Duration {
        let frames = self.shown.iter().filter(|shown| shown.bytes > 0);
        let arrivals = frames.filter_map(|shown| shown.at);
        let within = arrivals.filter(|at| (begin..end).contains(at));
        let times: Vec<_> = [begin].into_iter().chain(within).chain([end]).collect();
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or_default()
    }

    /// The most that was in flight at a time, in bytes before compression.
    pub(in super::super) fn most_in_flight(&self, begin: Duration) -> usize {
        let in_flight = |time| {
            let is_there =
                |shown: &&Shown| shown.sent_at <= time && shown.at.is_none_or(|at| at > time);
            self.shown.iter().filter(is_there).map(|shown| shown.bytes).sum()
        };
        self.shown_since(begin).iter().map(|shown| in_flight(shown.sent_at)).max().unwrap_or(0)
    }
}
