//! A player who makes a person's errors, for figures of difficulty.
//!
//! The player knows where things are and the ways between them, and nothing about guards except
//! what the picture, the sounds and the state of alarm have shown. They
//!
//! - react after 0.3 seconds, hold each key for at least 0.1 seconds, and miss directions by some
//!   degrees;
//! - walk, and run only over spikes and away from guards;
//! - step back and wait when a guard looks their way, until they lose patience;
//! - strike a guard within reach, shoot darts at guards who follow, and run towards the last
//!   checkpoint;
//! - count the beat of spikes, fail some jumps, and fetch a heart when they are hurt;
//! - go on after each death, as the rules allow, and give up after [`LIVES`] deaths or
//!   [`MAX_STEPS`] steps.

use std::collections::VecDeque;
use std::ops::Range;

use cellcaster::game::{Alarm, Game, GuardView, Intent, Intents, Mood, Outcome, PlayerId};
use cellcaster::game::{Rules, SoundKind};
use cellcaster::map::builtin::BuiltinLevel;
use cellcaster::rng::SplitMix64;
use cellcaster::world::{Cell, FieldOfView, GuardKind, Supply, ThingKind, TileEffect, World};
use glam::DVec2;

use crate::careful::dread;
use crate::levels::{route, world};
use crate::pilot::Pilot;
use crate::route::{Errand, Verb};
use crate::ways::Ways;

/// The number of deaths, and the time in the game, after which the player gives up.
pub(crate) const LIVES: u32 = 3;
pub(crate) const MAX_STEPS: u64 = 60 * 60 * 15;

/// The shortest time for which a key is held, in steps. The player decides once in this time.
const TAP: u32 = 6;
/// The time from an event to the reaction, in taps.
const REACTION: usize = 3;
/// The largest error of the player's direction, and the error that is not corrected, in degrees.
const BIAS: f64 = 6.0;
const TOLERANCE: f64 = 8.0;
/// The distance at which a guard who looks their way worries the player, in cells.
const WORRY: f64 = 9.0;
/// The distance at which the player strikes, in cells.
const ARM: f64 = 0.95;
/// The number of steps from a blow to the next.
const AFTER_BLOW: u64 = 90;
/// The points of health at which the player fetches a heart, and its largest walking cost.
const HURT: u8 = 3;
const DETOUR: u32 = 200;
/// The number of steps for which the player remembers a guard.
const MEMORY: u64 = 240;
/// The walking costs to the last checkpoint from which the player flees there.
const ESCAPE: Range<u32> = 30..u32::MAX;
/// The walking cost from which a player counts as near a checkpoint or a heart: fifteen cells.
const NEAR: u32 = 150;
/// One in this many jumps fails.
const CLUMSY: usize = 12;

/// The player's intents until a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Plan {
    /// Go on with the errands.
    Go,
    /// Step back from a guard, and then hide.
    StepBack,
    /// Wait, ducking.
    Hide,
    /// Run away.
    Flee,
}

/// The perceptions of the player at a time.
#[derive(Clone, Debug)]
struct Glimpse {
    guards: Vec<GuardView>,
    alarm: Alarm,
    hears_steps: bool,
}

/// A loss of health.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Loss {
    /// The number of completed errands.
    pub(crate) errand: usize,
    pub(crate) points: u8,
    pub(crate) is_death: bool,
    /// `true` if the player has come near a checkpoint or a heart before.
    pub(crate) is_helped: bool,
}

/// A person at the keyboard.
pub(crate) struct Person {
    pub(crate) pilot: Pilot,
    at_start: World,
    random: SplitMix64,
    errands: Vec<Errand>,
    /// The number of completed errands, now and at the last checkpoint.
    done: usize,
    saved: usize,
    /// The cell of the last checkpoint, or of the start.
    home: Cell,
    /// The perceptions of the last taps, newest last.
    glimpses: VecDeque<Glimpse>,
    /// The guards seen lately, each with the step.
    known: Vec<(GuardView, u64)>,
    plan: Plan,
    until: u64,
    /// The remaining times that the player waits before they go on regardless, and the step until
    /// which they do.
    patience: u32,
    bold: u64,
    /// The error of the direction, in degrees.
    bias: f64,
    /// The way, and the step in which the player thinks about it again.
    ways: Option<(Ways, u64)>,
    /// The heart that the player fetches.
    heart: Option<Cell>,
    /// The frames of the spikes ahead in the last taps.
    beat: Vec<(u64, Option<u8>)>,
    /// The number of taps for which the player has walked on the spot.
    stuck: u32,
    /// The step from which the player strikes again.
    strikes: u64,
    /// `true` once the player has come near a checkpoint or a heart.
    is_helped: bool,
    pub(crate) losses: Vec<Loss>,
}

