//! The definitions of a map: all of its keys except the grid, each read on its own.

use std::ops::Range;

use toml::de::DeTable;

use super::checks::MIN_HEADROOM;
use super::keys::{self, CharacterTable};
use super::legend::Legend;
use super::surfaces::{self, CeilingText, CoveringText, SkyText};
use super::textures::SurfaceText;
use super::values::{HEIGHT, LIGHT, whole};
use crate::fault::document::{Entry, FaultList, entries};
use crate::world::{Fog, Light};

/// The longest goal, in characters.
const MAX_GOAL: usize = 40;
/// The longest par time, in seconds: a day.
const MAX_PAR: u32 = 86_400;

/// The definitions of a map, and the entry of its grid.
#[derive(Default)]
pub(crate) struct Definitions<'a, 't> {
    pub(crate) title: String,
    pub(crate) goal: Option<String>,
    /// The time in which a good player finishes, in seconds.
    pub(crate) par: Option<u32>,
    /// The worth of the treasure that exits require, and its place in the map.
    pub(crate) treasure_needed: Option<(u32, Range<usize>)>,
    pub(crate) ceiling: Option<CeilingText<'a>>,
    /// The height of the ceiling and of walls.
    pub(crate) ceiling_height: Option<f64>,
    pub(crate) floor: Option<CoveringText<'a>>,
    /// The sides of raised floors, for tiles without their own.
    pub(crate) riser: Option<SurfaceText<'a>>,
    /// The sides of lowered ceilings, for tiles without their own.
    pub(crate) lintel: Option<SurfaceText<'a>>,
    pub(crate) sky: Option<SkyText<'a>>,
    pub(crate) fog: Option<Fog>,
    /// The light of tiles without their own.
    pub(crate) light: Option<Light>,
    pub(crate) grid: Option<Entry<'a, 't>>,
    pub(crate) legend: Legend<'a>,
}

impl<'a, 't> Definitions<'a, 't> {
    /// Reads the definitions in `document`. Reports faulty definitions and leaves them out.
    pub(crate) fn read(document: &'a DeTable<'t>, faults: &'a FaultList) -> Self {
        let mut definitions = Self::default();
        for entry in entries(document, faults) {
            definitions.read_entry(entry);
        }
        definitions
    }

    fn read_entry(&mut self, entry: Entry<'a, 't>) {
        match entry.key {
            "title" => self.title = title(&entry).unwrap_or_default(),
            "goal" => self.goal = goal(&entry),
            "par" => self.par = whole(&entry, 1..=MAX_PAR),
            "treasure_needed" => {
                let worth = whole(&entry, 1..=1_000_000);
                self.treasure_needed = worth.map(|worth| (worth, entry.value_place));
            }
            "ceiling" => self.ceiling = CeilingText::read(&entry, r##"ceiling = "#202028""##),
            "ceiling_height" => self.ceiling_height = ceiling_height(&entry),
            "floor" => self.floor = CoveringText::read(&entry, r#"floor = "stone""#),
            "riser" => self.riser = SurfaceText::read(&entry, r#"riser = "stone""#),
            "lintel" => self.lintel = SurfaceText::read(&entry, r#"lintel = "brick""#),
            "sky" => self.sky = SkyText::read(&entry),
            "light" => self.light = LIGHT.read(&entry),
            "fog" => self.fog = surfaces::fog(&entry),
            "grid" => self.grid = Some(entry),
            "tiles" => self.legend.read_section(CharacterTable::Tiles, &entry),
            "things" => self.legend.read_section(CharacterTable::Things, &entry),
            _ => entry.faults.push(entry.unknown_key("a map", keys::MAP)),
        }
    }
}

/// Reads the goal, a line of at most [`MAX_GOAL`] characters.
fn goal(entry: &Entry<'_, '_>) -> Option<String> {
    let goal = entry.string(r#"goal = "Find the way out""#)?;
    let length = goal.chars().count();
    let message = if goal.contains(char::is_control) {
        "the goal has a line break or another control character".to_owned()
    } else if goal.trim().is_empty() {
        "the goal is empty".to_owned()
    } else if length > MAX_GOAL {
        format!("the goal has {length} characters, but only {MAX_GOAL} fit on the screen")
    } else {
        return Some(goal.to_owned());
    };
    entry.reject(message, "", "write what to do in one short line, or leave it out")
}

pub(crate) fn title(entry: &Entry<'_, '_>) -> Option<String> {
    let title = entry.string(r#"title = "Cellar""#)?;
    if title.contains(char::is_control) {
        let message = "the title has a line break or another control character";
        return entry.reject(message, "", "write it on one line");
    }
    Some(title.to_owned())
}

/// Reads the height of the map's ceiling, which is also the height of walls.
fn ceiling_height(entry: &Entry<'_, '_>) -> Option<f64> {
    let height = HEIGHT.read(entry)?;
    (height >= MIN_HEADROOM).then_some(height).or_else(|| {
        entry.reject(
            format!("the ceiling of a map must be at {MIN_HEADROOM} cells or above"),
            "nobody has room to stand below this",
            "to lower the ceiling in places, draw a tile with a ceiling_height",
        )
    })
}
