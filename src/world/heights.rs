//! Heights of floors, ceilings and walls, and the gaps between them.
//!
//! A cell is a solid column with gaps: one between floor and ceiling and one above the roof, or a
//! single one under the sky or above a low wall. Drawing, walking and falling use the gaps, and
//! need not know which kind of tile makes them. A list of solid blocks for each cell was refused:
//! floor, ceiling and roof describe all that the levels of a raycaster need, with at most two gaps.

use super::{Ceiling, Shape, Tile, TileKind};

/// The heights of a tile, in cells above the map's own floor: finite, and at most [`Heights::MOST`]
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
    /// The same as a solid wall.
    pub const LEVEL_WALL: Self = Self { floor: 1.0, ..Self::LEVEL };
    /// The largest absolute value of a height.
    pub const MOST: f64 = 1e9;

    /// Heights of a floor, a ceiling and a roof. `None` if one of them is out of range.
    pub fn new(floor: f64, ceiling: f64, roof: f64) -> Option<Self> {
        let is_in_range = |height: f64| height.abs() <= Self::MOST;
        // Adding zero removes the sign of a negative zero.
        let heights = Self { floor: floor + 0.0, ceiling: ceiling + 0.0, roof: roof + 0.0 };
        [floor, ceiling, roof].into_iter().all(is_in_range).then_some(heights)
    }

    /// The height of the floor; of a wall, that of its top.
    pub fn floor(self) -> f64 {
        self.floor
    }

    /// The height of the ceiling, or under the sky where it would be. Doors, glass and masks reach
    /// up to it.
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

    /// Whether `height` is in the gap or at one of its ends.
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

    /// The height above which there is nothing: the top of all that is solid or stands here.
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Rgb;
    use crate::world::{Covering, Paint, TileKind};

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
    fn gaps_are_what_floor_ceiling_and_roof_leave() {
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
}
