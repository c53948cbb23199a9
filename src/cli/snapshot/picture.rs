//! The picture of a snapshot, for grids and for maps of bodies.

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use crate::cli::arguments::Snapshot;
use crate::render::Renderable;
use crate::tui::{FirstPerson, View};

/// A picture that is drawn once, and converted to cells band by band.
pub(crate) struct Picture<'a, S: Renderable> {
    widget: FirstPerson<'a, S>,
    view: View<S>,
}

impl<'a, S: Renderable> Picture<'a, S> {
    /// The view of `camera` into `scene`, to be drawn into `view`.
    pub(crate) fn new(
        scene: &'a S,
        camera: &'a S::Camera,
        view: View<S>,
        options: &Snapshot,
    ) -> Self {
        let widget = FirstPerson::new(scene, camera)
            .glyphs(options.glyphs)
            .color_depth(options.depth)
            .cell_aspect(options.cell_aspect)
            .filter(options.filter);
        Self { widget, view }
    }

    /// Draws the picture for an area of this size.
    pub(crate) fn draw(&mut self, size: Size) {
        self.widget.draw(size, &mut self.view);
    }

    /// Draws the picture, and returns its counts in lines for people.
    pub(crate) fn explain(&mut self, size: Size) -> String {
        let explanation = self.widget.explain(size, &mut self.view);
        explanation.map(|explanation| explanation.to_string()).unwrap_or_default()
    }

    /// Fills `area` with the cells of the rows from `first_row` on.
    pub(crate) fn paint(&self, first_row: u16, area: Rect, buffer: &mut Buffer) {
        self.widget.paint(&self.view, first_row, area, buffer);
    }
}