/// Plays a level. `seed` selects the errors.
pub(crate) fn play(level: &BuiltinLevel, rules: Rules, seed: u64) -> Person {
    let mut person = Person::new(level, rules, seed);
    while person.pilot.game.outcome() != Outcome::Won && !person.gives_up() {
        person.tap();
    }
    person
}

impl Person {
    fn new(level: &BuiltinLevel, rules: Rules, seed: u64) -> Self {
        let at_start = world(level);
        let pilot = Pilot::new(Game::with_rules(at_start.clone(), rules));
        let home = at_start.start().cell;
        let (glimpses, known, beat) = (VecDeque::new(), Vec::new(), Vec::new());
        let (plan, until, patience, bold, bias) = (Plan::Go, 0, 4, 0, 0.0);
        let random = SplitMix64::new(seed);
        let errands = route(level);
        let (done, saved, ways, heart, stuck) = (0, 0, None, None, 0);
        let mut person = Self {
            pilot,
            at_start,
            random,
            errands,
            done,
            saved,
            home,
            glimpses,
            known,
            plan,
            until,
            patience,
            bold,
            bias,
            ways,
            heart,
            beat,
            stuck,
            strikes: 0,
            is_helped: false,
            losses: Vec::new(),
        };
        person.look_around();
        person
    }

    fn gives_up(&self) -> bool {
        let game = &self.pilot.game;
        game.tally().deaths >= LIVES || game.steps() >= MAX_STEPS
    }

    /// Waits before the first key, for as long as the player likes to look at the picture.
    fn look_around(&mut self) {
        let steps = 30 + self.random.below(200) as u32;
        self.pilot.wait(steps);
    }

    /// Perceives, decides, and holds keys for the time of a tap.
    fn tap(&mut self) {
        if matches!(self.pilot.game.outcome(), Outcome::Dead { .. }) {
            return self.retry();
        }
        self.perceive();
        self.decide();
        let before = self.pilot.steps();
        let health = self.pilot.game.health().points;
        let (errand, cell) = (self.done, self.pilot.cell());
        match self.plan {
            Plan::Go => self.go_on(),
            Plan::StepBack => self.hold(&[Intent::Back]),
            Plan::Hide => self.hold(&[Intent::Duck]),
            Plan::Flee => self.flee(),
        }
        if self.pilot.steps() == before {
            self.pilot.wait(TAP);
        }
        let game = &self.pilot.game;
        let points = health.saturating_sub(game.health().points);
        if points > 0 {
            let is_death = matches!(game.outcome(), Outcome::Dead { .. });
            self.losses.push(Loss { errand, points, is_death, is_helped: self.is_helped });
        }
        // Ways take time, so they are not searched in each tap.
        if !self.is_helped && before / 60 < self.pilot.steps() / 60 {
            let helps = |kind| matches!(kind, ThingKind::Checkpoint | ThingKind::Healing(_));
            let things = game.world().things().iter().filter(|thing| helps(thing.kind));
            let mut ways = things.map(|thing| Ways::new(game, thing.cell, |_| 0));
            self.is_helped = ways.any(|ways| ways.cost(cell) <= NEAR);
        }
    }

    fn retry(&mut self) {
        self.pilot.wait(1);
        self.pilot.press(Intent::Retry);
        self.glimpses.clear();
        self.known.clear();
        (self.plan, self.until, self.bold, self.patience) = (Plan::Go, 0, 0, 4);
        self.set_done(self.saved);
        self.look_around();
    }

    fn now(&self) -> u64 {
        self.pilot.game.steps()
    }

