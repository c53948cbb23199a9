//! A position in a script, from which it goes on step by step.

use crate::game::{Intents, Script, Stretch};

/// A script and the number of its steps that are over.
#[derive(Clone, Debug)]
pub(crate) struct ScriptCursor {
    stretches: Vec<Stretch>,
    /// The stretch of the next step, and how many of its steps are over.
    index: usize,
    passed: u32,
}

impl ScriptCursor {
    /// The start of `script`.
    pub(crate) fn new(script: &Script) -> Self {
        let stretches = script.sections().iter().flat_map(|section| &section.stretches);
        Self { stretches: stretches.copied().collect(), index: 0, passed: 0 }
    }

    /// The intents of the next step, which is then over; `None` at the end.
    pub(crate) fn next(&mut self) -> Option<Intents> {
        let stretch = self.stretches.get(self.index)?;
        self.passed += 1;
        if self.passed >= stretch.steps {
            (self.index, self.passed) = (self.index + 1, 0);
        }
        Some(stretch.intents)
    }

    /// Returns to the start.
    pub(crate) fn rewind(&mut self) {
        (self.index, self.passed) = (0, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_gives_the_steps_of_the_script() {
        let text = "2 steps forward\n[b]\n1 step stand\n3 steps run\n";
        let script = Script::parse(text, "it").unwrap_or_else(|faults| panic!("{faults}"));
        let expected: Vec<Intents> = script.iter().map(|(_, intents)| intents).collect();
        let mut cursor = ScriptCursor::new(&script);
        for _ in 0..2 {
            let mut steps = Vec::new();
            while let Some(intents) = cursor.next() {
                steps.push(intents);
            }
            assert_eq!(steps, expected);
            cursor.rewind();
        }
    }
}
