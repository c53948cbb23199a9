//! Guards: they stand, patrol, notice, search, chase, strike, give up and fall.
//!
//! A step of all guards depends on the world, on what can be perceived of the players, on the
//! sounds of the step, and on nothing else. Guards share what they know about ways, and call each
//! other by sounds that spread as all others do.
//!
//! Guards far from all players take [`FAR_STRIDE`] steps at once. Simulating only those who are in
//! view was refused: a patrol would stop whenever the player looks away.

mod act;
mod alert;
mod attack;
mod awake;
mod chase;
mod context;
mod duty;
mod guard;
mod kind;
mod listen;
mod mood;
mod mover;
mod outside;
mod perceive;
mod route;
mod shifted;
mod sight;
mod sprites;
mod state;
mod terrain;
mod trail;
mod view;
mod ways;

use serde::{Deserialize, Serialize};

use super::rules::MOST_PLAYERS;
use super::rules::Rules;
use super::scratch::Scratch;
use super::sound::{Sound, SoundField, Source};
use super::stored::{OfLevel, Unrestorable, at_most, check};
use crate::world::{GuardKind, SpriteId, World};
use awake::Awake;
use context::{Context, Other};
use guard::Guard;
use sprites::sprites_of;
use state::State;
use terrain::Terrain;
use trail::Trail;
use ways::Ways;

pub(crate) use act::{Act, Cloud, Target};
pub use mood::{Alarm, Mood};
pub(crate) use sight::{Point, is_in_sight};
pub use view::GuardView;

/// Guards on duty at this distance from all players, in cells, take several steps at once.
const FAR: f64 = 26.0;
const FAR_STRIDE: u16 = 8;
/// The steps from one look for fallen guards to the next.
const FALLEN_EACH: u64 = 30;
/// The number of cells over which sounds spread to guards in one step. Guards do not hear the sounds
/// that come after them in the same step.
const MOST_AIR_CELLS: usize = 16_384;

/// All guards of a level.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guards {
    #[serde(skip)]
    rules: Rules,
    list: Vec<Guard>,
    #[serde(skip)]
    awake: Awake,
    /// By the order of [`GuardKind::ALL`].
    #[serde(skip)]
    sprites: [Option<SpriteId>; GuardKind::ALL.len()],
    #[serde(skip)]
    terrain: Terrain,
    ways: Ways,
    air: SoundField,
    #[serde(deserialize_with = "at_most::<MOST_PLAYERS, _, _>")]
    trails: Vec<Trail>,
    #[serde(skip)]
    others: Scratch<Vec<Other>>,
    /// The cells over which sounds have spread in this step.
    #[serde(skip)]
    air_cells: Scratch<usize>,
    /// The guards, sounds and cells that the last step has looked at.
    #[serde(skip)]
    work: Scratch<u64>,
    acts: Vec<Act>,
    /// The sounds that guards have made in the last step.
    spoken: Vec<Sound>,
    /// Empty between steps.
    #[serde(skip)]
    woken: Vec<usize>,
    steps: u64,
    alarm: Alarm,
    has_changed: bool,
}

impl Guards {
    /// The guards of `world` that are there under these rules. Their sprites are added to `world`.
    pub(crate) fn new(world: &mut World, rules: Rules) -> Self {
        let posts = world.guards().iter().zip(0..);
        let posts = posts.filter(|(post, _)| post.from <= rules.difficulty);
        let list: Vec<Guard> =
            posts.map(|(post, index)| Guard::new(world, post, index, rules.seed)).collect();
        let is_needed = |kind| list.iter().any(|guard| guard.kind == kind);
        let sprites = sprites_of(is_needed).map(|sprite| Some(world.add_sprite(sprite?)));
        let mut guards = Self {
            rules,
            list,
            awake: Awake::default(),
            sprites,
            terrain: Terrain::new(world),
            ways: Ways::default(),
            air: SoundField::default(),
            trails: Vec::new(),
            others: Scratch::default(),
            air_cells: Scratch::default(),
            work: Scratch::default(),
            acts: Vec::new(),
            spoken: Vec::new(),
            woken: Vec::new(),
            steps: 0,
            alarm: Alarm::Calm,
            has_changed: false,
        };
        guards.find_awake();
        guards
    }

    /// Whether a guard who is awake could see `point`, however dark it is there, once they look that way.
    pub(crate) fn may_see(&self, world: &World, point: Point) -> bool {
        self.list.iter().any(|guard| guard.may_see(world, point))
    }

