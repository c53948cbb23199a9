//! The legend: what each character of the grid means, from the tables `[tiles]` and `[things]`.

mod property;
mod section;

use std::collections::BTreeMap;
use std::ops::Range;

use toml::de::{DeTable, DeValue};

use super::covering::{CeilingText, CoveringText};
use super::definitions::KEYS;
use super::doors::{DoorSymbol, KeySymbol};
use super::heights::HeightsText;
use super::see_through::MaskSymbol;
use super::shapes::ShapeSymbol;
use super::sprites::SpriteSymbol;
use super::textures::Surface;
use crate::fault::document::{Entry, entries};
use crate::fault::{Fault, quoted};
use crate::world::{Glass, Heading, Light};
pub(super) use property::light;
use property::property;
pub(super) use section::Section;

/// What the characters mean that the grid may be drawn with.
pub(super) struct Legend<'a> {
    pub(super) symbols: BTreeMap<char, Symbol<'a>>,
    /// Whether every definition is in `symbols`: false where the map has one without a character
    /// to find it by.
    pub(super) is_complete: bool,
}

/// What a character means.
pub(super) struct Symbol<'a> {
    /// Where it is defined.
    pub(super) place: Range<usize>,
    pub(super) meaning: Meaning<'a>,
    pub(super) surroundings: Surroundings<'a>,
    /// Of a thing, which tile it stands on; the map's own floor, if it does not say.
    pub(super) support: Option<Support>,
}

/// The tile that a thing stands on.
pub(super) struct Support {
    /// What it is drawn with elsewhere.
    pub(super) tile: char,
    /// Where the map says it.
    pub(super) place: Range<usize>,
}

