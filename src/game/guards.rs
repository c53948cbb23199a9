//! Guards: they stand, patrol, notice, search, chase, strike, give up and fall.
//!
//! A step of all guards depends only on the world, on the perceptible state of the players, and on
//! the sounds of the step. Guards share their path searches, and call each other by sounds that
//! spread like any other.
//!
//! Guards far from all players take [`FAR_STRIDE`] steps at once. Rejected: simulating only the
//! guards in view. A patrol would stop whenever the player looks away.

mod behavior;
mod context;
mod guard;
mod kind;
mod movement;
mod perception;
mod trail;
mod walking;
mod ways;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::collision::overlaps;
use super::rules::MAX_PLAYERS;
use super::rules::Rules;
use super::scratch::Scratch;
use super::sight::{Cloud, Point, is_in_sight};
use super::sound::{Sound, SoundField, SoundKind, Source};
use super::stored::{OfLevel, RestoreError, at_most, check};
use crate::generate::WindowShift;
use crate::rng::hash;
use crate::world::sprite::builtin;
use crate::world::{Cell, Figure, GuardKind, Lamp, Light, Reach, SpriteId, World};
use context::{Context, PerceivedGuard};
use guard::{Guard, GuardActivity};
use movement::{GuardWorld, RADIUS};
use trail::Trail;
use ways::{GuardPaths, GuardTerrain};

pub(crate) use context::{GuardEffect, PerceivedPlayer};
pub use guard::{Alarm, GuardView, Mood};

/// Guards on duty who are at least this far from all players, in cells, take several steps at once.
const FAR: f64 = 26.0;
const FAR_STRIDE: u16 = 8;
/// The number of steps from one check for fallen guards to the next.
const FALLEN_EACH: u64 = 30;
/// The number of cells over which sounds spread to guards in one step. Once it is reached, guards
/// do not hear the remaining sounds of that step.
const MAX_SOUND_CELLS: usize = 16_384;

/// The distance at which a fall is heard, in cells.
const FALL: u8 = 6;
/// A projectile hits a guard if it passes within this distance of their centre, in cells.
const HIT: f64 = 0.35;
/// All guards of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guards {
    #[serde(skip)]
    rules: Rules,
    list: Vec<Guard>,
    #[serde(skip)]
    awake: AwakeGuards,
    /// Indexed by the order of [`GuardKind::ALL`].
    #[serde(skip)]
    sprites: [Option<SpriteId>; GuardKind::ALL.len()],
    #[serde(skip)]
    terrain: GuardTerrain,
    ways: GuardPaths,
    sound_field: SoundField,
    #[serde(deserialize_with = "at_most::<MAX_PLAYERS, _, _>")]
    trails: Vec<Trail>,
    #[serde(skip)]
    others: Scratch<Vec<PerceivedGuard>>,
    /// The number of cells over which sounds have spread in this step.
    #[serde(skip)]
    sound_cells: Scratch<usize>,
    /// The number of guards, sounds and cells that the last step examined.
    #[serde(skip)]
    work: Scratch<u64>,
    effects: Vec<GuardEffect>,
    /// The sounds that guards made in the last step.
    spoken: Vec<Sound>,
    /// Empty between steps.
    #[serde(skip)]
    woken: Vec<usize>,
    steps: u64,
    alarm: Alarm,
    has_changed: bool,
}

/// The guards who are awake. A step examines only these guards, so a sleeping guard costs nothing
/// until a sound or a push wakes them. A guard who sleeps on a floor that has moved counts as
/// awake, because they may fall.
///
/// A guard who has woken never sleeps again. Therefore the list is rebuilt only when a guard wakes
/// or the level changes, not in each step.
#[derive(Clone, Debug, PartialEq, Default)]
struct AwakeGuards {
    /// The indices of the guards who do not sleep, in ascending order.
    indices: Vec<usize>,
    /// Whether the level has hounds, awake or asleep.
    has_hounds: bool,
    /// The number of guards that have a sprite.
    figures: usize,
}