    /// Records what is perceived now, and remembers what was perceived [`REACTION`] taps ago.
    fn perceive(&mut self) {
        let game = &self.pilot.game;
        let now = game.steps();
        let view = game.seen_by(PlayerId::FIRST).expect("the player is in the game");
        let guards = view.guards_in_sight(&view.camera(FieldOfView::default())).collect();
        let is_near = |kind, strength| kind == SoundKind::Walking && strength >= 2;
        let hears_steps = view.heard().iter().any(|it| is_near(it.kind, it.strength));
        self.glimpses.push_back(Glimpse { guards, alarm: game.alarm(), hears_steps });
        let cell = self.pilot.cell();
        let is_checkpoint = |thing: &cellcaster::world::Thing| thing.kind == ThingKind::Checkpoint;
        let is_saved = game.message() == Some("Checkpoint.");
        if is_saved && game.world().things_in(cell).iter().any(is_checkpoint) && cell != self.home {
            (self.home, self.saved) = (cell, self.done);
        }
        if self.glimpses.len() > REACTION + 1 {
            self.glimpses.pop_front();
        }
        for guard in self.glimpses[0].guards.clone() {
            let is_same = |other: &GuardView| {
                other.kind == guard.kind && other.position.distance(guard.position) < 2.5
            };
            self.known.retain(|(other, since)| !is_same(other) && since + MEMORY > now);
            self.known.push((guard, now));
        }
    }

    /// Changes the plan if something happens or the present plan has ended.
    fn decide(&mut self) {
        let now = self.now();
        let Glimpse { guards, alarm, hears_steps } = self.glimpses[0].clone();
        let here = self.pilot.position();
        let cell = self.pilot.cell();
        let is_wet = self.pilot.game.world().effect_in(cell) == Some(TileEffect::Water);
        if self.plan != Plan::Flee && (is_wet || self.spikes_in(cell).is_some()) {
            (self.plan, self.bold) = (Plan::Go, self.bold.max(now + 60));
        }
        let standing = || guards.iter().filter(|guard| !guard.is_down);
        if alarm == Alarm::Raised || standing().any(|it| follows(it.mood)) {
            if self.plan != Plan::Flee && now >= self.bold {
                (self.plan, self.until) = (Plan::Flee, now + 900);
                self.ways = None;
            }
            return;
        }
        if self.plan == Plan::Flee {
            (self.plan, self.until) = (Plan::Hide, now + 60 + self.random.below(180) as u64);
        }
        let worries = |guard: &GuardView| {
            let to = here - guard.position;
            let looks = guard.heading.direction().dot(to) > 0.35 * to.length();
            let is_wary = matches!(guard.mood, Mood::Wondering | Mood::Searching);
            let sees = guard.kind != GuardKind::Listener && guard.mood != Mood::Asleep;
            to.length() < WORRY && sees && (looks || is_wary)
        };
        let is_worried = standing().any(worries);
        if self.plan == Plan::Go && now >= self.bold && (is_worried || hears_steps) {
            self.patience = self.patience.saturating_sub(1);
            if self.patience == 0 {
                (self.patience, self.bold) = (2 + self.random.below(4) as u32, now + 240);
                return;
            }
            let back = if is_worried { 24 + self.random.below(36) as u64 } else { 0 };
            (self.plan, self.until) = (Plan::StepBack, now + back);
        } else if now >= self.until && self.plan == Plan::StepBack {
            (self.plan, self.until) = (Plan::Hide, now + 60 + self.random.below(120) as u64);
        } else if now >= self.until && self.plan == Plan::Hide {
            let waits = alarm == Alarm::Wary && now < self.until + 480;
            self.plan = if waits { Plan::Hide } else { Plan::Go };
            self.ways = None;
        }
    }

