//! Events from the terminal, the position of the mouse, and the size of the window.

use super::KeyEvent;
use crate::color::palette::ColorDepth;

/// An event of the terminal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Event {
    /// A key was pressed, repeated or released.
    Key(KeyEvent),
    /// The mouse was moved, or one of its buttons pressed or released. Only if
    /// [`Session::set_mouse`](super::Session::set_mouse) has turned on reports.
    Mouse(MouseEvent),
    /// The window has received the focus.
    FocusGained,
    /// The window has lost the focus. Releases of held keys may not be reported.
    FocusLost,
    /// The window may have another size, and the next frame repaints it.
    Resized,
    /// The terminal, or tmux around the program, has answered that it shows this number of colours,
    /// which is not the one assumed before.
    ColorDepth(ColorDepth),
    /// The terminal has said its name, so that
    /// [`Session::glyph_support`](super::Session::glyph_support) and
    /// [`Protocol::shade_ink`](super::Protocol::shade_ink) may have changed.
    Identified,
    /// The terminal has answered whether it reports key releases. Sent at most once; before it,
    /// releases are not reported.
    KeyReleases(bool),
    /// Whether [`Session::tell_tmux`](super::Session::tell_tmux) has worked.
    TmuxTold(bool),
    /// The terminal is ready for the next frame. Sent only after
    /// [`Session::is_ready`](super::Session::is_ready) has returned `false`.
    Ready,
    /// The user wants to return to the shell for a while, by Ctrl-Z or a signal. The program should
    /// call [`Session::suspend`](super::Session::suspend).
    Suspend,
    /// The program should end. After a signal, it is ended by force one second later.
    Quit(QuitReason),
}

/// The reason why the program should end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum QuitReason {
    /// The user pressed Ctrl-C, or the process received SIGINT.
    Interrupted,
    /// The process received SIGTERM.
    Terminated,
    /// The terminal is gone: the process received SIGHUP.
    HungUp,
    /// The input is closed, so that no more keys can arrive.
    InputClosed,
}

/// An event of the mouse.
///
/// Terminals report the position of the pointer in the window, in cells or in pixels, but never the motion of the mouse
/// itself. Both are converted to the same unit, so that a program does not depend on the difference.
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

/// The size of the window, and the shape of its cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSize {
    /// The width in cells: 0 to [`WindowSize::MOST_COLUMNS`].
    pub columns: u16,
    /// The height in cells: 0 to [`WindowSize::MOST_ROWS`].
    pub rows: u16,
    /// A cell's height divided by its width, from 1.5 to 3, if the terminal reports it.
    pub cell_aspect: Option<f64>,
    /// The width and the height in pixels, if the terminal reports them and the cells then have a
    /// plausible shape.
    pub pixels: Option<[u16; 2]>,
}

impl WindowSize {
    /// The most columns that are used; further ones are left blank, since a terminal that reports
    /// more is not credible.
    pub const MOST_COLUMNS: u16 = 2048;
    /// The most rows that are used; further ones are left blank.
    pub const MOST_ROWS: u16 = 1024;

    /// The assumed size of a terminal that reports none.
    #[cfg(unix)]
    pub(crate) const UNKNOWN: Self =
        Self { columns: 80, rows: 24, cell_aspect: None, pixels: None };

    /// A window of this many cells, whose size in pixels is unknown.
    pub fn of_cells(columns: u16, rows: u16) -> Self {
        Self::new((columns, rows), (0, 0))
    }

    /// The size of a window in columns and rows, and in pixels. Some terminals report no pixels,
    /// some implausible numbers.
    pub fn new((columns, rows): (u16, u16), (width, height): (u16, u16)) -> Self {
        let cell_width = f64::from(width) / f64::from(columns);
        let cell_height = f64::from(height) / f64::from(rows);
        let cell_aspect =
            Some(cell_height / cell_width).filter(|aspect| (1.5..=3.0).contains(aspect));
        Self {
            columns: columns.min(Self::MOST_COLUMNS),
            rows: rows.min(Self::MOST_ROWS),
            cell_aspect,
            pixels: cell_aspect.map(|_| [width, height]),
        }
    }

    /// The size in cells, as ratatui's type.
    pub(crate) fn cells(self) -> ratatui::layout::Size {
        ratatui::layout::Size { width: self.columns, height: self.rows }
    }
}

#[cfg(test)]
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

    fn aspect(cells: (u16, u16), pixels: (u16, u16)) -> Option<f64> {
        WindowSize::new(cells, pixels).cell_aspect
    }

    #[test]
    fn a_plausible_shape_of_cells_is_used() {
        assert_eq!(aspect((80, 24), (640, 384)), Some(2.0));
        assert_eq!(aspect((100, 50), (1000, 1100)), Some(2.2));
    }

    #[test]
    fn implausible_pixels_are_ignored() {
        for (cells, pixels) in [
            ((80, 24), (0, 0)),
            ((80, 24), (640, 0)),
            ((80, 24), (0, 384)),
            ((0, 0), (0, 0)),
            ((0, 0), (640, 384)),
            ((80, 24), (80, 24)),
            ((80, 24), (640, 3840)),
        ] {
            assert_eq!(aspect(cells, pixels), None, "{cells:?} {pixels:?}");
        }
    }

    #[test]
    fn no_window_is_too_large_to_draw() {
        let size = WindowSize::new((u16::MAX, u16::MAX), (0, 0));
        assert_eq!((size.columns, size.rows), (2048, 1024));
    }
}
