//! The top view: the map point at each position of the map, and its appearance in every colour depth and in characters.
//!
//! The appearance of tiles is computed once per picture, and the things in a row once per row of pixels, so that most
//! pixels need only a table lookup.
//!
//! The brightness of walls is between two limits, floors are darker, and the player's arrow is brighter than both. With
//! 16 colours, which users can redefine, and without colour, each kind of point has its own colour or pattern.
//! Rejected: the nearest of 16 colours, which would make walls and floors equal.

use glam::DVec2;

use super::explored::{Explored, SeenRow};
use crate::color::Rgb;
use crate::game::SightCone;
use crate::numeric::rounding::floor_short;
use crate::world::{
    Camera, Cell, Paint, Shape, Thing, ThingKind, Tile, TileEffect, TileId, TileKind, World,
};

/// A world seen from above.
pub(crate) struct TopView<'a> {
    world: &'a World,
    visible_floor: VisibleFloor<'a>,
    explored: Option<&'a Explored>,
    /// The cones of the guards in view.
    cones: Vec<&'a SightCone>,
    /// The appearance of each tile.
    tiles: [TileAppearance; TileId::MAX],
    /// The width of a pixel in cells.
    pixel: f64,
}

/// The appearance of a tile from above.
#[derive(Clone, Copy)]
enum TileAppearance {
    Floor(Floor),
    Wall(Rgb),
    Door(Rgb),
    /// Solid inside of the shape, and floor around it.
    Shape(Rgb, Floor),
}

/// The colour that shows through glass.
const BELOW_GLASS: Rgb = Rgb::new(0x24, 0x24, 0x2c);
/// The least opacity of glass, so that clear glass differs from floor.
const MIN_GLASS_OPACITY: u8 = 96;

impl<'a> TopView<'a> {
    /// A top view of `world`. The rays of the picture from `camera` end at `distances`, cells that
    /// are not `explored` are hidden, and `pixel` is the width of a pixel in cells.
    pub(crate) fn new(
        world: &'a World,
        camera: &Camera,
        (distances, explored): (&'a [f64], Option<&'a Explored>),
        pixel: f64,
    ) -> Self {
        let mut tiles = [TileAppearance::Wall(Rgb::BLACK); TileId::MAX];
        for (appearance, tile) in tiles.iter_mut().zip(world.tiles()) {
            *appearance = appearance_of(tile, world, camera.eye());
        }
        let visible_floor = VisibleFloor::new(camera, distances);
        Self { world, visible_floor, explored, cones: Vec::new(), tiles, pixel }
    }

    /// The same view, with the floor tinted that guards in view look at.
    #[must_use]
    pub(crate) fn watched(mut self, cones: &'a [SightCone]) -> Self {
        self.cones = cones.iter().filter(|cone| self.is_visible(cone.position())).collect();
        self
    }

    /// The row of points at the distance `y` from the map's northern edge.
    pub(crate) fn row(&self, y: f64) -> MapRow<'_> {
        let row = u32::try_from(floor_short(y)).ok();
        MapRow {
            view: self,
            seen: self.explored.map(|explored| explored.row(row.unwrap_or(u32::MAX))),
            tiles: row
                .and_then(|row| self.world.grid().rows().nth(row as usize))
                .unwrap_or_default(),
            things: row.map_or(&[], |row| self.world.things_between(row, 0, u32::MAX)),
            y,
            number: row.unwrap_or_default(),
        }
    }

    /// Returns true if the floor at `point` is in view.
    pub(crate) fn is_visible(&self, point: DVec2) -> bool {
        self.visible_floor.contains(point)
    }

    /// Returns true if a pixel around `point` shows the shape of `tile`, which is in `cell`.
    fn is_covered(&self, tile: TileId, cell: Cell, point: DVec2) -> bool {
        let TileKind::Shape(Shape { outline, .. }) = self.world.tile(tile).kind else {
            return true;
        };
        outline.distance(cell, point) <= self.pixel / 2.0
    }
}