    /// Goes on with the next errand.
    fn go_on(&mut self) {
        if let Some(guard) = self.unaware_guard_ahead() {
            return self.attack(guard);
        }
        let Some(&errand) = self.errands.get(self.done) else { return self.set_done(0) };
        match errand.verb {
            Verb::Hop if self.random.one_in(CLUMSY) => {
                self.pilot.face_point(errand.cell.center());
                (0..6).for_each(|_| self.hold(&[Intent::Forward, Intent::Jump]));
            }
            Verb::Hop => {
                let has_landed = self.pilot.hop(errand.cell, errand.height);
                self.set_done(if has_landed { self.done + 1 } else { self.last_walk() });
                self.pilot.wait(if has_landed { TAP } else { 60 });
            }
            Verb::Straight => {
                let has_arrived = self.pilot.straight(errand.cell);
                self.set_done(if has_arrived { self.done + 1 } else { self.last_walk() });
            }
            Verb::Throw => self.set_done(self.done + 1),
            Verb::Go | Verb::Open => {
                let ways = self.ways_to_goal(errand);
                if ways.cost(self.pilot.cell()) == u32::MAX {
                    return self.look_for_a_way();
                }
                let is_errand = self.heart.is_none();
                let pace = Some(Intent::Run).filter(|_| self.glimpses[0].alarm == Alarm::Raised);
                if self.walk(&ways, pace) && is_errand {
                    if errand.verb == Verb::Open {
                        self.pilot.open(errand.cell);
                    }
                    self.patience = 4;
                    self.set_done(self.done + 1);
                }
            }
        }
    }

    /// Waits for a lift or a door to move. If there is still no way, turns the next lever, or begins
    /// again from the last walk.
    fn look_for_a_way(&mut self) {
        let here = self.pilot.position();
        let ways = self.ways_to_goal(self.errands[self.done]);
        let beside = self.pilot.cell().beside().filter(|&cell| ways.cost(cell) < u32::MAX);
        let mut beside = beside.map(Cell::center).filter(|it| it.distance(here) < 0.9);
        if let Some(nearest) = beside.next() {
            return self.steer(nearest, None);
        }
        (0..20).for_each(|_| self.hold(&[]));
        self.ways = None;
        let ways = self.ways_to_goal(self.errands[self.done]);
        if ways.cost(self.pilot.cell()) == u32::MAX {
            let next = self.errands.get(self.done + 1);
            let is_lever = next.is_some_and(|errand| errand.verb == Verb::Open);
            self.set_done(if is_lever { self.done + 1 } else { self.last_walk() });
        }
    }

    /// The last errand that is a walk, from which the player begins a row of jumps again.
    fn last_walk(&self) -> usize {
        (0..self.done).rev().find(|&it| self.errands[it].verb == Verb::Go).unwrap_or(0)
    }

    /// Sets the number of completed errands. Skips finds that the player has already, and jumps to
    /// places to which they can walk.
    fn set_done(&mut self, done: usize) {
        (self.done, self.ways) = (done, None);
        let world = self.pilot.game.world();
        let is_find = |kind| matches!(kind, ThingKind::Key(_) | ThingKind::Treasure(_));
        let is_goal = |errand: &Errand| {
            let mut things = self.at_start.things_in(errand.cell).iter();
            let is_goal = things.any(|it| is_find(it.kind) || it.kind == ThingKind::Exit);
            is_goal || errand.verb == Verb::Open
        };
        let Some(way) = self.errands[done..].iter().position(is_goal) else { return };
        let goal = self.errands[done + way];
        let has_find = |world: &World| world.things_in(goal.cell).iter().any(|it| is_find(it.kind));
        if has_find(&self.at_start) && !has_find(world) {
            return self.set_done(done + way + 1);
        }
        let jumps = |errand: &Errand| matches!(errand.verb, Verb::Hop | Verb::Straight);
        let ways = || Ways::new(&self.pilot.game, goal.cell, |_| 0);
        let skips = goal.verb == Verb::Go && self.errands[done..done + way].iter().any(jumps);
        if skips && ways().cost(self.pilot.cell()) < u32::MAX {
            self.done = done + way;
        }
    }

    /// The heart that a hurt player fetches first.
    fn nearest_heart(&self) -> Option<Cell> {
        let game = &self.pilot.game;
        let is_heart = |kind| matches!(kind, ThingKind::Healing(_));
        let things = game.world().things().iter().filter(|thing| is_heart(thing.kind));
        let hearts = things.map(|thing| thing.cell).filter(|_| game.health().points <= HURT);
        let costed =
            hearts.map(|cell| (Ways::new(game, cell, |_| 0).cost(self.pilot.cell()), cell));
        costed.min().filter(|&(cost, _)| cost < DETOUR).map(|(_, cell)| cell)
    }

