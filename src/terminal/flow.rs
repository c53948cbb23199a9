//! Flow control: when to send the next frame, so that it does not wait in the link behind others.
//!
//! A write shows no lag: the system and the link accept seconds of frames before they block. So
//! each frame is followed by a request, which the terminal answers when it has processed everything
//! before it. The number of frames in flight has three limits: the frames that occupy the link
//! until the first of them is answered, the frames that 30 frames a second need (Little's law:
//! frames in flight = frames a second × round-trip time), and four. While the answer to the oldest
//! frame is late, no frame is sent: the link may have become slower, and all frames in flight
//! arrive before a new one.
//!
//! Answers arrive in the order of the requests, so that the n-th answer belongs to the n-th request, however late it
//! is. A lost answer is detected at the next *fence*, a request of another kind: when a fence is answered, no answer
//! to an earlier request can still arrive. Every few seconds the request after a frame is a fence.
//!
//! After a timeout, one fence is sent alone and then nothing more: frames that are not received
//! delay the detection of a dead connection. An answer or a key ends this state. A terminal that
//! stays silent, or that never answered, receives no more requests; for it a frame may be sent when
//! the system has accepted the one before.
//!
//! The fidelity of frames follows from the rate and from the bytes that exact frames of motion would take.
//!
//! This module has neither a clock nor a terminal. Its functions receive events and their times,
//! which are durations since any fixed moment.
//!
//! Rejected: a limit in bytes. 16 kB make exact frames coarse (fidelity 6) at 10 Mbit/s and 100 ms. Removing frames
//! after a timeout: their answers are then credited to newer frames, and the link seems faster than it is for as long
//! as anything moves. Raising and lowering the fidelity step by step: it is then late at the beginning of motion, when
//! lag is most noticeable.

mod link;

use std::collections::VecDeque;
use std::time::Duration;

use self::link::Link;
use super::Fidelity;

/// The state of flow control.
#[derive(Debug, Default)]
pub(crate) struct Flow {
    answers: Answers,
    /// The unanswered frames and requests, oldest first.
    in_flight: VecDeque<Sent>,
    /// The number of frames sent so far.
    frames_sent: u64,
    /// The time of the last frame, request or answer.
    active_at: Duration,
    /// The time at which a fence was last sent.
    fenced_at: Duration,
    /// The number of consecutive timeouts.
    timeouts: u32,
    /// Whether a key has arrived since the last frame or request was sent.
    has_input: bool,
    /// The number of removed requests whose answers may still arrive.
    forgotten: usize,
    is_remote: bool,
    link: Link,
    /// The bytes that an exact frame of motion would take, estimated from the sent frames.
    exact_bytes: f64,
}

/// A request to the terminal, after a frame or alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// No request, since the terminal does not answer.
    Nothing,
    /// A request for the terminal's status.
    Status,
    /// A request for the terminal's attributes, which every terminal answers.
    Fence,
}

/// A sent frame, or a request alone, which counts 0 bytes.
#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Duration,
    bytes: usize,
    request: Request,
}

/// Whether the terminal answers requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Answers {
    #[default]
    Unknown,
    Given,
    Never,
}

/// The maximum of frames in flight.
const MAX_FRAMES: usize = 4;
/// The maximum of frames in flight while the link is unknown.
const FIRST_FRAMES: usize = 1;
/// The maximum of frames a second.
const MAX_FRAMES_PER_SECOND: f64 = 30.0;
/// The fidelity of the first frame over a network, at which it takes a quarter of the bytes.
const FIRST_FIDELITY: Fidelity = Fidelity::LOW;

/// The shortest and the longest timeout.
const MIN_TIMEOUT: Duration = Duration::from_secs(1);
const MAX_TIMEOUT: Duration = Duration::from_secs(8);
/// A timeout is this multiple of the expected time.
const TIMEOUT_FACTOR: u32 = 4;
/// The rate of the slowest link, in bytes a second.
const MIN_RATE: f64 = 16_000.0;
/// After this number of consecutive timeouts, with keys between them, a terminal counts as
/// silent.
const MAX_TIMEOUTS: u32 = 5;
/// The time between two requests that are fences.
const FENCE_PERIOD: Duration = Duration::from_secs(5);

