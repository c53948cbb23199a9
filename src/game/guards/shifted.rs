//! Guards in a window that moves over a generated level.

use glam::DVec2;

use super::guard::Guard;
use super::route::Route;
use super::state::State;
use crate::generate::Shift;
use crate::world::{Cell, Duty};

impl Guard {
    /// Moves the guard with the window; `false` if they are outside it now. Places outside it
    /// become the cell of the guard.
    pub(crate) fn shift(&mut self, shift: Shift) -> bool {
        let Some(here) = shift.cell(self.mover.cell()) else { return false };
        let cell = |cell: Cell| shift.cell(cell).unwrap_or(here);
        let place = |place: DVec2| shift.position(place);
        self.mover.body.position = place(self.mover.position());
        self.post = cell(self.post);
        if let Duty::Patrol(stops) = &mut self.duty {
            for stop in stops {
                *stop = cell(*stop);
            }
        }
        self.errand = self.errand.map(cell);
        if let Some(quarry) = &mut self.quarry {
            quarry.position = place(quarry.position);
        }
        match &mut self.state {
            State::Wondering { about, wakes, .. } => (*about, *wakes) = (place(*about), None),
            State::Searching { around, next, .. } => {
                (*around, *next) = (cell(*around), next.map(cell));
            }
            State::Tracking { .. } => self.begin_to_search(here, 360),
            State::Asleep
            | State::OnDuty
            | State::Chasing { .. }
            | State::Attacking { .. }
            | State::Down { .. }
            | State::Returning => {}
        }
        self.route = Route::default();
        true
    }
}