/// The points on a line from west to east.
pub(crate) struct MapRow<'a> {
    view: &'a TopView<'a>,
    tiles: &'a [TileId],
    /// The cells that are not hidden. `None` if no cell is hidden.
    seen: Option<SeenRow<'a>>,
    things: &'a [Thing],
    y: f64,
    /// The number of the row, if there are tiles.
    number: u32,
}

impl MapRow<'_> {
    /// The map point at the distance `x` from the map's western edge, which is the middle of a
    /// pixel.
    #[inline]
    pub(crate) fn point(&self, x: f64) -> MapPoint {
        let column = floor_short(x) as usize;
        let Some(&tile) = self.tiles.get(column) else { return MapPoint::Void };
        if self.seen.is_some_and(|seen| !seen.contains(column as u32)) {
            return MapPoint::Void;
        }
        self.point_in(Cell { column: column as u32, row: self.number }, tile, x)
    }

    /// The map point at the distance `x` from the map's western edge, in a cell that is not hidden.
    #[inline(never)]
    fn point_in(&self, cell: Cell, tile: TileId, x: f64) -> MapPoint {
        let point = DVec2::new(x, self.y);
        let floor = match self.view.tiles[usize::from(tile.0)] {
            TileAppearance::Wall(color) => return MapPoint::Wall(color),
            TileAppearance::Door(color) => return MapPoint::Door(color),
            TileAppearance::Shape(color, _) if self.view.is_covered(tile, cell, point) => {
                return MapPoint::Wall(color);
            }
            TileAppearance::Shape(_, floor) | TileAppearance::Floor(floor) => floor,
        };
        match self.thing(cell) {
            Some(ThingKind::Exit) => MapPoint::Exit,
            Some(kind) if self.is_on_dot(point, cell) => dot(kind),
            _ if self.view.cones.iter().any(|cone| cone.contains(point)) => {
                MapPoint::Watched(floor)
            }
            _ if self.view.visible_floor.contains(point) => MapPoint::InView(floor),
            _ => MapPoint::Floor(floor),
        }
    }

    /// Returns true if `point` is on the dot for a thing in `cell`. If pixels are as large as cells, the dot fills the
    /// whole cell.
    fn is_on_dot(&self, point: DVec2, cell: Cell) -> bool {
        const RADIUS: f64 = 0.3;
        self.view.pixel >= 1.0 || (point - cell.center()).abs().max_element() <= RADIUS
    }

    /// The first thing in a cell of the row.
    #[inline]
    fn thing(&self, cell: Cell) -> Option<ThingKind> {
        if self.things.is_empty() {
            return None;
        }
        let first = self.things.partition_point(|thing| thing.cell.column < cell.column);
        self.things.get(first).filter(|thing| thing.cell == cell).map(|thing| thing.kind)
    }
}

/// The dot for a thing.
fn dot(kind: ThingKind) -> MapPoint {
    match kind {
        ThingKind::Exit => MapPoint::Exit,
        ThingKind::Key(_) => MapPoint::Key,
        ThingKind::Treasure(_)
        | ThingKind::Healing(_)
        | ThingKind::Supply(..)
        | ThingKind::Note(_) => MapPoint::Item,
        ThingKind::Ornament
        | ThingKind::Checkpoint
        | ThingKind::Lever(_)
        | ThingKind::Spikes(_)
        | ThingKind::Flame => MapPoint::Ornament,
    }
}

