//! The way from each cell of a level to its nearest exit, which orders racers before they finish.
//!
//! Doors count as open and moving tiles as passable, so a detour for a key or a lever does not count. A player
//! walks from cell to cell and climbs no higher than a jump. A higher floor that is not a wall may still be
//! reached by a lift or a flight, so that step counts as a detour.
//!
//! The map of a level is found once and shared by all its races: two bytes for each cell, and less than 0.1 s
//! for 500×500 cells. Rejected: the straight line to the exit. In a maze, the racer who is ahead may be the
//! farthest away. Rejected: a heap of cells in place of buckets. It took eight times as long.

use glam::DVec2;

use cellcaster::world::{Cell, ThingKind, TileId, TileKind, World};

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
        let tiles: Vec<TileWay> = (0..=u8::MAX)
            .map(TileId)
            .take(world.tiles().len())
            .map(|tile| TileWay::of(world, tile))
            .collect();
        let tile = |cell| tiles.get(usize::from(world.grid().tile_in(cell)?.0));
        let exits = world.things().iter().filter(|thing| thing.kind == ThingKind::Exit);
        // The cells to visit at each length, from the current one to the longest after one more step.
        let mut waiting = [const { Vec::new() }; DETOUR as usize + 1];
        waiting[0].extend(exits.map(|thing| thing.cell));
        let mut length = 0;
        while length < u16::MAX && waiting.iter().any(|cells| !cells.is_empty()) {
            let bucket = |length: u16| usize::from(length) % (usize::from(DETOUR) + 1);
            for cell in std::mem::take(&mut waiting[bucket(length)]) {
                let Some(index) = ways.index(cell).filter(|&it| ways.lengths[it] > length) else {
                    continue;
                };
                ways.lengths[index] = length;
                for before in cell.beside().filter(|&before| ways.length(before).is_none()) {
                    let cost = tile(before).zip(tile(cell)).and_then(|(from, to)| from.cost(to));
                    if let Some(cost) = cost {
                        waiting[bucket(length.saturating_add(cost))].push(before);
                    }
                }
            }
            length += 1;
        }
        ways
    }

    /// The length of the way from `position` to the nearest exit, in cells; `None` if there is no way.
    pub(crate) fn from(&self, position: DVec2) -> Option<f64> {
        let cell = Cell { column: position.x as u32, row: position.y as u32 };
        let length = self.length(cell)?;
        let next = cell.beside().find(|&next| self.length(next).is_some_and(|it| it + 1 == length));
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

/// The part of a tile that a way depends on.
struct TileWay {
    moves: bool,
    is_wall: bool,
    /// The height of the lowest floor on which a player can stand; `None` if there is none.
    floor: Option<f64>,
}

impl TileWay {
    fn of(world: &World, id: TileId) -> Self {
        let tile = world.tile(id);
        let is_closed = matches!(tile.kind, TileKind::Mask(_) | TileKind::Glass(_));
        let lowest = tile.gaps().find(|gap| gap.height() >= MIN_GAP).filter(|_| !is_closed);
        Self {
            moves: world.moving_tiles().iter().any(|moving| moving.states.contains(&id)),
            is_wall: matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_)),
            floor: lowest.map(|gap| gap.bottom),
        }
    }

    /// The cost of a step from this tile onto another; `None` if nobody can go there.
    fn cost(&self, to: &Self) -> Option<u16> {
        if self.moves || to.moves {
            return Some(1);
        }
        let (from, onto) = (self.floor?, to.floor?);
        match onto - from <= MAX_CLIMB {
            // Nobody gets onto a high wall.
            _ if self.is_wall && from > MAX_CLIMB => None,
            true => Some(1),
            false => (!to.is_wall).then_some(DETOUR),
        }
    }
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
