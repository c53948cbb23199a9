//! Runs as scripts: the game records them, and the ghost of the best run replays them.
//!
//! The ghost is a second game that runs beside the player's. Rejected: recorded positions. A script
//! is a hundredth of their size, and the store keeps it anyway.
//!
//! If the player takes time back, the run loses that time, and counts how often it did.

use std::io::Write;
use std::iter::{self, FlatMap, RepeatN};
use std::{fmt, vec};

use crate::app::App;
use crate::app::history::History;
use crate::app::played::Goal;
use crate::game::{self, Game, Intents, Script, Stretch, script};
use crate::terminal;
use crate::tui::MapMark;
use crate::world::{Camera, FieldOfView, Figure, SpriteId};

/// The recordings to make during a game; none by default.
#[derive(Default)]
pub struct Recording {
    /// Receives every byte sent to the terminal.
    pub terminal: Option<Box<dyn terminal::Recorder>>,
    /// Receives the player's intents as a script. [Replaying][replayed] the script produces the
    /// same game. Changes that affect only the view, and the time during a pause, are left out.
    ///
    /// [replayed]: super::Replay
    pub script: Option<ScriptRecorder>,
}

/// Writes a script while the game is played.
pub(crate) type ScriptRecorder = game::ScriptWriter<Box<dyn Write>>;

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

/// The stretches of a run up to now.
#[derive(Clone, Debug, Default)]
pub(crate) struct RunLog {
    stretches: Vec<Stretch>,
    /// The number of recorded steps.
    pub(crate) steps: u64,
    /// The number of times that the player has taken time back.
    pub(crate) taken_back: u32,
}

impl RunLog {
    /// Records that the player wants `intents` for `steps` more steps.
    pub(crate) fn record(&mut self, intents: Intents, mut steps: u64) {
        self.steps += steps;
        while steps > 0 {
            match self.stretches.last_mut() {
                Some(last) if last.intents == intents && last.steps < Stretch::MAX_STEPS => {
                    let taken = steps.min(u64::from(Stretch::MAX_STEPS - last.steps));
                    last.steps += taken as u32;
                    steps -= taken;
                }
                _ => self.stretches.push(Stretch { steps: 0, intents }),
            }
        }
    }

    /// Returns true if nothing has been recorded.
    pub(crate) fn is_empty(&self) -> bool {
        self.stretches.is_empty()
    }

    /// The intents of each step from step `first` on.
    pub(crate) fn since(&self, first: u64) -> impl Iterator<Item = Intents> {
        let mut skipped = first;
        self.stretches.iter().flat_map(move |stretch| {
            let before = skipped.min(stretch.steps.into());
            skipped -= before;
            iter::repeat_n(stretch.intents, stretch.steps as usize - before as usize)
        })
    }

    /// Takes back the last `steps` steps.
    pub(crate) fn take_back(&mut self, steps: u32) {
        let missing = script::taken_back(&mut self.stretches, steps);
        self.steps -= u64::from(steps - missing);
        self.taken_back = self.taken_back.saturating_add(1);
    }

    pub(crate) fn stretches(&self) -> &[Stretch] {
        &self.stretches
    }

    /// The script of the run, without a header.
    pub(crate) fn script(&self) -> String {
        self.stretches.iter().flat_map(|stretch| [stretch.to_string(), "\n".to_owned()]).collect()
    }
}

/// An iterator over the intents of each step of a script.
pub(crate) type Steps =
    FlatMap<vec::IntoIter<Stretch>, RepeatN<Intents>, fn(Stretch) -> RepeatN<Intents>>;

/// The intents of each step of `script`.
pub(crate) fn steps(script: &Script) -> Steps {
    let stretches = script.sections().iter().flat_map(|section| section.stretches.iter().copied());
    let steps = |stretch: Stretch| iter::repeat_n(stretch.intents, stretch.steps as usize);
    stretches.collect::<Vec<_>>().into_iter().flat_map(steps as fn(Stretch) -> RepeatN<Intents>)
}

/// The opacity of the ghost, out of 255.
const OPACITY: u8 = 96;

/// A game that replays the best run, step by step beside the player's game.
#[derive(Debug)]
pub(crate) struct Ghost {
    game: Game,
    /// The intents of the whole run, and of the rest of it.
    run: Steps,
    steps: Steps,
    /// The intents of the next step; `None` at the end of the script.
    next: Option<Intents>,
    history: History,
}

impl App {
    /// Switches ghosts on or off, and shows a notice about it.
    pub(crate) fn toggle_ghost(&mut self) {
        self.prefer(|it| it.ghost ^= true);
        let is_on = self.store.preferences().ghost;
        let (text, short) = match (is_on, &self.ghost) {
            (false, _) => ("The ghost is off", "Ghost off"),
            (true, Some(ghost)) if ghost.camera().is_none() => {
                ("The ghost is on, and has left the level", "Ghost on, and gone")
            }
            (true, Some(_)) => ("The ghost of your best run is on", "Ghost on"),
            (true, None) => ("The ghost is on: you have no best run here yet", "No ghost here yet"),
        };
        self.notice = Some(Goal::new(text, short));
    }
}

impl Ghost {
    /// The best run at its start. `game` must be at its start too.
    pub(crate) fn new(game: Game, run: Steps) -> Self {
        let mut steps = run.clone();
        let next = steps.next();
        Self { history: History::new(game.clone(), 0), game, run, steps, next }
    }

    /// Advances by one step.
    pub(crate) fn step(&mut self) {
        if let Some(intents) = self.next {
            self.game.step(intents);
            self.next = self.steps.next();
            self.history.record(self.history.steps + 1, &self.game);
        }
    }

    /// Goes back to the state after `steps` steps.
    pub(crate) fn go_back_to(&mut self, steps: u64) {
        if steps < self.history.steps {
            let run = |first| self.run.clone().skip(first as usize);
            self.game = self.history.at(steps, run);
            self.history.forget_after(steps);
            self.steps = self.run.clone();
            self.next = self.steps.nth(steps as usize);
        }
    }

    /// Returns true if the run has ended.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.next.is_none()
    }

    /// A number that changes whenever the ghost moves.
    pub(crate) fn steps(&self) -> u64 {
        self.game.tally().steps
    }

    /// The ghost's figure; `None` after the ghost has left the level.
    pub(crate) fn figure(&self, sprite: SpriteId) -> Option<Figure> {
        let camera = self.camera()?;
        Some(Figure {
            sprite,
            position: camera.position(),
            base: self.game.feet(),
            heading: camera.heading,
            frame: 0,
            opacity: OPACITY,
        })
    }

    /// The ghost's mark on the map; `None` after the ghost has left the level.
    pub(crate) fn on_map(&self) -> Option<MapMark> {
        let camera = self.camera()?;
        Some(MapMark { position: camera.position(), heading: camera.heading })
    }

    fn camera(&self) -> Option<Camera> {
        (!self.game.is_finished()).then(|| self.game.camera(FieldOfView::default()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::game::{Intent, Script};

    #[test]
    fn the_script_contains_the_recorded_steps() {
        let run = [Intent::Run].into_iter().collect();
        let most = u64::from(Stretch::MAX_STEPS);
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

    #[test]
    fn steps_match_the_script() {
        let text = "2 steps forward\n[b]\n1 step stand\n3 steps run\n";
        let script = Script::parse(text, "it").unwrap_or_else(|faults| panic!("{faults}"));
        assert!(steps(&script).eq(script.iter().map(|(_, intents)| intents)));
    }
}
