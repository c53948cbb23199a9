//! Doors and keys: reads their definitions, and checks that the grid lets them work.
//!
//! A door slides into a wall, so it stands between two walls, with open floor before and behind it.
//! The key of a locked door must be reachable without opening that door.

mod reach;

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::DeTable;

use super::checks::Cells;
use super::drawing::Drawing;
use super::legend::{Legend, Meaning};
use super::switches::{self, SwitchSymbol};
use super::textures::Surface;
use crate::fault::document::Entry;
use crate::fault::{Fault, quoted};
use crate::sort;
use crate::world::{Cell, Grid, KeyId, Start, Tile, TileId, TileKind};
use reach::{Opener, Openers, Reach};

/// A door as the legend defines it.
pub(crate) struct DoorSymbol<'a> {
    pub(crate) leaf: Surface<'a>,
    pub(crate) key: Option<KeySymbol<'a>>,
    pub(crate) switch: Option<SwitchSymbol<'a>>,
}

/// The name of a key, and its place in the map.
#[derive(Clone)]
pub(crate) struct KeySymbol<'a> {
    pub(crate) name: &'a str,
    place: Range<usize>,
}

impl<'a> DoorSymbol<'a> {
    /// Reads the door in `entry` of `table`, with the key or the switch that the table names.
    pub(crate) fn read(entry: &Entry<'a, '_>, table: &'a DeTable<'_>) -> Option<Self> {
        let leaf = Surface::read(entry, r#"{ door = "oak" }"#);
        let key = entry.entries(table).find(|entry| entry.key == "key");
        let key = match key {
            None => None,
            Some(key) => Some(KeySymbol::read(&key, r#"{ door = "metal", key = "brass" }"#)?),
        };
        let switch = entry.entries(table).find(|entry| entry.key == "switch");
        let switch = match (switch, &key) {
            (None, _) => None,
            (Some(switch), None) => {
                Some(SwitchSymbol::read(&switch, r#"{ door = "metal", switch = "gate" }"#)?)
            }
            (Some(switch), Some(_)) => {
                let message = "a door opens with a key or a switch, not both";
                let fault = Fault::new(switch.key_place, message).label("this door has a key");
                entry.faults.push(fault.help("keep one of the two"));
                return None;
            }
        };
        Some(Self { leaf: leaf?, key, switch })
    }
}

impl<'a> DoorSymbol<'a> {
    /// What opens it, if not the player alone.
    fn opener(&self) -> Option<Opener<'a>> {
        let switch = self.switch.as_ref().map(|switch| Opener::Switch(switch.name));
        self.key.as_ref().map(|key| Opener::Key(key.name)).or(switch)
    }
}

impl<'a> KeySymbol<'a> {
    /// Reads the name in `entry`.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        let name = entry.string(example)?;
        let place = entry.value_place.clone();
        if name.is_empty() || name.contains(char::is_control) {
            let message = "a key's name is some characters on one line";
            entry.faults.push(Fault::new(place, message).help(format!("write {example}")));
            return None;
        }
        Some(Self { name, place })
    }
}

/// The names of the keys that doors in the grid need. A [`KeyId`] is an index into them.
pub(crate) struct Keys {
    names: Vec<String>,
}

impl Keys {
    /// Collects the keys of the doors in the grid. There are at most as many as kinds of tile.
    pub(crate) fn of(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Self {
        let doors = locked_doors(drawing, legend);
        let names: BTreeSet<&str> = sort::gathered(doors.map(|(_, key)| key.name));
        Self { names: names.into_iter().map(str::to_owned).collect() }
    }

    /// The key of that name, if a door needs it.
    pub(crate) fn id(&self, name: &str) -> Option<KeyId> {
        let index = self.names.iter().position(|known| known == name)?;
        u8::try_from(index).ok().map(KeyId)
    }

    pub(crate) fn into_names(self) -> Vec<String> {
        self.names
    }
}

/// All faults of doors and keys in a drawing whose cells are those of `grid`.
pub(crate) fn faults(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    cells: &Cells<'_>,
    start: Start,
    low_things: &BTreeSet<Cell>,
) -> Vec<Fault> {
    let mut faults = misplaced(drawing, legend, cells);
    // Behind a misplaced door, reachability means nothing.
    if faults.is_empty() {
        faults = keys_out_of_reach(drawing, legend, cells.grid, start, low_things);
    }
    faults.extend(useless_keys(drawing, legend));
    faults
}

/// The characters in the grid that are locked doors, with their keys.
fn locked_doors<'l, 'a>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'a>,
) -> impl Iterator<Item = (char, &'l KeySymbol<'a>)> {
    drawing.characters().filter_map(|(character, _)| {
        match &legend.symbols.get(&character)?.meaning {
            Meaning::Door(DoorSymbol { key: Some(key), .. }) => Some((character, key)),
            _ => None,
        }
    })
}

/// The characters in the grid that are keys, with their names.
fn drawn_keys<'l, 'a>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'a>,
) -> impl Iterator<Item = (char, &'l KeySymbol<'a>)> {
    drawing.characters().filter_map(|(character, _)| {
        match &legend.symbols.get(&character)?.meaning {
            Meaning::Key(key) => Some((character, key)),
            _ => None,
        }
    })
}

/// The faults of doors that cannot slide or lead nowhere, one for each character.
fn misplaced(drawing: &Drawing<'_>, legend: &Legend<'_>, cells: &Cells<'_>) -> Vec<Fault> {
    let is_door = |character| {
        let meaning = legend.symbols.get(&character).map(|symbol| &symbol.meaning);
        matches!(meaning, Some(Meaning::Door(_)))
    };
    let misplaced = drawing.first_of_each(is_door, |cell| !is_between_jambs(cells, cell));
    let faults = misplaced.into_iter().map(|(first, others)| {
        let message = "a door stands between two walls, with open floor before and behind it";
        let fault = Fault::new(drawing.place_of(first), message)
            .help("draw it in a gap of a wall, such as \"#+#\", or use { wall = … }");
        match others {
            0 => fault.label("this one does not"),
            others => fault.label(format!("this one does not, and {others} more")),
        }
    });
    faults.collect()
}

/// Whether exactly one pair of opposite neighbours of `cell` can hold a door, and the other pair is
/// open floor.
fn is_between_jambs(cells: &Cells<'_>, cell: Cell) -> bool {
    use TileKind::{Glass, Mask, Mirror, Open, Wall};

    let (column, row) = (i64::from(cell.column), i64::from(cell.row));
    let kinds = |places: [(i64, i64); 2]| places.map(|(column, row)| cells.tile(column, row));
    let pairs = [
        kinds([(column - 1, row), (column + 1, row)]),
        kinds([(column, row - 1), (column, row + 1)]),
    ];
    // A wall that sinks would leave the door without its jamb.
    let holds = |tile: Option<(TileId, Tile)>| {
        tile.is_some_and(|(id, tile)| {
            matches!(tile.kind, Wall(_) | Mask(_) | Glass(_) | Mirror(_)) && !cells.moves(id)
        })
    };
    let is_open =
        |tile: Option<(TileId, Tile)>| tile.is_some_and(|(_, tile)| matches!(tile.kind, Open));
    let [one, other] = pairs;
    one.into_iter().all(holds) && other.into_iter().all(is_open)
        || one.into_iter().all(is_open) && other.into_iter().all(holds)
}

/// The faults of keys that no door in the grid needs.
fn useless_keys(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Vec<Fault> {
    let asked: BTreeSet<&str> =
        sort::gathered(locked_doors(drawing, legend).map(|(_, key)| key.name));
    let useless = drawn_keys(drawing, legend).filter(|(_, key)| !asked.contains(key.name));
    useless
        .map(|(_, key)| {
            let name = quoted(key.name);
            Fault::new(key.place.clone(), format!("no door in the grid asks for the key {name}"))
                .help(format!(
                    "draw a door {{ door = \"oak\", key = {name} }}, or leave the key out"
                ))
        })
        .collect()
}

/// The faults of doors whose key the player cannot reach.
fn keys_out_of_reach(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    grid: &Grid,
    start: Start,
    low_things: &BTreeSet<Cell>,
) -> Vec<Fault> {
    if locked_doors(drawing, legend).next().is_none() {
        return Vec::new();
    }
    let mut reach = Reach::new(grid);
    let mut openers = Openers::default();
    let mut given = BTreeSet::new();
    for &cell in low_things {
        reach.passable.replace(cell, true);
    }
    let has_guards = legend.used_in(drawing).any(|(_, it)| matches!(it.meaning, Meaning::Guard(_)));
    for (cell, symbol) in legend.of_cells(drawing) {
        match &symbol.meaning {
            Meaning::Door(door) => {
                reach.passable.replace(cell, true);
                reach.locks.replace(cell, door.opener().map(|opener| openers.id(opener)));
            }
            Meaning::Shape(_) | Meaning::MovingWall(_) => _ = reach.passable.replace(cell, true),
            Meaning::Key(key) => {
                reach.found.replace(cell, Some(openers.id(Opener::Key(key.name))));
            }
            meaning => {
                let Some(switch) = switches::set_by(symbol) else { continue };
                let opener = openers.id(Opener::Switch(switch.name));
                if matches!(meaning, Meaning::Item(_)) {
                    for it in cells_around(cell) {
                        reach.levers.entry(it).or_default().push(opener);
                    }
                } else {
                    reach.found.replace(cell, Some(opener));
                    given.extend(has_guards.then_some(opener));
                }
            }
        }
    }
    let taken = reach.openers_from(start.cell, given);
    let is_taken = |key: &KeySymbol<'_>| {
        openers.known(Opener::Key(key.name)).is_some_and(|key| taken.contains(&key))
    };
    let missing = locked_doors(drawing, legend).filter(|(_, key)| !is_taken(key));
    missing
        .map(|(_, key)| {
            let name = quoted(key.name);
            let is_drawn = drawn_keys(drawing, legend).any(|(_, drawn)| drawn.name == key.name);
            let place = key.place.clone();
            if is_drawn {
                let message = format!("the key {name} cannot be reached from the start");
                Fault::new(place, message)
                    .label("nobody can open this door")
                    .help("put the key where one gets without opening the doors that ask for it")
            } else {
                Fault::new(place, format!("there is no key {name} in the grid"))
                    .label("nobody can open this door")
                    .help(format!(
                        "under [things] write \"k\" = {{ key = {name} }}, and draw one k"
                    ))
            }
        })
        .collect()
}

/// The cell and its eight neighbours, from which a player can reach a lever in it.
fn cells_around(cell: Cell) -> Vec<Cell> {
    let beside = |place: u32| place.saturating_sub(1)..=place.saturating_add(1);
    let rows = beside(cell.row);
    rows.flat_map(|row| beside(cell.column).map(move |column| Cell { column, row })).collect()
}
