//! Standing rooms: the tables `[[room]]` of a configuration.

use std::fmt;
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::Config;
use crate::rooms::room::Mode;
use crate::rooms::summary::RoomWish;
use cellcaster::app::parts::Value as _;
use cellcaster::fault::document::{self, Entry, FaultList};
use cellcaster::fault::{Fault, Faults, nearest, quoted};
use cellcaster::world::Difficulty;

/// The most standing rooms.
const MOST: usize = 32;

/// A room that is always there, with members or without.
///
/// Its `Display` output is its table in a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StandingRoom(pub(crate) RoomWish);

impl StandingRoom {
    /// The rooms of a host that names none: one to walk about in, and one to play in.
    pub(crate) fn usual() -> Vec<Self> {
        [Mode::Roam, Mode::Tag].map(|mode| Self(in_mode(mode))).into()
    }

    /// The name of its level: of a built-in one, or of a map of the host.
    pub fn level(&self) -> &str {
        &self.0.level
    }
}

impl fmt::Display for StandingRoom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let RoomWish { level, mode, difficulty } = &self.0;
        writeln!(f, "[[room]]\nmode = \"{}\"\nlevel = \"{level}\"", mode.name())?;
        writeln!(f, "difficulty = \"{}\"", difficulty.name())
    }
}

impl Config {
    /// Checks that there are the levels of the standing rooms in `text`, a configuration that was parsed
    /// without a fault. `levels` are all names of levels.
    ///
    /// # Errors
    /// A fault for each unknown level.
    pub fn check_levels(text: &str, name: &str, levels: &[&str]) -> Result<(), Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        for (level, place) in named_levels(&document) {
            if !levels.contains(&level) {
                let message = format!("there is no level {}", quoted(level));
                let help = match nearest(level, levels) {
                    Some(meant) => format!("the nearest level is {}", quoted(meant)),
                    None => format!("the levels are {}", levels.join(", ")),
                };
                faults.push(Fault::new(place, message).help(help));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(Faults::new(name, text, faults.take())) }
    }
}

/// The levels of the standing rooms, with their places.
fn named_levels<'a>(document: &'a DeTable<'_>) -> Vec<(&'a str, Range<usize>)> {
    let Some(DeValue::Array(rooms)) = document.get("room").map(Spanned::get_ref) else {
        return Vec::new();
    };
    let tables = rooms.iter().filter_map(|room| match room.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    });
    let levels = tables.filter_map(|table| {
        let value = table.get("level")?;
        let DeValue::String(level) = value.get_ref() else { return None };
        Some((level.as_ref(), value.span()))
    });
    levels.collect()
}

/// The standing rooms of an entry `room`; `None` after a fault of the whole list.
pub(crate) fn read(entry: &Entry<'_, '_>) -> Option<Vec<StandingRoom>> {
    const EXAMPLE: &str = "[[room]]";
    let Some(list) = entry.list() else {
        entry.faults.push(entry.wrong_type("a list of tables", EXAMPLE));
        return None;
    };
    if list.len() > MOST {
        let message = format!("there are {} standing rooms, of at most {MOST}", list.len());
        entry.faults.push(Fault::new(entry.key_place.clone(), message));
        return None;
    }
    let rooms = list.iter().filter_map(|room| Some(read_room(room, room.table(EXAMPLE)?)));
    Some(rooms.collect())
}

fn read_room(room: &Entry<'_, '_>, table: &DeTable<'_>) -> StandingRoom {
    let mut wish = in_mode(Mode::Roam);
    for entry in room.entries(table) {
        match entry.key {
            "mode" => wish.mode = mode(&entry).unwrap_or(wish.mode),
            "level" => {
                if let Some(level) = entry.string("level = \"museum\"") {
                    level.clone_into(&mut wish.level);
                }
            }
            "difficulty" => {
                wish.difficulty = Difficulty::read(&entry).unwrap_or(wish.difficulty);
            }
            _ => {
                let known = ["mode", "level", "difficulty"];
                entry.faults.push(entry.unknown_key("[[room]]", &known));
            }
        }
    }
    StandingRoom(wish)
}

fn mode(entry: &Entry<'_, '_>) -> Option<Mode> {
    const ALONE: &str =
        "a standing room can't be in the mode \"alone\": such a room ends with its player";
    let text = entry.string("mode = \"roam\"")?;
    let is_possible = |mode: &Mode| *mode != Mode::Alone;
    Mode::named(text).filter(is_possible).or_else(|| {
        let is_alone = text == Mode::Alone.name();
        let unknown = || format!("there is no mode {}", quoted(text));
        let message = if is_alone { ALONE.to_owned() } else { unknown() };
        let names: Vec<&str> = Mode::ALL.into_iter().filter(is_possible).map(Mode::name).collect();
        entry.reject(message, "", format!("write one of {}", names.join(", ")))
    })
}

fn in_mode(mode: Mode) -> RoomWish {
    RoomWish { level: "museum".to_owned(), mode, difficulty: Difficulty::default() }
}
