//! What moves a player who does not walk: floors carry those who stand on them, blows and guards push.

use glam::DVec2;

use super::{Body, Motion, Place, RADIUS, STEP_HEIGHT, slide};
use crate::game::stored::{Unrestorable, check_on_map};
use crate::world::{Cell, World};

impl Motion {
    /// Refuses a place outside of `world`, and a stance and turns that are none.
    pub fn check(&self, world: &World) -> Result<(), Unrestorable> {
        check_on_map(world, self.body.position)?;
        self.stance.check()?;
        self.turning.check()
    }

    /// Lifted or lowered, with the floor, to that height of the feet.
    #[must_use]
    pub(crate) fn carried_to(self, feet: f64) -> Self {
        Self { feet, rising: 0.0, ..self }
    }

    /// Standing in the middle of `cell`; `None` if there is no room.
    pub(crate) fn moved_to(mut self, world: &World, cell: Cell) -> Option<Self> {
        self.body.position = cell.center();
        self.feet = world.floor_at(cell);
        self.has_room(world).then_some(self)
    }

    /// With that change of the velocity, in cells per second.
    #[must_use]
    pub(crate) fn pushed(mut self, change: DVec2) -> Self {
        self.body.velocity += change;
        self
    }

    /// The same motion moved by `displacement`, as far as nothing is in the way; unchanged if the floor
    /// there is not level with the feet.
    #[must_use]
    pub(crate) fn moved_aside(self, world: &World, displacement: DVec2) -> Self {
        let mut place = self.place(world);
        let body = slide(&mut place, self.body, displacement, RADIUS);
        let moved = Self { body: Body { velocity: self.body.velocity, ..body }, ..self };
        let is_level = self.stands(world) && moved.stands(world) && moved.has_room(world);
        if is_level { moved } else { self }
    }

    /// The height of the feet in `world`, if that has lifted or, where they stood, lowered them.
    pub(crate) fn feet_after(&self, world: &World, stood: bool) -> Option<f64> {
        if !self.has_room(world) {
            return self.lifted(world);
        }
        let floor = self.floor(world);
        (stood && floor < self.feet && self.feet - floor <= STEP_HEIGHT).then_some(floor)
    }

    /// The height to which floors that have risen around the feet lift them; `None` if there are no
    /// such floors, or no room.
    pub(crate) fn lifted(&self, world: &World) -> Option<f64> {
        let place = Place { step: STEP_HEIGHT, ..self.place(world) };
        place.lifted(self.body.position, RADIUS)
    }
}
