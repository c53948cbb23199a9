//! The legend: what each character of the grid means, from the tables `[tiles]` and `[things]`.

mod property;
mod section;
mod surroundings;

use std::collections::BTreeMap;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::definitions::KEYS;
use super::doors::{DoorSymbol, KeySymbol};
use super::drawing::Drawing;
use super::guards::GuardSymbol;
use super::items::ItemSymbol;
use super::mechanisms::MovingWallSymbol;
use super::per_character::PerCharacter;
use super::see_through::MaskSymbol;
use super::shapes::ShapeSymbol;
use super::sprites::SpriteSymbol;
use super::textures::Surface;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::world::{Cell, Glass, Heading};
use property::property;
pub(crate) use property::{heading, light};
pub(crate) use section::Section;
pub(crate) use surroundings::Surroundings;
use surroundings::Taken;

/// The meanings of the characters that the grid may use.
pub(crate) struct Legend<'a> {
    pub(crate) symbols: BTreeMap<char, Symbol<'a>>,
    /// Whether `symbols` has all definitions: not those without a valid character.
    pub(crate) is_complete: bool,
}

/// What a character means.
pub(crate) struct Symbol<'a> {
    /// The place of its definition.
    pub(crate) place: Range<usize>,
    pub(crate) meaning: Meaning<'a>,
    pub(crate) surroundings: Surroundings<'a>,
    /// The tile that a thing stands on, if it names one.
    pub(crate) support: Option<Support>,
}

/// The tile that a thing stands on.
pub(crate) struct Support {
    /// The character of the tile.
    pub(crate) tile: char,
    /// The place of the name in the map.
    pub(crate) place: Range<usize>,
}

