//! What the rest of the game asks of guards, and does to them.

use glam::DVec2;

use super::act::{Act, Cloud};
use super::guard::Guard;
use super::mover::{Ground, RADIUS};
use super::sight::{Point, is_in_sight};
use super::state::State;
use super::{Alarm, GuardView, Guards, Mood};
use crate::game::collision::overlaps;
use crate::game::sound::{Sound, SoundKind, Source};
use crate::generate::Shift;
use crate::world::{Cell, Figure, GuardKind, Lamp, Light, Reach, World};

/// How far a fall is heard, in cells.
const FALL: u8 = 6;
/// How near to the middle of a guard a projectile hits, in cells.
const HIT: f64 = 0.35;

impl Guards {
    /// Whether there are none.
    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// What guards have done in the last step, by its place in their order.
    pub(crate) fn act(&self, index: usize) -> Option<Act> {
        self.acts.get(index).copied()
    }

    /// The number of steps in which no guard does anything, if nothing is perceived: 0 if anybody
    /// is awake, `None` if all sleep.
    pub(crate) fn quiet_steps(&self) -> Option<u64> {
        // Only a step fills what guards remember of each other and of the players.
        let has_begun = self.steps > 0 || self.list.is_empty();
        if !has_begun || self.has_changed || !self.acts.is_empty() || !self.spoken.is_empty() {
            return Some(0);
        }
        let quiet = self.awake().filter_map(|guard| match guard.state {
            State::Asleep if guard.stagger == 0 => None,
            State::Down { left } => Some(u64::from(left) - 1),
            _ => Some(0),
        });
        quiet.min()
    }

    /// Advances the clocks by `steps`, at most [`Guards::quiet_steps`].
    pub(crate) fn wait(&mut self, steps: u64) {
        if self.list.is_empty() {
            return;
        }
        let before = self.steps;
        self.steps += steps;
        self.ways.wait(steps);
        self.trails.iter_mut().for_each(|trail| trail.wait(before, self.steps));
        for guard in &mut self.list {
            if let State::Down { left } = &mut guard.state {
                *left = left.saturating_sub(u16::try_from(steps).unwrap_or(u16::MAX)).max(1);
            }
        }
    }

    /// Whether anything that a picture shows of guards has changed in the last step.
    pub(crate) fn has_changed(&self) -> bool {
        self.has_changed
    }

