//! The body of a guard: turning, walking, climbing and falling.
//!
//! A guard collides with the world like the player, and also with everything that they avoid: edges
//! of high drops, water and spikes. In the middle of level floor, where nothing can be in the way,
//! a step is one addition. Elsewhere it is a [`slide`].

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ways::{DROP, Footing, Gait, GuardTerrain};
use crate::game::collision::{
    MovingBody, Obstacles, Radius, Stature, WorldObstacles, is_clear, slide,
};
use crate::game::fall::VerticalMotion;
use crate::game::player::STEP_HEIGHT;
use crate::game::rules::STEP;
use crate::world::{Cell, Heading, Outline, World};

/// The radius of all guards, in cells.
pub(crate) const RADIUS: Radius =
    Radius::new(0.25).expect("a quarter is between nothing and a half");

/// The maximum change of velocity in one step, in cells per second.
const ACCELERATION: f64 = 0.6;

/// The position and the motion of a guard.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct GuardMotion {
    pub(crate) body: MovingBody,
    /// The height of the feet, in cells.
    pub(crate) feet: f64,
    /// Cells per second, upwards.
    rising: f64,
    pub(crate) heading: Heading,
    /// The unit vector of the heading.
    #[serde(skip)]
    pub(crate) facing: DVec2,
}

impl GuardMotion {
    pub(crate) fn new(world: &World, cell: Cell, heading: Heading) -> Self {
        Self {
            body: MovingBody { position: cell.center(), velocity: DVec2::ZERO },
            feet: world.floor_at(cell),
            rising: 0.0,
            heading,
            facing: heading.direction(),
        }
    }

    /// The same motion, with `facing` computed from the heading.
    pub(crate) fn facing_ahead(self) -> Self {
        Self { facing: self.heading.direction(), ..self }
    }

    pub(crate) fn position(&self) -> DVec2 {
        self.body.position
    }

    /// The cell that contains the guard's centre.
    pub(crate) fn cell(&self) -> Cell {
        Cell::at(self.body.position)
    }

    /// Whether the guard neither falls nor flies.
    pub(crate) fn is_on_floor(&self) -> bool {
        self.rising == 0.0
    }

    /// Returns true if a guard who neither walks nor is pushed would not move.
    pub(crate) fn is_at_rest(&self, world: &World) -> bool {
        world.moving_tiles().is_empty()
            || self.rising == 0.0 && self.feet == world.floor_at(self.cell())
    }

    /// Turns towards `direction`, of any length but zero, by at most `degrees`.
    pub(crate) fn turn(&mut self, direction: DVec2, degrees: f64) {
        let across = self.facing.perp_dot(direction);
        let along = self.facing.dot(direction);
        if across == 0.0 && along >= 0.0 {
            return;
        }
        let angle = libm::atan2(across, along);
        let most = degrees.to_radians();
        self.heading = self.heading.turned(angle.clamp(-most, most));
        self.facing = self.heading.direction();
    }

    /// Accelerates towards the velocity `wanted`, and moves for `steps` steps.
    pub(crate) fn walk(&mut self, ground: &GuardWorld, wanted: DVec2, steps: u16) {
        let change = wanted - self.body.velocity;
        let most = ACCELERATION * f64::from(steps);
        let length = change.length();
        self.body.velocity =
            if length <= most { wanted } else { self.body.velocity + change * (most / length) };
        let displacement = self.body.velocity * (STEP * f64::from(steps));
        if displacement == DVec2::ZERO && self.rising == 0.0 && ground.is_at_rest(self) {
            return;
        }
        if self.rising == 0.0 && ground.is_free(self, displacement) {
            self.body.position += displacement;
        } else {
            self.slide(ground, displacement);
        }
    }

