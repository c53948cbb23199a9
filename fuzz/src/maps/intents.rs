//! Intents from bytes.

use cellcaster::game::{Intent, Intents, Look};

use crate::bytes::Bytes;

/// Intents that are held for a number of steps.
pub(crate) struct Stretch {
    pub(crate) steps: u64,
    pub(crate) intents: Intents,
}

/// The next stretch of a script.
pub(crate) fn stretch(choices: &mut Bytes) -> Stretch {
    let bits = choices.double_word();
    let held = Intent::ALL.into_iter().zip(0..).filter(|(_, bit)| bits >> bit & 1 == 1);
    let intents: Intents = held.map(|(intent, _)| intent).collect();
    // This bit is beyond the last intent.
    let looks = bits >> 31 == 1;
    let look = if looks {
        Look { turn: choices.word().cast_signed(), tilt: choices.word().cast_signed() }
    } else {
        Look::NONE
    };
    Stretch { steps: 1 + choices.below(64) as u64, intents: intents.with_look(look) }
}

/// The player's intents in a map without choices: walk around, jump, and use everything.
pub(crate) fn usual() -> Vec<Stretch> {
    use Intent::{
        Duck, FineRight, Forward, Jump, Run, Shoot, Smoke, StrafeLeft, Strike, Throw, TurnRight,
    };
    let held: [(u64, &[Intent]); 10] = [
        (30, &[Forward, Run]),
        (20, &[Forward, TurnRight]),
        (30, &[Forward, Jump]),
        (20, &[Duck, Forward]),
        (2, &[Throw, FineRight]),
        (2, &[Shoot]),
        (2, &[Smoke]),
        (10, &[Strike, StrafeLeft, Forward]),
        (30, &[Forward, Run]),
        (30, &[]),
    ];
    let stretch = |(steps, held): (u64, &[Intent])| Stretch {
        steps,
        intents: held.iter().copied().collect(),
    };
    held.map(stretch).into()
}
