//! The legend: the meaning of each character of the grid, from the tables `[tiles]` and `[things]`.

pub(crate) mod things;
pub(crate) mod tiles;

use std::collections::BTreeMap;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::keys::{self, CharacterTable};
use super::textures::SurfaceText;
use super::values::{HEADING, Name, is_true};
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::world::{Glass, Heading, ThingKind};
use things::{GuardText, SpriteText};
use tiles::{DoorText, ShapeText, TileText, WallText};

const ANOTHER: &str = "draw it with another character";

/// The meanings of the characters that the grid may use.
pub(crate) struct Legend<'a> {
    pub(crate) symbols: BTreeMap<char, Symbol<'a>>,
    /// `false` if a definition is missing from `symbols` because its character is not valid.
    pub(crate) is_complete: bool,
}

/// The definition of a character.
pub(crate) struct Symbol<'a> {
    /// The place of its definition.
    pub(crate) place: Range<usize>,
    pub(crate) meaning: Meaning<'a>,
    pub(crate) tile: TileText<'a>,
    /// The character of the tile that a thing stands on, if it names one, and the place of the name.
    pub(crate) support: Option<(char, Range<usize>)>,
}

/// The meaning of a character in the grid.
pub(crate) enum Meaning<'a> {
    Open,
    /// Open floor with surfaces, a height or a mechanism of its own.
    Floor,
    Wall(WallText<'a>),
    Door(DoorText<'a>),
    Mask(SurfaceText<'a>),
    Glass(Glass),
    /// With its own height, if it has one.
    Mirror(Glass, Option<f64>),
    Shape(ShapeText<'a>),
    Start(Heading),
    Key(Name<'a>),
    Lever(Name<'a>),
    Note(&'a str),
    /// A thing with a built-in sprite that refers to nothing else.
    Item(ThingKind),
    Sprite(SpriteText<'a>),
    Guard(GuardText<'a>),
    Waypoint,
    /// A definition with a fault.
    Unclear,
}

impl<'a> Symbol<'a> {
    /// The switch that moves a tile, if one does.
    pub(crate) fn driver(&self) -> Option<&Name<'a>> {
        match &self.meaning {
            Meaning::Door(door) => door.switch.as_ref(),
            Meaning::Wall(wall) => wall.switch.as_ref(),
            Meaning::Floor => self.tile.switch.as_ref(),
            _ => None,
        }
    }

    /// The switch that a lever or a plate sets, if the symbol is one.
    pub(crate) fn sets(&self) -> Option<&Name<'a>> {
        match &self.meaning {
            Meaning::Lever(switch) => Some(switch),
            Meaning::Floor => self.tile.plate.as_ref(),
            _ => None,
        }
    }
}

/// Returns whether `meaning` is a thing, which stands on a floor.
pub(crate) fn is_thing(meaning: &Meaning<'_>) -> bool {
    use Meaning::{Guard, Item, Key, Lever, Note, Sprite, Start, Waypoint};
    matches!(
        meaning,
        Start(_) | Key(_) | Lever(_) | Note(_) | Item(_) | Sprite(_) | Guard(_) | Waypoint
    )
}

impl Default for Legend<'_> {
    /// The characters with the same meaning in every map.
    fn default() -> Self {
        let open = |character| {
            let (meaning, tile) = (Meaning::Open, TileText::default());
            (character, Symbol { place: 0..0, meaning, tile, support: None })
        };
        Self { symbols: ['.', ' '].map(open).into(), is_complete: true }
    }
}

impl<'a> Legend<'a> {
    /// Returns whether every definition is free of faults.
    pub(crate) fn is_clear(&self) -> bool {
        let is_unclear = |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Unclear);
        self.is_complete && !self.symbols.values().any(is_unclear)
    }

    /// Reads the definitions in the table of `entry`; reports its faults.
    pub(crate) fn read_section(&mut self, section: CharacterTable, entry: &Entry<'a, '_>) {
        let Some(table) = entry.table(section.name()) else {
            self.is_complete = false;
            return;
        };
        for entry in entry.entries(table) {
            let Some(character) = character(section, &entry) else {
                self.is_complete = false;
                continue;
            };
            let (mut meaning, tile) = meaning(section, &entry);
            if self.symbols.contains_key(&character) {
                let message = format!("{character:?} is both a tile and a thing");
                entry.faults.push(
                    Fault::new(entry.key_place.clone(), message)
                        .label("also defined in the other table")
                        .help("a thing stands on open floor: draw one of the two with another character"),
                );
                meaning = Meaning::Unclear;
            }
            let support = match (section, entry.value) {
                (CharacterTable::Things, DeValue::Table(thing)) => support(&entry, thing),
                _ => None,
            };
            let place = entry.key_place;
            self.symbols.insert(character, Symbol { place, meaning, tile, support });
        }
    }
}

/// Reads the tile that a thing's table names as its support, if it names one.
fn support(owner: &Entry<'_, '_>, thing: &DeTable<'_>) -> Option<(char, Range<usize>)> {
    let entry = owner.beside(thing, "on")?;
    let text = entry.string(r#"on = ",""#)?;
    let mut characters = text.chars();
    if let (Some(tile), None) = (characters.next(), characters.next()) {
        return Some((tile, entry.value_place));
    }
    let message = format!("{} is not the character of a tile", quoted(text));
    entry.reject(
        message,
        "",
        "write the character that stands for this floor elsewhere in the grid",
    )
}

/// Reads the character that `entry` defines.
fn character(section: CharacterTable, entry: &Entry<'_, '_>) -> Option<char> {
    let mut characters = entry.key.chars();
    let (message, help) = match (characters.next(), characters.next()) {
        (Some(open @ ('.' | ' ')), None) => {
            (format!("{open:?} is open floor and cannot be defined"), ANOTHER.to_owned())
        }
        (Some(control), None) if control.is_control() => {
            (format!("the control character {control:?} cannot be drawn"), ANOTHER.to_owned())
        }
        (Some(character), None) => return Some(character),
        _ => {
            let (noun, key) = (section.noun(), quoted(entry.key));
            let help = if keys::MAP.contains(&entry.key) {
                format!("move {} above {}", entry.key, section.name())
            } else {
                format!("write, for example, {}", section.example())
            };
            (format!("{noun} is drawn with one character, not {key}"), help)
        }
    };
    entry.faults.push(Fault::new(entry.key_place.clone(), message).help(help));
    None
}

/// Reads the meaning and the tile's text in `entry`.
fn meaning<'a>(section: CharacterTable, entry: &Entry<'a, '_>) -> (Meaning<'a>, TileText<'a>) {
    let mut tile = TileText::default();
    let Some(table) = entry.table(section.example()) else {
        return (Meaning::Unclear, tile);
    };
    let faults_before = entry.faults.len();
    let mut meanings = Vec::new();
    for entry in entry.entries(table) {
        if section == CharacterTable::Things || !tile.take(&entry, table) {
            meanings.extend(property(section, &entry, table));
        }
    }
    if entry.faults.len() > faults_before {
        return (Meaning::Unclear, tile);
    }
    let fault = |message: String| Fault::new(entry.key_place.clone(), message);
    let key = entry.key;
    let fault = match (meanings.pop(), meanings.is_empty()) {
        (Some(meaning), true) => match unsuitable(&tile, &meaning, entry, table) {
            None => return (meaning, tile),
            Some(fault) => fault,
        },
        (None, _) if !tile.is_empty() => match tile.contradiction() {
            None => return (Meaning::Floor, tile),
            Some(fault) => fault,
        },
        (Some(_), false) => several_at_once(entry),
        (None, _) => fault(format!("{key:?} does not say what it is"))
            .help(format!("write, for example, {}", section.example())),
    };
    entry.faults.push(fault);
    (Meaning::Unclear, tile)
}

/// The fault of a tile whose `meaning` cannot have this text. `entry` defines the tile by
/// `table`.
fn unsuitable(
    tile: &TileText<'_>,
    meaning: &Meaning<'_>,
    entry: &Entry<'_, '_>,
    table: &DeTable<'_>,
) -> Option<Fault> {
    if let Some(place) = tile.mechanism.clone() {
        let message = "only a floor can be water, a plate, or move to another height";
        let fault = Fault::new(place, message).label("this tile is not a floor");
        return Some(fault.help("give each its own character"));
    }
    match meaning {
        Meaning::Wall(_) | Meaning::Mirror(..) if tile.has_extent() => Some(several_at_once(entry)),
        Meaning::Door(_) | Meaning::Mask(_) | Meaning::Glass(_) if tile.light.is_some() => {
            let light = entry.beside(table, "light")?.key_place;
            let message = "a door, a mask or glass has no light of its own";
            let fault = Fault::new(light, message);
            let fault = fault.label("only open floor, walls and shapes have light");
            Some(fault.help("leave it out, and give the floor beside it a light"))
        }
        _ => None,
    }
}

fn several_at_once(entry: &Entry<'_, '_>) -> Fault {
    Fault::new(entry.key_place.clone(), format!("{:?} has more than one meaning", entry.key))
        .help("give each its own character")
}

/// Reads one property of a tile or a thing, which may be its meaning.
fn property<'a>(
    section: CharacterTable,
    entry: &Entry<'a, '_>,
    table: &'a DeTable<'_>,
) -> Option<Meaning<'a>> {
    if section.owners(entry.key).iter().any(|&owner| table.contains_key(owner)) {
        return None;
    }
    match (section, entry.key) {
        (CharacterTable::Tiles, "wall" | "secret") => {
            WallText::read(entry, table).map(Meaning::Wall)
        }
        (CharacterTable::Tiles, "door") => DoorText::read(entry, table).map(Meaning::Door),
        (CharacterTable::Tiles, "mask") => {
            SurfaceText::read(entry, r#"{ mask = "grate" }"#).map(Meaning::Mask)
        }
        (CharacterTable::Tiles, "glass") => tiles::glass(entry, table).map(Meaning::Glass),
        (CharacterTable::Tiles, "mirror") => {
            let (tint, height) = (tiles::mirror(entry, table), tiles::wall_height(entry, table));
            tint.map(|tint| Meaning::Mirror(tint, height))
        }
        (CharacterTable::Tiles, "pillar" | "diagonal" | "thin") => {
            ShapeText::read(entry, table).map(Meaning::Shape)
        }
        (CharacterTable::Things, "start") => HEADING.read(entry).map(Meaning::Start),
        (CharacterTable::Things, "key") => {
            Name::read(entry, "key", r#"{ key = "brass" }"#).map(Meaning::Key)
        }
        (CharacterTable::Things, "lever") => {
            Name::read(entry, "switch", r#"{ lever = "gate" }"#).map(Meaning::Lever)
        }
        (CharacterTable::Things, "note") => things::note(entry).map(Meaning::Note),
        (CharacterTable::Things, "sprite") => SpriteText::read(entry, table).map(Meaning::Sprite),
        (CharacterTable::Things, "guard") => GuardText::read(entry, table).map(Meaning::Guard),
        (CharacterTable::Things, "waypoint") => is_true(entry).then_some(Meaning::Waypoint),
        (CharacterTable::Things, key) if things::ITEMS.contains(&key) => {
            things::item(entry, table).map(Meaning::Item)
        }
        _ => {
            entry.faults.push(section.unknown_property(entry));
            None
        }
    }
}