    /// The guard after a floor has moved under them. If the floor `carries` and they stood on it,
    /// they stay on it. Otherwise they are unchanged if they have room, and lifted if not. `None`
    /// if they have no room after the lift either.
    pub(crate) fn after_floor(&self, ground: &GuardWorld, carries: bool) -> Option<Self> {
        let ridden = if carries { self.ridden(ground) } else { None };
        let has_room = |motion: &Self| ground.has_room_for(motion);
        ridden.filter(has_room).or_else(|| Some(*self).filter(has_room)).or_else(|| {
            let place = WorldObstacles { step: STEP_HEIGHT, ..ground.place(self) };
            let feet = place.lifted(self.body.position, RADIUS)?;
            Some(Self { feet, rising: 0.0, ..*self })
        })
    }

    /// The guard on the floor, if the floor has moved by at most a step.
    fn ridden(&self, ground: &GuardWorld) -> Option<Self> {
        let feet = ground.highest_floor(self.body.position)?;
        let is_a_step = (feet - self.feet).abs() <= STEP_HEIGHT;
        (self.is_on_floor() && is_a_step).then_some(Self { feet, ..*self })
    }

    fn slide(&mut self, ground: &GuardWorld, displacement: DVec2) {
        let is_standing = self.rising == 0.0 && self.feet == ground.floor(self);
        let step = if is_standing { STEP_HEIGHT } else { 0.0 };
        let place = WorldObstacles { step, ..ground.place(self) };
        let mut careful = GuardObstacles { place, ground, avoids: true };
        careful.avoids = is_standing && careful.is_clear(self.body.position);
        self.body = slide(&mut careful, self.body, displacement, RADIUS);
        let place = careful.place;
        let room = place.room(self.body.position, RADIUS);
        let feet = place.stature.feet;
        if is_standing && feet - room.floor <= STEP_HEIGHT {
            (self.feet, self.rising) = (room.floor, 0.0);
        } else {
            let VerticalMotion { height, speed } =
                VerticalMotion { height: feet, speed: self.rising }.after(STEP, room);
            (self.feet, self.rising) = (height, speed);
        }
    }
}

/// The world for a guard who walks in it.
pub(crate) struct GuardWorld<'a> {
    pub(crate) world: &'a World,
    pub(crate) terrain: &'a GuardTerrain,
    pub(crate) gait: Gait,
}

