//! Tiles, as the legend defines them: walls, doors, glass and shapes, and the surfaces, heights and mechanism that a
//! tile of any kind may define for itself.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::color::Rgb;
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest_or_all, quoted};
use crate::map::surfaces::{CeilingText, CoveringText};
use crate::map::textures::SurfaceText;
use crate::map::values::{
    HEIGHT, LIGHT, Name, OPACITY, PILLAR_RADIUS, SHAPE_HEIGHT, color, is_true,
};
use crate::world::{Glass, Light, Line, Outline, PillarRadius, ShapeHeight};

const DEFAULT_RADIUS: PillarRadius = PillarRadius::new(0.3).expect("it fits a cell");
const GLASS_OPACITY: f64 = 0.3;
const MIRROR_OPACITY: f64 = 0.1;
const SILVER: Rgb = Rgb::new(0xb8, 0xc8, 0xd0);
/// The colour of water for which the map names no floor.
const WATER: Rgb = Rgb::new(0x1c, 0x48, 0x68);

/// The places of a thin wall in its cell.
const PLACES: [(&str, Line); 6] = [
    ("north", Line::North),
    ("east", Line::East),
    ("south", Line::South),
    ("west", Line::West),
    ("east-west", Line::EastWest),
    ("north-south", Line::NorthSouth),
];

/// The corners where a diagonal begins.
const CORNERS: [(&str, Line); 4] = [
    ("north-west", Line::FromNorthWest),
    ("south-east", Line::FromNorthWest),
    ("north-east", Line::FromNorthEast),
    ("south-west", Line::FromNorthEast),
];

/// A wall.
pub(crate) struct WallText<'a> {
    pub(crate) surface: SurfaceText<'a>,
    /// Its height, if it has one of its own.
    pub(crate) height: Option<f64>,
    /// `true` for a secret wall, which the player opens.
    pub(crate) is_secret: bool,
    /// The switch that moves it.
    pub(crate) switch: Option<Name<'a>>,
}

impl<'a> WallText<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let is_secret = entry.key == "secret";
        let surface = SurfaceText::read(entry, &format!("{{ {} = \"brick\" }}", entry.key));
        let height = wall_height(entry, table);
        let switch = entry.beside(table, "switch").filter(|_| !is_secret).and_then(|switch| {
            Name::read(&switch, "switch", r#"{ wall = "stone", switch = "gate" }"#)
        });
        Some(Self { surface: surface?, height, is_secret, switch })
    }

    /// Returns whether the wall sinks into the floor.
    pub(crate) fn moves(&self) -> bool {
        self.is_secret || self.switch.is_some()
    }
}

/// A door.
pub(crate) struct DoorText<'a> {
    pub(crate) leaf: SurfaceText<'a>,
    pub(crate) key: Option<Name<'a>>,
    pub(crate) switch: Option<Name<'a>>,
}

impl<'a> DoorText<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let leaf = SurfaceText::read(entry, r#"{ door = "oak" }"#);
        let (key, switch) = (entry.beside(table, "key"), entry.beside(table, "switch"));
        if let (Some(_), Some(switch)) = (&key, &switch) {
            let message = "a door opens with a key or a switch, not both";
            let fault = Fault::new(switch.key_place.clone(), message).label("this door has a key");
            entry.faults.push(fault.help("keep one of the two"));
        }
        let name = |entry: Entry<'a, '_>, owner: &str, name: &str| {
            Name::read(&entry, owner, &format!("{{ door = \"metal\", {owner} = \"{name}\" }}"))
        };
        let key = key.and_then(|key| name(key, "key", "brass"));
        let switch = switch.and_then(|switch| name(switch, "switch", "gate"));
        Some(Self { leaf: leaf?, key, switch })
    }
}

