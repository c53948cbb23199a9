//! From held keys to the intents of a step.
//!
//! A tap has a small, exact effect, because motion that starts and stops smoothly covers the same
//! distance as motion that does not: 5 steps of walking are a quarter of a cell, and 10 steps of
//! turning slowly are 5 degrees.

use super::held::Hold;
use crate::game::{Intent, Intents};

/// The number of steps for which a tap of a key wants `intent`, as an argument of
/// [`HeldKeys::press`](super::HeldKeys::press).
pub fn tap_steps(intent: Intent) -> u32 {
    match intent {
        once if once.acts_once() => 1,
        turn if turn.turns() => 10,
        Intent::Open | Intent::LookAhead => 1,
        Intent::Run | Intent::Aim => 0,
        _ => 5,
    }
}

/// The intents of a step, given the intents that are bound to keys and how each key is held.
///
/// Taps turn slowly and never run. A key to duck that may be down counts as held.
pub fn wanted(keys: impl Iterator<Item = (Intent, Hold)>) -> Intents {
    let mut wanted = Intents::new();
    let mut held = Intents::new();
    for (intent, hold) in keys {
        let is_wanted = match intent {
            Intent::Duck => hold != Hold::Up,
            once if once.acts_once() => hold == Hold::Tap,
            _ => matches!(hold, Hold::Tap | Hold::Held),
        };
        if is_wanted {
            wanted.insert(intent);
        }
        if hold == Hold::Held {
            held.insert(intent);
        }
    }
    let taps =
        |is_meant: fn(Intent) -> bool| wanted.iter().any(is_meant) && !held.iter().any(is_meant);
    let (turns_by_taps, walks_by_taps) = (taps(Intent::turns), taps(Intent::walks));
    if turns_by_taps {
        wanted.insert(Intent::Aim);
    }
    if walks_by_taps {
        wanted.remove(Intent::Run);
    }
    wanted
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(keys: &[(Intent, Hold)]) -> Vec<&'static str> {
        wanted(keys.iter().copied()).iter().map(Intent::name).collect()
    }

    #[test]
    fn a_tap_turns_slowly_and_does_not_run() {
        use Hold::{Held, Tap, Unknown};
        use Intent::{Duck, FineLeft, Forward, Run, TurnLeft};
        assert_eq!(names(&[(TurnLeft, Tap)]), ["turn-left", "aim"]);
        assert_eq!(names(&[(TurnLeft, Held)]), ["turn-left"]);
        assert_eq!(names(&[(TurnLeft, Unknown), (Forward, Unknown)]), [""; 0]);
        assert_eq!(names(&[(Forward, Tap), (Run, Held)]), ["forward"]);
        assert_eq!(names(&[(Forward, Held), (Run, Held)]), ["forward", "run"]);
        assert_eq!(names(&[(Duck, Unknown), (FineLeft, Held)]), ["duck"]);
    }
}
