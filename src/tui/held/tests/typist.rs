//! A simulated player.

use super::*;

/// A player at a keyboard that repeats. A step passes every 16 ms.
pub(crate) struct Typist {
    pub(crate) held: HeldKeys<char>,
    keyboard: Keyboard<char>,
    pub(crate) now: u64,
    /// The steps in which a key was tapped.
    pub(crate) tapped: u32,
}

impl Typist {
    pub(crate) fn new((delay, per_second): (u64, u32)) -> Self {
        Self {
            held: HeldKeys::default(),
            keyboard: Keyboard::new(at(delay), per_second),
            now: 0,
            tapped: 0,
        }
    }

    pub(crate) fn press(&mut self, key: char) {
        let key = self.keyboard.press(key, at(self.now));
        press(&mut self.held, key, self.now);
    }

    pub(crate) fn release(&mut self, key: char) {
        self.keyboard.release(key);
    }

    /// Lets time pass, and returns for how many milliseconds each of `keys` was `Held`.
    pub(crate) fn wait<const N: usize>(&mut self, milliseconds: u64, keys: [char; N]) -> [u64; N] {
        let mut held_for = [0; N];
        for _ in 0..milliseconds {
            self.now += 1;
            while let Some((key, due)) = self.keyboard.next_byte(at(self.now)) {
                self.held.press(key, STEPS, due, |other| opposes(key, other));
            }
            self.held.advance(at(self.now));
            for (count, key) in held_for.iter_mut().zip(keys) {
                *count += u64::from(self.held.hold(key) == Hold::Held);
            }
            if self.now.is_multiple_of(16) {
                self.tapped +=
                    self.held.iter().filter(|&(_, hold)| hold == Hold::Tap).count() as u32;
                self.held.step();
            }
        }
        held_for
    }
}
