//! The ghosts that a visitor sees in a room.

use std::sync::Arc;

use super::messages::Request;
use crate::rooms::ghost::Ghost;
use crate::rooms::room::RoomView;
use cellcaster::game::PlayerColor;
use cellcaster::world::{Difficulty, Figure};

/// The ghosts of the level that is played.
#[derive(Debug, Default)]
pub(crate) struct Ghosts {
    /// The level that they were asked for.
    level: Option<(String, Difficulty)>,
    ghosts: Option<Arc<[Ghost]>>,
}

/// A ghost in a step.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Seen<'g> {
    pub(crate) ghost: &'g Ghost,
    pub(crate) color: PlayerColor,
    pub(crate) figure: Figure,
}

impl Ghosts {
    /// Forgets all at the beginning of a round; returns the wish for those of its level.
    pub(crate) fn begin(&mut self, room: &RoomView) -> Option<Request> {
        *self = Self::default();
        let header = &room.header;
        header.mode.has_ghosts().then(|| {
            let (level, difficulty) = (header.level.clone(), header.difficulty);
            self.level = Some((level.clone(), difficulty));
            Request::Ghosts { level, difficulty }
        })
    }

    /// Takes the ghosts of a level, if it is still played.
    pub(crate) fn receive(&mut self, level: String, difficulty: Difficulty, ghosts: Arc<[Ghost]>) {
        if self.level == Some((level, difficulty)) {
            self.ghosts = Some(ghosts);
        }
    }

    /// The ghosts where they are now; the visitor's own one in their colour. There are some only
    /// while the round is played.
    pub(crate) fn seen<'g>(
        &'g self,
        room: &'g RoomView,
        own: Option<PlayerColor>,
    ) -> impl Iterator<Item = Seen<'g>> {
        let step = room.begun.map(|begun| room.step.saturating_sub(begun));
        let ghosts = self.ghosts.as_deref().unwrap_or_default();
        step.into_iter().flat_map(move |step| {
            ghosts.iter().filter_map(move |ghost| {
                let color = ghost.color(own);
                let figure = ghost.figure(step, room.game.sprite_of_players(color)?)?;
                Some(Seen { ghost, color, figure })
            })
        })
    }
}
