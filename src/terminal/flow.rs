//! When the next frame may be sent, so that none waits in the link behind others.
//!
//! A write says nothing about lag: the system and the link take seconds of frames before they
//! take no more. So each frame is followed by a request, which the terminal answers when it has come
//! that far, and only a few frames may be unanswered: as many as keep the link busy until the answer
//! to the first of them is back, and four at the most.
//!
//! Answers come in the order of the requests, so the n-th answer belongs to the n-th request,
//! however late it is. Giving frames up after a while was refused: their late answers are then
//! credited to newer frames, and the link seems faster than it is for as long as anything moves.
//! An answer that is lost is noticed at the next *fence*, a request of another kind: its answer says
//! that all before it has been answered, or never will be. Every few seconds the request after a
//! frame is a fence.
//!
//! Where no answer comes in time, a fence is sent alone, and after that nothing: frames that nobody
//! takes keep a dead connection from being noticed. An answer opens the link again, and so does a
//! key: it proves that the player is there. A terminal that goes on without answering, or passes
//! over requests from the start, is not asked any more; for it a frame may be sent when the one
//! before has been written.
//!
//! All this is told of what happens, and when, in times that count from any moment; it has no clock
//! and no terminal.

mod demand;
mod fit;
mod link;

use std::collections::VecDeque;
use std::time::Duration;

use self::demand::{Demand, LEAST_FIDELITY};
use self::link::Link;
use super::Fidelity;

/// What is known of the frames on their way, and what follows from it for the next one.
#[derive(Debug, Default)]
pub(super) struct Flow {
    answers: Answers,
    /// What has not been answered, oldest first.
    unanswered: VecDeque<Sent>,
    /// When something was last sent, or answered.
    active_at: Duration,
    /// When a fence was last sent.
    fenced_at: Duration,
    /// How often in a row no answer came in time.
    misses: u32,
    /// Whether a key has arrived since the last one.
    is_nudged: bool,
    /// How many requests were forgotten whose answers may still come.
    forgotten: usize,
    is_remote: bool,
    link: Link,
    demand: Demand,
}

/// Whether the terminal answers requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Answers {
    #[default]
    Unknown,
    Given,
    Never,
}

/// What follows a frame, or is sent alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Request {
    Nothing,
    Status,
    Fence,
}

/// A frame on its way, or a request alone.
#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Duration,
    bytes: usize,
    request: Request,
}

impl Sent {
    fn is_fence(&self) -> bool {
        self.request == Request::Fence
    }
}

/// The most frames that may be unanswered.
pub(super) const WIDEST_WINDOW: usize = 4;
/// The most while nothing is known of the link.
const FIRST_WINDOW: usize = 1;
/// How exact a frame is while nothing is known of a link that is one: a quarter of the bytes.
const FIRST_FIDELITY: Fidelity = Fidelity::LOW;

/// The least time after which an answer is missed, and the most.
const LEAST_PATIENCE: Duration = Duration::from_secs(1);
pub(super) const MOST_PATIENCE: Duration = Duration::from_secs(8);
/// How many times longer than expected an answer may take.
const PATIENT_TIMES: u32 = 4;
/// What a link carries that nothing is known of, if it is as slow as one can be: bytes a second.
const SLOWEST: f64 = 16_000.0;
/// After so many misses in a row, with keys arriving meanwhile, a terminal does not answer any more.
const MOST_MISSES: u32 = 5;
/// How often a request is a fence.
const FENCE_PERIOD: Duration = Duration::from_secs(5);

impl Flow {
    /// Nothing is known yet, but whether there is a network on the way.
    pub(super) fn new(is_remote: bool) -> Self {
        Self { is_remote, ..Self::default() }
    }

    /// What belongs after the next frame.
    pub(super) fn request(&self, now: Duration) -> Request {
        match self.answers {
            Answers::Never => Request::Nothing,
            Answers::Given if self.misses > 0 => Request::Fence,
            Answers::Given if now.saturating_sub(self.fenced_at) >= FENCE_PERIOD => Request::Fence,
            Answers::Unknown | Answers::Given => Request::Status,
        }
    }

    /// Takes note that a frame of so many bytes was sent, with `request` after it; one of no bytes is
    /// a request alone.
    pub(super) fn sent(&mut self, now: Duration, bytes: usize, request: Request) {
        if self.is_overdue(now) {
            self.misses = self.misses.saturating_add(1);
            if self.answers == Answers::Unknown || self.misses >= MOST_MISSES {
                self.answers = Answers::Never;
                self.unanswered.clear();
            }
        }
        if request == Request::Fence {
            self.fenced_at = now;
        }
        self.unanswered.push_back(Sent { at: now, bytes, request });
        self.active_at = now;
        self.is_nudged = false;
    }

