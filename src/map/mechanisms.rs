//! Mechanisms of tiles, as the map writes them: water, plates, and floors and walls that move.
//!
//! A tile that moves becomes a list of tiles, its states, at most [`STEP`] apart in height. The
//! grid draws the first of them only.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::covering::CoveringText;
use super::heights::{self, Height};
use super::switches::SwitchSymbol;
use super::textures::Surface;
use crate::color::Rgb;
use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::world::{Ceiling, Heights, Tile, TileKind};

/// The largest difference in height between two states that follow each other, in cells.
const STEP: f64 = 0.125;
/// The colour of water, where a map names none.
const WATER: Rgb = Rgb::new(0x1c, 0x48, 0x68);
/// More states than a map has tiles.
const MOST_STATES: f64 = 256.0;

/// A wall that moves, as the legend defines it.
pub(crate) struct MovingWallSymbol<'a> {
    pub(crate) surface: Surface<'a>,
    /// Its height, if it has one of its own.
    pub(crate) height: Option<f64>,
    /// The switch that moves it; `None` for a secret wall.
    pub(crate) switch: Option<SwitchSymbol<'a>>,
}

impl<'a> MovingWallSymbol<'a> {
    /// Reads the secret wall in `entry`.
    pub(crate) fn read_secret(entry: &Entry<'a, '_>, table: &DeTable<'_>) -> Option<Self> {
        let surface = Surface::read(entry, r#"{ secret = "brick" }"#);
        let height = heights::of_wall(entry, table);
        Some(Self { surface: surface?, height, switch: None })
    }
}

/// The mechanism of a floor.
#[derive(Default)]
pub(crate) struct FloorMechanism<'a> {
    water: Option<Range<usize>>,
    pub(crate) plate: Option<SwitchSymbol<'a>>,
    pub(crate) moves_to: Option<Height>,
    pub(crate) crumbles: Option<Height>,
    pub(crate) switch: Option<SwitchSymbol<'a>>,
    /// The place of its first key.
    place: Option<Range<usize>>,
}

impl<'a> FloorMechanism<'a> {
    /// Reads `entry` of `table` if it is part of a floor's mechanism; returns whether it is.
    pub(crate) fn take(&mut self, entry: &Entry<'a, '_>, table: &DeTable<'_>) -> bool {
        const LIFT: &str = r#"{ floor_height = -2, moves_to = 0, switch = "lift" }"#;
        match entry.key {
            "water" => self.water = is_true(entry).then(|| entry.key_place.clone()),
            "plate" => self.plate = SwitchSymbol::read(entry, r#"{ plate = "gate" }"#),
            "moves_to" => self.moves_to = Height::read(entry),
            "crumbles" => self.crumbles = Height::read(entry),
            "switch" if table.contains_key("moves_to") => {
                self.switch = SwitchSymbol::read(entry, LIFT);
            }
            _ => return false,
        }
        self.place.get_or_insert_with(|| entry.key_place.clone());
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.place.is_none()
    }

    /// The floor of a tile with it, where the map does not name one: what may harm or help shows.
    pub(crate) fn usual_floor(&self) -> Option<CoveringText<'static>> {
        let plate = self.plate.as_ref().map(|_| CoveringText::built_in("metal"));
        plate.or_else(|| self.water.as_ref().map(|_| CoveringText::plain(WATER)))
    }

    /// Whether it is water.
    pub(crate) fn is_water(&self) -> bool {
        self.water.is_some()
    }

    /// The fault of a mechanism that contradicts itself, if it does.
    pub(crate) fn contradiction(&self) -> Option<Fault> {
        let fault = |place: &Range<usize>, message: &str| Fault::new(place.clone(), message);
        match (&self.water, &self.plate, &self.moves_to, &self.crumbles) {
            (Some(water), Some(_), ..) => Some(
                fault(water, "a floor is water or a plate, not both")
                    .help("draw each with a character of its own"),
            ),
            (.., Some(moves_to), Some(_)) => Some(
                fault(&moves_to.place, "a floor moves with a switch or crumbles, not both")
                    .help("keep moves_to or crumbles"),
            ),
            (.., Some(moves_to), None) if self.switch.is_none() => Some(
                fault(&moves_to.place, "no switch moves this floor")
                    .label("\"switch\" is missing")
                    .help(
                        "add the name of a lever's or a plate's switch, such as switch = \"lift\"",
                    ),
            ),
            _ => None,
        }
    }

