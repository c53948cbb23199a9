//! Where everybody was in the last steps, by which acts are judged.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::{MOST_LAG, PlayerId};
use crate::game::Game;
use crate::game::player::{Motion, RADIUS};
use crate::game::sight::{Point, is_in_sight};
use crate::world::World;

/// The number of positions that are remembered: those of this step and of the last ones.
const STEPS: usize = MOST_LAG as usize + 1;
/// How far beyond their bodies players touch, in cells.
const TOUCH: f64 = 0.25;

/// Where a player was in the last steps.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Track([Option<Stand>; STEPS]);

/// Where a player was in a step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Stand {
    pub(crate) position: DVec2,
    /// The unit vector of the heading.
    pub(crate) facing: DVec2,
    feet: f64,
    head: f64,
}

impl Track {
    /// Records where a player stands at the end of the step `now`; `None` if they do not play.
    /// Returns how far they have moved in that step, in cells.
    pub(crate) fn record(&mut self, now: u64, motion: Option<&Motion>) -> f64 {
        let stand = motion.map(Stand::new);
        let before = now.checked_sub(1).and_then(|before| self.at(before).copied());
        self.0[now as usize % STEPS] = stand;
        let way = stand.zip(before).map(|(now, before)| now.position.distance(before.position));
        way.unwrap_or_default()
    }

    /// Where the player was in the step `seen`.
    fn at(&self, seen: u64) -> Option<&Stand> {
        self.0[seen as usize % STEPS].as_ref()
    }
}

impl Stand {
    fn new(motion: &Motion) -> Self {
        let facing = motion.heading().direction();
        let (feet, head) = (motion.feet(), motion.head());
        Self { position: motion.position(), facing, feet, head }
    }

    /// Whether an arm reaches from here to `other`: the bodies are at most `reach` apart, at one
    /// height, with nothing between.
    pub(crate) fn reaches(&self, world: &World, other: &Self, reach: f64) -> bool {
        let distance = self.position.distance(other.position);
        let overlaps = self.feet < other.head && other.feet < self.head;
        overlaps && distance <= reach && is_in_sight(world, &[], self.middle(), other.middle())
    }

    fn middle(&self) -> Point {
        Point { position: self.position, height: f64::midpoint(self.feet, self.head) }
    }
}

impl Game {
    /// Whether two players touched each other in the step `seen`, which counts as at most
    /// [`MOST_LAG`] steps ago. The dead, and those who have reached the exit, touch nobody.
    pub fn touches(&self, one: PlayerId, other: PlayerId, seen: u64) -> bool {
        let stands = [one, other].map(|player| self.stood(player.index(), seen));
        let [Some(one_stood), Some(other_stood)] = stands else { return false };
        one != other && one_stood.reaches(&self.world, other_stood, 2.0 * RADIUS.cells() + TOUCH)
    }

    /// Where a player stood in the step `seen`.
    pub(crate) fn stood(&self, index: usize, seen: u64) -> Option<&Stand> {
        let seen = self.clamp_seen(seen);
        self.members.as_ref()?.member(index)?.track.at(seen)
    }

    /// The step that a player saw, as far as it counts.
    pub(crate) fn clamp_seen(&self, seen: u64) -> u64 {
        seen.clamp(self.steps.saturating_sub(MOST_LAG), self.steps)
    }
}