impl Guards {
    /// The guards that `world` has under these rules. Their sprites are added to `world`.
    pub(crate) fn new(world: &mut World, rules: Rules) -> Self {
        let posts = world.guards().iter().zip(0..);
        let posts = posts.filter(|(post, _)| post.from <= rules.difficulty);
        let list: Vec<Guard> =
            posts.map(|(post, index)| Guard::new(world, post, index, rules.seed)).collect();
        let is_needed = |kind| list.iter().any(|guard| guard.kind == kind);
        let sprites = GuardKind::ALL.map(|kind| {
            let sprite = is_needed(kind).then(|| builtin::named(kind.name()))??;
            Some(world.add_sprite(sprite))
        });
        let mut guards = Self {
            rules,
            list,
            awake: AwakeGuards::default(),
            sprites,
            terrain: GuardTerrain::new(world),
            ways: GuardPaths::default(),
            sound_field: SoundField::default(),
            trails: Vec::new(),
            others: Scratch::default(),
            sound_cells: Scratch::default(),
            work: Scratch::default(),
            effects: Vec::new(),
            spoken: Vec::new(),
            woken: Vec::new(),
            steps: 0,
            alarm: Alarm::Calm,
            has_changed: false,
        };
        guards.find_awake();
        guards
    }

    /// Returns true if a guard who is awake could see `point` by looking that way, however dark it
    /// is there.
    pub(crate) fn may_see(&self, world: &World, point: Point) -> bool {
        self.list.iter().any(|guard| guard.may_see(world, point))
    }

    /// Advances all guards by one step. The index of a target is the index of its player. `sounds`
    /// are the sounds of this step that no guard made.
    pub(crate) fn step(
        &mut self,
        world: &World,
        targets: &[PerceivedPlayer],
        sounds: &[Sound],
        clouds: &[Cloud],
    ) -> &[GuardEffect] {
        self.effects.clear();
        (*self.work, *self.sound_cells) = (0, 0);
        if self.list.is_empty() {
            return &self.effects;
        }
        self.steps += 1;
        self.ways.begin_step();
        self.look_at_others();
        self.record_trails(world, targets);
        let mut spoken = std::mem::take(&mut self.spoken);
        for sound in sounds.iter().chain(&spoken) {
            if *self.sound_cells < MAX_SOUND_CELLS {
                self.spread(world, targets, clouds, sound);
            }
        }
        let heard = (sounds.len() + spoken.len()) * self.list.len();
        spoken.clear();
        self.has_changed = false;
        for place in 0..self.awake.indices.len() {
            self.step_one(world, targets, clouds, self.awake.indices[place]);
        }
        for index in self.woken.drain(..) {
            self.list[index].get_up();
        }
        let made = self.effects.iter().filter_map(|effect| match effect {
            GuardEffect::Sound(sound) => Some(*sound),
            _ => None,
        });
        spoken.extend(made);
        self.spoken = spoken;
        self.update_alarm();
        *self.work = (self.awake.indices.len() + heard + *self.sound_cells) as u64;
        &self.effects
    }

    fn step_one(
        &mut self,
        world: &World,
        targets: &[PerceivedPlayer],
        clouds: &[Cloud],
        index: usize,
    ) {
        let stride = self.stride(world, targets, index);
        if stride == 0 {
            return;
        }
        let now = self.steps;
        let (guard, mut context) = self.with_context(world, targets, clouds, index, stride);
        let before = (guard.motion, guard.frame());
        if (now + index as u64).is_multiple_of(FALLEN_EACH) && stride == 1 {
            guard.look_for_fallen(&mut context);
        }
        guard.step(&mut context);
        self.has_changed |= (guard.motion, guard.frame()) != before;
    }

    /// The number of steps that a guard takes at once now: 0 while they wait for their turn.
    fn stride(&self, world: &World, targets: &[PerceivedPlayer], index: usize) -> u16 {
        let guard = &self.list[index];
        match guard.state {
            // A floor may have moved under the guard.
            GuardActivity::Asleep if guard.stagger == 0 => {
                u16::from(!guard.motion.is_at_rest(world))
            }
            GuardActivity::OnDuty | GuardActivity::Returning => {
                let position = guard.motion.position();
                let is_near = |target: &PerceivedPlayer| {
                    target.position.distance_squared(position) < FAR * FAR && target.is_noticeable
                };
                let is_turn = (self.steps + index as u64).is_multiple_of(u64::from(FAR_STRIDE));
                match targets.iter().any(is_near) {
                    true => 1,
                    false if is_turn => FAR_STRIDE,
                    false => 0,
                }
            }
            _ => 1,
        }
    }