/// The appearance of `tile` for an eye at height `eye`. The top of a wall below the eye is floor.
fn appearance_of(tile: &Tile, world: &World, eye: f64) -> TileAppearance {
    let wall = |paint| of_wall(world.mean_color(paint));
    let height = tile.heights.floor();
    let floor = match tile.effect {
        Some(TileEffect::Water) => Floor::water(height),
        _ => Floor::new(height, world.mean_color(tile.floor.pattern.first_paint())),
    };
    let is_top_seen = || height < eye && tile.gaps().next().is_some_and(|gap| gap.bottom <= height);
    match tile.kind {
        TileKind::Open | TileKind::Doorway(_) => TileAppearance::Floor(floor),
        TileKind::Wall(_) if is_top_seen() => TileAppearance::Floor(floor),
        TileKind::Wall(paint) => TileAppearance::Wall(wall(paint)),
        TileKind::Shape(Shape { paint, .. }) => TileAppearance::Shape(wall(paint), floor),
        TileKind::Door(door) => TileAppearance::Door(wall(door.leaf)),
        TileKind::Mirror(tint) => TileAppearance::Wall(of_wall(tint.color)),
        TileKind::Mask(texture) => TileAppearance::Wall(wall(Paint::Texture(texture))),
        TileKind::Glass(glass) => {
            let color = glass.color.over(BELOW_GLASS, glass.opacity.max(MIN_GLASS_OPACITY));
            TileAppearance::Door(of_wall(color))
        }
    }
}

/// The visible part of the floor.
struct VisibleFloor<'a> {
    position: DVec2,
    direction: DVec2,
    half_width: f64,
    distances: &'a [f64],
}

impl<'a> VisibleFloor<'a> {
    fn new(camera: &Camera, distances: &'a [f64]) -> Self {
        Self {
            position: camera.position(),
            direction: camera.direction(),
            half_width: camera.field_of_view.half_width(),
            distances,
        }
    }

    /// Returns true if the ray of the picture's column at `point` reaches `point`.
    #[inline]
    fn contains(&self, point: DVec2) -> bool {
        let to_point = point - self.position;
        let distance = to_point.dot(self.direction);
        if distance <= 0.0 || self.distances.is_empty() {
            return false;
        }
        let (across, half_width) =
            (to_point.dot(self.direction.perp()), distance * self.half_width);
        // Most points out of view need no division.
        if across.abs() > 2.0 * half_width {
            return false;
        }
        let across = across / half_width;
        let index = f64::midpoint(across, 1.0) * self.distances.len() as f64;
        index >= 0.0 && self.distances.get(index as usize).is_some_and(|&end| distance <= end)
    }
}

/// The content of a point of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapPoint {
    /// Outside of the map, or unexplored.
    Void,
    Wall(Rgb),
    /// A door, or glass.
    Door(Rgb),
    Floor(Floor),
    /// Floor in the field of view.
    InView(Floor),
    /// Floor that a guard in view looks at.
    Watched(Floor),
    Exit,
    Key,
    /// Something that the player can take or read.
    Item,
    Ornament,
}

/// Floor, with a colour that depends on its height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Floor {
    kind: FloorKind,
    color: Rgb,
    /// The floor's colour if it is visible.
    lit: Rgb,
    /// The floor's colour if a guard looks at it.
    watched: Rgb,
}

/// The kinds of floor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum FloorKind {
    /// At the height of the map's own floor.
    Base,
    /// Above it.
    Ledge,
    /// Below it, without water.
    Pit,
    Water,
}

/// Floor at the height of the map's own floor.
pub(crate) const BASE: Rgb = Rgb::new(0x24, 0x24, 0x2c);
/// The colours that raised floor, lowered floor and water approach with their height or depth. They are so light that
/// pits are red and water is blue among 256 colours, too.
const LEDGE: Rgb = Rgb::new(0x66, 0x66, 0x70);
const PIT: Rgb = Rgb::new(0xa0, 0x1c, 0x1c);
const WATER: Rgb = Rgb::new(0x10, 0x60, 0xb8);
/// The tint of visible floor, and its share.
const TINT: Rgb = Rgb::new(0x7a, 0x72, 0x50);
const TINT_SHARE: f64 = 0.7;
/// The tint of floor that a guard looks at.
const WATCHED: Rgb = Rgb::new(0xa8, 0x64, 0x10);
/// The share of black on a faded map.
const FADED_SHARE: f64 = 0.45;
/// Points outside of the map.
const VOID: Rgb = Rgb::BLACK;
/// The cell to reach. It is lighter than a key, for people who cannot tell green from gold.
const EXIT: Rgb = Rgb::new(0x50, 0xd8, 0x78);
/// A key to take.
const KEY: Rgb = Rgb::new(0xd0, 0x90, 0x20);
/// Treasure, a tool or a note.
const ITEM: Rgb = Rgb::new(0xc8, 0x78, 0xc8);
/// An obstacle, or a decoration.
const ORNAMENT: Rgb = Rgb::new(0x9c, 0x8c, 0x74);
/// The least and the greatest brightness of walls.
const WALLS: (u8, u8) = (0x60, 0xb0);

