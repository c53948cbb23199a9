//! What a point of the map shows from above.
//!
//! What tiles look like is found out once a picture, and what stands in a row once a row of pixels: most
//! pixels need no more than a look into a table.

use glam::DVec2;

use super::explored::Explored;
use super::place::{self, Ground, Place};
use crate::color::Rgb;
use crate::render::Column;
use crate::world::{Camera, Cell, Paint, Shape, Thing, ThingKind, Tile, TileId, TileKind, World};

/// All that points are asked of.
pub(super) struct Chart<'a> {
    world: &'a World,
    sight: Sight<'a>,
    explored: Option<&'a Explored>,
    /// What each tile looks like.
    tiles: [Drawn; TileId::MOST],
    /// How many cells a pixel is wide.
    pixel: f64,
}

/// What a tile looks like.
#[derive(Clone, Copy)]
enum Drawn {
    Floor(Ground),
    Wall(Rgb),
    Door(Rgb),
    /// Solid where the shape is, and floor around it.
    Shape(Rgb, Ground),
}

/// The floor below glass, as far as that can be told apart.
const BELOW_GLASS: Rgb = Rgb::new(0x24, 0x24, 0x2c);
/// How opaque glass is at least, so that clear glass can be told from floor.
const MIST: u8 = 96;

impl<'a> Chart<'a> {
    /// A chart of `world`, of which `camera` saw `columns` and what is `explored`, whose pixels are so many
    /// cells wide.
    pub(super) fn new(
        world: &'a World,
        camera: &Camera,
        (columns, explored): (&'a [Column], Option<&'a Explored>),
        pixel: f64,
    ) -> Self {
        let mut tiles = [Drawn::Wall(Rgb::BLACK); TileId::MOST];
        for (drawn, tile) in tiles.iter_mut().zip(world.tiles()) {
            *drawn = drawn_as(tile, world, camera.eye());
        }
        Self { world, sight: Sight::new(camera, columns), explored, tiles, pixel }
    }

    /// What lies at the points whose distance from the map's northern edge is `y`.
    pub(super) fn row(&self, y: f64) -> Row<'_> {
        let row = u32::try_from(cell_at(y)).ok();
        Row {
            chart: self,
            tiles: row
                .and_then(|row| self.world.grid().rows().nth(row as usize))
                .unwrap_or_default(),
            things: row.map_or(&[], |row| self.world.things_between(row, 0, u32::MAX)),
            y,
            number: row.unwrap_or_default(),
        }
    }

    /// Whether a pixel around `point`, in a cell of a tile with a shape, shows that.
    fn is_covered(&self, tile: TileId, cell: Cell, point: DVec2) -> bool {
        let TileKind::Shape(Shape { outline, .. }) = self.world.tile(tile).kind else {
            return true;
        };
        outline.distance(cell, point) <= self.pixel / 2.0
    }
}

/// What lies on a line from west to east.
pub(super) struct Row<'a> {
    chart: &'a Chart<'a>,
    tiles: &'a [TileId],
    things: &'a [Thing],
    y: f64,
    /// Which of the map's rows that is, if there are tiles.
    number: u32,
}

