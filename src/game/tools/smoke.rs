//! Smoke: clouds that block the view for a while.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::game::sight::Cloud;
use crate::game::stored::{RestoreError, check};
use crate::generate::WindowShift;

/// The radius of a cloud in cells, and its duration in steps.
const RADIUS: f64 = 1.5;
const STEPS: u16 = 480;
/// The number of steps in which a cloud spreads, and in which it fades away.
const SPREADS: u16 = 12;
const FADES: u16 = 60;

/// The puffs of a cloud: their positions around its centre, in radii, and their heights in cells.
const PUFFS: [(f64, f64, f64); 7] = [
    (0.0, 0.0, 0.05),
    (0.62, 0.0, 0.0),
    (-0.62, 0.0, 0.1),
    (0.31, 0.54, 0.15),
    (-0.31, 0.54, 0.0),
    (0.31, -0.54, 0.1),
    (-0.31, -0.54, 0.05),
];

/// All clouds, oldest first.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Smoke {
    /// The clouds, in the form that lines of sight need.
    pub(crate) clouds: Vec<Cloud>,
    /// For each cloud, its height and the remaining steps.
    lives: Vec<Life>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Life {
    height: f64,
    left: u16,
}

/// A part of a cloud, as a frame shows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Puff {
    pub(crate) position: DVec2,
    pub(crate) height: f64,
    pub(crate) frame: u8,
    pub(crate) opacity: u8,
}

impl Smoke {
    /// Returns an error for clouds that the game cannot produce.
    pub(crate) fn check(&self) -> Result<(), RestoreError> {
        let are_possible = self.clouds.len() == self.lives.len()
            && self.clouds.iter().all(|cloud| cloud.radius == RADIUS)
            && self.lives.iter().all(|life| (1..=STEPS).contains(&life.left));
        check(are_possible, "a cloud")
    }

    /// Adds a cloud around `position`, above a floor of height `height`.
    pub(crate) fn add(&mut self, position: DVec2, height: f64) {
        self.clouds.push(Cloud { position, radius: RADIUS });
        self.lives.push(Life { height, left: STEPS });
    }

    /// Whether there are no clouds.
    pub(crate) fn is_empty(&self) -> bool {
        self.clouds.is_empty()
    }

    /// Advances all clouds by one step.
    pub(crate) fn step(&mut self) {
        self.lives.iter_mut().for_each(|life| life.left = life.left.saturating_sub(1));
        let mut lives = self.lives.iter();
        self.clouds.retain(|_| lives.next().is_some_and(|life| life.left > 0));
        self.lives.retain(|life| life.left > 0);
    }

    /// The puffs of all clouds.
    pub(crate) fn puffs(&self) -> impl Iterator<Item = Puff> + Clone {
        self.clouds.iter().zip(&self.lives).flat_map(|(cloud, life)| {
            let age = STEPS - life.left;
            let spread = f64::from(age.min(SPREADS)) / f64::from(SPREADS);
            let opacity = (u32::from(life.left.min(FADES)) * 230 / u32::from(FADES)) as u8;
            PUFFS.iter().zip(0_u16..).map(move |(&(across, down, up), index)| Puff {
                position: cloud.position + DVec2::new(across, down) * (cloud.radius * spread),
                height: life.height + up,
                frame: ((age / 10 + index) % 4) as u8,
                opacity,
            })
        })
    }

    /// The same clouds in a window that has moved.
    pub(crate) fn shift(&mut self, shift: WindowShift) {
        let clouds = self.clouds.iter_mut();
        clouds.for_each(|cloud| cloud.position = shift.position(cloud.position));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cloud_lasts_its_full_time() {
        let mut smoke = Smoke::default();
        smoke.add(DVec2::new(2.5, 2.5), 0.0);
        (1..STEPS).for_each(|_| smoke.step());
        assert_eq!(smoke.clouds.len(), 1);
        assert!(smoke.puffs().all(|puff| puff.opacity < 10));
        smoke.step();
        assert_eq!(smoke, Smoke::default());
    }
}