    /// Takes note that the terminal has answered a status request.
    pub(super) fn answered(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            self.unanswered.clear();
        }
        self.answers = Answers::Given;
        self.misses = 0;
        // The answer to a fence would have come before.
        while self.unanswered.front().is_some_and(Sent::is_fence) {
            self.unanswered.pop_front();
        }
        let Some(&sent) = self.unanswered.front() else { return };
        if self.forgotten > 0 && !self.link.is_plausible(now.saturating_sub(sent.at)) {
            self.forgotten -= 1;
            return;
        }
        self.unanswered.pop_front();
        self.take_answer(now, sent);
    }

    /// Takes note that the terminal has answered a fence, and all before it that it ever will.
    pub(super) fn fence_answered(&mut self, now: Duration) {
        let Some(place) = self.unanswered.iter().position(Sent::is_fence) else { return };
        if self.answers == Answers::Unknown && place > 0 {
            self.answers = Answers::Never;
            self.unanswered.clear();
            return;
        }
        self.forgotten = 0;
        let fence = self.unanswered.drain(..=place).next_back();
        if let Some(fence) = fence {
            self.take_answer(now, fence);
        }
    }

    fn take_answer(&mut self, now: Duration, sent: Sent) {
        self.misses = 0;
        self.active_at = now;
        // Where it may be the answer to something forgotten, it says nothing of the link.
        if self.forgotten == 0 {
            self.link.answered(now, sent.at, sent.bytes);
        }
        self.forgotten = 0;
    }

    /// Takes note that a key has arrived.
    pub(super) fn heard(&mut self) {
        self.is_nudged = true;
    }

    /// Takes note that the system has taken all that was sent.
    pub(super) fn taken(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            for Sent { at, bytes, .. } in self.unanswered.drain(..) {
                self.link.taken(now, at, bytes);
            }
        }
    }

    /// Takes note that nobody may answer any more what was asked so far.
    pub(super) fn forget(&mut self) {
        self.forgotten = self.unanswered.len();
        self.unanswered.clear();
        self.misses = 0;
    }

    /// Whether a frame that is sent now does not wait behind others.
    pub(super) fn may_send(&self, now: Duration) -> bool {
        match self.answers {
            Answers::Never => self.unanswered.is_empty(),
            Answers::Unknown => self.frames() < FIRST_WINDOW || self.is_overdue(now),
            Answers::Given if self.misses > 0 => self.is_nudged && self.is_overdue(now),
            Answers::Given => self.has_room() && !self.is_overdue(now),
        }
    }

    /// Whether a fence should be sent alone, to learn whether anybody is there.
    pub(super) fn probe_is_due(&self, now: Duration) -> bool {
        self.answers == Answers::Given && self.misses == 0 && self.is_overdue(now)
    }

    /// When to look again, even if nothing happens until then; `None` for never.
    pub(super) fn opens_at(&self) -> Option<Duration> {
        let is_silent = self.misses > 0 && !self.is_nudged;
        let due = self.active_at + self.patience();
        (self.awaits_answers() && !is_silent).then_some(due)
    }

    /// Whether answers are on their way.
    pub(super) fn awaits_answers(&self) -> bool {
        self.answers != Answers::Never && !self.unanswered.is_empty()
    }

    /// How long the latest answer took; `None` where there was none.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.link.round_trip()
    }

    /// How exact the next frame should be, so that the link can take it in time.
    pub(super) fn fidelity(&self) -> Fidelity {
        if self.misses > 0 && self.answers == Answers::Given {
            return LEAST_FIDELITY;
        }
        if self.is_remote && !self.link.is_known() {
            return FIRST_FIDELITY;
        }
        self.link.usable_rate().map_or(Fidelity::EXACT, |rate| self.demand.fidelity_within(rate))
    }

    /// Takes note that something has moved, and that it took so many bytes to show it. The first frame,
    /// which paints everything, is no motion.
    pub(super) fn showed_motion(&mut self, bytes: usize, fidelity: Fidelity) {
        if self.link.is_known() {
            self.demand.showed_motion(bytes, fidelity);
        }
    }

    /// How many frames are unanswered.
    fn frames(&self) -> usize {
        self.unanswered.iter().filter(|sent| sent.bytes > 0).count()
    }

    fn bytes(&self) -> usize {
        self.unanswered.iter().map(|sent| sent.bytes).sum()
    }

    fn has_room(&self) -> bool {
        let frames = self.frames();
        frames == 0 || frames < WIDEST_WINDOW && !self.keeps_link_busy()
    }

    /// Whether what is on its way keeps the link busy until the answer to a frame would be back.
    fn keeps_link_busy(&self) -> bool {
        self.link.time_for(self.bytes()) >= self.link.expected_round_trip()
    }

    fn is_overdue(&self, now: Duration) -> bool {
        self.awaits_answers() && self.active_at + self.patience() <= now
    }

    /// How long there may be no answer until it counts as missed.
    fn patience(&self) -> Duration {
        let bytes = self.bytes();
        let expected = if self.link.is_known() {
            let expected = self.link.expected_round_trip() + self.link.jitter();
            (expected + self.link.time_for(bytes)) * PATIENT_TIMES
        } else {
            Duration::from_secs_f64(bytes as f64 / SLOWEST)
        };
        let first = expected.clamp(LEAST_PATIENCE, MOST_PATIENCE);
        first.saturating_mul(1_u32.checked_shl(self.misses).unwrap_or(u32::MAX)).min(MOST_PATIENCE)
    }
}

#[cfg(test)]
mod scenarios;
#[cfg(test)]
mod simulation;
#[cfg(test)]
mod tests;