    /// Lets all guards within reach hear `sound`.
    fn spread(
        &mut self,
        world: &World,
        targets: &[PerceivedPlayer],
        clouds: &[Cloud],
        sound: &Sound,
    ) {
        let told = match sound.by {
            Source::Guard(index) => self.list.get(index).and_then(|guard| guard.quarry),
            Source::Player(_) | Source::Object => None,
        };
        let mut has_woken = false;
        for index in 0..self.list.len() {
            let guard = &self.list[index];
            let earshot = guard.earshot(sound, self.rules.difficulty);
            let way = guard.motion.position().distance(sound.cell.center());
            // No path is shorter than the straight line. Two cells are added for rounding.
            if earshot == 0 || way * 2.0 > f64::from(earshot) + 4.0 {
                continue;
            }
            if sound.by == Source::Guard(index) {
                continue;
            }
            *self.sound_cells += self.sound_field.reach_out(world, sound.cell, earshot, self.steps);
            let distance = self.sound_field.distance(guard.motion.cell());
            if let Some(distance) = distance.filter(|&distance| distance <= earshot) {
                let (guard, mut context) = self.with_context(world, targets, clouds, index, 1);
                let was_asleep = guard.is_asleep();
                guard.hear(&mut context, sound, (distance, earshot), told);
                has_woken |= was_asleep && !guard.is_asleep();
            }
        }
        if has_woken {
            self.find_awake();
        }
    }

    fn with_context<'a>(
        &'a mut self,
        world: &'a World,
        targets: &'a [PerceivedPlayer],
        clouds: &'a [Cloud],
        index: usize,
        stride: u16,
    ) -> (&'a mut Guard, Context<'a>) {
        let context = Context {
            world,
            terrain: &self.terrain,
            ways: &mut self.ways,
            targets,
            clouds,
            trails: &self.trails,
            others: &self.others,
            rules: self.rules,
            now: self.steps,
            index,
            stride,
            effects: &mut self.effects,
            woken: &mut self.woken,
        };
        (&mut self.list[index], context)
    }

    /// Records the trails of players if there are hounds to smell them.
    fn record_trails(&mut self, world: &World, targets: &[PerceivedPlayer]) {
        if self.awake.has_hounds {
            self.trails.resize_with(targets.len(), Trail::default);
            let trails = self.trails.iter_mut().zip(targets);
            for (trail, target) in trails.filter(|(_, target)| target.is_noticeable) {
                trail.record(world, target.cell(), self.steps);
            }
        }
    }

    fn update_alarm(&mut self) {
        let alarm = self.awake().map(|guard| guard.state.mood().alarm()).max().unwrap_or_default();
        if alarm == Alarm::Raised && self.alarm < Alarm::Raised {
            self.effects.push(GuardEffect::Raised);
        }
        self.alarm = alarm;
    }

    /// Returns an error if a step could fail in this state.
    pub(crate) fn check(&self, world: &World) -> Result<(), RestoreError> {
        let map = (world.grid().width(), world.grid().height());
        self.ways.check(map)?;
        check(self.sound_field.is_possible(map), "the search of a sound")?;
        self.trails.iter().try_for_each(|trail| trail.check(self.steps))?;
        self.list.iter().try_for_each(|guard| guard.check(world, self.list.len()))
    }
}

impl Guards {
    /// Rebuilds the list of guards who are awake.
    fn find_awake(&mut self) {
        let guards = self.list.iter().enumerate();
        let awake = guards.filter(|(_, guard)| !guard.is_asleep() || guard.is_unsettled);
        let indices = &mut self.awake.indices;
        indices.clear();
        indices.extend(awake.map(|(index, _)| index));
        self.awake.has_hounds = self.list.iter().any(|guard| guard.kind == GuardKind::Hound);
        self.awake.figures = self.figures().count();
    }

    /// The guards who are awake.
    pub(crate) fn awake(&self) -> impl Iterator<Item = &Guard> + Clone {
        self.awake.indices.iter().map(|&index| &self.list[index])
    }

    /// Records the positions of all guards. Guards who sleep have not moved since the last step.
    fn look_at_others(&mut self) {
        if self.others.len() != self.list.len() {
            self.others.clear();
            self.others.extend(self.list.iter().map(Guard::as_other));
            return;
        }
        for &index in &self.awake.indices {
            self.others[index] = self.list[index].as_other();
        }
    }
}

/// Queries and effects for the rest of the game.
impl Guards {
    /// Whether the level has no guards.
    pub(crate) fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// The effect at this index in the order of the last step's effects.
    pub(crate) fn effect(&self, index: usize) -> Option<GuardEffect> {
        self.effects.get(index).copied()
    }

    /// Returns true if all guards sleep, so that none acts before they perceive something.
    pub(crate) fn are_at_rest(&self) -> bool {
        // The first step fills the guards' records of each other and of the players.
        let has_begun = self.steps > 0 || self.list.is_empty();
        has_begun
            && !self.has_changed
            && self.effects.is_empty()
            && self.spoken.is_empty()
            && self.awake().all(Guard::is_asleep)
    }

