//! What a point of the map looks like, in every colour depth and in characters.
//!
//! Walls are between two brightnesses, floors below the lower one, and the player's arrow above everything. With 16
//! colours, which people choose themselves, and with none, each kind has a colour or a pattern of its own: to look
//! for the nearest of 16 would give walls and floors the same.

use crate::color::Rgb;

/// What is at a point of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Nothing, or nothing that is known.
    Void,
    Wall(Rgb),
    /// A door, or glass.
    Door(Rgb),
    Floor(Ground),
    /// Floor in the field of view.
    InView(Ground),
    Exit,
    Key,
    Ornament,
}

/// Floor, by its height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Ground {
    pub(super) kind: GroundKind,
    color: Rgb,
}

/// What kind of floor that is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum GroundKind {
    /// As high as the map's own floor.
    Level,
    /// Higher.
    Ledge,
    /// Lower, and dry.
    Pit,
    Water,
}

/// Floor as high as the map's own.
const FLOOR: Rgb = Rgb::new(0x24, 0x24, 0x2c);
/// What higher floor comes close to, and what lower floor and water do.
const LEDGE: Rgb = Rgb::new(0x66, 0x66, 0x70);
const PIT: Rgb = Rgb::new(0x54, 0x18, 0x1c);
const WATER: Rgb = Rgb::new(0x10, 0x48, 0x80);
/// What floor in the field of view is tinted with, and how much.
const LIGHT: Rgb = Rgb::new(0x7a, 0x72, 0x50);
const TINT: f64 = 0.7;
/// What is not on the map.
const VOID: Rgb = Rgb::BLACK;
/// The cell to reach.
const EXIT: Rgb = Rgb::new(0x3c, 0xc8, 0x64);
/// A key to take.
const KEY: Rgb = Rgb::new(0xe0, 0xa0, 0x28);
/// Something to walk around, or past.
const ORNAMENT: Rgb = Rgb::new(0x9c, 0x8c, 0x74);
/// How bright walls are at least and at most.
const WALLS: (u8, u8) = (0x60, 0xb0);

/// Floor that differs by less from the map's own, in cells, is as high.
const LEVEL: f64 = 0.05;

impl Ground {
    /// Floor at `height` that is laid with `color` on the average.
    pub(super) fn new(height: f64, color: Rgb) -> Self {
        // It comes half as close to its colour at these heights and depths.
        let share = |half: f64| height.abs() / (height.abs() + half);
        if height > LEVEL {
            Self { kind: GroundKind::Ledge, color: mix(FLOOR, LEDGE, share(0.6)) }
        } else if height >= -LEVEL {
            Self { kind: GroundKind::Level, color: FLOOR }
        } else if is_watery(color) {
            Self { kind: GroundKind::Water, color: mix(FLOOR, WATER, share(0.3)) }
        } else {
            Self { kind: GroundKind::Pit, color: mix(FLOOR, PIT, share(0.5)) }
        }
    }

    /// Its colour in the field of view.
    fn lit(self) -> Rgb {
        mix(self.color, LIGHT, TINT)
    }
}

/// Whether a floor of that colour is taken for water: one that is much more blue than red. The map file has no word
/// for water, as it is floor like any other.
fn is_watery(color: Rgb) -> bool {
    u16::from(color.blue()) >= 2 * u16::from(color.red())
}

/// The first colour, and a share of the second.
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

/// The colour of a wall that has `color` on the average: as that, but neither as dark as floor nor as bright as the
/// arrow.
pub(super) fn of_wall(color: Rgb) -> Rgb {
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

impl Place {
    pub(super) fn color(self) -> Rgb {
        match self {
            Self::Void => VOID,
            Self::Wall(color) | Self::Door(color) => color,
            Self::Floor(ground) => ground.color,
            Self::InView(ground) => ground.lit(),
            Self::Exit => EXIT,
            Self::Key => KEY,
            Self::Ornament => ORNAMENT,
        }
    }

    /// Which of the 16 colours shows it.
    pub(super) fn index_of_16(self) -> u8 {
        match self {
            Self::Void => 0,
            Self::Wall(_) => 7,
            Self::Door(_) => 5,
            Self::Floor(Ground { kind, .. }) | Self::InView(Ground { kind, .. }) => match kind {
                GroundKind::Level if matches!(self, Self::InView(_)) => 3,
                GroundKind::Level => 8,
                GroundKind::Ledge => 6,
                GroundKind::Pit => 1,
                GroundKind::Water => 4,
            },
            Self::Exit => 10,
            Self::Key => 13,
            Self::Ornament => 2,
        }
    }

    /// Whether the pixel at that place of the screen is lit where there are no colours.
    pub(super) fn is_lit(self, x: u32, y: u32) -> bool {
        match self {
            Self::Wall(_) | Self::Door(_) => true,
            Self::Floor(Ground { kind, .. }) | Self::InView(Ground { kind, .. }) => match kind {
                GroundKind::Ledge => (x + y).is_multiple_of(2),
                GroundKind::Water => y.is_multiple_of(2) && !x.is_multiple_of(3),
                GroundKind::Level if matches!(self, Self::InView(_)) => {
                    x.is_multiple_of(2) && y.is_multiple_of(2)
                }
                GroundKind::Level | GroundKind::Pit => false,
            },
            Self::Void | Self::Exit | Self::Key | Self::Ornament => false,
        }
    }

    pub(super) fn character(self) -> char {
        match self {
            Self::Void => ' ',
            Self::Wall(_) => '#',
            Self::Door(_) => '+',
            Self::Floor(Ground { kind, .. }) | Self::InView(Ground { kind, .. }) => match kind {
                GroundKind::Level if matches!(self, Self::InView(_)) => ':',
                GroundKind::Level => '.',
                GroundKind::Ledge => '=',
                GroundKind::Pit => '_',
                GroundKind::Water => '~',
            },
            Self::Exit => 'X',
            Self::Key => 'k',
            Self::Ornament => 'o',
        }
    }

    /// Which of several that one pixel shows it is: the greatest.
    pub(super) fn importance(self) -> u8 {
        match self {
            Self::Void => 0,
            Self::Floor(_) => 1,
            Self::InView(_) => 2,
            Self::Ornament => 3,
            Self::Wall(_) => 4,
            Self::Door(_) => 5,
            Self::Key => 6,
            Self::Exit => 7,
        }
    }
}
