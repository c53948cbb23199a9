//! The shortest ways over the cells of a level to a goal.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

use cellcaster::game::Game;
use cellcaster::world::{Cell, ThingKind, TileEffect, World};
use glam::DVec2;

/// The height of a step that the player climbs by walking, and of a fall that does no harm, in
/// cells.
const STEP: f64 = 0.35;
const FALL: f64 = 2.2;
/// The player's height, standing and ducking.
const STANDING: f64 = 0.7;
const DUCKING: f64 = 0.5;
/// The cost of a neighbouring cell at a side and at a corner, and the surcharges of water, spikes
/// and doors.
const STRAIGHT: u32 = 10;
const DIAGONAL: u32 = 14;
const WATER: u32 = 30;
const SPIKES: u32 = 15;
const DOOR: u32 = 10;
/// The number of cells that the player looks ahead.
const AHEAD: usize = 6;
/// The room needed on each side of a straight line, in cells.
const ASIDE: f64 = 0.3;

/// The cost of the cheapest way from each cell to a goal.
#[derive(Clone, Debug)]
pub(crate) struct Ways {
    width: u32,
    costs: Vec<u32>,
}

impl Ways {
    /// The ways to `goal` in the present state of `game`. `dread` is the additional cost of a cell.
    pub(crate) fn new(game: &Game, goal: Cell, dread: impl Fn(Cell) -> u32) -> Self {
        let ground = Ground::new(game);
        Self::to_any(&ground, &[goal], dread)
    }

    /// The ways to the cells beside `goal`, at its height.
    pub(crate) fn beside(game: &Game, goal: Cell, dread: impl Fn(Cell) -> u32) -> Self {
        let ground = Ground::new(game);
        let sides = ground.around(goal).filter(|&(cell, length)| {
            length == STRAIGHT && ground.is_open(cell) && ground.world.door(cell).is_none()
        });
        let sides: Vec<Cell> = sides.map(|(cell, _)| cell).collect();
        Self::to_any(&ground, &sides, dread)
    }

    fn to_any(ground: &Ground, ends: &[Cell], dread: impl Fn(Cell) -> u32) -> Self {
        let (width, height) = (ground.world.grid().width(), ground.world.grid().height());
        let mut ways = Self { width, costs: vec![u32::MAX; (width * height) as usize] };
        let mut waiting: BinaryHeap<_> = ends.iter().map(|&cell| (Reverse(0), cell)).collect();
        for end in ends {
            ways.costs[(end.row * width + end.column) as usize] = 0;
        }
        while let Some((Reverse(cost), cell)) = waiting.pop() {
            if cost > ways.cost(cell) {
                continue;
            }
            for (from, length) in ground.around(cell).filter(|&(from, _)| ground.leads(from, cell))
            {
                let cost = cost + length + ground.toll(cell) + dread(cell);
                if cost < ways.cost(from) {
                    ways.costs[(from.row * width + from.column) as usize] = cost;
                    waiting.push((Reverse(cost), from));
                }
            }
        }
        ways
    }

    /// The cost from `cell`, in tenths of a cell; `u32::MAX` if no way leads to the goal.
    pub(crate) fn cost(&self, cell: Cell) -> u32 {
        let index = (cell.row * self.width + cell.column) as usize;
        self.costs.get(index).copied().unwrap_or(u32::MAX)
    }

    /// The point to walk to from `position`, and whether the player has to duck.
    pub(crate) fn target(&self, game: &Game, position: DVec2) -> (DVec2, bool) {
        let ground = Ground::new(game);
        let mut path = vec![cell_of(position)];
        while path.len() <= AHEAD {
            let Some(next) = self.next(&ground, path[path.len() - 1]) else { break };
            path.push(next);
        }
        let is_low = path.iter().take(3).any(|&cell| ground.room(cell) < STANDING);
        let is_straight = |&&cell: &&Cell| ground.is_straight(position, cell.center(), &path);
        let farthest = path.iter().skip(2).rev().find(is_straight);
        let target = farthest.or(path.get(1)).unwrap_or(&path[0]);
        (target.center(), is_low)
    }

