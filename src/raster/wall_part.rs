//! Wall parts: walls that cover pixels in part, blended over what is behind them.
//!
//! A pixel has the mean of its surfaces in linear light, weighted by the share that each covers. Floor, ceiling
//! and sky are drawn before; the walls of a column are added all at once, so that nothing is rounded between
//! them. The rows that the only wall of a column covers as a whole are drawn as any wall column.

use std::iter;
use std::ops::Range;

use super::column_batch::{BatchMemory, ColumnBatch};
use super::direct_columns;
use super::sampling::Sampling;
use super::target::Target;
use super::wall_column::{WallLevel, lighting_of, side_of};
use crate::color::Rgb;
use crate::color::srgb::{from_linear_16, linear_16};
use crate::visibility::{
    DrawList, Lighting, Pass, Scene, SideLit, TextureStepper, WallColumn, WallPart,
};
use crate::world::Paint;
use crate::world::texture::MipLevel;

/// Draws all parts of walls of `list`.
pub(crate) fn draw<M: Sampling>(
    scene: Scene<'_>,
    list: &DrawList,
    memory: &mut BatchMemory,
    target: &mut Target<'_>,
) {
    let are_direct = direct_columns::are_for(scene, target.band_mut());
    if scene.plan.walls.faded || scene.world.has_shapes() {
        let lighting = |wall: &WallColumn| lighting_of(scene, wall.facing, wall.light, wall.t);
        draw_lit::<M, _>(
            scene,
            (list, true),
            ColumnBatch::new(memory, target, are_direct),
            lighting,
        );
    } else {
        let lighting = |wall: &WallColumn| SideLit(side_of(wall));
        draw_lit::<M, _>(
            scene,
            (list, false),
            ColumnBatch::new(memory, target, are_direct),
            lighting,
        );
    }
}

fn draw_lit<'a, M: Sampling, L: Lighting>(
    scene: Scene<'a>,
    (list, is_lit): (&DrawList, bool),
    mut batch: ColumnBatch<'_, '_, 'a, L>,
    lighting: impl Fn(&WallColumn) -> L,
) {
    let mut latest: Option<WallLevel<'_, M>> = None;
    // The wall of a column's ray has at most one wall on each side.
    let mut before = [None, None];
    list.for_each_wall_part(scene, is_lit, |part, wall| {
        let texels = match wall.material {
            Paint::Color(color) => Texels::Color(color),
            Paint::Texture(id) => {
                let WallLevel { level, texels, .. } =
                    WallLevel::on_face(scene, id, (wall.t, wall.slope), &mut latest);
                let stepper = scene.projection.texels_down_the_wall(wall.t, texels);
                Texels::Level { level, u: wall.u, column: level.column(wall.u), stepper }
            }
        };
        let part = LitPart { part, paint: wall.material, texels, lighting: lighting(wall) };
        if part.part.is_alone {
            draw_alone(&part, &mut batch);
            return;
        }
        if !part.part.is_last {
            before = [before[1].take(), Some(part)];
            return;
        }
        match [before[0].take(), before[1].take()] {
            [Some(one), Some(other)] => draw_divided(&[one, other, part], &mut batch),
            [_, Some(one)] => draw_divided(&[one, part], &mut batch),
            [_, None] => draw_divided(&[part], &mut batch),
        }
    });
    batch.draw();
}

/// A part with its colours.
struct LitPart<'l, 'a, L> {
    part: &'l WallPart,
    paint: Paint,
    texels: Texels<'a>,
    lighting: L,
}

/// The colours of a column of a wall, from top to bottom.
#[derive(Clone, Copy)]
enum Texels<'a> {
    Color(Rgb),
    Level { level: &'a MipLevel, u: f64, column: &'a [Rgb], stepper: TextureStepper },
}

