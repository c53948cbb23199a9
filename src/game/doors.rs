//! Doors: they open, wait and close.
//!
//! A door opens when the player is within [`REACH`] and wants to open it or walks into it. It takes
//! [`TRAVEL`] steps to open, stays open for [`STAY`] steps, and closes in [`TRAVEL`] steps. If a
//! closing door is opened, it reverses. A door with a switch stays open while the switch is on. The
//! position is computed from the number of steps, not from the last position.
//!
//! Nobody is ever inside a door: its cell is solid unless the door is fully open, and the door does
//! not begin to close while anybody touches the cell. Rejected: a door that pushes players away.
//! There may be no room for them.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::cast::{Ray, Walk};
use crate::game::stored::{RestoreError, check};
use crate::generate::WindowShift;
use crate::world::{Cell, Door, Opening, TileKind, World};

/// The number of steps from closed to open: 0.6 seconds.
const TRAVEL: u32 = 36;
/// The number of steps for which a door stays open: 4 seconds.
const STAY: u32 = 240;
/// The largest distance between a door's cell and the player who opens it, in cells.
const REACH: f64 = 0.75;

/// The doors that are not closed, in the order in which they were opened.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Doors {
    moving: Vec<MovingDoor>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct MovingDoor {
    cell: Cell,
    phase: DoorPhase,
    /// Whether a switch keeps it open.
    is_held: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum DoorPhase {
    /// The number of steps since the door was closed.
    Opening(u32),
    /// The number of remaining steps.
    Open(u32),
    /// The number of steps until the door is closed.
    Closing(u32),
}

impl Doors {
    /// Opens the door in `cell`, unless it is opening already.
    pub(crate) fn open(&mut self, cell: Cell) {
        match self.moving.iter_mut().find(|door| door.cell == cell) {
            None => self.moving.push(MovingDoor::new(cell)),
            Some(MovingDoor { phase, .. }) => {
                if let DoorPhase::Closing(steps) = *phase {
                    *phase = DoorPhase::Opening(steps);
                }
            }
        }
    }

    /// Opens the door in `cell` for as long as its switch is on, or lets it close.
    pub(crate) fn hold(&mut self, cell: Cell, is_on: bool) {
        if is_on {
            self.open(cell);
        }
        for door in self.moving.iter_mut().filter(|door| door.cell == cell) {
            door.is_held = is_on;
            if let (DoorPhase::Open(_), false) = (door.phase, is_on) {
                door.phase = DoorPhase::Open(0);
            }
        }
    }

    /// Whether [`Doors::open`] would change anything.
    pub(crate) fn would_open(&self, cell: Cell) -> bool {
        let door = self.moving.iter().find(|door| door.cell == cell);
        door.is_none_or(|door| matches!(door.phase, DoorPhase::Closing(_)))
    }

    /// The number of doors that are not closed.
    pub(crate) fn count(&self) -> usize {
        self.moving.len()
    }

    /// Advances the doors of `world` by one step. `is_occupied` returns true for a cell that a
    /// player or a guard touches. Returns whether any door has moved.
    pub(crate) fn step(&mut self, world: &mut World, is_occupied: impl Fn(Cell) -> bool) -> bool {
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

    /// Restores the openings of the doors in `world` after the window has moved by `shift` and
    /// shows all doors closed. Doors outside the window are closed.
    pub(crate) fn shift(&mut self, world: &mut World, shift: WindowShift) {
        self.moving.retain_mut(|door| match shift.cell(door.cell) {
            Some(cell) => {
                door.cell = cell;
                world.set_opening(cell, door.phase.opening());
                true
            }
            None => false,
        });
    }

    /// Returns true if no door moves until it is opened or its switch releases it.
    pub(crate) fn are_at_rest(&self) -> bool {
        self.moving.iter().all(MovingDoor::is_kept_open)
    }

    /// Applies the openings of these doors to `world`, in which all doors are closed.
    ///
    /// # Errors
    /// If they are not doors of `world`.
    pub(crate) fn show(&self, world: &mut World) -> Result<(), RestoreError> {
        for (index, door) in self.moving.iter().enumerate() {
            let is_new = self.moving[..index].iter().all(|other| other.cell != door.cell);
            let is_possible = match door.phase {
                DoorPhase::Opening(steps) | DoorPhase::Closing(steps) => steps < TRAVEL,
                DoorPhase::Open(left) => left <= STAY,
            };
            check(is_new && is_possible && world.door(door.cell).is_some(), "a door")?;
            world.set_opening(door.cell, door.phase.opening());
        }
        Ok(())
    }
}

impl MovingDoor {
    fn new(cell: Cell) -> Self {
        Self { cell, phase: DoorPhase::Opening(0), is_held: false }
    }

    /// Returns true while a switch keeps the door open, so that its time does not run.
    fn is_kept_open(&self) -> bool {
        self.is_held && matches!(self.phase, DoorPhase::Open(_))
    }

    /// Advances the door by one step. Returns false once it is closed.
    fn step(&mut self, is_occupied: bool) -> bool {
        if self.is_kept_open() {
            return true;
        }
        self.phase = match self.phase {
            DoorPhase::Opening(steps) if steps + 1 < TRAVEL => DoorPhase::Opening(steps + 1),
            DoorPhase::Opening(_) => DoorPhase::Open(STAY),
            DoorPhase::Open(0) if is_occupied => DoorPhase::Open(STAY),
            DoorPhase::Open(0) => DoorPhase::Closing(TRAVEL - 1),
            DoorPhase::Open(left) => DoorPhase::Open(left - 1),
            DoorPhase::Closing(steps) => DoorPhase::Closing(steps.saturating_sub(1)),
        };
        self.phase != DoorPhase::Closing(0)
    }
}

impl DoorPhase {
    fn opening(self) -> Opening {
        let steps = match self {
            Self::Opening(steps) | Self::Closing(steps) => steps,
            Self::Open(_) => TRAVEL,
        };
        Opening::new(eased(f64::from(steps) / f64::from(TRAVEL))).unwrap_or(Opening::OPEN)
    }
}

/// Maps `part` from 0..1 to 0..1 with a slow start and end.
fn eased(part: f64) -> f64 {
    part * part * (3.0 - 2.0 * part)
}

/// The door in front of a player at `position` who looks or walks along `direction`, a unit vector.
/// `None` if no door is within reach.
pub(crate) fn door_ahead(world: &World, position: DVec2, direction: DVec2) -> Option<(Cell, Door)> {
    let ray = Ray::new(position, direction).ok()?;
    let cell = Walk::new(world.grid(), &ray).first_solid()?;
    let TileKind::Door(door) = world.tile(cell.tile).kind else { return None };
    let middle = cell.cell.center();
    let distance = position.distance(position.clamp(middle - 0.5, middle + 0.5));
    (distance <= REACH).then_some((cell.cell, door))
}
