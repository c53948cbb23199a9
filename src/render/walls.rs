//! The last pass: the walls that the rays hit.
//!
//! A column of a wall is one column of its texture, stretched. The texel of each pixel is computed
//! from its row, not from the texel above it, so that no error adds up down the picture; and where a
//! wall is so near that only a few texels of it fill the screen, they are the right ones.

use glam::DVec2;

use super::Scene;
use super::band::Band;
use super::coat::{Coats, Wardrobe};
use super::doors::jamb;
use super::plan::WallLoop;
use super::shade::{Faded, OfSide, Shade};
use super::tally::{Pass, Tally};
use crate::cast::{Hit, Side};
use crate::world::texture::Level;
use crate::world::{
    Cell, FaceLight, Light, Outline, Paint, Shape, TextureId, Tile, TileId, TileKind, World,
};

/// Draws the wall of every column that has one. `wardrobe` is memory to work with.
pub(super) fn draw<T: Tally>(
    scene: Scene<'_>,
    plan: WallLoop,
    wardrobe: &mut Wardrobe,
    band: &mut Band<'_>,
    tally: &mut T,
) {
    if plan.faded || scene.world.has_shapes() {
        #[expect(clippy::redundant_closure_for_method_calls, reason = "it is for any lifetime")]
        draw_shaded::<_, _, true>(scene, plan, wardrobe, band, tally, |strip| strip.shade());
    } else {
        let shade = |strip: &Strip<'_, '_>| OfSide(strip.hit.side);
        draw_shaded::<_, _, false>(scene, plan, wardrobe, band, tally, shade);
    }
}

/// Draws them in shades that depend on their light, or do not.
#[inline]
fn draw_shaded<'a, S: Shade, T: Tally, const BY_LIGHT: bool>(
    scene: Scene<'a>,
    plan: WallLoop,
    wardrobe: &mut Wardrobe,
    band: &mut Band<'_>,
    tally: &mut T,
    shade: impl Fn(&Strip<'_, 'a>) -> S,
) {
    let mut coats = Coats::new(wardrobe, band);
    let mut latest: Option<(Face<'a>, Paint)> = None;
    for (x, column) in (0..).zip(scene.columns) {
        let rows = coats.clip(&column.rows);
        let Some(hit) = column.hit.as_ref().filter(|_| !rows.is_empty()) else { continue };
        let (face, paint) = match &mut latest {
            Some(latest) if latest.0.is_of(hit) => &*latest,
            latest => {
                let face = Face::new::<BY_LIGHT>(scene, x, hit);
                latest.insert((face, face.paint(scene, plan, hit)))
            }
        };
        let strip = Strip { scene, x, hit, face };
        tally.pixels(Pass::Walls, rows.len());
        match *paint {
            Paint::Color(color) => coats.paint(x, rows, color, shade(&strip)),
            Paint::Texture(texture) => {
                tally.texels(Pass::Walls, rows.len());
                let texels = strip.level(texture).column(hit.u);
                let down = scene.projection.texels_down_the_wall(hit.t, texels.len());
                coats.hang(x, rows, texels, down, shade(&strip));
            }
        }
    }
    coats.draw();
}

/// What is the same for all columns that show one face of a cell.
#[derive(Clone, Copy)]
struct Face<'a> {
    cell: Cell,
    side: Side,
    /// What stands in the cell.
    tile: Option<&'a Tile>,
    /// How bright the face is along it, if its shade depends on that.
    light: FaceLight,
}

impl<'a> Face<'a> {
    /// The one that the ray of column `x` hit.
    fn new<const BY_LIGHT: bool>(scene: Scene<'a>, x: u32, hit: &Hit) -> Self {
        let Cell { column, row } = hit.cell;
        let world = scene.world;
        let id = world.grid().tile(i64::from(column), i64::from(row));
        let tile = id.map(|TileId(index)| &world.tiles()[usize::from(index)]);
        let light = if BY_LIGHT { face_light(scene, x, hit, tile) } else { FaceLight::FULL };
        Self { cell: hit.cell, side: hit.side, tile, light }
    }

    /// Whether `hit` is on it, too.
    #[inline]
    fn is_of(&self, hit: &Hit) -> bool {
        (self.cell, self.side) == (hit.cell, hit.side)
    }

    /// How it looks, where `hit` is on it: as a jamb, where it faces a door.
    fn paint(&self, scene: Scene<'_>, plan: WallLoop, hit: &Hit) -> Paint {
        let Scene { world, projection, .. } = scene;
        let jamb = if plan.jambs { jamb(world, projection, hit) } else { None };
        jamb.unwrap_or_else(|| self.paint_of_tile(world))
    }

