//! Watches the game for what the terminal's bell is rung for: the player is hurt, or is noticed.

use crate::game::{Alarm, Game};

/// The last state, to compare the next one with.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watch {
    alarm: Alarm,
    health: u8,
    /// Whether something has happened since [`Watch::take_ring`].
    rings: bool,
}

impl Watch {
    /// A watch that begins with the state of `game`.
    pub(super) fn begin(game: Option<&Game>) -> Self {
        let mut watch = Self::default();
        if let Some(game) = game {
            watch.look(game);
        }
        Self { rings: false, ..watch }
    }

    /// Looks at the state after a step.
    pub(super) fn look(&mut self, game: &Game) {
        let (alarm, health) = (game.alarm(), game.health().points);
        self.rings |= alarm > self.alarm || health < self.health;
        (self.alarm, self.health) = (alarm, health);
    }

    /// Whether something has happened since the last call.
    pub(super) fn take_ring(&mut self) -> bool {
        std::mem::take(&mut self.rings)
    }
}