impl Row<'_> {
    /// What is there so far from the map's western edge, in the middle of a pixel.
    #[inline]
    pub(super) fn place(&self, x: f64) -> Place {
        let column = cell_at(x) as usize;
        let Some(&tile) = self.tiles.get(column) else { return Place::Void };
        let cell = Cell { column: column as u32, row: self.number };
        let point = DVec2::new(x, self.y);
        if self.chart.explored.is_some_and(|explored| !explored.contains(cell)) {
            return Place::Void;
        }
        let ground = match self.chart.tiles[usize::from(tile.0)] {
            Drawn::Wall(color) => return Place::Wall(color),
            Drawn::Door(color) => return Place::Door(color),
            Drawn::Shape(color, _) if self.chart.is_covered(tile, cell, point) => {
                return Place::Wall(color);
            }
            Drawn::Shape(_, ground) | Drawn::Floor(ground) => ground,
        };
        match self.thing(cell) {
            Some(ThingKind::Exit) => Place::Exit,
            Some(ThingKind::Key(_)) if self.is_on_dot(point, cell) => Place::Key,
            Some(ThingKind::Ornament) if self.is_on_dot(point, cell) => Place::Ornament,
            _ if self.chart.sight.reaches(point) => Place::InView(ground),
            _ => Place::Floor(ground),
        }
    }

    /// Whether `point` is on the dot that stands for a thing in `cell`; where pixels are cells or larger, all of it
    /// is.
    fn is_on_dot(&self, point: DVec2, cell: Cell) -> bool {
        const RADIUS: f64 = 0.3;
        self.chart.pixel >= 1.0 || (point - cell.center()).abs().max_element() <= RADIUS
    }

    /// The first thing that stands in a cell of the row.
    #[inline]
    fn thing(&self, cell: Cell) -> Option<ThingKind> {
        if self.things.is_empty() {
            return None;
        }
        let first = self.things.partition_point(|thing| thing.cell.column < cell.column);
        self.things.get(first).filter(|thing| thing.cell == cell).map(|thing| thing.kind)
    }
}

/// What `tile` looks like to who has their eye at that height: the top of a wall that they look down on is floor.
fn drawn_as(tile: &Tile, world: &World, eye: f64) -> Drawn {
    let wall = |paint| place::of_wall(world.mean_color(paint));
    let height = tile.heights.floor();
    let ground = Ground::new(height, world.mean_color(tile.floor.pattern.first_paint()));
    let is_top_seen = || height < eye && tile.gaps().next().is_some_and(|gap| gap.bottom <= height);
    match tile.kind {
        TileKind::Open | TileKind::Doorway(_) => Drawn::Floor(ground),
        TileKind::Wall(_) if is_top_seen() => Drawn::Floor(ground),
        TileKind::Wall(paint) => Drawn::Wall(wall(paint)),
        TileKind::Shape(Shape { paint, .. }) => Drawn::Shape(wall(paint), ground),
        TileKind::Door(door) => Drawn::Door(wall(door.leaf)),
        TileKind::Mirror(tint) => Drawn::Wall(place::of_wall(tint.color)),
        TileKind::Mask(texture) => Drawn::Wall(wall(Paint::Texture(texture))),
        TileKind::Glass(glass) => {
            let color = glass.color.over(BELOW_GLASS, glass.opacity.max(MIST));
            Drawn::Door(place::of_wall(color))
        }
    }
}

/// What the player sees of the floor.
struct Sight<'a> {
    position: DVec2,
    direction: DVec2,
    half_width: f64,
    columns: &'a [Column],
}

impl<'a> Sight<'a> {
    fn new(camera: &Camera, columns: &'a [Column]) -> Self {
        Self {
            position: camera.position(),
            direction: camera.direction(),
            half_width: camera.field_of_view.half_width(),
            columns,
        }
    }

    /// Whether the ray of the column that `point` falls in gets as far as that.
    #[inline]
    fn reaches(&self, point: DVec2) -> bool {
        let to_point = point - self.position;
        let distance = to_point.dot(self.direction);
        if distance <= 0.0 || self.columns.is_empty() {
            return false;
        }
        let (across, half_width) =
            (to_point.dot(self.direction.perp()), distance * self.half_width);
        // Most of what is not in view is found out without a division.
        if across.abs() > 2.0 * half_width {
            return false;
        }
        let across = across / half_width;
        let index = f64::midpoint(across, 1.0) * self.columns.len() as f64;
        index >= 0.0
            && self.columns.get(index as usize).is_some_and(|column| distance <= column.distance)
    }
}

/// The column or row that a place is in; before the map, a negative one. Where processors may be old, rounding
/// down is a call.
fn cell_at(place: f64) -> i64 {
    place as i64 - i64::from(place < 0.0)
}
