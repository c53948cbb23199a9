//! The last pass: what is seen through, over what is seen behind it.
//!
//! The rays collect what they pass in one list for the whole frame, column by column from the left
//! and in each from near to far. Read backwards, that is from far to near, the order in which it is
//! painted. A list for each column was refused: it would be as many allocations.
//!
//! Colours are mixed as they are in the frame, as sRGB. Mixing light instead was refused: it needs a
//! table each way for every pixel, and a tint looks no more like glass for it.

use super::shade::{Faded, Shade};
use super::tally::{Pass, Tally};
use super::walls::light_of;
use super::{Frame, Scene};
use crate::cast::Hit;
use crate::world::{Glass, Texture, TileKind};

/// What all rays of a frame passed.
#[derive(Clone, Debug, Default)]
pub(super) struct Passed {
    list: Vec<(usize, Hit)>,
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

/// Draws what the rays passed over what is in `frame`.
pub(super) fn draw<T: Tally>(scene: Scene<'_>, passed: &Passed, frame: &mut Frame, tally: &mut T) {
    for &(column, ref hit) in passed.list.iter().rev() {
        draw_hit(scene, column, hit, frame, tally);
    }
}

/// Draws one thing that the ray of `column` passed.
fn draw_hit<T: Tally>(
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
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
            draw_mask(world.texture(texture), shade, scene, column, hit, frame);
        }
        Some(TileKind::Glass(glass)) => draw_glass(glass, shade, scene, column, hit, frame),
        _ => {}
    }
}

/// Draws a mask from the texture itself: the levels of a texture know no holes.
fn draw_mask(
    texture: &Texture,
    shade: Faded,
    scene: Scene<'_>,
    column: usize,
    hit: &Hit,
    frame: &mut Frame,
) {
    let texels = texture.column(hit.u);
    let Some(alphas) = texture.alpha_column(hit.u) else { return };
    let texels_down = scene.projection.texels_down_the_wall(hit.t, texels.len());
    let rows = scene.projection.wall_rows(hit.t);
    for (row, pixel) in rows.clone().zip(frame.column_mut(column as u32, rows)) {
        let texel = texels_down.at(row);
        *pixel = shade.apply(texels[texel]).over(*pixel, alphas[texel]);
    }
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