    /// Advances the clocks by `steps` steps in which all guards are at rest.
    pub(crate) fn wait(&mut self, steps: u64) {
        if self.list.is_empty() {
            return;
        }
        let before = self.steps;
        self.steps += steps;
        self.ways.wait(steps);
        self.trails.iter_mut().for_each(|trail| trail.wait(before, self.steps));
    }

    /// Whether the last step changed anything about guards that a frame shows.
    pub(crate) fn has_changed(&self) -> bool {
        self.has_changed
    }

    /// The guards, in the order of their indices.
    pub(crate) fn views(&self) -> impl ExactSizeIterator<Item = GuardView> + '_ {
        self.list.iter().map(Guard::view)
    }

    /// The guards as figures.
    pub(crate) fn figures(&self) -> impl Iterator<Item = Figure> + '_ {
        self.list.iter().filter_map(|guard| {
            let sprite = self.sprites[guard.kind as usize]?;
            let (position, heading) = (guard.motion.position(), guard.motion.heading);
            let (base, frame) = (guard.motion.feet, guard.frame());
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
        let up =
            bearers.filter(|guard| !guard.state.is_down() && guard.state != GuardActivity::Asleep);
        let light = Light::new(0.7).unwrap_or(Light::FULL);
        up.map(move |guard| (guard.motion.cell(), Lamp { light, reach: Reach::default() }))
    }

    /// The highest alarm of any guard.
    pub(crate) fn alarm(&self) -> Alarm {
        self.alarm
    }

    /// Returns true if the guard `index` neither follows nor searches for a player, and is not
    /// down.
    pub(crate) fn is_unaware(&self, index: usize) -> bool {
        self.list.get(index).is_some_and(|guard| {
            let mood = guard.state.mood();
            matches!(mood, Mood::Asleep | Mood::OnDuty | Mood::Wondering | Mood::Returning)
        })
    }

    /// Returns true if `from` is behind the guard `index`: more than 90° from the direction in
    /// which they look.
    pub(crate) fn is_behind(&self, index: usize, from: DVec2) -> bool {
        let guard = self.list.get(index);
        guard.is_some_and(|it| it.motion.facing.dot(from - it.motion.position()) < 0.0)
    }

    /// The number of guards.
    pub(crate) fn count(&self) -> usize {
        self.list.len()
    }

    /// The number of guards, sounds and cells that the last step examined.
    pub(crate) fn work(&self) -> u64 {
        *self.work
    }

    /// The cells of all guards.
    pub(crate) fn cells(&self) -> impl Iterator<Item = Cell> {
        self.list.iter().map(|guard| guard.motion.cell())
    }

    /// Returns true if any guard would overlap `cell` if it were solid. A door does not close on
    /// them.
    pub(crate) fn touches(&self, cell: Cell) -> bool {
        self.list.iter().any(|guard| overlaps(guard.motion.position(), cell, RADIUS))
    }

    /// Returns true if any guard stands in `cell`. Their weight acts on plates and on floors that
    /// crumble.
    pub(crate) fn weighs_on(&self, cell: Cell) -> bool {
        self.list.iter().any(|guard| guard.motion.cell() == cell && guard.motion.is_on_floor())
    }

    /// The positions of the guards who are awake and on their feet, are nearer than `distance` to
    /// `position`, and have part of their body between the heights `feet` and `head`.
    pub(crate) fn touching(
        &self,
        position: DVec2,
        distance: f64,
        feet: f64,
        head: f64,
    ) -> impl Iterator<Item = DVec2> {
        let up = self.awake().filter(|guard| !guard.is_asleep() && !guard.state.is_down());
        let level = up.filter(move |guard| guard.motion.feet < head && feet < guard.head());
        let positions = level.map(|guard| guard.motion.position());
        positions.filter(move |at| at.distance_squared(position) < distance * distance)
    }

    /// The nearest guard who is not down, has their centre within `reach` of `position`, and is
    /// within the angle of cosine `least_cosine` of `direction`, a unit vector. Nothing may be
    /// between the two at the height of the guard's middle.
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

    /// The middle of the body of the nearest guard visible from `eye`, as a position and a height.
    /// The guard is within the angle of cosine `least_cosine` of `direction`, a unit vector.
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

    /// The guards in a cone who are not down, with their distances and indices.
    fn ahead(
        &self,
        position: DVec2,
        direction: DVec2,
        least_cosine: f64,
    ) -> impl Iterator<Item = (f64, &Guard, usize)> {
        let up = self.list.iter().zip(0..).filter(|(guard, _)| !guard.state.is_down());
        up.filter_map(move |(guard, index)| {
            let way = guard.motion.position() - position;
            let distance = way.length();
            let is_ahead = direction.dot(way) >= least_cosine * distance;
            is_ahead.then_some((distance, guard, index))
        })
    }

    /// The first guard hit by a projectile that moves from `from` to `to`. Both are a position and
    /// a height.
    pub(crate) fn hit_between(&self, from: (DVec2, f64), to: (DVec2, f64)) -> Option<usize> {
        let way = to.0 - from.0;
        let length_squared = way.length_squared();
        let hits = self.list.iter().zip(0..).filter_map(|(guard, index)| {
            let offset = guard.motion.position() - from.0;
            let along = if length_squared > 0.0 { offset.dot(way) / length_squared } else { 0.0 };
            let along = along.clamp(0.0, 1.0);
            let height = from.1 + (to.1 - from.1) * along;
            let is_hit = (way * along).distance_squared(offset) <= HIT * HIT
                && (guard.motion.feet..=guard.head()).contains(&height)
                && !guard.state.is_down();
            is_hit.then_some((along, index))
        });
        Some(hits.min_by(|one, other| one.0.total_cmp(&other.0))?.1)
    }

    /// Lays the guard `index` on the floor for `steps` steps.
    pub(crate) fn stun(&mut self, index: usize, steps: u16) {
        let Some(guard) = self.list.get_mut(index) else { return };
        guard.stun(steps);
        let (cell, by) = (guard.motion.cell(), Source::Guard(index));
        self.find_awake();
        self.spoken.push(Sound { kind: SoundKind::Fall, cell, reach: FALL, by });
    }

    /// Pushes the guard `index` along `direction`, a unit vector. The guard staggers for half a
    /// second, and an attack in progress is cancelled.
    pub(crate) fn push(&mut self, index: usize, direction: DVec2) {
        if let Some(guard) = self.list.get_mut(index) {
            guard.push(direction);
            self.find_awake();
        }
    }

    /// Returns true if a guard has no room after the floor of `cell` has moved.
    pub(crate) fn are_crushed(&self, world: &World, cell: Cell, carries: bool) -> bool {
        self.list.iter().any(|guard| {
            let ground = GuardWorld { world, terrain: &self.terrain, gait: guard.gait() };
            overlaps(guard.motion.position(), cell, RADIUS)
                && guard.motion.after_floor(&ground, carries).is_none()
        })
    }

    /// Records that the floor of `cell` has just moved. If `carries` is true, guards who stand on
    /// the floor stay on it.
    pub(crate) fn floor_moved(&mut self, world: &World, cell: Cell, carries: bool) {
        let mut has_unsettled = false;
        for guard in &mut self.list {
            if overlaps(guard.motion.position(), cell, RADIUS) {
                let ground = GuardWorld { world, terrain: &self.terrain, gait: guard.gait() };
                guard.motion = guard.motion.after_floor(&ground, carries).unwrap_or(guard.motion);
                has_unsettled |= guard.is_asleep() && !guard.is_unsettled;
                guard.is_unsettled = true;
            }
        }
        if has_unsettled {
            self.find_awake();
        }
    }

    /// Forgets the player with this index, who has left.
    pub(crate) fn forget_player(&mut self, index: usize) {
        for guard in &mut self.list {
            guard.quarry = guard.quarry.filter(|quarry| quarry.target != index);
        }
        if let Some(trail) = self.trails.get_mut(index) {
            trail.forget();
        }
    }

    /// Moves all guards with the window of a generated level. Guards outside the window are
    /// removed, and guards of the parts that have come into it are added.
    pub(crate) fn shift(&mut self, world: &World, shift: WindowShift) {
        self.list.retain_mut(|guard| guard.shift(shift));
        let is_new = |cell: Cell| shift.is_new(cell);
        let posts = world.guards().iter().zip(0..);
        let posts =
            posts.filter(|(post, _)| post.from <= self.rules.difficulty && is_new(post.cell));
        let seed = hash(self.rules.seed, [self.steps]);
        self.list.extend(posts.map(|(post, index)| Guard::new(world, post, index, seed)));
        self.terrain.look_at_things(world);
        self.others.clear();
        self.find_awake();
        self.ways.forget();
        self.sound_field.forget();
        self.trails.iter_mut().for_each(Trail::forget);
        self.spoken.clear();
    }
}

impl OfLevel for Guards {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        let Self { rules, sprites, terrain, .. } = start;
        let list = self.list.of_level(start.list)?;
        let mut guards = Self { rules, list, sprites, terrain, ..self };
        guards.find_awake();
        Ok(guards)
    }
}

#[cfg(test)]
mod tests;
