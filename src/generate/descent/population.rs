//! The population of a floor: treasure, healing, supplies and guards with their patrols.

use std::ops::RangeInclusive;

use super::ground::Ground;
use crate::fault::Faults;
use crate::map::{self, NoFiles};
use crate::rng::SplitMix64;
use crate::sort;
use crate::world::{
    Cell, Difficulty, Duty, GuardKind, GuardPost, Heading, SpriteId, Supply, Thing, ThingKind,
    World,
};

/// The minimum number of steps between the start and an item.
const FROM_START: u32 = 4;
/// The number of steps along the grid between two items, if there is room.
const ITEMS_APART: u32 = 5;
/// The number of cells compared for the place of an item.
const ITEM_PLACES: usize = 12;
/// The minimum distance between a guard's post and the start, in cells.
pub(crate) const GUARD_DISTANCE: u32 = 8;
/// The number of guards at the lowest difficulty: on the first floor, and on the deepest floors.
const MIN_GUARDS: u32 = 2;
const MAX_GUARDS: u32 = 12;
/// The minimum number of reachable cells for each guard.
const CELLS_EACH: usize = 24;
/// The distance between two guards along the grid, if there is room.
const GUARDS_APART: u32 = 6;
/// The number of cells compared for the place of a guard.
const GUARD_PLACES: usize = 16;
/// The range of path lengths between two waypoints, in steps.
const LEG: RangeInclusive<u32> = 5..=14;
/// The kinds of guard, in the order of the floors on which they first appear.
const KINDS: [GuardKind; 5] = [
    GuardKind::Warden,
    GuardKind::Listener,
    GuardKind::Hound,
    GuardKind::Lantern,
    GuardKind::Archer,
];

/// The items, each with its cell.
pub(crate) struct Items {
    pub(crate) things: Vec<Thing>,
    /// The cell of the exit, which must stay free of items.
    exit: Cell,
}

impl Items {
    /// Places the items of a floor, and adds their sprites to `world`.
    pub(crate) fn place(
        floor: u32,
        ground: &Ground,
        exit: Cell,
        world: &mut World,
        random: &mut SplitMix64,
    ) -> Result<Self, Faults> {
        let models = Models::new()?;
        let free = |&&cell: &&Cell| {
            ground.is_bare(cell) && cell != exit && ground.distance(cell) >= FROM_START
        };
        let free: Vec<Cell> = ground.reachable.iter().filter(free).copied().collect();
        let mut items = Self { things: Vec::new(), exit };
        let mut sprites = Vec::new();
        for (kind, is_hidden) in list(floor) {
            let Some(cell) = items.place_for(is_hidden, ground, &free, random) else { break };
            let sprite = models.sprite(kind, &mut sprites, world);
            items.things.extend(sprite.map(|sprite| Thing { kind, cell, sprite, frame: None }));
        }
        Ok(items)
    }

    /// Returns true if an item or the exit is in the cell.
    pub(crate) fn is_in(&self, cell: Cell) -> bool {
        cell == self.exit || self.things.iter().any(|thing| thing.cell == cell)
    }

    /// The total worth of the treasure.
    pub(crate) fn treasure(&self) -> u32 {
        self.treasures().sum()
    }

    pub(crate) fn treasure_count(&self) -> usize {
        self.treasures().count()
    }

    fn treasures(&self) -> impl Iterator<Item = u32> {
        self.things.iter().filter_map(|thing| match thing.kind {
            ThingKind::Treasure(worth) => Some(worth.into()),
            _ => None,
        })
    }

    /// The best of some random cells. A cell is better if it is farther from other items. For a
    /// hidden item, a dead end or a long way from the start decides between equally good cells.
    fn place_for(
        &self,
        is_hidden: bool,
        ground: &Ground,
        free: &[Cell],
        random: &mut SplitMix64,
    ) -> Option<Cell> {
        let places =
            some_of(ITEM_PLACES, free, random).into_iter().filter(|&cell| !self.is_in(cell));
        places.max_by_key(|&cell| {
            let nearest = self.things.iter().map(|thing| apart(thing.cell, cell)).min();
            let worth = match ground.exits_of(cell) {
                0..=1 => 1000,
                _ => ground.distance(cell),
            };
            (nearest.unwrap_or(ITEMS_APART).min(ITEMS_APART), if is_hidden { worth } else { 0 })
        })
    }
}

