//! The way from each cell of a level to its nearest exit, which orders racers before they finish.
//!
//! Doors count as open and moving tiles as passable, so a detour for a key or a lever does not count. A player
//! walks from cell to cell and climbs no higher than a jump. A higher floor that is not a wall may still be
//! reached by a lift or a flight, so that step counts as a detour.
//!
//! The map of a level is found once and shared by all its races: two bytes for each cell, and about 10 ms for
//! the largest map of a host. Rejected: the straight line to the exit. In a maze, the racer who is ahead may
//! be the farthest away.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use cellcaster::world::{Cell, ThingKind, Tile, TileKind, World};

/// The height that a player can jump onto, in cells.
const MAX_CLIMB: f64 = 0.66;
/// The lowest gap that a player fits in, in cells.
const MIN_GAP: f64 = 0.5;
/// The cost of a step up a higher floor, in cells.
const DETOUR: u16 = 8;

/// The length of the way from each cell to the nearest exit, in cells.
#[derive(Debug)]
pub(crate) struct ExitWays {
    columns: u32,
    /// Row by row; `u16::MAX` in cells from which no way leads to an exit.
    lengths: Box<[u16]>,
}

impl ExitWays {
    pub(crate) fn of(world: &World) -> Self {
        let (columns, rows) = (world.grid().width(), world.grid().height());
        let count = columns as usize * rows as usize;
        let mut ways = Self { columns, lengths: vec![u16::MAX; count].into() };
        let exits = world.things().iter().filter(|thing| thing.kind == ThingKind::Exit);
        let mut waiting: BinaryHeap<_> =
            exits.map(|thing| Reverse((0, thing.cell.row, thing.cell.column))).collect();
        while let Some(Reverse((length, row, column))) = waiting.pop() {
            let cell = Cell { column, row };
            let Some(known) = ways.index(cell).map(|index| &mut ways.lengths[index]) else {
                continue;
            };
            if *known <= length {
                continue;
            }
            *known = length;
            for before in beside(cell) {
                if ways.length(before).is_none()
                    && let Some(cost) = cost(world, before, cell)
                {
                    waiting.push(Reverse((length.saturating_add(cost), before.row, before.column)));
                }
            }
        }
        ways
    }

    /// The length of the way from `position` to the nearest exit, in cells; `None` if there is no way.
    pub(crate) fn from(&self, position: DVec2) -> Option<f64> {
        let cell = Cell { column: position.x as u32, row: position.y as u32 };
        let length = self.length(cell)?;
        let next = beside(cell).find(|&next| self.length(next).is_some_and(|it| it + 1 == length));
        let ahead =
            next.map_or(0.0, |next| (next.center() - cell.center()).dot(position - cell.center()));
        Some(f64::from(length) - ahead)
    }

    fn length(&self, cell: Cell) -> Option<u16> {
        let length = self.lengths[self.index(cell)?];
        (length < u16::MAX).then_some(length)
    }

    fn index(&self, Cell { column, row }: Cell) -> Option<usize> {
        let index = row as usize * self.columns as usize + column as usize;
        (column < self.columns && index < self.lengths.len()).then_some(index)
    }
}

/// The cost of a step from one cell to the next; `None` if nobody can go there.
fn cost(world: &World, from: Cell, to: Cell) -> Option<u16> {
    let [from, to] = [from, to].map(|cell| world.grid().tile_in(cell));
    let moves = |tile| world.moving_tiles().iter().any(|moving| moving.states.contains(&tile));
    if from.is_some_and(moves) || moves(to?) {
        return Some(1);
    }
    let [from, to] = [world.tile(from?), world.tile(to?)];
    let floor = |tile: &Tile| Some(tile.gaps().find(|gap| gap.height() >= MIN_GAP)?.bottom);
    let is_high_wall =
        matches!(from.kind, TileKind::Wall(_) | TileKind::Mirror(_)) && floor(&from)? > MAX_CLIMB;
    let climb = floor(&to)? - floor(&from)?;
    match to.kind {
        _ if is_high_wall => None,
        TileKind::Mask(_) | TileKind::Glass(_) => None,
        _ if climb <= MAX_CLIMB => Some(1),
        TileKind::Wall(_) | TileKind::Mirror(_) => None,
        TileKind::Open | TileKind::Doorway(_) | TileKind::Door(_) | TileKind::Shape(_) => {
            Some(DETOUR)
        }
    }
}

fn beside(Cell { column, row }: Cell) -> impl Iterator<Item = Cell> {
    [(-1, 0), (1, 0), (0, -1), (0, 1)].into_iter().filter_map(move |(columns, rows)| {
        let column = column.checked_add_signed(columns)?;
        Some(Cell { column, row: row.checked_add_signed(rows)? })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map::{self, builtin};

    fn level(grid: &str) -> World {
        let text = format!(
            "grid = '''\n{grid}\n'''\n[tiles]\n'#' = {{ wall = '#808080' }}\n'+' = {{ door = 'oak' }}\n\
             '1' = {{ floor_height = 0.5 }}\n'2' = {{ floor_height = 1.5, ceiling_height = 3 }}\n[things]\n'@'.start = 0\nX.exit = true\n"
        );
        map::parse(&text, "it", &map::NoFiles).unwrap_or_else(|faults| panic!("{faults}"))
    }

    #[test]
    fn a_way_goes_around_walls_and_through_doors() {
        let world = level("#######\n#@#X..#\n#.###+#\n#.....#\n#######");
        let ways = ExitWays::of(&world);
        let from = |x, y| ways.from(DVec2::new(x, y));
        assert_eq!(from(3.5, 1.5), Some(0.0));
        assert_eq!(from(1.5, 1.5), Some(10.0));
        assert_eq!(from(1.5, 1.75), Some(9.75), "the way leads south");
        assert_eq!(from(5.5, 2.5), Some(3.0));
        assert_eq!(from(0.5, 0.5), None, "in a wall");
        assert_eq!(from(-3.0, 900.0), None);
    }

    #[test]
    fn a_way_climbs_steps_and_avoids_ledges() {
        let climbs = ExitWays::of(&level("#####\n#@1X#\n#####"));
        assert_eq!(climbs.from(DVec2::new(1.5, 1.5)), Some(2.0));
        let detour = ExitWays::of(&level("######\n#@2.X#\n#....#\n######"));
        assert_eq!(detour.from(DVec2::new(1.5, 1.5)), Some(5.0), "around the ledge");
        assert_eq!(detour.from(DVec2::new(2.5, 1.5)), Some(2.0), "down from it");
    }

    #[test]
    fn every_start_has_a_way_to_the_exit() {
        let worlds =
            builtin::LEVELS.iter().filter_map(|level| Some((level.name, level.world().ok()?)));
        for (name, world) in worlds.filter(|(_, world)| world.has_exit()) {
            let way = ExitWays::of(&world).from(world.start().cell.center());
            assert!(way.is_some_and(|way| way >= 1.0), "{name}: {way:?}");
        }
    }
}
