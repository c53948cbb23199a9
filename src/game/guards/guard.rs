//! A guard: the state, its public view, and its changes.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::context::{Context, PerceivedGuard, PerceivedPlayer};
use super::kind::{Abilities, abilities};
use super::movement::GuardMotion;
use super::ways::Gait;
use crate::game::sight::{Point, is_in_sight};
use crate::game::sound::{Sound, SoundKind};
use crate::game::stored::{OfLevel, RestoreError, check, check_on_map};
use crate::generate::WindowShift;
use crate::rng::{SplitMix64, hash};
use crate::world::{Cell, Difficulty, Duty, GuardKind, GuardPost, Heading, World};

/// The awareness at which a guard wonders, and the awareness at which they are alarmed.
pub(crate) const WONDERING: u16 = 300;
pub(crate) const ALARMED: u16 = 1000;

/// For this many steps, a guard still knows the position of a player who has left their sight.
pub(crate) const GUESS_STEPS: u16 = 45;
/// The number of steps for which a guard stands and shouts before they run.
const FRIGHT_STEPS: u16 = 24;
/// The number of steps for which a lantern-bearer rings the bell before they run.
const RINGING_STEPS: u16 = 60;
/// The number of steps for which a guard looks towards a noise before they go there.
const LOOK_STEPS: u16 = 45;
/// The angle of a glance to the side, in radians.
const GLANCE: f64 = 0.9;

/// The length of a pace, in cells. Each pace changes the sprite's frame and makes a sound.
pub(crate) const PACE: f64 = 0.55;
/// The number of steps for which a guard staggers after a push.
const STAGGER_STEPS: u16 = 30;
/// A guard who has not moved for this many steps is stuck.
pub(crate) const STUCK_STEPS: u16 = 40;
/// The speed of a pushed guard, in cells per second.
const PUSH: f64 = 4.0;
/// An upper bound on the number of steps for which a guard is baffled.
const MAX_BAFFLED_STEPS: u16 = 1000;
/// The number of paces after which the count restarts at 0.
pub(crate) const MAX_PACES: f64 = 1024.0;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Guard {
    pub(crate) kind: GuardKind,
    #[serde(skip)]
    pub(crate) post: Cell,
    #[serde(skip)]
    pub(crate) post_heading: Heading,
    #[serde(skip)]
    pub(crate) duty: Duty,
    pub(crate) motion: GuardMotion,
    pub(crate) state: GuardActivity,
    /// From 0 to [`ALARMED`].
    pub(crate) awareness: u16,
    pub(crate) quarry: Option<KnownPlayer>,
    /// Whether the guard has been alarmed before. Set only on the hardest difficulty.
    pub(crate) is_wary: bool,
    /// The index of the next stop of a patrol.
    pub(crate) stop: usize,
    /// The destination of a guard who wanders.
    pub(crate) errand: Option<Cell>,
    /// The remaining steps for which the guard stands still on duty or looks around.
    pub(crate) pause: u16,
    /// The angle by which the guard looks aside during a pause, in radians.
    pub(crate) glance: f64,
    /// The number of steps until the guard may strike again, until they stand firmly, and until
    /// they may notice players by sight or smell again.
    pub(crate) rest: u16,
    pub(crate) stagger: u16,
    pub(crate) blind: u16,
    /// The number of steps for which the guard has followed a player in vain.
    pub(crate) baffled: u16,
    /// Whether a floor has moved under the guard.
    pub(crate) is_unsettled: bool,
    pub(crate) route: Route,
    /// The velocity and the direction of view that the guard wants in this step.
    pub(crate) wanted: DVec2,
    pub(crate) look: Option<DVec2>,
    /// The distance walked, in paces.
    pub(crate) paces: f64,
    pub(crate) random: SplitMix64,
}

/// A guard's activity, as the simulation stores it. Times are in steps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum GuardActivity {
    Asleep,
    OnDuty,
    /// Looks towards a place for a while, and then walks there if `goes` is true.
    Wondering {
        about: DVec2,
        looks: u16,
        goes: bool,
        hurries: bool,
        wakes: Option<usize>,
    },
    /// Visits cells around a place.
    Searching {
        around: Cell,
        next: Option<Cell>,
        left: u16,
    },
    /// Follows a player's trail; `mark` is the number of the current mark.
    Tracking {
        target: usize,
        mark: u64,
        lost: u16,
    },
    /// Follows a player once the fright has passed.
    Chasing {
        fright: u16,
    },
    Attacking {
        phase: AttackPhase,
        left: u16,
    },
    Down {
        left: u16,
    },
    Returning,
}