    /// The guards, in the order of their indices.
    pub(crate) fn views(&self) -> impl ExactSizeIterator<Item = GuardView> + '_ {
        self.list.iter().map(Guard::view)
    }

    /// The guards as a picture shows them.
    pub(crate) fn figures(&self) -> impl Iterator<Item = Figure> + '_ {
        self.list.iter().filter_map(|guard| {
            let sprite = self.sprites[guard.kind as usize]?;
            let (position, heading) = (guard.mover.position(), guard.mover.heading);
            let (base, frame) = (guard.mover.feet, guard.frame());
            Some(Figure { sprite, position, base, heading, frame, opacity: u8::MAX })
        })
    }

    /// The number of [`Guards::figures`].
    pub(crate) fn figure_count(&self) -> usize {
        self.awake.figures
    }

    /// The lamps that guards carry.
    pub(crate) fn lamps(&self) -> impl Iterator<Item = (Cell, Lamp)> + Clone + '_ {
        let bearers = self.awake().filter(|guard| guard.kind == GuardKind::Lantern);
        let up = bearers.filter(|guard| !guard.state.is_down() && guard.state != State::Asleep);
        let light = Light::new(0.7).unwrap_or(Light::FULL);
        up.map(move |guard| (guard.mover.cell(), Lamp { light, reach: Reach::default() }))
    }

    /// How much the guards know.
    pub(crate) fn alarm(&self) -> Alarm {
        self.alarm
    }

    /// Whether the guard `index` neither follows nor looks for a player, and is not down.
    pub(crate) fn is_unaware(&self, index: usize) -> bool {
        self.list.get(index).is_some_and(|guard| {
            let mood = guard.state.mood();
            matches!(mood, Mood::Asleep | Mood::OnDuty | Mood::Wondering | Mood::Returning)
        })
    }

    /// Whether `from` is behind the guard `index`: more than 90° off the direction of their look.
    pub(crate) fn is_behind(&self, index: usize, from: DVec2) -> bool {
        let guard = self.list.get(index);
        guard.is_some_and(|it| it.mover.facing.dot(from - it.mover.position()) < 0.0)
    }

    /// The number of guards.
    pub(crate) fn count(&self) -> usize {
        self.list.len()
    }

    /// The guards, sounds and cells that the last step looked at.
    pub(crate) fn work(&self) -> u64 {
        *self.work
    }

    /// The cells of all guards.
    pub(crate) fn cells(&self) -> impl Iterator<Item = Cell> {
        self.list.iter().map(|guard| guard.mover.cell())
    }

    /// Whether any guard would overlap `cell` if it were solid: a door does not close on them.
    pub(crate) fn touches(&self, cell: Cell) -> bool {
        self.list.iter().any(|guard| overlaps(guard.mover.position(), cell, RADIUS))
    }

    /// Whether any guard stands in `cell`: plates and floors that crumble feel it.
    pub(crate) fn weighs_on(&self, cell: Cell) -> bool {
        self.list.iter().any(|guard| guard.mover.cell() == cell && guard.mover.is_on_floor())
    }

    /// The positions of the guards who are awake and on their feet, nearer than `distance` to
    /// `position`, and with a part of their body between the heights `feet` and `head`.
    pub(crate) fn touching(
        &self,
        position: DVec2,
        distance: f64,
        feet: f64,
        head: f64,
    ) -> impl Iterator<Item = DVec2> {
        let up = self.awake().filter(|guard| !guard.is_asleep() && !guard.state.is_down());
        let level = up.filter(move |guard| guard.mover.feet < head && feet < guard.head());
        let positions = level.map(|guard| guard.mover.position());
        positions.filter(move |at| at.distance_squared(position) < distance * distance)
    }

    /// The nearest guard who is not down, whose middle is at most `reach` from `position` and at
    /// most the angle with the cosine `least_cosine` off `direction`, a unit vector. Nothing is
    /// between the two at the height of the middle of the guard.
    pub(crate) fn guard_near(
        &self,
        world: &World,
        position: DVec2,
        direction: DVec2,
        reach: f64,
        least_cosine: f64,
    ) -> Option<usize> {
        let near = self.ahead(position, direction, least_cosine);
        let near = near.filter(|&(distance, guard, _)| {
            let to = guard.middle();
            distance <= reach && is_in_sight(world, &[], Point { position, ..to }, to)
        });
        Some(near.min_by(|one, other| one.0.total_cmp(&other.0))?.2)
    }

    /// The middle of the body of the nearest guard in sight of an eye, at most the angle with the
    /// cosine `least_cosine` off `direction`, a unit vector: the position and the height.
    pub(crate) fn aim(
        &self,
        world: &World,
        clouds: &[Cloud],
        eye: (DVec2, f64),
        direction: DVec2,
        least_cosine: f64,
    ) -> Option<(DVec2, f64)> {
        let eye = Point { position: eye.0, height: eye.1 };
        let ahead = self.ahead(eye.position, direction, least_cosine);
        let seen = ahead.filter(|(_, guard, _)| is_in_sight(world, clouds, eye, guard.middle()));
        let Point { position, height } =
            seen.min_by(|one, other| one.0.total_cmp(&other.0))?.1.middle();
        Some((position, height))
    }

    /// The guards who are not down in a cone, with their distances and indices.
    fn ahead(
        &self,
        position: DVec2,
        direction: DVec2,
        least_cosine: f64,
    ) -> impl Iterator<Item = (f64, &Guard, usize)> {
        let up = self.list.iter().zip(0..).filter(|(guard, _)| !guard.state.is_down());
        up.filter_map(move |(guard, index)| {
            let way = guard.mover.position() - position;
            let distance = way.length();
            let is_ahead = direction.dot(way) >= least_cosine * distance;
            is_ahead.then_some((distance, guard, index))
        })
    }

    /// The guard whom a projectile hits that moves from `from` to `to`, the nearest to `from`; both
    /// have a position and a height.
    pub(crate) fn hit_between(&self, from: (DVec2, f64), to: (DVec2, f64)) -> Option<usize> {
        let way = to.0 - from.0;
        let length_squared = way.length_squared();
        let hits = self.list.iter().zip(0..).filter_map(|(guard, index)| {
            let offset = guard.mover.position() - from.0;
            let along = if length_squared > 0.0 { offset.dot(way) / length_squared } else { 0.0 };
            let along = along.clamp(0.0, 1.0);
            let height = from.1 + (to.1 - from.1) * along;
            let is_hit = (way * along).distance_squared(offset) <= HIT * HIT
                && (guard.mover.feet..=guard.head()).contains(&height)
                && !guard.state.is_down();
            is_hit.then_some((along, index))
        });
        Some(hits.min_by(|one, other| one.0.total_cmp(&other.0))?.1)
    }

    /// Lays the guard `index` on the floor for that many steps.
    pub(crate) fn stun(&mut self, index: usize, steps: u16) {
        let Some(guard) = self.list.get_mut(index) else { return };
        guard.stun(steps);
        let (cell, by) = (guard.mover.cell(), Source::Guard(index));
        self.find_awake();
        self.spoken.push(Sound { kind: SoundKind::Fall, cell, reach: FALL, by });
    }

    /// Pushes the guard `index` along `direction`, a unit vector: they stagger for half a second,
    /// and lose the blow that they were raising.
    pub(crate) fn push(&mut self, index: usize, direction: DVec2) {
        if let Some(guard) = self.list.get_mut(index) {
            guard.push(direction);
            self.find_awake();
        }
    }

    /// Whether a guard has no room after the floor of `cell` has moved.
    pub(crate) fn are_crushed(&self, world: &World, cell: Cell, carries: bool) -> bool {
        self.list.iter().any(|guard| {
            let ground = Ground { world, terrain: &self.terrain, gait: guard.gait() };
            overlaps(guard.mover.position(), cell, RADIUS)
                && guard.mover.after_floor(&ground, carries).is_none()
        })
    }

    /// Records that the floor of `cell` has just moved. If it carries, the guards who stand on it stay
    /// on it.
    pub(crate) fn floor_moved(&mut self, world: &World, cell: Cell, carries: bool) {
        let mut has_unsettled = false;
        for guard in &mut self.list {
            if overlaps(guard.mover.position(), cell, RADIUS) {
                let ground = Ground { world, terrain: &self.terrain, gait: guard.gait() };
                guard.mover = guard.mover.after_floor(&ground, carries).unwrap_or(guard.mover);
                has_unsettled |= guard.is_asleep() && !guard.is_unsettled;
                guard.is_unsettled = true;
            }
        }
        if has_unsettled {
            self.find_awake();
        }
    }

    /// Forgets the player with that index, who has left.
    pub(crate) fn forget_player(&mut self, index: usize) {
        for guard in &mut self.list {
            guard.quarry = guard.quarry.filter(|quarry| quarry.target != index);
        }
        if let Some(trail) = self.trails.get_mut(index) {
            trail.forget();
        }
    }

    /// Moves all guards with the window of a generated level. Those outside it are gone, and those
    /// of parts that have come into it are there.
    pub(crate) fn shift(&mut self, world: &World, shift: Shift) {
        self.list.retain_mut(|guard| guard.shift(shift));
        let is_new = |cell: Cell| shift.is_new(cell);
        let posts = world.guards().iter().zip(0..);
        let posts =
            posts.filter(|(post, _)| post.from <= self.rules.difficulty && is_new(post.cell));
        let seed = crate::rng::hash(self.rules.seed, [self.steps]);
        self.list.extend(posts.map(|(post, index)| Guard::new(world, post, index, seed)));
        self.terrain.look_at_things(world);
        self.others.clear();
        self.find_awake();
        self.ways.forget();
        self.air.forget();
        self.trails.iter_mut().for_each(super::Trail::forget);
        self.spoken.clear();
    }
}

impl Guard {
    /// The middle of the body.
    fn middle(&self) -> Point {
        let height = self.mover.feet + self.kind.height() / 2.0;
        Point { position: self.mover.position(), height }
    }
}
