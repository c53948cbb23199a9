//! Missiles: pebbles, darts and flasks that a player throws or shoots, and bolts of archers.
//!
//! A missile is a point with a small radius that collides like a player. Its height follows a
//! parabola or a straight line. A missile ends at the first obstacle, at the floor, or at the first
//! body in its way. Darts hit guards, and bolts hit players.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::game::collision::{Radius, Stature, WorldObstacles, fly};
use crate::game::fall::GRAVITY;
use crate::game::guards::Guards;
use crate::game::player::{Motion, RADIUS};
use crate::game::rules::STEP;
use crate::game::stored::{RestoreError, check};
use crate::generate::WindowShift;
use crate::world::{Cell, World};

/// The radius of every missile, in cells.
const SIZE: Radius = Radius::new(0.04).expect("it is between nothing and a half");
/// The number of steps after which a missile in flight is removed.
const MAX_STEPS: u16 = 240;
/// The distance beside the body at which a bolt still hits a player, in cells.
const MARGIN: f64 = 0.05;

/// The height of a throw above the player's feet, in cells.
const HAND: f64 = 0.45;

/// The missiles in flight, in the order in which they were launched.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Missiles {
    flying: Vec<Missile>,
}

/// A missile in flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Missile {
    pub(crate) kind: MissileKind,
    pub(crate) position: DVec2,
    /// The height above the map's own floor, in cells.
    pub(crate) height: f64,
    /// Cells per second.
    pub(crate) velocity: DVec2,
    /// Cells per second, upwards.
    rising: f64,
    steps: u16,
}

/// A kind of missile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) enum MissileKind {
    Pebble,
    /// A dart that the player with index `by` has shot.
    Dart {
        by: usize,
    },
    Flask,
    /// A bolt that takes `points` of health. The guard with index `by` has shot it from `from`.
    Bolt {
        points: u8,
        from: DVec2,
        by: usize,
    },
}

/// A missile that has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LandedMissile {
    pub(crate) missile: Missile,
    pub(crate) cell: Cell,
    pub(crate) struck: MissileTarget,
}

/// The target that a missile has hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MissileTarget {
    /// No body: the missile hit a wall or the floor, or flew for too long.
    Nothing,
    Guard(usize),
    /// The player with that index.
    Player(usize),
}

impl Missile {
    /// A pebble, which lands six cells ahead on level floor.
    pub(crate) fn pebble(from: (DVec2, f64), ahead: DVec2) -> Self {
        Self::thrown(MissileKind::Pebble, from, ahead * 9.0, 6.0 / 9.0)
    }

    /// A flask, which lands three cells ahead on level floor.
    pub(crate) fn flask(from: (DVec2, f64), ahead: DVec2) -> Self {
        Self::thrown(MissileKind::Flask, from, ahead * 6.0, 3.0 / 6.0)
    }

    /// A dart, which flies straight ahead, or to `aim` if there is one.
    pub(crate) fn dart(
        (position, height): (DVec2, f64),
        ahead: DVec2,
        aim: Option<(DVec2, f64)>,
        by: usize,
    ) -> Self {
        const SPEED: f64 = 14.0;
        let to_aim = aim.and_then(|(target, middle)| {
            let way = target - position;
            Some((way.try_normalize()?, (middle - height) / way.length()))
        });
        let (direction, slope) = to_aim.unwrap_or((ahead, 0.0));
        Self {
            kind: MissileKind::Dart { by },
            position,
            height,
            velocity: direction * SPEED,
            rising: slope * SPEED,
            steps: 0,
        }
    }

    /// A bolt by the guard `by` along `direction`, a unit vector. It rises by `slope` for each
    /// cell.
    pub(crate) fn bolt(
        (position, height): (DVec2, f64),
        direction: DVec2,
        slope: f64,
        (by, points): (usize, u8),
    ) -> Self {
        const SPEED: f64 = 10.0;
        Self {
            kind: MissileKind::Bolt { points, from: position, by },
            position,
            height,
            velocity: direction * SPEED,
            rising: slope * SPEED,
            steps: 0,
        }
    }