impl GuardWorld<'_> {
    fn place(&self, motion: &GuardMotion) -> WorldObstacles<'_> {
        let stature = Stature { feet: motion.feet, height: self.gait.height };
        WorldObstacles {
            world: self.world,
            stature,
            step: 0.0,
            has_shapes: self.world.tile_facts().have_shapes,
            others: &[],
        }
    }

    /// The height of the floor under a guard.
    fn floor(&self, motion: &GuardMotion) -> f64 {
        self.place(motion).room(motion.body.position, RADIUS).floor
    }

    /// The highest floor under a guard at `position`.
    fn highest_floor(&self, position: DVec2) -> Option<f64> {
        let (low, high) = (position - RADIUS.cells(), position + RADIUS.cells());
        let cells = (low.y as u32..=high.y as u32)
            .flat_map(|row| (low.x as u32..=high.x as u32).map(move |column| Cell { column, row }));
        let footings = cells.filter_map(|cell| self.terrain.footing(self.world, cell));
        footings.map(|footing| footing.floor).reduce(f64::max)
    }

    /// Whether the body of a guard overlaps nothing.
    pub(crate) fn has_room_for(&self, motion: &GuardMotion) -> bool {
        self.place(motion).is_clear(motion.body.position, RADIUS)
    }

    /// Whether a guard who does not walk stays at their position, because the floor under them has
    /// not moved.
    fn is_at_rest(&self, motion: &GuardMotion) -> bool {
        self.is_free(motion, DVec2::ZERO) || motion.feet == self.floor(motion)
    }

    /// Whether a guard stands on level floor, and will still do so after `displacement` with
    /// nothing in the way.
    fn is_free(&self, motion: &GuardMotion, displacement: DVec2) -> bool {
        let radius = RADIUS.cells();
        let (from, to) = (motion.body.position, motion.body.position + displacement);
        let low = from.min(to) - radius;
        let high = from.max(to) + radius;
        if low.min_element() < 0.0 {
            return false;
        }
        let is_level = |cell| {
            let footing = self.terrain.way_through(self.world, self.gait, cell);
            footing.is_some_and(|it| it.floor == motion.feet && it.is_level_with(it))
        };
        (low.y as u32..=high.y as u32)
            .all(|row| (low.x as u32..=high.x as u32).all(|column| is_level(Cell { column, row })))
    }

    /// Whether a guard can walk straight from `from` to `to`: nothing is in the way, and they can
    /// climb all steps.
    pub(crate) fn is_straight(&self, from: DVec2, to: DVec2) -> bool {
        /// The distance between the tested positions, and the room around each of them, in cells.
        const STRIDE: f64 = 0.25;
        const ROOM: f64 = 0.3;
        let way = to - from;
        let count = (way.length() / STRIDE).ceil().max(1.0);
        let mut last = Cell::at(from);
        (0..=count as u32).all(|index| {
            let at = from + way * (f64::from(index) / count);
            let middle = Cell::at(at);
            let is_step = middle == last
                || self.terrain.leads(self.world, self.gait, last, middle)
                    && (middle.column == last.column || middle.row == last.row);
            let is_step = is_step || self.is_level_square(last, middle);
            last = middle;
            is_step && self.has_room(at, middle, ROOM)
        })
    }

    /// Whether all floors under a circle are within one step of the floor at its centre.
    fn has_room(&self, at: DVec2, middle: Cell, radius: f64) -> bool {
        let Some(floor) = self.terrain.footing(self.world, middle) else { return false };
        let (low, high) = (at - radius, at + radius);
        (low.y as u32..=high.y as u32).all(|row| {
            (low.x as u32..=high.x as u32).all(|column| {
                let cell = Cell { column, row };
                let footing = || self.terrain.way_through(self.world, self.gait, cell);
                let is_near = |it: Footing| (it.floor - floor.floor).abs() <= STEP_HEIGHT;
                cell == middle || footing().is_some_and(is_near)
            })
        })
    }

    /// Whether two diagonal neighbours and the two cells beside them are at one height.
    fn is_level_square(&self, one: Cell, other: Cell) -> bool {
        let corners = [
            other,
            Cell { column: one.column, row: other.row },
            Cell { column: other.column, row: one.row },
        ];
        let Some(here) = self.terrain.footing(self.world, one) else { return false };
        corners.into_iter().all(|cell| {
            let there = self.terrain.footing(self.world, cell);
            there.is_some_and(|there| here.is_level_with(there))
        })
    }
}

/// The obstacles for a guard: the place and, if the guard `avoids` hazards, everything that they
/// avoid.
struct GuardObstacles<'a> {
    place: WorldObstacles<'a>,
    ground: &'a GuardWorld<'a>,
    avoids: bool,
}

impl GuardObstacles<'_> {
    fn is_clear(&self, center: DVec2) -> bool {
        is_clear(self, center, RADIUS)
    }

    fn is_avoided(&self, cell: Cell) -> bool {
        let GuardWorld { world, terrain, .. } = *self.ground;
        let floor = terrain.footing(world, cell).map(|footing| footing.floor);
        floor.is_some_and(|floor| floor < self.place.stature.feet - DROP)
            || terrain.is_hazard(world, cell)
    }
}

impl Obstacles for GuardObstacles<'_> {
    fn blocks(&self, column: i64, row: i64) -> bool {
        let cell = (u32::try_from(column), u32::try_from(row));
        let (Ok(column_on_map), Ok(row_on_map)) = cell else { return true };
        let cell = Cell { column: column_on_map, row: row_on_map };
        self.place.blocks(column, row) || self.avoids && self.is_avoided(cell)
    }

    fn outline(&self, cell: Cell) -> Option<Outline> {
        self.place.outline(cell)
    }

    fn gives_way(&mut self, column: i64, row: i64, center: DVec2, radius: Radius) -> bool {
        let before = self.place.stature;
        let gives_way = self.place.gives_way(column, row, center, radius);
        if gives_way && self.avoids && !self.is_clear(center) {
            self.place.stature = before;
            return false;
        }
        gives_way
    }
}
