//! A player, the player's game, and the frames that the terminal has shown.

use std::collections::VecDeque;

use super::super::*;
use super::FrameSource;

/// A player in motion, and the flow control of the game.
pub(crate) struct Player {
    pub(crate) flow: Flow,
    pub(crate) shown: Vec<Shown>,
    /// The times from a key press to the first frame that reflects it, in order of the presses.
    pub(crate) latencies: Vec<Latency>,
    pub(crate) frames: Box<dyn FrameSource>,
    pub(crate) due: Duration,
    pub(crate) next_key: Duration,
    /// Answers and keys on their way to the game, with their arrival times.
    pub(crate) upward: VecDeque<(Duration, Upward)>,
    /// The arrival times of the latest packets, upward and downward.
    pub(crate) last: [Duration; 2],
    /// The keys that the next frame reflects, by the times of their presses.
    pub(crate) pressed: Vec<Duration>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Upward {
    Answer(Request),
    Key(Duration),
}

/// A key press, and the time until a frame showed it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Latency {
    pub(crate) pressed_at: Duration,
    pub(crate) taken: Duration,
}

/// A sent frame.
#[derive(Clone, Debug)]
pub(crate) struct Shown {
    pub(crate) sent_at: Duration,
    /// The time at which it is on the screen; `None` if it has not arrived.
    pub(crate) at: Option<Duration>,
    pub(crate) fidelity: Fidelity,
    pub(crate) bytes: usize,
    pub(crate) keys: Vec<Duration>,
    pub(crate) request: Request,
}

impl Shown {
    /// The age of the frame when it is shown; the maximum if it never is.
    pub(crate) fn age(&self) -> Duration {
        self.at.map_or(Duration::MAX, |at| at.saturating_sub(self.sent_at))
    }
}

impl Player {
    pub(crate) fn new(frames: Box<dyn FrameSource>) -> Self {
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

    pub(crate) fn receive(&mut self, now: Duration, upward: Upward) {
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

    /// The frames sent after `time`.
    pub(crate) fn shown_since(&self, time: Duration) -> Vec<&Shown> {
        self.shown.iter().filter(|shown| shown.bytes > 0 && shown.sent_at >= time).collect()
    }

    /// The longest time between two frames that arrive from `begin` until `end`.
    pub(crate) fn longest_freeze(&self, begin: Duration, end: Duration) -> Duration {
        let frames = self.shown.iter().filter(|shown| shown.bytes > 0);
        let arrivals = frames.filter_map(|shown| shown.at);
        let within = arrivals.filter(|at| (begin..end).contains(at));
        let times: Vec<_> = [begin].into_iter().chain(within).chain([end]).collect();
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).max().unwrap_or_default()
    }

    /// The maximum in flight at any time, in bytes before compression.
    pub(crate) fn most_in_flight(&self, begin: Duration) -> usize {
        let in_flight = |time| {
            let is_there =
                |shown: &&Shown| shown.sent_at <= time && shown.at.is_none_or(|at| at > time);
            self.shown.iter().filter(is_there).map(|shown| shown.bytes).sum()
        };
        self.shown_since(begin).iter().map(|shown| in_flight(shown.sent_at)).max().unwrap_or(0)
    }
}
