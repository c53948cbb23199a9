//! Handles: what the player opens beside doors: levers, flames and secret walls.

use glam::DVec2;

use crate::cast::{Ray, Walk};
use crate::game::Game;
use crate::game::noise::reach;
use crate::game::sound::SoundKind;
use crate::world::sprite::builtin::LeverFrame;
use crate::world::{Cell, Driver, SwitchId, ThingKind};

/// How far a handle's cell may be from the player who opens it, in cells.
const REACH: f64 = 0.9;
/// The cosine of the angle to both sides of the view in which a lever or a flame is: 50°.
const COSINE: f64 = 0.642_787_609_686_539_3;
/// Nearer than this the direction does not matter.
const NEAR: f64 = 0.4;

/// Something that the player can open, beside doors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Handle {
    Lever(Cell, SwitchId),
    Flame(Cell),
    /// The secret wall that is the moving cell with that index.
    Secret(usize),
}

impl Game {
    /// The handle in front of the player.
    pub(crate) fn handle_ahead(&self) -> Option<Handle> {
        if !self.mechanisms.has_handles() {
            return None;
        }
        self.thing_to_open().or_else(|| self.secret_ahead())
    }

    /// Turns a lever, puts a flame out or lights it, or opens a secret wall.
    pub(crate) fn use_handle(&mut self, handle: Handle) {
        self.revision += 1;
        match handle {
            Handle::Lever(cell, switch) => self.turn_lever(cell, switch),
            Handle::Flame(cell) => {
                let burns = self.burns(cell);
                self.world.set_flame(cell, !burns);
            }
            Handle::Secret(index) => {
                let cell = self.mechanisms.moving[index].cell();
                self.mechanisms.open_secret(index);
                self.sound_in(cell, SoundKind::Mechanism, reach::MECHANISM);
                self.say("You have found a secret.".to_owned());
            }
        }
    }

    fn turn_lever(&mut self, cell: Cell, switch: SwitchId) {
        let is_turned = self.mechanisms.turn(switch);
        let is_it = |kind| kind == ThingKind::Lever(switch);
        let levers = self.world.things().iter().filter(|thing| is_it(thing.kind));
        let cells: Vec<Cell> = levers.map(|thing| thing.cell).collect();
        for lever in cells {
            let frame = if is_turned { LeverFrame::On } else { LeverFrame::Off };
            self.world.set_frame(lever, is_it, frame.index());
        }
        self.sound_in(cell, SoundKind::Mechanism, reach::CLICK);
    }

    fn burns(&self, cell: Cell) -> bool {
        let things = self.world.things_in(cell).iter();
        things.filter(|thing| thing.kind == ThingKind::Flame).any(|thing| thing.frame.is_none())
    }

    /// The nearest lever or flame in front of the player or at their place.
    fn thing_to_open(&self) -> Option<Handle> {
        let Cell { column, row } = self.player.motion.cell();
        let near = |place: u32| place.saturating_sub(1)..=place.saturating_add(1);
        let cells = near(row).flat_map(|row| near(column).map(move |column| Cell { column, row }));
        let handles = cells.filter(|&cell| self.is_within_reach(cell)).filter_map(|cell| {
            self.world
                .things_in(cell)
                .iter()
                .find_map(|thing| match thing.kind {
                    ThingKind::Lever(switch) => Some(Handle::Lever(cell, switch)),
                    ThingKind::Flame => Some(Handle::Flame(cell)),
                    _ => None,
                })
                .map(|handle| (cell, handle))
        });
        let position = self.player.motion.position();
        let distance = |cell: Cell| cell.center().distance_squared(position);
        let nearest = handles.min_by(|one, other| distance(one.0).total_cmp(&distance(other.0)));
        nearest.map(|(_, handle)| handle)
    }

    /// Whether the player can reach the middle of `cell`.
    fn is_within_reach(&self, cell: Cell) -> bool {
        let motion = &self.player.motion;
        let position = motion.position();
        let way = cell.center() - position;
        let length = way.length();
        if length < NEAR {
            return true;
        }
        let is_ahead = way.dot(motion.heading().direction()) >= COSINE * length;
        is_ahead && to_cell(position, cell) <= REACH && self.is_clear(position, way)
    }

    /// Whether nothing solid is on a way.
    fn is_clear(&self, position: DVec2, way: DVec2) -> bool {
        let Ok(ray) = Ray::new(position, way) else { return true };
        let solid = Walk::new(self.world.grid(), &ray).first_solid();
        solid.is_none_or(|solid| to_cell(position, solid.cell) >= way.length())
    }

    /// The secret wall that the player looks at, if it has not been opened.
    fn secret_ahead(&self) -> Option<Handle> {
        let motion = &self.player.motion;
        let ray = Ray::new(motion.position(), motion.heading().direction()).ok()?;
        let cell = Walk::new(self.world.grid(), &ray).first_solid()?.cell;
        let index = self.mechanisms.moving_in(cell)?;
        let moving = &self.mechanisms.moving[index];
        let is_secret = moving.driver(&self.world) == Driver::Hand && !moving.is_driven();
        let is_near = to_cell(motion.position(), cell) <= REACH;
        (is_secret && is_near).then_some(Handle::Secret(index))
    }
}

/// The distance from a position to the square of `cell`.
fn to_cell(position: DVec2, cell: Cell) -> f64 {
    let middle = cell.center();
    position.distance(position.clamp(middle - 0.5, middle + 0.5))
}
