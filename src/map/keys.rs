//! The keys of a map with a grid: the keys of the map itself, and of the tables that define
//! characters.

use crate::fault::Fault;
use crate::fault::document::Entry;

/// The keys of a map.
pub(crate) const MAP: &[&str] = &[
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

/// The keys that make a tile on their own.
const TILES: &[&str] = &[
    "wall",
    "door",
    "mask",
    "glass",
    "mirror",
    "pillar",
    "diagonal",
    "thin",
    "floor",
    "ceiling",
    "light",
    "floor_height",
    "ceiling_height",
    "roof_height",
    "riser",
    "lintel",
    "secret",
    "water",
    "plate",
    "moves_to",
    "crumbles",
];

/// The other keys of a tile. Each needs one of the keys in its list.
const OF_TILES: &[(&str, &[&str])] = &[
    ("key", &["door"]),
    ("opacity", &["glass", "mirror"]),
    ("height", &["wall", "mirror", "pillar", "diagonal", "thin", "secret"]),
    ("radius", &["pillar"]),
    ("from", &["diagonal"]),
    ("at", &["thin"]),
    ("switch", &["door", "wall", "moves_to"]),
];

/// The keys that make a thing on their own.
const THINGS: &[&str] = &[
    "start",
    "exit",
    "key",
    "sprite",
    "guard",
    "waypoint",
    "treasure",
    "healing",
    "pebbles",
    "darts",
    "flasks",
    "note",
    "checkpoint",
    "lever",
    "spikes",
];

/// The other keys of a thing, as in [`OF_TILES`].
const OF_THINGS: &[(&str, &[&str])] = &[
    ("anchor", &["sprite"]),
    ("blocks", &["sprite"]),
    ("douse", &["sprite"]),
    ("facings", &["sprite"]),
    ("frame_time", &["sprite"]),
    ("frames", &["sprite"]),
    ("heading", &["sprite", "guard"]),
    ("height", &["sprite"]),
    ("light", &["sprite"]),
    ("reach", &["sprite"]),
    ("on", THINGS),
    ("delay", &["spikes"]),
    ("patrol", &["guard"]),
    ("wander", &["guard"]),
    ("asleep", &["guard"]),
    ("difficulty", &["guard"]),
];
/// Common features of other raycasters that do not exist here.
const NOT_YET: &[(&str, &str)] = &[("pushwall", "moving walls"), ("window", "windows")];

/// One of the two tables that define characters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum CharacterTable {
    Tiles,
    Things,
}

impl CharacterTable {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Tiles => "[tiles]",
            Self::Things => "[things]",
        }
    }

    pub(crate) fn noun(self) -> &'static str {
        match self {
            Self::Tiles => "a tile",
            Self::Things => "a thing",
        }
    }

    pub(crate) fn example(self) -> &'static str {
        match self {
            Self::Tiles => r##""#" = { wall = "brick" }"##,
            Self::Things => r#""@" = { start = 0 }"#,
        }
    }

    /// The keys that make a tile or a thing on their own.
    fn makers(self) -> &'static [&'static str] {
        match self {
            Self::Tiles => TILES,
            Self::Things => THINGS,
        }
    }

    /// The other keys, each with the keys that it needs one of.
    fn others(self) -> &'static [(&'static str, &'static [&'static str])] {
        match self {
            Self::Tiles => OF_TILES,
            Self::Things => OF_THINGS,
        }
    }

    /// The keys that `key` can be used with, if it needs another key; otherwise empty.
    pub(crate) fn owners(self, key: &str) -> &'static [&'static str] {
        self.others().iter().find(|(known, _)| *known == key).map_or(&[], |&(_, owners)| owners)
    }

    /// The fault of an unknown key in a tile or a thing.
    pub(crate) fn unknown_property(self, entry: &Entry<'_, '_>) -> Fault {
        let key = entry.key;
        let fault = |message: String| Fault::new(entry.key_place.clone(), message);
        if let Some((_, plural)) = NOT_YET.iter().find(|(name, _)| *name == key) {
            let known = self.makers().join(", ");
            return fault(format!("{plural} are not supported yet"))
                .help(format!("known keys: {known}"));
        }
        let owners = self.owners(key);
        if let Some((last, others)) = owners.split_last() {
            let to = match others {
                [] => format!("{last:?}"),
                _ => format!("\"{}\" or {last:?}", others.join("\", \"")),
            };
            let help = match owners.len() {
                1 | 2 => format!("add {to} in the same braces"),
                _ => "add one of them in the same braces".to_owned(),
            };
            return fault(format!("\"{key}\" needs {to}, which is missing")).help(help);
        }
        let other = match self {
            Self::Tiles => Self::Things,
            Self::Things => Self::Tiles,
        };
        if other.makers().contains(&key) {
            return fault(format!("\"{key}\" makes {}, not {}", other.noun(), self.noun()))
                .help(format!("move it to {}", other.name()));
        }
        let others = self.others().iter().map(|&(key, _)| key);
        let known: Vec<&str> = self.makers().iter().copied().chain(others).collect();
        entry.unknown_key(self.noun(), &known)
    }
}
