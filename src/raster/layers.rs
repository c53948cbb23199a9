//! Layers: masks, tints and billboards, which are drawn over the opaque surfaces.

use super::faces;
use super::target::Target;
use crate::color::Rgb;
use crate::visibility::{BillboardPart, DrawList, FrameContext, Layer, Pass, Surface};

/// Draws the layers of `list` in order.
pub(crate) fn draw(scene: FrameContext<'_>, list: &DrawList, target: &mut Target<'_>) {
    for layer in &list.layers {
        match layer {
            Layer::Billboard(part) => draw_billboard(scene, list, part, target),
            &Layer::Face(index) => faces::draw_over(scene, list, &list.see_through[index], target),
            Layer::Part(_) => {}
        }
    }
}

/// Draws a part of a billboard over the pixels behind it.
fn draw_billboard(
    scene: FrameContext<'_>,
    list: &DrawList,
    part: &BillboardPart,
    target: &mut Target<'_>,
) {
    let lighting = list.billboards[part.billboard].lighting;
    if lighting.is_full() {
        draw_lit(scene, list, part, |color| color, target);
    } else {
        draw_lit(scene, list, part, |color| lighting.apply(color), target);
    }
}

fn draw_lit(
    scene: FrameContext<'_>,
    list: &DrawList,
    part: &BillboardPart,
    lit: impl Fn(Rgb) -> Rgb,
    target: &mut Target<'_>,
) {
    let billboard = &list.billboards[part.billboard];
    let Some(level) = billboard.level(scene, list.player.as_ref()) else { return };
    let opacity = billboard.opacity;
    let band = target.rows();
    for (x, rows) in part.columns.clone().zip(&list.billboard_rows[part.first..]) {
        let rows = rows.within(&band);
        target.count_pixels(Pass::Things, rows.len());
        target.count_texels(Pass::Things, rows.len());
        let u = billboard.u(x);
        let (texels, alphas) = (level.column(u), level.alpha_column(u));
        let texel = |row: u32| billboard.texel(row).min(texels.len() - 1);
        let alpha = |texel: usize| {
            let alpha = alphas.map_or(u8::MAX, |alphas| alphas[texel]);
            if opacity == u8::MAX { alpha } else { share_of(alpha, opacity) }
        };
        for (row, pixel) in rows.clone().zip(target.column_mut(x, rows.clone())) {
            let texel = texel(row);
            *pixel = match alpha(texel) {
                0 => *pixel,
                u8::MAX => lit(texels[texel]),
                alpha => lit(texels[texel]).over(*pixel, alpha),
            };
        }
        let shown = rows.clone().map(|row| alpha(texel(row)) > u8::MAX / 2);
        target.mark(x, rows.start, Surface::Thing, shown);
    }
}

/// The product of `alpha` and `opacity`, each in 255ths, rounded to the nearest 255th.
fn share_of(alpha: u8, opacity: u8) -> u8 {
    let most = u32::from(u8::MAX);
    ((u32::from(alpha) * u32::from(opacity) + most / 2) / most) as u8
}