    /// Advances all guards by one step. Each target is the player with that index; `sounds` are
    /// those that others than guards have made in this step.
    pub(crate) fn step(
        &mut self,
        world: &World,
        targets: &[Target],
        sounds: &[Sound],
        clouds: &[Cloud],
    ) -> &[Act] {
        self.acts.clear();
        (*self.work, *self.air_cells) = (0, 0);
        if self.list.is_empty() {
            return &self.acts;
        }
        self.steps += 1;
        self.ways.begin_step();
        self.look_at_others();
        self.record_trails(world, targets);
        let mut spoken = std::mem::take(&mut self.spoken);
        for sound in sounds.iter().chain(&spoken) {
            if *self.air_cells < MOST_AIR_CELLS {
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
        let made = self.acts.iter().filter_map(|act| match act {
            Act::Sound(sound) => Some(*sound),
            _ => None,
        });
        spoken.extend(made);
        self.spoken = spoken;
        self.update_alarm();
        *self.work = (self.awake.indices.len() + heard + *self.air_cells) as u64;
        &self.acts
    }

    fn step_one(&mut self, world: &World, targets: &[Target], clouds: &[Cloud], index: usize) {
        let stride = self.stride(world, targets, index);
        if stride == 0 {
            return;
        }
        let now = self.steps;
        let (guard, mut context) = self.with_context(world, targets, clouds, index, stride);
        let before = (guard.mover, guard.frame());
        if (now + index as u64).is_multiple_of(FALLEN_EACH) && stride == 1 {
            guard.look_for_fallen(&mut context);
        }
        guard.step(&mut context);
        self.has_changed |= (guard.mover, guard.frame()) != before;
    }

    /// The number of steps that a guard takes at once now: 0 for those who wait for their turn.
    fn stride(&self, world: &World, targets: &[Target], index: usize) -> u16 {
        let guard = &self.list[index];
        match guard.state {
            // A floor may have moved under them.
            State::Asleep if guard.stagger == 0 => u16::from(!guard.mover.is_at_rest(world)),
            State::OnDuty | State::Returning => {
                let position = guard.mover.position();
                let is_near = |target: &Target| {
                    target.position.distance_squared(position) < FAR * FAR && target.is_alive
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

    /// Lets all guards hear `sound` whom it reaches.
    fn spread(&mut self, world: &World, targets: &[Target], clouds: &[Cloud], sound: &Sound) {
        let told = match sound.by {
            Source::Guard(index) => self.list.get(index).and_then(|guard| guard.quarry),
            Source::Player(_) | Source::Object => None,
        };
        let mut has_woken = false;
        for index in 0..self.list.len() {
            let guard = &self.list[index];
            let earshot = guard.earshot(sound, self.rules.difficulty);
            let way = guard.mover.position().distance(sound.cell.center());
            // No way is shorter than the straight line; two cells more for rounding.
            if earshot == 0 || way * 2.0 > f64::from(earshot) + 4.0 {
                continue;
            }
            if sound.by == Source::Guard(index) {
                continue;
            }
            *self.air_cells += self.air.reach_out(world, sound.cell, earshot, self.steps);
            let distance = self.air.distance(guard.mover.cell());
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
        targets: &'a [Target],
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
            acts: &mut self.acts,
            woken: &mut self.woken,
        };
        (&mut self.list[index], context)
    }

    /// Records the trails of players, if anybody smells them.
    fn record_trails(&mut self, world: &World, targets: &[Target]) {
        if self.awake.has_hounds {
            self.trails.resize_with(targets.len(), Trail::default);
            let trails = self.trails.iter_mut().zip(targets);
            for (trail, target) in trails.filter(|(_, target)| target.is_alive) {
                trail.record(world, target, self.steps);
            }
        }
    }

    fn update_alarm(&mut self) {
        let alarm = self.awake().map(|guard| guard.state.mood().alarm()).max().unwrap_or_default();
        if alarm == Alarm::Raised && self.alarm < Alarm::Raised {
            self.acts.push(Act::Raised);
        }
        self.alarm = alarm;
    }

    /// Refuses a state in which a step could fail.
    pub(crate) fn check(&self, world: &World) -> Result<(), Unrestorable> {
        let map = (world.grid().width(), world.grid().height());
        self.ways.check(map)?;
        check(self.air.is_possible(map), "the search of a sound")?;
        self.trails.iter().try_for_each(|trail| trail.check(self.steps))?;
        self.list.iter().try_for_each(|guard| guard.check(world, self.list.len()))
    }
}

impl OfLevel for Guards {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        let Self { rules, sprites, terrain, .. } = start;
        let list = self.list.of_level(start.list)?;
        let mut guards = Self { rules, list, sprites, terrain, ..self };
        guards.find_awake();
        Ok(guards)
    }
}

#[cfg(test)]
mod tests;
