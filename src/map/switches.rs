//! Switches: the names that connect levers and plates with doors, walls and floors.
//!
//! A switch has no definition of its own. It exists where a lever or a plate sets it and something
//! is driven by it; a name with one of the two only is a fault. A table of switches was refused: it
//! would repeat names that the tiles and things give already.

use std::collections::BTreeSet;
use std::ops::Range;

use toml::de::DeTable;

use super::drawing::Drawing;
use super::items::ItemSymbol;
use super::legend::{Legend, Meaning, Symbol};
use crate::fault::document::Entry;
use crate::fault::{Fault, nearest, quoted};
use crate::sort;
use crate::world::SwitchId;

/// The largest number of levers.
const MOST_LEVERS: usize = 256;
/// The largest number of cells that switches move. One press may move all of them in a step.
const MOST_DRIVEN: usize = 512;

/// The name of a switch, and its place in the map.
#[derive(Clone)]
pub(crate) struct SwitchSymbol<'a> {
    pub(crate) name: &'a str,
    pub(crate) place: Range<usize>,
}

impl<'a> SwitchSymbol<'a> {
    /// Reads the name in `entry`; reports a fault where there is none. `example` is a whole entry.
    pub(crate) fn read(entry: &Entry<'a, '_>, example: &str) -> Option<Self> {
        let name = entry.string(example)?;
        let place = entry.value_place.clone();
        if name.is_empty() || name.contains(char::is_control) {
            let message = "a switch's name is some characters on one line";
            entry.faults.push(Fault::new(place, message).help(format!("write {example}")));
            return None;
        }
        Some(Self { name, place })
    }

    /// Reads the switch that `table`, the table of `owner`, names. `None` if it names none, or with
    /// a fault.
    pub(crate) fn of(owner: &Entry<'a, '_>, table: &'a DeTable<'_>, example: &str) -> Option<Self> {
        let entry = owner.entries(table).find(|entry| entry.key == "switch")?;
        Self::read(&entry, example)
    }
}

/// The names of the switches that drive something in the grid. A [`SwitchId`] is an index into
/// them.
pub(crate) struct Switches {
    names: Vec<String>,
}

