//! The guards of a floor, and where they walk.

use super::GUARD_DISTANCE;
use super::ground::Ground;
use super::items::{Items, apart};
use crate::rng::SplitMix64;
use crate::sort;
use crate::world::{Cell, Difficulty, Duty, GuardKind, GuardPost, Heading};

/// The guards on the first floor at the least difficulty, and on the deepest ones.
const FEWEST: u32 = 2;
const MOST: u32 = 12;
/// Reachable cells for each guard, at least.
const CELLS_EACH: usize = 24;
/// The distance of two guards along the grid, if there is room.
const APART: u32 = 6;
/// The cells that are compared for the place of a guard.
const PLACES: usize = 16;
/// The longest way between two waypoints, and the shortest, in steps.
const LEG: std::ops::RangeInclusive<u32> = 5..=14;
/// The kinds in the order of the floors on which they come first.
const KINDS: [GuardKind; 5] = [
    GuardKind::Warden,
    GuardKind::Listener,
    GuardKind::Hound,
    GuardKind::Lantern,
    GuardKind::Archer,
];

/// Places the guards of a floor, in reading order.
pub(crate) fn place(
    floor: u32,
    ground: &Ground,
    items: &Items,
    random: &mut SplitMix64,
) -> Vec<GuardPost> {
    let start = ground.start();
    let is_far = |cell: Cell| {
        let (columns, rows) = (cell.column.abs_diff(start.column), cell.row.abs_diff(start.row));
        columns * columns + rows * rows >= GUARD_DISTANCE * GUARD_DISTANCE
    };
    let is_free = |&&cell: &&Cell| {
        ground.is_bare(cell) && is_far(cell) && !items.is_in(cell) && !ground.sees(start, cell)
    };
    let free: Vec<Cell> = ground.reachable().iter().filter(is_free).copied().collect();
    let mut posts: Vec<GuardPost> = Vec::new();
    for (number, from) in from_difficulties(floor, ground).enumerate() {
        let Some(cell) = place_for(&posts, &free, random) else { break };
        let kind = kind(floor, number, random);
        let duty = duty(kind, cell, ground, random);
        let heading = heading(&duty, cell, random);
        posts.push(GuardPost { kind, cell, heading, duty, from });
    }
    sort::by_key(&mut posts, |post| (post.cell.row, post.cell.column));
    posts
}

/// The difficulty from which on each guard is there.
fn from_difficulties(floor: u32, ground: &Ground) -> impl Iterator<Item = Difficulty> {
    let room = ground.reachable().len() / CELLS_EACH;
    let wanted = (FEWEST + floor / 2).min(MOST) as usize;
    let easy = wanted.min(room.max(1));
    let more = easy.div_ceil(2);
    let counts = [(Difficulty::Easy, easy), (Difficulty::Normal, more), (Difficulty::Hard, more)];
    counts.into_iter().flat_map(|(from, count)| (0..count).map(move |_| from))
}

/// The best of some random cells: the farthest from other guards.
fn place_for(posts: &[GuardPost], free: &[Cell], random: &mut SplitMix64) -> Option<Cell> {
    let places: Vec<Cell> =
        (0..PLACES).filter_map(|_| free.get(random.below(free.len())).copied()).collect();
    let nearest = |cell: Cell| posts.iter().map(|post| apart(post.cell, cell)).min();
    let places = places.into_iter().filter(|&cell| nearest(cell) != Some(0));
    places.max_by_key(|&cell| nearest(cell).unwrap_or(APART).min(APART))
}

/// The kind of a guard. The first guard is of the kind that is new on the floor.
fn kind(floor: u32, number: usize, random: &mut SplitMix64) -> GuardKind {
    let known = (floor as usize).min(KINDS.len());
    let any = random.below(known);
    KINDS[if number == 0 && floor as usize <= KINDS.len() { known - 1 } else { any }]
}

fn duty(kind: GuardKind, cell: Cell, ground: &Ground, random: &mut SplitMix64) -> Duty {
    let sleeps = kind == GuardKind::Hound && random.one_in(2);
    match random.below(8) {
        _ if sleeps => Duty::Sleep,
        0 => Duty::Stand,
        1..=2 => Duty::Wander(6),
        _ => match patrol(cell, ground, random) {
            cells if cells.len() < 2 => Duty::Wander(4),
            cells => Duty::Patrol(cells),
        },
    }
}

/// A round of up to four waypoints on open floor, the last of which is `post`.
fn patrol(post: Cell, ground: &Ground, random: &mut SplitMix64) -> Vec<Cell> {
    let mut round = vec![post];
    let mut from = post;
    for _ in 0..2 + random.below(2) {
        let is_next = |&(cell, steps): &(Cell, u32)| {
            let is_apart = round.iter().all(|&other| apart(other, cell) >= *LEG.start() / 2);
            LEG.contains(&steps)
                && is_apart
                && ground.is_bare(cell)
                && ground.distance(cell) >= GUARD_DISTANCE
        };
        let around = ground.around(from, *LEG.end());
        let places: Vec<Cell> = around.into_iter().filter(is_next).map(|(cell, _)| cell).collect();
        let Some(&next) = places.get(random.below(places.len())) else { break };
        round.push(next);
        from = next;
    }
    round.rotate_left(1);
    round
}

/// Towards the first waypoint, or any of the four directions of the grid.
fn heading(duty: &Duty, cell: Cell, random: &mut SplitMix64) -> Heading {
    let any = random.below(4);
    let quarter = match duty {
        Duty::Patrol(cells) => cells.first().map_or(any, |next| {
            let across = i64::from(next.column) - i64::from(cell.column);
            let down = i64::from(next.row) - i64::from(cell.row);
            match (across.abs() >= down.abs(), across > 0, down > 0) {
                (true, true, _) => 0,
                (false, _, true) => 1,
                (true, false, _) => 2,
                (false, _, false) => 3,
            }
        }),
        _ => any,
    };
    Heading::from_degrees(90.0 * quarter as f64).unwrap_or_default()
}
