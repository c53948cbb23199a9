//! Heights of a map and of its tiles, as the map writes them.

use std::ops::Range;

use toml::de::DeTable;

use super::reader::Reader;
use super::textures::Surface;
use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::world::{Ceiling, Covering, Heights, Paint};

/// The least headroom where the player starts, and the least height of the map's ceiling.
pub(crate) const LEAST_HEADROOM: f64 = 0.75;

/// The heights that a tile has of its own.
#[derive(Default)]
pub(crate) struct HeightsText<'a> {
    floor: Option<Height>,
    ceiling: Option<Height>,
    roof: Option<Height>,
    pub(crate) riser: Option<Surface<'a>>,
    pub(crate) lintel: Option<Surface<'a>>,
}

/// The surfaces of risers and lintels that the map names for tiles without their own.
#[derive(Clone, Copy)]
pub(crate) struct Faces {
    pub(crate) riser: Option<Paint>,
    pub(crate) lintel: Option<Paint>,
}

/// A height, and its place in the map.
#[derive(Clone)]
pub(crate) struct Height {
    pub(crate) cells: f64,
    pub(crate) place: Range<usize>,
}

impl<'a> HeightsText<'a> {
    /// Reads `entry` if it is one of the heights, risers and lintels; returns whether it is.
    pub(crate) fn take(&mut self, entry: &Entry<'a, '_>) -> bool {
        match entry.key {
            "floor_height" => self.floor = Height::read(entry),
            "ceiling_height" => self.ceiling = Height::read(entry),
            "roof_height" => self.roof = Height::read(entry),
            "riser" => self.riser = Surface::read(entry, r#"{ riser = "stone" }"#),
            "lintel" => self.lintel = Surface::read(entry, r#"{ lintel = "brick" }"#),
            _ => return false,
        }
        true
    }

    pub(crate) fn is_empty(&self) -> bool {
        let Self { floor, ceiling, roof, riser, lintel } = self;
        [floor, ceiling, roof].iter().all(|height| height.is_none())
            && riser.is_none()
            && lintel.is_none()
    }

    /// The heights of a tile below `overhead`, in a map whose ceiling is at `map_ceiling`. Adds to
    /// `faults` where they contradict each other.
    pub(crate) fn heights(
        &self,
        overhead: Ceiling,
        map_ceiling: f64,
        reader: &Reader<'_>,
    ) -> Option<Heights> {
        let cells = |height: &Option<Height>| height.as_ref().map(|height| height.cells);
        let floor = cells(&self.floor).unwrap_or(0.0);
        let ceiling = match overhead {
            Ceiling::Covered(_) => cells(&self.ceiling).unwrap_or(map_ceiling),
            Ceiling::Sky => (floor + map_ceiling).min(Heights::MAX),
        };
        let roof = cells(&self.roof).unwrap_or(map_ceiling.max(ceiling));
        if let Some(fault) = self.contradiction(overhead, floor, ceiling) {
            reader.faults.push(fault);
            return None;
        }
        Heights::new(floor, ceiling, roof)
    }

    /// The fault of a tile that contradicts itself, if it does.
    fn contradiction(&self, overhead: Ceiling, floor: f64, ceiling: f64) -> Option<Fault> {
        let is_open = overhead == Ceiling::Sky;
        match (&self.ceiling, &self.floor, &self.roof) {
            (Some(height), ..) if is_open => Some(
                Fault::new(height.place.clone(), "there is no ceiling here to be at a height")
                    .label("this tile is open to the sky")
                    .help("give it one, such as ceiling = \"wood\", or leave its height out"),
            ),
            (.., Some(height)) if is_open => Some(
                Fault::new(height.place.clone(), "there is no roof here to be at a height")
                    .label("this tile is open to the sky")
                    .help("give it a ceiling, such as ceiling = \"wood\", or leave the roof out"),
            ),
            (Some(height), ..) | (None, Some(height), _) if !is_open && floor >= ceiling => Some(
                Fault::new(height.place.clone(), "a ceiling must be above its floor")
                    .label(format!("the floor is at {floor} here, the ceiling at {ceiling}"))
                    .help("raise ceiling_height, or write a wall with a height"),
            ),
            (.., Some(height)) if height.cells < ceiling => Some(
                Fault::new(height.place.clone(), "a roof must not be below its ceiling")
                    .label(format!("the ceiling is at {ceiling}"))
                    .help("raise roof_height; what is between the two is solid"),
            ),
            _ => None,
        }
    }
}

impl Faces {
    /// The riser below `floor`: the map's, or the surface of the floor.
    pub(crate) fn riser(self, floor: Covering) -> Paint {
        self.riser.unwrap_or(floor.pattern.first_paint())
    }

    /// The lintel above `ceiling`: the map's, or the surface of the ceiling.
    pub(crate) fn lintel(self, floor: Covering, ceiling: Ceiling) -> Paint {
        let below = match ceiling {
            Ceiling::Covered(covering) => covering,
            Ceiling::Sky => floor,
        };
        self.lintel.unwrap_or(below.pattern.first_paint())
    }
}

impl Height {
    /// Reads the height in `entry`; reports a fault where there is none.
    pub(crate) fn read(entry: &Entry<'_, '_>) -> Option<Self> {
        let cells = entry.number().filter(|height| height.abs() <= Heights::MAX);
        if cells.is_none() {
            let most = Heights::MAX;
            let message = format!("a height must be a number of cells from -{most} to {most}");
            entry.faults.push(
                Fault::new(entry.value_place.clone(), message)
                    .label("this is none")
                    .help("write 0.25 for a quarter of a cell above the map's floor"),
            );
        }
        Some(Self { cells: cells?, place: entry.value_place.clone() })
    }
}

/// Reads the height of the map's ceiling, which is also the height of walls.
pub(crate) fn map_ceiling(entry: &Entry<'_, '_>) -> Option<f64> {
    let height = Height::read(entry)?;
    if height.cells >= LEAST_HEADROOM {
        return Some(height.cells);
    }
    let message = format!("the ceiling of a map is at {LEAST_HEADROOM} cells or above");
    entry.faults.push(
        Fault::new(height.place, message)
            .label("nobody has room to stand below this")
            .help("lower the ceiling in places, by a tile with a ceiling_height"),
    );
    None
}

/// Reads the height of a wall in `table`, if it has one.
pub(crate) fn of_wall(entry: &Entry<'_, '_>, table: &DeTable<'_>) -> Option<f64> {
    let entry = entry.entries(table).find(|entry| entry.key == "height")?;
    let height = Height::read(&entry)?;
    if height.cells > 0.0 {
        return Some(height.cells);
    }
    let message = "the height of a wall must be above 0";
    entry.faults.push(
        Fault::new(height.place, message)
            .label("this is not")
            .help("write { floor_height = -1 } for a pit"),
    );
    None
}