    fn ways_to_goal(&mut self, errand: Errand) -> Ways {
        if let Some((ways, until)) = &self.ways
            && self.now() < *until
        {
            return ways.clone();
        }
        self.heart = self.nearest_heart();
        self.bias = self.random.between(-BIAS, BIAS);
        let feared: Vec<_> =
            self.known.iter().map(|(it, _)| (it.position, it.heading.direction())).collect();
        let dread = |cell| dread(&feared, cell);
        let game = &self.pilot.game;
        let ways = match (self.heart, errand.verb) {
            (Some(heart), _) => Ways::new(game, heart, dread),
            (None, Verb::Open) => Ways::beside(game, errand.cell, dread),
            (None, _) => Ways::new(game, errand.cell, dread),
        };
        self.ways = Some((ways.clone(), self.now() + 60));
        ways
    }

    fn ways_home(&mut self) -> Ways {
        match &self.ways {
            Some((ways, until)) if self.now() < *until => ways.clone(),
            _ => {
                let ways = Ways::new(&self.pilot.game, self.home, |_| 0);
                self.ways = Some((ways.clone(), self.now() + 60));
                ways
            }
        }
    }

    /// Walks or runs along `ways` for a tap. Returns whether the player has arrived.
    fn walk(&mut self, ways: &Ways, manner: Option<Intent>) -> bool {
        let (here, cell) = (self.pilot.position(), self.pilot.cell());
        if ways.cost(cell) == 0 && (cell.center() - here).length() < 0.4 {
            return true;
        }
        let (target, is_low) = ways.target(&self.pilot.game, here);
        let spikes = self.spikes_in(cell_before(here, target));
        let here_spiked = self.spikes_in(cell);
        if here_spiked.is_none() && spikes.is_some() && !self.has_beat(spikes) {
            let turn = self.turn_to(target);
            self.hold(turn.as_slice());
            return false;
        }
        let is_spiked = here_spiked.is_some() || spikes.is_some();
        let is_near_listener = self.known.iter().any(|(guard, _)| {
            guard.kind == GuardKind::Listener && guard.position.distance(here) < 4.0
        });
        self.steer(
            target,
            match manner {
                _ if is_low => Some(Intent::Duck),
                _ if is_spiked => Some(Intent::Run),
                None if is_near_listener => Some(Intent::Duck),
                manner => manner,
            },
        );
        let has_moved = self.pilot.position().distance(here) > 0.03;
        self.stuck = if has_moved { 0 } else { self.stuck + 1 };
        if self.stuck > 25 {
            self.stuck = 0;
            let aside =
                if self.random.one_in(2) { Intent::StrafeLeft } else { Intent::StrafeRight };
            (0..4).for_each(|_| self.hold(&[aside]));
        }
        false
    }

    /// The frame of the spikes in a cell.
    fn spikes_in(&self, cell: Cell) -> Option<u8> {
        let mut things = self.pilot.game.world().things_in(cell).iter();
        things.find(|it| matches!(it.kind, ThingKind::Spikes(_))).and_then(|it| it.frame)
    }

    /// Watches the spikes ahead. Returns whether they have just gone in, as expected. Sometimes the
    /// player misses the beat.
    fn has_beat(&mut self, frame: Option<u8>) -> bool {
        let now = self.now();
        if self.beat.last().is_some_and(|&(last, _)| last + u64::from(TAP) != now) {
            self.beat.clear();
        }
        self.beat.push((now, frame));
        let [.., (_, before), (_, now)] = self.beat[..] else { return false };
        let goes = before != Some(0) && now == Some(0) && !self.random.one_in(CLUMSY);
        if goes {
            self.beat.clear();
        }
        goes
    }

    /// Turns towards a point, and walks once it is about ahead.
    fn steer(&mut self, target: DVec2, manner: Option<Intent>) {
        let error = self.pilot.error(target - self.pilot.position()) + self.bias;
        let walk = [Some(Intent::Forward), manner].into_iter().filter(|_| error.abs() < 40.0);
        let wanted: Vec<Intent> = walk.chain([self.turn_to(target)]).flatten().collect();
        self.hold(&wanted);
    }