/// The items of a floor, and whether each one is hidden.
fn list(floor: u32) -> impl Iterator<Item = (ThingKind, bool)> {
    let floor = floor.min(20) as usize;
    let every =
        |count: usize, kind: ThingKind| (floor.is_multiple_of(count)).then_some((kind, false));
    let treasure = [
        (ThingKind::Treasure(100), floor.div_ceil(4)),
        (ThingKind::Treasure(25), 1 + floor / 2),
        (ThingKind::Treasure(10), 2 + floor / 2),
    ];
    let treasure =
        treasure.into_iter().flat_map(|(kind, count)| (0..count).map(move |_| (kind, true)));
    let supplies = [
        every(1, ThingKind::Supply(Supply::Pebbles, 2)),
        every(1, ThingKind::Healing(1)),
        every(2, ThingKind::Supply(Supply::Darts, 1)),
        every(3, ThingKind::Supply(Supply::Flasks, 1)),
        every(4, ThingKind::Healing(2)),
    ];
    treasure.chain(supplies.into_iter().flatten())
}

/// Up to `count` random cells from `free`.
fn some_of(count: usize, free: &[Cell], random: &mut SplitMix64) -> Vec<Cell> {
    (0..count).filter_map(|_| free.get(random.below(free.len())).copied()).collect()
}

/// The distance between two cells along the grid.
fn apart(one: Cell, other: Cell) -> u32 {
    one.column.abs_diff(other.column) + one.row.abs_diff(other.row)
}

/// A world with one item of each kind, described by a map file.
struct Models(World);

impl Models {
    fn new() -> Result<Self, Faults> {
        map::parse(include_str!("items.toml"), "the items", &NoFiles).map(Self)
    }

    /// The sprite of a kind in `world`. It is added once; `known` are the sprites that were added
    /// before.
    fn sprite(
        &self,
        kind: ThingKind,
        known: &mut Vec<(ThingKind, SpriteId)>,
        world: &mut World,
    ) -> Option<SpriteId> {
        if let Some(&(_, sprite)) = known.iter().find(|(other, _)| *other == kind) {
            return Some(sprite);
        }
        let model = self.0.things().iter().find(|thing| thing.kind == kind)?;
        let sprite = world.add_sprite(self.0.sprite(model.sprite).clone());
        known.push((kind, sprite));
        Some(sprite)
    }
}

/// Places the guards of a floor. They are sorted by row, then by column.
pub(crate) fn guards(
    floor: u32,
    ground: &Ground,
    items: &Items,
    random: &mut SplitMix64,
) -> Vec<GuardPost> {
    let start = ground.start;
    let is_far = |cell: Cell| {
        let (columns, rows) = (cell.column.abs_diff(start.column), cell.row.abs_diff(start.row));
        columns * columns + rows * rows >= GUARD_DISTANCE * GUARD_DISTANCE
    };
    let is_free = |&&cell: &&Cell| {
        ground.is_bare(cell) && is_far(cell) && !items.is_in(cell) && !ground.sees(start, cell)
    };
    let free: Vec<Cell> = ground.reachable.iter().filter(is_free).copied().collect();
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

/// The lowest difficulty at which each guard appears.
fn from_difficulties(floor: u32, ground: &Ground) -> impl Iterator<Item = Difficulty> {
    let room = ground.reachable.len() / CELLS_EACH;
    let wanted = (MIN_GUARDS + floor / 2).min(MAX_GUARDS) as usize;
    let easy = wanted.min(room.max(1));
    let more = easy.div_ceil(2);
    let counts = [(Difficulty::Easy, easy), (Difficulty::Normal, more), (Difficulty::Hard, more)];
    counts.into_iter().flat_map(|(from, count)| (0..count).map(move |_| from))
}

/// The best of some random cells: the one farthest from other guards.
fn place_for(posts: &[GuardPost], free: &[Cell], random: &mut SplitMix64) -> Option<Cell> {
    let nearest = |cell: Cell| posts.iter().map(|post| apart(post.cell, cell)).min();
    let places =
        some_of(GUARD_PLACES, free, random).into_iter().filter(|&cell| nearest(cell) != Some(0));
    places.max_by_key(|&cell| nearest(cell).unwrap_or(GUARDS_APART).min(GUARDS_APART))
}

/// The kind of a guard. The first guard on a floor has the kind that is new there.
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

/// A patrol of up to four waypoints over open floor. The last waypoint is `post`.
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

/// The direction along the grid to the first waypoint. Without a patrol, a random direction along
/// the grid.
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