impl Switches {
    /// Collects the switches of the tiles in the grid.
    pub(crate) fn of(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Self {
        let names: BTreeSet<&str> = sort::gathered(driven(drawing, legend).map(|it| it.name));
        Self { names: names.into_iter().map(str::to_owned).collect() }
    }

    /// The switch of that name, if it drives anything.
    pub(crate) fn id(&self, name: &str) -> Option<SwitchId> {
        let index = self.names.binary_search_by(|known| known.as_str().cmp(name)).ok()?;
        u8::try_from(index).ok().map(SwitchId)
    }

    pub(crate) fn into_names(self) -> Vec<String> {
        self.names
    }
}

/// The faults of switches that nothing sets, and of levers and plates that drive nothing.
pub(crate) fn faults(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Vec<Fault> {
    if !legend.is_clear() {
        return Vec::new();
    }
    let driven_names: BTreeSet<&str> = sort::gathered(driven(drawing, legend).map(|it| it.name));
    let setting_names: BTreeSet<&str> = sort::gathered(setting(drawing, legend).map(|it| it.name));
    let without_effect = setting(drawing, legend).filter(|it| !driven_names.contains(it.name));
    let without_driver = driven(drawing, legend).filter(|it| !setting_names.contains(it.name));
    let without_effect = without_effect.enumerate().map(|(index, switch)| {
        let message = format!("nothing in the grid moves with the switch {}", quoted(switch.name));
        let fault = Fault::new(switch.place.clone(), message).label("this does nothing");
        let example = "draw a door, a wall or a floor that moves with it";
        fault.help(nearest_switch(switch.name, &driven_names, index).unwrap_or_else(|| {
            format!("{example}, such as {{ door = \"metal\", switch = {} }}", quoted(switch.name))
        }))
    });
    let without_driver = without_driver.enumerate().map(|(index, switch)| {
        let message = format!("nothing in the grid sets the switch {}", quoted(switch.name));
        let fault = Fault::new(switch.place.clone(), message).label("this never moves");
        fault.help(nearest_switch(switch.name, &setting_names, index).unwrap_or_else(|| {
            format!(
                "under [things] write \"l\" = {{ lever = {} }}, and draw one l",
                quoted(switch.name)
            )
        }))
    });
    let too_many = [too_many_levers(drawing, legend), too_many_driven(drawing, legend)];
    too_many.into_iter().flatten().chain(without_effect).chain(without_driver).collect()
}

/// The fault of the levers after the first [`MOST_LEVERS`].
fn too_many_levers(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    let is_lever =
        |symbol: &Symbol<'_>| matches!(symbol.meaning, Meaning::Item(ItemSymbol::Lever(_)));
    let levers = legend.used_in(drawing).filter(|(_, symbol)| is_lever(symbol));
    let count: usize = levers.map(|(character, _)| drawing.sightings(character).count).sum();
    (count > MOST_LEVERS).then(|| {
        let message =
            format!("the grid has {count} levers, and {MOST_LEVERS} at most can be there");
        Fault::new(drawing.key_place.clone(), message).help("draw fewer of them")
    })
}

/// The fault of more than [`MOST_DRIVEN`] cells that switches move.
fn too_many_driven(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Option<Fault> {
    let driven = legend.used_in(drawing).filter_map(|(character, symbol)| {
        Some((driver_of(symbol)?.place.clone(), drawing.sightings(character).count))
    });
    let driven: Vec<_> = driven.collect();
    let count: usize = driven.iter().map(|(_, count)| count).sum();
    let (place, most) = driven.into_iter().max_by_key(|&(_, count)| count)?;
    (count > MOST_DRIVEN).then(|| {
        let message =
            format!("switches move {count} cells of the grid, and {MOST_DRIVEN} at most can move");
        Fault::new(place, message)
            .label(format!("{most} of them here"))
            .help("draw fewer of them, and plain floor or wall in their place")
    })
}

/// A help for the fault `index` that names the most similar of some switches; `None` where there is
/// none, or too many to compare in a moment.
fn nearest_switch(name: &str, known: &BTreeSet<&str>, index: usize) -> Option<String> {
    const MOST_COMPARED: usize = 32;
    const MOST_FAULTS: usize = 100;
    if known.len() > MOST_COMPARED || index >= MOST_FAULTS {
        return None;
    }
    let known: Vec<&str> = known.iter().copied().collect();
    nearest(name, &known).map(|near| format!("the nearest switch is {}", quoted(near)))
}

/// The switches of the tiles in the grid that move.
fn driven<'l, 'a>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'a>,
) -> impl Iterator<Item = &'l SwitchSymbol<'a>> {
    legend.used_in(drawing).filter_map(|(_, symbol)| driver_of(symbol))
}

/// The switch that moves a tile, if one does.
pub(crate) fn driver_of<'l, 'a>(symbol: &'l Symbol<'a>) -> Option<&'l SwitchSymbol<'a>> {
    match &symbol.meaning {
        Meaning::Door(door) => door.switch.as_ref(),
        Meaning::MovingWall(wall) => wall.switch.as_ref(),
        Meaning::Floor => symbol.surroundings.mechanism.switch.as_ref(),
        _ => None,
    }
}

/// The switches of the levers and plates in the grid.
fn setting<'l, 'a>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'a>,
) -> impl Iterator<Item = &'l SwitchSymbol<'a>> {
    legend.used_in(drawing).filter_map(|(_, symbol)| set_by(symbol))
}

/// The switch that a lever or a plate sets, if the symbol is one.
pub(crate) fn set_by<'l, 'a>(symbol: &'l Symbol<'a>) -> Option<&'l SwitchSymbol<'a>> {
    match &symbol.meaning {
        Meaning::Item(ItemSymbol::Lever(switch)) => Some(switch),
        Meaning::Floor => symbol.surroundings.mechanism.plate.as_ref(),
        _ => None,
    }
}
