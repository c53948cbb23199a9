//! How a picture is drawn, and the drawing itself.

use ratatui::layout::Rect;

use super::hud;
use crate::canvas::Canvas;
use crate::color::palette::ColorDepth;
use crate::game::Flash;
use crate::render::{Filter, Frame, Renderable};
use crate::tui::{CellAspect, FirstPerson, GlyphMode, View};
use crate::world::{FieldOfView, Heading};

/// How a picture is drawn.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DrawOptions {
    pub(crate) glyphs: GlyphMode,
    pub(crate) depth: ColorDepth,
    pub(crate) cell_aspect: CellAspect,
    pub(crate) filter: Filter,
    pub(crate) field_of_view: FieldOfView,
    /// The flash at the edge, and the direction of view.
    pub(crate) flash: Option<(Flash, Heading)>,
    /// Whether a dot marks the middle.
    pub(crate) marks_middle: bool,
}

impl DrawOptions {
    /// Draws `scene` from `camera` at the time `seconds`.
    pub(crate) fn draw<S: Renderable>(
        &self,
        scene: &S,
        camera: &S::Camera,
        seconds: f64,
        canvas: &mut impl Canvas,
        area: Rect,
        view: &mut View<S>,
    ) {
        let picture = FirstPerson::new(scene, camera)
            .glyphs(self.glyphs)
            .color_depth(self.depth)
            .cell_aspect(self.cell_aspect)
            .filter(self.filter)
            .time(seconds);
        picture.draw(area.as_size(), view);
        if !area.is_empty() && self.depth != ColorDepth::Mono {
            self.change_pixels(view.frame_mut());
        }
        picture.paint(view, 0, area, canvas);
    }
}

impl DrawOptions {
    /// Tints and marks the pixels of a picture in colours.
    fn change_pixels(&self, frame: &mut Frame) {
        if let Some((flash, heading)) = &self.flash {
            hud::tint(frame, flash, *heading);
        }
        if self.marks_middle && self.glyphs == GlyphMode::Half {
            hud::mark_middle(frame);
        }
    }
}
