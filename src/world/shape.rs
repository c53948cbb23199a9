//! Shapes: walls that do not fill their cell.
//!
//! A shape is a round pillar, or a line: a thin wall along an edge or across the middle of the
//! cell, or a diagonal. Each is a curve whose equation is solved as exactly as the lines of the
//! grid. Polygons were refused: a curve made of lines shows its corners, and a level of polygons
//! can no longer be drawn with characters.

use glam::DVec2;

use super::{Cell, Heights, Paint};

/// A wall that does not fill its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The place in its cell.
    pub outline: Outline,
    /// The surface. It repeats once along a line, and around a pillar as often as fits best.
    pub paint: Paint,
    /// The height; `None` if it reaches up to the ceiling.
    pub height: Option<ShapeHeight>,
}

/// The height of a shape above the floor that it stands on, in cells: above 0, at most
/// [`Heights::MOST`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHeight(f64);

impl ShapeHeight {
    /// A height in cells. `None` outside that range.
    pub const fn new(cells: f64) -> Option<Self> {
        if cells > 0.0 && cells <= Heights::MOST { Some(Self(cells)) } else { None }
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
    /// From the north-western corner to the one opposite.
    FromNorthWest,
    /// From the north-eastern corner to the one opposite.
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
        DVec2::new(f64::from(cell.column), f64::from(cell.row)) + within
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

    const CELL: Cell = Cell { column: 3, row: 5 };

    #[test]
    fn lines_are_in_their_cells_and_no_two_are_alike() {
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
