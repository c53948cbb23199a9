//! The wall columns of a level scene: one for each ray that hit a solid tile.
//!
//! Neighbours on one kind of side with one paint are a run. In plain light, nothing else distinguishes them
//! but distance and texture coordinate, and a run is drawn without looking at the map for each column.

use std::ops::Range;

use glam::DVec2;

use crate::cast::{Hit, Side, cell_before};
use crate::visibility::{Column, Extent, Facing, Scene, WallColumn, WallPart, WallRun, WallSink};
use crate::world::{Cell, FaceLight, Light, Paint, Tile, TileKind, World};

/// Passes the wall column in `rows` of each of `columns` to `sink`, from left to right.
#[inline]
pub(crate) fn for_each_wall_column(
    scene: Scene<'_>,
    columns: &[Column],
    rows: &Range<u32>,
    sink: &mut impl WallSink,
) {
    let mut latest: Option<(Face<'_>, Paint)> = None;
    for (x, column) in (0..).zip(columns) {
        let shown = column.rows.start.max(rows.start)..column.rows.end.min(rows.end);
        let Some(hit) = column.hit.as_ref().filter(|_| !shown.is_empty()) else { continue };
        if hit.t < 0.0 {
            // The portal way fills that column.
            continue;
        }
        let (face, paint) = match &mut latest {
            Some(latest) if latest.0.is_of(hit) => &*latest,
            latest => {
                let face = Face::new(scene, x, hit, true);
                latest.insert((face, face.paint(scene, x, hit)))
            }
        };
        let direction = scene.projection.direction_of(x);
        let facing = face.facing(scene, direction, hit);
        let wall = WallColumn {
            column: x,
            rows: column.rows.clone(),
            facing,
            slope: facing.slope(direction),
            t: hit.t,
            u: hit.u,
            light: face.light.at(hit.u),
            material: *paint,
            extent: Extent::Level,
        };
        sink.take(&wall, shown);
    }
}

/// Passes every run of `columns` to `draw`, from left to right. No shape may be in view.
#[inline]
pub(crate) fn for_each_wall_run<'l>(
    scene: Scene<'_>,
    columns: &'l [Column],
    mut draw: impl FnMut(WallRun<'l>),
) {
    let mut face: Option<Face<'_>> = None;
    let mut run: Option<(usize, Side, Paint)> = None;
    let mut end = |run: Option<(usize, Side, Paint)>, end: usize| {
        if let Some((first, side, paint)) = run {
            draw(WallRun { first: first as u32, columns: &columns[first..end], side, paint });
        }
    };
    for (x, column) in columns.iter().enumerate() {
        let Some(hit) = column.hit.as_ref().filter(|hit| hit.t >= 0.0) else {
            end(run.take(), x);
            face = None;
            continue;
        };
        if face.as_ref().is_some_and(|face| face.is_of(hit)) {
            continue;
        }
        let of_hit = face.insert(Face::new(scene, x as u32, hit, false));
        let paint = of_hit.paint(scene, x as u32, hit);
        if !run.is_some_and(|(_, side, of_run)| (side, of_run) == (hit.side, paint)) {
            end(run.replace((x, hit.side, paint)), x);
        }
    }
    end(run, columns.len());
}

/// Passes each of `parts` to `draw`, with the wall column in its middle. The light is computed only if
/// `is_lit`.
#[inline]
pub(crate) fn for_each_wall_part<'l>(
    scene: Scene<'_>,
    parts: &'l [WallPart],
    is_lit: bool,
    mut draw: impl FnMut(&'l WallPart, &WallColumn),
) {
    let mut latest: Option<(Face<'_>, Paint)> = None;
    for part in parts {
        let (x, hit) = (part.column, &part.hit);
        let (face, paint) = match &mut latest {
            Some(latest) if latest.0.is_of(hit) => &*latest,
            latest => {
                let face = Face::new(scene, x, hit, is_lit);
                latest.insert((face, face.paint(scene, x, hit)))
            }
        };
        let direction = scene.projection.direction_at(part.middle);
        let facing = face.facing(scene, direction, hit);
        let wall = WallColumn {
            column: x,
            rows: part.rows.clone(),
            facing,
            slope: facing.slope(direction),
            t: hit.t,
            u: hit.u,
            light: if is_lit { face.light.at(hit.u) } else { Light::FULL },
            material: *paint,
            extent: Extent::Level,
        };
        draw(part, &wall);
    }
}

/// The light of the face that the ray of column `x` hit.
pub(crate) fn light_of(scene: Scene<'_>, x: u32, hit: &Hit) -> Light {
    Face::new(scene, x, hit, true).light.at(hit.u)
}

/// The values that all columns showing one face of a cell share.
#[derive(Clone, Copy)]
struct Face<'a> {
    cell: Cell,
    side: Side,
    /// The tile of the cell.
    tile: Option<&'a Tile>,
    /// The light along the face, if it is lit.
    light: FaceLight,
}

impl<'a> Face<'a> {
    /// The face that the ray of column `x` hit.
    fn new(scene: Scene<'a>, x: u32, hit: &Hit, is_lit: bool) -> Self {
        let tile = scene.world.tile_in(hit.cell);
        let light = if is_lit { face_light(scene, x, hit, tile) } else { FaceLight::FULL };
        Self { cell: hit.cell, side: hit.side, tile, light }
    }

    /// Whether `hit` is on the same face.
    #[inline]
    fn is_of(&self, hit: &Hit) -> bool {
        (self.cell, self.side) == (hit.cell, hit.side)
    }

    /// The paint at the hit of the ray of column `x`: that of a jamb, if the face is towards a
    /// door.
    fn paint(&self, scene: Scene<'_>, x: u32, hit: &Hit) -> Paint {
        let Scene { world, plan, .. } = scene;
        let door = || world.door(place_before(scene, x, hit)?);
        let door = if plan.walls.jambs { door() } else { None };
        door.map_or_else(|| self.paint_of_tile(world), |door| door.jamb)
    }

    /// The paint of the tile itself.
    fn paint_of_tile(&self, world: &World) -> Paint {
        match self.tile.map(|tile| tile.kind) {
            Some(TileKind::Wall(paint)) => paint,
            Some(TileKind::Door(door)) => door.leaf,
            Some(TileKind::Shape(shape)) => shape.paint,
            // Casters that do not support masks and glass hit these.
            Some(TileKind::Mask(texture)) => Paint::Texture(texture),
            Some(TileKind::Glass(glass) | TileKind::Mirror(glass)) => Paint::Color(glass.color),
            // No caster hits an open tile. If one did, the floor is the only paint there.
            Some(TileKind::Open | TileKind::Doorway(_)) | None => {
                world.floor().pattern.first_paint()
            }
        }
    }

    /// The facing at the hit of a ray along `direction`.
    #[inline]
    fn facing(&self, scene: Scene<'_>, direction: DVec2, hit: &Hit) -> Facing {
        match self.tile.map(|tile| &tile.kind) {
            Some(&TileKind::Shape(shape)) => {
                let point = scene.projection.origin() + direction * hit.t;
                Facing::of_shape(shape.outline, point, hit)
            }
            _ => Facing::Side(hit.side),
        }
    }
}

/// The light along the face of `tile` that the ray of column `x` hit.
fn face_light(scene: Scene<'_>, x: u32, hit: &Hit, tile: Option<&Tile>) -> FaceLight {
    let world = scene.world;
    if let Some(own) = tile.and_then(|tile| tile.light) {
        return FaceLight::even(own);
    }
    let before = || place_before(scene, x, hit);
    match tile.map(|tile| tile.kind) {
        // A shape is lit by the light of its own cell.
        Some(TileKind::Shape(_)) => FaceLight::even(world.light_in(hit.cell)),
        Some(TileKind::Door(_)) => {
            FaceLight::even(before().map_or(Light::FULL, |cell| world.light_in(cell)))
        }
        _ => before().map_or(FaceLight::FULL, |cell| world.face_light(hit.cell, cell)),
    }
}

/// The cell from which the ray of column `x` sees its hit; `None` off the north and west of the
/// map.
fn place_before(scene: Scene<'_>, x: u32, hit: &Hit) -> Option<Cell> {
    let [column, row] = cell_before(scene.projection.direction_of(x), hit.cell, hit.side);
    let is_known = column >= 0 && row >= 0;
    is_known.then_some(Cell { column: column as u32, row: row as u32 })
}
