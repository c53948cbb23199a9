//! A guard: the state, and the order of what happens in a step.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::context::{Context, Other};
use super::kind::{Abilities, abilities};
use super::mover::Mover;
use super::route::Route;
use super::state::{Phase, Quarry, State};
use super::terrain::Gait;
use super::view::GuardView;
use crate::game::sound::SoundKind;
use crate::game::stored::{OfLevel, Unrestorable, check, check_on_map};
use crate::rng::{SplitMix64, hash};
use crate::world::{Cell, Duty, GuardKind, GuardPost, Heading, World};

/// The awareness from which a guard wonders, and from which they are alarmed.
pub(crate) const WONDERS: u16 = 300;
pub(crate) const ALARMED: u16 = 1000;

/// The length of a pace: each one is a frame and a sound, in cells.
const PACE: f64 = 0.55;
/// The steps for which a guard staggers who is pushed.
const STAGGER: u16 = 30;
/// The speed of a guard who is pushed, in cells per second.
const PUSH: f64 = 4.0;
/// More steps than any guard is baffled.
const MOST_BAFFLED: u16 = 1000;
/// The number of paces after which they are counted from 0 again.
const MOST_PACES: f64 = 1024.0;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guard {
    pub(crate) kind: GuardKind,
    #[serde(skip)]
    pub(crate) post: Cell,
    #[serde(skip)]
    pub(crate) post_heading: Heading,
    #[serde(skip)]
    pub(crate) duty: Duty,
    pub(crate) mover: Mover,
    pub(crate) state: State,
    /// From 0 to [`ALARMED`].
    pub(crate) awareness: u16,
    pub(crate) quarry: Option<Quarry>,
    /// Whether they have been alarmed before, in a game where guards remember it.
    pub(crate) is_wary: bool,
    /// The place in the round of a patrol.
    pub(crate) stop: usize,
    /// Where a guard who wanders goes.
    pub(crate) errand: Option<Cell>,
    /// The steps for which they stand still on duty, or look around.
    pub(crate) pause: u16,
    /// The side to which they look, while they look around.
    pub(crate) glance: f64,
    /// The steps until they may strike again, until they stand firmly, and until they may be
    /// alarmed by sight again.
    pub(crate) rest: u16,
    pub(crate) stagger: u16,
    pub(crate) blind: u16,
    /// The steps for which they have not reached a player whom they follow.
    pub(crate) baffled: u16,
    /// Whether a floor under them has moved.
    pub(crate) is_unsettled: bool,
    pub(crate) route: Route,
    /// The velocity and the look that they want in this step.
    pub(crate) wanted: DVec2,
    pub(crate) look: Option<DVec2>,
    /// The distance walked, in paces.
    paces: f64,
    pub(crate) random: SplitMix64,
}

impl Guard {
    pub(crate) fn new(world: &World, post: &GuardPost, index: usize, seed: u64) -> Self {
        let is_asleep = post.duty == Duty::Sleep;
        Self {
            kind: post.kind,
            post: post.cell,
            post_heading: post.heading,
            duty: post.duty.clone(),
            mover: Mover::new(world, post.cell, post.heading),
            state: if is_asleep { State::Asleep } else { State::OnDuty },
            awareness: 0,
            quarry: None,
            is_wary: false,
            stop: 0,
            errand: None,
            pause: 0,
            glance: 0.0,
            rest: 0,
            stagger: 0,
            blind: 0,
            baffled: 0,
            is_unsettled: false,
            route: Route::default(),
            wanted: DVec2::ZERO,
            look: None,
            paces: 0.0,
            random: SplitMix64::new(hash(seed, [index as u64])),
        }
    }

    /// Advances the guard by the steps of `context`.
    pub(crate) fn step(&mut self, context: &mut Context) {
        let steps = context.stride;
        self.rest = self.rest.saturating_sub(steps);
        self.blind = self.blind.saturating_sub(steps);
        (self.wanted, self.look) = (DVec2::ZERO, None);
        if self.stagger > 0 {
            self.stagger = self.stagger.saturating_sub(steps);
        } else {
            if !matches!(self.state, State::Asleep | State::Down { .. }) {
                self.perceive(context);
            }
            self.think(context);
        }
        self.move_body(context);
    }

    fn think(&mut self, context: &mut Context) {
        match self.state {
            State::Asleep => {}
            State::OnDuty => self.do_duty(context),
            State::Returning => self.return_to_duty(context),
            State::Wondering { .. } => self.wonder(context),
            State::Searching { around, next, left } => self.search(context, around, next, left),
            State::Tracking { target, mark, lost } => self.track(context, target, mark, lost),
            State::Chasing { fright } => self.chase(context, fright),
            State::Attacking { phase, left } => self.attack(context, phase, left),
            State::Down { left } => self.lie(left.saturating_sub(context.stride)),
        }
    }

    fn lie(&mut self, left: u16) {
        self.state = State::Down { left };
        if left == 0 {
            self.get_up();
        }
    }

