//! Whether a segment meets what stands in a cell: a pillar, a thin wall or the leaf of a door.
//!
//! - The ends of a segment are exact, unlike a [`Ray`](super::Ray) between them, whose direction is rounded.
//! - A segment that touches an obstacle meets it. A segment along a thin wall does not.
//! - A segment has a height at each end, and meets an obstacle only where it is at most as high.
//! - The result is exact. One formula serves doubles, and integers of any length where the rounding of doubles might
//!   change the sign.

use std::ops::{Add, Mul, Sub};

use glam::DVec2;
use num_bigint::BigInt;

use super::pillar::{in_units, unit_of};
use super::through::Leaf;
use crate::world::{Cell, Outline, Tile, TileKind, World};

/// A line between two points at given heights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    /// The ends, in cells.
    pub(crate) ends: [DVec2; 2],
    /// The heights of the ends.
    pub(crate) heights: [f64; 2],
}

/// An object that stands in a cell and does not fill it.
#[derive(Clone, Copy, Debug)]
enum Obstacle {
    Pillar {
        center: DVec2,
        radius: f64,
    },
    /// A thin wall or the leaf of a door, between two ends that differ.
    Line([DVec2; 2]),
}

impl Obstacle {
    fn in_cell(world: &World, cell: Cell, kind: TileKind) -> Option<Self> {
        match kind {
            TileKind::Door(_) => {
                let Leaf { start, end, .. } = Leaf::new(world.grid(), cell, world.opening(cell));
                (start != end).then_some(Self::Line([start, end]))
            }
            TileKind::Shape(shape) => Some(match shape.outline {
                Outline::Pillar(radius) => {
                    Self::Pillar { center: cell.center(), radius: radius.cells() }
                }
                Outline::Line(line) => {
                    let start = line.start(cell);
                    Self::Line([start, start + line.stretch()])
                }
            }),
            _ => None,
        }
    }
}

impl Segment {
    /// Whether it meets the door or the shape of `tile` in `cell`.
    pub(crate) fn meets(&self, world: &World, cell: Cell, tile: &Tile) -> bool {
        /// Covers the rounding of all operations together, as a share of the sum of all terms.
        const ROUNDING: f64 = 64.0 * f64::EPSILON;
        let Some(obstacle) = Obstacle::in_cell(world, cell, tile.kind) else { return false };
        let highest = self.heights[0].max(self.heights[1]);
        let top = tile.top_of_what_stands().min(highest);
        if self.heights.into_iter().all(|height| height > top) {
            return false;
        }
        // The second term covers the loss by underflow.
        let is_clear =
            |&(depth, terms): &(f64, f64)| depth.abs() > terms * ROUNDING + f64::MIN_POSITIVE;
        match self.depth(obstacle, top, |it| it, |it| it).filter(is_clear) {
            Some((depth, _)) => depth > 0.0,
            None => self.meets_by_integers(obstacle, top),
        }
    }

    #[cold]
    fn meets_by_integers(&self, obstacle: Obstacle, top: f64) -> bool {
        let [from, to] = self.ends;
        let (one, other) = match obstacle {
            Obstacle::Pillar { center, radius } => (center, DVec2::splat(radius)),
            Obstacle::Line([start, end]) => (start, end),
        };
        let lengths = [from, to, one, other].map(|it| it.to_array());
        let unit = unit_of(lengths.as_flattened());
        let unit_of_heights = unit_of(&[self.heights[0], self.heights[1], top, 1.0]);
        let length = |it| in_units(it, unit);
        let height = |it| in_units(it, unit_of_heights);
        self.depth(obstacle, top, length, height).is_some_and(|(depth, _)| depth >= BigInt::ZERO)
    }

