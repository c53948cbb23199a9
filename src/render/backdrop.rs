//! The second pass: what is above and below the walls.
//!
//! Each half of the picture has one colour, so each is one fill of consecutive memory, walls or no
//! walls: at 160×90 pixels both together take less time than asking every column where its wall
//! begins. Only columns that look past the edge of the map are visited one by one.

use super::columns::first_row_of_ground;
use super::{Column, Frame};
use crate::world::{Rgb, World};

/// Fills `frame` with floor, ceiling and the sky beyond the edge of the map.
pub(super) fn draw(world: &World, columns: &[Column], frame: &mut Frame) {
    let height = frame.height();
    let ground = first_row_of_ground(height);
    frame.row_range_mut(0, ground).fill(world.mean_color(world.ceiling()));
    frame.row_range_mut(ground, height).fill(world.mean_color(world.floor()));

    for (x, column) in columns.iter().enumerate().filter(|(_, column)| column.hit.is_none()) {
        let first = column.rows.start;
        let count = ground.saturating_sub(first);
        for pixel in frame.column_mut(x).skip(first as usize).take(count as usize) {
            *pixel = Rgb::SKY;
        }
    }
}
