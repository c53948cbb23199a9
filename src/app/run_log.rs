//! The log of a run: what the player has wanted since the level began, to be kept as a script.

use crate::game::{Intents, Stretch};

/// The stretches of a run so far.
#[derive(Clone, Debug, Default)]
pub(crate) struct RunLog {
    stretches: Vec<Stretch>,
}

impl RunLog {
    /// Records that the player wants `intents` for `steps` more steps.
    pub(crate) fn record(&mut self, intents: Intents, mut steps: u64) {
        while steps > 0 {
            let last = self.stretches.last_mut().filter(|last| last.intents == intents);
            let room = last.map_or(0, |last| {
                let taken = steps.min(u64::from(Stretch::MOST_STEPS - last.steps)) as u32;
                last.steps += taken;
                taken
            });
            steps -= u64::from(room);
            if room == 0 {
                let taken = steps.min(Stretch::MOST_STEPS.into()) as u32;
                self.stretches.push(Stretch { steps: taken, intents });
                steps -= u64::from(taken);
            }
        }
    }

    /// Whether nothing has been recorded.
    pub(crate) fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// The number of steps.
    pub(crate) fn steps(&self) -> u64 {
        self.stretches.iter().map(|stretch| u64::from(stretch.steps)).sum()
    }

    pub(crate) fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The script of the run, without a header.
    pub(crate) fn script(&self) -> String {
        self.stretches.iter().flat_map(|stretch| [stretch.to_string(), "\n".to_owned()]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::{Intent, Script};

    #[test]
    fn the_script_has_the_steps_that_were_recorded() {
        let run = [Intent::Run].into_iter().collect();
        let most = u64::from(Stretch::MOST_STEPS);
        let recorded = [(run, 3), (run, 4), (Intents::new(), 1), (run, 0), (run, 2 * most + 1)];
        let mut log = RunLog::default();
        assert!(log.is_empty());
        for (intents, steps) in recorded {
            log.record(intents, steps);
        }
        let script = Script::parse(&log.script(), "it").unwrap_or_else(|faults| panic!("{faults}"));
        let each =
            recorded.into_iter().flat_map(|(intents, steps)| (0..steps).map(move |_| intents));
        assert!(script.iter().map(|(_, intents)| intents).eq(each));
    }
}
