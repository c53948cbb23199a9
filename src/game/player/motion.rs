//! The motion of a player: position, heading, stance and speed, and their changes in a step.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::game::collision::{MovingBody, Radius, Stature, WorldObstacles, overlaps, slide};
use crate::game::fall::{GRAVITY, VerticalMotion, VerticalRange};
use crate::game::intent::{Intent, Intents};
use crate::game::rules::STEP;
use crate::game::stance::Stance;
use crate::game::stored::{RestoreError, check_on_map};
use crate::game::turning::{PitchControl, Turning};
use crate::generate::WindowShift;
use crate::numeric::damped_motion::{DampedMotion, approach_in_plane};
use crate::world::{Camera, Cell, FieldOfView, Heading, World};

/// The player's radius, in cells. A door is twice as wide as the player.
pub(crate) const RADIUS: Radius =
    Radius::new(0.25).expect("a quarter is between nothing and a half");

/// Walking speed in any direction, in cells per second.
pub(crate) const WALK: f64 = 3.0;
/// Running speed in any direction, in cells per second.
pub(crate) const RUN: f64 = 5.5;

/// The rate at which the player approaches the walking or running speed, per second.
pub const FRICTION: f64 = 12.0;

/// The height of a step that the player can climb or descend by walking, in cells.
pub(crate) const STEP_HEIGHT: f64 = 0.35;
/// The height of a jump, in cells.
pub(crate) const JUMP_HEIGHT: f64 = 0.66;

/// Below this speed the player counts as still, in cells or radians per second. An exponential
/// decay never ends, but a program should be able to sleep when nothing moves.
pub(crate) const STILL: f64 = 1e-4;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Motion {
    body: MovingBody,
    /// The height of the feet, in cells.
    feet: f64,
    /// Cells per second, upwards.
    rising: f64,
    stance: Stance,
    pitch_control: PitchControl,
    /// Whether the player wanted to jump in the last step, because each press makes one jump.
    wanted_to_jump: bool,
    heading: Heading,
    turning: Turning,
}

impl Motion {
    /// A player who stands still at the start.
    pub(crate) fn new(world: &World) -> Self {
        let start = world.start();
        let body = MovingBody { position: start.cell.center(), velocity: DVec2::ZERO };
        Self {
            body,
            // The start has headroom.
            feet: world.floor_at(start.cell),
            rising: 0.0,
            stance: Stance::default(),
            pitch_control: PitchControl::default(),
            wanted_to_jump: false,
            heading: start.heading,
            turning: Turning::default(),
        }
    }

    /// The same position in another world, standing still. `None` if there is no room.
    pub(crate) fn placed_in(self, world: &World) -> Option<Self> {
        let Cell { column, row } = self.cell();
        let (column, row) = (i64::from(column), i64::from(row));
        if world.grid().tile(column, row).is_none() || world.grid().is_solid(column, row) {
            return None;
        }
        let still = Self {
            body: MovingBody { velocity: DVec2::ZERO, ..self.body },
            rising: 0.0,
            turning: Turning::default(),
            stance: Stance::default(),
            wanted_to_jump: false,
            ..self
        };
        let heights = [self.feet, world.floor_at(self.cell())];
        let placed = heights.map(|feet| Self { feet, ..still });
        placed.into_iter().find(|motion| motion.has_room(world))
    }

    /// The player's view of `world`.
    pub(crate) fn camera(&self, world: &World, field_of_view: FieldOfView) -> Option<Camera> {
        let ceiling = self.room(world).ceiling + self.stance.height();
        let eye = self.feet + self.stance.eye(ceiling - self.feet);
        let camera = Camera::new(self.position(), self.heading, field_of_view)?.with_eye(eye)?;
        Some(camera.with_pitch(self.pitch_control.pitch))
    }

    pub(crate) fn position(&self) -> DVec2 {
        self.body.position
    }

    pub(crate) fn feet(&self) -> f64 {
        self.feet
    }

    /// The height of the top of the head, in cells.
    pub(crate) fn head(&self) -> f64 {
        self.feet + self.stance.height()
    }

    pub(crate) fn heading(&self) -> Heading {
        self.heading
    }

    /// The same position in a window that has moved.
    #[must_use]
    pub(crate) fn shifted(self, shift: WindowShift) -> Self {
        let position = shift.position(self.body.position);
        Self { body: MovingBody { position, ..self.body }, ..self }
    }

