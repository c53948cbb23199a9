//! The size of the window, and the shape of its cells.

/// The size of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowSize {
    /// How many cells wide it is: 0 to [`WindowSize::MOST_COLUMNS`].
    pub columns: u16,
    /// How many cells high it is: 0 to [`WindowSize::MOST_ROWS`].
    pub rows: u16,
    /// A cell's height divided by its width, from 1.5 to 3, where the terminal says so.
    pub cell_aspect: Option<f64>,
    /// How many pixels wide and high it is, where the terminal says so and its cells have a shape
    /// that is believed.
    pub pixels: Option<[u16; 2]>,
}

impl WindowSize {
    /// More columns than this are left blank: a terminal that claims them is not to be believed.
    pub const MOST_COLUMNS: u16 = 2048;
    /// More rows than this are left blank.
    pub const MOST_ROWS: u16 = 1024;

    /// What is assumed of a terminal that does not say.
    #[cfg(unix)]
    pub(super) const UNKNOWN: Self =
        Self { columns: 80, rows: 24, cell_aspect: None, pixels: None };

    /// The size of a window of so many columns and rows, and so many pixels across and down. Some
    /// terminals say that they have no pixels, some say nonsense.
    #[cfg(unix)]
    pub(super) fn new((columns, rows): (u16, u16), (width, height): (u16, u16)) -> Self {
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

    /// Without the shape of the cells, as ratatui has it.
    pub(super) fn cells(self) -> ratatui::layout::Size {
        ratatui::layout::Size { width: self.columns, height: self.rows }
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn aspect(cells: (u16, u16), pixels: (u16, u16)) -> Option<f64> {
        WindowSize::new(cells, pixels).cell_aspect
    }

    #[test]
    fn a_sane_shape_of_cells_is_believed() {
        assert_eq!(aspect((80, 24), (640, 384)), Some(2.0));
        assert_eq!(aspect((100, 50), (1000, 1100)), Some(2.2));
    }

    #[test]
    fn nonsense_about_pixels_is_not() {
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