/// What a character stands for in the grid.
pub(super) enum Meaning<'a> {
    Open,
    /// With a height of its own, if any.
    Wall(Surface<'a>, Option<f64>),
    /// Open floor that is not like the map's, but as the symbol's surroundings say.
    Floor,
    Door(DoorSymbol<'a>),
    Mask(MaskSymbol<'a>),
    Glass(Glass),
    /// With a height of its own, if any.
    Mirror(Glass, Option<f64>),
    Shape(ShapeSymbol<'a>),
    Start(Heading),
    Exit,
    Key(KeySymbol<'a>),
    Ornament(SpriteSymbol<'a>),
    /// Something that a fault has been found with already.
    Unclear,
}

/// What a tile has of its own; the rest is as the map says.
#[derive(Default)]
pub(super) struct Surroundings<'a> {
    pub(super) floor: Option<CoveringText<'a>>,
    pub(super) ceiling: Option<CeilingText<'a>>,
    pub(super) light: Option<Light>,
    pub(super) heights: HeightsText<'a>,
}

impl<'a> Legend<'a> {
    /// The characters that mean the same in every map.
    pub(super) fn new() -> Self {
        let open = |character| {
            let (meaning, surroundings) = (Meaning::Open, Surroundings::default());
            (character, Symbol { place: 0..0, meaning, surroundings, support: None })
        };
        Self { symbols: ['.', ' '].map(open).into(), is_complete: true }
    }

    /// Whether every definition is known, and what it means.
    pub(super) fn is_clear(&self) -> bool {
        let is_unclear = |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Unclear);
        self.is_complete && !self.symbols.values().any(is_unclear)
    }

    /// Adds the definitions in the table that `entry` holds; what is wrong there is added to
    /// `faults`.
    pub(super) fn read_section(
        &mut self,
        section: Section,
        entry: &Entry<'a, '_>,
        faults: &mut Vec<Fault>,
    ) {
        let Some(table) = entry.table(section.name(), faults) else {
            self.is_complete = false;
            return;
        };
        for entry in entries(table) {
            let character = match character(section, &entry) {
                Ok(character) => character,
                Err(fault) => {
                    faults.push(fault);
                    self.is_complete = false;
                    continue;
                }
            };
            let (mut meaning, surroundings) = meaning(section, &entry, faults);
            if self.symbols.contains_key(&character) {
                faults.push(defined_twice(character, entry.key_place.clone()));
                meaning = Meaning::Unclear;
            }
            let support = match (section, entry.value) {
                (Section::Things, DeValue::Table(thing)) => Support::read(thing, faults),
                _ => None,
            };
            let place = entry.key_place;
            self.symbols.insert(character, Symbol { place, meaning, surroundings, support });
        }
    }
}

impl Support {
    /// The tile that the table of a thing names, if it does.
    fn read(thing: &DeTable<'_>, faults: &mut Vec<Fault>) -> Option<Self> {
        let entry = entries(thing).find(|entry| entry.key == "on")?;
        let text = entry.string(r#"on = ",""#, faults)?;
        let mut characters = text.chars();
        if let (Some(tile), None) = (characters.next(), characters.next()) {
            return Some(Self { tile, place: entry.value_place });
        }
        faults.push(
            Fault::new(
                entry.value_place,
                format!("{} is not the character of a tile", quoted(text)),
            )
            .help("write the character that the floor is drawn with elsewhere"),
        );
        None
    }
}

/// The character that `entry` defines.
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

/// What the character of `entry` stands for, and what there is around it.
fn meaning<'a>(
    section: Section,
    entry: &Entry<'a, '_>,
    faults: &mut Vec<Fault>,
) -> (Meaning<'a>, Surroundings<'a>) {
    let mut surroundings = Surroundings::default();
    let Some(table) = entry.table(section.example(), faults) else {
        return (Meaning::Unclear, surroundings);
    };
    let faults_before = faults.len();
    let mut meanings: Vec<_> = entries(table)
        .filter_map(|entry| match surroundings.take(section, &entry, faults) {
            Taken::Yes => None,
            Taken::No => property(section, &entry, table, faults),
        })
        .collect();
    if faults.len() > faults_before {
        return (Meaning::Unclear, surroundings);
    }
    let place = || entry.key_place.clone();
    let several_at_once = || {
        Fault::new(place(), format!("{:?} is several things at once", entry.key))
            .help("draw each with a character of its own")
    };
    match (meanings.pop(), meanings.is_empty()) {
        (Some(meaning), true) if surroundings.suit(&meaning) => return (meaning, surroundings),
        (None, _) if !surroundings.is_empty() => return (Meaning::Floor, surroundings),
        (Some(_), _) => faults.push(several_at_once()),
        (None, _) => faults.push(
            Fault::new(place(), format!("{:?} does not say what it is", entry.key))
                .help(format!("write, for example, {}", section.example())),
        ),
    }
    (Meaning::Unclear, surroundings)
}

/// Whether a property was one of the [`Surroundings`].
#[derive(Clone, Copy, PartialEq, Eq)]
enum Taken {
    Yes,
    No,
}

impl<'a> Surroundings<'a> {
    fn is_empty(&self) -> bool {
        !self.has_covering() && self.light.is_none() && self.heights.is_empty()
    }

    /// Whether a tile of that meaning can have these.
    fn suit(&self, meaning: &Meaning<'_>) -> bool {
        match meaning {
            Meaning::Wall(..) | Meaning::Mirror(..) => {
                !self.has_covering() && self.heights.is_empty()
            }
            Meaning::Shape(_) => true,
            Meaning::Door(_) | Meaning::Mask(_) | Meaning::Glass(_) => self.light.is_none(),
            _ => self.is_empty(),
        }
    }

    fn has_covering(&self) -> bool {
        self.floor.is_some() || self.ceiling.is_some()
    }

    /// Takes the property that `entry` is, if it is one of a tile's surroundings.
    fn take(&mut self, section: Section, entry: &Entry<'a, '_>, faults: &mut Vec<Fault>) -> Taken {
        match (section, entry.key) {
            (Section::Tiles, "floor") => {
                self.floor = CoveringText::read(entry, r#"{ floor = "moss" }"#, faults);
            }
            (Section::Tiles, "ceiling") => {
                self.ceiling = CeilingText::read(entry, r#"{ ceiling = "wood" }"#, faults);
            }
            (Section::Tiles, "light") => self.light = light(entry, faults),
            (Section::Tiles, _) if self.heights.take(entry, faults) => {}
            _ => return Taken::No,
        }
        Taken::Yes
    }
}

fn defined_twice(character: char, place: Range<usize>) -> Fault {
    Fault::new(place, format!("{character:?} is both a tile and a thing"))
        .label("also defined in the other table")
        .help("a thing stands on open floor: draw one of the two with another character")
}
