//! Layers over the surfaces: columns of masked and translucent faces, and of billboards.
//!
//! Glass and the tints of mirrors cover whole areas. Neighbouring columns of one tint are collected and
//! drawn together, row by row. Drawn one column after the other, the tints of mirrors took a fifth of a
//! frame.

use std::ops::Range;

use super::target::Target;
use super::wall_column::lighting_of;
use crate::cast::Side;
use crate::color::Rgb;
use crate::visibility::{
    Billboard, BillboardColumn, DrawList, Extent, Facing, FullyLit, Layer, Lighting, Material,
    Pass, Scene, SeeThroughColumn, Surface,
};
use crate::world::{Glass, TextureId};

/// Paints the layers of `list` in their order.
pub(crate) fn draw(scene: Scene<'_>, list: &DrawList, target: &mut Target<'_>) {
    let mut tints = Tints::default();
    for layer in &list.layers {
        match layer {
            Layer::Billboard(column) => {
                tints.draw_before(column.column, target);
                draw_billboard(scene, list, column, target);
            }
            &Layer::SeeThrough(index) => {
                let column = &list.see_through[index];
                match column.material {
                    Material::Masked(texture) => {
                        tints.draw_before(column.column, target);
                        draw_masked(scene, column, texture, target);
                    }
                    Material::Translucent(glass) => tints.add(scene, column, glass, target),
                }
            }
        }
    }
    tints.draw(target);
}

/// Draws `column`, which has `texture`, over the pixels behind it.
fn draw_masked(
    scene: Scene<'_>,
    column: &SeeThroughColumn,
    texture: TextureId,
    target: &mut Target<'_>,
) {
    let SeeThroughColumn { column: x, facing, slope, t, u, light, extent, .. } = *column;
    let rows = target.clip(&column.rows);
    target.count_pixels(Pass::SeeThrough, rows.len());
    target.count_texels(Pass::SeeThrough, rows.len());
    let level = scene.level_on_face(texture, t, slope);
    let texels = level.column(u);
    let Some(alphas) = level.alpha_column(u) else { return };
    let lighting = lighting_of(scene, facing, light, t);
    let stepper = match extent {
        Extent::Level => {
            let projection = scene.projection;
            projection.texels_down_the_wall(t, projection.wall_texels(texels.len()))
        }
        Extent::Heights { bottom, top } => {
            let projection = scene.projection;
            projection.texels_down_the_face(t, projection.face_texels(texels.len(), (bottom, top)))
        }
    };
    for (row, pixel) in rows.clone().zip(target.column_mut(x, rows.clone())) {
        let texel = stepper.at(row);
        *pixel = lighting.apply(texels[texel]).over(*pixel, alphas[texel]);
    }
    let surface = match facing {
        Facing::Side(side) => Surface::of_wall(side),
        Facing::Normal(_) => Surface::of_wall(Side::X),
    };
    let is_shown = |row| alphas[stepper.at(row)] > u8::MAX / 2;
    target.mark(x, rows.start, surface, rows.map(is_shown));
}

/// The most columns that are drawn together.
const COLUMNS_AT_ONCE: usize = 32;

/// Neighbouring columns of one tint that are not drawn yet.
#[derive(Default)]
struct Tints {
    color: Rgb,
    opacity: u8,
    columns: Range<u32>,
    /// The rows of each column, indexed by the column modulo the number of columns.
    rows: [Range<u32>; COLUMNS_AT_ONCE],
}

impl Tints {
    /// Adds `column`, which is made of `glass`. Draws the others first, if it cannot be drawn with
    /// them.
    fn add(
        &mut self,
        scene: Scene<'_>,
        column: &SeeThroughColumn,
        glass: Glass,
        target: &mut Target<'_>,
    ) {
        let rows = target.clip(&column.rows);
        target.count_pixels(Pass::SeeThrough, rows.len());
        let x = column.column;
        let lighting = lighting_of(scene, column.facing, column.light, column.t);
        let (color, opacity) = (lighting.apply(glass.color), glass.opacity);
        let Range { start, end } = self.columns;
        let is_alike = (color, opacity) == (self.color, self.opacity);
        let is_beside = x == end || x + 1 == start;
        if is_alike && is_beside && self.columns.len() < COLUMNS_AT_ONCE {
            self.columns = start.min(x)..end.max(x + 1);
        } else {
            self.draw(target);
            (self.color, self.opacity, self.columns) = (color, opacity, x..x + 1);
        }
        self.rows[x as usize % COLUMNS_AT_ONCE] = rows;
    }

