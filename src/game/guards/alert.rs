//! Wondering, searching and tracking: guards who have noticed something.

use glam::DVec2;

use super::context::Context;
use super::guard::{Guard, WONDERS};
use super::route::Progress;
use super::state::State;
use crate::game::sound::SoundKind;
use crate::world::Cell;

/// How far a hound smells a trail, in cells.
pub(crate) const NOSE: f64 = 1.5;
/// The steps for which a guard looks towards a noise before they go there.
const LOOKS: u16 = 45;
/// The farthest cells that are searched, in cells from the place.
const SEARCHED: i32 = 4;
/// How far guards see others who have fallen, in cells.
const SEES_FALLEN: f64 = 8.0;
/// The steps after which a hound gives up at the end of a trail.
const LOST: u16 = 150;

impl Guard {
    /// Says so, and looks towards a place; then goes there, if it is worth it.
    pub(crate) fn begin_to_wonder(&mut self, context: &mut Context, about: DVec2, goes: bool) {
        let looks = if self.state == State::Asleep { LOOKS * 2 } else { LOOKS };
        self.state = State::Wondering { about, looks, goes, hurries: false, wakes: None };
        context.sound(SoundKind::Wonder, self.mover.cell(), 7);
    }

    pub(crate) fn wonder(&mut self, context: &mut Context) {
        let State::Wondering { about, looks, goes, hurries, wakes } = self.state else { return };
        let way = about - self.mover.position();
        if looks > 0 {
            self.look = Some(way).filter(|way| *way != DVec2::ZERO);
            let looks = looks.saturating_sub(context.stride);
            let goes = goes || self.awareness >= WONDERS;
            self.state = State::Wondering { about, looks, goes, hurries, wakes };
            if looks == 0 && !goes {
                self.give_up(context);
            }
            return;
        }
        let Some(cell) = Cell::containing(about) else { return self.give_up(context) };
        let abilities = self.abilities();
        let speed = if hurries { abilities.chase } else { abilities.walk * 1.15 };
        match self.go(context, cell, about, speed) {
            Progress::OnTheWay => {}
            Progress::There | Progress::Impossible => {
                context.woken.extend(wakes);
                let left = if hurries || wakes.is_some() { 780 } else { 420 };
                self.begin_to_search(cell, left);
            }
        }
        if wakes.is_some() && way.length() < 0.9 {
            context.woken.extend(wakes);
            self.begin_to_search(cell, 780);
        }
    }

    pub(crate) fn begin_to_search(&mut self, around: Cell, left: u16) {
        self.state = State::Searching { around, next: None, left };
        self.pause_a_while(50, 70);
    }

    pub(crate) fn search(
        &mut self,
        context: &mut Context,
        around: Cell,
        next: Option<Cell>,
        left: u16,
    ) {
        let left = left.saturating_sub(context.stride);
        self.state = State::Searching { around, next, left };
        if left == 0 {
            self.give_up(context);
        } else if self.pause > 0 {
            self.pause = self.pause.saturating_sub(context.stride);
            let turn = if self.glance < 0.0 { -0.035 } else { 0.035 };
            self.look = Some(self.mover.heading.turned(turn).direction());
        } else if let Some(cell) = next {
            let speed = self.abilities().walk * 1.3;
            let progress = self.go_to(context, cell, speed);
            if progress != Progress::OnTheWay {
                self.state = State::Searching { around, next: None, left };
                let pause = if progress == Progress::There { 60 } else { 5 };
                self.pause_a_while(pause, pause + 20);
            }
        } else {
            let next = self.random_cell(context, around, SEARCHED);
            self.state = State::Searching { around, next, left };
        }
    }

    /// Goes back to duty, and says so.
    pub(crate) fn give_up(&mut self, context: &mut Context) {
        context.sound(SoundKind::GiveUp, self.mover.cell(), 7);
        self.state = State::Returning;
        (self.awareness, self.quarry, self.errand) = (0, None, None);
    }

    /// Follows the marks of a trail, one after the other.
    pub(crate) fn track(&mut self, context: &mut Context, target: usize, mark: u64, lost: u16) {
        // The trails of the last players go with them.
        let Some(trail) = context.trails.get(target) else { return self.give_up(context) };
        let mark = mark.max(trail.first());
        let Some(cell) = trail.cell(mark) else { return self.stop_tracking(lost, context.stride) };
        let newer = trail.cell(mark + 1).is_some();
        let speed = self.abilities().walk * 1.4;
        let is_near = self.mover.position().distance_squared(cell.center()) < 0.5;
        if is_near && newer {
            self.state = State::Tracking { target, mark: mark + 1, lost: 0 };
            return;
        }
        match self.go_to(context, cell, speed) {
            Progress::OnTheWay => self.state = State::Tracking { target, mark, lost: 0 },
            Progress::There if newer => {
                self.state = State::Tracking { target, mark: mark + 1, lost: 0 };
            }
            Progress::There | Progress::Impossible => {
                self.state = State::Tracking { target, mark, lost };
                self.stop_tracking(lost, context.stride);
            }
        }
    }

    /// Sniffs around at the end of a trail, and searches after a while.
    fn stop_tracking(&mut self, lost: u16, stride: u16) {
        let State::Tracking { target, mark, .. } = self.state else { return };
        let lost = lost.saturating_add(stride);
        self.state = State::Tracking { target, mark, lost };
        let side = if (lost / 20).is_multiple_of(2) { 0.05 } else { -0.05 };
        self.look = Some(self.mover.heading.turned(side).direction());
        if lost > LOST {
            self.blind = 120;
            self.begin_to_search(self.mover.cell(), 360);
        }
    }

    /// Goes to another guard who has fallen, if this one sees any.
    pub(crate) fn look_for_fallen(&mut self, context: &mut Context) {
        let is_busy = match self.state {
            State::OnDuty | State::Returning | State::Searching { .. } => false,
            State::Wondering { wakes, hurries, .. } => wakes.is_some() || hurries,
            _ => true,
        };
        let Some(sight) = self.abilities().sight.filter(|_| !is_busy) else { return };
        let position = self.mover.position();
        let fallen = context.others.iter().position(|other| {
            let way = other.position - position;
            let distance = way.length();
            other.is_down
                && distance < SEES_FALLEN
                && self.mover.facing.dot(way) >= sight.least_cosine * distance
                && self.sees_place(context, other.position, other.feet + 0.2)
        });
        if let Some(index) = fallen {
            let about = context.others[index].position;
            context.sound(SoundKind::Wonder, self.mover.cell(), 7);
            self.awareness = self.awareness.max(WONDERS);
            self.state = State::Wondering {
                about,
                looks: 20,
                goes: true,
                hurries: false,
                wakes: Some(index),
            };
        }
    }

    fn sees_place(&self, context: &Context, position: DVec2, height: f64) -> bool {
        let point = super::sight::Point { position, height };
        super::sight::is_in_sight(context.world, context.clouds, self.eye(), point)
    }
}