/// A floor counts as level with the map's own floor if their heights differ by less than this, in cells.
const SAME_HEIGHT: f64 = 0.05;

impl Floor {
    /// Water at `height`.
    pub(crate) fn water(height: f64) -> Self {
        let depth = height.min(0.0).abs();
        Self::of(FloorKind::Water, mix(BASE, WATER, (depth + 0.3) / (depth + 0.6)))
    }

    /// Floor at `height` with the mean colour `color`.
    pub(crate) fn new(height: f64, color: Rgb) -> Self {
        // The share is one half at the height or depth `half`.
        let share = |half: f64| height.abs() / (height.abs() + half);
        if height > SAME_HEIGHT {
            Self::of(FloorKind::Ledge, mix(BASE, LEDGE, share(0.6)))
        } else if height >= -SAME_HEIGHT {
            Self::of(FloorKind::Base, BASE)
        } else if is_watery(color) {
            Self::of(FloorKind::Water, mix(BASE, WATER, share(0.3)))
        } else {
            Self::of(FloorKind::Pit, mix(BASE, PIT, share(0.5)))
        }
    }

    fn of(kind: FloorKind, color: Rgb) -> Self {
        let [lit, watched] = [TINT, WATCHED].map(|tint| mix(color, tint, TINT_SHARE));
        Self { kind, color, lit, watched }
    }
}

/// Returns true if a lowered floor with this colour looks like water, because it is much more blue than red. A map may
/// draw water that has no effect.
fn is_watery(color: Rgb) -> bool {
    u16::from(color.blue()) >= 2 * u16::from(color.red())
}

/// The mean of two colours, in which the second has the weight `share`.
fn mix(one: Rgb, other: Rgb, share: f64) -> Rgb {
    let [one, other] = [one, other].map(|color| color.channels().map(f64::from));
    let channel = |index: usize| (one[index] + (other[index] - one[index]) * share).round() as u8;
    Rgb::new(channel(0), channel(1), channel(2))
}

/// The colour of a wall with the mean colour `color`. It is the same, but neither as dark as floor nor as bright as the
/// arrow.
fn of_wall(color: Rgb) -> Rgb {
    let (least, most) = WALLS;
    let luma = color.luma();
    if luma < least {
        let share = f64::from(least - luma) / f64::from(u8::MAX - luma);
        mix(color, Rgb::WHITE, share)
    } else if luma > most {
        mix(Rgb::BLACK, color, f64::from(most) / f64::from(luma))
    } else {
        color
    }
}

impl MapPoint {
    pub(crate) fn color(self) -> Rgb {
        match self {
            Self::Void => VOID,
            Self::Wall(color) | Self::Door(color) => color,
            Self::Floor(floor) => floor.color,
            Self::InView(floor) => floor.lit,
            Self::Watched(floor) => floor.watched,
            Self::Exit => EXIT,
            Self::Key => KEY,
            Self::Item => ITEM,
            Self::Ornament => ORNAMENT,
        }
    }

    /// The point without the tint of the field of view.
    pub(crate) fn out_of_view(self) -> Self {
        match self {
            Self::InView(floor) => Self::Floor(floor),
            other => other,
        }
    }

