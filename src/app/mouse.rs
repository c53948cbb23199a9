//! The mouse: its motion turns and tilts the view, its buttons open and jump.
//!
//! Terminals report the position of the pointer, not the motion of the mouse, so the player turns
//! by the difference of two positions. At the left and the right edge of the window the pointer can
//! go no further, and the player keeps turning while it rests there. That ends after one full turn,
//! since terminals do not report that the pointer has left the window.
//!
//! Positions are converted to angles first, and then subtracted: rounding errors do not add up, and
//! a pointer that returns to its position has turned the player by nothing.

use crate::game::{Intent, Intents, Look, STEPS_PER_SECOND};
use crate::terminal::{MouseButton, MouseEvent, MouseEventKind};

/// The angle by which a motion across a cell turns or tilts, in degrees.
const DEGREES_PER_CELL: i32 = 2;
/// The speed of turning while the pointer is at an edge, in degrees per second.
const DEGREES_PER_SECOND: i32 = 90;
/// The number of steps of turning at an edge: one full turn.
const EDGE_STEPS: u32 = 360 * STEPS_PER_SECOND / DEGREES_PER_SECOND as u32;
/// The width of an edge is one column, plus one for each 80 columns: the last reported position of
/// a pointer that leaves the window quickly is a little inside of it.
const COLUMNS_PER_EDGE_COLUMN: i32 = 80;

/// The position of the pointer, and its motion and clicks since the last step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pointer {
    is_on: bool,
    columns: u16,
    /// Measured from the upper left corner, in units of [`Look`]; `None` if unknown.
    position: Option<[i32; 2]>,
    /// The motion since the last step, in the same units.
    moved: [i32; 2],
    /// The intents of the buttons for the next step.
    clicked: Intents,
    /// The edge at which the pointer rests, −1 for the left and 1 for the right one, and the
    /// remaining number of steps for which it turns the player.
    edge: Option<(i16, u32)>,
}

impl Pointer {
    /// A pointer that is on or off at first.
    pub fn new(is_on: bool) -> Self {
        Self { is_on, ..Self::default() }
    }

    /// Whether the mouse turns the player.
    pub fn is_on(&self) -> bool {
        self.is_on
    }

    /// Switches between on and off.
    pub fn toggle(&mut self) {
        *self = Self { is_on: !self.is_on, columns: self.columns, ..Self::default() };
    }

    /// Forgets the position.
    pub fn forget(&mut self) {
        *self = Self { is_on: self.is_on, columns: self.columns, ..Self::default() };
    }

    /// Sets the width of the window.
    pub fn set_columns(&mut self, columns: u16) {
        self.columns = columns;
        self.forget();
    }

    /// Handles an event. Motion and clicks count only if the player `plays`.
    pub fn handle(&mut self, event: MouseEvent, plays: bool) {
        if !self.is_on {
            return;
        }
        self.move_to(event.x, event.y);
        if !plays {
            self.moved = [0, 0];
            return;
        }
        match event.kind {
            MouseEventKind::Pressed(MouseButton::Left) => self.clicked.insert(Intent::Open),
            MouseEventKind::Pressed(MouseButton::Right) => self.clicked.insert(Intent::Jump),
            _ => {}
        }
    }

    /// The intents of the buttons for the next step.
    pub fn clicked(&self) -> Intents {
        self.clicked
    }

    /// Whether the next step turns the player or uses a click.
    pub fn is_busy(&self) -> bool {
        self.has_input() || self.edge.is_some()
    }

    /// Moves the pointer to a position in units of [`MouseEvent`].
    fn move_to(&mut self, x: u32, y: u32) {
        let units_per_cell = MouseEvent::UNITS_PER_CELL as i32;
        let position = [x, y].map(|units| {
            units as i32 * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / units_per_cell
        });
        let before = self.position.replace(position).unwrap_or(position);
        let [right, down] = [position[0] - before[0], position[1] - before[1]];
        let half_a_window =
            i32::from(self.columns) * DEGREES_PER_CELL * i32::from(Look::PER_DEGREE) / 2;
        // For a longer motion, the pointer was outside of the window.
        if right.abs() <= half_a_window {
            self.moved = [self.moved[0] + right, self.moved[1] + down];
        }
        self.edge = self.edge_at(x as i32 / units_per_cell).map(|edge| (edge, EDGE_STEPS));
    }

    /// The edge at `column`.
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

    /// The turn and tilt of the next step.
    pub fn look(&self) -> Look {
        let at_edge = self.edge.map_or(0, |(edge, _)| {
            i32::from(edge) * DEGREES_PER_SECOND * i32::from(Look::PER_DEGREE)
                / STEPS_PER_SECOND as i32
        });
        let within = |amount: i32| amount.clamp(-i32::from(i16::MAX), i16::MAX.into()) as i16;
        Look { turn: within(self.moved[0] + at_edge), tilt: within(-self.moved[1]) }
    }

    /// Whether there was motion or a click since the last step.
    pub(crate) fn has_input(&self) -> bool {
        self.moved != [0, 0] || !self.clicked.is_empty()
    }

    /// Records that `steps` steps have used [`Pointer::look`].
    pub fn passed(&mut self, steps: u64) {
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
    fn the_first_position_turns_nothing_and_a_cell_is_two_degrees() {
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
    fn at_an_edge_the_player_makes_one_turn() {
        let mut pointer = on(80);
        pointer.move_to(50 * CELL, 10 * CELL);
        pointer.move_to(79 * CELL, 10 * CELL);
        pointer.passed(1);
        let mut turned = 0;
        for _ in 0..10_000 {
            turned += i32::from(pointer.look().turn);
            pointer.passed(1);
        }
        // The first step is the one that used the motion.
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
        fn returning_to_a_position_turns_nothing(
            positions in prop::collection::vec((20 * CELL..60 * CELL, 0..24 * CELL), 1..40),
            cuts in prop::collection::vec(any::<bool>(), 40),
        ) {
            let mut pointer = on(80);
            let mut sum = [0, 0];
            for (&(x, y), &cut) in positions.iter().chain(&positions[..1]).zip(cuts.iter().chain(&cuts)) {
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
