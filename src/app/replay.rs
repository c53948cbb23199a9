//! Replays: the game played by a script, off screen.

use std::fmt;
use std::num::NonZeroU32;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::{App, Levels, Screen, Settings};
use crate::game::{Intents, STEPS_PER_SECOND, Script};
use crate::tui::canvas::Canvas;

/// A game without a terminal, one step at a time. It draws the picture, minimap and status line
/// that a player with the same intents would see.
///
/// After a level's exit is reached, the next step is the first one of the next level.
pub struct Replay {
    app: App,
    picture: Buffer,
}

impl Replay {
    /// Begins `levels` in a window of `size`.
    pub fn new(levels: Levels, settings: Settings, size: Size) -> Self {
        let area = Rect::from(size);
        Self { app: App::new(levels, settings), picture: Buffer::empty(area) }
    }

    /// Advances by one step with `intents`.
    pub fn step(&mut self, intents: Intents) {
        if self.app.screen() == Screen::LevelDone {
            self.app.next_level();
        }
        if self.app.screen() == Screen::Playing {
            self.app.game.step(intents);
            self.app.goal.moved(u64::from(!intents.is_empty()));
            if self.app.game.is_finished() {
                self.app.show(Screen::LevelDone);
            }
        }
    }

    /// Plays `script` and calls `show` with its frames, `frames_per_second` per second; the first
    /// shows the state before the first step. The arguments are the frame's number, the section of
    /// the script that led to it, and its cells.
    ///
    /// # Errors
    /// The first error of `show`.
    pub fn play<E>(
        &mut self,
        script: &Script,
        frames_per_second: NonZeroU32,
        mut show: impl FnMut(u64, usize, &Buffer) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut frame = 0;
        show(frame, 0, self.picture())?;
        for (steps, (section, intents)) in (1..).zip(script.iter()) {
            self.step(intents);
            let frames = steps * u64::from(frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
            while frame < frames {
                frame += 1;
                show(frame, section, self.picture())?;
            }
        }
        Ok(())
    }

    /// Draws the current state.
    pub fn draw(&mut self, canvas: &mut impl Canvas) {
        self.app.draw(canvas);
    }

    /// The current picture. As in a game, it is redrawn only if something has changed.
    pub fn picture(&mut self) -> &Buffer {
        if self.app.is_stale() {
            self.picture.reset();
            self.app.draw(&mut self.picture);
            self.app.drawn();
        }
        &self.picture
    }
}

impl fmt::Debug for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Replay").field("game", &self.app.game).finish_non_exhaustive()
    }
}
