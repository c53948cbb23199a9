//! Faces: the upright surfaces in view, each found once for all of its columns.

use std::ops::Range;

use glam::DVec2;

use crate::cast::{Hit, MirrorTransform, Ray, Side, cell_before};
use crate::world::{Cell, FaceLight, Glass, Grid, Outline, Paint, TextureId, TileId};

/// Neighbouring columns that show one upright surface.
#[derive(Clone, Debug)]
pub(crate) struct Face {
    pub(crate) columns: Range<usize>,
    /// The index of its first face column. The others follow.
    pub(crate) first: usize,
    pub(crate) facing: Facing,
    pub(crate) material: Material,
    /// The light along one cell of the face.
    pub(crate) light: FaceLight,
    /// The heights of its bottom and its top.
    pub(crate) bottom: f64,
    pub(crate) top: f64,
    /// The image in which it is seen.
    pub(crate) image: MirrorTransform,
}

/// A column of a face.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceColumn {
    pub(crate) rows: Rows,
    pub(crate) t: f64,
    pub(crate) u: f64,
}

/// A range of rows of pixels, empty if the end is not below the start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rows {
    pub(crate) start: u32,
    pub(crate) end: u32,
}

/// The look of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Material {
    Opaque(Paint),
    /// A texture with holes.
    Masked(TextureId),
    /// A tint.
    Translucent(Glass),
}

/// The direction of a face on the map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Facing {
    /// Perpendicular to a side of a cell.
    Side(Side),
    /// Along a vector of length 1, in either direction.
    Normal(DVec2),
    /// Away from an axis at this point.
    Around(DVec2),
}

impl Rows {
    pub(crate) const NONE: Self = Self { start: 0, end: 0 };

    pub(crate) fn is_empty(self) -> bool {
        self.start >= self.end
    }

    /// The rows that are in both.
    #[inline]
    pub(crate) fn and(self, other: Self) -> Self {
        Self { start: self.start.max(other.start), end: self.end.min(other.end) }
    }

    /// The rows that are in both ranges, as a range that does not end before its start.
    #[inline]
    pub(crate) fn within(self, rows: &Range<u32>) -> Range<u32> {
        let start = self.start.max(rows.start);
        start..self.end.min(rows.end).max(start)
    }
}

impl Facing {
    /// The facing of a shape in `cell`.
    pub(crate) fn of_shape(outline: Outline, cell: Cell) -> Self {
        match outline {
            Outline::Line(line) => Self::Normal(line.stretch().perp().normalize()),
            Outline::Pillar(_) => Self::Around(cell.center()),
        }
    }

    /// The normal of length 1, in either direction, at `point` on the face.
    pub(crate) fn normal(self, point: DVec2) -> DVec2 {
        match self {
            Self::Side(Side::X) => DVec2::X,
            Self::Side(Side::Y) => DVec2::Y,
            Self::Normal(normal) => normal,
            Self::Around(axis) => (point - axis).normalize_or_zero(),
        }
    }
}

/// A side of a cell through which straight rays from one origin enter it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CellFace {
    /// The kind of line that the rays cross.
    pub(crate) side: Side,
    /// The column and the row of the cell along the straight rays. Mirrors repeat the map
    /// along these rays.
    pub(crate) place: [i64; 2],
    /// `true` if the rays cross the line to the east or to the south.
    pub(crate) is_ahead: bool,
}

impl CellFace {
    /// The coordinate of its line.
    #[inline]
    pub(crate) fn line(&self) -> i64 {
        self.place[self.side as usize] + i64::from(!self.is_ahead)
    }

    /// The column or row along the line.
    #[inline]
    fn along(&self) -> i64 {
        self.place[self.side.other() as usize]
    }

    /// The north or west end.
    #[inline]
    pub(crate) fn corner(&self) -> DVec2 {
        let (line, along) = (self.line() as f64, self.along() as f64);
        match self.side {
            Side::X => DVec2::new(line, along),
            Side::Y => DVec2::new(along, line),
        }
    }

    /// The cell from which the rays come.
    pub(crate) fn place_before(&self) -> [i64; 2] {
        let mut place = self.place;
        place[self.side as usize] += if self.is_ahead { -1 } else { 1 };
        place
    }

    /// Returns true if the rays see the north or west end on the left.
    #[inline]
    fn is_from_left(&self) -> bool {
        self.is_ahead == (self.side == Side::X)
    }

    /// The end on the left, as rays see it.
    #[inline]
    pub(crate) fn left_end(&self) -> DVec2 {
        if self.is_from_left() { self.corner() } else { self.other_end() }
    }

    /// The end on the right, as rays see it.
    #[inline]
    pub(crate) fn right_end(&self) -> DVec2 {
        if self.is_from_left() { self.other_end() } else { self.corner() }
    }

    #[inline]
    fn other_end(&self) -> DVec2 {
        match self.side {
            Side::X => self.corner() + DVec2::Y,
            Side::Y => self.corner() + DVec2::X,
        }
    }

    /// Returns true if `other` is on the same line.
    #[inline]
    pub(crate) fn is_in_line_with(&self, other: &Self) -> bool {
        self.side == other.side && self.is_ahead == other.is_ahead && self.line() == other.line()
    }

    /// Returns true if `other` is on the same line and belongs to a neighbouring cell.
    #[inline]
    pub(crate) fn is_beside(&self, other: &Self) -> bool {
        self.is_in_line_with(other) && self.along().abs_diff(other.along()) == 1
    }

    /// The distance from `point` to the line.
    #[inline]
    pub(crate) fn distance_to_line(&self, point: DVec2) -> f64 {
        (self.line() as f64 - point[self.side as usize]).abs()
    }
}

/// The cell from which a ray along `direction` sees the side of `hit`, and its tile; `None` off the map.
pub(crate) fn cell_in_front(grid: &Grid, direction: DVec2, hit: &Hit) -> Option<(Cell, TileId)> {
    let [column, row] = cell_before(direction, hit.cell, hit.side);
    grid.cell(column, row)
}

/// The ray on the map that an image shows as the straight ray from `origin` along `direction`.
pub(crate) fn on_map(image: MirrorTransform, origin: DVec2, direction: DVec2) -> Ray {
    Ray::moved(image.to_map(origin), image.direction_to_map(direction))
}