    /// Returns true if the point is as bright on a faded map as on any other.
    pub(crate) fn stays(self) -> bool {
        matches!(self, Self::Exit | Self::Watched(_))
    }

    /// The colour on a faded map.
    pub(crate) fn faded_color(self) -> Rgb {
        if self.stays() { self.color() } else { mix(self.color(), VOID, FADED_SHARE) }
    }

    /// Returns true if the point's pixel at this position of the screen is lit when there are no colours.
    pub(crate) fn is_lit(self, x: u32, y: u32) -> bool {
        match self {
            Self::Wall(_) | Self::Door(_) => true,
            Self::Watched(_) => (x / 2 + y).is_multiple_of(3),
            Self::Floor(Floor { kind, .. }) | Self::InView(Floor { kind, .. }) => match kind {
                FloorKind::Ledge => (x + y).is_multiple_of(2),
                FloorKind::Water => y.is_multiple_of(2) && !x.is_multiple_of(3),
                FloorKind::Base if matches!(self, Self::InView(_)) => {
                    x.is_multiple_of(2) && y.is_multiple_of(2)
                }
                FloorKind::Base | FloorKind::Pit => false,
            },
            Self::Void | Self::Exit | Self::Key | Self::Item | Self::Ornament => false,
        }
    }

    /// Returns true if the point is a letter among the patterns of a map without colour.
    pub(crate) fn is_thing(self) -> bool {
        matches!(self, Self::Exit | Self::Key | Self::Item | Self::Ornament)
    }

    /// The appearance if colours are few or missing, and the importance.
    pub(crate) fn look(self) -> PointLook {
        let floor = |floor: Floor, base: (char, u8)| match floor.kind {
            FloorKind::Base => base,
            FloorKind::Ledge => ('=', 6),
            FloorKind::Pit => ('_', 1),
            FloorKind::Water => ('~', 4),
        };
        let ((character, index_of_16), importance) = match self {
            Self::Void => ((' ', 0), 0),
            Self::Floor(it) => (floor(it, ('.', 8)), 1),
            Self::InView(it) => (floor(it, (':', 3)), 2),
            Self::Watched(_) => (('%', 1), 3),
            Self::Ornament => (('o', 2), 3),
            Self::Wall(_) => (('#', 7), 4),
            Self::Door(_) => (('+', 5), 5),
            Self::Item => (('$', 14), 6),
            Self::Key => (('k', 13), 7),
            Self::Exit => (('X', 10), 8),
        };
        PointLook { character, index_of_16, importance }
    }
}

impl PointLook {
    /// The index of the colour among the 16 on a faded map: a dark one.
    pub(crate) fn faded_index_of_16(&self) -> u8 {
        if self.index_of_16 == 7 { 8 } else { self.index_of_16 % 8 }
    }
}

/// The appearance of a point if colours are few or missing.
pub(crate) struct PointLook {
    pub(crate) character: char,
    /// The index of its colour among the 16.
    pub(crate) index_of_16: u8,
    /// A pixel that covers several points shows the most important one.
    pub(crate) importance: u8,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::blindness::assert_apart;

    /// Marks differ in shape. The field of view is left out, because its shape tells it from higher floor.
    #[test]
    fn everybody_can_tell_the_colours_of_the_map_apart() {
        let floor = |height| Floor::new(height, Rgb::WHITE).color;
        assert_apart(&[
            ("unexplored", VOID),
            ("floor", BASE),
            ("higher floor", floor(1.0)),
            ("pit", floor(-1.0)),
            ("water", Floor::water(-1.0).color),
            ("watched floor", Floor::new(0.0, Rgb::WHITE).watched),
            ("exit", EXIT),
            ("key", KEY),
            ("item", ITEM),
        ]);
        assert_apart(&[("floor", BASE), ("floor in view", Floor::new(0.0, Rgb::WHITE).lit)]);
        for depth in [0.0, -0.5, -2.0] {
            assert_apart(&[("floor", BASE), ("water", Floor::water(depth).color)]);
        }
    }
}
