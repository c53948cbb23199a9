//! The last pass: what is seen through, over what is seen behind it.
//!
//! The rays collect what they pass in one list for the whole frame, column by column from the left
//! and in each from near to far. Read backwards, that is from far to near, the order in which it is
//! painted. A list for each column was refused: it would be as many allocations.
//!
//! Colours are mixed as they are in the frame, as sRGB. Mixing light instead was refused: it needs a
//! table each way for every pixel, and a tint looks no more like glass for it.

use super::walls::shaded;
use super::{Frame, Projection};
use crate::cast::Hit;
use crate::world::{Glass, Texture, TileKind, World};

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

    /// Adds what the ray of `column` passed: columns from the left, hits from near to far.
    pub(super) fn push(&mut self, column: usize, hit: Hit) {
        self.list.push((column, hit));
    }
}

/// Draws what the rays passed over what is in `frame`.
pub(super) fn draw(world: &World, projection: &Projection, passed: &Passed, frame: &mut Frame) {
    for &(column, ref hit) in passed.list.iter().rev() {
        draw_hit(world, projection, column, hit, frame);
    }
}

/// Draws one thing that the ray of `column` passed.
fn draw_hit(world: &World, projection: &Projection, column: usize, hit: &Hit, frame: &mut Frame) {
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row));
    match tile.map(|tile| world.tile(tile).kind) {
        Some(TileKind::Mask(texture)) => {
            draw_mask(world.texture(texture), projection, column, hit, frame);
        }
        Some(TileKind::Glass(glass)) => draw_glass(glass, projection, column, hit, frame),
        _ => {}
    }
}

const CLEAR: u8 = 0;
const OPAQUE: u8 = u8::MAX;

fn draw_mask(
    texture: &Texture,
    projection: &Projection,
    column: usize,
    hit: &Hit,
    frame: &mut Frame,
) {
    let texels = texture.column(hit.u);
    let Some(alphas) = texture.alpha_column(hit.u) else { return };
    let texel = projection.texel_on_the_wall(hit.t, texels.len());
    let rows = projection.wall_rows(hit.t);
    let pixels = frame.column_mut(column).skip(rows.start as usize);
    for (row, pixel) in rows.zip(pixels) {
        let texel = texel(row);
        match alphas[texel] {
            CLEAR => {}
            OPAQUE => *pixel = shaded(texels[texel], hit.side),
            alpha => *pixel = shaded(texels[texel], hit.side).over(*pixel, alpha),
        }
    }
}

fn draw_glass(glass: Glass, projection: &Projection, column: usize, hit: &Hit, frame: &mut Frame) {
    let tint = shaded(glass.color, hit.side);
    let rows = projection.wall_rows(hit.t);
    let pixels = frame.column_mut(column).skip(rows.start as usize).take(rows.len());
    for pixel in pixels {
        *pixel = tint.over(*pixel, glass.opacity);
    }
}
