//! Faces: walls, masks and tints, column by column of their textures.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so no error accumulates from row to row. Even if a
//! wall is so near that only a few of its texels are in view, they are the right ones.
//!
//! The mip level changes in one direction along a wall. If both ends have the same level, all
//! columns have it.

use std::ops::Range;

use glam::DVec2;

use super::Band;
use super::target::Target;
use super::texture_columns::{self, TextureColumns};
use crate::cast::Side;
use crate::color::Rgb;
use crate::visibility::{
    DrawList, Face, FaceColumn, FaceTexels, Facing, FrameContext, Lighting, Material, Pass, Surface,
};
use crate::world::texture::MipLevel;
use crate::world::{Glass, Paint, Texture, TextureId};

/// Draws the faces of `list` that hide what is behind them.
pub(crate) fn draw(scene: FrameContext<'_>, list: &DrawList, target: &mut Target<'_>) {
    let opaque = || {
        list.faces.iter().filter_map(|face| match face.material {
            Material::Opaque(paint) => Some((ShownFace::new(scene, list, face), paint)),
            Material::Masked(_) | Material::Translucent(_) => None,
        })
    };
    if target.counts() || target.keeps_surfaces() {
        opaque().for_each(|(face, paint)| face.record(paint, target));
    }
    let band = target.band_mut();
    let Range { start, end } = band.rows();
    let at_once = texture_columns::rows_at_once(band.width()) as u32;
    for first in (start..end).step_by(at_once as usize) {
        let rows = first..end.min(first + at_once);
        for (face, paint) in opaque() {
            if face.columns.iter().any(|column| !column.rows.within(&rows).is_empty()) {
                face.draw(paint, &rows, band);
            }
        }
    }
}

/// A face, with the state that its columns share.
struct ShownFace<'a> {
    scene: FrameContext<'a>,
    list: &'a DrawList,
    face: &'a Face,
    columns: &'a [FaceColumn],
}

impl<'a> ShownFace<'a> {
    fn new(scene: FrameContext<'a>, list: &'a DrawList, face: &'a Face) -> Self {
        let columns = &list.face_columns[face.first..][..face.columns.len()];
        Self { scene, list, face, columns }
    }

    /// The side that the face shows, if the face is on a line of the grid.
    fn side(&self) -> Option<Side> {
        match self.face.facing {
            Facing::Side(side) => Some(side),
            Facing::Normal(_) | Facing::Around(_) => None,
        }
    }

    /// The direction of a column's ray on the map.
    #[inline]
    fn direction(&self, index: usize) -> DVec2 {
        let direction = self.list.directions.of(self.face.columns.start + index);
        self.face.image.direction_to_map(direction)
    }

    /// The normal at a column.
    fn normal(&self, index: usize) -> DVec2 {
        let origin = self.face.image.to_map(self.scene.projection.origin());
        self.face.facing.normal(origin + self.direction(index) * self.columns[index].t)
    }

    /// The speed at which a column's ray approaches the face, in cells per unit of `t`.
    #[inline]
    fn slope(&self, index: usize) -> f64 {
        match self.face.facing {
            Facing::Side(side) => self.direction(index)[side as usize],
            _ => self.normal(index).dot(self.direction(index)),
        }
    }

    /// The level of detail of `texture` in a column.
    #[inline]
    fn lod(&self, texture: &Texture, index: usize) -> usize {
        let t = self.columns[index].t;
        let area = self.scene.projection.pixel_area_on_wall(t, self.slope(index));
        self.scene.plan.filter.lod(area * texture.area())
    }

    /// The lighting of a column.
    #[inline]
    fn lighting(&self, index: usize) -> Lighting {
        let FaceColumn { t, u, .. } = self.columns[index];
        let (light, fog) = (self.face.light.at(u), self.scene.world.fog());
        match self.face.facing {
            Facing::Side(side) => Lighting::of_wall(side, light, fog, t),
            _ => Lighting::of_surface(self.normal(index), light, fog, t),
        }
    }

    /// Passes the columns of `range`, which must not be empty, to `draw`. Neighbouring columns in the same
    /// lighting are passed together.
    #[inline]
    fn for_each_lighting(&self, range: Range<usize>, mut draw: impl FnMut(Range<usize>, Lighting)) {
        let Range { start: mut first, end } = range;
        let mut lighting = self.lighting(first);
        let is_even = self.face.light.is_even() && self.scene.world.fog().is_none();
        if !is_even || self.side().is_none() {
            for index in first + 1..end {
                let next = self.lighting(index);
                if next != lighting {
                    draw(first..index, lighting);
                    (first, lighting) = (index, next);
                }
            }
        }
        draw(first..end, lighting);
    }

    /// The surface that a column shows.
    fn surface(&self, index: usize) -> Surface {
        let side = self.side().unwrap_or_else(|| {
            let normal = self.normal(index).abs();
            if normal.x >= normal.y { Side::X } else { Side::Y }
        });
        Surface::of_wall(side)
    }

    /// Counts the pixels and records the surfaces.
    fn record(&self, paint: Paint, target: &mut Target<'_>) {
        let rows = target.rows();
        for (index, (x, column)) in (self.face.columns.clone()).zip(self.columns).enumerate() {
            let rows = column.rows.within(&rows);
            target.count_painted(Pass::Walls, rows.len(), paint);
            let all = rows.clone().map(|_| true);
            target.mark(x, rows.start, self.surface(index), all);
        }
    }

