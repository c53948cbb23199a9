//! Classes: names that Tiled offers for objects and tiles, and the values that they stand for.
//!
//! Tiled does not save a value that a class gives by default, so the values are known here.

use crate::world::GuardKind;
use crate::world::sprite::builtin;

/// The kind of a class: it makes a thing, which stands in a cell, or a tile of each cell that it
/// covers.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum ClassKind {
    Thing,
    Tile,
}

use ClassKind::{Thing, Tile};

/// A class: its name, which is a key of a map file, the key's value as TOML, and other keys with
/// their defaults.
pub(crate) struct Class {
    pub(crate) name: &'static str,
    pub(crate) kind: ClassKind,
    pub(crate) value: &'static str,
    pub(crate) others: &'static [(&'static str, &'static str)],
}

const fn class(kind: ClassKind, name: &'static str, value: &'static str) -> Class {
    Class { name, kind, value, others: &[] }
}

pub(crate) const CLASSES: &[Class] = &[
    class(Thing, "start", "0"),
    class(Thing, "exit", "true"),
    Class {
        others: &[("heading", "0"), ("difficulty", "\"easy\"")],
        ..class(Thing, "guard", "\"warden\"")
    },
    class(Thing, "treasure", "20"),
    class(Thing, "key", "\"brass\""),
    Class { others: &[("heading", "0")], ..class(Thing, "sprite", "\"barrel\"") },
    class(Thing, "note", "\"A note.\""),
    class(Thing, "checkpoint", "true"),
    class(Thing, "healing", "2"),
    class(Thing, "pebbles", "3"),
    class(Thing, "darts", "1"),
    class(Thing, "flasks", "1"),
    class(Thing, "lever", "\"gate\""),
    class(Thing, "spikes", "2"),
    class(Tile, "wall", "\"brick\""),
    class(Tile, "door", "\"oak\""),
    class(Tile, "secret", "\"brick\""),
    class(Tile, "mask", "\"grate\""),
    class(Tile, "glass", "\"#80c0ff\""),
    class(Tile, "mirror", "true"),
    class(Tile, "pillar", "\"marble\""),
    Class { others: &[("from", "\"north-west\"")], ..class(Tile, "diagonal", "\"brick\"") },
    Class { others: &[("at", "\"north-south\"")], ..class(Tile, "thin", "\"wood\"") },
    class(Tile, "plate", "\"gate\""),
    class(Tile, "water", "true"),
];

/// The tiles that are more than a floor. A tile of one of these replaces the tile below it.
pub(crate) const SOLID: [&str; 9] =
    ["wall", "secret", "door", "mask", "glass", "mirror", "pillar", "diagonal", "thin"];
/// The tiles without a floor or a ceiling that shows.
pub(crate) const FULL: [&str; 3] = ["wall", "secret", "mirror"];
/// The classes whose value may be a picture: the tile's, if it has one.
pub(crate) const PICTURED: [&str; 8] =
    ["wall", "secret", "door", "mask", "pillar", "diagonal", "thin", "sprite"];
/// The keys that make a tile a floor, in a layer of walls as well.
pub(crate) const FLOORS: [&str; 6] =
    ["floor", "floor_height", "water", "plate", "moves_to", "crumbles"];
/// The keys of a floor and a ceiling.
pub(crate) const GROUND: [&str; 12] = [
    "floor",
    "ceiling",
    "floor_height",
    "ceiling_height",
    "roof_height",
    "riser",
    "lintel",
    "light",
    "water",
    "plate",
    "moves_to",
    "crumbles",
];

/// Returns whether something of this class is a thing; without a class, whether the keys that it
/// `has` make one.
pub(crate) fn is_thing(class: &str, has: impl Fn(&str) -> bool) -> bool {
    match named(class).or(of_kind(class).map(|(class, _)| class)) {
        Some(class) => class.kind == Thing,
        // A door has a key, too.
        None => !has("door") && CLASSES.iter().any(|class| class.kind == Thing && has(class.name)),
    }
}

/// The class `name`.
pub(crate) fn named(name: &str) -> Option<&'static Class> {
    CLASSES.iter().find(|class| class.name == name)
}

/// The class for a kind of guard or a built-in sprite, and its value.
pub(crate) fn of_kind(name: &str) -> Option<(&'static Class, &'static str)> {
    let guard = GuardKind::ALL.map(GuardKind::name).into_iter().find(|kind| *kind == name);
    let sprite = builtin::NAMES.iter().copied().find(|sprite| *sprite == name);
    match (guard, sprite) {
        (Some(kind), _) => Some((named("guard")?, kind)),
        (None, Some(sprite)) => Some((named("sprite")?, sprite)),
        (None, None) => None,
    }
}
