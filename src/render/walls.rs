//! The last pass: the walls that the rays hit.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so that no error adds up down the picture; and where a
//! wall is so near that only a few texels of it fill the screen, they are the right ones.

use glam::DVec2;

use super::plan::WallLoop;
use super::shade::{Bright, Faded, Halved, Shade};
use super::tally::{Pass, Tally};
use super::{Column, Frame, Scene};
use crate::cast::{Hit, Side};
use crate::world::{Light, Paint, Rgb, TextureId, Tile, TileId, TileKind, World};

/// Draws the wall of every column that has one.
pub(super) fn draw<T: Tally>(scene: Scene<'_>, plan: WallLoop, frame: &mut Frame, tally: &mut T) {
    if plan.faded { draw_faded(scene, frame, tally) } else { draw_unfaded(scene, frame, tally) }
}

fn draw_unfaded<T: Tally>(scene: Scene<'_>, frame: &mut Frame, tally: &mut T) {
    for strip in strips(scene) {
        match strip.hit.side {
            Side::X => strip.draw(Bright, frame, tally),
            Side::Y => strip.draw(Halved, frame, tally),
        }
    }
}

fn draw_faded<T: Tally>(scene: Scene<'_>, frame: &mut Frame, tally: &mut T) {
    for strip in strips(scene) {
        let fog = scene.world.fog();
        let shade = Faded::of_wall(strip.hit.side, strip.light(), fog, strip.hit.t);
        strip.draw(shade, frame, tally);
    }
}

/// The columns that show a wall.
fn strips(scene: Scene<'_>) -> impl Iterator<Item = Strip<'_>> {
    (0..).zip(scene.columns).filter_map(move |(x, column)| {
        let hit = column.hit.as_ref()?;
        Some(Strip { scene, x, column, hit })
    })
}

/// A wall as wide as a pixel.
struct Strip<'a> {
    scene: Scene<'a>,
    x: u32,
    column: &'a Column,
    hit: &'a Hit,
}

impl Strip<'_> {
    #[inline]
    fn draw<S: Shade, T: Tally>(&self, shade: S, frame: &mut Frame, tally: &mut T) {
        let rows = self.column.rows.clone();
        tally.pixels(Pass::Walls, rows.len());
        let pixels = frame.column_mut(self.x as usize).skip(rows.start as usize).take(rows.len());
        match paint_of(self.scene.world, self.hit) {
            Paint::Color(color) => {
                let color = shade.apply(color);
                pixels.for_each(|pixel| *pixel = color);
            }
            Paint::Texture(texture) => {
                let texels = self.texels(texture);
                tally.texels(Pass::Walls, rows.len());
                let last = texels.len() - 1;
                let down = self.scene.projection.down_the_wall(self.hit.t);
                for (row, pixel) in rows.zip(pixels) {
                    let texel = (down(row) * texels.len() as f64) as usize;
                    *pixel = shade.apply(texels[texel.min(last)]);
                }
            }
        }
    }

    /// The column of the texture that shows, from a level that suits the distance.
    fn texels(&self, id: TextureId) -> &[Rgb] {
        let Scene { world, projection, filter, .. } = self.scene;
        let texture = world.texture(id);
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let area = projection.pixel_area_on_wall(self.hit.t, self.across(self.direction()));
        texture.level(filter.halvings(area * texels)).column(self.hit.u)
    }

    /// How bright the side is.
    fn light(&self) -> Light {
        let world = self.scene.world;
        let own = tile_of(world, self.hit).and_then(|tile| tile.light);
        own.or_else(|| self.tile_before()?.light).unwrap_or(Light::FULL)
    }

    /// The tile that the side is seen from.
    fn tile_before(&self) -> Option<Tile> {
        let world = self.scene.world;
        let (column, row) = (i64::from(self.hit.cell.column), i64::from(self.hit.cell.row));
        let step = if self.across(self.direction()) > 0.0 { 1 } else { -1 };
        let before: Option<TileId> = match self.hit.side {
            Side::X => world.grid().tile(column - step, row),
            Side::Y => world.grid().tile(column, row - step),
        };
        before.map(|tile| world.tile(tile))
    }

    fn direction(&self) -> DVec2 {
        self.scene.projection.direction_of(self.x)
    }

    /// The part of a direction that leads straight at the side.
    fn across(&self, direction: DVec2) -> f64 {
        match self.hit.side {
            Side::X => direction.x,
            Side::Y => direction.y,
        }
    }
}

fn paint_of(world: &World, hit: &Hit) -> Paint {
    match tile_of(world, hit).map(|tile| tile.kind) {
        Some(TileKind::Wall(paint)) => paint,
        // No caster hits what is not solid; were one to, the floor is what is there.
        Some(TileKind::Open) | None => world.floor().pattern.first_paint(),
    }
}

fn tile_of(world: &World, hit: &Hit) -> Option<Tile> {
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row))?;
    Some(world.tile(tile))
}
