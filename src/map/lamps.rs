//! Lamps: which cells they shine into.
//!
//! A cell is lit where a straight line leads from the middle of the lamp's cell to the middle of that
//! one through nothing but open floor and what can be seen through; doors count as closed.

use crate::cast::{Ray, Walk};
use crate::world::{Cell, Grid, Lamp, Lamplight, Light, Sprite, Thing, Tile, TileKind};

/// What the lamps among `things` add to the light of each cell: nothing where all is fully lit.
pub(crate) fn lamplight(
    grid: &Grid,
    tiles: &[Tile],
    sprites: &[Sprite],
    things: &[Thing],
) -> Lamplight {
    let lamp = |thing: &Thing| Some((thing.cell, sprites[usize::from(thing.sprite.0)].lamp?));
    let mut lamps = things.iter().filter_map(lamp).peekable();
    let is_dim = |tile: &Tile| tile.light.is_some_and(|light| light != Light::FULL);
    if lamps.peek().is_none() || !tiles.iter().any(is_dim) {
        return Lamplight::default();
    }
    let mut lamplight = grid.lamplight();
    for (place, lamp) in lamps {
        for (cell, distance) in around(grid, place, lamp) {
            if shines_into(grid, tiles, place, cell) {
                lamplight.add(cell, lamp.light_at(distance));
            }
        }
    }
    lamplight
}

/// The cells that a lamp reaches, and how far they are.
fn around(grid: &Grid, place: Cell, lamp: Lamp) -> impl Iterator<Item = (Cell, f64)> {
    let reach = lamp.reach.cells() as u32;
    let along = |index: u32, count: u32| {
        index.saturating_sub(reach)..=(index.saturating_add(reach)).min(count - 1)
    };
    let columns = along(place.column, grid.width());
    let cells = along(place.row, grid.height())
        .flat_map(move |row| columns.clone().map(move |column| Cell { column, row }));
    cells
        .map(move |cell| (cell, cell.center().distance(place.center())))
        .filter(move |&(_, distance)| distance < lamp.reach.cells())
}

/// Whether the light of a lamp in `place` gets to `cell`.
fn shines_into(grid: &Grid, tiles: &[Tile], place: Cell, cell: Cell) -> bool {
    let Ok(ray) = Ray::new(place.center(), cell.center() - place.center()) else {
        return place == cell;
    };
    let lets_through = |kind: TileKind| {
        matches!(
            kind,
            TileKind::Open | TileKind::Doorway(_) | TileKind::Mask(_) | TileKind::Glass(_)
        )
    };
    Walk::new(grid, &ray)
        .take_while(|crossing| lets_through(tiles[usize::from(crossing.tile.0)].kind))
        .any(|crossing| crossing.cell == cell)
}
