//! The content of one point of the map, and its appearance in every colour depth and in characters.
//!
//! The brightness of walls is between two limits, floors are darker, and the player's arrow is
//! brighter than both. With 16 colours, which users redefine, and without colour, each kind of
//! point has its own colour or pattern: choosing the nearest of 16 colours would make walls and
//! floors equal.

use crate::color::Rgb;

/// The content of a point of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapPoint {
    /// Outside of the map, or unexplored.
    Void,
    Wall(Rgb),
    /// A door, or glass.
    Door(Rgb),
    Floor(Floor),
    /// Floor in the field of view.
    InView(Floor),
    Exit,
    Key,
    /// What the player can take or read.
    Item,
    Ornament,
}

/// Floor, with a colour by its height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Floor {
    pub(crate) kind: FloorKind,
    color: Rgb,
    /// Its colour if it is visible.
    lit: Rgb,
}

/// The kinds of floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FloorKind {
    /// At the height of the map's own floor.
    Base,
    /// Above it.
    Ledge,
    /// Below it, without water.
    Pit,
    Water,
}

/// Floor at the height of the map's own floor.
const BASE: Rgb = Rgb::new(0x24, 0x24, 0x2c);
/// The colours that raised floor, lowered floor and water approach.
const LEDGE: Rgb = Rgb::new(0x66, 0x66, 0x70);
const PIT: Rgb = Rgb::new(0x54, 0x18, 0x1c);
const WATER: Rgb = Rgb::new(0x10, 0x48, 0x80);
/// The tint of visible floor, and its share.
const TINT: Rgb = Rgb::new(0x7a, 0x72, 0x50);
const TINT_SHARE: f64 = 0.7;
/// Points outside of the map.
const VOID: Rgb = Rgb::BLACK;
/// The cell to reach.
const EXIT: Rgb = Rgb::new(0x3c, 0xc8, 0x64);
/// A key to take.
const KEY: Rgb = Rgb::new(0xe0, 0xa0, 0x28);
/// Treasure, a tool or a note.
const ITEM: Rgb = Rgb::new(0xc8, 0x78, 0xc8);
/// An obstacle, or a decoration.
const ORNAMENT: Rgb = Rgb::new(0x9c, 0x8c, 0x74);
/// The least and the greatest brightness of walls.
const WALLS: (u8, u8) = (0x60, 0xb0);

/// Floor whose height differs by less from the map's own floor, in cells, counts as equal.
const SAME_HEIGHT: f64 = 0.05;

impl Floor {
    /// Water at `height`.
    pub(crate) fn water(height: f64) -> Self {
        let depth = height.min(0.0).abs();
        Self::of(FloorKind::Water, mix(BASE, WATER, (depth + 0.3) / (depth + 0.6)))
    }

    /// Floor at `height` with the mean colour `color`.
    pub(crate) fn new(height: f64, color: Rgb) -> Self {
        // The share is one half at the height or depth `half`.
        let share = |half: f64| height.abs() / (height.abs() + half);
        if height > SAME_HEIGHT {
            Self::of(FloorKind::Ledge, mix(BASE, LEDGE, share(0.6)))
        } else if height >= -SAME_HEIGHT {
            Self::of(FloorKind::Base, BASE)
        } else if is_watery(color) {
            Self::of(FloorKind::Water, mix(BASE, WATER, share(0.3)))
        } else {
            Self::of(FloorKind::Pit, mix(BASE, PIT, share(0.5)))
        }
    }

    fn of(kind: FloorKind, color: Rgb) -> Self {
        Self { kind, color, lit: mix(color, TINT, TINT_SHARE) }
    }
}

/// Whether a lowered floor with that colour looks like water: if it is much more blue than red. A
/// map may draw water that does nothing.
fn is_watery(color: Rgb) -> bool {
    u16::from(color.blue()) >= 2 * u16::from(color.red())
}