    /// The key that turns towards a point, unless the player looks there.
    fn turn_to(&self, target: DVec2) -> Option<Intent> {
        let error = self.pilot.error(target - self.pilot.position()) + self.bias;
        let turn = if error > 0.0 { Intent::TurnRight } else { Intent::TurnLeft };
        (error.abs() > TOLERANCE).then_some(turn)
    }

    /// Presses a key that acts once.
    fn press(&mut self, intent: Intent) {
        self.pilot.press(intent);
        self.hold(&[]);
    }

    fn hold(&mut self, wanted: &[Intent]) {
        let wanted: Intents = wanted.iter().copied().collect();
        for _ in 0..TAP {
            if self.pilot.game.outcome() == Outcome::Playing {
                self.pilot.step(wanted);
            }
        }
    }

    /// The guard close ahead who knows nothing of the player.
    fn unaware_guard_ahead(&self) -> Option<GuardView> {
        let here = self.pilot.position();
        let is_close = |guard: &&GuardView| {
            let to = guard.position - here;
            let is_calm = matches!(guard.mood, Mood::OnDuty | Mood::Returning);
            let is_behind = guard.heading.direction().dot(to) > 0.0;
            let is_near =
                to.length() < ARM && self.now() >= self.strikes && guard.kind != GuardKind::Warden;
            !guard.is_down
                && guard.mood != Mood::Asleep
                && (is_near || is_calm && is_behind && to.length() < 3.0)
        };
        self.glimpses[0].guards.iter().find(is_close).copied()
    }

    /// Turns to a guard, and strikes or comes closer.
    fn attack(&mut self, guard: GuardView) {
        let to = guard.position - self.pilot.position();
        if to.length() < ARM && self.pilot.error(to).abs() < 50.0 {
            self.strikes = self.now() + AFTER_BLOW;
            self.press(Intent::Strike);
        } else {
            self.steer(guard.position, None);
        }
    }

    /// Runs towards the last checkpoint, or to the exit if it is nearer or a guard is in the way.
    /// Strikes and shoots at guards who are in view.
    fn flee(&mut self) {
        let here = self.pilot.position();
        let foes = self.glimpses[0].guards.iter().filter(|it| !it.is_down && follows(it.mood));
        let foes = foes.map(|foe| (foe.position.distance(here), *foe));
        let foe = foes.min_by(|one, other| one.0.total_cmp(&other.0));
        if let Some((distance, foe)) = foe {
            let has_darts = self.pilot.game.supplies(Supply::Darts) > 0;
            if has_darts && self.pilot.error(foe.position - here).abs() < 12.0 {
                return self.press(Intent::Shoot);
            }
            if foe.kind == GuardKind::Listener && distance > 2.0 {
                return self.hold(&[Intent::Duck]);
            }
            let strikes = foe.kind != GuardKind::Warden && self.now() >= self.strikes;
            if distance < 1.2 && strikes {
                return self.attack(foe);
            }
        }
        let home = self.ways_home();
        let cost = home.cost(self.pilot.cell());
        let is_cut_off = self.known.iter().any(|(it, _)| {
            let cell = Cell { column: it.position.x as u32, row: it.position.y as u32 };
            follows(it.mood) && home.cost(cell) < cost
        });
        let is_last = self.done + 1 == self.errands.len();
        let (target, _) = home.target(&self.pilot.game, here);
        let is_spiked = self.spikes_in(cell_before(here, target)).is_some();
        if is_last || is_spiked || is_cut_off || !ESCAPE.contains(&cost) {
            (self.plan, self.bold, self.ways) = (Plan::Go, self.now() + 300, None);
        } else {
            self.walk(&home, Some(Intent::Run));
        }
    }
}

/// The cell that the player enters next on the way from `here` to `target`.
fn cell_before(here: DVec2, target: DVec2) -> Cell {
    let ahead = here + (target - here).normalize_or_zero() * 0.8;
    Cell { column: ahead.x as u32, row: ahead.y as u32 }
}

fn follows(mood: Mood) -> bool {
    matches!(mood, Mood::Chasing | Mood::Attacking)
}
