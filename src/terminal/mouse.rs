//! The mouse: the position of its pointer, and its buttons.
//!
//! Terminals report the position of the pointer in the window, in cells or in pixels, but never the
//! motion of the mouse itself. Both are converted to the same unit, so that a program does not
//! depend on the difference.

use super::WindowSize;

/// An event of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MouseEvent {
    /// The distance of the pointer from the left edge of the window, in units of 1 /
    /// [`MouseEvent::UNITS_PER_CELL`] of a cell's width. If the terminal reports only cells, the
    /// middle of the cell.
    pub x: u32,
    /// The distance of the pointer from the upper edge, in the same parts of a cell's height.
    pub y: u32,
    /// The kind of event.
    pub kind: MouseEventKind,
}

impl MouseEvent {
    /// The number of units in a cell: in its width for `x`, in its height for `y`.
    pub const UNITS_PER_CELL: u32 = 64;
}

/// The kind of a mouse event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseEventKind {
    /// The pointer was moved, with or without a button held.
    Moved,
    /// A button was pressed.
    Pressed(MouseButton),
    /// A button was released; some terminals do not report which.
    Released,
}

/// A button of the mouse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MouseButton {
    /// The first button.
    Left,
    /// The wheel, when pressed.
    Middle,
    /// The second button.
    Right,
}

/// A report of the mouse, as the terminal sends it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct MouseReport {
    pub(crate) kind: MouseEventKind,
    /// The column and the row of the cell or the pixel, from 1.
    pub(crate) place: [u32; 2],
}

/// The unit of the pointer's position in reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MouseUnits {
    Cells,
    Pixels,
}

impl MouseReport {
    /// The event in a window of `size`; `None` if the position is in pixels and the size in pixels
    /// is unknown.
    pub(crate) fn event(self, units: MouseUnits, size: WindowSize) -> Option<MouseEvent> {
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
    fn pixels_are_ignored_if_their_number_is_unknown() {
        let report = MouseReport { kind: MouseEventKind::Moved, place: [100, 100] };
        assert_eq!(report.event(MouseUnits::Pixels, WindowSize::new((80, 24), (0, 0))), None);
    }
}
