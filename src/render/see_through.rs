//! The last pass: what is seen through, over what is seen behind it.
//!
//! The rays collect what they pass in one list for the whole frame, column by column from the left
//! and in each from near to far. Read backwards, that is from far to near, the order in which it is
//! painted. A list for each column was refused: it would be as many allocations.
//!
//! Colours are mixed as they are in the frame, as sRGB. Mixing light instead was refused: it needs a
//! table each way for every pixel, and a tint looks no more like glass for it.

use std::ops::Range;

use super::band::Band;
use super::marks::MarksOfBand;
use super::shade::{Faded, Shade};
use super::tally::{Pass, Tally};
use super::walls::{level_of, light_of};
use super::{Scene, Surface};
use crate::cast::{Hit, Side};
use crate::world::{Glass, TextureId, TileKind};

/// What all rays of a frame passed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Passed {
    list: Vec<(usize, Hit)>,
}

/// For each column, which part of what its ray passed is still to be drawn; empty where no ray passed
/// anything. Kept so that it is allocated once.
#[derive(Clone, Debug, Default)]
pub(super) struct Left {
    of_columns: Vec<Range<usize>>,
}

impl Passed {
    /// Forgets everything but how much memory it took.
    pub(super) fn clear(&mut self) {
        self.list.clear();
    }

    /// Makes room for what so many rays pass in all but the strangest of maps, so that a camera that
    /// turns towards more of it needs no more memory.
    pub(super) fn make_room_for(&mut self, rays: usize) {
        const OF_A_RAY: usize = 8;
        self.list.reserve(rays * OF_A_RAY);
    }

    /// Adds what the ray of `column` passed: columns from the left, hits from near to far.
    pub(super) fn push(&mut self, column: usize, hit: Hit) {
        self.list.push((column, hit));
    }
}

impl Left {
    /// Finds out what belongs to each of `columns` columns: all of it is left.
    pub(super) fn begin(&mut self, passed: &Passed, columns: usize) {
        let Self { of_columns } = self;
        of_columns.clear();
        of_columns.reserve(columns);
        if passed.list.is_empty() {
            return;
        }
        of_columns.resize(columns, 0..0);
        for (index, &(column, _)) in passed.list.iter().enumerate() {
            let left = &mut of_columns[column];
            *left = if Range::is_empty(left) { index..index + 1 } else { left.start..index + 1 };
        }
    }

    /// The furthest that is left in `column`, if it is `depth` away or more; it is left no longer.
    fn take_behind(&mut self, passed: &Passed, column: usize, depth: f64) -> Option<Hit> {
        let left = self.of_columns.get_mut(column).filter(|left| !Range::is_empty(left))?;
        let (_, hit) = passed.list[left.end - 1];
        (hit.t >= depth).then(|| {
            left.end -= 1;
            hit
        })
    }
}

/// Draws what the rays passed over what is in `band`.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    passed: &Passed,
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    for &(column, ref hit) in passed.list.iter().rev() {
        draw_hit(scene, column, hit, marks, band, tally);
    }
}

/// Draws what the ray of `column` passed at `depth` or further away, where that is left to be drawn.
pub(super) fn draw_behind<T: Tally>(
    depth: f64,
    column: usize,
    scene: Scene<'_>,
    (passed, left): (&Passed, &mut Left),
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    while let Some(hit) = left.take_behind(passed, column, depth) {
        draw_hit(scene, column, &hit, marks, band, tally);
    }
}

/// Draws what is left to be drawn.
pub(super) fn draw_rest<T: Tally>(
    scene: Scene<'_>,
    (passed, left): (&Passed, &mut Left),
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    for column in 0..left.of_columns.len() {
        draw_behind(0.0, column, scene, (passed, left), marks, band, tally);
    }
}

/// Draws one thing that the ray of `column` passed.
fn draw_hit<T: Tally>(
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    let rows = band.clip(&scene.projection.wall_rows(hit.t));
    if rows.is_empty() {
        return;
    }
    let world = scene.world;
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row));
    let light = light_of(scene, column as u32, hit);
    let shade = Faded::of_wall(hit.side, light, world.fog(), hit.t);
    tally.pixels(Pass::SeeThrough, rows.len());
    match tile.map(|tile| world.tile(tile).kind) {
        Some(TileKind::Mask(texture)) => {
            tally.texels(Pass::SeeThrough, rows.len());
            draw_mask(texture, shade, scene, (column, rows), hit, marks, band);
        }
        Some(TileKind::Glass(glass)) => draw_glass(glass, shade, (column, rows), band),
        _ => {}
    }
}

fn draw_mask(
    texture: TextureId,
    shade: Faded,
    scene: Scene<'_>,
    (column, rows): (usize, Range<u32>),
    hit: &Hit,
    marks: &mut MarksOfBand<'_>,
    band: &mut Band<'_>,
) {
    let level = level_of(scene, column as u32, hit, texture);
    let texels = level.column(hit.u);
    let Some(alphas) = level.alpha_column(hit.u) else { return };
    let texels_down = scene.projection.texels_down_the_wall(hit.t, texels.len());
    for (row, pixel) in rows.clone().zip(band.column_mut(column as u32, rows.clone())) {
        let texel = texels_down.at(row);
        *pixel = shade.apply(texels[texel]).over(*pixel, alphas[texel]);
    }
    let surface = match hit.side {
        Side::X => Surface::WallX,
        Side::Y => Surface::WallY,
    };
    let is_shown = |row| alphas[texels_down.at(row)] > u8::MAX / 2;
    marks.note(column, rows.start, surface, rows.map(is_shown));
}

fn draw_glass(
    glass: Glass,
    shade: Faded,
    (column, rows): (usize, Range<u32>),
    band: &mut Band<'_>,
) {
    let tint = shade.apply(glass.color);
    for pixel in band.column_mut(column as u32, rows) {
        *pixel = tint.over(*pixel, glass.opacity);
    }
}
