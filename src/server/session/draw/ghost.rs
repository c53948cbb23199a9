//! A ghost in a picture.

use crate::game::PlayerColor;
use crate::server::session::ghosts::Seen;
use crate::world::Figure;

/// A ghost, where it is drawn.
pub(super) struct Ghost {
    pub(super) figure: Figure,
    pub(super) label: String,
    pub(super) color: PlayerColor,
}

impl Ghost {
    pub(super) fn of(seen: &Seen) -> Self {
        Self { figure: seen.figure, label: seen.ghost.label(), color: seen.color }
    }
}
