//! The last pass: what is seen through, over what is seen behind it.
//!
//! The rays collect what they pass in one list for the whole frame, column by column from the left
//! and in each from near to far. Read backwards, that is from far to near, the order in which it is
//! painted. A list for each column was refused: it would be as many allocations.
//!
//! Colours are mixed as they are in the frame, as sRGB. Mixing light instead was refused: it needs a
//! table each way for every pixel, and a tint looks no more like glass for it.

use std::ops::Range;

use super::marks::Marks;
use super::shade::{Faded, Shade};
use super::tally::{Pass, Tally};
use super::walls::{level_of, light_of};
use super::{Frame, Scene, Surface};
use crate::cast::{Hit, Side};
use crate::world::{Glass, TextureId, TileKind};

/// What all rays of a frame passed.
#[derive(Clone, Debug, Default)]
pub(super) struct Passed {
    list: Vec<(usize, Hit)>,
    /// For each column, which part of the list is still to be drawn; empty until that is asked for.
    left: Vec<Range<usize>>,
}

impl Passed {
    /// Forgets everything but how much memory it took.
    pub(super) fn clear(&mut self) {
        self.list.clear();
        self.left.clear();
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

    /// Finds out what belongs to each of `columns` columns.
    pub(super) fn sort_out(&mut self, columns: usize) {
        self.left.clear();
        self.left.reserve(columns);
        if self.list.is_empty() {
            return;
        }
        self.left.resize(columns, 0..0);
        for (index, &(column, _)) in self.list.iter().enumerate() {
            let left = &mut self.left[column];
            *left = if Range::is_empty(left) { index..index + 1 } else { left.start..index + 1 };
        }
    }

    /// The furthest that is left in `column`, if it is `depth` away or more; it is left no longer.
    fn take_behind(&mut self, column: usize, depth: f64) -> Option<Hit> {
        let left = self.left.get_mut(column).filter(|left| !Range::is_empty(left))?;
        let (_, hit) = self.list[left.end - 1];
        (hit.t >= depth).then(|| {
            left.end -= 1;
            hit
        })
    }
}

/// Draws what the rays passed over what is in `frame`.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    passed: &Passed,
    marks: &mut Marks,
    frame: &mut Frame,
    tally: &mut T,
) {
    for &(column, ref hit) in passed.list.iter().rev() {
        draw_hit(scene, column, hit, marks, frame, tally);
    }
}

/// Draws what the ray of `column` passed at `depth` or further away, where that is left to be drawn.
pub(super) fn draw_behind<T: Tally>(
    depth: f64,
    column: usize,
    scene: Scene<'_>,
    passed: &mut Passed,
    marks: &mut Marks,
    frame: &mut Frame,
    tally: &mut T,
) {
    while let Some(hit) = passed.take_behind(column, depth) {
        draw_hit(scene, column, &hit, marks, frame, tally);
    }
}

/// Draws what is left to be drawn.
pub(super) fn draw_rest<T: Tally>(
    scene: Scene<'_>,
    passed: &mut Passed,
    marks: &mut Marks,
    frame: &mut Frame,
    tally: &mut T,
) {
    for column in 0..passed.left.len() {
        draw_behind(0.0, column, scene, passed, marks, frame, tally);
    }
}

/// Draws one thing that the ray of `column` passed.
fn draw_hit<T: Tally>(
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
    marks: &mut Marks,
    frame: &mut Frame,
    tally: &mut T,
) {
    let world = scene.world;
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row));
    let light = light_of(scene, column as u32, hit);
    let shade = Faded::of_wall(hit.side, light, world.fog(), hit.t);
    let rows = scene.projection.wall_rows(hit.t).len();
    tally.pixels(Pass::SeeThrough, rows);
    match tile.map(|tile| world.tile(tile).kind) {
        Some(TileKind::Mask(texture)) => {
            tally.texels(Pass::SeeThrough, rows);
            draw_mask(texture, shade, scene, column, hit, marks, frame);
        }
        Some(TileKind::Glass(glass)) => draw_glass(glass, shade, scene, column, hit, frame),
        _ => {}
    }
}

fn draw_mask(
    texture: TextureId,
    shade: Faded,
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
    marks: &mut Marks,
    frame: &mut Frame,
) {
    let level = level_of(scene, column as u32, hit, texture);
    let texels = level.column(hit.u);
    let Some(alphas) = level.alpha_column(hit.u) else { return };
    let texels_down = scene.projection.texels_down_the_wall(hit.t, texels.len());
    let rows = scene.projection.wall_rows(hit.t);
    for (row, pixel) in rows.clone().zip(frame.column_mut(column as u32, rows.clone())) {
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
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
    frame: &mut Frame,
) {
    let tint = shade.apply(glass.color);
    let rows = scene.projection.wall_rows(hit.t);
    for pixel in frame.column_mut(column as u32, rows) {
        *pixel = tint.over(*pixel, glass.opacity);
    }
}
