//! Tiles: the kinds of cell, with their surfaces, heights and shapes.
//!
//! A cell is a solid column with gaps: one between floor and ceiling and one above the roof, or a
//! single one under the sky or above a low wall. Drawing, walking and falling use the gaps, and
//! need not know which kind of tile makes them. Rejected: a list of solid blocks for each cell.
//! Floor, ceiling and roof, with at most two gaps, describe everything that the levels of a
//! raycaster need.
//!
//! A shape is a wall that does not fill its cell: a round pillar or a line. A line is a diagonal or
//! a thin wall along an edge or across the middle of the cell. Each shape is a curve whose equation
//! is solved as exactly as the lines of the grid. Rejected: polygons. A curve made of lines shows
//! its corners, and a level of polygons can no longer be drawn with characters.

use glam::DVec2;

use super::{Cell, Door, Light, TileEffect};
use crate::color::Rgb;

/// One kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The character that draws it in a map.
    pub character: char,
    /// The kind of tile.
    pub kind: TileKind,
    /// The floor: the tile's own, or else the map's.
    pub floor: Covering,
    /// The ceiling: the tile's own, or else the map's.
    pub ceiling: Ceiling,
    /// For open floor, the light on it and on the walls around it; for a wall, the light on its
    /// sides. `None` if the map does not specify it. Then open floor has full light, and a wall has
    /// the light of the floor in front of it.
    pub light: Option<Light>,
    /// The heights of its floor, its ceiling and its roof.
    pub heights: Heights,
    /// The surface of the sides below its floor, seen from a lower floor. For a wall, the surface
    /// of its sides and its top.
    pub riser: Paint,
    /// The surface of its roof, and of the sides above its ceiling, seen from below a higher
    /// ceiling.
    pub lintel: Paint,
    /// The effect on anyone who stands on it.
    pub effect: Option<TileEffect>,
}

/// A kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileKind {
    /// Floor.
    Open,
    /// A door that is fully open: floor between two jambs.
    Doorway(Door),
    /// A solid block up to the height of its floor.
    Wall(Paint),
    /// A door that is not fully open. It stands between two solid cells, with open floor before and
    /// behind it.
    Door(Door),
    /// A solid cube with a texture that has holes.
    Mask(TextureId),
    /// A solid cube of tinted glass.
    Glass(Glass),
    /// A solid block like a wall, whose sides reflect under a tint.
    Mirror(Glass),
    /// A wall that does not fill the cell, and may be lower than its ceiling. Casters and movement
    /// that do not support shapes treat the cell as solid.
    Shape(Shape),
}

/// The tint of glass or of a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glass {
    /// The colour of the tint.
    pub color: Rgb,
    /// The share of the tint over the background or the reflection, from 0 for none to 255 for all.
    pub opacity: u8,
}

impl Glass {
    /// Returns whether the tint is invisible.
    pub(crate) fn is_clear(self) -> bool {
        self.opacity == 0
    }

    /// Returns whether the tint hides the background or the reflection.
    pub(crate) fn is_opaque(self) -> bool {
        self.opacity == u8::MAX
    }
}

/// The look of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// One colour.
    Color(Rgb),
    /// A texture.
    Texture(TextureId),
}

/// A texture: an index into the world's list of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u16);

/// The surface of a floor or a ceiling: paints in a pattern, and the scale of the pattern.
///
/// The top of a texture points north, and one of its corners is at the corner of the map. A ceiling
/// has the same texel as a floor below it would have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covering {
    /// The arrangement of the paints.
    pub pattern: Pattern,
    /// The size of a piece of the pattern.
    pub scale: Scale,
}

/// An arrangement of paints in pieces. A piece is a square with sides of the covering's [`Scale`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    /// One paint everywhere.
    Plain(Paint),
    /// Two paints alternating like a chessboard, the first in the north-west corner.
    Checker([Paint; 2]),
    /// Two paints alternating from row to row, the first in the north.
    Stripes([Paint; 2]),
}

/// The number of cells that one repeat of a texture covers along both axes: finite and above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale(f64);

impl Scale {
    /// One cell.
    pub const ONE: Self = Self(1.0);

    /// A scale of `cells`. `None` unless `cells` is finite and above 0.
    pub fn new(cells: f64) -> Option<Self> {
        (cells > 0.0 && cells.is_finite()).then_some(Self(cells))
    }

