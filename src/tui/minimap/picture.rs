//! The pixels of a map.
//!
//! A row of pixels finds its row of tiles and things once, not for each pixel.

use super::map_point::MapPoint;
use super::top_view::{Row, TopView};
use super::window::Window;

/// A map and the part of it that is shown.
pub(crate) struct Picture<'a> {
    pub(crate) top_view: TopView<'a>,
    pub(crate) window: Window,
}

impl<'a> Picture<'a> {
    /// The pixels in row `y`.
    pub(crate) fn row(&self, y: u32) -> PixelRow<'_, 'a> {
        let y = self.window.y_of(y);
        PixelRow { picture: self, y, middle: self.top_view.row(y) }
    }

    /// The map point at a pixel.
    pub(crate) fn point(&self, x: u32, y: u32) -> MapPoint {
        self.row(y).point(x)
    }
}

/// A row of pixels of a map.
pub(crate) struct PixelRow<'p, 'a> {
    picture: &'p Picture<'a>,
    /// The position of the middle of the pixels.
    y: f64,
    /// The points in the middle of the pixels.
    middle: Row<'p>,
}

impl PixelRow<'_, '_> {
    /// The map point at a pixel. If a pixel covers several cells, it is the most important one.
    #[inline]
    pub(crate) fn point(&self, x: u32) -> MapPoint {
        let window = &self.picture.window;
        let x = window.x_of(x);
        match window.cells_per_pixel() {
            [1, 1] => self.middle.point(x),
            cells => self.most_important(x, cells),
        }
    }

    /// The most important point of the pixel at `x`, which covers this number of cells.
    #[inline(never)]
    fn most_important(&self, x: f64, [columns, rows]: [u32; 2]) -> MapPoint {
        let top_view = &self.picture.top_view;
        // The pixel covers this number of cells in each direction; each is sampled at its middle.
        let along = |middle: f64, count: u32| {
            let first = middle - f64::from(count - 1) / 2.0;
            (0..count).map(move |index| first + f64::from(index))
        };
        let points = along(self.y, rows).flat_map(|y| {
            let row = top_view.row(y);
            along(x, columns).map(move |x| row.point(x))
        });
        points.max_by_key(|point| point.importance()).unwrap_or(MapPoint::Void)
    }
}
