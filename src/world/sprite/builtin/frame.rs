//! The frames of the built-in sprites whose frame a game selects.

/// A frame of a guard's sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum GuardFrame {
    /// Stands.
    Stand,
    /// Walks, with the left foot in front.
    WalkLeft,
    /// Walks, with the right foot in front.
    WalkRight,
    /// Has noticed something, and holds the weapon ready.
    Alert,
    /// Is about to strike or to shoot.
    WindUp,
    /// Strikes or shoots.
    Strike,
    /// Lies on the floor.
    Fallen,
    /// Sleeps.
    Asleep,
}

impl GuardFrame {
    /// All frames, in the order of the sprite.
    pub const ALL: [Self; 8] = [
        Self::Stand,
        Self::WalkLeft,
        Self::WalkRight,
        Self::Alert,
        Self::WindUp,
        Self::Strike,
        Self::Fallen,
        Self::Asleep,
    ];

    /// The index among the sprite's frames.
    pub const fn index(self) -> u8 {
        self as u8
    }
}

/// A frame of the sprite of a player, as others see them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlayerFrame {
    /// Stands.
    Stand,
    /// Walks, with the left foot in front.
    WalkLeft,
    /// Walks, with the right foot in front.
    WalkRight,
    /// Strikes.
    Strike,
    /// Ducks.
    Duck,
    /// Lies on the floor.
    Down,
}

impl PlayerFrame {
    /// All frames, in the order of the sprite.
    pub const ALL: [Self; 6] =
        [Self::Stand, Self::WalkLeft, Self::WalkRight, Self::Strike, Self::Duck, Self::Down];

    /// The index among the sprite's frames.
    pub const fn index(self) -> u8 {
        self as u8
    }
}

/// A frame of a checkpoint's sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CheckpointFrame {
    /// Nobody has reached it.
    Grey,
    /// The player has reached it.
    Lit,
}

impl CheckpointFrame {
    /// The index among the sprite's frames.
    pub const fn index(self) -> u8 {
        self as u8
    }
}

/// A frame of a lever's sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LeverFrame {
    /// Its switch is off.
    Off,
    /// Its switch is on.
    On,
}

impl LeverFrame {
    /// The index among the sprite's frames.
    pub const fn index(self) -> u8 {
        self as u8
    }
}

/// A frame of the sprite of spikes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SpikesFrame {
    /// In the floor.
    In,
    /// The tips show: the warning.
    Rising,
    /// Out of the floor.
    Out,
}

impl SpikesFrame {
    /// The index among the sprite's frames.
    pub const fn index(self) -> u8 {
        self as u8
    }
}
