//! What the player is to do in a level, said in one line when it begins.
//!
//! It is told until the player has moved for some time. A clock that hides it was refused: it would draw a frame while
//! nobody moves, and hide it from whoever reads slowly.

use super::played::Played;
use crate::app::MapDisplay;
use crate::game::STEPS_PER_SECOND;

/// Steps in which something moves, until the goal is not told any more: four seconds.
const TOLD_FOR: u64 = 4 * STEPS_PER_SECOND as u64;

/// What the player is to do, and for how long that is told.
#[derive(Clone, Debug)]
pub(super) struct Goal {
    text: String,
    short: String,
    steps_left: u64,
}

impl Goal {
    /// The goal of `game`, by its map if that names one.
    pub(super) fn of(game: &Played, display: MapDisplay) -> Self {
        let (text, short) = match game.goal() {
            Some(own) => (own, own),
            None if game.has_exit() && display == MapDisplay::Off => {
                ("Find the way out", "Find the exit")
            }
            None if game.has_exit() => ("Find the way out: green on the map", "Find the exit"),
            None => ("Roam as you like: no exit here", "Roam around"),
        };
        Self { text: text.to_owned(), short: short.to_owned(), steps_left: TOLD_FOR }
    }

    /// A whole sentence without its full stop.
    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// For where there is not much room.
    pub(super) fn short(&self) -> &str {
        &self.short
    }

    /// Whether it still is to be told.
    pub(super) fn is_told(&self) -> bool {
        self.steps_left > 0
    }

    /// Takes note that so many steps have passed in which something moved.
    pub(super) fn moved(&mut self, steps: u64) {
        self.steps_left = self.steps_left.saturating_sub(steps);
    }
}
