//! What the game has to say, for a while.

/// How long something is said, in steps: 3 seconds.
const DURATION: u64 = 180;

/// A sentence that is shown for some more steps.
#[derive(Clone, Debug, PartialEq, Default)]
pub(super) struct Notice {
    text: String,
    steps_left: u64,
}

impl Notice {
    /// Says `text` from now on.
    pub(super) fn new(text: String) -> Self {
        Self { text, steps_left: DURATION }
    }

    /// What is being said.
    pub(super) fn text(&self) -> Option<&str> {
        (self.steps_left > 0).then_some(&self.text)
    }

    /// How many steps may pass before something else is said; `None` for any number.
    pub(super) fn quiet_steps(&self) -> Option<u64> {
        self.steps_left.checked_sub(1)
    }

    /// Lets `steps` steps pass, and tells whether that was the end of what was being said.
    pub(super) fn wait(&mut self, steps: u64) -> bool {
        let was_said = self.steps_left > 0;
        self.steps_left = self.steps_left.saturating_sub(steps);
        if self.steps_left == 0 {
            self.text.clear();
        }
        was_said && self.steps_left == 0
    }
}
