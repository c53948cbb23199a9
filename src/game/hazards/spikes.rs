//! Spikes: they come out of the floor at intervals, and announce it by a picture and a sound.
//!
//! What they do depends on the number of steps since the start alone.

use serde::{Deserialize, Serialize};

use crate::game::noise::reach;
use crate::game::sound::{Sound, SoundKind, Source};
use crate::game::stored::{OfLevel, Unrestorable};
use crate::world::sprite::builtin::SpikesFrame;
use crate::world::{Cell, Rhythm, ThingKind, World};

/// The steps for which they rise, which warns, and for which they are out.
const WARNING: u64 = 30;
const OUT: u64 = 24;
/// How high they come out, in cells.
pub(crate) const HEIGHT: f64 = 0.4;

/// All spikes of a level.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Spikes {
    /// In the order of the world's things.
    each: Vec<Spike>,
}

impl OfLevel for Spikes {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        Ok(Self { each: self.each.of_level(start.each)? })
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Spike {
    cell: Cell,
    rhythm: Rhythm,
    /// What they show.
    phase: Phase,
}

impl OfLevel for Spike {
    fn of_level(self, start: Self) -> Result<Self, Unrestorable> {
        Ok(Self { phase: self.phase, ..start })
    }
}

/// The position of spikes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Phase {
    In,
    Rising,
    Out,
}

impl Spikes {
    /// The spikes of `world`, which show that they are in.
    pub(crate) fn new(world: &mut World) -> Self {
        let each: Vec<Spike> = world
            .things()
            .iter()
            .filter_map(|thing| match thing.kind {
                ThingKind::Spikes(rhythm) => {
                    Some(Spike { cell: thing.cell, rhythm, phase: Phase::In })
                }
                _ => None,
            })
            .collect();
        for spike in &each {
            spike.show(world);
        }
        Self { each }
    }

    /// The number of spikes.
    pub(crate) fn count(&self) -> usize {
        self.each.len()
    }

    /// Shows the spikes as they are in the step `now`, and adds a sound for those that begin to rise.
    /// Returns whether any has changed.
    pub(crate) fn show(&mut self, world: &mut World, now: u64, sounds: &mut Vec<Sound>) -> bool {
        let mut has_changed = false;
        for spike in &mut self.each {
            let phase = spike.rhythm.phase(now);
            if phase != spike.phase {
                spike.phase = phase;
                spike.show(world);
                sounds.extend((phase == Phase::Rising).then(|| spike.warning()));
                has_changed = true;
            }
        }
        has_changed
    }

    /// The step in which the spikes in `cell` came out that are out in the step `now`; `None` if
    /// there are none.
    pub(crate) fn thrust_in(&self, cell: Cell, now: u64) -> Option<u64> {
        let spike = self.each.iter().find(|spike| spike.cell == cell)?;
        (spike.rhythm.phase(now) == Phase::Out).then(|| now - spike.rhythm.age(now))
    }

    /// The number of steps from `now` in which no spikes change; `None` if there are none.
    pub(crate) fn quiet_steps(&self, now: u64) -> Option<u64> {
        let quiet = self.each.iter().map(|spike| {
            let is_shown = spike.phase == spike.rhythm.phase(now);
            if is_shown { spike.rhythm.steps_left(now) } else { 0 }
        });
        quiet.min()
    }
}

impl Spike {
    /// The sound that they make before they come out.
    fn warning(&self) -> Sound {
        let (kind, by) = (SoundKind::Spikes, Source::Object);
        Sound { kind, cell: self.cell, reach: reach::SPIKES, by }
    }

    fn show(&self, world: &mut World) {
        let is_it = |kind| matches!(kind, ThingKind::Spikes(_));
        let frame = match self.phase {
            Phase::In => SpikesFrame::In,
            Phase::Rising => SpikesFrame::Rising,
            Phase::Out => SpikesFrame::Out,
        };
        world.set_frame(self.cell, is_it, frame.index());
    }
}

impl Rhythm {
    /// The steps since they last came out, had they always done so.
    fn age(self, now: u64) -> u64 {
        let (period, delay) = (u64::from(self.period), u64::from(self.delay));
        (now + period - delay % period) % period
    }

    fn phase(self, now: u64) -> Phase {
        let period = u64::from(self.period);
        let is_before = now < u64::from(self.delay);
        match self.age(now) {
            age if age < OUT && !is_before => Phase::Out,
            age if age + WARNING >= period => Phase::Rising,
            _ => Phase::In,
        }
    }

    /// The number of steps from `now` in which the phase stays the same; at least one.
    fn steps_left(self, now: u64) -> u64 {
        let (age, period) = (self.age(now), u64::from(self.period));
        match self.phase(now) {
            Phase::Out => OUT - age,
            Phase::In => period - WARNING - age,
            Phase::Rising => period - age,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn spikes_warn_before_they_come_out_and_say_how_long_they_rest(
            period in 60..=3600_u16,
            delay in 0..3600_u16,
            now in 3600..9000_u64,
        ) {
            let rhythm = Rhythm { period, delay: delay % period };
            let phase = rhythm.phase(now);
            let left = rhythm.steps_left(now);
            prop_assert!((0..left).all(|step| rhythm.phase(now + step) == phase));
            prop_assert!(rhythm.phase(now + left) != phase);
            if phase == Phase::Out {
                let thrust = now - rhythm.age(now);
                prop_assert!((1..=24).all(|step| rhythm.phase(thrust - step) == Phase::Rising));
            }
        }

        #[test]
        fn they_first_come_out_after_their_delay(period in 60..=3600_u16, delay in 0..3600_u16) {
            let rhythm = Rhythm { period, delay: delay % period };
            let first = (0..7200).find(|&step| rhythm.phase(step) == Phase::Out);
            prop_assert_eq!(first, Some(u64::from(rhythm.delay)));
        }
    }
}