    /// The cell of the player's centre.
    pub(crate) fn cell(&self) -> Cell {
        Cell::at(self.body.position)
    }

    /// Whether the player would overlap `cell` if it were solid.
    pub(crate) fn touches(&self, cell: Cell) -> bool {
        overlaps(self.body.position, cell, RADIUS)
    }

    /// The direction in which the player wants to walk, as a unit vector; `None` if they do not.
    pub(crate) fn wanted_direction(&self, intents: Intents) -> Option<DVec2> {
        wanted_velocity(self.heading, intents).try_normalize()
    }

    /// The motion after one step. The player turns, then ducks, and then moves at `pace` times the
    /// usual speed, with `others` in the way.
    #[must_use]
    pub(crate) fn stepped(
        self,
        world: &World,
        others: &[DVec2],
        intents: Intents,
        pace: f64,
    ) -> Self {
        let pitch_control = self.pitch_control.after_a_step(intents);
        let ducked = Self { pitch_control, ..self }.turned(intents).ducked(world, intents);
        ducked.walked(world, others, intents, pace)
    }

    fn turned(self, intents: Intents) -> Self {
        let (turning, turned) = self.turning.after_a_step(intents);
        let angle = turned + intents.look().turn_radians();
        Self { heading: self.heading.turned(angle), turning, ..self }
    }

    /// The player stands up only if there is room.
    fn ducked(self, world: &World, intents: Intents) -> Self {
        let stance = self.stance.after_a_step(intents.contains(Intent::Duck));
        let ducked = Self { stance, ..self };
        if stance.height() <= self.stance.height() || ducked.has_room(world) {
            ducked
        } else {
            self
        }
    }

    fn walked(self, world: &World, others: &[DVec2], intents: Intents, pace: f64) -> Self {
        let wants_to_jump = intents.contains(Intent::Jump);
        let stands = self.stands(world);
        let jumps = stands && wants_to_jump && !self.wanted_to_jump;
        let step = if stands && !jumps { STEP_HEIGHT } else { 0.0 };

        let target = wanted_velocity(self.heading, intents) * pace;
        let DampedMotion { velocity, displacement } =
            approach_in_plane(self.body.velocity, target, FRICTION, STEP);
        let mut place = WorldObstacles { step, others, ..self.place(world) };
        let mut body =
            slide(&mut place, MovingBody { velocity, ..self.body }, displacement, RADIUS);
        if body.velocity.length() < STILL {
            body.velocity = DVec2::ZERO;
        }
        let walked = Self { body, wanted_to_jump: wants_to_jump, ..self };
        let feet = place.stature.feet;
        let room = place.room(body.position, RADIUS);
        if stands && !jumps && feet - room.floor <= STEP_HEIGHT {
            walked.standing_on(room.floor)
        } else {
            let speed = if jumps { libm::sqrt(2.0 * GRAVITY * JUMP_HEIGHT) } else { self.rising };
            walked.flying(VerticalMotion { height: feet, speed }, room)
        }
    }

    /// Whether the player stands on the floor.
    pub(crate) fn stands(&self, world: &World) -> bool {
        self.rising == 0.0 && self.feet == self.room(world).floor
    }

    /// The height of the floor under the player.
    pub(crate) fn floor(&self, world: &World) -> f64 {
        self.room(world).floor
    }

    /// The height of the body, in cells.
    pub(crate) fn height(&self) -> f64 {
        self.stance.height()
    }

    /// Whether the body is nearer to ducking than to standing upright.
    pub(crate) fn is_ducking(&self) -> bool {
        self.stance.is_ducking()
    }

    /// Whether the player neither walks nor falls.
    pub(crate) fn is_still(&self) -> bool {
        self.body.velocity == DVec2::ZERO && self.rising == 0.0
    }

    fn standing_on(self, floor: f64) -> Self {
        Self { feet: floor, rising: 0.0, stance: self.stance.following(floor - self.feet), ..self }
    }

    fn flying(self, flight: VerticalMotion, room: VerticalRange) -> Self {
        let VerticalMotion { height, speed } = flight.after(STEP, room);
        Self { feet: height, rising: speed, stance: self.stance.following(0.0), ..self }
    }

    /// The lowest and the highest height of the feet at this position.
    fn room(&self, world: &World) -> VerticalRange {
        self.place(world).room(self.body.position, RADIUS)
    }

    /// Whether the body overlaps nothing solid.
    pub(crate) fn has_room(&self, world: &World) -> bool {
        self.place(world).is_clear(self.body.position, RADIUS)
    }

