//! The checksum of a game: a number that games in different states very likely do not share.
//!
//! It tells whether a replay, or a game on another machine, is still the same game. Only values
//! that rules depend on are part of it, as whole numbers and bits of doubles, so that it is the same
//! on every machine.

use glam::DVec2;

use super::Game;
use super::health::Cause;
use super::player::Player;
use super::tools::MissileKind;
use crate::rng;
use crate::world::{Cell, Supply, Thing, ThingKind, World};

impl Game {
    /// A number that depends on the whole state: of the world, the player, the guards and all that
    /// moves.
    pub fn checksum(&self) -> u64 {
        let players = match &self.members {
            None => rng::hash(0, words_of_player(&self.player)),
            Some(members) => rng::hash(0, members.words()),
        };
        let counts = self.player.counts;
        let parts = [
            self.steps,
            players,
            rng::hash(1, words_of_world(&self.world)),
            rng::hash(2, self.mechanisms.words()),
            rng::hash(3, self.words_of_missiles()),
            self.guards.checksum(),
            u64::from(counts.alarms),
            u64::from(counts.deaths) << 32 | u64::from(counts.stunned),
        ];
        let seed = self.rules.seed ^ self.rules.difficulty as u64;
        rng::hash(seed, parts)
    }

    fn words_of_missiles(&self) -> impl Iterator<Item = u64> {
        let missiles = self.missiles.iter().flat_map(|missile| {
            let kind = match missile.kind {
                MissileKind::Pebble => 0,
                MissileKind::Dart { .. } => 1,
                MissileKind::Flask => 2,
                MissileKind::Bolt { points, .. } => 3 + u64::from(points),
            };
            let [x, y] = words_of(missile.position);
            let [across, down] = words_of(missile.velocity);
            [kind, x, y, missile.height.to_bits(), across, down]
        });
        let clouds = self.smoke.clouds().iter().flat_map(|cloud| words_of(cloud.position));
        missiles.chain(clouds).chain(self.smoke.lives().map(u64::from))
    }
}

/// What rules depend on of a player.
pub(crate) fn words_of_player(player: &Player) -> impl Iterator<Item = u64> {
    let supplies = Supply::ALL.map(|supply| u64::from(player.supplies.count(supply)));
    let keys = player.keys.iter().fold(0_u64, |bits, key| bits.rotate_left(9) ^ u64::from(key.0));
    let numbers = [
        u64::from(player.health.points) ^ player.warnings.word(),
        u64::from(player.treasure),
        u64::from(player.has_light),
        u64::from(player.strike_wait),
        u64::from(player.in_water),
        player.stride.to_bits(),
        player.fell_from.to_bits(),
        player.last_thrust.map_or(u64::MAX, |step| step),
        keys,
        player.killed_by.map_or(0, word_of_cause),
    ];
    player.motion.words().into_iter().chain(supplies).chain(numbers)
}

/// A position as the bits of its coordinates.
pub(crate) fn words_of(position: DVec2) -> [u64; 2] {
    position.to_array().map(f64::to_bits)
}

/// The tiles, the openings of doors, and the things with their frames.
fn words_of_world(world: &World) -> impl Iterator<Item = u64> {
    let rows = world.grid().rows();
    let tiles = rows.map(|row| rng::hash(0, row.iter().map(|tile| u64::from(tile.0))));
    let openings = world
        .openings()
        .map(|(cell, opening)| rng::hash(word_of(cell), [opening.part().to_bits()]));
    tiles.chain(openings).chain(world.things().iter().map(word_of_thing))
}

fn word_of_thing(thing: &Thing) -> u64 {
    let kind = match thing.kind {
        ThingKind::Exit => [0, 0],
        ThingKind::Key(key) => [1, u64::from(key.0)],
        ThingKind::Ornament => [2, 0],
        ThingKind::Treasure(worth) => [3, u64::from(worth)],
        ThingKind::Healing(points) => [4, u64::from(points)],
        ThingKind::Supply(supply, count) => [5, (supply as u64) << 8 | u64::from(count)],
        ThingKind::Note(id) => [6, u64::from(id.0)],
        ThingKind::Checkpoint => [7, 0],
        ThingKind::Lever(switch) => [8, u64::from(switch.0)],
        ThingKind::Spikes(rhythm) => [9, u64::from(rhythm.period) << 16 | u64::from(rhythm.delay)],
        ThingKind::Flame => [10, 0],
    };
    let frame = thing.frame.map_or(0, |frame| u64::from(frame) + 1);
    rng::hash(word_of(thing.cell), kind.into_iter().chain([frame]))
}

pub(crate) fn word_of(cell: Cell) -> u64 {
    u64::from(cell.row) << 32 | u64::from(cell.column)
}

fn word_of_cause(cause: Cause) -> u64 {
    match cause {
        Cause::Guard(kind) => 16 + kind as u64,
        Cause::Bolt => 1,
        Cause::Spikes => 2,
        Cause::Water => 3,
        Cause::Fall => 4,
    }
}