/// The phases of an attack.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum AttackPhase {
    /// The warning.
    Windup,
    /// The blow itself. `has_hit` is true once it has hit.
    Strike { has_hit: bool },
    /// The rest after the blow.
    Recovery,
}

/// A guard's knowledge of the player that they look for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct KnownPlayer {
    /// The index of the player.
    pub(crate) target: usize,
    /// The position at which the player was last perceived.
    pub(crate) position: DVec2,
    /// The number of steps since then.
    pub(crate) unseen: u16,
}

/// The path of a guard.
#[derive(Clone, Copy, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Route {
    pub(crate) goal: Option<Cell>,
    /// The point that the guard walks to now.
    pub(crate) point: Option<DVec2>,
    /// The cell from which the point was found.
    pub(crate) from: Option<Cell>,
    /// The number of steps for which the point remains in use.
    pub(crate) fresh: u16,
    /// The number of steps for which the guard has not moved, and for which they will still walk
    /// with care.
    pub(crate) still: u16,
    pub(crate) care: u16,
}

/// A guard's activity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Mood {
    /// Sleeps.
    Asleep,
    /// Stands, patrols or wanders.
    OnDuty,
    /// Has noticed something and goes to see.
    Wondering,
    /// Searches the surrounding cells for the player.
    Searching,
    /// Follows the player.
    Chasing,
    /// Strikes or shoots.
    Attacking,
    /// Lies on the floor.
    Down,
    /// Goes back to duty.
    Returning,
}

/// The state of alarm of a level's guards.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default, Serialize, Deserialize,
)]
pub enum Alarm {
    /// No guard has noticed anything.
    #[default]
    Calm,
    /// A guard wonders or searches.
    Wary,
    /// A guard follows the player.
    Raised,
}

/// A guard as seen from outside the simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GuardView {
    /// The kind of guard.
    pub kind: GuardKind,
    /// The position, in cells.
    pub position: DVec2,
    /// The height of the feet, in cells.
    pub feet: f64,
    /// The direction in which the guard looks.
    pub heading: Heading,
    /// The guard's activity.
    pub mood: Mood,
    /// Whether the guard lies on the floor.
    pub is_down: bool,
    /// How sure the guard is of a player, from 0 to [`GuardView::SURE`].
    pub awareness: u16,
}

impl GuardView {
    /// The awareness at which a guard raises the alarm.
    pub const SURE: u16 = ALARMED;

    /// The range in cells and the cosine of half the angle of the guard's sight on duty; `None` if
    /// the guard does not look.
    pub(crate) fn sight(&self) -> Option<(f64, f64)> {
        let looks = !self.is_down && self.mood != Mood::Asleep;
        let sight = abilities(self.kind).sight.filter(|_| looks)?;
        Some((sight.range, sight.least_cosine))
    }

    /// The guard's eye.
    pub(crate) fn eye(&self) -> Point {
        Point { position: self.position, height: self.feet + abilities(self.kind).eye }
    }
}

