//! Redrawing: whether the screen is out of date, and when the game changes next.
//!
//! Guards who move where no ray of the last picture ends behind them are not in view, and need no new
//! picture. Comparing the pixels of two pictures was refused: it saves the bytes, but not the drawing.

use std::time::Duration;

use super::ghost::Ghost;
use super::played::Viewpoint;
use super::{App, Screen, Shown};
use crate::game::STEP;
use crate::world::Figure;

impl App {
    /// Whether the screen is out of date.
    pub(crate) fn is_stale(&self) -> bool {
        let Some(Shown { viewpoint, revision, figures }) = &self.shown else { return true };
        (*viewpoint, *revision) != self.surroundings()
            || !self.figures_in_view().eq(figures)
            || self.steps_to_animation() == Some(0)
    }

    /// The viewpoint, and a number that grows with every visible change but those of figures.
    fn surroundings(&self) -> (Viewpoint, u64) {
        let ghost = self.ghost.as_ref().map_or(0, Ghost::steps);
        (self.game.viewpoint(self.field_of_view), self.game.revision() + ghost)
    }

    /// The figures that the last picture and its map would show if they were drawn now, in the same
    /// surroundings; and perhaps others.
    fn figures_in_view(&self) -> impl Iterator<Item = &Figure> {
        let figures = self.game.grid().into_iter().flat_map(|game| {
            let camera = game.camera(self.field_of_view);
            game.figures().map(move |figure| (game.world(), camera, figure))
        });
        let in_view = figures
            .filter(|(world, camera, figure)| self.views.grid.may_show(world, camera, figure));
        in_view.map(|(.., figure)| figure)
    }

    /// The number of steps until that change; `None` for never.
    pub(crate) fn steps_to_animation(&self) -> Option<u64> {
        let steps = (self.animates_at? - self.game.elapsed()) / STEP;
        Some(steps.round().max(0.0) as u64)
    }

    /// Records that the screen is up to date.
    pub(crate) fn drawn(&mut self) {
        let (viewpoint, revision) = self.surroundings();
        let figures = self.figures_in_view().copied().collect();
        self.shown = Some(Shown { viewpoint, revision, figures });
        let soonest = self.game.elapsed() + STEP;
        self.animates_at = self.views.next_change().map(|change| change.max(soonest));
    }

    /// The time at which the game changes without an event; `None` for never.
    pub(crate) fn next_change(&self) -> Option<Duration> {
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

    /// Whether the player wants nothing, and the next step changes only what others do.
    pub(crate) fn waits_for_others(&self) -> bool {
        let wanted = self.wanted();
        self.screen == Screen::Playing
            && self.demo.is_none()
            && wanted.is_empty()
            && !self.controls.held.has_taps()
            && self.quiet_steps(wanted) == 0
    }
}
