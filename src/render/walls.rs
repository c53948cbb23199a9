//! The last pass: the walls that the rays hit.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so that no error adds up down the picture; and where a
//! wall is so near that only a few texels of it fill the screen, they are the right ones.

use std::ops::Range;

use glam::DVec2;

use super::doors::jamb;
use super::plan::WallLoop;
use super::shade::{Bright, Faded, Halved, Shade};
use super::tally::{Pass, Tally};
use super::{Frame, Scene};
use crate::cast::{Hit, Side};
use crate::world::texture::Level;
use crate::world::{Cell, Light, Outline, Paint, Rgb, Shape, TextureId, Tile, TileKind, World};

/// Draws the wall of every column that has one.
pub(super) fn draw<T: Tally>(scene: Scene<'_>, plan: WallLoop, frame: &mut Frame, tally: &mut T) {
    if plan.faded { draw_faded(scene, frame, tally) } else { draw_unfaded(scene, frame, tally) }
}

fn draw_unfaded<T: Tally>(scene: Scene<'_>, frame: &mut Frame, tally: &mut T) {
    let has_shapes = scene.world.has_shapes();
    for strip in strips(scene) {
        match strip.hit.side {
            _ if has_shapes && strip.shape().is_some() => strip.draw(strip.shade(), frame, tally),
            Side::X => strip.draw(Bright, frame, tally),
            Side::Y => strip.draw(Halved, frame, tally),
        }
    }
}

fn draw_faded<T: Tally>(scene: Scene<'_>, frame: &mut Frame, tally: &mut T) {
    for strip in strips(scene) {
        strip.draw(strip.shade(), frame, tally);
    }
}

/// The columns that show a wall.
fn strips(scene: Scene<'_>) -> impl Iterator<Item = Strip<'_>> {
    (0..).zip(scene.columns).filter_map(move |(x, column)| {
        let hit = column.hit.as_ref()?;
        Some(Strip { scene, x, rows: column.rows.clone(), hit })
    })
}

/// A wall as wide as a pixel.
struct Strip<'a> {
    scene: Scene<'a>,
    x: u32,
    rows: Range<u32>,
    hit: &'a Hit,
}

