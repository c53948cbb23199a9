//! The last pass: the walls that the rays hit.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so that no error adds up down the picture; and where a
//! wall is so near that only a few texels of it fill the screen, they are the right ones.

use std::ops::Range;

use glam::DVec2;

use super::band::Band;
use super::coat::{self, COLUMNS_AT_ONCE, Coat, Cover, Paper, Papers};
use super::doors::jamb;
use super::plan::WallLoop;
use super::shade::{Faded, OfSide, Shade};
use super::tally::{Pass, Tally};
use super::{Column, Scene};
use crate::cast::{Hit, Side};
use crate::world::texture::Level;
use crate::world::{Cell, Light, Outline, Paint, Rgb, Shape, TextureId, Tile, TileId, TileKind};

/// Draws the wall of every column that has one. `papers` is memory to work with.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    plan: WallLoop,
    papers: &mut Papers,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    let is_faded = plan.faded || scene.world.has_shapes();
    let width = scene.columns.len() as u32;
    for first in (0..width).step_by(COLUMNS_AT_ONCE) {
        let columns = first..width.min(first + COLUMNS_AT_ONCE as u32);
        let strips = strips(scene, columns, band);
        if is_faded {
            let coats = coats(strips, plan, papers, tally, Strip::shade);
            coat::draw(&coats, papers, band);
        } else {
            let coats = coats(strips, plan, papers, tally, |strip| OfSide(strip.hit.side));
            coat::draw(&coats, papers, band);
        }
    }
}

/// Those of `columns` that show a wall in `band`.
fn strips<'a>(
    scene: Scene<'a>,
    columns: Range<u32>,
    band: &Band<'_>,
) -> impl Iterator<Item = Strip<'a>> {
    columns.filter_map(move |x| {
        let Column { hit, rows, .. } = &scene.columns[x as usize];
        let rows = band.clip(rows);
        (!rows.is_empty()).then(|| Some(Strip::new(scene, x, rows, hit.as_ref()?)))?
    })
}

/// How at most [`COLUMNS_AT_ONCE`] of them are covered.
#[inline]
fn coats<'a, S: Shade, T: Tally>(
    strips: impl Iterator<Item = Strip<'a>>,
    plan: WallLoop,
    papers: &mut Papers,
    tally: &mut T,
    shade: impl Fn(&Strip<'a>) -> S,
) -> [Option<Coat<'a, S>>; COLUMNS_AT_ONCE] {
    let mut coats = [const { None }; COLUMNS_AT_ONCE];
    for (coat, (strip, paper)) in coats.iter_mut().zip(strips.zip(papers.iter_mut())) {
        *coat = Some(strip.coat(plan, shade(&strip), paper, tally));
    }
    coats
}

/// A wall as wide as a pixel.
struct Strip<'a> {
    scene: Scene<'a>,
    x: u32,
    rows: Range<u32>,
    hit: &'a Hit,
    /// What stands in the cell that was hit.
    tile: Option<&'a Tile>,
}

impl<'a> Strip<'a> {
    #[inline]
    fn new(scene: Scene<'a>, x: u32, rows: Range<u32>, hit: &'a Hit) -> Self {
        let Cell { column, row } = hit.cell;
        let id = scene.world.grid().tile(i64::from(column), i64::from(row));
        let tile = id.map(|TileId(index)| &scene.world.tiles()[usize::from(index)]);
        Self { scene, x, rows, hit, tile }
    }

    /// The level of a texture that suits the distance.
    fn level(&self, id: TextureId) -> &'a Level {
        let Scene { world, projection, filter, .. } = self.scene;
        let texture = world.texture(id);
        let texels = f64::from(texture.width()) * f64::from(texture.height());
        let area = projection.pixel_area_on_wall(self.hit.t, self.across(self.direction()));
        texture.level(filter.halvings(area * texels))
    }

    /// How it is covered in that shade, by means of `paper`.
    #[inline]
    fn coat<S: Shade, T: Tally>(
        &self,
        plan: WallLoop,
        shade: S,
        paper: &mut Paper,
        tally: &mut T,
    ) -> Coat<'a, S> {
        tally.pixels(Pass::Walls, self.rows.len());
        let cover = match self.paint(plan) {
            Paint::Color(color) => Cover::of_color(color, shade, paper),
            Paint::Texture(texture) => {
                tally.texels(Pass::Walls, self.rows.len());
                let texels = self.texels(texture);
                let down = self.scene.projection.texels_down_the_wall(self.hit.t, texels.len());
                Cover::of_texels(texels, down, shade, paper, self.rows.len())
            }
        };
        Coat { x: self.x, rows: self.rows.clone(), cover }
    }

    /// How it looks: as a jamb, where it faces a door.
    fn paint(&self, plan: WallLoop) -> Paint {
        let Scene { world, projection, .. } = self.scene;
        let jamb = if plan.jambs { jamb(world, projection, self.hit) } else { None };
        jamb.unwrap_or_else(|| self.paint_of_tile())
    }

    /// How the tile itself looks.
    fn paint_of_tile(&self) -> Paint {
        match self.tile.map(|tile| tile.kind) {
            Some(TileKind::Wall(paint)) => paint,
            Some(TileKind::Door(door)) => door.leaf,
            Some(TileKind::Shape(shape)) => shape.paint,
            // Casters that know no masks and no glass hit these.
            Some(TileKind::Mask(texture)) => Paint::Texture(texture),
            Some(TileKind::Glass(glass) | TileKind::Mirror(glass)) => Paint::Color(glass.color),
            // No caster hits what is not solid; were one to, the floor is what is there.
            Some(TileKind::Open | TileKind::Doorway(_)) | None => {
                self.scene.world.floor().pattern.first_paint()
            }
        }
    }

    /// The column of the texture that shows.
    fn texels(&self, id: TextureId) -> &'a [Rgb] {
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
        let seen_from = match self.tile.map(|tile| tile.kind) {
            // It stands in a cell of its own.
            Some(TileKind::Shape(_)) => Some(self.hit.cell),
            _ => self.cell_before(),
        };
        let own = self.tile.and_then(|tile| tile.light);
        own.unwrap_or_else(|| seen_from.map_or(Light::FULL, |cell| world.light_in(cell)))
    }

    /// The shape that the ray hit, if it is one.
    fn shape(&self) -> Option<Shape> {
        match self.tile?.kind {
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
    Strip::new(scene, x, 0..0, hit).light()
}

/// The level of the texture `id` that suits what the ray of column `x` hit.
pub(super) fn level_of<'a>(scene: Scene<'a>, x: u32, hit: &'a Hit, id: TextureId) -> &'a Level {
    Strip::new(scene, x, 0..0, hit).level(id)
}
