//! Checks that a level can be played as it is drawn: its guards fit, its secrets lead somewhere, and
//! its treasure is there.

use std::ops::Range;

use super::drawing::Drawing;
use super::legend::{Legend, Meaning};
use crate::fault::Fault;
use crate::world::{Cell, Grid, GuardPost, MovingTile, Thing, ThingKind, Tile, TileId, TileKind};

/// The tiles of a drawing, and which of them move.
pub(crate) struct Cells<'l> {
    pub(crate) grid: &'l Grid,
    pub(crate) tiles: &'l [Tile],
    pub(crate) moving: &'l [MovingTile],
}

impl Cells<'_> {
    /// The tile at a column and a row; `None` outside the map.
    pub(crate) fn tile(&self, column: i64, row: i64) -> Option<(TileId, Tile)> {
        let id = self.grid.tile(column, row)?;
        Some((id, self.tiles[usize::from(id.0)]))
    }

    /// Whether `id` is drawn for a tile that moves.
    pub(crate) fn moves(&self, id: TileId) -> bool {
        self.moving.iter().any(|moving| moving.states[0] == id)
    }
}

/// The faults of guards for whom the ceiling is too low.
pub(crate) fn cramped_guards(
    drawing: &Drawing<'_>,
    cells: &Cells<'_>,
    posts: &[GuardPost],
) -> Vec<Fault> {
    let cramped = posts.iter().filter_map(|post| {
        let (_, tile) = cells.tile(post.cell.column.into(), post.cell.row.into())?;
        let height = post.kind.height();
        let room = tile.gaps().next()?.height();
        let name = post.kind.name();
        let message = format!("the {name} has no room to stand here");
        (room < height).then(|| {
            Fault::new(drawing.place_of(post.cell), message)
                .label(format!("the ceiling is {room} above the floor here"))
                .help(format!("a {name} is {height} high: raise the ceiling, or draw it elsewhere"))
        })
    });
    cramped.collect()
}

/// The faults of secret walls with nothing behind them, one for each character.
pub(crate) fn blind_secrets(
    drawing: &Drawing<'_>,
    legend: &Legend<'_>,
    cells: &Cells<'_>,
) -> Vec<Fault> {
    let is_secret = |character| {
        let meaning = legend.symbols.get(&character).map(|symbol| &symbol.meaning);
        matches!(meaning, Some(Meaning::MovingWall(it)) if it.switch.is_none())
    };
    let blind = drawing.first_of_each(is_secret, |cell| ways_into(cells, cell) < 2);
    let faults = blind.into_iter().map(|(first, others)| {
        let fault = Fault::new(drawing.place_of(first), "there is nothing behind this secret wall")
            .help("draw open floor on two of its sides, one to come from and one to find");
        match others {
            0 => fault,
            others => fault.label(format!("and behind {others} more")),
        }
    });
    faults.collect()
}

/// The number of sides from which a player may enter the cell of a secret wall once it has sunk.
fn ways_into(cells: &Cells<'_>, cell: Cell) -> usize {
    let (column, row) = (i64::from(cell.column), i64::from(cell.row));
    let Some((_, secret)) = cells.tile(column, row) else { return 0 };
    let sides = [(column - 1, row), (column + 1, row), (column, row - 1), (column, row + 1)];
    let is_way = |&(column, row): &(i64, i64)| {
        cells.tile(column, row).is_some_and(|(id, tile)| match tile.kind {
            TileKind::Wall(_) | TileKind::Mirror(_) => {
                cells.moves(id) || tile.heights.floor() < secret.heights.floor()
            }
            TileKind::Mask(_) | TileKind::Glass(_) => false,
            _ => true,
        })
    };
    sides.iter().filter(|side| is_way(side)).count()
}

/// The fault that a map asks for more treasure than lies in it; `place` is where it asks.
pub(crate) fn missing_treasure(
    needed: u32,
    place: &Range<usize>,
    things: &[Thing],
) -> Option<Fault> {
    let worth = things.iter().map(|thing| match thing.kind {
        ThingKind::Treasure(worth) => u64::from(worth),
        _ => 0,
    });
    let total: u64 = worth.sum();
    (total < u64::from(needed)).then(|| {
        let message = "the exit asks for more treasure than lies in the map";
        Fault::new(place.clone(), message)
            .label(format!("treasure worth {total} is drawn"))
            .help("draw more, such as { treasure = 50 }, or ask for less")
    })
}
