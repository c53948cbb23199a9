//! The last pass: what is seen through, over what is seen behind it, and tints over mirror images.

use std::ops::Range;

use super::Scene;
use super::faces::Stretch;
use crate::cast::Side;
use crate::render::Frame;
use crate::render::shade::{Faded, Shade};
use crate::render::tally::{Pass, Tally};
use crate::world::{Glass, Light, TextureId};

/// Something to see through, as wide as a pixel.
#[derive(Clone, Debug)]
pub(super) struct Veil {
    pub(super) column: u32,
    pub(super) rows: Range<u32>,
    pub(super) side: Side,
    pub(super) t: f64,
    pub(super) u: f64,
    pub(super) light: Light,
    pub(super) film: Film,
    pub(super) stretch: Stretch,
}

/// What is painted over what is behind it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Film {
    Mask(TextureId),
    Glass(Glass),
}

/// Draws all of `veils`, the last ones first: in a column they are further away.
pub(super) fn draw<T: Tally>(scene: Scene<'_>, veils: &[Veil], frame: &mut Frame, tally: &mut T) {
    for veil in veils.iter().rev() {
        tally.pixels(Pass::SeeThrough, veil.rows.len());
        let shade = Faded::of_wall(veil.side, veil.light, scene.world.fog(), veil.t);
        match veil.film {
            Film::Mask(texture) => {
                tally.texels(Pass::SeeThrough, veil.rows.len());
                veil.draw_mask(scene, texture, shade, frame);
            }
            Film::Glass(glass) => veil.draw_glass(glass, shade, frame),
        }
    }
}

impl Veil {
    fn draw_mask(&self, scene: Scene<'_>, texture: TextureId, shade: Faded, frame: &mut Frame) {
        let texture = scene.world.texture(texture).level(0);
        let texels = texture.column(self.u);
        let Some(alphas) = texture.alpha_column(self.u) else { return };
        let Stretch { bottom, top } = self.stretch;
        let texels_down = scene.projection.texels_down_the_face(self.t, texels.len(), bottom, top);
        let pixels = frame.column_mut(self.column, self.rows.clone());
        for (row, pixel) in self.rows.clone().zip(pixels) {
            let texel = texels_down.at(row);
            *pixel = shade.apply(texels[texel]).over(*pixel, alphas[texel]);
        }
    }

    fn draw_glass(&self, glass: Glass, shade: Faded, frame: &mut Frame) {
        let tint = shade.apply(glass.color);
        for pixel in frame.column_mut(self.column, self.rows.clone()) {
            *pixel = tint.over(*pixel, glass.opacity);
        }
    }
}
