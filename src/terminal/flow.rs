//! When the next frame may be sent, so that none waits in the link behind others.
//!
//! A write says nothing about lag: the system and the link take seconds of frames before they
//! take no more. So each frame is followed by a status request, which the terminal answers when
//! it has come that far, and only a few frames may be unanswered: as many as keep the link busy
//! until the answer to the first of them is back, and four at the most.
//!
//! An answer that is lost must not end the game: after a while without any, a frame is sent
//! anyhow, and the while is doubled. A terminal that passes over requests is not asked any more; for
//! it a frame may be sent when the one before has been written.
//!
//! All this is told of what happens, and when, in times that count from any moment; it has no clock
//! and no terminal.

mod demand;
mod link;

use std::collections::VecDeque;
use std::time::Duration;

use self::demand::Demand;
use self::link::Link;
use super::Fidelity;

/// What is known of the frames on their way, and what follows from it for the next one.
#[derive(Debug, Default)]
pub(super) struct Flow {
    answers: Answers,
    /// The unanswered frames, oldest first.
    in_flight: VecDeque<Sent>,
    /// When a frame was last sent, or answered.
    active_at: Duration,
    /// How often in a row a frame was sent because there was no answer.
    misses: u32,
    /// How many frames were given up whose answers may be late rather than lost.
    given_up: usize,
    link: Link,
    demand: Demand,
}

/// Whether the terminal answers status requests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Answers {
    #[default]
    Unknown,
    Given,
    Never,
}

/// A frame on its way.
#[derive(Clone, Copy, Debug)]
struct Sent {
    at: Duration,
    bytes: usize,
}

/// The most frames that may be unanswered.
pub(super) const WIDEST_WINDOW: usize = 4;
/// The most while nothing is known of the link.
const FIRST_WINDOW: usize = 2;

/// The least time after which an answer counts as lost, and the most.
const LEAST_PATIENCE: Duration = Duration::from_secs(1);
pub(super) const MOST_PATIENCE: Duration = Duration::from_secs(8);
/// How many times longer than expected an answer may take.
const PATIENT_TIMES: u32 = 4;
/// What a link carries that nothing is known of, if it is as slow as one can be: bytes a second.
const SLOWEST: f64 = 16_000.0;

impl Flow {
    /// Whether a status request belongs after the next frame.
    pub(super) fn asks(&self) -> bool {
        self.answers != Answers::Never
    }

    /// Takes note that a frame of so many bytes was sent, with a request after it if it [`asks`].
    ///
    /// [`asks`]: Self::asks
    pub(super) fn sent(&mut self, now: Duration, bytes: usize) {
        if self.is_overdue(now) {
            self.given_up = self.in_flight.drain(..).len();
            self.misses = self.misses.saturating_add(1);
            if self.answers == Answers::Unknown {
                self.answers = Answers::Never;
            }
        }
        self.in_flight.push_back(Sent { at: now, bytes });
        self.active_at = now;
    }

    /// Takes note that the terminal has answered a request.
    pub(super) fn answered(&mut self, now: Duration) {
        self.answers = Answers::Given;
        let Some(&Sent { at, bytes }) = self.in_flight.front() else { return };
        if self.given_up > 0 && !self.link.is_plausible(now.saturating_sub(at)) {
            self.given_up -= 1;
            return;
        }
        self.in_flight.pop_front();
        self.misses = 0;
        self.active_at = now;
        if self.given_up > 0 {
            // It may be the answer to one of those, and says nothing of the link.
            self.given_up = 0;
        } else {
            self.link.answered(now, at, bytes);
        }
    }

    /// Takes note that the terminal has passed over a request, and answered what was asked later.
    pub(super) fn passed_over(&mut self) {
        if self.answers == Answers::Unknown {
            self.answers = Answers::Never;
            self.in_flight.clear();
        }
    }

    /// Takes note that the system has taken all that was sent.
    pub(super) fn taken(&mut self, now: Duration) {
        if self.answers == Answers::Never {
            for Sent { at, bytes } in self.in_flight.drain(..) {
                self.link.taken(now, at, bytes);
            }
        }
    }

    /// Takes note that nobody answers any more what was asked so far.
    pub(super) fn forget(&mut self) {
        self.in_flight.clear();
        self.given_up = 0;
        self.misses = 0;
    }

    /// Whether a frame that is sent now does not wait behind others.
    pub(super) fn may_send(&self, now: Duration) -> bool {
        self.has_room() || self.is_overdue(now)
    }

    /// When a frame may be sent even if nothing happens until then; `None` for never.
    pub(super) fn opens_at(&self) -> Option<Duration> {
        (self.asks() && !self.in_flight.is_empty()).then(|| self.active_at + self.patience())
    }

    /// Whether answers are on their way.
    pub(super) fn awaits_answers(&self) -> bool {
        self.asks() && !self.in_flight.is_empty()
    }

    /// How long the latest answer took; `None` where there was none.
    pub(super) fn round_trip(&self) -> Option<Duration> {
        self.link.round_trip()
    }

    /// How exact the next frame should be, so that the link can take it in time.
    pub(super) fn fidelity(&self) -> Fidelity {
        self.link.rate().map_or(Fidelity::EXACT, |rate| self.demand.fidelity_within(rate))
    }

    /// Takes note that something has moved, and that it took so many bytes to show it.
    pub(super) fn showed_motion(&mut self, bytes: usize, fidelity: Fidelity) {
        self.demand.showed_motion(bytes, fidelity);
    }

    fn has_room(&self) -> bool {
        if self.in_flight.is_empty() {
            return true;
        }
        match self.answers {
            Answers::Never => false,
            Answers::Unknown => self.in_flight.len() < FIRST_WINDOW,
            Answers::Given if self.misses > 0 => false,
            Answers::Given => self.in_flight.len() < WIDEST_WINDOW && !self.keeps_link_busy(),
        }
    }

    /// Whether what is on its way keeps the link busy until the answer to a frame would be back.
    fn keeps_link_busy(&self) -> bool {
        let bytes: usize = self.in_flight.iter().map(|sent| sent.bytes).sum();
        match self.link.time_for(bytes) {
            Some(busy) => busy >= self.link.expected_round_trip(),
            None => self.in_flight.len() >= FIRST_WINDOW,
        }
    }

    fn is_overdue(&self, now: Duration) -> bool {
        self.opens_at().is_some_and(|time| time <= now)
    }

    /// How long there may be no answer until those to come count as lost.
    fn patience(&self) -> Duration {
        let bytes = self.in_flight.iter().map(|sent| sent.bytes).sum();
        let expected = match self.link.time_for(bytes) {
            Some(busy) => (self.link.expected_round_trip() + busy) * PATIENT_TIMES,
            None => Duration::from_secs_f64(bytes as f64 / SLOWEST),
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
