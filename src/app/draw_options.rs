//! How a picture is drawn, and the drawing itself.

use ratatui::layout::Rect;
use ratatui::layout::Size;

use super::hud;
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::game::Flash;
use crate::render::{Filter, Frame, Renderable};
use crate::tui::canvas::Canvas;
use crate::tui::{CellAspect, Correction, FirstPerson, GlyphSet, View};
use crate::world::{FieldOfView, Heading};

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
pub struct DrawOptions {
    pub glyphs: GlyphSet,
    pub depth: ColorDepth,
    pub shade_ink: ShadeInk,
    pub cell_aspect: CellAspect,
    pub filter: Filter,
    pub correction: Correction,
    pub field_of_view: FieldOfView,
    /// The flash at the edge, and the direction of view.
    pub flash: Option<(Flash, Heading)>,
    /// Whether a dot marks the middle.
    pub marks_middle: bool,
}

impl DrawOptions {
    /// Draws `scene` from `camera` at the time `seconds`.
    pub fn draw<S: Renderable>(
        &self,
        scene: &S,
        camera: &S::Camera,
        seconds: f64,
        canvas: &mut impl Canvas,
        area: Rect,
        view: &mut View<S>,
    ) {
        let picture = self.picture(scene, camera, seconds);
        self.render(&picture, area.as_size(), view, &mut || true);
        picture.paint(view, 0, area, canvas);
    }

    /// The picture of `scene` from `camera` at the time `seconds`.
    pub(crate) fn picture<'a, S: Renderable>(
        &self,
        scene: &'a S,
        camera: &'a S::Camera,
        seconds: f64,
    ) -> FirstPerson<'a, S> {
        FirstPerson::new(scene, camera)
            .glyphs(self.glyphs)
            .color_depth(self.depth)
            .shade_ink(self.shade_ink)
            .cell_aspect(self.cell_aspect)
            .filter(self.filter)
            .correction(self.correction)
            .time(seconds)
    }

    /// Renders `picture` for an area of this size into `view`; may stop once `go_on` returns `false`.
    /// Returns whether the picture is complete.
    pub(crate) fn render<S: Renderable>(
        &self,
        picture: &FirstPerson<'_, S>,
        size: Size,
        view: &mut View<S>,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let is_complete = picture.draw_while(size, view, go_on);
        let has_pixels = size.width > 0 && size.height > 0;
        if is_complete && has_pixels && self.depth != ColorDepth::Mono {
            self.change_pixels(view.frame_mut());
        }
        is_complete
    }

    /// Tints and marks the pixels of a picture in colours.
    fn change_pixels(&self, frame: &mut Frame) {
        if let Some((flash, heading)) = &self.flash {
            hud::tint(frame, flash, *heading);
        }
        if self.marks_middle && self.glyphs.has_blocks() {
            hud::mark_middle(frame);
        }
    }
}
