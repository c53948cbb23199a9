//! Watches the game for what the terminal's bell is rung for: the player is hurt, or is noticed.

use crate::game::{Alarm, Game, PlayerId};

/// The last state, to compare the next one with.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watch {
    alarm: Alarm,
    health: u8,
    /// Whether something has happened since [`Watch::take_ring`].
    rings: bool,
}

impl Watch {
    /// A watch that begins with the state of `game`.
    pub(crate) fn begin(game: Option<&Game>) -> Self {
        let mut watch = Self::default();
        if let Some(game) = game {
            watch.look(game);
        }
        watch.silenced()
    }

    /// A watch that begins with the state of `player` in `game`.
    pub fn of(game: &Game, player: PlayerId) -> Self {
        let mut watch = Self::default();
        watch.look_at(game, player);
        watch.silenced()
    }

    fn silenced(self) -> Self {
        Self { rings: false, ..self }
    }

    /// Looks at the state after a step.
    pub(crate) fn look(&mut self, game: &Game) {
        self.look_at(game, PlayerId::FIRST);
    }

    /// Looks at the state of `player` after a step.
    pub fn look_at(&mut self, game: &Game, player: PlayerId) {
        let alarm = game.alarm();
        let health = game.seen_by(player).map_or(self.health, |player| player.health().points);
        self.rings |= alarm > self.alarm || health < self.health;
        (self.alarm, self.health) = (alarm, health);
    }

    /// Whether something has happened since the last call.
    pub fn take_ring(&mut self) -> bool {
        std::mem::take(&mut self.rings)
    }
}
