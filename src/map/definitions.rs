//! Definitions: all keys of a map except its grid, each read by itself.

use std::ops::{Range, RangeInclusive};

use toml::de::DeTable;

use super::air::{self, SkyText};
use super::covering::{CeilingText, CoveringText};
use super::heights;
use super::items::whole;
use super::legend::{self, Legend, Section};
use super::textures::Surface;
use crate::color::Rgb;
use crate::fault::Fault;
use crate::fault::document::{Entry, FaultList, entries};
use crate::world::{Fog, Heights, Light};

/// The keys of a map.
pub(crate) const KEYS: &[&str] = &[
    "title",
    "goal",
    "par",
    "treasure_needed",
    "ceiling",
    "ceiling_height",
    "floor",
    "riser",
    "lintel",
    "light",
    "sky",
    "fog",
    "grid",
    "tiles",
    "things",
];
/// In seconds, up to a day.
const LONGEST_PAR: RangeInclusive<u32> = 1..=86_400;
const MOST_TREASURE: RangeInclusive<u32> = 1..=1_000_000;
const DEFAULT_CEILING: Rgb = Rgb::new(0x30, 0x30, 0x30);
const DEFAULT_FLOOR: Rgb = Rgb::new(0x58, 0x58, 0x58);

/// All that a map defines besides its grid.
pub(crate) struct Definitions<'a, 't> {
    pub(crate) title: String,
    pub(crate) goal: Option<String>,
    /// The time in which a good player finishes, in seconds.
    pub(crate) par: Option<u32>,
    /// The treasure without which exits do not let anybody out, with its place in the map.
    pub(crate) treasure_needed: Option<(u32, Range<usize>)>,
    pub(crate) ceiling: CeilingText<'a>,
    /// The height of the ceiling and of walls.
    pub(crate) ceiling_height: f64,
    pub(crate) floor: CoveringText<'a>,
    /// The sides of raised floors, for tiles without their own.
    pub(crate) riser: Option<Surface<'a>>,
    /// The sides of what is above lowered ceilings, for tiles without their own.
    pub(crate) lintel: Option<Surface<'a>>,
    pub(crate) sky: Option<SkyText<'a>>,
    pub(crate) fog: Option<Fog>,
    /// The light of tiles without their own.
    pub(crate) light: Option<Light>,
    pub(crate) grid: Option<Entry<'a, 't>>,
    pub(crate) legend: Legend<'a>,
}

impl<'a, 't> Definitions<'a, 't> {
    /// Reads the definitions in `document`. Faults are reported, and their definitions
    /// replaced by defaults.
    pub(crate) fn read(document: &'a DeTable<'t>, faults: &'a FaultList) -> Self {
        let mut definitions = Self {
            title: String::new(),
            goal: None,
            par: None,
            treasure_needed: None,
            ceiling: CeilingText::plain(DEFAULT_CEILING),
            ceiling_height: Heights::LEVEL.ceiling(),
            floor: CoveringText::plain(DEFAULT_FLOOR),
            riser: None,
            lintel: None,
            sky: None,
            fog: None,
            light: None,
            grid: None,
            legend: Legend::new(),
        };
        for entry in entries(document, faults) {
            definitions.read_entry(entry);
        }
        definitions
    }

    fn read_entry(&mut self, entry: Entry<'a, 't>) {
        match entry.key {
            "title" => self.title = title(&entry).unwrap_or_default(),
            "goal" => self.goal = goal(&entry),
            "par" => self.par = whole(&entry, LONGEST_PAR),
            "treasure_needed" => {
                let worth = whole(&entry, MOST_TREASURE);
                self.treasure_needed = worth.map(|worth| (worth, entry.value_place));
            }
            "ceiling" => {
                if let Some(ceiling) = CeilingText::read(&entry, r##"ceiling = "#202028""##) {
                    self.ceiling = ceiling;
                }
            }
            "ceiling_height" => {
                if let Some(height) = heights::map_ceiling(&entry) {
                    self.ceiling_height = height;
                }
            }
            "floor" => {
                if let Some(floor) = CoveringText::read(&entry, r#"floor = "stone""#) {
                    self.floor = floor;
                }
            }
            "riser" => self.riser = Surface::read(&entry, r#"riser = "stone""#),
            "lintel" => self.lintel = Surface::read(&entry, r#"lintel = "brick""#),
            "sky" => self.sky = SkyText::read(&entry),
            "light" => self.light = legend::light(&entry),
            "fog" => self.fog = air::fog(&entry),
            "grid" => self.grid = Some(entry),
            "tiles" => self.legend.read_section(Section::Tiles, &entry),
            "things" => self.legend.read_section(Section::Things, &entry),
            _ => entry.faults.push(entry.unknown_key("a map", KEYS)),
        }
    }
}

/// Reads the goal, a line of at most 40 characters.
fn goal(entry: &Entry<'_, '_>) -> Option<String> {
    const LONGEST_GOAL: usize = 40;
    let goal = entry.string(r#"goal = "Find the way out""#)?;
    let length = goal.chars().count();
    let message = if goal.contains(char::is_control) {
        "the goal has a line break or another control character".to_owned()
    } else if goal.trim().is_empty() {
        "the goal is empty".to_owned()
    } else if length > LONGEST_GOAL {
        format!("the goal has {length} characters, and {LONGEST_GOAL} fit the screen")
    } else {
        return Some(goal.to_owned());
    };
    let help = "write what to do in one short line, or leave it out";
    entry.faults.push(Fault::new(entry.value_place.clone(), message).help(help));
    None
}

pub(crate) fn title(entry: &Entry<'_, '_>) -> Option<String> {
    let title = entry.string(r#"title = "Cellar""#)?;
    if title.contains(char::is_control) {
        let message = "the title has a line break or another control character";
        entry
            .faults
            .push(Fault::new(entry.value_place.clone(), message).help("write it on one line"));
        return None;
    }
    Some(title.to_owned())
}
