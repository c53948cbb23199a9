//! The third pass: the walls that the rays hit.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so that no error adds up down the picture; and where a
//! wall is so near that only a few texels of it fill the screen, they are the right ones.

use super::doors::jamb;
use super::{Column, Frame, Projection};
use crate::cast::{Hit, Side};
use crate::world::{Paint, Rgb, TileKind, World};

/// Draws the wall of every column that has one.
pub(super) fn draw(world: &World, projection: &Projection, columns: &[Column], frame: &mut Frame) {
    let has_jambs = !world.is_of_walls();
    for (x, column) in columns.iter().enumerate() {
        let Some(hit) = &column.hit else { continue };
        let pixels = frame.column_mut(x).skip(column.rows.start as usize).take(column.rows.len());
        let jamb = if has_jambs { jamb(world, projection, hit) } else { None };
        match jamb.unwrap_or_else(|| paint_of(world, hit)) {
            Paint::Color(color) => {
                let color = shaded(color, hit.side);
                pixels.for_each(|pixel| *pixel = color);
            }
            Paint::Texture(texture) => {
                let texels = world.texture(texture).column(hit.u);
                let texel = projection.texel_on_the_wall(hit.t, texels.len());
                for (row, pixel) in column.rows.clone().zip(pixels) {
                    *pixel = shaded(texels[texel(row)], hit.side);
                }
            }
        }
    }
}

fn paint_of(world: &World, hit: &Hit) -> Paint {
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row));
    match tile.map(|tile| world.tile(tile).kind) {
        Some(TileKind::Wall(paint)) => paint,
        Some(TileKind::Door(door)) => door.leaf,
        // Casters that know no masks and no glass hit these.
        Some(TileKind::Mask(texture)) => Paint::Texture(texture),
        Some(TileKind::Glass(glass)) => Paint::Color(glass.color),
        // No caster hits what is not solid; were one to, the floor is what is there.
        Some(TileKind::Open | TileKind::Doorway(_)) | None => world.floor(),
    }
}

/// A y-side is half as bright as an x-side, so that the edge between the two shows.
pub(super) fn shaded(color: Rgb, side: Side) -> Rgb {
    match side {
        Side::X => color,
        Side::Y => color.halved(),
    }
}
