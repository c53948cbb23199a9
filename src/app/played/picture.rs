//! The picture of a level that is played.

use ratatui::layout::{Rect, Size};

use super::{Played, Views};
use crate::app::DrawOptions;
use crate::tui::canvas::Canvas;

impl Played {
    /// Renders the player's view for an area of this size; may stop once `go_on` returns `false`.
    /// Returns whether the picture is complete.
    pub(crate) fn render(
        &self,
        options: &DrawOptions,
        size: Size,
        views: &mut Views,
        go_on: &mut dyn FnMut() -> bool,
    ) -> bool {
        let seconds = self.elapsed();
        match self {
            Self::Grid(game) => {
                let camera = game.camera(options.field_of_view);
                let picture = options.picture(game.world(), &camera, seconds);
                options.render(&picture, size, &mut views.grid, go_on)
            }
            Self::Space(flight) => {
                let camera = flight.camera(options.field_of_view);
                let picture = options.picture(flight.scene(), &camera, seconds);
                options.render(&picture, size, &mut views.space, go_on)
            }
        }
    }

    /// Paints the rendered picture into `area`, which has the size that it was rendered for.
    pub(crate) fn paint(
        &self,
        options: &DrawOptions,
        canvas: &mut impl Canvas,
        area: Rect,
        views: &Views,
    ) {
        let seconds = self.elapsed();
        match self {
            Self::Grid(game) => {
                let camera = game.camera(options.field_of_view);
                let picture = options.picture(game.world(), &camera, seconds);
                picture.paint(&views.grid, 0, area, canvas);
            }
            Self::Space(flight) => {
                let camera = flight.camera(options.field_of_view);
                let picture = options.picture(flight.scene(), &camera, seconds);
                picture.paint(&views.space, 0, area, canvas);
            }
        }
    }
}