/// The number of frames a second for which the rate should suffice.
const FRAMES_PER_SECOND: f64 = 18.0;
/// An exact frame takes 1 + 0.32 t times the bytes of one at tolerance t: 3.6 times at 8, and 8.7
/// times at 24.
const SAVING: f64 = 0.32;
/// The share of a high estimate that is left after one more frame.
const DECAY: f64 = 0.99;
/// The coarsest fidelity: beyond it, fewer frames are better than coarser ones.
const MIN_FIDELITY: Fidelity = Fidelity::new(48);

impl Flow {
    /// Flow control of an unknown link; the link is a network if `is_remote`.
    pub(crate) fn new(is_remote: bool) -> Self {
        Self { is_remote, ..Self::default() }
    }

    /// The request to send after the next frame.
    pub(crate) fn request(&self, now: Duration) -> Request {
        match self.answers {
            Answers::Never => Request::Nothing,
            Answers::Given if self.timeouts > 0 => Request::Fence,
            Answers::Given if now.saturating_sub(self.fenced_at) >= FENCE_PERIOD => Request::Fence,
            Answers::Unknown | Answers::Given => Request::Status,
        }
    }

    /// Records that a frame of this number of bytes was sent, with `request` after it. A frame of 0
    /// bytes is a request alone.
    pub(crate) fn sent(&mut self, now: Duration, bytes: usize, request: Request) {
        if self.is_timed_out(now) {
            self.timeouts = self.timeouts.saturating_add(1);
            if self.answers == Answers::Unknown || self.timeouts >= MAX_TIMEOUTS {
                self.answers = Answers::Never;
                self.in_flight.clear();
            }
        }
        if request == Request::Fence {
            self.fenced_at = now;
        }
        self.frames_sent += u64::from(bytes > 0);
        self.in_flight.push_back(Sent { at: now, bytes, request });
        self.active_at = now;
        self.has_input = false;
    }

