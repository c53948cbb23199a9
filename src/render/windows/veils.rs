//! Veils: what a ray passes on its way, masks and glass, the tints of mirrors, and things.

use std::ops::Range;

use super::Scene;
use super::faces::{Facing, Stretch};
use super::things::Between;
use crate::cast::Side;
use crate::render::Surface;
use crate::render::band::Band;
use crate::render::marks::MarksOfBand;
use crate::render::shade::{Faded, Shade};
use crate::world::{Glass, Light, TextureId};

/// What a ray passes.
#[derive(Clone, Debug)]
pub(super) enum Veil {
    /// Which of all panes.
    Pane(usize),
    /// The things in a part of the ray.
    Things(Between),
}

/// Something to see through, or the tint of a mirror.
#[derive(Clone, Debug)]
pub(super) struct Pane {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    pub(super) facing: Facing,
    /// How much of the ray leads straight at it, for each unit of `t`.
    pub(super) slope: f64,
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) light: Light,
    pub(super) film: Film,
    pub(super) stretch: Stretch,
}

/// What a pane is made of.
#[derive(Clone, Copy, Debug)]
pub(super) enum Film {
    Mask(TextureId),
    Glass(Glass),
}

impl Pane {
    /// Draws what a mask of that `texture` shows in `rows`.
    pub(super) fn draw_mask(
        &self,
        scene: Scene<'_>,
        texture: TextureId,
        shade: Faded,
        rows: Range<u32>,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
    ) {
        let level = scene.level_on(scene.world.texture(texture), self.t, self.slope);
        let texels = level.column(self.u);
        let Some(alphas) = level.alpha_column(self.u) else { return };
        let Stretch { bottom, top } = self.stretch;
        let texels_down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
        let pixels = band.column_mut(self.column, rows.clone());
        for (row, pixel) in rows.clone().zip(pixels) {
            let texel = texels_down.at(row);
            *pixel = shade.apply(texels[texel]).over(*pixel, alphas[texel]);
        }
        let surface = match self.facing {
            Facing::Side(Side::Y) => Surface::WallY,
            Facing::Side(Side::X) | Facing::Normal(_) => Surface::WallX,
        };
        let is_shown = |row| alphas[texels_down.at(row)] > u8::MAX / 2;
        marks.note(self.column as usize, rows.start, surface, rows.map(is_shown));
    }
}