    /// How the tile itself looks.
    fn paint_of_tile(&self, world: &World) -> Paint {
        match self.tile.map(|tile| tile.kind) {
            Some(TileKind::Wall(paint)) => paint,
            Some(TileKind::Door(door)) => door.leaf,
            Some(TileKind::Shape(shape)) => shape.paint,
            // Casters that know no masks and no glass hit these.
            Some(TileKind::Mask(texture)) => Paint::Texture(texture),
            Some(TileKind::Glass(glass) | TileKind::Mirror(glass)) => Paint::Color(glass.color),
            // No caster hits what is not solid; were one to, the floor is what is there.
            Some(TileKind::Open | TileKind::Doorway(_)) | None => {
                world.floor().pattern.first_paint()
            }
        }
    }

    /// The shape that stands in the cell, if it is one.
    fn shape(&self) -> Option<Shape> {
        match self.tile?.kind {
            TileKind::Shape(shape) => Some(shape),
            _ => None,
        }
    }
}

/// How bright the face of `tile` is along it that the ray of column `x` hit.
fn face_light(scene: Scene<'_>, x: u32, hit: &Hit, tile: Option<&Tile>) -> FaceLight {
    let world = scene.world;
    if let Some(own) = tile.and_then(|tile| tile.light) {
        return FaceLight::even(own);
    }
    let before = || cell_before(hit, scene.projection.direction_of(x));
    match tile.map(|tile| tile.kind) {
        // It stands in a cell of its own.
        Some(TileKind::Shape(_)) => FaceLight::even(world.light_in(hit.cell)),
        Some(TileKind::Door(_)) => {
            FaceLight::even(before().map_or(Light::FULL, |cell| world.light_in(cell)))
        }
        _ => before().map_or(FaceLight::FULL, |cell| world.face_light(hit.cell, cell)),
    }
}

/// The cell that the side of a wall is seen from, along `direction`; `None` off the map's north and
/// west.
fn cell_before(hit: &Hit, direction: DVec2) -> Option<Cell> {
    let Cell { column, row } = hit.cell;
    let is_ahead = across_line(hit.side, direction) > 0.0;
    let before = |index: u32| if is_ahead { index.checked_sub(1) } else { index.checked_add(1) };
    Some(match hit.side {
        Side::X => Cell { column: before(column)?, row },
        Side::Y => Cell { column, row: before(row)? },
    })
}

/// The part of a direction that leads straight at lines of that kind.
fn across_line(side: Side, direction: DVec2) -> f64 {
    match side {
        Side::X => direction.x,
        Side::Y => direction.y,
    }
}

/// A wall as wide as a pixel.
struct Strip<'s, 'a> {
    scene: Scene<'a>,
    x: u32,
    hit: &'s Hit,
    face: &'s Face<'a>,
}

impl<'a> Strip<'_, 'a> {
    /// The level of a texture that suits the distance.
    #[inline]
    fn level(&self, id: TextureId) -> &'a Level {
        level(self.scene, self.hit.t, self.across(), id)
    }

    /// What becomes of its colours.
    fn shade(&self) -> Faded {
        let light = self.face.light.at(self.hit.u);
        let (fog, distance) = (self.scene.world.fog(), self.hit.t);
        match self.face.shape() {
            None => Faded::of_wall(self.hit.side, light, fog, distance),
            Some(shape) => Faded::of_surface(self.normal(shape), light, fog, distance),
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

    /// The part of the ray's direction that leads straight at the side.
    fn across(&self) -> f64 {
        match self.face.shape() {
            None => across_line(self.hit.side, self.direction()),
            Some(shape) => self.normal(shape).dot(self.direction()),
        }
    }

    fn direction(&self) -> DVec2 {
        self.scene.projection.direction_of(self.x)
    }
}

/// How bright what the ray of column `x` hit is.
pub(super) fn light_of(scene: Scene<'_>, x: u32, hit: &Hit) -> Light {
    Face::new::<true>(scene, x, hit).light.at(hit.u)
}

/// The level of the texture `id` that suits the side of a cube that the ray of column `x` hit.
pub(super) fn level_of<'a>(scene: Scene<'a>, x: u32, hit: &Hit, id: TextureId) -> &'a Level {
    level(scene, hit.t, across_line(hit.side, scene.projection.direction_of(x)), id)
}

/// The level of the texture `id` that suits the distance `t`, where that much of the ray's direction leads
/// straight at it.
#[inline]
fn level(scene: Scene<'_>, t: f64, across: f64, id: TextureId) -> &Level {
    let Scene { world, projection, filter, .. } = scene;
    let texture = world.texture(id);
    let texels = f64::from(texture.width()) * f64::from(texture.height());
    let area = projection.pixel_area_on_wall(t, across);
    texture.level(filter.halvings(area * texels))
}