    /// Records that the terminal has answered a status request.
    pub(crate) fn answered(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            self.in_flight.clear();
        }
        self.answers = Answers::Given;
        self.timeouts = 0;
        // The answer to a fence would have arrived before.
        while self.in_flight.front().is_some_and(|sent| sent.request == Request::Fence) {
            self.in_flight.pop_front();
        }
        let Some(&sent) = self.in_flight.front() else { return };
        if self.forgotten > 0 && !self.link.is_plausible(now.saturating_sub(sent.at)) {
            self.forgotten -= 1;
            return;
        }
        self.in_flight.pop_front();
        self.take_answer(now, sent);
    }

    /// Records that the terminal has answered a fence, and thus all earlier requests that it will
    /// answer.
    pub(crate) fn fence_answered(&mut self, now: Duration) {
        let is_fence = |sent: &Sent| sent.request == Request::Fence;
        let Some(before) = self.in_flight.iter().position(is_fence) else { return };
        if self.answers == Answers::Unknown && before > 0 {
            self.answers = Answers::Never;
            self.in_flight.clear();
            return;
        }
        self.forgotten = 0;
        let fence = self.in_flight.drain(..=before).next_back();
        if let Some(fence) = fence {
            self.take_answer(now, fence);
        }
    }

    fn take_answer(&mut self, now: Duration, sent: Sent) {
        self.timeouts = 0;
        self.active_at = now;
        // An answer that may belong to a forgotten request is no evidence about the link.
        if self.forgotten == 0 {
            self.link.answered(now, sent.at, sent.bytes);
        }
        self.forgotten = 0;
    }

    /// Records that a key has arrived.
    pub(crate) fn received_input(&mut self) {
        self.has_input = true;
    }

    /// Records that the system has accepted all sent bytes.
    pub(crate) fn written(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            for Sent { at, bytes, .. } in self.in_flight.drain(..) {
                self.link.written(now, at, bytes);
            }
        }
    }

    /// Forgets all requests so far: the terminal may never answer them.
    pub(crate) fn forget(&mut self) {
        self.forgotten = self.in_flight.len();
        self.in_flight.clear();
        self.timeouts = 0;
    }

    /// Whether a frame that is sent now would not wait behind others.
    pub(crate) fn may_send(&self, now: Duration) -> bool {
        match self.answers {
            Answers::Never => self.in_flight.is_empty(),
            Answers::Unknown => self.frames_in_flight() < FIRST_FRAMES || self.is_timed_out(now),
            Answers::Given if self.timeouts > 0 => self.has_input && self.is_timed_out(now),
            Answers::Given => self.has_room() && !self.is_late(now) && !self.is_timed_out(now),
        }
    }

    /// Whether to send a fence alone, to learn whether the terminal is still connected.
    pub(crate) fn probe_is_due(&self, now: Duration) -> bool {
        self.answers == Answers::Given && self.timeouts == 0 && self.is_timed_out(now)
    }

    /// The time at which to call [`Flow::may_send`] again even without an event; `None` for never.
    pub(crate) fn opens_at(&self) -> Option<Duration> {
        let is_silent = self.timeouts > 0 && !self.has_input;
        let due = self.active_at + self.timeout();
        (self.awaits_answers() && !is_silent).then_some(due)
    }

    /// Whether answers may arrive.
    pub(crate) fn awaits_answers(&self) -> bool {
        self.answers != Answers::Never && !self.in_flight.is_empty()
    }

    /// The number of frames sent so far.
    pub(crate) fn frames_sent(&self) -> u64 {
        self.frames_sent
    }

    /// The number of frames that are not in flight any more.
    pub(crate) fn frames_answered(&self) -> u64 {
        self.frames_sent - self.frames_in_flight() as u64
    }

    /// The round-trip time of the latest answer; `None` if there was no answer.
    pub(crate) fn round_trip(&self) -> Option<Duration> {
        self.link.last_round_trip()
    }

    /// The fidelity of the next frame, at which the link carries it in time.
    pub(crate) fn fidelity(&self) -> Fidelity {
        if self.timeouts > 0 && self.answers == Answers::Given {
            return MIN_FIDELITY;
        }
        if self.is_remote && !self.link.is_known() {
            return FIRST_FIDELITY;
        }
        self.link.usable_rate().map_or(Fidelity::EXACT, |rate| self.fidelity_within(rate))
    }

    /// Records that a frame of motion was sent. The first frame does not count as motion, since it
    /// paints the whole screen.
    pub(crate) fn sent_motion(&mut self, bytes: usize, fidelity: Fidelity) {
        if self.link.is_known() {
            let saving = 1.0 + f64::from(fidelity.tolerance()) * SAVING;
            self.exact_bytes = (self.exact_bytes * DECAY).max(bytes as f64 * saving);
        }
    }

    /// The best fidelity for a link that carries `rate` bytes a second.
    fn fidelity_within(&self, rate: f64) -> Fidelity {
        let excess = self.exact_bytes * FRAMES_PER_SECOND / rate;
        let tolerance = (excess - 1.0).max(0.0) / SAVING;
        Fidelity::new(tolerance.min(f64::from(MIN_FIDELITY.tolerance())).round() as u8)
    }

    fn frames_in_flight(&self) -> usize {
        self.in_flight.iter().filter(|sent| sent.bytes > 0).count()
    }

    fn bytes_in_flight(&self) -> usize {
        self.in_flight.iter().map(|sent| sent.bytes).sum()
    }

    fn has_room(&self) -> bool {
        let frames = self.frames_in_flight();
        let occupied = self.link.time_for(self.bytes_in_flight());
        let round_trip = self.link.expected_round_trip();
        let longest = round_trip + self.link.jitter() + self.link.jitter_range();
        let needed = MAX_FRAMES_PER_SECOND * longest.as_secs_f64();
        frames == 0 || frames < MAX_FRAMES && occupied < round_trip && frames as f64 <= needed
    }

    /// Whether the answer to the oldest frame should have arrived.
    fn is_late(&self, now: Duration) -> bool {
        let oldest = self.in_flight.front();
        let latest = oldest.and_then(|sent| self.link.latest_answer(sent.at, sent.bytes));
        latest.is_some_and(|latest| latest < now)
    }

    fn is_timed_out(&self, now: Duration) -> bool {
        self.awaits_answers() && self.active_at + self.timeout() <= now
    }

    fn timeout(&self) -> Duration {
        let bytes = self.bytes_in_flight();
        let expected = if self.link.is_known() {
            let round_trip = self.link.expected_round_trip() + self.link.jitter();
            (round_trip + self.link.time_for(bytes)) * TIMEOUT_FACTOR
        } else {
            Duration::from_secs_f64(bytes as f64 / MIN_RATE)
        };
        let first = expected.clamp(MIN_TIMEOUT, MAX_TIMEOUT);
        // Exponential backoff, as in RFC 6298.
        let factor = 1_u32.checked_shl(self.timeouts).unwrap_or(u32::MAX);
        first.saturating_mul(factor).min(MAX_TIMEOUT)
    }
}

#[cfg(test)]
mod tests;
