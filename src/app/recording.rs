//! What is noted down while the game is played.

use std::fmt;
use std::io::Write;

use super::App;
use crate::game::{self, Intents};
use crate::terminal;

/// What of a game is to be noted down; by default, nothing.
#[derive(Default)]
pub struct Recording {
    /// Everything that the terminal is sent.
    pub terminal: Option<Box<dyn terminal::Recorder>>,
    /// What the player wants, as a script that gives the same game when it is [replayed]. What only
    /// concerns the view, and the time that passes while the game waits, is not in it.
    ///
    /// [replayed]: super::Replay
    pub script: Option<ScriptRecorder>,
}

/// What writes a script while the game is played.
pub(super) type ScriptRecorder = game::Recorder<Box<dyn Write>>;

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recording")
            .field("terminal", &self.terminal.is_some())
            .field("script", &self.script.is_some())
            .finish()
    }
}

impl App {
    /// Notes down that the player has wanted `intents` for `steps` steps.
    pub(super) fn record(&mut self, intents: Intents, steps: u64) {
        if let Some(script) = &mut self.script {
            // The game goes on where the recording can't: who gave the file asks it how it went.
            _ = script.record(intents, steps);
        }
    }
}