    /// The fault of a tile with this mechanism that is not floor.
    pub(crate) fn not_on_a_floor(&self) -> Option<Fault> {
        let place = self.place.clone()?;
        let message = "only a floor can be water, a plate, or move to another height";
        Some(
            Fault::new(place, message)
                .label("this tile is no floor")
                .help("draw the two with characters of their own"),
        )
    }
}

/// The states of the floor `tile` after the first, up or down to the height `end`. The faults of
/// `end` are reported by [`end_fault`].
pub(crate) fn floor_states(tile: Tile, end: f64) -> impl Iterator<Item = Tile> {
    let start = tile.heights.floor();
    let over = tile.heights.ceiling() - start;
    heights_between(start, end).filter_map(move |floor| {
        // Under the sky, what stands on the floor moves with it.
        let ceiling = match tile.ceiling {
            Ceiling::Covered(_) => tile.heights.ceiling(),
            Ceiling::Sky => (floor + over).min(Heights::MAX),
        };
        let roof = tile.heights.roof().max(ceiling);
        Some(Tile { heights: Heights::new(floor, ceiling, roof)?, ..tile })
    })
}

/// The fault of a floor that cannot move to the height `end`, if it cannot.
pub(crate) fn end_fault(tile: Tile, end: &Height, is_crumbling: bool) -> Option<Fault> {
    let fault = |message: String| Fault::new(end.place.clone(), message);
    let (floor, ceiling) = (tile.heights.floor(), tile.heights.ceiling());
    if is_crumbling && end.cells >= floor {
        let message = "a floor crumbles to a lower height".to_owned();
        return Some(
            fault(message)
                .label(format!("the floor is at {floor}"))
                .help(format!("write, for example, crumbles = {}", floor - 3.0)),
        );
    }
    if end.cells == floor {
        let message = "this floor moves to the height that it has".to_owned();
        return Some(fault(message).help("write another height, or leave moves_to out"));
    }
    if matches!(tile.ceiling, Ceiling::Covered(_)) && end.cells >= ceiling {
        let message = "a ceiling must be above its floor".to_owned();
        return Some(
            fault(message)
                .label(format!("the ceiling is at {ceiling} here"))
                .help("raise ceiling_height, or move the floor less far"),
        );
    }
    None
}

/// The states of `wall` after the first that are lower walls. After them it is open.
pub(crate) fn wall_states(wall: Tile) -> impl Iterator<Item = Tile> {
    let (ceiling, roof) = (wall.heights.ceiling(), wall.heights.roof());
    let lower = heights_between(wall.heights.floor(), 0.0).filter(|&top| top > 0.0);
    lower.filter_map(move |top| Some(Tile { heights: Heights::new(top, ceiling, roof)?, ..wall }))
}

/// The floor that a moving wall leaves, in a map whose open floor is `ground`.
pub(crate) fn floor_of_wall(wall: Tile, ground: Tile) -> Tile {
    let light = wall.light.or(ground.light);
    Tile { character: wall.character, kind: TileKind::Open, light, ..ground }
}

/// Heights after `start` at equal distances, to `end`.
fn heights_between(start: f64, end: f64) -> impl Iterator<Item = f64> {
    let way = end - start;
    let count = (way.abs() / STEP).ceil().min(MOST_STATES) as u32;
    (1..=count).map(move |index| {
        if index == count { end } else { start + way * f64::from(index) / f64::from(count) }
    })
}

/// Reads a key that is there or not.
pub(crate) fn is_true(entry: &Entry<'_, '_>) -> bool {
    let is_true = matches!(entry.value, DeValue::Boolean(true));
    if !is_true {
        let key = entry.key;
        entry.faults.push(
            Fault::new(entry.value_place.clone(), format!("\"{key}\" must be true"))
                .help(format!("write {key} = true, or leave it out")),
        );
    }
    is_true
}

#[cfg(test)]
mod tests;