impl<'a> Strip<'a> {
    /// The level of a texture that suits the distance.
    fn level(&self, id: TextureId) -> &'a Level {
        let Scene { world, projection, filter, .. } = self.scene;
        let texture = world.texture(id);
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let area = projection.pixel_area_on_wall(self.hit.t, self.across(self.direction()));
        texture.level(filter.halvings(area * texels))
    }

    #[inline]
    fn draw<S: Shade, T: Tally>(&self, shade: S, frame: &mut Frame, tally: &mut T) {
        let rows = self.rows.clone();
        tally.pixels(Pass::Walls, rows.len());
        let pixels = frame.column_mut(self.x as usize).skip(rows.start as usize).take(rows.len());
        match self.paint() {
            Paint::Color(color) => {
                let color = shade.apply(color);
                pixels.for_each(|pixel| *pixel = color);
            }
            Paint::Texture(texture) => {
                let texels = self.texels(texture);
                tally.texels(Pass::Walls, rows.len());
                let texel = self.scene.projection.texel_on_the_wall(self.hit.t, texels.len());
                for (row, pixel) in rows.zip(pixels) {
                    *pixel = shade.apply(texels[texel(row)]);
                }
            }
        }
    }

    /// How it looks: as a jamb, where it faces a door.
    fn paint(&self) -> Paint {
        let Scene { world, projection, .. } = self.scene;
        let jamb = if world.is_of_walls() { None } else { jamb(world, projection, self.hit) };
        jamb.unwrap_or_else(|| paint_of(world, self.hit))
    }

    /// The column of the texture that shows.
    fn texels(&self, id: TextureId) -> &[Rgb] {
        self.level(id).column(self.hit.u)
    }

    /// What becomes of its colours.
    fn shade(&self) -> Faded {
        let (light, fog, distance) = (self.light(), self.scene.world.fog(), self.hit.t);
        match self.shape() {
            None => Faded::of_wall(self.hit.side, light, fog, distance),
            Some(shape) => Faded::of_surface(self.normal(shape), light, fog, distance),
        }
    }

    /// How bright the side is.
    fn light(&self) -> Light {
        let world = self.scene.world;
        let tile = tile_of(world, self.hit);
        let seen_from = match tile.map(|tile| tile.kind) {
            // It stands in a cell of its own.
            Some(TileKind::Shape(_)) => Some(self.hit.cell),
            _ => self.cell_before(),
        };
        let own = tile.and_then(|tile| tile.light);
        own.unwrap_or_else(|| seen_from.map_or(Light::FULL, |cell| world.light_in(cell)))
    }

    /// The shape that the ray hit, if it is one.
    fn shape(&self) -> Option<Shape> {
        match tile_of(self.scene.world, self.hit)?.kind {
            TileKind::Shape(shape) => Some(shape),
            _ => None,
        }
    }

    /// Which way a shape faces where the ray hit it, or the opposite way: a vector of length 1.
    fn normal(&self, shape: Shape) -> DVec2 {
        match shape.outline {
            Outline::Line(line) => line.stretch().perp().normalize(),
            Outline::Pillar(_) => {
                let point = self.scene.projection.origin() + self.direction() * self.hit.t;
                (point - self.hit.cell.center()).normalize_or_zero()
            }
        }
    }

    /// The cell that the side is seen from; `None` off the map's north and west.
    fn cell_before(&self) -> Option<Cell> {
        let Cell { column, row } = self.hit.cell;
        let is_ahead = self.across_line(self.direction()) > 0.0;
        let before =
            |index: u32| if is_ahead { index.checked_sub(1) } else { index.checked_add(1) };
        Some(match self.hit.side {
            Side::X => Cell { column: before(column)?, row },
            Side::Y => Cell { column, row: before(row)? },
        })
    }

    fn direction(&self) -> DVec2 {
        self.scene.projection.direction_of(self.x)
    }

    /// The part of a direction that leads straight at the side.
    fn across(&self, direction: DVec2) -> f64 {
        if let Some(shape) = self.shape() {
            return self.normal(shape).dot(direction);
        }
        self.across_line(direction)
    }

    fn across_line(&self, direction: DVec2) -> f64 {
        match self.hit.side {
            Side::X => direction.x,
            Side::Y => direction.y,
        }
    }
}

/// How bright what the ray of column `x` hit is.
pub(super) fn light_of(scene: Scene<'_>, x: u32, hit: &Hit) -> Light {
    Strip { scene, x, rows: 0..0, hit }.light()
}

/// The level of the texture `id` that suits what the ray of column `x` hit.
pub(super) fn level_of<'a>(scene: Scene<'a>, x: u32, hit: &'a Hit, id: TextureId) -> &'a Level {
    Strip { scene, x, rows: 0..0, hit }.level(id)
}

fn paint_of(world: &World, hit: &Hit) -> Paint {
    match tile_of(world, hit).map(|tile| tile.kind) {
        Some(TileKind::Wall(paint)) => paint,
        Some(TileKind::Door(door)) => door.leaf,
        Some(TileKind::Shape(shape)) => shape.paint,
        // Casters that know no masks and no glass hit these.
        Some(TileKind::Mask(texture)) => Paint::Texture(texture),
        Some(TileKind::Glass(glass) | TileKind::Mirror(glass)) => Paint::Color(glass.color),
        // No caster hits what is not solid; were one to, the floor is what is there.
        Some(TileKind::Open | TileKind::Doorway(_)) | None => world.floor().pattern.first_paint(),
    }
}

fn tile_of(world: &World, hit: &Hit) -> Option<Tile> {
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row))?;
    Some(world.tile(tile))
}
