//! What is drawn: a grid, or bodies.

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use crate::cli::arguments::Snapshot;
use crate::space::{self, Scene};
use crate::tui::{FirstPerson, SpaceMemory, SpaceView, View};
use crate::world::{Camera, World};

/// A picture that is drawn once, and painted a band of rows at a time.
pub(super) trait Picture {
    /// Draws it; the answer tells how, if that `is_explained`.
    fn draw(&mut self, size: Size, is_explained: bool) -> String;

    /// Fills `area` with its cells from the row `first_row` on.
    fn paint(&self, first_row: u16, area: Rect, buffer: &mut Buffer);
}

/// The picture of a grid.
pub(super) struct OfGrid<'a> {
    widget: FirstPerson<'a>,
    view: View,
}

/// The picture of bodies.
pub(super) struct OfSpace<'a> {
    widget: SpaceView<'a>,
    memory: SpaceMemory,
}

impl<'a> OfGrid<'a> {
    pub(super) fn new(
        world: &'a World,
        camera: &'a Camera,
        view: View,
        options: &Snapshot,
    ) -> Self {
        let widget = FirstPerson::new(world, camera)
            .glyphs(options.glyphs)
            .color_depth(options.depth)
            .cell_aspect(options.cell_aspect)
            .filter(options.filter);
        Self { widget, view }
    }
}

impl<'a> OfSpace<'a> {
    pub(super) fn new(scene: &'a Scene, camera: &'a space::Camera, options: &Snapshot) -> Self {
        let widget = SpaceView::new(scene, camera)
            .glyphs(options.glyphs)
            .color_depth(options.depth)
            .cell_aspect(options.cell_aspect);
        Self { widget, memory: SpaceMemory::default() }
    }
}

impl Picture for OfGrid<'_> {
    fn draw(&mut self, size: Size, is_explained: bool) -> String {
        if is_explained {
            let explanation = self.widget.explain(size, &mut self.view);
            return explanation.map(|it| it.to_string()).unwrap_or_default();
        }
        self.widget.draw(size, &mut self.view);
        String::new()
    }

    fn paint(&self, first_row: u16, area: Rect, buffer: &mut Buffer) {
        self.widget.paint(&self.view, first_row, area, buffer);
    }
}

impl Picture for OfSpace<'_> {
    fn draw(&mut self, size: Size, _: bool) -> String {
        let explanation = self.widget.draw(size, &mut self.memory);
        explanation.map(|it| it.to_string()).unwrap_or_default()
    }

    fn paint(&self, first_row: u16, area: Rect, buffer: &mut Buffer) {
        self.widget.paint(&self.memory, first_row, area, buffer);
    }
}