    /// The number of cells.
    pub fn cells(self) -> f64 {
        self.0
    }
}

impl From<Paint> for Covering {
    /// One paint everywhere, at a scale of one cell.
    fn from(paint: Paint) -> Self {
        Self { pattern: Pattern::Plain(paint), scale: Scale::ONE }
    }
}

impl Pattern {
    /// The paint in the north-west corner.
    pub fn first_paint(&self) -> Paint {
        match *self {
            Self::Plain(paint) | Self::Checker([paint, _]) | Self::Stripes([paint, _]) => paint,
        }
    }

    /// The paints of the pattern.
    pub fn paints(&self) -> &[Paint] {
        match self {
            Self::Plain(paint) => std::slice::from_ref(paint),
            Self::Checker(paints) | Self::Stripes(paints) => paints,
        }
    }
}

/// A ceiling, or its absence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ceiling {
    /// No ceiling: the sky shows.
    Sky,
    /// A ceiling with this covering.
    Covered(Covering),
}

/// The heights of a tile, in cells above the map's own floor: finite, and at most [`Heights::MAX`]
/// in absolute value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    floor: f64,
    ceiling: f64,
    roof: f64,
}

/// An open range of heights in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The height of the floor below it.
    pub bottom: f64,
    /// The height of the ceiling above it; infinite under the sky.
    pub top: f64,
}

impl Heights {
    /// A floor at 0, with ceiling and roof at 1.
    pub const LEVEL: Self = Self { floor: 0.0, ceiling: 1.0, roof: 1.0 };
    /// The same for a solid wall.
    pub const LEVEL_WALL: Self = Self { floor: 1.0, ..Self::LEVEL };
    /// The largest absolute value of a height.
    pub const MAX: f64 = 1e9;

    /// Heights of a floor, a ceiling and a roof. `None` if one of them is out of range.
    pub fn new(floor: f64, ceiling: f64, roof: f64) -> Option<Self> {
        let is_in_range = |height: f64| height.abs() <= Self::MAX;
        // Adding zero removes the sign of a negative zero.
        let heights = Self { floor: floor + 0.0, ceiling: ceiling + 0.0, roof: roof + 0.0 };
        [floor, ceiling, roof].into_iter().all(is_in_range).then_some(heights)
    }

    /// The height of the floor, or of the top of a wall.
    pub fn floor(self) -> f64 {
        self.floor
    }

    /// The height of the ceiling. Under the sky, the height where the ceiling would be. Doors,
    /// glass and masks reach up to it.
    pub const fn ceiling(self) -> f64 {
        self.ceiling
    }

    /// The height of the top of the solid part above the ceiling.
    pub fn roof(self) -> f64 {
        self.roof
    }
}

impl Gap {
    /// The difference of top and bottom; infinite under the sky.
    pub fn height(self) -> f64 {
        self.top - self.bottom
    }

    /// Returns whether `height` is in the gap or at one of its ends.
    pub fn holds(self, height: f64) -> bool {
        (self.bottom..=self.top).contains(&height)
    }
}

impl Tile {
    /// The gaps of this tile, from the lowest up; there is at least one. Doors, glass and masks
    /// stand in a gap and do not count as solid.
    pub fn gaps(&self) -> impl DoubleEndedIterator<Item = Gap> + use<> {
        let Heights { floor, ceiling, roof } = self.heights;
        let up_from = |bottom| Gap { bottom, top: f64::INFINITY };
        let (inside, above) = match self.ceiling {
            Ceiling::Sky => (None, up_from(floor)),
            Ceiling::Covered(_) if floor < ceiling => {
                (Some(Gap { bottom: floor, top: ceiling }), up_from(roof.max(ceiling)))
            }
            Ceiling::Covered(_) => (None, up_from(floor.max(roof))),
        };
        inside.into_iter().chain([above])
    }

    /// The height above which the cell is empty, above everything solid and everything that stands
    /// here.
    pub(crate) fn top(&self) -> f64 {
        let solid = self.gaps().next_back().map_or(f64::INFINITY, |gap| gap.bottom);
        match self.kind {
            TileKind::Open | TileKind::Wall(_) | TileKind::Mirror(_) => solid,
            _ => solid.max(self.top_of_what_stands()),
        }
    }

