//! The items of a floor: treasure, healing and supplies.

use super::ground::Ground;
use crate::fault::Faults;
use crate::map::{self, NoFiles};
use crate::rng::SplitMix64;
use crate::world::{Cell, SpriteId, Supply, Thing, ThingKind, World};

/// The items, in the cells where they lie.
pub(crate) struct Items {
    things: Vec<Thing>,
    /// The exit, where nothing else may be.
    exit: Cell,
}

/// The steps between the start and an item, at least.
const FROM_START: u32 = 4;
/// The steps along the grid between two items, if there is room.
const APART: u32 = 5;
/// The cells that are compared for the place of an item.
const PLACES: usize = 12;

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
        let free: Vec<Cell> = ground.reachable().iter().filter(free).copied().collect();
        let mut items = Self { things: Vec::new(), exit };
        let mut sprites = Vec::new();
        for (kind, is_hidden) in list(floor) {
            let Some(cell) = items.place_for(is_hidden, ground, &free, random) else { break };
            let sprite = models.sprite(kind, &mut sprites, world);
            items.things.extend(sprite.map(|sprite| Thing { kind, cell, sprite, frame: None }));
        }
        Ok(items)
    }

    pub(crate) fn things(&self) -> &[Thing] {
        &self.things
    }

    /// Whether an item or the exit is in a cell.
    pub(crate) fn is_in(&self, cell: Cell) -> bool {
        cell == self.exit || self.things.iter().any(|thing| thing.cell == cell)
    }

    /// The worth of all treasure.
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

    /// The best of some random cells: apart from other items; if the item is hidden, in a dead end or
    /// far from the start.
    fn place_for(
        &self,
        is_hidden: bool,
        ground: &Ground,
        free: &[Cell],
        random: &mut SplitMix64,
    ) -> Option<Cell> {
        let places: Vec<Cell> =
            (0..PLACES).filter_map(|_| free.get(random.below(free.len())).copied()).collect();
        let places = places.into_iter().filter(|&cell| !self.is_in(cell));
        places.max_by_key(|&cell| {
            let nearest = self.things.iter().map(|thing| apart(thing.cell, cell)).min();
            let worth = match ground.exits_of(cell) {
                0..=1 => 1000,
                _ => ground.distance(cell),
            };
            (nearest.unwrap_or(APART).min(APART), if is_hidden { worth } else { 0 })
        })
    }
}

/// The items of a floor, and whether each is hidden.
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

/// The distance of two cells along the grid.
pub(crate) fn apart(one: Cell, other: Cell) -> u32 {
    one.column.abs_diff(other.column) + one.row.abs_diff(other.row)
}

/// A world with one item of each kind, as a map describes them.
struct Models(World);

impl Models {
    fn new() -> Result<Self, Faults> {
        map::parse(include_str!("items.toml"), "the items", &NoFiles).map(Self)
    }

    /// The sprite of a kind in `world`, where it is added once. `known` are those that it has.
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
