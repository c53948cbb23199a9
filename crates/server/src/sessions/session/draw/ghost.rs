//! A ghost in a picture.

use crate::sessions::session::ghosts::Seen;
use cellcaster::game::PlayerColor;
use cellcaster::world::Figure;

/// A ghost, where it is drawn.
pub(crate) struct Ghost {
    pub(crate) figure: Figure,
    pub(crate) label: String,
    pub(crate) color: PlayerColor,
}

impl Ghost {
    pub(crate) fn of(seen: &Seen) -> Self {
        Self { figure: seen.figure, label: seen.ghost.label(), color: seen.color }
    }
}