    /// The height up to which a door, glass, a mask or a shape reaches here.
    pub fn top_of_what_stands(&self) -> f64 {
        let Heights { floor, ceiling, .. } = self.heights;
        match (self.kind, self.ceiling) {
            (TileKind::Shape(Shape { height: Some(height), .. }), Ceiling::Sky) => {
                floor + height.cells()
            }
            (TileKind::Shape(Shape { height: Some(height), .. }), Ceiling::Covered(_)) => {
                ceiling.min(floor + height.cells())
            }
            _ => ceiling,
        }
    }

    /// Returns whether its floor is at 0, and its ceiling, or the wall or shape itself, is one cell
    /// higher.
    pub(crate) fn has_level_heights(&self) -> bool {
        let level = match self.kind {
            TileKind::Wall(_) | TileKind::Mirror(_) => Heights::LEVEL_WALL,
            _ => Heights::LEVEL,
        };
        let is_as_high = match self.kind {
            TileKind::Shape(_) => self.top_of_what_stands() == Heights::LEVEL.ceiling(),
            _ => true,
        };
        self.heights == level && is_as_high
    }

    /// Returns whether it is a mirror that shows an image. An opaque tint hides the whole image.
    pub(crate) fn reflects(&self) -> bool {
        matches!(self.kind, TileKind::Mirror(tint) if !tint.is_opaque())
    }

    /// Returns whether every ray through it passes neither above nor below anything, and is not
    /// reflected.
    pub(crate) fn is_level(&self) -> bool {
        self.has_level_heights() && !self.reflects()
    }
}

/// A wall that does not fill its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The place in its cell.
    pub outline: Outline,
    /// The surface. It repeats once along a line. Around a pillar, it repeats the number of times
    /// that fits best.
    pub paint: Paint,
    /// The height; `None` if it reaches up to the ceiling.
    pub height: Option<ShapeHeight>,
}

/// The height of a shape above the floor that it stands on, in cells: above 0, at most
/// [`Heights::MAX`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHeight(f64);

impl ShapeHeight {
    /// A height in cells. `None` outside that range.
    pub const fn new(cells: f64) -> Option<Self> {
        if cells > 0.0 && cells <= Heights::MAX { Some(Self(cells)) } else { None }
    }

    /// The height in cells.
    pub fn cells(self) -> f64 {
        self.0
    }
}

/// The outline of a shape from above.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outline {
    /// A circle in the middle of the cell.
    Pillar(PillarRadius),
    /// A line through the cell, without thickness.
    Line(Line),
}

/// The radius of a pillar, in cells: above 0, at most half a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PillarRadius(f64);

impl PillarRadius {
    /// A radius in cells. `None` outside that range.
    pub const fn new(cells: f64) -> Option<Self> {
        if cells > 0.0 && cells <= 0.5 { Some(Self(cells)) } else { None }
    }

    /// The radius in cells.
    pub fn cells(self) -> f64 {
        self.0
    }
}

/// A line through a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Line {
    /// The northern edge.
    North,
    /// The eastern edge.
    East,
    /// The southern edge.
    South,
    /// The western edge.
    West,
    /// Across the middle, from east to west.
    EastWest,
    /// Across the middle, from north to south.
    NorthSouth,
    /// From the north-western corner to the opposite corner.
    FromNorthWest,
    /// From the north-eastern corner to the opposite corner.
    FromNorthEast,
}

impl Line {
    /// All lines.
    pub const ALL: [Self; 8] = [
        Self::North,
        Self::East,
        Self::South,
        Self::West,
        Self::EastWest,
        Self::NorthSouth,
        Self::FromNorthWest,
        Self::FromNorthEast,
    ];

    /// The start of the line in `cell`.
    pub fn start(self, cell: Cell) -> DVec2 {
        let within = match self {
            Self::North | Self::West | Self::FromNorthWest => DVec2::ZERO,
            Self::East | Self::FromNorthEast => DVec2::X,
            Self::South => DVec2::Y,
            Self::EastWest => DVec2::new(0.0, 0.5),
            Self::NorthSouth => DVec2::new(0.5, 0.0),
        };
        cell.corner() + within
    }

    /// The vector from its start to its end, with components of −1, 0 or 1.
    pub fn stretch(self) -> DVec2 {
        match self {
            Self::North | Self::South | Self::EastWest => DVec2::X,
            Self::East | Self::West | Self::NorthSouth => DVec2::Y,
            Self::FromNorthWest => DVec2::ONE,
            Self::FromNorthEast => DVec2::new(-1.0, 1.0),
        }
    }
}

