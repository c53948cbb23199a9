//! The mouse: moving its pointer turns and tilts, its buttons open and jump.
//!
//! Terminals tell where the pointer is and never how far the mouse was moved, so the player turns by
//! the difference between two places. Where the pointer rests at the left or the right edge of the
//! window, it can go no further, and the player goes on turning; once around at the most, since nobody
//! tells that the pointer has left the window for good.
//!
//! Places become angles first, and angles are subtracted: what is rounded never adds up, and a pointer
//! that comes back to where it was has turned nothing.

use std::time::Duration;

use super::{App, Screen};
use crate::game::{Intent, Intents, Look, STEPS_PER_SECOND};
use crate::terminal::{MouseButton, MouseEvent, MouseEventKind};

/// By how much a motion across a cell turns, and one along its height tilts, in degrees.
const DEGREES_PER_CELL: i32 = 2;
/// How fast the player turns while the pointer rests at an edge, in degrees per second.
const DEGREES_PER_SECOND: i32 = 90;
/// For so many steps: once around.
const EDGE_STEPS: u32 = 360 * STEPS_PER_SECOND / DEGREES_PER_SECOND as u32;
/// One in so many columns is at an edge, and one more: a pointer that leaves the window quickly is last
/// seen a little before it.
const COLUMNS_PER_EDGE_COLUMN: i32 = 80;

/// Where the pointer is, and what it has done that no step knows of yet.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pointer {
    is_on: bool,
    columns: u16,
    /// From the upper left corner, in units of [`Look`]; `None` where nobody knows.
    place: Option<[i32; 2]>,
    /// How far it has moved since the last step, likewise.
    moved: [i32; 2],
    /// What its buttons want of the next step.
    clicked: Intents,
    /// At which edge it rests, 1 for the right one, and for how many more steps that counts.
    edge: Option<(i16, u32)>,
}

impl Pointer {
    /// One that is on from the start, or off.
    pub(super) fn new(is_on: bool) -> Self {
        Self { is_on, ..Self::default() }
    }

    /// Whether it turns the player.
    pub(super) fn is_on(&self) -> bool {
        self.is_on
    }

    /// On where it was off, and off where it was on.
    pub(super) fn toggle(&mut self) {
        *self = Self { is_on: !self.is_on, columns: self.columns, ..Self::default() };
    }

    /// Nobody knows where it is.
    pub(super) fn forget(&mut self) {
        *self = Self { is_on: self.is_on, columns: self.columns, ..Self::default() };
    }

    /// The window is so wide now.
    pub(super) fn set_columns(&mut self, columns: u16) {
        self.columns = columns;
        self.forget();
    }

    /// It is at that place now, in the units of [`MouseEvent`].
    fn move_to(&mut self, x: u32, y: u32) {
        let units_per_cell = MouseEvent::UNITS_PER_CELL as i32;
        let place = [x, y].map(|units| {
            units as i32 * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / units_per_cell
        });
        let before = self.place.replace(place).unwrap_or(place);
        let [right, down] = [place[0] - before[0], place[1] - before[1]];
        let half_a_window =
            i32::from(self.columns) * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / 2;
        // What is further was outside of the window meanwhile.
        if right.abs() <= half_a_window {
            self.moved = [self.moved[0] + right, self.moved[1] + down];
        }
        self.edge = self.edge_at(x as i32 / units_per_cell).map(|edge| (edge, EDGE_STEPS));
    }

    /// The edge that `column` is at.
    fn edge_at(&self, column: i32) -> Option<i16> {
        let columns = i32::from(self.columns);
        let at_edge = 1 + columns / COLUMNS_PER_EDGE_COLUMN;
        if columns < 4 * at_edge {
            return None;
        }
        let to_the_left = column < at_edge;
        let to_the_right = column >= columns - at_edge;
        (to_the_left || to_the_right).then_some(if to_the_left { -1 } else { 1 })
    }

    /// By how much the player turns and tilts in the next step.
    fn look(&self) -> Look {
        let at_edge = self.edge.map_or(0, |(edge, _)| {
            i32::from(edge) * DEGREES_PER_SECOND * i32::from(Look::PER_DEGREE)
                / STEPS_PER_SECOND as i32
        });
        let within = |amount: i32| amount.clamp(-i32::from(i16::MAX), i16::MAX.into()) as i16;
        Look { turn: within(self.moved[0] + at_edge), tilt: within(-self.moved[1]) }
    }