/// What a character means in the grid.
pub(crate) enum Meaning<'a> {
    Open,
    /// With its own height, if it has one.
    Wall(Surface<'a>, Option<f64>),
    /// A wall that sinks into the floor.
    MovingWall(MovingWallSymbol<'a>),
    /// Open floor with surroundings of its own.
    Floor,
    Door(DoorSymbol<'a>),
    Mask(MaskSymbol<'a>),
    Glass(Glass),
    /// With its own height, if it has one.
    Mirror(Glass, Option<f64>),
    Shape(ShapeSymbol<'a>),
    Start(Heading),
    Exit,
    Key(KeySymbol<'a>),
    Ornament(SpriteSymbol<'a>),
    Item(ItemSymbol<'a>),
    Guard(GuardSymbol<'a>),
    Waypoint,
    /// A definition with a fault.
    Unclear,
}

impl<'a> Legend<'a> {
    /// The characters with the same meaning in every map.
    pub(crate) fn new() -> Self {
        let open = |character| {
            let (meaning, surroundings) = (Meaning::Open, Surroundings::default());
            (character, Symbol { place: 0..0, meaning, surroundings, support: None })
        };
        Self { symbols: ['.', ' '].map(open).into(), is_complete: true }
    }

    /// Whether no definition has a fault.
    pub(crate) fn is_clear(&self) -> bool {
        let is_unclear = |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Unclear);
        self.is_complete && !self.symbols.values().any(is_unclear)
    }

    /// The characters that occur in `drawing`, with their definitions.
    pub(crate) fn used_in<'l>(
        &'l self,
        drawing: &'l Drawing<'_>,
    ) -> impl Iterator<Item = (char, &'l Symbol<'a>)> {
        drawing
            .characters()
            .filter_map(|(character, _)| Some((character, self.symbols.get(&character)?)))
    }

    /// The cells of `drawing` whose characters are more than floor or a wall, with their definitions, row by
    /// row from the north.
    pub(crate) fn of_cells<'l>(
        &'l self,
        drawing: &'l Drawing<'_>,
    ) -> impl Iterator<Item = (Cell, &'l Symbol<'a>)> {
        let mut is_more = PerCharacter::<bool>::new();
        for (character, symbol) in self.used_in(drawing) {
            let is_floor = matches!(symbol.meaning, Meaning::Open | Meaning::Floor);
            let is_wall = matches!(symbol.meaning, Meaning::Wall(..));
            let is_plate = symbol.surroundings.mechanism.plate.is_some();
            *is_more.get_mut(character) = !is_floor && !is_wall || is_plate;
        }
        let cells = drawing.cells().filter(move |&(_, character)| is_more.get(character));
        cells.filter_map(|(cell, character)| Some((cell, self.symbols.get(&character)?)))
    }

    /// Reads the definitions in the table of `entry`; reports its faults.
    pub(crate) fn read_section(&mut self, section: Section, entry: &Entry<'a, '_>) {
        let Some(table) = entry.table(section.name()) else {
            self.is_complete = false;
            return;
        };
        for entry in entry.entries(table) {
            let character = match character(section, &entry) {
                Ok(character) => character,
                Err(fault) => {
                    entry.faults.push(fault);
                    self.is_complete = false;
                    continue;
                }
            };
            let (mut meaning, surroundings) = meaning(section, &entry);
            if self.symbols.contains_key(&character) {
                entry.faults.push(defined_twice(character, entry.key_place.clone()));
                meaning = Meaning::Unclear;
            }
            let support = match (section, entry.value) {
                (Section::Things, DeValue::Table(thing)) => Support::read(&entry, thing),
                _ => None,
            };
            let place = entry.key_place;
            self.symbols.insert(character, Symbol { place, meaning, surroundings, support });
        }
    }
}

impl Support {
    /// Reads the tile that the table of a thing names, if it does.
    fn read(owner: &Entry<'_, '_>, thing: &DeTable<'_>) -> Option<Self> {
        let entry = owner.entries(thing).find(|entry| entry.key == "on")?;
        let text = entry.string(r#"on = ",""#)?;
        let mut characters = text.chars();
        if let (Some(tile), None) = (characters.next(), characters.next()) {
            return Some(Self { tile, place: entry.value_place });
        }
        entry.faults.push(
            Fault::new(
                entry.value_place,
                format!("{} is not the character of a tile", quoted(text)),
            )
            .help("write the character that the floor is drawn with elsewhere"),
        );
        None
    }
}

/// Reads the character that `entry` defines.
fn character(section: Section, entry: &Entry<'_, '_>) -> Result<char, Fault> {
    const ANOTHER: &str = "draw it with another character";
    let fault = |message: String| Fault::new(entry.key_place.clone(), message);
    let mut characters = entry.key.chars();
    match (characters.next(), characters.next()) {
        (Some(open @ ('.' | ' ')), None) => {
            Err(fault(format!("{open:?} is open floor and cannot be defined")).help(ANOTHER))
        }
        (Some(control), None) if control.is_control() => {
            Err(fault(format!("the control character {control:?} cannot be drawn")).help(ANOTHER))
        }
        (Some(character), None) => Ok(character),
        _ => {
            let (noun, key) = (section.noun(), quoted(entry.key));
            let fault = fault(format!("{noun} is drawn with one character, not {key}"));
            Err(if KEYS.contains(&entry.key) {
                fault.help(format!("move {} above {}", entry.key, section.name()))
            } else {
                fault.help(format!("write, for example, {}", section.example()))
            })
        }
    }
}

/// Reads the meaning and the surroundings in `entry`.
fn meaning<'a>(section: Section, entry: &Entry<'a, '_>) -> (Meaning<'a>, Surroundings<'a>) {
    let mut surroundings = Surroundings::default();
    let Some(table) = entry.table(section.example()) else {
        return (Meaning::Unclear, surroundings);
    };
    let faults_before = entry.faults.len();
    let mut meanings: Vec<_> = entry
        .entries(table)
        .filter_map(|entry| match surroundings.take(section, &entry, table) {
            Taken::Yes => None,
            Taken::No => property(section, &entry, table),
        })
        .collect();
    if entry.faults.len() > faults_before {
        return (Meaning::Unclear, surroundings);
    }
    let place = || entry.key_place.clone();
    let several_at_once = || {
        Fault::new(place(), format!("{:?} is several things at once", entry.key))
            .help("draw each with a character of its own")
    };
    match (meanings.pop(), meanings.is_empty()) {
        (Some(meaning), true) if surroundings.suit(&meaning) => return (meaning, surroundings),
        (Some(_), true) if !surroundings.mechanism.is_empty() => {
            entry.faults.extend(surroundings.mechanism.not_on_a_floor());
        }
        (Some(Meaning::Door(_) | Meaning::Mask(_) | Meaning::Glass(_)), true) => {
            // These may have anything else.
            let light = entry.entries(table).find(|entry| entry.key == "light");
            entry.faults.extend(light.map(|light| no_light_of_its_own(light.key_place)));
        }
        (None, _) if !surroundings.is_empty() => match surroundings.mechanism.contradiction() {
            None => return (Meaning::Floor, surroundings),
            fault => entry.faults.extend(fault),
        },
        (Some(_), _) => entry.faults.push(several_at_once()),
        (None, _) => entry.faults.push(
            Fault::new(place(), format!("{:?} does not say what it is", entry.key))
                .help(format!("write, for example, {}", section.example())),
        ),
    }
    (Meaning::Unclear, surroundings)
}

/// The fault of a door, a mask or glass with the light at `place`.
fn no_light_of_its_own(place: Range<usize>) -> Fault {
    Fault::new(place, "a door, a mask or glass has no light of its own")
        .label("open floor, walls and shapes have one")
        .help("leave it out, and give the floor beside it a light")
}

fn defined_twice(character: char, place: Range<usize>) -> Fault {
    Fault::new(place, format!("{character:?} is both a tile and a thing"))
        .label("also defined in the other table")
        .help("a thing stands on open floor: draw one of the two with another character")
}