    /// A number that is at least 0 if the segment meets `obstacle`, which reaches up to `top`, and the sum of the
    /// magnitudes of all terms. `None` if both are parallel. At least one end is not above `top`.
    #[inline]
    fn depth<N: Number>(
        &self,
        obstacle: Obstacle,
        top: f64,
        length: impl Fn(f64) -> N,
        height: impl Fn(f64) -> N,
    ) -> Option<(N, N)> {
        let point = |it: DVec2| [length(it.x), length(it.y)];
        let [from, to] = self.ends.map(point);
        let direction = minus(to, from.clone());
        let [first, last, whole] = self.part_below(top, height);
        match obstacle {
            Obstacle::Pillar { center, radius } => {
                let (to_center, radius) = (minus(point(center), from), length(radius));
                let (reach, square) = (radius.clone() * radius, dot(&direction, &direction));
                let nearest = dot(&to_center, &direction) * whole.clone();
                let end = if nearest <= first.clone() * square.clone() {
                    first
                } else if nearest >= last.clone() * square.clone() {
                    last
                } else {
                    let miss = perp_dot(&to_center, &direction);
                    let (reach, far) =
                        (reach * square.clone(), dot(&to_center, &to_center) * square);
                    return Some((reach.clone() - miss.clone() * miss, reach + far));
                };
                let [to_center, moved] = [(to_center, &whole), (direction, &end)]
                    .map(|([x, y], factor)| [x * factor.clone(), y * factor.clone()]);
                let reach = reach * whole.clone() * whole;
                let terms = reach.clone() + dot(&to_center, &to_center) + dot(&moved, &moved);
                let offset = minus(to_center, moved);
                Some((reach - dot(&offset, &offset), terms.clone() + terms))
            }
            Obstacle::Line([start, end]) => {
                let [start, end] = [start, end].map(point);
                let (extent, to_start) = (minus(end, start.clone()), minus(start, from));
                let zero = length(0.0);
                let terms = [&to_start, &direction, &extent].map(|it| dot(it, it));
                let terms = terms.into_iter().fold(zero.clone(), N::add) * whole.clone();
                let across = perp_dot(&direction, &extent);
                // The distances of the crossing of both lines from their starts, in units of `across`.
                let along_segment = perp_dot(&to_start, &extent);
                let along_obstacle = perp_dot(&to_start, &direction);
                if across == zero {
                    return None;
                }
                let [across, along_segment, along_obstacle] = if across < zero {
                    [across, along_segment, along_obstacle].map(|it| zero.clone() - it)
                } else {
                    [across, along_segment, along_obstacle]
                };
                let along_segment = along_segment * whole.clone();
                let depths = [
                    along_segment.clone() - first * across.clone(),
                    last * across.clone() - along_segment,
                    along_obstacle.clone() * whole.clone(),
                    (across - along_obstacle) * whole,
                ];
                let least =
                    depths.into_iter().reduce(|one, other| if other < one { other } else { one });
                Some((least?, terms.clone() + terms))
            }
        }
    }

    /// The part of the segment that is not above `top`: the numerators of its ends, and their denominator.
    #[inline]
    fn part_below<N: Number>(&self, top: f64, height: impl Fn(f64) -> N) -> [N; 3] {
        let [one, other] = self.heights.map(|it| height(top) - height(it));
        let zero = height(0.0);
        if one < zero {
            let whole = other - one.clone();
            [zero - one, whole.clone(), whole]
        } else if other < zero {
            [zero, one.clone(), one - other]
        } else {
            [zero, height(1.0), height(1.0)]
        }
    }
}

trait Number:
    Clone + PartialOrd + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
}

impl Number for f64 {}
impl Number for BigInt {}

fn minus<N: Number>([x, y]: [N; 2], [other_x, other_y]: [N; 2]) -> [N; 2] {
    [x - other_x, y - other_y]
}

fn dot<N: Number>([x, y]: &[N; 2], [other_x, other_y]: &[N; 2]) -> N {
    x.clone() * other_x.clone() + y.clone() * other_y.clone()
}

fn perp_dot<N: Number>([x, y]: &[N; 2], [other_x, other_y]: &[N; 2]) -> N {
    x.clone() * other_y.clone() - y.clone() * other_x.clone()
}
