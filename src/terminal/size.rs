//! The size of the window, and the shape of its cells.

/// The size of the window.
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

#[cfg(all(test, unix))]
mod tests {
    use super::*;

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
