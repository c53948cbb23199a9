//! The level that plays itself behind the title.
//!
//! It has no guards: their pictures take twice the time of everything else in the first frame.

use super::played::Played;
use super::script_cursor::ScriptCursor;
use crate::game::{Intents, Script};
use crate::map::{Level, builtin};

/// The level, and the script that plays it.
const LEVEL: &str = "citadel";
const SCRIPT: &str = include_str!("../../maps/showcase.script");

/// A level that a script plays, again and again.
pub(crate) struct Demo {
    level: &'static builtin::Level,
    cursor: ScriptCursor,
}

impl Demo {
    /// The demo and its level at the start. Only this level is read, as the first picture of the
    /// program needs no other.
    pub(crate) fn begin() -> Option<(Self, Played)> {
        let level = builtin::LEVELS.iter().find(|level| level.name == LEVEL)?;
        let script = Script::parse(SCRIPT, "showcase").ok()?;
        let demo = Self { level, cursor: ScriptCursor::new(&script) };
        let played = demo.again()?;
        Some((demo, played))
    }

    /// The intents of the next step; `None` at the end of the script.
    pub(crate) fn next(&mut self) -> Option<Intents> {
        self.cursor.next()
    }

    /// Returns to the start of the script, and returns the level at its start.
    pub(crate) fn rewind(&mut self) -> Option<Played> {
        self.cursor.rewind();
        self.again()
    }

    fn again(&self) -> Option<Played> {
        let world = self.level.world().ok()?.without_guards();
        Some(Played::new(Level::from(world)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_demo_moves_and_comes_to_its_end() {
        let (mut demo, mut played) = Demo::begin().unwrap();
        let start = played.grid().unwrap().clone();
        let mut steps = 0;
        while let Some(intents) = demo.next() {
            played.step(intents);
            steps += 1;
        }
        assert!(steps > 600, "{steps} steps");
        assert_ne!(*played.grid().unwrap(), start);
        assert_eq!(*demo.rewind().unwrap().grid().unwrap(), start);
        assert!(demo.next().is_some());
    }
}
