//! A position in one word.
//!
//! The pen stores its position after each cell and loads it before the next. The two fields of a
//! [`Position`] were stored one by one and loaded as one word; a processor cannot forward two
//! pending stores to one load, and waited a third of the time that drawing a cell took.

use ratatui::layout::Position;

/// A position on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct PackedPosition(u32);

impl PackedPosition {
    #[inline]
    pub(crate) fn of(position: Position) -> Self {
        Self(u32::from(position.y) << u16::BITS | u32::from(position.x))
    }

    #[inline]
    pub(crate) fn get(self) -> Position {
        Position { x: self.0 as u16, y: (self.0 >> u16::BITS) as u16 }
    }
}