    /// Draws `rows` of the face in `paint`.
    fn draw(&self, paint: Paint, rows: &Range<u32>, band: &mut Band<'_>) {
        let first = self.face.columns.start;
        match paint {
            Paint::Color(color) => {
                self.for_each_lighting(0..self.columns.len(), |range, lighting| {
                    let color = lighting.apply(color);
                    for (x, column) in (first + range.start..).zip(&self.columns[range]) {
                        band.column_mut(x, column.rows.within(rows))
                            .for_each(|pixel| *pixel = color);
                    }
                });
            }
            Paint::Texture(id) => self.for_each_level(id, |level, range| {
                let texels = (level, self.texels(level));
                let is_horizon_near = self.scene.projection.is_horizon_near();
                self.for_each_lighting(range, |range, lighting| {
                    let columns = (first + range.start, &self.columns[range]);
                    TextureColumns::new(texels, lighting, columns).draw(
                        rows,
                        is_horizon_near,
                        band,
                    );
                });
            }),
        }
    }

    /// Passes each level of the texture `id` that the face shows to `draw`, with its columns.
    #[inline]
    fn for_each_level(&self, id: TextureId, mut draw: impl FnMut(&'a MipLevel, Range<usize>)) {
        let texture = self.scene.world.texture(id);
        let lod = |index: usize| self.lod(texture, index);
        let mut first = 0;
        while first < self.columns.len() {
            let level = lod(first);
            let end = self.end_of_level(first, |index| lod(index) == level);
            draw(texture.level(level), first..end);
            first = end;
        }
    }

    /// The first column after `first` that does not show the same level.
    #[inline]
    fn end_of_level(&self, first: usize, is_same: impl Fn(usize) -> bool) -> usize {
        let count = self.columns.len();
        if self.side().is_none() {
            return (first + 1..count).find(|&index| !is_same(index)).unwrap_or(count);
        }
        // The level changes in one direction, so a binary search finds the end.
        let (mut same, mut other) = (first, count);
        if is_same(count - 1) {
            return count;
        }
        while other - same > 1 {
            let middle = usize::midpoint(same, other);
            *(if is_same(middle) { &mut same } else { &mut other }) = middle;
        }
        other
    }

    /// The texels of the face at `level`.
    fn texels(&self, level: &MipLevel) -> FaceTexels {
        let Face { bottom, top, .. } = *self.face;
        self.scene.projection.face_texels(level.height() as usize, (bottom, top))
    }
}

/// Draws a mask or a tint over the pixels behind it.
pub(crate) fn draw_over(
    scene: FrameContext<'_>,
    list: &DrawList,
    face: &Face,
    target: &mut Target<'_>,
) {
    let shown = ShownFace::new(scene, list, face);
    match face.material {
        Material::Opaque(_) => {}
        Material::Masked(texture) => shown.draw_mask(texture, target),
        Material::Translucent(glass) => shown.draw_tint(glass, target),
    }
}

impl ShownFace<'_> {
    fn draw_mask(&self, id: TextureId, target: &mut Target<'_>) {
        let texture = self.scene.world.texture(id);
        let band = target.rows();
        for (index, (x, column)) in self.face.columns.clone().zip(self.columns).enumerate() {
            let rows = column.rows.within(&band);
            let FaceColumn { t, u, .. } = *column;
            target.count_pixels(Pass::SeeThrough, rows.len());
            target.count_texels(Pass::SeeThrough, rows.len());
            let level = texture.level(self.lod(texture, index));
            let texels = level.column(u);
            let Some(alphas) = level.alpha_column(u) else { return };
            let lighting = self.lighting(index);
            let stepper = self.texels(level).at(t);
            for (row, pixel) in rows.clone().zip(target.column_mut(x, rows.clone())) {
                let texel = stepper.at(row);
                *pixel = match alphas[texel] {
                    0 => *pixel,
                    u8::MAX => lighting.apply(texels[texel]),
                    alpha => lighting.apply(texels[texel]).over(*pixel, alpha),
                };
            }
            let is_shown = |row| alphas[stepper.at(row)] > u8::MAX / 2;
            target.mark(x, rows.start, self.surface(index), rows.map(is_shown));
        }
    }

    fn draw_tint(&self, glass: Glass, target: &mut Target<'_>) {
        self.for_each_lighting(0..self.columns.len(), |range, lighting| {
            self.paint_over(range, lighting.apply(glass.color), glass.opacity, target);
        });
    }

    /// Blends `color` over the pixels of the columns of `range`. Rows that all of the columns share
    /// are blended row by row, the rest column by column.
    fn paint_over(&self, range: Range<usize>, color: Rgb, opacity: u8, target: &mut Target<'_>) {
        let band_rows = target.rows();
        let x = self.face.columns.start + range.start;
        let rows = |column: &FaceColumn| column.rows.within(&band_rows);
        let columns = &self.columns[range];
        let pixels = columns.iter().map(|column| rows(column).len()).sum();
        target.count_pixels(Pass::SeeThrough, pixels);
        let start = columns.iter().map(|column| rows(column).start).max().unwrap_or_default();
        let end = columns.iter().map(|column| rows(column).end).min().unwrap_or_default();
        let end = end.max(start);
        let band = target.band_mut();
        for row in start..end {
            color.paint_over(&mut band.row_mut(row)[x..x + columns.len()], opacity);
        }
        for (x, column) in (x..).zip(columns) {
            let Range { start: top, end: bottom } = rows(column);
            for rest in [top..bottom.min(start), top.max(end)..bottom] {
                for pixel in band.column_mut(x, rest) {
                    *pixel = color.over(*pixel, opacity);
                }
            }
        }
    }
}
