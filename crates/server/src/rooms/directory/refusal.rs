//! Why somebody cannot be in a room.

use std::fmt;

use crate::rooms::sequencer::JoinRefusal;

/// Why somebody cannot be in a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RoomRefusal {
    /// There is no such room any more.
    Gone,
    /// It is full.
    Full,
    /// One plays alone in it.
    Alone,
    /// There are as many rooms as the host allows.
    TooMany,
    /// This host does not have the level.
    NoLevel,
    /// The member is somewhere else.
    Taken,
    /// The hosts cannot agree now.
    NotNow,
}

impl From<JoinRefusal> for RoomRefusal {
    fn from(refusal: JoinRefusal) -> Self {
        match refusal {
            JoinRefusal::Closed => Self::Gone,
            JoinRefusal::Full => Self::Full,
        }
    }
}

impl fmt::Display for RoomRefusal {
    /// Writes a sentence for the visitor.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gone => "This room is closed.",
            Self::Full => "This room is full.",
            Self::Alone => "Somebody plays alone in this room; you can watch.",
            Self::TooMany => "There are as many rooms as this server allows; enter one of them.",
            Self::NoLevel => "This host does not have the map of this room.",
            Self::Taken => "You are in a room by another connection, and stay there.",
            Self::NotNow => "The room does not answer now; try again.",
        })
    }
}