/// Reads the glass in `entry` of `table`.
pub(crate) fn glass(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Glass> {
    let color = color(entry, " for a tint", r##"{ glass = "#80c0ff", opacity = 0.3 }"##);
    tinted(entry, table, color, GLASS_OPACITY)
}

/// Reads the tint of the mirror in `entry` of `table`.
pub(crate) fn mirror(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<Glass> {
    let color = match entry.value {
        DeValue::Boolean(true) => Some(SILVER),
        _ => color(entry, " for a tint", "{ mirror = true }"),
    };
    tinted(entry, table, color, MIRROR_OPACITY)
}

/// Glass of this colour, with the opacity in `table`, or else `usual_opacity`.
fn tinted(
    entry: &Entry<'_, '_>,
    table: &DeTable<'_>,
    color: Option<Rgb>,
    usual_opacity: f64,
) -> Option<Glass> {
    let opacity = match entry.beside(table, "opacity") {
        None => usual_opacity,
        Some(entry) => OPACITY.read(&entry)?,
    };
    Some(Glass { color: color?, opacity: (opacity * 255.0).round() as u8 })
}

/// Reads the height of a wall in `table`, if it has one.
pub(crate) fn wall_height(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<f64> {
    let entry = entry.beside(table, "height")?;
    let height = HEIGHT.read(&entry)?;
    (height > 0.0).then_some(height).or_else(|| {
        let message = "the height of a wall must be above 0";
        entry.reject(message, "this is not", "write { floor_height = -1 } for a pit")
    })
}

/// A wall that does not fill its cell.
pub(crate) struct ShapeText<'a> {
    pub(crate) outline: Outline,
    pub(crate) surface: SurfaceText<'a>,
    pub(crate) height: Option<ShapeHeight>,
}

impl<'a> ShapeText<'a> {
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &DeTable<'_>) -> Option<Self> {
        let (addition, example) = match entry.key {
            "pillar" => ("radius", r#"{ pillar = "marble", radius = 0.3 }"#),
            "diagonal" => ("from", r#"{ diagonal = "brick", from = "north-west" }"#),
            _ => ("at", r#"{ thin = "wood", at = "north" }"#),
        };
        let surface = SurfaceText::read(entry, example);
        let outline = match (addition, entry.beside(table, addition)) {
            ("radius", None) => Some(Outline::Pillar(DEFAULT_RADIUS)),
            ("radius", Some(radius)) => PILLAR_RADIUS.read(&radius).map(Outline::Pillar),
            ("from", Some(corner)) => line(&corner, "corner", &CORNERS, example).map(Outline::Line),
            (_, Some(place)) => {
                line(&place, "place in a cell", &PLACES, example).map(Outline::Line)
            }
            (_, None) => {
                let message = format!("a {} wall does not say where it is", entry.key);
                let fault = Fault::new(entry.key_place.clone(), message)
                    .label(format!("{} is missing", quoted(addition)))
                    .help(format!("write, for example, {example}"));
                entry.faults.push(fault);
                None
            }
        };
        let height = entry.beside(table, "height").and_then(|entry| SHAPE_HEIGHT.read(&entry));
        Some(Self { outline: outline?, surface: surface?, height })
    }
}

/// Reads the line that `entry` names. It must be in `lines`; the fault calls their kind `what`.
fn line(entry: &Entry<'_, '_>, what: &str, lines: &[(&str, Line)], example: &str) -> Option<Line> {
    let name = entry.string(example)?;
    let line = lines.iter().find(|(known, _)| *known == name).map(|&(_, line)| line);
    line.or_else(|| {
        let names: Vec<&str> = lines.iter().map(|&(name, _)| name).collect();
        let help = nearest_or_all(name, &names, "the nearest is", "write one of");
        entry.reject(format!("{} is not a {what}", quoted(name)), "", help)
    })
}

/// A height in cells, and its place in the map.
pub(crate) struct Height {
    pub(crate) cells: f64,
    pub(crate) place: Range<usize>,
}

impl Height {
    fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        Some(Self { cells: HEIGHT.read(entry)?, place: entry.value_place.clone() })
    }
}

/// A tile's own surfaces, heights and mechanism. The map supplies the missing ones.
#[derive(Default)]
pub(crate) struct TileText<'a> {
    pub(crate) floor: Option<CoveringText<'a>>,
    pub(crate) ceiling: Option<CeilingText<'a>>,
    pub(crate) light: Option<Light>,
    pub(crate) floor_height: Option<Height>,
    pub(crate) ceiling_height: Option<Height>,
    pub(crate) roof_height: Option<Height>,
    pub(crate) riser: Option<SurfaceText<'a>>,
    pub(crate) lintel: Option<SurfaceText<'a>>,
    /// The place of the key that makes it water.
    pub(crate) water: Option<Range<usize>>,
    /// The switch of a plate.
    pub(crate) plate: Option<Name<'a>>,
    pub(crate) moves_to: Option<Height>,
    pub(crate) crumbles: Option<Height>,
    /// The switch that moves the floor.
    pub(crate) switch: Option<Name<'a>>,
    /// The place of the first key of a mechanism, from `water` to `switch`.
    pub(crate) mechanism: Option<Range<usize>>,
}

impl<'a> TileText<'a> {
    /// Reads `entry` of `table` if it is one of these keys; returns whether it is.
    pub(crate) fn take(&mut self, entry: &Entry<'a, '_>, table: &DeTable<'_>) -> bool {
        const LIFT: &str = r#"{ floor_height = -2, moves_to = 0, switch = "lift" }"#;
        match entry.key {
            "floor" => self.floor = CoveringText::read(entry, r#"{ floor = "moss" }"#),
            "ceiling" => self.ceiling = CeilingText::read(entry, r#"{ ceiling = "wood" }"#),
            "light" => self.light = LIGHT.read(entry),
            "floor_height" => self.floor_height = Height::read(entry),
            "ceiling_height" => self.ceiling_height = Height::read(entry),
            "roof_height" => self.roof_height = Height::read(entry),
            "riser" => self.riser = SurfaceText::read(entry, r#"{ riser = "stone" }"#),
            "lintel" => self.lintel = SurfaceText::read(entry, r#"{ lintel = "brick" }"#),
            "water" => self.water = is_true(entry).then(|| entry.key_place.clone()),
            "plate" => self.plate = Name::read(entry, "switch", r#"{ plate = "gate" }"#),
            "moves_to" => self.moves_to = Height::read(entry),
            "crumbles" => self.crumbles = Height::read(entry),
            "switch" if table.contains_key("moves_to") => {
                self.switch = Name::read(entry, "switch", LIFT);
            }
            _ => return false,
        }
        if matches!(entry.key, "water" | "plate" | "moves_to" | "crumbles" | "switch") {
            self.mechanism.get_or_insert_with(|| entry.key_place.clone());
        }
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        !self.has_extent() && self.light.is_none() && self.mechanism.is_none()
    }

    /// Returns whether it has a covering, a height, a riser or a lintel.
    pub(crate) fn has_extent(&self) -> bool {
        let Self { floor_height, ceiling_height, roof_height, .. } = self;
        let heights = [floor_height, ceiling_height, roof_height];
        self.floor.is_some()
            || self.ceiling.is_some()
            || heights.into_iter().any(Option::is_some)
            || self.riser.is_some()
            || self.lintel.is_some()
    }

    /// The fault of a floor whose mechanism contradicts itself; `None` if it does not.
    pub(crate) fn contradiction(&self) -> Option<Fault> {
        let fault = |place: &Range<usize>, message: &str| Fault::new(place.clone(), message);
        match (&self.water, &self.plate, &self.moves_to, &self.crumbles) {
            (Some(water), Some(_), ..) => Some(
                fault(water, "a floor is water or a plate, not both")
                    .help("give each its own character"),
            ),
            (.., Some(moves_to), Some(_)) => Some(
                fault(&moves_to.place, "a floor moves with a switch or crumbles, not both")
                    .help("keep moves_to or crumbles"),
            ),
            (.., Some(moves_to), None) if self.switch.is_none() => {
                let help =
                    "add the name of a lever's or a plate's switch, such as switch = \"lift\"";
                Some(
                    fault(&moves_to.place, "no switch moves this floor")
                        .label("\"switch\" is missing")
                        .help(help),
                )
            }
            _ => None,
        }
    }

    /// The floor of a plate or of water if the map names none. It makes a mechanism visible.
    pub(crate) fn usual_floor(&self) -> Option<CoveringText<'static>> {
        let plate = self.plate.as_ref().map(|_| SurfaceText::built_in("metal"));
        plate
            .or_else(|| self.water.as_ref().map(|_| SurfaceText::plain(WATER)))
            .map(CoveringText::plain)
    }
}
