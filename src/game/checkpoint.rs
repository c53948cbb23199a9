//! Checkpoints: the places where a dead player continues.
//!
//! A checkpoint is a copy of the game at the time when the player reached it. Before the first
//! checkpoint, it is a copy of the game at its start. Worlds share their textures and sprites, so a
//! copy contains little more than the cells. A retry restores the copy, but keeps the clock, the
//! alarms and the deaths. On the easiest difficulty, the player also keeps everything that they
//! have found since.

use std::sync::Arc;

use super::Game;
use super::guards::Alarm;
use crate::world::sprite::builtin::CheckpointFrame;
use crate::world::{Cell, Difficulty, ThingKind};

/// The game from which a dead player continues.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Checkpoint {
    /// `None` in a level in which nothing kills.
    game: Option<Arc<Game>>,
    /// The cell of the checkpoint; `None` for the start.
    pub(crate) cell: Option<Cell>,
}

impl Checkpoint {
    /// The game at the checkpoint in `cell`.
    pub(crate) fn new(game: Option<Arc<Game>>, cell: Option<Cell>) -> Self {
        Self { game, cell }
    }

    /// The game from which a dead player continues.
    pub(crate) fn game(&self) -> Option<&Game> {
        self.game.as_deref()
    }
}

impl Game {
    /// The game with its start as the first checkpoint.
    #[must_use]
    pub(crate) fn with_start(mut self) -> Self {
        self.checkpoint.game = self.is_mission.then(|| Arc::new(self.clone()));
        self
    }

    /// Whether the player has reached a checkpoint other than the last one while no guard follows a
    /// player.
    pub(crate) fn is_at_a_new_checkpoint(&self) -> bool {
        self.is_mission
            && self.rules.difficulty < Difficulty::Hard
            && self.last_checkpoint() != Some(self.player.motion.cell())
            && self.guards.alarm() < Alarm::Raised
            && !self.is_dead()
            && self.things_reached().any(|thing| thing.kind == ThingKind::Checkpoint)
    }

    /// Activates the checkpoint that the player has reached, if it is a new one.
    pub(crate) fn reach_checkpoint(&mut self) {
        if !self.is_at_a_new_checkpoint() {
            return;
        }
        let cell = self.player.motion.cell();
        let before = self.last_checkpoint();
        let is_of_one = !self.set_own_checkpoint(cell);
        self.grey_checkpoint(before);
        self.world.set_frame(cell, is_checkpoint, CheckpointFrame::Lit.index());
        self.say("Checkpoint.".to_owned());
        self.revision += 1;
        if is_of_one {
            self.save_checkpoint(cell);
        }
    }

    fn save_checkpoint(&mut self, cell: Cell) {
        self.checkpoint = Checkpoint { game: None, cell: Some(cell) };
        self.checkpoint.game = Some(Arc::new(self.clone()));
    }

    /// The cell of the player's last checkpoint; `None` for the start.
    pub(crate) fn last_checkpoint(&self) -> Option<Cell> {
        match self.members.as_deref() {
            Some(members) => members.checkpoint(),
            None => self.checkpoint.cell,
        }
    }

    /// Makes `cell` the checkpoint of the current player. Returns `false` in a single-player game.
    fn set_own_checkpoint(&mut self, cell: Cell) -> bool {
        let Some(members) = self.members.as_deref_mut() else { return false };
        members.set_checkpoint(cell);
        true
    }

    /// Shows a checkpoint as inactive, unless a player would continue from it.
    pub(crate) fn grey_checkpoint(&mut self, cell: Option<Cell>) {
        let is_used = |cell| self.members.as_ref().is_some_and(|it| it.has_checkpoint(cell));
        if let Some(cell) = cell.filter(|&cell| !is_used(cell)) {
            self.world.set_frame(cell, is_checkpoint, CheckpointFrame::Grey.index());
        }
    }

    /// Continues from the last checkpoint.
    pub(crate) fn retry(&mut self) {
        let Some(saved) = self.checkpoint.game.clone() else { return };
        let mut game = Self::clone(&saved);
        game.player.health = game.player.health.revived();
        game.player.pressed = self.player.pressed;
        game.player.has_acted = false;
        game.steps = self.steps;
        game.revision = self.revision + 1;
        game.figure_revision = self.figure_revision;
        game.player.counts = self.player.counts;
        if self.rules.difficulty == Difficulty::Easy {
            game.merge_finds(self);
        }
        game.checkpoint = self.checkpoint.clone();
        *self = game;
    }

    /// Gives the player everything that they have found in `other`, a later state of this game.
    fn merge_finds(&mut self, other: &Self) {
        self.player.keys.extend(&other.player.keys);
        self.player.treasure = other.player.treasure;
        self.player.supplies = self.player.supplies.or_more(other.player.supplies);
        let is_find = |kind| {
            use ThingKind::{Healing, Key, Supply, Treasure};
            matches!(kind, Healing(_) | Key(_) | Supply(..) | Treasure(_))
        };
        let taken: Vec<(Cell, ThingKind)> = self
            .world
            .things()
            .iter()
            .filter(|thing| is_find(thing.kind))
            .filter(|thing| {
                !other.world.things_in(thing.cell).iter().any(|it| it.kind == thing.kind)
            })
            .map(|thing| (thing.cell, thing.kind))
            .collect();
        for (cell, taken) in taken {
            self.world.take_things(cell, |kind| kind == taken);
        }
    }
}

fn is_checkpoint(kind: ThingKind) -> bool {
    kind == ThingKind::Checkpoint
}
