//! Recordings of a game while it is played.

use std::fmt;
use std::io::Write;

use super::App;
use crate::game::{self, Intents};
use crate::terminal;

/// The recordings to make of a game; by default, none.
#[derive(Default)]
pub struct Recording {
    /// Receives every byte that is sent to the terminal.
    pub terminal: Option<Box<dyn terminal::Recorder>>,
    /// Receives the player's intents, as a script that gives the same game when it is [replayed].
    /// Changes of the view only, and time during a pause, are not part of it.
    ///
    /// [replayed]: super::Replay
    pub script: Option<ScriptRecorder>,
}

/// Writes a script while the game is played.
pub(crate) type ScriptRecorder = game::Recorder<Box<dyn Write>>;

impl fmt::Debug for Recording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recording")
            .field("terminal", &self.terminal.is_some())
            .field("script", &self.script.is_some())
            .finish()
    }
}

impl App {
    /// Records that the player had `intents` for `steps` steps.
    pub(crate) fn record(&mut self, intents: Intents, steps: u64) {
        self.log.record(intents, steps);
        if let Some(script) = &mut self.script {
            // The game continues if recording fails. The owner of the file asks for the error
            // later.
            _ = script.record(intents, steps);
        }
    }
}
