//! Flow control: decides when to send the next frame, so that it does not wait in the link behind others.
//!
//! Writes do not reveal lag, because the system and the link accept seconds of frames before they block. Therefore a
//! request follows each frame, and the terminal answers it when it has processed everything before it. The number of
//! frames in flight has three limits: the frames that occupy the link until the first of them is answered, the frames
//! that 30 frames per second need (Little's law: frames in flight = frames per second × round-trip time), and four.
//! While the answer to the oldest frame is late, no frame is sent. The link may have become slower, and all frames in
//! flight arrive before a new one.
//!
//! Answers arrive in the order of the requests. The n-th answer therefore belongs to the n-th request, however late it
//! is. A lost answer is detected at the next *fence*, a request of another kind: when a fence is answered, no answer to
//! an earlier request can still arrive. Every few seconds the request after a frame is a fence.
//!
//! After a timeout, one fence is sent alone and then nothing more, because frames that are not received delay the
//! detection of a dead connection. An answer or a key ends this state. A terminal that stays silent, or that has never
//! answered, receives no more requests. It receives a frame when the system has accepted the frame before.
//!
//! On a steady link, only every third small frame asks for an answer. A frame without a request counts as in flight
//! until its answer would have arrived at the latest. Each answer costs a server a packet, a decryption and a turn of
//! the session.
//!
//! The fidelity of frames follows from the rate and from the bytes that exact frames of motion would take. The link
//! limits the rate, and so may a [budget]. If frames still exceed the budget, there are fewer of them.
//!
//! If the processor is short, frames are encoded greedily, which takes a third of the time and more bytes. Rejected: a
//! search if greedy frames would be coarser than low fidelity. On a busy server, each late answer then made frames more
//! expensive.
//!
//! This module has neither a clock nor a terminal. Its functions receive events and their times, which are durations
//! since any fixed moment.
//!
//! Rejected: a limit in bytes. A limit of 16 kB makes exact frames coarse (fidelity 6) at 10 Mbit/s and 100 ms.
//!
//! Rejected: removing frames after a timeout. Their answers are then credited to newer frames, and the link seems
//! faster than it is as long as anything moves.
//!
//! Rejected: raising and lowering the fidelity step by step. The fidelity then reacts late at the beginning of motion,
//! when lag is most noticeable.

mod budget;

use std::collections::VecDeque;
use std::num::NonZero;
use std::time::Duration;

use self::budget::Budget;
use crate::terminal::{Effort, Fidelity};

/// The state of flow control.
#[derive(Debug, Default)]
pub(crate) struct Flow {
    answers: Answers,
    /// The unanswered frames and requests, oldest first.
    in_flight: VecDeque<Sent>,
    /// The number of frames sent.
    frames_sent: u64,
    /// The time of the last frame, request or answer.
    active_at: Duration,
    /// The time at which a fence was last sent.
    fenced_at: Duration,
    /// The number of consecutive timeouts.
    timeouts: u32,
    /// `true` if a key has arrived since the last frame or request was sent.
    has_input: bool,
    /// The number of removed requests whose answers may still arrive.
    forgotten: usize,
    /// The number of frames since the last request, and their bytes.
    unasked: [usize; 2],
    is_remote: bool,
    link: Link,
    /// The estimated number of bytes that an exact frame of motion would take.
    exact_bytes: f64,
    budget: Option<Budget>,
    /// The effort to prefer.
    effort: Effort,
}

/// A request to the terminal, after a frame or alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Request {
    /// No request, because the terminal does not answer, or need not answer on a steady link.
    Nothing,
    /// A request for the terminal's status.
    Status,
    /// A request for the terminal's attributes, which every terminal answers.
    Fence,
}

/// A sent frame, or a request alone, which counts as 0 bytes.
#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Duration,
    bytes: usize,
    request: Request,
}

/// Tells whether the terminal answers requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Answers {
    #[default]
    Unknown,
    Given,
    Never,
}