    /// Turns and walks as they want to.
    fn move_body(&mut self, context: &mut Context) {
        let steps = context.stride;
        let is_alarmed = self.state.is_alarmed();
        let wanted = if self.stagger > 0 { self.mover.body.velocity } else { self.wanted };
        let is_walking = wanted.length_squared() > 0.01;
        let look = self.look.or(is_walking.then_some(wanted)).filter(|_| self.stagger == 0);
        if let Some(look) = look {
            let degrees = if is_alarmed { 6.0 } else { 4.0 };
            self.mover.turn(look, degrees * f64::from(steps));
        }
        let before = self.mover.position();
        let wanted = self.slowed_by_turning(wanted);
        self.mover.walk(&context.ground(self.gait()), wanted, steps);
        let paces = self.paces + before.distance(self.mover.position()) / PACE;
        if paces.floor() > self.paces.floor() && self.stagger == 0 {
            context.sound(SoundKind::Walking, self.mover.cell(), self.abilities().tread);
        }
        self.paces = paces % MOST_PACES;
    }

    /// A guard who looks elsewhere than they walk turns first.
    fn slowed_by_turning(&self, wanted: DVec2) -> DVec2 {
        if self.look.is_some() || self.stagger > 0 || wanted == DVec2::ZERO {
            return wanted;
        }
        let along = self.mover.facing.dot(wanted) / wanted.length();
        wanted * ((along + 0.25) / 1.0).clamp(0.0, 1.0)
    }

    /// Lays the guard on the floor.
    pub(crate) fn stun(&mut self, steps: u16) {
        self.state = State::Down { left: steps.max(1) };
        self.mover.body.velocity = DVec2::ZERO;
        (self.awareness, self.quarry, self.stagger) = (0, None, 0);
    }

    /// Lets a guard who lies stand up and look around.
    pub(crate) fn get_up(&mut self) {
        self.state = State::Searching { around: self.mover.cell(), next: None, left: 600 };
        self.pause = 60;
    }

    /// Pushes the guard along `direction`, a unit vector.
    pub(crate) fn push(&mut self, direction: DVec2) {
        if self.state.is_down() {
            return;
        }
        self.stagger = STAGGER;
        self.mover.body.velocity = direction * PUSH;
        match self.state {
            State::Attacking { .. } => self.state = State::Chasing { fright: 0 },
            State::Asleep => {
                let about = self.mover.position() - direction;
                self.state =
                    State::Wondering { about, looks: 30, goes: true, hurries: false, wakes: None };
            }
            _ => {}
        }
    }

    pub(crate) fn abilities(&self) -> &'static Abilities {
        abilities(self.kind)
    }

    pub(crate) fn gait(&self) -> Gait {
        Gait { opens_doors: self.abilities().opens_doors, height: self.kind.height() }
    }

    /// The height of the top of the head.
    pub(crate) fn head(&self) -> f64 {
        self.mover.feet + self.kind.height()
    }

    pub(crate) fn view(&self) -> GuardView {
        GuardView {
            kind: self.kind,
            position: self.mover.position(),
            feet: self.mover.feet,
            heading: self.mover.heading,
            mood: self.state.mood(),
            is_down: self.state.is_down(),
        }
    }

    pub(crate) fn as_other(&self) -> Other {
        let is_down = self.state.is_down();
        Other { position: self.mover.position(), feet: self.mover.feet, is_down }
    }

    /// The frame of the sprite.
    pub(crate) fn frame(&self) -> u8 {
        let is_walking = self.mover.body.velocity.length_squared() > 0.04;
        match self.state {
            State::Down { .. } => 6,
            State::Asleep => 7,
            State::Attacking { phase: Phase::Windup, .. } => 4,
            State::Attacking { phase: Phase::Strike { .. }, .. } => 5,
            State::Chasing { fright } if fright > 0 => 3,
            _ if is_walking => 1 + (self.paces as u64 % 2) as u8,
            State::Wondering { .. } | State::Chasing { .. } => 3,
            _ => 0,
        }
    }

    /// Refuses a state in which a step of `count` guards could fail.
    pub(crate) fn check(&self, world: &World, count: usize) -> Result<(), Unrestorable> {
        check_on_map(world, self.mover.position())?;
        if let Some(quarry) = self.quarry {
            check_on_map(world, quarry.position)?;
        }
        let stops = match &self.duty {
            Duty::Patrol(stops) => stops.len(),
            Duty::Stand | Duty::Sleep | Duty::Wander(_) => 1,
        };
        let wakes_nobody_else = match self.state {
            State::Wondering { wakes, .. } => wakes.is_none_or(|index| index < count),
            _ => true,
        };
        check(wakes_nobody_else, "whom a guard wakes")?;
        let counts = self.awareness <= ALARMED
            && self.stop < stops.max(1)
            && self.baffled <= MOST_BAFFLED
            && self.route.is_possible()
            && (0.0..MOST_PACES).contains(&self.paces)
            && self.state != (State::Down { left: 0 });
        check(counts, "a count of a guard")
    }
}

impl OfLevel for Guard {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        let Self { kind, post, post_heading, duty, .. } = start;
        if self.kind != kind {
            return Err(Unrestorable::OtherLevel);
        }
        Ok(Self { post, post_heading, duty, mover: self.mover.facing_ahead(), ..self })
    }
}
