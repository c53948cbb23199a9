//! Ways through a cell: the gaps that are high enough to duck in, at all heights to which the cell
//! moves.

use super::openers::Openers;
use crate::game::stance::DUCKING;
use crate::world::{Ceiling, Door, Driver, Gap, Tile, TileKind, World};

/// A gap of a cell, and the lowest height from which the player gets into it: its bottom, or where
/// a floor begins that carries the player up to it.
#[derive(Clone, Copy)]
pub(crate) struct Way {
    pub(crate) gap: Gap,
    pub(crate) least: f64,
}

/// The ways through a cell. A tile has two gaps, each at two ends where it moves. A shape may
/// divide one and leave a way beside it, and a thing may divide one more.
pub(crate) type Ways = [Option<Way>; 8];

/// The ways through each tile; through those that move, at all heights or at both ends.
pub(crate) fn of_tiles(world: &World, openers: &Openers) -> Vec<Ways> {
    let tiles = world.tiles().iter();
    let mut of_tiles: Vec<Ways> = tiles.map(|tile| high_enough(open_in(tile, openers))).collect();
    for moving in world.moving_tiles().iter().filter(|it| openers.can_move(it.driver)) {
        let mut states = moving.states.iter().map(|&state| world.tile(state));
        of_tiles[usize::from(moving.states[0].0)] = match moving.driver {
            Driver::Switch(_) => along(states),
            // They carry nobody up.
            Driver::Hand | Driver::Weight => {
                let ends = [states.next(), states.next_back()];
                let gaps = ends.iter().flatten().flat_map(|tile| open_in(tile, openers));
                high_enough(gaps.collect())
            }
        };
    }
    of_tiles
}

/// The ways through a tile that moves through `states`. A player who gets onto its floor at any
/// height is carried to both ends, but not through the ceiling.
fn along(states: impl Iterator<Item = Tile>) -> Ways {
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for tile in states {
        let gaps: Vec<Gap> = tile.gaps().collect();
        let is_inside =
            |index: usize| matches!(tile.ceiling, Ceiling::Covered(_)) && index + 1 < gaps.len();
        for (index, &gap) in gaps.iter().enumerate().filter(|(_, gap)| gap.height() >= DUCKING) {
            let side = if is_inside(index) { &mut below } else { &mut above };
            side.push(gap);
        }
    }
    let mut ways = Ways::default();
    let ends = [below, above].into_iter().flat_map(|gaps| {
        let by_height = |one: &&Gap, other: &&Gap| one.bottom.total_cmp(&other.bottom);
        let lowest = gaps.iter().min_by(by_height).copied();
        let highest = gaps.iter().max_by(by_height).copied();
        let ends = [lowest, highest].into_iter().flatten();
        let way = move |gap| Some(Way { gap, least: lowest?.bottom });
        ends.filter_map(way).collect::<Vec<_>>()
    });
    ways.iter_mut().zip(ends).for_each(|(way, end)| *way = Some(end));
    ways
}

/// The gaps of a tile for a player who has found `openers`.
pub(crate) fn open_in(tile: &Tile, openers: &Openers) -> Vec<Gap> {
    let gaps: Vec<Gap> = tile.gaps().collect();
    let standing = Gap { bottom: tile.heights.floor(), top: tile.top_of_what_stands() };
    match tile.kind {
        TileKind::Door(Door { key: Some(key), .. }) if !openers.keys.contains(&key) => {
            without(&gaps, standing)
        }
        TileKind::Door(Door { switch: Some(switch), .. })
            if !openers.switches.contains(&switch) =>
        {
            without(&gaps, standing)
        }
        TileKind::Mask(_) | TileKind::Glass(_) => without(&gaps, standing),
        // There may be a way beside it, and its top is a floor.
        TileKind::Shape(_) => [without(&gaps, standing), gaps].concat(),
        TileKind::Open
        | TileKind::Door(_)
        | TileKind::Doorway(_)
        | TileKind::Wall(_)
        | TileKind::Mirror(_) => gaps,
    }
}

/// The `gaps` that are high enough to duck in.
pub(crate) fn high_enough(gaps: Vec<Gap>) -> Ways {
    let mut left = Ways::default();
    let high = gaps.into_iter().filter(|gap| gap.height() >= DUCKING);
    let way = |gap: Gap| Way { gap, least: gap.bottom };
    left.iter_mut().zip(high).for_each(|(left, gap)| *left = Some(way(gap)));
    left
}

/// The parts of gaps below and above what fills a part of them.
pub(crate) fn without(gaps: &[Gap], filled: Gap) -> Vec<Gap> {
    let left = gaps.iter().flat_map(|&gap| {
        let is_apart = filled.top <= gap.bottom || gap.top <= filled.bottom;
        let below = Gap { top: filled.bottom, ..gap };
        let above = Gap { bottom: filled.top, ..gap };
        if is_apart { [Some(gap), None] } else { [Some(below), Some(above)] }
    });
    left.flatten().filter(|gap| gap.bottom < gap.top).collect()
}