    fn place<'a>(&self, world: &'a World) -> WorldObstacles<'a> {
        let stature = Stature { feet: self.feet, height: self.stance.height() };
        WorldObstacles {
            world,
            stature,
            step: 0.0,
            has_shapes: world.tile_facts().have_shapes,
            others: &[],
        }
    }

    /// Returns an error if the position is outside `world`, or if the stance or the turns are out
    /// of range.
    pub(crate) fn check(&self, world: &World) -> Result<(), RestoreError> {
        check_on_map(world, self.body.position)?;
        self.stance.check()?;
        self.turning.check()
    }

    /// The motion after a moving floor has carried the feet to the height `feet`.
    #[must_use]
    pub(crate) fn carried_to(self, feet: f64) -> Self {
        Self { feet, rising: 0.0, ..self }
    }

    /// The motion in the middle of `cell`; `None` if there is no room.
    pub(crate) fn moved_to(mut self, world: &World, cell: Cell) -> Option<Self> {
        self.body.position = cell.center();
        self.feet = world.floor_at(cell);
        self.has_room(world).then_some(self)
    }

    /// The motion after a change of velocity by `change`, in cells per second.
    #[must_use]
    pub(crate) fn pushed(mut self, change: DVec2) -> Self {
        self.body.velocity += change;
        self
    }

    /// The motion after a move by `displacement`, or up to the first obstacle. Unchanged if the
    /// floor there is not level with the feet.
    #[must_use]
    pub(crate) fn moved_aside(self, world: &World, displacement: DVec2) -> Self {
        let mut place = self.place(world);
        let body = slide(&mut place, self.body, displacement, RADIUS);
        let moved = Self { body: MovingBody { velocity: self.body.velocity, ..body }, ..self };
        let is_level = self.stands(world) && moved.stands(world) && moved.has_room(world);
        if is_level { moved } else { self }
    }

    /// The height of the feet in `world`, if a floor has lifted them, or has lowered them while the
    /// player `stood` on it.
    pub(crate) fn feet_after(&self, world: &World, stood: bool) -> Option<f64> {
        if !self.has_room(world) {
            return self.lifted(world);
        }
        let floor = self.floor(world);
        (stood && floor < self.feet && self.feet - floor <= STEP_HEIGHT).then_some(floor)
    }

    /// The height to which floors that have risen around the feet lift them. `None` if there are no
    /// such floors, or no room.
    pub(crate) fn lifted(&self, world: &World) -> Option<f64> {
        let place = WorldObstacles { step: STEP_HEIGHT, ..self.place(world) };
        place.lifted(self.body.position, RADIUS)
    }
}

/// The velocity that the player approaches on open floor.
fn wanted_velocity(heading: Heading, intents: Intents) -> DVec2 {
    let forward = intents.balance(Intent::Forward, Intent::Back);
    let right = intents.balance(Intent::StrafeRight, Intent::StrafeLeft);
    let speed = if intents.contains(Intent::Run) { RUN } else { WALK };
    let ahead_and_aside = DVec2::new(forward, right).normalize_or_zero();
    heading.direction().rotate(ahead_and_aside) * speed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn speed(intents: &[Intent]) -> f64 {
        let heading = Heading::from_degrees(33.0).unwrap();
        wanted_velocity(heading, intents.iter().copied().collect()).length()
    }

    #[test]
    fn a_diagonal_is_no_faster_and_opposites_cancel() {
        use Intent::{Back, Forward, Run, StrafeLeft, StrafeRight};
        for way in [&[Forward][..], &[StrafeLeft], &[Forward, StrafeRight], &[Back, StrafeLeft]] {
            assert!((speed(way) - WALK).abs() < 1e-12, "{way:?}");
            assert!((speed(&[way, &[Run]].concat()) - RUN).abs() < 1e-12, "{way:?}");
        }
        for nowhere in [&[Run][..], &[Forward, Back], &[Forward, Back, StrafeLeft, StrafeRight]] {
            assert_eq!(speed(nowhere), 0.0, "{nowhere:?}");
        }
    }

    #[test]
    fn right_is_south_when_looking_east() {
        let east = Heading::from_degrees(0.0).unwrap();
        let strafe = [Intent::StrafeRight].into_iter().collect();
        assert_eq!(wanted_velocity(east, strafe), DVec2::new(0.0, WALK));
    }
}
