//! The goal of a level, shown in one line when it begins; and what a key has just done, shown the same way.
//!
//! It is shown until the player has acted for some time. Hiding it by the clock was refused: that
//! would draw a frame while nothing moves, and hide it from slow readers. For the same readers,
//! steps in which only guards move do not count.

use super::played::Played;
use crate::app::MapDisplay;
use crate::game::STEPS_PER_SECOND;

/// The number of steps with intents for which the goal is shown: four seconds.
const SHOWN_FOR: u64 = 4 * STEPS_PER_SECOND as u64;

/// A goal, and how much longer it is shown.
#[derive(Clone, Debug)]
pub(crate) struct Goal {
    text: String,
    short: String,
    steps_left: u64,
}

impl Goal {
    /// The goal of `game`, from its map if that has one.
    pub(crate) fn of(game: &Played, display: MapDisplay) -> Self {
        let (text, short) = match game.goal() {
            Some(own) => (own, own),
            None if game.has_exit() && display == MapDisplay::Off => {
                ("Find the way out", "Find the exit")
            }
            None if game.has_exit() => ("Find the way out: green on the map", "Find the exit"),
            None => ("Roam as you like: no exit here", "Roam around"),
        };
        Self::new(text, short)
    }

    /// A goal with a shorter form for narrow windows. Both are sentences without their full stops.
    pub(crate) fn new(text: &str, short: &str) -> Self {
        Self { text: text.to_owned(), short: short.to_owned(), steps_left: SHOWN_FOR }
    }

    /// A sentence without its full stop.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// A shorter form for narrow windows.
    pub(crate) fn short(&self) -> &str {
        &self.short
    }

    /// Whether the goal is still shown.
    pub(crate) fn is_shown(&self) -> bool {
        self.steps_left > 0
    }

    /// Counts `steps` steps in which the player wanted something.
    pub(crate) fn moved(&mut self, steps: u64) {
        self.steps_left = self.steps_left.saturating_sub(steps);
    }
}
