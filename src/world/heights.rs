//! Heights: how high floors, ceilings and walls are, and the gaps that they leave.
//!
//! A cell is a column of rock with gaps in it: one between floor and ceiling, and one above the roof;
//! a single one under the sky; above a wall, if it is a low one. Whoever draws, walks or falls asks for
//! the gaps, and need not know what kind of tile makes them. A list of blocks for each cell was
//! refused: a floor, a ceiling and a roof say all that a raycaster's levels are made of, and there
//! are never more than two gaps.

use super::{Ceiling, Shape, Tile, TileKind};

/// How high the parts of a tile are, in cells above the map's own floor: finite, and within
/// [`Heights::MOST`] of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Heights {
    floor: f64,
    ceiling: f64,
    roof: f64,
}

/// What is open in a cell, from one height to another: empty space over a floor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// The height of what is below it.
    pub bottom: f64,
    /// The height of what is above it; infinite for the sky.
    pub top: f64,
}

impl Heights {
    /// A floor at 0, and all else a cell above it.
    pub const LEVEL: Self = Self { floor: 0.0, ceiling: 1.0, roof: 1.0 };
    /// The same, filled up to the ceiling by a wall.
    pub const LEVEL_WALL: Self = Self { floor: 1.0, ..Self::LEVEL };
    /// How far up or down anything may be.
    pub const MOST: f64 = 1e9;

    /// A floor, a ceiling and a roof at those heights. `None` where one of them is out of range.
    pub fn new(floor: f64, ceiling: f64, roof: f64) -> Option<Self> {
        let is_in_range = |height: f64| height.abs() <= Self::MOST;
        // Zero is added to be rid of its sign.
        let heights = Self { floor: floor + 0.0, ceiling: ceiling + 0.0, roof: roof + 0.0 };
        [floor, ceiling, roof].into_iter().all(is_in_range).then_some(heights)
    }

    /// The height of the floor; of a wall, that of its top.
    pub fn floor(self) -> f64 {
        self.floor
    }

    /// The height of the ceiling, or where it would be under the sky: doors, glass and walls with
    /// holes reach up to it.
    pub fn ceiling(self) -> f64 {
        self.ceiling
    }

    /// The height of the top of what hangs above the ceiling.
    pub fn roof(self) -> f64 {
        self.roof
    }
}

impl Gap {
    /// From the bottom to the top; infinite under the sky.
    pub fn height(self) -> f64 {
        self.top - self.bottom
    }

    /// Whether `height` is in it, its bottom and its top included.
    pub fn holds(self, height: f64) -> bool {
        (self.bottom..=self.top).contains(&height)
    }
}

impl Tile {
    /// What is open in a cell of this tile, from the lowest gap up: at least one, as nothing reaches
    /// up to the sky. Doors, glass and masks stand in a gap and are not counted as rock.
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

    /// Up to where a door, glass, a wall with holes or a shape stands here, from the floor.
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
