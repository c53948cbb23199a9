//! Supports: the floor that things stand on, the map's own or that of a tile that they name.

use std::collections::BTreeSet;

use super::drawing::Drawing;
use super::heights::LEAST_HEADROOM;
use super::legend::{Legend, Meaning, Support};
use crate::fault::Fault;
use crate::sort;
use crate::world::{Cell, Grid, Sprite, Start, Thing, Tile};

/// The faults of things whose support is not open floor.
pub(crate) fn faults(drawing: &Drawing<'_>, legend: &Legend<'_>) -> Vec<Fault> {
    let wrong = of(drawing, legend).filter_map(|(_, support)| {
        let tile = legend.symbols.get(&support.tile).map(|symbol| &symbol.meaning);
        let is_fine = matches!(tile, Some(Meaning::Open | Meaning::Floor | Meaning::Unclear))
            || tile.is_none() && !legend.is_complete;
        let message = format!("a thing stands on open floor, and {:?} is none", support.tile);
        let help = "write the character of a tile that has no wall, door, mask or glass";
        (!is_fine).then(|| Fault::new(support.place.clone(), message).help(help))
    });
    wrong.collect()
}

/// The things in the drawing that name a support.
pub(crate) fn of<'l>(
    drawing: &'l Drawing<'_>,
    legend: &'l Legend<'_>,
) -> impl Iterator<Item = (char, &'l Support)> {
    drawing.characters().filter_map(|(character, _)| {
        let support = legend.symbols.get(&character)?.support.as_ref()?;
        Some((character, support))
    })
}

/// The cells of things that block, but leave room above them to jump over.
pub(crate) fn low_things(
    grid: &Grid,
    tiles: &[Tile],
    sprites: &[Sprite],
    things: &[Thing],
) -> BTreeSet<Cell> {
    /// The height of a player who ducks, in cells.
    const DUCKING: f64 = 0.5;
    let is_low = |thing: &&Thing| {
        let (column, row) = (i64::from(thing.cell.column), i64::from(thing.cell.row));
        let (Some(sprite), Some(id)) =
            (sprites.get(usize::from(thing.sprite.0)), grid.tile(column, row))
        else {
            return false;
        };
        let tile = &tiles[usize::from(id.0)];
        let top = sprite.base(tile.heights) + sprite.height.cells();
        let has_room = tile.gaps().any(|gap| gap.holds(top) && gap.top - top >= DUCKING);
        sprite.blocks && has_room
    };
    sort::gathered(things.iter().filter(is_low).map(|thing| thing.cell))
}

/// The fault that the player has no room to stand at the start.
pub(crate) fn low_start(
    drawing: &Drawing<'_>,
    grid: &Grid,
    tiles: &[Tile],
    start: Start,
) -> Option<Fault> {
    let tile = grid.tile(start.cell.column.into(), start.cell.row.into())?;
    let room = tiles[usize::from(tile.0)].gaps().next()?.height();
    let message = "the player has no room to stand where they start";
    (room < LEAST_HEADROOM).then(|| {
        Fault::new(drawing.place_of(start.cell), message)
            .label(format!("the ceiling is {room} above the floor here"))
            .help(format!("the player starts where it is {LEAST_HEADROOM} or more"))
    })
}
