//! The ghost: the best run of a level, which walks along as a see-through figure.
//!
//! It is a game of its own that the script of that run plays. Recorded positions were refused: a
//! script is a hundredth of their size, and is kept anyway.

use super::App;
use super::goal::Goal;
use super::script_cursor::ScriptCursor;
use crate::game::{Game, Intents};
use crate::tui::MapMark;
use crate::world::{Camera, FieldOfView, Figure, SpriteId};

/// How much of the ghost shows, of 255.
const OPACITY: u8 = 96;

/// The game of the best run, step by step beside that of the player.
#[derive(Debug)]
pub(crate) struct Ghost {
    game: Game,
    cursor: ScriptCursor,
    /// The intents of the next step; `None` at the end of the script.
    next: Option<Intents>,
}

impl App {
    /// Switches ghosts on or off, and says so.
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
    /// The best run at its start, in `game` at its start.
    pub(crate) fn new(game: Game, mut cursor: ScriptCursor) -> Self {
        let next = cursor.next();
        Self { game, cursor, next }
    }

    /// Advances by one step.
    pub(crate) fn step(&mut self) {
        if let Some(intents) = self.next {
            self.game.step(intents);
            self.next = self.cursor.next();
        }
    }

    /// The number of steps in which the ghost stays as it is, at most `most`.
    pub(crate) fn quiet_steps(&self, most: u64) -> u64 {
        match self.next {
            Some(intents) => self.game.quiet_steps(intents).min(1).min(most),
            None => most,
        }
    }

    /// A number that changes when the ghost has moved.
    pub(crate) fn steps(&self) -> u64 {
        self.game.tally().steps
    }

    /// The figure of the ghost; `None` after it has left the level.
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

    /// The ghost on the map; `None` after it has left the level.
    pub(crate) fn on_map(&self) -> Option<MapMark> {
        let camera = self.camera()?;
        Some(MapMark { position: camera.position(), heading: camera.heading })
    }

    fn camera(&self) -> Option<Camera> {
        (!self.game.is_finished()).then(|| self.game.camera(FieldOfView::default()))
    }
}
