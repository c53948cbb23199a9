//! Redrawing: whether the screen is out of date, and when the game changes next.

use std::time::Duration;

use super::ghost::Ghost;
use super::{App, Screen, Shown};
use crate::game::STEP;

impl App {
    /// The state that a picture would show now.
    pub(super) fn visible(&self) -> Shown {
        let ghost = self.ghost.as_ref().map_or(0, Ghost::steps);
        let revision = self.game.revision() + ghost;
        Shown { viewpoint: self.game.viewpoint(self.field_of_view), revision }
    }

    /// Whether the screen is out of date.
    pub(super) fn is_stale(&self) -> bool {
        self.shown != Some(self.visible()) || self.steps_to_animation() == Some(0)
    }

    /// The number of steps until that change; `None` for never.
    pub(super) fn steps_to_animation(&self) -> Option<u64> {
        let steps = (self.animates_at? - self.game.elapsed()) / STEP;
        Some(steps.round().max(0.0) as u64)
    }

    /// Records that the screen is up to date.
    pub(super) fn drawn(&mut self) {
        self.shown = Some(self.visible());
        let soonest = self.game.elapsed() + STEP;
        self.animates_at = self.views.next_change().map(|change| change.max(soonest));
    }

    /// The time at which the game changes without an event; `None` for never.
    pub(super) fn next_change(&self) -> Option<Duration> {
        if self.demo.is_some() {
            return Some(self.clock.step_after(0));
        }
        if self.screen != Screen::Playing {
            return self.pending.until();
        }
        if self.controls.held.has_taps() {
            return Some(self.clock.step_after(0));
        }
        let quiet = Some(self.quiet_steps(self.wanted())).filter(|&quiet| quiet < u64::MAX);
        let before_animation = self.steps_to_animation().map(|steps| steps.saturating_sub(1));
        let steps = quiet.into_iter().chain(before_animation).min()?;
        Some(self.clock.step_after(steps))
    }
}
