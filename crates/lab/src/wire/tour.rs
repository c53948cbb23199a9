//! A short walk through any level.

use std::num::NonZeroU32;

use cellcaster::game::{Game, STEPS_PER_SECOND, Script};

const TOUR: &str = "\
[tour]
1 s    forward
1 s    turn-left
0.5 s  forward turn-right
1 s    turn-right aim
0.5 s  strafe-left
";

/// Walks through a level. `show` takes the number and the state of each frame.
pub(crate) fn walk(
    mut game: Game,
    frames_per_second: NonZeroU32,
    mut show: impl FnMut(usize, &Game),
) {
    let script = Script::parse(TOUR, "tour").unwrap_or_else(|faults| unreachable!("{faults}"));
    let frames_after =
        |steps: u64| steps * u64::from(frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
    show(0, &game);
    let mut frames = 1;
    for (steps, (_, intents)) in (0..).zip(script.iter()) {
        game.step(intents);
        if frames_after(steps + 1) > frames_after(steps) {
            show(frames, &game);
            frames += 1;
        }
    }
}
