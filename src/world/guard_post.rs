//! Guard posts: where the guards of a level begin, and what they do while nothing disturbs them.
//!
//! A post is data of the map. The guard itself, which moves, is part of the game.

use serde::{Deserialize, Serialize};

use super::{Cell, Heading};

/// A guard as the map draws it.
#[derive(Clone, Debug, PartialEq)]
pub struct GuardPost {
    /// The kind of guard.
    pub kind: GuardKind,
    /// The cell in whose middle the guard begins.
    pub cell: Cell,
    /// The direction in which the guard looks at first.
    pub heading: Heading,
    /// What the guard does while nothing disturbs them.
    pub duty: Duty,
    /// The easiest difficulty at which the guard is there.
    pub from: Difficulty,
}

/// A kind of guard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum GuardKind {
    /// Slow and armoured; hits hard.
    Warden,
    /// Blind; hears well.
    Listener,
    /// Carries a lamp, and calls the others.
    Lantern,
    /// Fast; follows the player's trail.
    Hound,
    /// Shoots.
    Archer,
}

impl GuardKind {
    /// All kinds.
    pub const ALL: [Self; 5] =
        [Self::Warden, Self::Listener, Self::Lantern, Self::Hound, Self::Archer];

    /// The name in maps, which is also that of the built-in sprite.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Warden => "warden",
            Self::Listener => "listener",
            Self::Lantern => "lantern",
            Self::Hound => "hound",
            Self::Archer => "archer",
        }
    }

    /// The height of the top of the head, in cells. A guard fits where there is as much room.
    pub const fn height(self) -> f64 {
        match self {
            Self::Warden => 0.9,
            Self::Listener => 0.85,
            Self::Lantern => 0.8,
            Self::Hound => 0.45,
            Self::Archer => 0.82,
        }
    }
}

/// What a guard does while nothing disturbs them.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub enum Duty {
    /// Stands at the post and looks around.
    #[default]
    Stand,
    /// Sleeps at the post, until a noise wakes them.
    Sleep,
    /// Walks from cell to cell, and from the last to the first again; there is at least one.
    Patrol(Vec<Cell>),
    /// Walks to cells at random, at most this many cells from the post.
    Wander(u8),
}

/// How hard a game is. The rules differ, not numbers only.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub enum Difficulty {
    /// A player without health goes back to the last checkpoint and keeps what they have. Guards
    /// do not hear walking, and tell nobody what they see.
    Easy,
    /// Guards who see the player call the others.
    #[default]
    Normal,
    /// As [`Normal`](Difficulty::Normal), without checkpoints: and guards who were alarmed stay
    /// wary to the end.
    Hard,
}

impl Difficulty {
    /// All difficulties, from the easiest.
    pub const ALL: [Self; 3] = [Self::Easy, Self::Normal, Self::Hard];

    /// The name in maps, in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Easy => "easy",
            Self::Normal => "normal",
            Self::Hard => "hard",
        }
    }

    /// The difficulty of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|difficulty| difficulty.name() == name)
    }
}