/// The maximum number of frames in flight.
const MAX_FRAMES: usize = 4;
/// The maximum number of frames in flight while the link is unknown.
const FIRST_FRAMES: usize = 1;
/// The maximum number of frames per second.
const MAX_FRAMES_PER_SECOND: f64 = 30.0;
/// The fidelity of the first frame over a network. The frame then takes a quarter of the bytes.
const FIRST_FIDELITY: Fidelity = Fidelity::LOW;

/// The shortest and the longest timeout.
const MIN_TIMEOUT: Duration = Duration::from_secs(1);
const MAX_TIMEOUT: Duration = Duration::from_secs(8);
/// A timeout is this multiple of the time in which an answer is expected.
const TIMEOUT_FACTOR: u32 = 4;
/// The assumed rate of the slowest link, in bytes per second.
const MIN_RATE: f64 = 16_000.0;
/// A terminal counts as silent after this number of consecutive timeouts, with keys between them.
const MAX_TIMEOUTS: u32 = 5;
/// The most frames in a row without a request, and the most bytes of all of them. The game cannot notice that the link
/// stalls until it sends a frame with a request.
const MAX_UNASKED: [usize; 2] = [2, 6_000];
/// The time between two fences.
const FENCE_INTERVAL: Duration = Duration::from_secs(5);

/// The number of frames per second that the rate should sustain.
const FRAMES_PER_SECOND: f64 = 18.0;
/// An exact frame takes 1 + 0.32 t times the bytes of a frame at tolerance t: 3.6 times at 8, and 8.7 times at 24.
/// Greedy frames take fewer bytes at the same tolerance, with larger errors.
const SAVING: f64 = 0.32;
const GREEDY_SAVING: f64 = 0.44;
/// The factor by which a high estimate decreases with each frame.
const DECAY: f64 = 0.99;
/// The coarsest fidelity. Beyond it, fewer frames are better than coarser frames.
const MIN_FIDELITY: Fidelity = Fidelity::new(48);

impl Flow {
    /// Flow control for an unknown link. The link is a network if `is_remote`.
    pub(crate) fn new(is_remote: bool) -> Self {
        Self { is_remote, ..Self::default() }
    }