    /// Whether it was moved or clicked since the last step.
    pub(super) fn has_news(&self) -> bool {
        self.moved != [0, 0] || !self.clicked.is_empty()
    }

    /// So many steps have passed that took [`Pointer::look`] into account.
    pub(super) fn passed(&mut self, steps: u64) {
        if steps == 0 {
            return;
        }
        self.moved = [0, 0];
        self.clicked = Intents::new();
        self.edge = self.edge.and_then(|(edge, left)| {
            let left = u64::from(left).saturating_sub(steps) as u32;
            (left > 0).then_some((edge, left))
        });
    }
}

impl App {
    /// The mouse was moved, or a button pressed, at that time.
    pub(super) fn mouse(&mut self, event: MouseEvent, now: Duration) {
        self.advance(now);
        if !self.pointer.is_on {
            return;
        }
        self.pointer.move_to(event.x, event.y);
        if self.screen != Screen::Playing {
            self.pointer.moved = [0, 0];
            return;
        }
        match event.kind {
            MouseEventKind::Pressed(MouseButton::Left) => self.pointer.clicked.insert(Intent::Open),
            MouseEventKind::Pressed(MouseButton::Right) => {
                self.pointer.clicked.insert(Intent::Jump);
            }
            _ => {}
        }
    }

    /// What the player wants in the next step, by keys and by the mouse.
    pub(super) fn wanted(&self) -> Intents {
        let keys = self.intents();
        keys.iter()
            .chain(self.pointer.clicked.iter())
            .collect::<Intents>()
            .with_look(self.pointer.look())
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn on(columns: u16) -> Pointer {
        let mut pointer = Pointer::new(true);
        pointer.set_columns(columns);
        pointer
    }

    const CELL: u32 = MouseEvent::UNITS_PER_CELL;

    #[test]
    fn the_first_place_turns_nothing_and_a_cell_is_two_degrees() {
        let mut pointer = on(80);
        pointer.move_to(40 * CELL, 10 * CELL);
        assert_eq!(pointer.look(), Look::NONE);
        pointer.move_to(41 * CELL, 10 * CELL);
        assert_eq!(pointer.look(), Look { turn: 200, tilt: 0 });
        pointer.passed(1);
        assert_eq!(pointer.look(), Look::NONE);
        pointer.move_to(41 * CELL, 8 * CELL);
        assert_eq!(pointer.look(), Look { turn: 0, tilt: 400 });
    }

    #[test]
    fn at_an_edge_the_player_turns_on_but_not_for_ever() {
        let mut pointer = on(80);
        pointer.move_to(50 * CELL, 10 * CELL);
        pointer.move_to(79 * CELL, 10 * CELL);
        pointer.passed(1);
        let mut turned = 0;
        for _ in 0..10_000 {
            turned += i32::from(pointer.look().turn);
            pointer.passed(1);
        }
        // The step that took the motion was one of them.
        assert_eq!(turned, 360 * 100 - 150);
        pointer.move_to(0, 10 * CELL);
        assert_eq!(pointer.look().turn, -150, "it came from the other side of the window");
        pointer.forget();
        assert_eq!(pointer.look(), Look::NONE);
    }

    #[test]
    fn a_narrow_window_has_no_edges() {
        let mut pointer = on(3);
        pointer.move_to(CELL, 0);
        pointer.move_to(0, 0);
        assert_eq!(pointer.look().turn, -200);
        pointer.passed(1);
        assert_eq!(pointer.look(), Look::NONE);
    }

    proptest! {
        #[test]
        fn who_comes_back_has_turned_nothing(
            places in prop::collection::vec((20 * CELL..60 * CELL, 0..24 * CELL), 1..40),
            cuts in prop::collection::vec(any::<bool>(), 40),
        ) {
            let mut pointer = on(80);
            let mut sum = [0, 0];
            for (&(x, y), &cut) in places.iter().chain(&places[..1]).zip(cuts.iter().chain(&cuts)) {
                pointer.move_to(x, y);
                if cut {
                    let look = pointer.look();
                    sum = [sum[0] + i32::from(look.turn), sum[1] + i32::from(look.tilt)];
                    pointer.passed(1);
                }
            }
            let look = pointer.look();
            prop_assert_eq!([sum[0] + i32::from(look.turn), sum[1] + i32::from(look.tilt)], [0, 0]);
        }
    }
}