/// The mean of two colours, where the second has the weight `share`.
fn mix(one: Rgb, other: Rgb, share: f64) -> Rgb {
    let channel = |one: u8, other: u8| {
        (f64::from(one) + (f64::from(other) - f64::from(one)) * share).round() as u8
    };
    Rgb::new(
        channel(one.red(), other.red()),
        channel(one.green(), other.green()),
        channel(one.blue(), other.blue()),
    )
}

/// The colour of a wall with the mean colour `color`: the same, but neither as dark as floor nor as
/// bright as the arrow.
pub(crate) fn of_wall(color: Rgb) -> Rgb {
    let (least, most) = WALLS;
    let luma = color.luma();
    if luma < least {
        let share = f64::from(least - luma) / f64::from(u8::MAX - luma);
        mix(color, Rgb::WHITE, share)
    } else if luma > most {
        mix(Rgb::BLACK, color, f64::from(most) / f64::from(luma))
    } else {
        color
    }
}

impl MapPoint {
    pub(crate) fn color(self) -> Rgb {
        match self {
            Self::Void => VOID,
            Self::Wall(color) | Self::Door(color) => color,
            Self::Floor(floor) => floor.color,
            Self::InView(floor) => floor.lit,
            Self::Exit => EXIT,
            Self::Key => KEY,
            Self::Item => ITEM,
            Self::Ornament => ORNAMENT,
        }
    }

    /// The index of the point's colour among the 16.
    pub(crate) fn index_of_16(self) -> u8 {
        match self {
            Self::Void => 0,
            Self::Wall(_) => 7,
            Self::Door(_) => 5,
            Self::Floor(Floor { kind, .. }) | Self::InView(Floor { kind, .. }) => match kind {
                FloorKind::Base if matches!(self, Self::InView(_)) => 3,
                FloorKind::Base => 8,
                FloorKind::Ledge => 6,
                FloorKind::Pit => 1,
                FloorKind::Water => 4,
            },
            Self::Exit => 10,
            Self::Key => 13,
            Self::Item => 14,
            Self::Ornament => 2,
        }
    }

    /// Whether the point's pixel at that position of the screen is lit if there are no colours.
    pub(crate) fn is_lit(self, x: u32, y: u32) -> bool {
        match self {
            Self::Wall(_) | Self::Door(_) => true,
            Self::Floor(Floor { kind, .. }) | Self::InView(Floor { kind, .. }) => match kind {
                FloorKind::Ledge => (x + y).is_multiple_of(2),
                FloorKind::Water => y.is_multiple_of(2) && !x.is_multiple_of(3),
                FloorKind::Base if matches!(self, Self::InView(_)) => {
                    x.is_multiple_of(2) && y.is_multiple_of(2)
                }
                FloorKind::Base | FloorKind::Pit => false,
            },
            Self::Void | Self::Exit | Self::Key | Self::Item | Self::Ornament => false,
        }
    }

    /// Whether the point is a letter among the patterns of a map without colour.
    pub(crate) fn is_thing(self) -> bool {
        matches!(self, Self::Exit | Self::Key | Self::Item | Self::Ornament)
    }

    pub(crate) fn character(self) -> char {
        match self {
            Self::Void => ' ',
            Self::Wall(_) => '#',
            Self::Door(_) => '+',
            Self::Floor(Floor { kind, .. }) | Self::InView(Floor { kind, .. }) => match kind {
                FloorKind::Base if matches!(self, Self::InView(_)) => ':',
                FloorKind::Base => '.',
                FloorKind::Ledge => '=',
                FloorKind::Pit => '_',
                FloorKind::Water => '~',
            },
            Self::Exit => 'X',
            Self::Key => 'k',
            Self::Item => '$',
            Self::Ornament => 'o',
        }
    }

    /// The importance of the point: a pixel that covers several points shows the most important
    /// one.
    pub(crate) fn importance(self) -> u8 {
        match self {
            Self::Void => 0,
            Self::Floor(_) => 1,
            Self::InView(_) => 2,
            Self::Ornament => 3,
            Self::Wall(_) => 4,
            Self::Door(_) => 5,
            Self::Item => 6,
            Self::Key => 7,
            Self::Exit => 8,
        }
    }
}
