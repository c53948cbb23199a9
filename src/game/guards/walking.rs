//! Walking to a cell: straight if nothing is in the way, otherwise along the shortest path.
//!
//! Guards look a few cells ahead on their path and walk straight to the farthest cell that they can
//! reach this way, so they cut corners as people do. A guard who has not moved for a while walks
//! from cell to cell, exactly through the centres, which is always possible.

use glam::DVec2;

use super::context::{Context, GuardEffect};
use super::guard::{Guard, Route, STUCK_STEPS};
use super::ways::PathResult;
use crate::world::{Cell, TileKind};

/// At smaller distances from the centre of a cell, a guard has arrived, in cells.
const ARRIVED: f64 = 0.3;
/// At smaller distances from a point on the path, a guard continues to the next point, in cells.
const PASSED: f64 = 0.35;
/// The greatest distance of a goal that is tried in a straight line, in cells.
const MAX_STRAIGHT: f64 = 8.0;
/// The number of cells on a path that are tried in a straight line.
const AHEAD: usize = 4;
/// The maximum number of steps before a point is found again.
const MAX_PATH_AGE: u16 = 24;
/// The number of steps for which a guard who was stuck walks with care.
const CARE_STEPS: u16 = 120;
/// Guards wait for guards ahead of them who are nearer than this, in cells.
const GUARD_SPACING: f64 = 0.6;

/// The progress of a walk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum WalkProgress {
    There,
    OnTheWay,
    Impossible,
}

impl Guard {
    /// Wants to walk to the middle of `cell`.
    pub(crate) fn go_to(&mut self, context: &mut Context, cell: Cell, speed: f64) -> WalkProgress {
        self.go(context, cell, cell.center(), speed)
    }

    /// Wants to walk to `place`, which is in the cell `goal`.
    pub(crate) fn go(
        &mut self,
        context: &mut Context,
        goal: Cell,
        place: DVec2,
        speed: f64,
    ) -> WalkProgress {
        let position = self.motion.position();
        if position.distance_squared(place) < ARRIVED * ARRIVED {
            self.route = Route::default();
            return WalkProgress::There;
        }
        let cell = self.motion.cell();
        let is_passed =
            |point: DVec2| point != place && point.distance_squared(position) < PASSED * PASSED;
        if self.route.point.is_some_and(is_passed) {
            self.route.fresh = 0;
        }
        let is_stale = self.route.fresh == 0 || self.route.from != Some(cell);
        let is_unknown = is_stale || self.route.goal != Some(goal);
        if is_unknown && !self.find_point(context, cell, goal, place) {
            return WalkProgress::Impossible;
        }
        self.route.fresh = self.route.fresh.saturating_sub(context.stride);
        if let Some(point) = self.route.point {
            self.walk_to(context, point, speed);
        }
        WalkProgress::OnTheWay
    }

    /// Finds the point to walk to. Returns whether there may be a path.
    fn find_point(&mut self, context: &mut Context, cell: Cell, goal: Cell, place: DVec2) -> bool {
        let gait = self.gait();
        let position = self.motion.position();
        let ground = context.ground(gait);
        let is_careful = self.route.care > 0;
        let is_near = position.distance_squared(place) < MAX_STRAIGHT * MAX_STRAIGHT;
        self.route.from = Some(cell);
        if is_near && !is_careful && ground.is_straight(position, place) {
            (self.route.goal, self.route.point, self.route.fresh) =
                (Some(goal), Some(place), MAX_PATH_AGE);
            return true;
        }
        match context.ways.towards(context.world, context.terrain, gait, cell, goal) {
            PathResult::Here => self.route.point = Some(place),
            PathResult::Next(next) => {
                self.route.point = Some(self.farthest_straight(context, cell, next, goal));
            }
            // The search continues. Until it ends, the old point is as good as any.
            PathResult::Unknown => {
                self.route.fresh = 0;
                return true;
            }
            PathResult::Impossible => {
                self.route = Route { fresh: 0, ..Route::default() };
                return false;
            }
        }
        (self.route.goal, self.route.fresh) = (Some(goal), MAX_PATH_AGE);
        true
    }

    /// The centre of the farthest of the next cells that the guard can reach in a straight line.
    fn farthest_straight(&self, context: &Context, from: Cell, first: Cell, goal: Cell) -> DVec2 {
        let gait = self.gait();
        let position = self.motion.position();
        let ground = context.ground(gait);
        if self.route.care > 0 {
            return self.middle_first(from, first);
        }
        let mut point = None;
        let mut next = Some(first);
        for _ in 0..AHEAD {
            let Some(cell) = next.filter(|cell| ground.is_straight(position, cell.center())) else {
                break;
            };
            point = Some(cell.center());
            next = context.ways.after(context.world, context.terrain, gait, cell, goal);
        }
        point.unwrap_or_else(|| self.middle_first(from, first))
    }

    /// The centre of the next cell, or of the guard's own cell first if the guard has strayed from
    /// the line.
    fn middle_first(&self, from: Cell, next: Cell) -> DVec2 {
        let (middle, position) = (from.center(), self.motion.position());
        let way = next.center() - middle;
        let off = (position - middle).perp_dot(way).abs() / way.length();
        let is_behind = (position - middle).dot(way) < 0.0;
        if off > 0.08 && !is_behind || off > 0.2 { middle } else { next.center() }
    }

    /// Walks to `point`. Waits for doors, and for guards who are in the way.
    pub(crate) fn walk_to(&mut self, context: &mut Context, point: DVec2, speed: f64) {
        let way = point - self.motion.position();
        let Some(direction) = way.try_normalize() else { return };
        let closed = self.closed_door_ahead(context, direction);
        if let Some(door) = closed {
            self.look = Some(door.center() - self.motion.position());
            if self.gait().opens_doors {
                context.effects.push(GuardEffect::Open(door));
            }
            self.route.fresh = 0;
            return;
        }
        let is_moving = self.motion.body.velocity.length_squared() > 0.01;
        let still = if is_moving { 0 } else { self.route.still + context.stride };
        self.route.still = still;
        self.route.care = self.route.care.saturating_sub(context.stride);
        if still > STUCK_STEPS {
            (self.route.still, self.route.care, self.route.fresh) = (0, CARE_STEPS, 0);
        }
        if self.route.care == 0 && self.is_in_the_way(context, direction) {
            return;
        }
        // Limits the speed so that this step does not go beyond the point.
        let most = way.length() * 60.0 / f64::from(context.stride.max(1));
        self.wanted = direction * speed.min(most.max(0.3));
    }

    /// The closed door that the guard is about to walk into.
    fn closed_door_ahead(&self, context: &Context, direction: DVec2) -> Option<Cell> {
        let ahead = self.motion.position() + direction * 0.7;
        let cell = Cell::at(ahead);
        let kind = context.world.tile_in(cell)?.kind;
        matches!(kind, TileKind::Door(_)).then_some(cell)
    }

    /// Whether another guard is close ahead of this one. If two guards meet, the guard with the
    /// lower index goes on.
    fn is_in_the_way(&self, context: &Context, direction: DVec2) -> bool {
        let position = self.motion.position();
        context.others.iter().enumerate().any(|(index, other)| {
            let way = other.position - position;
            way.length_squared() < GUARD_SPACING * GUARD_SPACING
                && index != context.index
                && !other.is_down
                && (other.feet - self.motion.feet).abs() < 1.0
                && way.dot(direction) > 0.3 * way.length()
                && index < context.index
        })
    }
}
