//! The two tables of the legend, and the keys of their entries.

use crate::fault::Fault;
use crate::fault::document::Entry;
use crate::map::sprites;

/// Common features of other raycasters that do not exist here.
const NOT_YET: &[(&str, &str)] = &[("pushwall", "moving walls"), ("window", "windows")];

const OF_TILES: &[(&str, &str)] = &[
    ("key", "door"),
    ("opacity", "glass"),
    ("opacity", "mirror"),
    ("height", "wall"),
    ("height", "mirror"),
    ("height", "pillar"),
    ("height", "diagonal"),
    ("height", "thin"),
    ("height", "secret"),
    ("radius", "pillar"),
    ("from", "diagonal"),
    ("at", "thin"),
    ("switch", "door"),
    ("switch", "wall"),
    ("switch", "moves_to"),
];

const OF_THINGS: &[(&str, &str)] = &[
    ("on", "start"),
    ("on", "exit"),
    ("on", "key"),
    ("on", "sprite"),
    ("on", "guard"),
    ("on", "waypoint"),
    ("on", "treasure"),
    ("on", "healing"),
    ("on", "pebbles"),
    ("on", "darts"),
    ("on", "flasks"),
    ("on", "note"),
    ("on", "checkpoint"),
    ("on", "lever"),
    ("on", "spikes"),
    ("delay", "spikes"),
    ("heading", "guard"),
    ("patrol", "guard"),
    ("wander", "guard"),
    ("asleep", "guard"),
    ("difficulty", "guard"),
];

/// One of the two tables that define characters.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Section {
    Tiles,
    Things,
}

impl Section {
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

    fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Tiles => &[
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
            ],
            Self::Things => &[
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
            ],
        }
    }

    /// The keys that belong to another key, with that key.
    pub(crate) fn additions(self) -> impl Iterator<Item = (&'static str, &'static str)> {
        let (additions, more): (&[_], &[_]) = match self {
            Self::Tiles => (OF_TILES, &[]),
            Self::Things => (&sprites::ADDITIONS, OF_THINGS),
        };
        additions.iter().chain(more).copied()
    }

    pub(crate) fn example(self) -> &'static str {
        match self {
            Self::Tiles => r##""#" = { wall = "brick" }"##,
            Self::Things => r#""@" = { start = 0 }"#,
        }
    }

    fn other(self) -> Self {
        match self {
            Self::Tiles => Self::Things,
            Self::Things => Self::Tiles,
        }
    }

    /// The fault of a key that a tile or a thing does not have.
    pub(crate) fn unknown_property(self, entry: &Entry<'_, '_>) -> Fault {
        let place = || entry.key_place.clone();
        if let Some((_, plural)) = NOT_YET.iter().find(|(key, _)| *key == entry.key) {
            return Fault::new(place(), format!("{plural} are not supported yet"))
                .help(format!("known keys: {}", self.keys().join(", ")));
        }
        let wanted = self.additions().filter(|(key, _)| *key == entry.key);
        let wanted: Vec<&str> = wanted.map(|(_, to)| to).collect();
        if !wanted.is_empty() {
            let (key, to) = (entry.key, alternatives(&wanted));
            let message = format!("\"{key}\" goes with {to}, and there is none");
            let help = match wanted.len() {
                1 | 2 => format!("name a {} in the same braces", wanted.join(" or a ")),
                _ => "name one of them in the same braces".to_owned(),
            };
            return Fault::new(place(), message).help(help);
        }
        let other = self.other();
        if other.keys().contains(&entry.key) {
            let message = format!("\"{}\" makes {}, not {}", entry.key, other.noun(), self.noun());
            return Fault::new(place(), message).help(format!("move it to {}", other.name()));
        }
        let mut known = self.keys().to_vec();
        for (addition, _) in self.additions() {
            if !known.contains(&addition) {
                known.push(addition);
            }
        }
        entry.unknown_key(self.noun(), &known)
    }
}

/// `names` in quotes, as a choice.
fn alternatives(names: &[&str]) -> String {
    let quoted: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
    match quoted.split_last() {
        Some((last, [])) => last.clone(),
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}