    fn next(&self, ground: &Ground, cell: Cell) -> Option<Cell> {
        let around = ground.around(cell).filter(|&(to, _)| ground.leads(cell, to));
        let costed = around.filter(|&(to, _)| self.cost(to) < self.cost(cell));
        costed.min_by_key(|&(to, length)| self.cost(to).saturating_add(length)).map(|(to, _)| to)
    }
}

/// The cells as the player can walk on them.
struct Ground<'a> {
    world: &'a World,
    keys: BTreeSet<&'a str>,
}

impl<'a> Ground<'a> {
    fn new(game: &'a Game) -> Self {
        Self { world: game.world(), keys: game.keys().collect() }
    }

    /// The cells around `cell`, each with its distance.
    fn around(&self, cell: Cell) -> impl Iterator<Item = (Cell, u32)> {
        let (width, height) = (self.world.grid().width(), self.world.grid().height());
        let sides = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
        sides.into_iter().filter_map(move |(east, south): (i32, i32)| {
            let column = cell.column.checked_add_signed(east).filter(|&column| column < width)?;
            let row = cell.row.checked_add_signed(south).filter(|&row| row < height)?;
            let length = if east != 0 && south != 0 { DIAGONAL } else { STRAIGHT };
            Some((Cell { column, row }, length))
        })
    }

    /// Returns whether the player can walk from a cell to its neighbour.
    fn leads(&self, from: Cell, to: Cell) -> bool {
        let corners =
            [Cell { column: from.column, row: to.row }, Cell { column: to.column, row: from.row }];
        let is_side = from.column == to.column || from.row == to.row;
        let is_level = |&cell: &Cell| {
            self.is_open(cell)
                && self.world.door(cell).is_none()
                && self.floor(cell) == self.floor(from)
                && self.floor(cell) == self.floor(to)
        };
        let rise = self.floor(to) - self.floor(from);
        let has_headroom = self.floor(from) + DUCKING <= self.world.room_in(to).ceiling()
            && self.floor(to) + DUCKING <= self.world.room_in(from).ceiling();
        self.is_open(from)
            && self.is_open(to)
            && has_headroom
            && (-FALL..=STEP).contains(&rise)
            && (is_side || corners.iter().all(is_level))
    }

    fn is_open(&self, cell: Cell) -> bool {
        let (column, row) = (i64::from(cell.column), i64::from(cell.row));
        let grid = self.world.grid();
        if let Some(door) = self.world.door(cell) {
            return door.key.is_none_or(|key| self.keys.contains(self.world.key_name(key)));
        }
        !grid.is_solid(column, row) && !grid.is_occupied(column, row) && self.room(cell) >= DUCKING
    }

    fn floor(&self, cell: Cell) -> f64 {
        self.world.floor_at(cell)
    }

    fn room(&self, cell: Cell) -> f64 {
        let heights = self.world.room_in(cell);
        heights.ceiling() - heights.floor()
    }

    fn toll(&self, cell: Cell) -> u32 {
        let is_spiked = self
            .world
            .things_in(cell)
            .iter()
            .any(|thing| matches!(thing.kind, ThingKind::Spikes(_)));
        let is_wet = self.world.effect_in(cell) == Some(TileEffect::Water);
        let is_door = self.world.door(cell).is_some();
        u32::from(is_spiked) * SPIKES + u32::from(is_wet) * WATER + u32::from(is_door) * DOOR
    }

    /// Returns whether the player can walk straight between two points, over level floor or the
    /// cells of the path.
    fn is_straight(&self, from: DVec2, to: DVec2, path: &[Cell]) -> bool {
        let along = to - from;
        let aside = along.perp().normalize_or_zero() * ASIDE;
        let count = (along.length() / 0.2).ceil();
        let floor = self.floor(cell_of(from));
        let is_fine = |point: DVec2| {
            let cell = cell_of(point);
            let is_plain = self.is_open(cell)
                && self.floor(cell) == floor
                && self.world.door(cell).is_none()
                && self.toll(cell) == 0;
            is_plain || path.contains(&cell) && self.floor(cell) == floor && self.is_open(cell)
        };
        (0..=count as u32).all(|index| {
            let middle = from + along * (f64::from(index) / count.max(1.0));
            [-aside, DVec2::ZERO, aside].into_iter().all(|aside| is_fine(middle + aside))
        })
    }
}

fn cell_of(point: DVec2) -> Cell {
    Cell { column: point.x as u32, row: point.y as u32 }
}