impl<L: Lighting> LitPart<'_, '_, L> {
    /// The colour in `row`.
    #[inline]
    fn color(&self, row: u32) -> Rgb {
        let texel = match self.texels {
            Texels::Color(color) => color,
            Texels::Level { column, stepper, .. } => column[stepper.at(row)],
        };
        self.lighting.apply(texel)
    }
}

/// Draws the only wall of a column.
#[inline]
fn draw_alone<'a, L: Lighting>(lit: &LitPart<'_, 'a, L>, batch: &mut ColumnBatch<'_, '_, 'a, L>) {
    let &WallPart { column: x, ref rows, ref covered, .. } = lit.part;
    let rows = batch.target_mut().clip(rows);
    if rows.is_empty() {
        return;
    }
    batch.count(Pass::Walls, rows.len(), lit.paint);
    let inside = covered.start.max(rows.start)..covered.end.min(rows.end);
    let band = batch.target_mut().band_mut();
    for row in (rows.start..inside.start.min(rows.end)).chain(inside.end.max(rows.start)..rows.end)
    {
        let share = in_parts_of_whole(lit.part.coverage(row)).min(WHOLE);
        let pixel = band.pixel_mut(x, row);
        let mut sums = [0; 3];
        add(&mut sums, share, lit.color(row));
        add(&mut sums, WHOLE - share, *pixel);
        *pixel = rounded(sums);
    }
    if !inside.is_empty() {
        match lit.texels {
            Texels::Color(color) => batch.queue_color(x, inside, color, lit.lighting),
            Texels::Level { level, u, stepper, .. } => {
                batch.draw_wall((x, inside), (level, u), stepper, lit.lighting);
            }
        }
    }
}

/// Draws the walls of one column, from left to right.
fn draw_divided<'a, const N: usize, L: Lighting>(
    parts: &[LitPart<'_, 'a, L>; N],
    batch: &mut ColumnBatch<'_, '_, 'a, L>,
) {
    let &WallPart { column: x, ref covered, .. } = parts[0].part;
    let rows = parts.iter().map(|lit| lit.part.rows.clone()).reduce(both).unwrap_or_default();
    let rows = batch.target_mut().clip(&rows);
    batch.count(Pass::Walls, rows.len(), parts[0].paint);
    let mut of_covered = parts.each_ref().map(|lit| in_parts_of_whole(lit.part.share));
    // Rounding may leave a little to be covered.
    of_covered[N - 1] = WHOLE - of_covered[..N - 1].iter().sum::<u32>().min(WHOLE);
    let band = batch.target_mut().band_mut();
    for row in rows {
        let shares = if covered.contains(&row) {
            of_covered
        } else {
            parts.each_ref().map(|lit| in_parts_of_whole(lit.part.coverage(row)))
        };
        let pixel = band.pixel_mut(x, row);
        let (mut left, mut sums) = (WHOLE, [0; 3]);
        for (lit, share) in iter::zip(parts, shares) {
            let share = share.min(left);
            add(&mut sums, share, lit.color(row));
            left -= share;
        }
        add(&mut sums, left, *pixel);
        *pixel = rounded(sums);
    }
}

/// The rows from the first of both to the last of both.
fn both(one: Range<u32>, other: Range<u32>) -> Range<u32> {
    one.start.min(other.start)..one.end.max(other.end)
}

/// The whole of a pixel.
const WHOLE: u32 = 1 << 16;

/// A share from 0 to 1, in parts of [`WHOLE`].
#[inline]
fn in_parts_of_whole(share: f64) -> u32 {
    (share * f64::from(WHOLE) + 0.5) as u32
}

/// Adds the light of `share` of a pixel in `color` to `sums`.
#[inline]
fn add(sums: &mut [u32; 3], share: u32, color: Rgb) {
    for (sum, light) in iter::zip(sums, linear_16(color)) {
        *sum += share * u32::from(light);
    }
}

/// The colour of the light in `sums`.
#[inline]
fn rounded(sums: [u32; 3]) -> Rgb {
    from_linear_16(sums.map(|sum| ((sum + WHOLE / 2) / WHOLE) as u16))
}