    /// The request to send after the next frame, which has this number of bytes.
    pub(crate) fn request(&self, now: Duration, bytes: usize) -> Request {
        match self.answers {
            Answers::Never => Request::Nothing,
            Answers::Given if self.timeouts > 0 => Request::Fence,
            Answers::Given if now.saturating_sub(self.fenced_at) >= FENCE_INTERVAL => {
                Request::Fence
            }
            Answers::Given if self.may_be_unasked(bytes) => Request::Nothing,
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
        if let Some(budget) = &mut self.budget {
            budget.sent(now, bytes);
        }
        self.advance(now);
        self.in_flight.push_back(Sent { at: now, bytes, request });
        let [frames, unasked] = self.unasked;
        if request == Request::Nothing {
            self.unasked = [frames + 1, unasked + bytes];
        } else {
            self.unasked = [0; 2];
            self.active_at = now;
        }
        self.has_input = false;
    }

    /// Records that the terminal has answered a status request.
    pub(crate) fn answered(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            self.in_flight.clear();
        }
        self.answers = Answers::Given;
        self.timeouts = 0;
        // The answers to these fences are lost: they would have arrived before this one.
        while self.in_flight.front().is_some_and(|sent| sent.request != Request::Status) {
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

    /// Records that the terminal has answered a fence. No answer to an earlier request can arrive after it.
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

    /// Sets the limit of bytes per second on the wire. `None` means no limit.
    pub(crate) fn set_budget(&mut self, bytes_per_second: Option<NonZero<u32>>) {
        self.budget = bytes_per_second.map(Budget::new);
    }

    /// Records that the wire has carried frames of `bytes` bytes with `on_wire` bytes.
    pub(crate) fn carried(&mut self, bytes: usize, on_wire: usize) {
        if let Some(budget) = &mut self.budget {
            budget.carried(bytes, on_wire);
        }
    }

    /// Sets the effort to prefer.
    pub(crate) fn set_effort(&mut self, effort: Effort) {
        self.effort = effort;
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

    /// Forgets all requests in flight, because the terminal may never answer them.
    pub(crate) fn forget(&mut self) {
        self.forgotten = self.in_flight.len();
        self.in_flight.clear();
        self.timeouts = 0;
    }

    /// Returns true if a frame of this number of bytes needs no request after it.
    fn may_be_unasked(&self, bytes: usize) -> bool {
        let ([frames, unasked], [most, most_bytes]) = (self.unasked, MAX_UNASKED);
        frames < most && unasked + bytes <= most_bytes && self.link.is_steady(bytes)
    }

    /// Removes the frames that have arrived by `now`, although no request followed them.
    pub(crate) fn advance(&mut self, now: Duration) {
        while self.answers == Answers::Given
            && self.in_flight.front().is_some_and(|sent| self.has_arrived(sent, now))
        {
            self.in_flight.pop_front();
        }
    }

    /// Returns true if no answer to a frame can be expected, and it has arrived by `now`.
    fn has_arrived(&self, sent: &Sent, now: Duration) -> bool {
        self.arrives_at(sent).is_some_and(|time| time <= now)
    }

    /// The latest time at which a frame without a request arrives.
    fn arrives_at(&self, sent: &Sent) -> Option<Duration> {
        let is_unasked = sent.request == Request::Nothing && self.answers == Answers::Given;
        self.link.latest_answer(sent.at, sent.bytes).filter(|_| is_unasked)
    }

    /// The time from which on [`Flow::may_send`] is true if no event comes before; `None` for never.
    pub(crate) fn ready_at(&self, now: Duration) -> Option<Duration> {
        let arrivals = self.in_flight.iter().filter_map(|sent| self.arrives_at(sent));
        let mut times = [now].into_iter().chain(arrivals.map(|time| time.max(now)));
        times.find(|&time| self.may_send(time))
    }

    /// Returns true if a frame that is sent now would not wait behind others.
    pub(crate) fn may_send(&self, now: Duration) -> bool {
        match self.answers {
            Answers::Never => self.in_flight.is_empty(),
            Answers::Unknown => self.frames_in_flight() < FIRST_FRAMES || self.is_timed_out(now),
            Answers::Given if self.timeouts > 0 => self.has_input && self.is_timed_out(now),
            Answers::Given => self.has_room(now) && !self.is_late(now) && !self.is_timed_out(now),
        }
    }

    /// Returns true when a fence should be sent alone, to find out whether the terminal is still connected.
    pub(crate) fn probe_is_due(&self, now: Duration) -> bool {
        self.answers == Answers::Given && self.timeouts == 0 && self.is_timed_out(now)
    }

    /// The time at which to call [`Flow::may_send`] again even without an event. `None` means never.
    pub(crate) fn opens_at(&self) -> Option<Duration> {
        let is_silent = self.timeouts > 0 && !self.has_input;
        let due = self.active_at + self.timeout();
        (self.awaits_answers() && !is_silent).then_some(due)
    }

    /// The least time between two frames of motion under the budget.
    pub(crate) fn frame_time(&self) -> Duration {
        self.budget.map(|budget| budget.frame_time()).unwrap_or_default()
    }

    /// The time from which on the budget allows the next frame.
    pub(crate) fn budget_opens_at(&self) -> Duration {
        self.budget.map(|budget| budget.opens_at()).unwrap_or_default()
    }

    /// Returns true while answers may arrive.
    pub(crate) fn awaits_answers(&self) -> bool {
        self.answers != Answers::Never && self.oldest_request().is_some()
    }

    fn oldest_request(&self) -> Option<&Sent> {
        self.in_flight.iter().find(|sent| sent.request != Request::Nothing)
    }

    /// The number of frames sent.
    pub(crate) fn frames_sent(&self) -> u64 {
        self.frames_sent
    }

    /// The number of frames that are no longer in flight.
    pub(crate) fn frames_answered(&self) -> u64 {
        self.frames_sent - self.frames_in_flight() as u64
    }

    /// The round-trip time of the latest answer; `None` if there was no answer.
    pub(crate) fn round_trip(&self) -> Option<Duration> {
        self.link.last_round_trip()
    }

    /// The fidelity at which the link and the budget carry the next frame in time, and the effort for it.
    pub(crate) fn quality(&self) -> (Fidelity, Effort) {
        if self.timeouts > 0 && self.answers == Answers::Given {
            return (MIN_FIDELITY, self.effort);
        }
        if self.is_remote && !self.link.is_known() {
            return (FIRST_FIDELITY, self.effort);
        }
        let of_link =
            self.link.usable_rate().map(|rate| self.exact_bytes * FRAMES_PER_SECOND / rate);
        let of_budget = self.budget.map(|budget| budget.excess());
        let excess = of_link.into_iter().chain(of_budget).fold(0.0, f64::max);
        (fidelity_for(excess, self.effort), self.effort)
    }

    /// Records that a frame of motion was sent. The first frame does not count as motion, because it paints the whole
    /// screen.
    pub(crate) fn sent_motion(&mut self, bytes: usize, (fidelity, effort): (Fidelity, Effort)) {
        let exact_bytes =
            bytes as f64 * (1.0 + f64::from(fidelity.tolerance()) * saving_of(effort));
        if self.link.is_known() {
            self.exact_bytes = (self.exact_bytes * DECAY).max(exact_bytes);
        }
        if let Some(budget) = &mut self.budget {
            budget.sent_motion(exact_bytes);
        }
    }

    fn frames_in_flight(&self) -> usize {
        self.in_flight.iter().filter(|sent| sent.bytes > 0).count()
    }

    fn bytes_in_flight(&self) -> usize {
        self.in_flight.iter().map(|sent| sent.bytes).sum()
    }

    fn has_room(&self, now: Duration) -> bool {
        let in_flight = self.in_flight.iter().filter(|sent| !self.has_arrived(sent, now));
        let frames = in_flight.clone().filter(|sent| sent.bytes > 0).count();
        let occupied = self.link.time_for(in_flight.map(|sent| sent.bytes).sum());
        let round_trip = self.link.expected_round_trip();
        let longest = round_trip + self.link.jitter() + self.link.jitter_range();
        let needed = MAX_FRAMES_PER_SECOND * longest.as_secs_f64();
        frames == 0 || frames < MAX_FRAMES && occupied < round_trip && frames as f64 <= needed
    }

    /// Returns true if the answer to the oldest frame should have arrived.
    fn is_late(&self, now: Duration) -> bool {
        let oldest = self.oldest_request();
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

/// The best fidelity if exact frames take `excess` times the available bytes.
fn fidelity_for(excess: f64, effort: Effort) -> Fidelity {
    let tolerance = (excess - 1.0).max(0.0) / saving_of(effort);
    Fidelity::new(tolerance.min(f64::from(MIN_FIDELITY.tolerance())).round() as u8)
}

fn saving_of(effort: Effort) -> f64 {
    match effort {
        Effort::Search => SAVING,
        Effort::Greedy => GREEDY_SAVING,
    }
}

/// Estimates of a link's properties from the terminal's answers: minimum round-trip time, rate and jitter.
#[derive(Debug, Default)]
pub(crate) struct Link {
    min_round_trip: Option<MinRoundTrip>,
    last_round_trip: Option<Duration>,
    answered_at: Duration,
    fit: Fit,
    /// The latest frame, if it took far longer than expected.
    outlier: Option<Transfer>,
    stalled_at: Option<Duration>,
    /// The number of answers since the last outlier.
    steady_answers: u32,
}

/// A frame, and the time for which it occupied the link.
#[derive(Clone, Copy, Debug)]
struct Transfer {
    bytes: f64,
    seconds: f64,
}

/// The shortest time of a frame that can be measured.
const MIN_TRANSFER: Duration = Duration::from_micros(100);
/// A frame is an outlier if it exceeds the expected time by this number of standard deviations, and also by this number
/// of seconds.
const OUTLIER_DEVIATIONS: f64 = 4.0;
const OUTLIER_SECONDS: f64 = 0.25;
/// An outlier of at least this number of seconds is a stall. A shorter one may be jitter.
const STALL_SECONDS: f64 = 1.0;
/// The factor by which the fitted time per byte is increased, up to the slope of the line through the origin. If the
/// time grows with the bytes, the link is narrow, and other frames on it may cause the constant part of the time.
/// Rejected: no margin. Two sessions on 2 Mbit/s then send finer frames than their shares carry, 12.5 per second
/// instead of 20. Rejected: the whole margin (the line through the origin). Jitter then counts as slowness: at 1 Mbit/s
/// with 0 to 50 ms of jitter, the largest error of frames is 41 instead of 21.
const SLOPE_MARGIN: f64 = 1.5;
/// The number of answers without an outlier after which a link is steady.
const STEADY_ANSWERS: u32 = 20;
/// The longest time for which a frame occupies a steady link, so that frames do not meet, and its most jitter.
const STEADY_TRANSFER: Duration = Duration::from_millis(10);
const STEADY_JITTER: Duration = Duration::from_millis(50);
/// An answer is late after this number of standard deviations: Jacobson and Karels, RFC 6298.
const LATE_DEVIATIONS: f64 = 4.0;
/// The resolution of the times of answers.
const CLOCK_GRANULARITY: Duration = Duration::from_millis(10);
/// The limit of bytes in flight after a stall: this number of bytes, or the bytes that the link carries in this number
/// of seconds, whichever is larger. If the link stalls again, all of them arrive before anything newer.
const AFTER_STALL_BYTES: f64 = 16_000.0;
const AFTER_STALL_SECONDS: f64 = 0.024;
/// The time for which this limit applies.
const AFTER_STALL_DURATION: Duration = Duration::from_mins(1);
/// The longest computed time, in seconds: one day.
const MAX_SECONDS: f64 = 86_400.0;

impl Link {
    /// Updates the estimates with the answer to a frame.
    pub(crate) fn answered(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        let round_trip = now.saturating_sub(sent_at);
        let minimum = MinRoundTrip::with(self.min_round_trip, now, round_trip);
        // The link carries the frame from the moment at which its first byte could arrive, but not before the previous
        // frame has arrived.
        let begun = (sent_at + minimum.get()).max(self.answered_at);
        self.add_transfer(now, bytes, now.saturating_sub(begun));
        self.min_round_trip = Some(minimum);
        self.last_round_trip = Some(round_trip);
        self.answered_at = now;
    }

    /// Updates the estimates with a frame that the system has accepted.
    pub(crate) fn written(&mut self, now: Duration, sent_at: Duration, bytes: usize) {
        self.add_transfer(now, bytes, now.saturating_sub(sent_at));
        self.answered_at = now;
    }

    /// Adds a frame to the fit. A single outlier is a stall, which is no evidence about the rate. Two in a row mean
    /// that the link has changed.
    fn add_transfer(&mut self, now: Duration, bytes: usize, time: Duration) {
        if bytes == 0 {
            return;
        }
        let seconds = time.max(MIN_TRANSFER).as_secs_f64();
        let transfer = Transfer { bytes: bytes as f64, seconds };
        self.steady_answers = self.steady_answers.saturating_add(1);
        match self.outlier.take() {
            None if self.is_outlier(transfer) => {
                self.outlier = Some(transfer);
                self.steady_answers = 0;
                if seconds >= STALL_SECONDS {
                    self.stalled_at = Some(now);
                }
            }
            Some(before) if self.is_outlier(transfer) => {
                self.fit = Fit::default();
                self.fit.add(before.bytes, before.seconds);
                self.fit.add(transfer.bytes, transfer.seconds);
            }
            _ => self.fit.add(transfer.bytes, transfer.seconds),
        }
    }

    fn is_outlier(&self, Transfer { bytes, seconds }: Transfer) -> bool {
        self.fit.line.is_some_and(|line| {
            let expected = line.constant + line.per_byte * bytes;
            seconds > expected + (OUTLIER_DEVIATIONS * line.deviation).max(OUTLIER_SECONDS)
        })
    }

    /// Returns true if the link has carried a frame.
    pub(crate) fn is_known(&self) -> bool {
        self.fit.mean().is_some()
    }

    /// Returns true if the time at which a frame of this number of bytes arrives is known well enough.
    fn is_steady(&self, bytes: usize) -> bool {
        self.steady_answers >= STEADY_ANSWERS
            && self.time_for(bytes) <= STEADY_TRANSFER
            && self.jitter_range() <= STEADY_JITTER
    }

    /// Returns true if an answer can arrive after so short a time.
    fn is_plausible(&self, round_trip: Duration) -> bool {
        self.min_round_trip.is_none_or(|minimum| round_trip >= minimum.get() / 2)
    }

    /// The round-trip time of the latest answer.
    fn last_round_trip(&self) -> Option<Duration> {
        self.last_round_trip
    }

    fn seconds_per_byte(&self) -> f64 {
        let usual = self
            .fit
            .line
            .map_or(0.0, |line| (line.per_byte * SLOPE_MARGIN).min(line.through_origin));
        self.outlier.map_or(usual, |transfer| usual.max(transfer.seconds / transfer.bytes))
    }

    /// The maximum number of bytes to send per second. `None` means no maximum.
    fn usable_rate(&self) -> Option<f64> {
        let seconds = self.seconds_per_byte();
        let rate = (seconds > 0.0).then(|| seconds.recip());
        let is_past = |at| self.answered_at.saturating_sub(at) > AFTER_STALL_DURATION;
        if self.stalled_at.is_none_or(is_past) {
            return rate;
        }
        let in_flight = (AFTER_STALL_SECONDS * rate.unwrap_or(0.0)).max(AFTER_STALL_BYTES);
        let limit = in_flight / self.expected_round_trip().as_secs_f64().max(1e-3);
        Some(rate.map_or(limit, |rate| rate.min(limit)))
    }

    /// The time for which this number of bytes occupies the link.
    fn time_for(&self, bytes: usize) -> Duration {
        Duration::from_secs_f64((bytes as f64 * self.seconds_per_byte()).min(MAX_SECONDS))
    }

    /// The expected round-trip time of a frame of mean size that no other frame delays.
    fn expected_round_trip(&self) -> Duration {
        let bytes = self.fit.mean().map_or(0.0, |(bytes, _)| bytes);
        self.min_round_trip() + self.time_for(bytes as usize)
    }

    /// The mean excess of a round trip over its expected time.
    pub(crate) fn jitter(&self) -> Duration {
        Duration::from_secs_f64(self.fit.line.map_or(0.0, |line| line.constant))
    }

    /// The maximum excess of a round trip over its mean, unless the link has changed.
    fn jitter_range(&self) -> Duration {
        let deviation = self.fit.line.map_or(0.0, |line| line.deviation);
        Duration::from_secs_f64(LATE_DEVIATIONS * deviation)
    }

    /// The latest time at which the answer to the oldest frame in flight arrives, unless the link
    /// has changed; `None` if the link is unknown.
    fn latest_answer(&self, sent_at: Duration, bytes: usize) -> Option<Duration> {
        let begun = (sent_at + self.min_round_trip()).max(self.answered_at);
        let time = self.time_for(bytes) + self.jitter() + self.jitter_range();
        self.is_known().then(|| begun + time + CLOCK_GRANULARITY)
    }

    fn min_round_trip(&self) -> Duration {
        self.min_round_trip.map(MinRoundTrip::get).unwrap_or_default()
    }
}

/// The time for which a frame occupies the link, as a function of its bytes: a line through recent frames. It is
/// computed from sums over the frames, in bytes and seconds.
///
/// A frame of b bytes takes c + b / rate. Weighted least squares finds both coefficients, with weights that fall
/// exponentially with age (Haykin, *Adaptive Filter Theory*, "recursive least squares"). Google's congestion control
/// estimates the same pair with a Kalman filter over differences (draft-alvestrand-rmcat-congestion, "arrival-time
/// filter").
///
/// Frames of one size do not determine c. A point at 0 bytes and 0 seconds represents the expectation that there is no
/// jitter. Its weight is small, and frames of different sizes outweigh it.
///
/// Rejected: the quotient of bytes and time as the rate. Jitter then lowers the rate. Frames become smaller, and jitter
/// lowers the rate further, until frames are as small as possible.
#[derive(Clone, Copy, Debug, Default)]
struct Fit {
    weight: f64,
    bytes: f64,
    seconds: f64,
    bytes_squared: f64,
    products: f64,
    seconds_squared: f64,
    /// The line, with neither coefficient below zero; `None` if there was no frame.
    line: Option<FittedLine>,
}

/// The line, in seconds and seconds per byte.
#[derive(Clone, Copy, Debug)]
struct FittedLine {
    /// The time of a frame of 0 bytes.
    constant: f64,
    per_byte: f64,
    /// The slope of the line through the origin, which is the largest possible slope.
    through_origin: f64,
    /// The standard deviation of frames from the line.
    deviation: f64,
}

/// The factor by which the weight of the past decreases with each frame.
const FORGETTING_FACTOR: f64 = 0.97;
/// The weight of the point at the origin, relative to the latest frame's weight.
const ORIGIN_WEIGHT: f64 = 0.25;

impl Fit {
    /// Adds a frame.
    fn add(&mut self, bytes: f64, seconds: f64) {
        self.weight = self.weight * FORGETTING_FACTOR + 1.0;
        self.bytes = self.bytes * FORGETTING_FACTOR + bytes;
        self.seconds = self.seconds * FORGETTING_FACTOR + seconds;
        self.bytes_squared = self.bytes_squared * FORGETTING_FACTOR + bytes * bytes;
        self.products = self.products * FORGETTING_FACTOR + bytes * seconds;
        self.seconds_squared = self.seconds_squared * FORGETTING_FACTOR + seconds * seconds;
        self.line = self.fitted();
    }

    /// The mean bytes and seconds of a frame; `None` if there was no frame.
    fn mean(&self) -> Option<(f64, f64)> {
        (self.weight > 0.0).then(|| (self.bytes / self.weight, self.seconds / self.weight))
    }

    fn fitted(&self) -> Option<FittedLine> {
        let (mean_bytes, mean_seconds) = self.mean()?;
        let weight = self.weight + ORIGIN_WEIGHT;
        let (center_bytes, center_seconds) = (self.bytes / weight, self.seconds / weight);
        let variance = self.bytes_squared - center_bytes * self.bytes;
        let covariance = self.products - center_bytes * self.seconds;
        if variance <= 0.0 {
            return None;
        }
        let through_origin = mean_seconds / mean_bytes;
        let per_byte = (covariance / variance).clamp(0.0, through_origin);
        let constant = center_seconds - per_byte * center_bytes;
        let total = self.seconds_squared - center_seconds * self.seconds;
        let residual = (total - 2.0 * per_byte * covariance + per_byte * per_byte * variance)
            .max(0.0)
            / weight;
        let deviation = residual.sqrt();
        Some(FittedLine { constant: constant.max(0.0), per_byte, through_origin, deviation })
    }
}

/// The minimum of recent round-trip times, over this half of a window and the one before it: the delay of the link in
/// both directions, without queues. This is the windowed minimum filter of BBR
/// (draft-cardwell-iccrg-bbr-congestion-control, "`BBR.min_rtt`").
///
/// Rejected: the minimum of all times. It would stay wrong after the route has become longer.
#[derive(Clone, Copy, Debug)]
struct MinRoundTrip {
    since: Duration,
    current: Duration,
    previous: Duration,
}

/// The length of half a window.
const HALF_WINDOW: Duration = Duration::from_secs(30);

impl MinRoundTrip {
    /// The minimum after a `round_trip` that ended at `now`.
    fn with(before: Option<Self>, now: Duration, round_trip: Duration) -> Self {
        match before {
            None => Self { since: now, current: round_trip, previous: round_trip },
            Some(old) if now.saturating_sub(old.since) > HALF_WINDOW => {
                Self { since: now, current: round_trip, previous: old.current }
            }
            Some(old) => Self { current: old.current.min(round_trip), ..old },
        }
    }

    fn get(self) -> Duration {
        self.current.min(self.previous)
    }
}

#[cfg(test)]
mod tests;