impl Guard {
    pub(crate) fn new(world: &World, post: &GuardPost, index: usize, seed: u64) -> Self {
        let is_asleep = post.duty == Duty::Sleep;
        Self {
            kind: post.kind,
            post: post.cell,
            post_heading: post.heading,
            duty: post.duty.clone(),
            motion: GuardMotion::new(world, post.cell, post.heading),
            state: if is_asleep { GuardActivity::Asleep } else { GuardActivity::OnDuty },
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

    /// Lays the guard on the floor.
    pub(crate) fn stun(&mut self, steps: u16) {
        self.state = GuardActivity::Down { left: steps.max(1) };
        self.motion.body.velocity = DVec2::ZERO;
        (self.awareness, self.quarry, self.stagger) = (0, None, 0);
    }

    /// Makes a guard who lies on the floor stand up and look around.
    pub(crate) fn get_up(&mut self) {
        self.state = GuardActivity::Searching { around: self.motion.cell(), next: None, left: 600 };
        self.pause = 60;
    }

    /// Pushes the guard along `direction`, a unit vector.
    pub(crate) fn push(&mut self, direction: DVec2) {
        if self.state.is_down() {
            return;
        }
        self.stagger = STAGGER_STEPS;
        self.motion.body.velocity = direction * PUSH;
        match self.state {
            GuardActivity::Attacking { .. } => self.state = GuardActivity::Chasing { fright: 0 },
            GuardActivity::Asleep => {
                let about = self.motion.position() - direction;
                self.state = GuardActivity::Wondering {
                    about,
                    looks: 30,
                    goes: true,
                    hurries: false,
                    wakes: None,
                };
            }
            _ => {}
        }
    }

    /// Makes a sound and looks towards `about`. If `goes` is true, the guard then walks there.
    pub(crate) fn begin_to_wonder(&mut self, context: &mut Context, about: DVec2, goes: bool) {
        let looks = if self.state == GuardActivity::Asleep { LOOK_STEPS * 2 } else { LOOK_STEPS };
        self.state = GuardActivity::Wondering { about, looks, goes, hurries: false, wakes: None };
        context.sound(SoundKind::Wonder, self.motion.cell(), 7);
    }

    pub(crate) fn begin_to_search(&mut self, around: Cell, left: u16) {
        self.state = GuardActivity::Searching { around, next: None, left };
        self.pause_a_while(50, 70);
    }

    /// Returns to duty, with a sound.
    pub(crate) fn give_up(&mut self, context: &mut Context) {
        context.sound(SoundKind::GiveUp, self.motion.cell(), 7);
        self.state = GuardActivity::Returning;
        (self.awareness, self.quarry, self.errand) = (0, None, None);
    }

    /// Calls the other guards and begins to chase.
    pub(crate) fn raise_alarm(&mut self, context: &mut Context) {
        let (kind, reach) = match self.kind {
            GuardKind::Lantern => (SoundKind::Bell, Sound::FARTHEST),
            GuardKind::Hound => (SoundKind::Bark, 10),
            _ => (SoundKind::Shout, 12),
        };
        context.sound(kind, self.motion.cell(), reach);
        self.awareness = ALARMED;
        self.baffled = 0;
        self.is_wary |= context.rules.difficulty == Difficulty::Hard;
        let is_ringing = self.kind == GuardKind::Lantern;
        self.state = GuardActivity::Chasing {
            fright: if is_ringing { RINGING_STEPS } else { FRIGHT_STEPS },
        };
    }

    /// Stands still for a random number of steps between `least` and `most`, and looks to a random
    /// side.
    pub(crate) fn pause_a_while(&mut self, least: u16, most: u16) {
        self.pause = self.random.whole(i32::from(least), i32::from(most)) as u16;
        self.glance = match self.random.below(3) {
            0 => -GLANCE,
            1 => GLANCE,
            _ => 0.0,
        };
    }

    pub(crate) fn abilities(&self) -> &'static Abilities {
        abilities(self.kind)
    }

    pub(crate) fn gait(&self) -> Gait {
        Gait { opens_doors: self.abilities().opens_doors, height: self.kind.height() }
    }

    /// The height of the top of the head.
    pub(crate) fn head(&self) -> f64 {
        self.motion.feet + self.kind.height()
    }

    /// The middle of the body.
    pub(crate) fn middle(&self) -> Point {
        let height = self.motion.feet + self.kind.height() / 2.0;
        Point { position: self.motion.position(), height }
    }

    /// Whether this guard has a clear line of sight to the middle of a player, in any direction and
    /// light.
    pub(crate) fn has_line_to(&self, context: &Context, target: &PerceivedPlayer) -> bool {
        self.sees(context, target.position, target.middle())
    }

    /// Whether this guard has a clear line of sight to a point, in any direction and light.
    pub(crate) fn sees(&self, context: &Context, position: DVec2, height: f64) -> bool {
        is_in_sight(context.world, context.clouds, self.eye(), Point { position, height })
    }

    /// Returns true if this guard is awake and could see `point` by looking that way, however dark
    /// it is there.
    pub(crate) fn may_see(&self, world: &World, point: Point) -> bool {
        let range = self.abilities().sight.map_or(0.0, |sight| sight.range);
        let is_awake = !self.state.is_down() && self.state != GuardActivity::Asleep;
        let eye = self.eye();
        is_awake
            && eye.position.distance(point.position) <= range
            && is_in_sight(world, &[], eye, point)
    }

    pub(crate) fn eye(&self) -> Point {
        let height = self.motion.feet + self.abilities().eye;
        Point { position: self.motion.position(), height }
    }

    /// Returns true if the guard does nothing until something wakes them.
    pub(crate) fn is_asleep(&self) -> bool {
        self.state == GuardActivity::Asleep && self.stagger == 0
    }

    pub(crate) fn view(&self) -> GuardView {
        GuardView {
            kind: self.kind,
            position: self.motion.position(),
            feet: self.motion.feet,
            heading: self.motion.heading,
            mood: self.state.mood(),
            is_down: self.state.is_down(),
            awareness: self.awareness,
        }
    }

    pub(crate) fn as_other(&self) -> PerceivedGuard {
        let is_down = self.state.is_down();
        PerceivedGuard { position: self.motion.position(), feet: self.motion.feet, is_down }
    }

    /// The frame of the sprite.
    pub(crate) fn frame(&self) -> u8 {
        let is_walking = self.motion.body.velocity.length_squared() > 0.04;
        match self.state {
            GuardActivity::Down { .. } => 6,
            GuardActivity::Asleep => 7,
            GuardActivity::Attacking { phase: AttackPhase::Windup, .. } => 4,
            GuardActivity::Attacking { phase: AttackPhase::Strike { .. }, .. } => 5,
            GuardActivity::Chasing { fright } if fright > 0 => 3,
            _ if is_walking => 1 + (self.paces as u64 % 2) as u8,
            GuardActivity::Wondering { .. } | GuardActivity::Chasing { .. } => 3,
            _ => 0,
        }
    }

    /// Returns an error if a step of `count` guards could fail in this state.
    pub(crate) fn check(&self, world: &World, count: usize) -> Result<(), RestoreError> {
        check_on_map(world, self.motion.position())?;
        if let Some(quarry) = self.quarry {
            check_on_map(world, quarry.position)?;
        }
        let stops = match &self.duty {
            Duty::Patrol(stops) => stops.len(),
            Duty::Stand | Duty::Sleep | Duty::Wander(_) => 1,
        };
        let wakes_nobody_else = match self.state {
            GuardActivity::Wondering { wakes, .. } => wakes.is_none_or(|index| index < count),
            _ => true,
        };
        check(wakes_nobody_else, "whom a guard wakes")?;
        let counts = self.awareness <= ALARMED
            && self.stop < stops.max(1)
            && self.baffled <= MAX_BAFFLED_STEPS
            && self.route.still <= STUCK_STEPS
            && (0.0..MAX_PACES).contains(&self.paces)
            && self.state != (GuardActivity::Down { left: 0 });
        check(counts, "a count of a guard")
    }

    /// Moves the guard with the window of a generated level. Returns `false` if the guard is
    /// outside it now. A remembered cell outside the window becomes the guard's own cell.
    pub(crate) fn shift(&mut self, shift: WindowShift) -> bool {
        let Some(here) = shift.cell(self.motion.cell()) else { return false };
        let cell = |cell: Cell| shift.cell(cell).unwrap_or(here);
        let place = |place: DVec2| shift.position(place);
        self.motion.body.position = place(self.motion.position());
        self.post = cell(self.post);
        if let Duty::Patrol(stops) = &mut self.duty {
            for stop in stops {
                *stop = cell(*stop);
            }
        }
        self.errand = self.errand.map(cell);
        if let Some(quarry) = &mut self.quarry {
            quarry.position = place(quarry.position);
        }
        match &mut self.state {
            GuardActivity::Wondering { about, wakes, .. } => {
                (*about, *wakes) = (place(*about), None);
            }
            GuardActivity::Searching { around, next, .. } => {
                (*around, *next) = (cell(*around), next.map(cell));
            }
            GuardActivity::Tracking { .. } => self.begin_to_search(here, 360),
            GuardActivity::Asleep
            | GuardActivity::OnDuty
            | GuardActivity::Chasing { .. }
            | GuardActivity::Attacking { .. }
            | GuardActivity::Down { .. }
            | GuardActivity::Returning => {}
        }
        self.route = Route::default();
        true
    }
}

impl OfLevel for Guard {
    fn of_level(self, start: Self) -> Result<Self, RestoreError> {
        let Self { kind, post, post_heading, duty, .. } = start;
        if self.kind != kind {
            return Err(RestoreError::OtherLevel);
        }
        Ok(Self { post, post_heading, duty, motion: self.motion.facing_ahead(), ..self })
    }
}

impl GuardActivity {
    pub(crate) fn mood(self) -> Mood {
        match self {
            Self::Asleep => Mood::Asleep,
            Self::OnDuty => Mood::OnDuty,
            Self::Wondering { .. } => Mood::Wondering,
            Self::Searching { .. } | Self::Tracking { .. } => Mood::Searching,
            Self::Chasing { .. } => Mood::Chasing,
            Self::Attacking { .. } => Mood::Attacking,
            Self::Down { .. } => Mood::Down,
            Self::Returning => Mood::Returning,
        }
    }

    pub(crate) fn is_down(self) -> bool {
        matches!(self, Self::Down { .. })
    }

    /// Whether the guard follows or strikes a player.
    pub(crate) fn is_alarmed(self) -> bool {
        matches!(self, Self::Chasing { .. } | Self::Attacking { .. })
    }
}

impl Mood {
    /// The alarm of a level in which one guard has this mood and all others are on duty.
    pub(crate) const fn alarm(self) -> Alarm {
        match self {
            Self::Asleep | Self::OnDuty | Self::Down | Self::Returning => Alarm::Calm,
            Self::Wondering | Self::Searching => Alarm::Wary,
            Self::Chasing | Self::Attacking => Alarm::Raised,
        }
    }
}