    /// A missile that is `HAND` below its start after `seconds`.
    fn thrown(
        kind: MissileKind,
        (position, height): (DVec2, f64),
        velocity: DVec2,
        seconds: f64,
    ) -> Self {
        let rising = GRAVITY / 2.0 * seconds - HAND / seconds;
        Self { kind, position, height, velocity, rising, steps: 0 }
    }

    fn falls(&self) -> bool {
        matches!(self.kind, MissileKind::Pebble | MissileKind::Flask)
    }

    /// Moves the missile by one step. Returns whether it has hit a wall or the floor, or has flown
    /// for too long.
    fn step(&mut self, world: &World) -> bool {
        let stature = Stature { feet: self.height, height: 0.0 };
        let place = WorldObstacles {
            world,
            stature,
            step: 0.0,
            has_shapes: world.tile_facts().have_shapes,
            others: &[],
        };
        let (position, is_stopped) = fly(&place, self.position, self.velocity * STEP, SIZE);
        self.position = position;
        let room = place.room(position, SIZE);
        let pull = if self.falls() { GRAVITY } else { 0.0 };
        let rising = self.rising - pull * STEP;
        let height = self.height + f64::midpoint(self.rising, rising) * STEP;
        let ceiling = room.ceiling.max(room.floor);
        self.rising = if height > ceiling { 0.0 } else { rising };
        self.height = height.clamp(room.floor, ceiling);
        self.steps += 1;
        is_stopped || height <= room.floor || self.steps >= MAX_STEPS
    }

    fn cell(&self) -> Cell {
        Cell::at(self.position)
    }
}

impl Missiles {
    /// Whether no missile is in flight.
    pub(crate) fn is_empty(&self) -> bool {
        self.flying.is_empty()
    }

    /// The missiles in flight.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Missile> + Clone {
        self.flying.iter()
    }

    /// Adds a missile.
    pub(crate) fn launch(&mut self, missile: Missile) {
        self.flying.push(missile);
    }

    /// Moves all missiles by one step. Removes and returns the missiles that have ended.
    pub(crate) fn step(
        &mut self,
        world: &World,
        guards: &Guards,
        players: &(impl Iterator<Item = (usize, Motion)> + Clone),
    ) -> Vec<LandedMissile> {
        let mut landed = Vec::new();
        self.flying.retain_mut(|missile| {
            let from = (missile.position, missile.height);
            let has_ended = missile.step(world);
            let to = (missile.position, missile.height);
            let struck = match missile.kind {
                MissileKind::Dart { .. } => guards.hit_between(from, to).map(MissileTarget::Guard),
                MissileKind::Bolt { .. } => {
                    let mut players = players.clone();
                    let struck = players.find(|(_, player)| hits(player, from, to));
                    struck.map(|(index, _)| MissileTarget::Player(index))
                }
                MissileKind::Pebble | MissileKind::Flask => None,
            };
            let is_over = has_ended || struck.is_some();
            if is_over {
                let struck = struck.unwrap_or(MissileTarget::Nothing);
                landed.push(LandedMissile { missile: *missile, cell: missile.cell(), struck });
            }
            !is_over
        });
        landed
    }

    /// Returns an error if a missile has flown for too long.
    pub(crate) fn check(&self) -> Result<(), RestoreError> {
        check(self.flying.iter().all(|missile| missile.steps < MAX_STEPS), "a missile")
    }

    /// The same missiles in a window that has moved.
    pub(crate) fn shift(&mut self, shift: WindowShift) {
        let flying = self.flying.iter_mut();
        flying.for_each(|missile| missile.position = shift.position(missile.position));
    }
}

/// Whether a missile that moves from `from` to `to` hits the player's body.
fn hits(player: &Motion, from: (DVec2, f64), to: (DVec2, f64)) -> bool {
    let way = to.0 - from.0;
    let along = if way == DVec2::ZERO {
        0.0
    } else {
        ((player.position() - from.0).dot(way) / way.length_squared()).clamp(0.0, 1.0)
    };
    let height = from.1 + (to.1 - from.1) * along;
    let distance = (from.0 + way * along).distance(player.position());
    distance <= RADIUS.cells() + MARGIN && (player.feet()..=player.head()).contains(&height)
}
