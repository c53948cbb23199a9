//! A member's intents, on their way into the log of the room.
//!
//! Intents are sent when they change, at most 30 times a second, and no change is left out: a tap may begin
//! and end within one interval. In addition, the intents of a moving member are sent again regularly, because
//! they also tell the room which step the member saw. Rooms judge touches by that step.
//!
//! The mouse's angles add up until they are sent, because they apply in only one step of the room.

use std::collections::VecDeque;
use std::time::Duration;

use cellcaster::game::{Intents, Look};

/// The shortest interval between two changes: two steps, so that each change takes effect in a separate step.
const MIN_INTERVAL: Duration = Duration::from_millis(34);
/// The interval at which a moving member's intents are sent again.
const RENEWAL_INTERVAL: Duration = Duration::from_millis(250);
/// The maximum number of queued changes. If it is exceeded, all but the newest are dropped.
const MAX_WAITING: usize = 8;

/// A queue of a member's intents.
#[derive(Clone, Debug, Default)]
pub(crate) struct IntentQueue {
    sent: Intents,
    sent_at: Option<Duration>,
    /// The time at which a change was last sent.
    changed_at: Option<Duration>,
    waiting: VecDeque<Intents>,
    /// The turn and the tilt not sent yet, in units of [`Look`].
    angles: [i32; 2],
}

impl IntentQueue {
    /// Sets the member's intents from now on.
    pub(crate) fn set(&mut self, intents: Intents) {
        if self.newest() == intents {
            return;
        }
        if self.waiting.len() >= MAX_WAITING {
            self.waiting.clear();
        }
        self.waiting.push_back(intents);
    }

    /// Adds angles by which the member turns and tilts.
    pub(crate) fn turn(&mut self, by: Look) {
        let [turn, tilt] = self.angles;
        self.angles = [turn + i32::from(by.turn), tilt + i32::from(by.tilt)].map(within);
    }

    /// The member's current intents.
    pub(crate) fn newest(&self) -> Intents {
        *self.waiting.back().unwrap_or(&self.sent)
    }

    /// The intents to send at `now`, if any.
    pub(crate) fn take(&mut self, now: Duration) -> Option<Intents> {
        if self.next_at().is_none_or(|due| due > now) {
            return None;
        }
        if !self.is_renewed() {
            self.changed_at = Some(now);
        }
        self.sent = self.waiting.pop_front().unwrap_or(self.sent);
        self.sent_at = Some(now);
        let [turn, tilt] = std::mem::take(&mut self.angles).map(|angle| angle as i16);
        Some(self.sent.with_look(Look { turn, tilt }))
    }

    /// The time at which [`take`](Self::take) next returns intents; `None` for never.
    pub(crate) fn next_at(&self) -> Option<Duration> {
        let after = |sent: Option<_>, time| sent.map_or(Duration::ZERO, |sent| sent + time);
        match (self.is_renewed(), self.sent.is_empty()) {
            (false, _) => Some(after(self.changed_at, MIN_INTERVAL)),
            (true, false) => Some(after(self.sent_at, RENEWAL_INTERVAL)),
            (true, true) => None,
        }
    }

    /// Returns true if the next intents are the last ones again.
    fn is_renewed(&self) -> bool {
        self.waiting.is_empty() && self.angles == [0, 0]
    }
}

/// The nearest angle that fits into a [`Look`].
fn within(angle: i32) -> i32 {
    angle.clamp(-i32::from(i16::MAX), i16::MAX.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::game::Intent;

    fn at(milliseconds: u64) -> Duration {
        Duration::from_millis(milliseconds)
    }

    #[test]
    fn a_tap_begins_and_ends_in_separate_steps() {
        let mut intents = IntentQueue::default();
        assert_eq!(intents.next_at(), None);
        let strike: Intents = [Intent::Strike].into_iter().collect();
        intents.set(strike);
        assert_eq!(intents.take(at(5)), Some(strike));
        intents.set(Intents::new());
        assert_eq!(intents.take(at(22)), None);
        assert_eq!(intents.next_at(), Some(at(39)));
        assert_eq!(intents.take(at(39)), Some(Intents::new()));
        assert_eq!(intents.next_at(), None);
    }

    #[test]
    fn a_moving_player_resends_the_seen_step() {
        let mut intents = IntentQueue::default();
        let forward: Intents = [Intent::Forward].into_iter().collect();
        intents.set(forward);
        intents.take(at(0));
        intents.set(forward);
        assert_eq!(intents.take(at(249)), None);
        assert_eq!(intents.take(at(250)), Some(forward));
        intents.set(Intents::new());
        assert_eq!(intents.take(at(251)), Some(Intents::new()), "it does not delay a change");
    }

    #[test]
    fn turns_add_up_and_are_sent_once() {
        let mut intents = IntentQueue::default();
        let forward: Intents = [Intent::Forward].into_iter().collect();
        intents.set(forward);
        assert_eq!(intents.take(at(0)), Some(forward));
        intents.turn(Look { turn: 150, tilt: -20 });
        intents.turn(Look { turn: 50, tilt: 0 });
        assert_eq!(intents.take(at(33)), None);
        assert_eq!(intents.take(at(34)), Some(forward.with_look(Look { turn: 200, tilt: -20 })));
        assert_eq!(intents.next_at(), Some(at(284)));
        (0..4).for_each(|_| intents.turn(Look { turn: i16::MIN, tilt: i16::MAX }));
        let most = Look { turn: -i16::MAX, tilt: i16::MAX };
        assert_eq!(intents.take(at(70)), Some(forward.with_look(most)));
    }

    #[test]
    fn the_number_of_waiting_changes_is_bounded() {
        let mut intents = IntentQueue::default();
        let forward: Intents = [Intent::Forward].into_iter().collect();
        for change in 0..1000 {
            intents.set(if change % 2 == 0 { forward } else { Intents::new() });
        }
        assert!(intents.waiting.len() <= MAX_WAITING);
        let last = (0..20).filter_map(|step| intents.take(at(50 * step))).last();
        assert_eq!(last, Some(Intents::new()));
    }
}
