//! Where a player stands in a step, and how they look, in 16 bytes.

use glam::DVec2;

use cellcaster::game::Game;
use cellcaster::world::{FieldOfView, Figure, Heading, SpriteId};

/// A pose. Coordinates are rounded to single precision, a few millionths of a cell, and headings to
/// 65,536ths of a turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pose {
    position: [f32; 2],
    feet: f32,
    heading: u16,
    frame: u8,
}

/// The headings in a turn.
const HEADINGS: f64 = 65_536.0;

impl Pose {
    /// The pose of the player of `game`, who has walked so many cells.
    pub(crate) fn of(game: &Game, walked: f64) -> Self {
        let camera = game.camera(FieldOfView::default());
        let turns = camera.heading.degrees() / 360.0;
        Self {
            position: camera.position().to_array().map(|coordinate| coordinate as f32),
            feet: game.feet() as f32,
            // The cast maps a whole turn to 65,535.
            heading: (turns * HEADINGS).round() as u16,
            frame: game.frame_of_figure(walked),
        }
    }

    /// The figure in this pose.
    pub(crate) fn figure(self, sprite: SpriteId, opacity: u8) -> Figure {
        let Self { position, feet, heading, frame } = self;
        let degrees = f64::from(heading) / HEADINGS * 360.0;
        Figure {
            sprite,
            position: DVec2::from_array(position.map(f64::from)),
            base: f64::from(feet),
            heading: Heading::from_degrees(degrees).unwrap_or_default(),
            frame,
            opacity,
        }
    }
}
