//! Messages to the player, shown for some time.

use serde::{Deserialize, Serialize};

/// The duration of a message in steps: 3 seconds.
const DURATION: u64 = 180;

/// A message that is shown for some more steps.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Notice {
    text: String,
    steps_left: u64,
}

impl Notice {
    /// Shows `text` from now on.
    pub(crate) fn new(text: String) -> Self {
        Self { text, steps_left: DURATION }
    }

    /// The current message.
    pub(crate) fn text(&self) -> Option<&str> {
        (self.steps_left > 0).then_some(&self.text)
    }

    /// The number of steps until the message ends; `None` if there is none.
    pub(crate) fn quiet_steps(&self) -> Option<u64> {
        self.steps_left.checked_sub(1)
    }

    /// Advances by `steps` steps, and returns whether the message ended.
    pub(crate) fn wait(&mut self, steps: u64) -> bool {
        let was_said = self.steps_left > 0;
        self.steps_left = self.steps_left.saturating_sub(steps);
        if self.steps_left == 0 {
            self.text.clear();
        }
        was_said && self.steps_left == 0
    }
}
