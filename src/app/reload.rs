//! Reloading: a level that changes while it is played, because its author edits the map.
//!
//! The game checks for changes a few times a second. File events of the system were refused: a
//! library for them needs a thread and wakes the loop, and has to follow files that editors
//! replace.

use std::time::Duration;

use ratatui::layout::Rect;
use ratatui::text::{Line, Text};

use super::wrap::wrapped;
use super::{App, Goal, Screen, panels};
use crate::fault::Faults;
use crate::map::Level;
use crate::tui::canvas::Canvas;

/// The time between two checks.
const INTERVAL: Duration = Duration::from_millis(200);

/// Returns the level or its faults, if it has changed.
pub(crate) type Changes = Box<dyn FnMut() -> Option<Result<Level, Faults>>>;

/// The source of changes, and the faults of the last one.
pub(crate) struct Reload {
    changes: Changes,
    next_check: Duration,
    fault: Option<String>,
}

impl Reload {
    pub(crate) fn from(changes: Changes) -> Self {
        Self { changes, next_check: INTERVAL, fault: None }
    }
}

impl App {
    /// Checks for a change when it is time, and continues in the changed level.
    pub(crate) fn reload(&mut self, now: Duration) {
        let Some(reload) = self.reload.as_mut().filter(|reload| now >= reload.next_check) else {
            return;
        };
        reload.next_check = now + INTERVAL;
        match (reload.changes)() {
            None => {}
            Some(Ok(level)) => {
                reload.fault = None;
                self.game = self.game.begun_again_in(level.clone());
                self.stage.change(level);
                self.goal = Goal::of(&self.game, self.settings.minimap);
                self.map.begin_level();
                if self.screen.is_result() {
                    self.show(Screen::Playing);
                }
                self.shown = None;
            }
            Some(Err(faults)) => {
                reload.fault = Some(faults.summary());
                self.shown = None;
            }
        }
    }

    /// The time of the next check; `None` for never.
    pub(crate) fn next_reload(&self) -> Option<Duration> {
        self.reload.as_ref().map(|reload| reload.next_check)
    }

    /// Draws the faults of the level, if any, over the bottom of the picture.
    pub(crate) fn draw_fault(&self, canvas: &mut impl Canvas, picture: Rect) {
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
