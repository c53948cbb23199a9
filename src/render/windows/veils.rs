//! The last pass: what is seen through, over what is seen behind it, and tints over mirror images.

use std::ops::Range;

use super::Scene;
use super::faces::{Facing, Stretch};
use super::notes::Notes;
use super::things::{Between, Billboards, Strip};
use crate::cast::Side;
use crate::render::Surface;
use crate::render::band::Band;
use crate::render::marks::MarksOfBand;
use crate::render::shade::{Faded, Shade};
use crate::render::tally::{Pass, Tally};
use crate::world::{Glass, Light, TextureId};

/// What a ray passes.
#[derive(Clone, Debug)]
pub(super) enum Veil {
    /// Which of all panes.
    Pane(usize),
    /// The things in a part of the ray.
    Things(Between),
}

/// What is painted over what is behind it, as wide as a pixel.
#[derive(Clone, Debug)]
pub(super) enum Layer {
    /// Which of all panes.
    Pane(usize),
    Thing(Strip),
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

/// Finds out in `layers` what is to be painted for the veils of `notes`: in each column, what is nearer
/// comes later.
pub(super) fn lay_out(
    scene: Scene<'_>,
    notes: &Notes,
    billboards: &mut Billboards,
    layers: &mut Vec<Layer>,
) {
    layers.clear();
    layers.reserve(notes.veils.capacity());
    for veil in notes.veils.iter().rev() {
        match veil {
            &Veil::Pane(index) => layers.push(Layer::Pane(index)),
            Veil::Things(between) => {
                billboards.cut(scene, between, |strip| layers.push(Layer::Thing(strip)));
            }
        }
    }
}

/// Paints all `layers`.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    (panes, billboards, layers): (&[Pane], &Billboards, &[Layer]),
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    for layer in layers {
        match layer {
            &Layer::Pane(index) => panes[index].draw(scene, marks, band, tally),
            Layer::Thing(strip) => billboards.draw(scene, strip, marks, band, tally),
        }
    }
}

impl Pane {
    fn draw<T: Tally>(
        &self,
        scene: Scene<'_>,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
        tally: &mut T,
    ) {
        tally.pixels(Pass::SeeThrough, self.rows.len());
        let shade = self.facing.shade(scene, self.light, self.t);
        match self.film {
            Film::Mask(texture) => {
                tally.texels(Pass::SeeThrough, self.rows.len());
                self.draw_mask(scene, texture, shade, marks, band);
            }
            Film::Glass(glass) => self.draw_glass(glass, shade, band),
        }
    }

    fn draw_mask(
        &self,
        scene: Scene<'_>,
        texture: TextureId,
        shade: Faded,
        marks: &mut MarksOfBand<'_>,
        band: &mut Band<'_>,
    ) {
        let level = scene.level_on(scene.world.texture(texture), self.t, self.slope);
        let texels = level.column(self.u);
        let Some(alphas) = level.alpha_column(self.u) else { return };
        let Stretch { bottom, top } = self.stretch;
        let texels_down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
        let pixels = band.column_mut(self.column, self.rows.clone());
        for (row, pixel) in self.rows.clone().zip(pixels) {
            let texel = texels_down.at(row);
            *pixel = shade.apply(texels[texel]).over(*pixel, alphas[texel]);
        }
        let surface = match self.facing {
            Facing::Side(Side::Y) => Surface::WallY,
            Facing::Side(Side::X) | Facing::Normal(_) => Surface::WallX,
        };
        let is_shown = |row| alphas[texels_down.at(row)] > u8::MAX / 2;
        let shown = self.rows.clone().map(is_shown);
        marks.note(self.column as usize, self.rows.start, surface, shown);
    }

    fn draw_glass(&self, glass: Glass, shade: Faded, band: &mut Band<'_>) {
        let tint = shade.apply(glass.color);
        for pixel in band.column_mut(self.column, self.rows.clone()) {
            *pixel = tint.over(*pixel, glass.opacity);
        }
    }
}
