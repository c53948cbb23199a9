//! What doors do: they open to who walks up to them, wait, and close behind them.
//!
//! A door is opened by the wish to open it, or by walking into it, within [`REACH`]. It takes
//! [`TRAVEL`] steps to open, stays open for [`STAY`], and closes as slowly as it opened; one that is
//! wanted open again turns back. How far it is open is computed from the steps that it has moved, not
//! from how far it was before.
//!
//! Nobody is ever inside a door: its cell is solid unless the door is all open, and it does not begin
//! to close while anybody touches the cell. A door that pushes people out of its way was refused:
//! they may have nowhere to go.

use glam::DVec2;

use crate::cast::{Ray, Walk};
use crate::generate::Shift;
use crate::world::{Cell, Door, Opening, TileKind, World};

/// Steps from closed to open: 0.6 seconds.
const TRAVEL: u32 = 36;
/// Steps that a door stays open: 4 seconds.
const STAY: u32 = 240;
/// How far a door's cell may be from who opens it, in cells.
const REACH: f64 = 0.75;

/// The doors that are not closed and at rest, in the order in which they were opened.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Doors {
    moving: Vec<MovingDoor>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct MovingDoor {
    cell: Cell,
    phase: Phase,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Phase {
    /// So many steps from closed.
    Opening(u32),
    /// For so many steps to come.
    Open(u32),
    /// So many steps from closed.
    Closing(u32),
}

impl Doors {
    /// Opens the door in `cell`, unless it is being opened already.
    pub(super) fn open(&mut self, cell: Cell) {
        match self.moving.iter_mut().find(|door| door.cell == cell) {
            None => self.moving.push(MovingDoor { cell, phase: Phase::Opening(0) }),
            Some(MovingDoor { phase, .. }) => {
                if let Phase::Closing(steps) = *phase {
                    *phase = Phase::Opening(steps);
                }
            }
        }
    }

    /// Whether [`Doors::open`] would change anything.
    pub(super) fn would_open(&self, cell: Cell) -> bool {
        let door = self.moving.iter().find(|door| door.cell == cell);
        door.is_none_or(|door| matches!(door.phase, Phase::Closing(_)))
    }

    /// Lets one step pass for the doors of `world`, where `is_occupied` tells which cells somebody
    /// touches. Tells whether any door has moved.
    pub(super) fn step(&mut self, world: &mut World, is_occupied: impl Fn(Cell) -> bool) -> bool {
        let mut has_moved = false;
        self.moving.retain_mut(|door| {
            let before = door.phase.opening();
            let is_open = door.step(is_occupied(door.cell));
            let opening = door.phase.opening();
            if opening != before {
                world.set_opening(door.cell, opening);
                has_moved = true;
            }
            is_open
        });
        has_moved
    }

    /// Opens the doors of `world`, the same ones in a window that has moved and shows them closed, as
    /// far as they were open. Those that are out of it are closed.
    pub(super) fn shift(&mut self, world: &mut World, shift: Shift) {
        self.moving.retain_mut(|door| match shift.cell(door.cell) {
            Some(cell) => {
                door.cell = cell;
                world.set_opening(cell, door.phase.opening());
                true
            }
            None => false,
        });
    }

    /// For how many steps no door begins, continues or ends to move; `None` for ever.
    pub(super) fn quiet_steps(&self) -> Option<u64> {
        let quiet = self.moving.iter().map(|door| match door.phase {
            Phase::Open(steps) => u64::from(steps),
            Phase::Opening(_) | Phase::Closing(_) => 0,
        });
        quiet.min()
    }

    /// Lets `steps` steps pass, no more than [`Doors::quiet_steps`].
    pub(super) fn wait(&mut self, steps: u64) {
        for door in &mut self.moving {
            if let Phase::Open(left) = &mut door.phase {
                *left = left.saturating_sub(u32::try_from(steps).unwrap_or(u32::MAX));
            }
        }
    }
}

impl MovingDoor {
    /// Lets one step pass, and tells whether the door is still anything but closed.
    fn step(&mut self, is_occupied: bool) -> bool {
        self.phase = match self.phase {
            Phase::Opening(steps) if steps + 1 < TRAVEL => Phase::Opening(steps + 1),
            Phase::Opening(_) => Phase::Open(STAY),
            Phase::Open(0) if is_occupied => Phase::Open(STAY),
            Phase::Open(0) => Phase::Closing(TRAVEL - 1),
            Phase::Open(left) => Phase::Open(left - 1),
            Phase::Closing(steps) => Phase::Closing(steps.saturating_sub(1)),
        };
        self.phase != Phase::Closing(0)
    }
}

impl Phase {
    fn opening(self) -> Opening {
        let steps = match self {
            Self::Opening(steps) | Self::Closing(steps) => steps,
            Self::Open(_) => TRAVEL,
        };
        Opening::new(eased(f64::from(steps) / f64::from(TRAVEL))).unwrap_or(Opening::OPEN)
    }
}

/// From 0 to 1 as `part` does, but slow at both ends.
fn eased(part: f64) -> f64 {
    part * part * (3.0 - 2.0 * part)
}

/// The door that somebody at `position` is before who looks or walks along `direction`, a vector of
/// length 1. `None` where none is within reach.
pub(super) fn door_ahead(world: &World, position: DVec2, direction: DVec2) -> Option<(Cell, Door)> {
    let ray = Ray::new(position, direction).ok()?;
    let cell = Walk::new(world.grid(), &ray).first_solid()?;
    let TileKind::Door(door) = world.tile(cell.tile).kind else { return None };
    let middle = cell.cell.center();
    let distance = position.distance(position.clamp(middle - 0.5, middle + 0.5));
    (distance <= REACH).then_some((cell.cell, door))
}