    /// Draws the collected columns, if `column` is one of them, before another layer is painted
    /// over it.
    #[inline]
    fn draw_before(&mut self, column: u32, target: &mut Target<'_>) {
        if self.columns.contains(&column) {
            self.draw(target);
        }
    }

    /// Draws the collected columns.
    fn draw(&mut self, target: &mut Target<'_>) {
        let &mut Self { color, opacity, ref rows, .. } = self;
        let columns = std::mem::take(&mut self.columns);
        let rows_of = |x: u32| &rows[x as usize % COLUMNS_AT_ONCE];
        let start = columns.clone().map(|x| rows_of(x).start).max().unwrap_or_default();
        let end = columns.clone().map(|x| rows_of(x).end).min().unwrap_or_default().max(start);
        let band = target.band_mut();
        for row in start..end {
            let columns = columns.start as usize..columns.end as usize;
            color.paint_over(&mut band.row_mut(row)[columns], opacity);
        }
        for x in columns {
            let Range { start: top, end: bottom } = *rows_of(x);
            for rest in [top..bottom.min(start), top.max(end)..bottom] {
                for pixel in band.column_mut(x, rest) {
                    *pixel = color.over(*pixel, opacity);
                }
            }
        }
    }
}

/// Draws `column` of a billboard of `list` over the pixels behind it.
fn draw_billboard(
    scene: Scene<'_>,
    list: &DrawList,
    column: &BillboardColumn,
    target: &mut Target<'_>,
) {
    let Billboard { lighting, opacity, .. } = list.billboards[column.billboard];
    let solid = |alpha: u8| alpha;
    let thinned = |alpha: u8| share_of(alpha, opacity);
    match (lighting, opacity) {
        (None, u8::MAX) => draw_lit(scene, list, column, FullyLit, solid, target),
        (Some(faded), u8::MAX) => draw_lit(scene, list, column, faded, solid, target),
        (None, _) => draw_lit(scene, list, column, FullyLit, thinned, target),
        (Some(faded), _) => draw_lit(scene, list, column, faded, thinned, target),
    }
}

/// `alpha` multiplied by `opacity`, in 255ths, rounded to the nearest whole number.
fn share_of(alpha: u8, opacity: u8) -> u8 {
    let most = u32::from(u8::MAX);
    ((u32::from(alpha) * u32::from(opacity) + most / 2) / most) as u8
}

fn draw_lit<L: Lighting>(
    scene: Scene<'_>,
    list: &DrawList,
    column: &BillboardColumn,
    lighting: L,
    alpha_shown: impl Fn(u8) -> u8,
    target: &mut Target<'_>,
) {
    let billboard = &list.billboards[column.billboard];
    let Some(level) = billboard.level(scene, list.player.as_ref()) else { return };
    let (x, rows) = (column.column, target.clip(&column.rows));
    target.count_pixels(Pass::Things, rows.len());
    target.count_texels(Pass::Things, rows.len());
    let u = billboard.u(x);
    let (texels, alphas) = (level.column(u), level.alpha_column(u));
    let texel = |row: u32| billboard.texel(row).min(texels.len() - 1);
    let alpha = |texel: usize| alpha_shown(alphas.map_or(u8::MAX, |alphas| alphas[texel]));
    for (row, pixel) in rows.clone().zip(target.column_mut(x, rows.clone())) {
        let texel = texel(row);
        *pixel = match alpha(texel) {
            0 => *pixel,
            u8::MAX => lighting.apply(texels[texel]),
            alpha => lighting.apply(texels[texel]).over(*pixel, alpha),
        };
    }
    let shown = rows.clone().map(|row| alpha(texel(row)) > u8::MAX / 2);
    target.mark(x, rows.start, Surface::Thing, shown);
}
