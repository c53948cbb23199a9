//! What the player wants, by the keys that are held.
//!
//! A tap is a small, exact thing, since motion that begins and ends smoothly covers as much as one that
//! does not: 5 steps of walking are a quarter of a cell, 10 steps of turning slowly are 5 degrees.

use super::held::Hold;
use crate::game::{Intent, Intents};

/// Which intents turn the player, or how they look up and down.
const TURNS: [Intent; 4] = [Intent::TurnLeft, Intent::TurnRight, Intent::LookUp, Intent::LookDown];
const WALKS: [Intent; 4] = [Intent::Forward, Intent::Back, Intent::StrafeLeft, Intent::StrafeRight];

/// For how many steps a tap of a key wants `intent`: what [`HeldKeys::press`](super::HeldKeys::press) is
/// told.
pub fn tap_steps(intent: Intent) -> u32 {
    use Intent::{AboutFace, FineLeft, FineRight, LookAhead, Open};
    match intent {
        Intent::TurnLeft | Intent::TurnRight | Intent::LookUp | Intent::LookDown => 10,
        Open | LookAhead | FineLeft | FineRight | AboutFace => 1,
        Intent::Run | Intent::Aim => 0,
        _ => 5,
    }
}

/// What is wanted in a step by somebody whose keys mean these intents, each held as it says.
///
/// Taps turn slowly, and do not run. Who may hold the key to duck ducks.
pub fn wanted(keys: impl Iterator<Item = (Intent, Hold)>) -> Intents {
    let mut wanted = Intents::new();
    let mut held = Intents::new();
    for (intent, hold) in keys {
        let is_wanted = match intent {
            Intent::Duck => hold != Hold::Up,
            Intent::FineLeft | Intent::FineRight | Intent::AboutFace => hold == Hold::Tap,
            _ => matches!(hold, Hold::Tap | Hold::Held),
        };
        if is_wanted {
            wanted.insert(intent);
        }
        if hold == Hold::Held {
            held.insert(intent);
        }
    }
    let taps = |intents: [Intent; 4]| {
        intents.iter().any(|&one| wanted.contains(one))
            && !intents.iter().any(|&one| held.contains(one))
    };
    let (aims, steps) = (taps(TURNS), taps(WALKS));
    if aims {
        wanted.insert(Intent::Aim);
    }
    if steps {
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
