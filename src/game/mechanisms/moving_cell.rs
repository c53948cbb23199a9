//! A cell whose tile moves: how far it is, and what comes next.

use serde::{Deserialize, Serialize};

use crate::game::STEPS_PER_SECOND;
use crate::game::stored::{OfLevel, Unrestorable};
use crate::world::{Cell, Driver, MovingTile, TileId, World};

/// The steps before a floor falls on which somebody has stepped, and those in which it falls.
const CRACKS: u16 = 30;
const FALLS: u16 = 20;

/// A cell of a [`MovingTile`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct MovingCell {
    #[serde(skip)]
    cell: Cell,
    /// The index of its moving tile.
    #[serde(skip)]
    tile: u16,
    /// The steps from the first state, without those in which it cracks.
    progress: u16,
    /// The steps for which it has cracked.
    cracks: u16,
    /// Whether a hand or a weight has set it in motion.
    is_driven: bool,
    /// Whether somebody was in the way of its last step, and no tile has moved since.
    is_blocked: bool,
}

/// What a moving cell does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Step {
    pub(crate) after: MovingCell,
    /// The tile that it shows then, if that changes.
    pub(crate) state: Option<TileId>,
}

impl OfLevel for MovingCell {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        Ok(Self { cell: start.cell, tile: start.tile, ..self })
    }
}

impl MovingCell {
    /// A cell at rest of the moving tile `tile`.
    pub(crate) fn new(cell: Cell, tile: usize) -> Self {
        Self {
            cell,
            tile: tile as u16,
            progress: 0,
            cracks: 0,
            is_driven: false,
            is_blocked: false,
        }
    }

    pub(crate) fn cell(&self) -> Cell {
        self.cell
    }

    pub(crate) fn tile(&self) -> usize {
        usize::from(self.tile)
    }

    pub(crate) fn driver(&self, world: &World) -> Driver {
        self.moving_tile(world).driver
    }

    /// Whether a hand or a weight has set it in motion.
    pub(crate) fn is_driven(&self) -> bool {
        self.is_driven
    }

    /// Sets it in motion for good.
    pub(crate) fn drive(&mut self) {
        self.is_driven = true;
    }

    /// Whether somebody was in the way of its last step, and no tile has moved since.
    pub(crate) fn is_blocked(&self) -> bool {
        self.is_blocked
    }

    /// The same cell, after a step in which somebody was in the way.
    #[must_use]
    pub(crate) fn blocked(self) -> Self {
        Self { is_blocked: true, ..self }
    }

    /// Forgets that somebody was in the way.
    pub(crate) fn try_again(&mut self) {
        self.is_blocked = false;
    }

    /// The tile that it shows.
    pub(crate) fn shown(&self, world: &World) -> TileId {
        let moving = self.moving_tile(world);
        let last = moving.states.len().saturating_sub(1);
        let index = usize::from(self.progress) * last / usize::from(steps(moving, world));
        // A floor that cracks shows it by sinking a little.
        let index = index.max(usize::from(self.cracks > 0)).min(last);
        moving.states[index]
    }

    /// Whether it shows its last state.
    pub(crate) fn is_at_the_end(&self, world: &World) -> bool {
        self.progress >= steps(self.moving_tile(world), world)
    }

    /// Its next step, towards the end if it `is_driven` and back otherwise; `None` if it rests.
    pub(crate) fn step(self, world: &World, is_driven: bool) -> Option<Step> {
        let moving = self.moving_tile(world);
        let mut after = Self { is_blocked: false, ..self };
        if moving.driver == Driver::Weight && is_driven && self.cracks < CRACKS {
            after.is_driven = true;
            after.cracks += 1;
        } else if is_driven {
            after.progress = (self.progress + 1).min(steps(moving, world));
        } else {
            after.progress = self.progress.saturating_sub(1);
        }
        let state = Some(after.shown(world)).filter(|&state| state != self.shown(world));
        (after != self).then_some(Step { after, state })
    }

    /// Whether it has not gone beyond its last state.
    pub(crate) fn is_possible(&self, world: &World) -> bool {
        self.cracks <= CRACKS && self.progress <= steps(self.moving_tile(world), world)
    }

    fn moving_tile<'a>(&self, world: &'a World) -> &'a MovingTile {
        &world.moving_tiles()[self.tile()]
    }
}

/// The steps from the first state to the last; at least one.
fn steps(moving: &MovingTile, world: &World) -> u16 {
    if moving.driver == Driver::Weight {
        return FALLS;
    }
    let height = |id: Option<&TileId>| id.map_or(0.0, |&id| world.tile(id).heights.floor());
    let way = (height(moving.states.last()) - height(moving.states.first())).abs();
    (way * f64::from(STEPS_PER_SECOND)).round().clamp(1.0, u16::MAX.into()) as u16
}
