//! The mouse: where its pointer is, and what its buttons do.
//!
//! Terminals tell where the pointer is in the window, in cells or in pixels, and never how far the
//! mouse itself was moved. Both become the same unit here, so that a program need not know which.

use super::WindowSize;

/// Something happened to the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MouseEvent {
    /// How far the pointer is from the window's left edge, in cells divided by
    /// [`MouseEvent::UNITS_PER_CELL`]. Where the terminal tells the cell alone, its middle.
    pub x: u32,
    /// How far it is from the upper edge, likewise.
    pub y: u32,
    /// What happened.
    pub kind: MouseEventKind,
}

impl MouseEvent {
    /// How many units of a place make a cell: its width for `x`, its height for `y`.
    pub const UNITS_PER_CELL: u32 = 64;
}

/// What happened to the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseEventKind {
    /// The pointer was moved, whether or not a button is held.
    Moved,
    /// A button went down.
    Pressed(MouseButton),
    /// A button went up, of which some terminals do not tell which.
    Released,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseButton {
    /// The first one.
    Left,
    /// The wheel, pressed.
    Middle,
    /// The second one.
    Right,
}

/// A report of the mouse, as the terminal sends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MouseReport {
    pub(super) kind: MouseEventKind,
    /// Column and row of the cell or the pixel, from 1.
    pub(super) place: [u32; 2],
}

/// What the terminal reports the pointer's place in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MouseUnits {
    Cells,
    Pixels,
}

impl MouseReport {
    /// The event in a window of `size`; `None` where the place is in pixels and nobody knows how many
    /// of them there are.
    pub(super) fn event(self, units: MouseUnits, size: WindowSize) -> Option<MouseEvent> {
        const UNITS: u64 = MouseEvent::UNITS_PER_CELL as u64;
        let from_zero = self.place.map(|one| u64::from(one.saturating_sub(1)));
        let [x, y] = match units {
            MouseUnits::Cells => from_zero.map(|cell| cell * UNITS + UNITS / 2),
            MouseUnits::Pixels => {
                let [width, height] = size.pixels?.map(|length| u64::from(length).max(1));
                let [x, y] = from_zero;
                [
                    x * u64::from(size.columns) * UNITS / width,
                    y * u64::from(size.rows) * UNITS / height,
                ]
            }
        };
        let within = |units: u64, cells: u16| units.min(u64::from(cells) * UNITS) as u32;
        Some(MouseEvent { x: within(x, size.columns), y: within(y, size.rows), kind: self.kind })
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn place(units: MouseUnits, place: [u32; 2]) -> Option<(u32, u32)> {
        let report = MouseReport { kind: MouseEventKind::Moved, place };
        let event = report.event(units, WindowSize::new((80, 24), (720, 432)))?;
        Some((event.x, event.y))
    }

    #[test]
    fn cells_and_pixels_are_the_same_places() {
        assert_eq!(place(MouseUnits::Cells, [1, 1]), Some((32, 32)));
        assert_eq!(place(MouseUnits::Cells, [80, 24]), Some((79 * 64 + 32, 23 * 64 + 32)));
        assert_eq!(place(MouseUnits::Pixels, [1, 1]), Some((0, 0)));
        // 9 by 18 pixels a cell.
        assert_eq!(place(MouseUnits::Pixels, [10, 19]), Some((64, 64)));
        assert_eq!(place(MouseUnits::Pixels, [4, 9]), Some((21, 28)));
    }

    #[test]
    fn no_place_is_outside_of_the_window() {
        for units in [MouseUnits::Cells, MouseUnits::Pixels] {
            assert_eq!(place(units, [u32::MAX, u32::MAX]), Some((80 * 64, 24 * 64)));
            assert!(place(units, [0, 0]).is_some());
        }
    }

    #[test]
    fn pixels_mean_nothing_where_nobody_knows_how_many_there_are() {
        let report = MouseReport { kind: MouseEventKind::Moved, place: [100, 100] };
        assert_eq!(report.event(MouseUnits::Pixels, WindowSize::new((80, 24), (0, 0))), None);
    }
}
