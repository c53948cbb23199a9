//! A level that changes while it is played: its author edits the map.
//!
//! The game asks for changes a few times a second. To be told of them by the system was refused: an
//! event library takes a thread and a wakeup of the loop, and has to follow files that editors replace.

use std::time::Duration;

use ratatui::layout::Rect;
use ratatui::text::{Line, Text};

use super::wrap::wrapped;
use super::{App, Goal, Screen, panels};
use crate::canvas::Canvas;
use crate::fault::Faults;
use crate::map::Level;

/// Between two looks for changes.
const INTERVAL: Duration = Duration::from_millis(200);

/// Answers with the level, or with what is wrong with it, where it has changed.
pub(super) type Changes = Box<dyn FnMut() -> Option<Result<Level, Faults>>>;

/// Where changes come from, and what was wrong with the last one.
pub(super) struct Reload {
    changes: Changes,
    next_look: Duration,
    fault: Option<String>,
}

impl Reload {
    pub(super) fn from(changes: Changes) -> Self {
        Self { changes, next_look: INTERVAL, fault: None }
    }
}

impl App {
    /// Goes on in the level as it is now, if it is time to look for changes and there is one.
    pub(super) fn reload(&mut self, now: Duration) {
        let Some(reload) = self.reload.as_mut().filter(|reload| now >= reload.next_look) else {
            return;
        };
        reload.next_look = now + INTERVAL;
        match (reload.changes)() {
            None => {}
            Some(Ok(level)) => {
                reload.fault = None;
                self.game = self.game.begun_again_in(level);
                self.goal = Goal::of(&self.game, self.settings.minimap);
                self.map.begin_level();
                let screen = match self.screen {
                    Screen::LevelDone | Screen::End => Screen::Playing,
                    screen => screen,
                };
                self.show(screen);
            }
            Some(Err(faults)) => {
                reload.fault = Some(faults.summary());
                self.shown = None;
            }
        }
    }

    /// When to look for changes again; `None` for never.
    pub(super) fn next_reload(&self) -> Option<Duration> {
        self.reload.as_ref().map(|reload| reload.next_look)
    }

    /// Draws what is wrong with the level, if anything is, over the foot of the picture.
    pub(super) fn draw_fault(&self, canvas: &mut impl Canvas, picture: Rect) {
        let fault = self.reload.as_ref().and_then(|reload| reload.fault.as_ref());
        let Some(fault) = fault else { return };
        let lines = wrapped(fault, usize::from(picture.width.saturating_sub(4)).max(1));
        let height = (lines.len() as u16).saturating_add(2).min(picture.height);
        let area = Rect { y: picture.bottom() - height, height, ..picture };
        let inside = panels::framed(canvas, area, "the map has faults");
        let text: Text = lines.into_iter().map(Line::from).collect();
        let padded = Rect { x: inside.x + 1, width: inside.width.saturating_sub(2), ..inside };
        for side in [inside.x, inside.right().saturating_sub(1)] {
            canvas.draw_widget(Text::default(), Rect { x: side, width: 1, ..inside });
        }
        canvas.draw_widget(text, padded);
    }
}
