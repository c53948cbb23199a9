//! Crowding: a guard who is awake pushes a player away who touches them.
//!
//! - The push is slower than any walk and leads a little aside, so that a player who walks on gets past,
//!   and nobody is ever held between a guard and a wall.
//! - It moves the player on level floor only: over no edge, and onto no step.
//! - Guards do not feel it.
//!
//! Solid bodies were refused: 20 of the 36 scripts that win pass through a guard, and a guard on duty
//! in a corridor would close it.

use glam::DVec2;

use super::player::{RADIUS, WALK};
use super::{Game, STEP};

/// The distance between the middles of two bodies that touch, in cells.
const TOUCH: f64 = 2.0 * RADIUS.cells();
/// The speed of the push in cells per second; that of a player who ducks is half of [`WALK`].
const SPEED: f64 = 0.45 * WALK;
/// The direction of the push, from that of the way out: 30° to the right.
const ASIDE: DVec2 = DVec2::new(0.866_025_403_784_439, 0.5);

impl Game {
    /// Moves the player away from the guards whom they touch.
    pub(crate) fn give_way(&mut self) {
        let motion = self.player.motion;
        let bodies = self.guards.touching(motion.position(), TOUCH, motion.feet(), motion.head());
        let push: DVec2 = bodies.map(|body| push_from(body, motion.position())).sum();
        if push != DVec2::ZERO {
            let displacement = push.clamp_length_max(1.0) * (SPEED * STEP);
            self.player.motion = motion.moved_aside(&self.world, displacement);
        }
    }
}

/// The direction in which a guard at `body` pushes a player, as a unit vector.
fn push_from(body: DVec2, player: DVec2) -> DVec2 {
    (player - body).try_normalize().unwrap_or(DVec2::X).rotate(ASIDE)
}
