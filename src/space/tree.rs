//! A bounding volume hierarchy over the bodies in view, for scenes in which many bodies overlap on the
//! screen.
//!
//! Each node has a box around its bodies (Rubin and Whitted, "A 3-Dimensional Representation for
//! Fast Rendering of Complex Scenes", 1980). A ray visits the nearer box first, and skips boxes
//! that begin beyond the nearest hit that it has found. A node is split at the median of its
//! centers along the axis on which they differ most. Rejected: the surface area heuristic. The tree
//! is built for each frame, and the heuristic takes longer.

use std::ops::Range;

use glam::DVec3;

use super::relative_shape::{RelativeBlock, RelativeShape};

/// The largest number of bodies of a node without children.
const MAX_IN_LEAF: usize = 4;
/// The distance of a box from its body, as a fraction of their largest coordinate. It exceeds any
/// rounding error in a test of a ray against a body.
const MARGIN: f64 = 1e-9;

/// The tree over some shapes, which are identified by their indices. Its memory is reused.
#[derive(Clone, Debug, Default)]
pub(crate) struct Tree {
    /// A node comes before its first child, which comes before the second one.
    nodes: Vec<Node>,
    /// The bounded shapes. The shapes of a node are next to each other.
    leaves: Vec<TreeLeaf>,
    /// The indices of planes.
    unbounded: Vec<usize>,
}

#[derive(Clone, Debug)]
struct Node {
    bounds: RelativeBlock,
    leaves: Range<usize>,
    /// The index of the second child; `None` if there are no children.
    second_child: Option<usize>,
}

#[derive(Clone, Copy, Debug)]
struct TreeLeaf {
    index: usize,
    bounds: RelativeBlock,
}

/// The nearest hit that the search for a ray has found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Nearest {
    pub(crate) t: f64,
    /// The index of the shape.
    pub(crate) index: usize,
}

impl Tree {
    /// Removes all shapes.
    pub(crate) fn clear(&mut self) {
        self.nodes.clear();
        self.leaves.clear();
        self.unbounded.clear();
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.nodes.is_empty() && self.unbounded.is_empty()
    }

    /// Builds the tree over `shapes`, whose indices are their positions.
    pub(crate) fn build<'s>(&mut self, shapes: impl Iterator<Item = &'s RelativeShape>) {
        self.clear();
        for (index, shape) in shapes.enumerate() {
            match bounds(shape) {
                Some(bounds) => self.leaves.push(TreeLeaf { index, bounds }),
                None => self.unbounded.push(index),
            }
        }
        if !self.leaves.is_empty() {
            self.add_node(0..self.leaves.len());
        }
    }

    /// The nearest hit of the ray in this direction. `distance` returns the distance of a shape. If
    /// several hits are at the same distance, the hit with the lowest index is returned.
    pub(crate) fn nearest(
        &self,
        direction: DVec3,
        mut distance: impl FnMut(usize) -> Option<f64>,
    ) -> Option<Nearest> {
        let mut search = Search { direction, distance: &mut distance, nearest: None };
        self.unbounded.iter().for_each(|&index| search.test(index));
        if let Some(enter) = self.nodes.first().and_then(|root| enter(&root.bounds, direction)) {
            self.visit(0, enter, &mut search);
        }
        search.nearest
    }

    /// Adds the node of these leaves, and its children.
    fn add_node(&mut self, range: Range<usize>) {
        let leaves = &mut self.leaves[range.clone()];
        let index = self.nodes.len();
        let bounds = union(leaves);
        self.nodes.push(Node { bounds, leaves: range.clone(), second_child: None });
        if leaves.len() <= MAX_IN_LEAF {
            return;
        }
        let middle = leaves.len() / 2;
        let axis = widest_axis(leaves);
        let place = |leaf: &TreeLeaf| (leaf.bounds.low + leaf.bounds.high).dot(axis);
        leaves.select_nth_unstable_by(middle, |one, other| place(one).total_cmp(&place(other)));
        self.add_node(range.start..range.start + middle);
        self.nodes[index].second_child = Some(self.nodes.len());
        self.add_node(range.start + middle..range.end);
    }

    /// Tests the shapes of a node that the ray enters at `entered`.
    fn visit<D>(&self, index: usize, entered: f64, search: &mut Search<'_, D>)
    where
        D: FnMut(usize) -> Option<f64>,
    {
        if search.nearest.is_some_and(|nearest| nearest.t < entered) {
            return;
        }
        let node = &self.nodes[index];
        let Some(second) = node.second_child else {
            self.leaves[node.leaves.clone()].iter().for_each(|leaf| search.test(leaf.index));
            return;
        };
        let children = [index + 1, second]
            .map(|child| (child, enter(&self.nodes[child].bounds, search.direction)));
        let is_second_nearer = matches!(children, [(_, Some(one)), (_, Some(two))] if two < one);
        let [one, other] = children;
        for (child, enter) in if is_second_nearer { [other, one] } else { [one, other] } {
            if let Some(enter) = enter {
                self.visit(child, enter, search);
            }
        }
    }
}

