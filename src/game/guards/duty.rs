//! Duty: what guards do while nothing disturbs them.

use super::context::Context;
use super::guard::Guard;
use super::route::Progress;
use super::state::State;
use crate::world::{Cell, Duty};

/// The steps for which a guard stops at a waypoint.
const STOP: u16 = 80;
/// The angle of a glance to the side, in radians.
const GLANCE: f64 = 0.9;

impl Guard {
    pub(crate) fn do_duty(&mut self, context: &mut Context) {
        if self.pause > 0 {
            self.pause = self.pause.saturating_sub(context.stride);
            self.look_aside();
            return;
        }
        match &self.duty {
            Duty::Stand | Duty::Sleep => self.stand(context),
            Duty::Patrol(stops) => {
                let stop = stops.get(self.stop).copied().unwrap_or(self.post);
                let count = stops.len().max(1);
                self.patrol(context, stop, count);
            }
            &Duty::Wander(reach) => self.wander(context, reach),
        }
    }

    pub(crate) fn return_to_duty(&mut self, context: &mut Context) {
        let home = match &self.duty {
            Duty::Patrol(stops) => stops.get(self.stop).copied().unwrap_or(self.post),
            Duty::Stand | Duty::Sleep | Duty::Wander(_) => self.post,
        };
        let speed = self.abilities().walk;
        match self.go_to(context, home, speed) {
            Progress::OnTheWay => {}
            Progress::There | Progress::Impossible => {
                self.state = State::OnDuty;
                self.pause = 60;
            }
        }
    }

    fn stand(&mut self, context: &mut Context) {
        let (post, speed) = (self.post, self.abilities().walk);
        match self.go_to(context, post, speed) {
            Progress::OnTheWay => {}
            Progress::Impossible => self.pause_a_while(120, 240),
            Progress::There => {
                let offset = self.glance;
                self.look = Some(self.post_heading.turned(offset).direction());
                self.pause_a_while(100, 240);
            }
        }
    }

    fn patrol(&mut self, context: &mut Context, stop: Cell, count: usize) {
        let speed = self.abilities().walk;
        match self.go_to(context, stop, speed) {
            Progress::OnTheWay => {}
            Progress::There => {
                self.stop = (self.stop + 1) % count;
                self.pause_a_while(STOP, STOP);
            }
            Progress::Impossible => {
                self.stop = (self.stop + 1) % count;
                self.pause_a_while(30, 60);
            }
        }
    }

    fn wander(&mut self, context: &mut Context, reach: u8) {
        let Some(errand) = self.errand else {
            self.errand = self.random_cell(context, self.post, i32::from(reach));
            if self.errand.is_none() {
                self.pause_a_while(60, 120);
            }
            return;
        };
        let speed = self.abilities().walk;
        if self.go_to(context, errand, speed) != Progress::OnTheWay {
            self.errand = None;
            self.pause_a_while(90, 240);
        }
    }

    /// A cell at most `reach` from `around` where guards walk; `None` if a few tries find none.
    pub(crate) fn random_cell(
        &mut self,
        context: &Context,
        around: Cell,
        reach: i32,
    ) -> Option<Cell> {
        let gait = self.gait();
        (0..6).find_map(|_| {
            let mut offset = || self.random.whole(-reach, reach) as i32;
            let column = around.column.checked_add_signed(offset())?;
            let row = around.row.checked_add_signed(offset())?;
            let cell = Cell { column, row };
            let is_good = cell != around && context.terrain.is_walkable(context.world, gait, cell);
            is_good.then_some(cell)
        })
    }

    /// Stands still for a time between two numbers of steps, and looks to another side.
    pub(crate) fn pause_a_while(&mut self, least: u16, most: u16) {
        self.pause = self.random.whole(i32::from(least), i32::from(most)) as u16;
        self.glance = match self.random.below(3) {
            0 => -GLANCE,
            1 => GLANCE,
            _ => 0.0,
        };
    }

    /// Looks to the side of the present glance: from the post's heading there, elsewhere from the
    /// way.
    fn look_aside(&mut self) {
        let is_at_post =
            matches!(self.duty, Duty::Stand | Duty::Sleep) && self.mover.cell() == self.post;
        if is_at_post {
            self.look = Some(self.post_heading.turned(self.glance).direction());
        } else if self.glance != 0.0 && self.pause > 30 {
            // The glance is spent as the guard turns.
            let part = self.glance.clamp(-0.03, 0.03);
            self.look = Some(self.mover.heading.turned(part).direction());
            self.glance -= part;
        }
    }
}
