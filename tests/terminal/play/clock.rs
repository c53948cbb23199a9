//! A keyboard for a program whose time is the number of focus reports that it has read.
//!
//! The program is started with `CELLCASTER_CLOCK=focus` (see `src/app/time.rs`). Time that is sent
//! as input is ordered with the keys, so a game is the same on every machine and under any load.
//! The test waits for the screen in real time, while the program's time stands still.

use std::cell::Cell;
use std::ops::{Deref, DerefMut};

use crate::emulator::Speaks;
use crate::player::Player;

/// The variable that selects this clock.
pub(crate) const CLOCK: (&str, &str) = ("CELLCASTER_CLOCK", "focus");

/// The report that the window has the focus, and the largest number of reports in one write. A
/// write of less than 256 bytes is read at once, so no report is split.
const STEP: &str = "\x1b[I";
const MAX_STEPS: u32 = 64;
/// The number of steps before the first repetition of a key, half a second, and the number of steps
/// between two repetitions.
const FIRST_DELAY: u32 = 30;
const INTERVAL: u32 = 2;
/// The number of steps after which a change is on the screen: two frames.
const FRAMES: u32 = 4;

/// A player at such a program.
pub(crate) struct Typist {
    player: Player,
    steps: Cell<u32>,
}

impl Typist {
    /// Starts `program`. It uses this clock if [`CLOCK`] is in `environment`.
    pub(crate) fn start(program: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let player = Player::start((80, 24), Speaks::Plain, program, arguments, environment);
        Self { player, steps: Cell::new(0) }
    }

    /// Lets `steps` steps of the game pass.
    pub(crate) fn pass(&self, mut steps: u32) {
        while steps > 0 {
            let some = steps.min(MAX_STEPS);
            self.send(STEP.repeat(some as usize));
            self.wait_until_read();
            steps -= some;
            self.steps.set(self.steps.get() + some);
        }
    }

    /// The number of steps that have passed.
    pub(crate) fn steps(&self) -> u32 {
        self.steps.get()
    }

    /// Presses `key` and releases it, and lets `steps` steps pass.
    pub(crate) fn tap(&self, key: &str, steps: u32) {
        self.send(key);
        self.pass(steps);
    }

    /// Holds `key` for `steps` steps: sends its byte, and its repetitions after the first delay.
    pub(crate) fn hold(&self, key: &str, steps: u32) {
        self.tap(key, steps.min(FIRST_DELAY));
        for _ in 0..steps.saturating_sub(FIRST_DELAY) / INTERVAL {
            self.tap(key, INTERVAL);
        }
    }

    /// Lets enough time pass for the screen to be drawn, and waits until it shows `text`.
    #[track_caller]
    pub(crate) fn wait_to_see(&self, text: &str) {
        self.pass(FRAMES);
        self.wait_for(text);
    }
}

impl Deref for Typist {
    type Target = Player;

    fn deref(&self) -> &Player {
        &self.player
    }
}

impl DerefMut for Typist {
    fn deref_mut(&mut self) -> &mut Player {
        &mut self.player
    }
}