/// A search for the nearest hit of a ray.
struct Search<'d, D> {
    direction: DVec3,
    distance: &'d mut D,
    nearest: Option<Nearest>,
}

impl<D: FnMut(usize) -> Option<f64>> Search<'_, D> {
    fn test(&mut self, index: usize) {
        let Some(t) = (self.distance)(index) else { return };
        let is_nearer = |before: Nearest| t < before.t || t == before.t && index < before.index;
        if self.nearest.is_none_or(is_nearer) {
            self.nearest = Some(Nearest { t, index });
        }
    }
}

/// The distance at which a ray in this direction enters a box, negative if it starts inside; `None`
/// if it misses the box.
fn enter(bounds: &RelativeBlock, direction: DVec3) -> Option<f64> {
    let (enters, leaves) = bounds.crossings(direction);
    let (enter, leave) = (enters.max_element(), leaves.min_element());
    (enter <= leave && leave >= 0.0).then_some(enter)
}

/// The box around a shape; `None` for a plane.
fn bounds(shape: &RelativeShape) -> Option<RelativeBlock> {
    let (low, high) = match shape {
        RelativeShape::Plane(_) => return None,
        RelativeShape::Sphere(sphere) => {
            (sphere.center - sphere.radius, sphere.center + sphere.radius)
        }
        RelativeShape::Block(block) => (block.low, block.high),
    };
    let margin = DVec3::splat(MARGIN * low.abs().max(high.abs()).max_element());
    Some(RelativeBlock { low: low - margin, high: high + margin })
}

fn union(leaves: &[TreeLeaf]) -> RelativeBlock {
    let low = leaves.iter().fold(DVec3::INFINITY, |low, leaf| low.min(leaf.bounds.low));
    let high = leaves.iter().fold(DVec3::NEG_INFINITY, |high, leaf| high.max(leaf.bounds.high));
    RelativeBlock { low, high }
}

/// The axis along which the centers differ most.
fn widest_axis(leaves: &[TreeLeaf]) -> DVec3 {
    let centers = leaves.iter().map(|leaf| leaf.bounds.low + leaf.bounds.high);
    let low = centers.clone().fold(DVec3::INFINITY, DVec3::min);
    let extent = centers.fold(DVec3::NEG_INFINITY, DVec3::max) - low;
    let widest = DVec3::AXES.into_iter().max_by(|a, b| a.dot(extent).total_cmp(&b.dot(extent)));
    widest.unwrap_or(DVec3::X)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::space::{Block, BodyShape, Plane, Sphere};

    /// Points on a coarse grid, so that bodies share surfaces.
    fn point(reach: i32) -> impl Strategy<Value = DVec3> {
        [-reach..=reach, -reach..=reach, -reach..=reach]
            .prop_map(|place| DVec3::from_array(place.map(|it| f64::from(it) / 2.0)))
    }

    fn shape() -> impl Strategy<Value = BodyShape> {
        prop_oneof![
            8 => (point(12), 1..6).prop_filter_map("a sphere", |(center, radius)| {
                Sphere::new(center, f64::from(radius) / 2.0).map(BodyShape::Sphere)
            }),
            8 => (point(12), point(12)).prop_filter_map("a box", |(corner, opposite)| {
                Block::new(corner, opposite).map(BodyShape::Block)
            }),
            1 => (point(12), point(2)).prop_filter_map("a plane", |(point, normal)| {
                Plane::new(point, normal).map(BodyShape::Plane)
            }),
        ]
    }

    proptest! {
        #[test]
        fn a_tree_finds_the_same_body_as_brute_force(
            shapes in prop::collection::vec(shape(), 0..60),
            origin in point(14),
            directions in prop::collection::vec(point(5), 1..20),
            scale in prop_oneof![Just(1.0), Just(1e-6), Just(1e6), 0.1..10.0],
        ) {
            let shapes: Vec<RelativeShape> =
                shapes.iter().map(|shape| RelativeShape::new(shape, origin)).collect();
            let mut tree = Tree::default();
            tree.build(shapes.iter());
            for direction in directions.into_iter().filter(|&it| it != DVec3::ZERO) {
                let direction = direction * scale;
                let distance = |index: usize| shapes[index].distance(direction);
                let hits = (0..shapes.len())
                    .filter_map(|index| Some(Nearest { t: distance(index)?, index }));
                let expected = hits.min_by(|one, other| one.t.partial_cmp(&other.t).unwrap());
                prop_assert_eq!(tree.nearest(direction, distance), expected);
            }
        }
    }
}