impl Outline {
    /// The distance of `point` from the outline in `cell`; negative inside a pillar.
    pub fn distance(self, cell: Cell, point: DVec2) -> f64 {
        match self {
            Self::Pillar(radius) => point.distance(cell.center()) - radius.0,
            Self::Line(line) => {
                let (offset, stretch) = (point - line.start(cell), line.stretch());
                let along = offset.dot(stretch) / stretch.length_squared();
                offset.distance(stretch * along.clamp(0.0, 1.0))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;

    fn gaps(covered: bool, floor: f64, ceiling: f64, roof: f64) -> Vec<(f64, f64)> {
        let paint = Paint::Color(Rgb::BLACK);
        let tile = Tile {
            character: ',',
            kind: TileKind::Open,
            floor: Covering::from(paint),
            ceiling: if covered { Ceiling::Covered(paint.into()) } else { Ceiling::Sky },
            light: None,
            heights: Heights::new(floor, ceiling, roof).unwrap(),
            riser: paint,
            lintel: paint,
            effect: None,
        };
        tile.gaps().map(|gap| (gap.bottom, gap.top)).collect()
    }

    #[test]
    fn gaps_lie_between_floor_ceiling_and_roof() {
        let sky = f64::INFINITY;
        assert_eq!(gaps(false, 0.25, 1.0, 1.0), [(0.25, sky)]);
        assert_eq!(gaps(true, 0.25, 1.0, 1.5), [(0.25, 1.0), (1.5, sky)]);
        assert_eq!(gaps(true, 1.0, 1.0, 1.0), [(1.0, sky)]);
        assert_eq!(gaps(true, 3.0, 1.0, 1.0), [(3.0, sky)]);
        assert_eq!(gaps(true, 0.0, 2.0, 1.0), [(0.0, 2.0), (2.0, sky)]);
    }

    #[test]
    fn heights_are_finite_and_not_absurd() {
        assert!(Heights::new(-1e9, 1e-9, 1e9).is_some());
        for absurd in [1.1e9, -1.1e9, f64::INFINITY, f64::NAN] {
            assert_eq!(Heights::new(absurd, 1.0, 1.0), None);
            assert_eq!(Heights::new(0.0, absurd, 1.0), None);
            assert_eq!(Heights::new(0.0, 1.0, absurd), None);
        }
    }

    const CELL: Cell = Cell { column: 3, row: 5 };

    #[test]
    fn lines_stay_in_their_cells_and_all_differ() {
        let mut ends = Vec::new();
        for line in Line::ALL {
            let start = line.start(CELL);
            for end in [start, start + line.stretch()] {
                let within = end - DVec2::new(3.0, 5.0);
                assert!(within.cmpge(DVec2::ZERO).all() && within.cmple(DVec2::ONE).all());
                assert_eq!(Outline::Line(line).distance(CELL, end), 0.0, "{line:?}");
            }
            ends.push((start.to_array(), line.stretch().to_array()));
        }
        for (index, line) in ends.iter().enumerate() {
            assert!(!ends[..index].contains(line));
        }
    }

    #[test]
    fn distances_are_to_the_nearest_point() {
        let distance = |outline: Outline, x, y| outline.distance(CELL, DVec2::new(x, y));
        let pillar = Outline::Pillar(PillarRadius::new(0.25).unwrap());
        assert_eq!(distance(pillar, 5.5, 5.5), 1.75);
        assert_eq!(distance(pillar, 3.5, 5.5), -0.25);
        let line = Outline::Line(Line::EastWest);
        assert_eq!(distance(line, 3.75, 7.0), 1.5);
        assert_eq!(distance(line, 1.0, 5.5), 2.0);
        let diagonal = Outline::Line(Line::FromNorthEast);
        assert!((distance(diagonal, 3.0, 5.0) - 0.5_f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn a_pillar_fits_its_cell() {
        assert!(PillarRadius::new(0.5).is_some());
        for cells in [0.0, -0.1, 0.5_f64.next_up(), f64::NAN] {
            assert_eq!(PillarRadius::new(cells), None);
        }
        for cells in [0.0, -0.1, 1.1e9, f64::NAN] {
            assert_eq!(ShapeHeight::new(cells), None);
        }
    }
}
