//! Outlines of things, for pictures without colours.
//!
//! A guard a few pixels wide is lost among the dots and characters of the wall behind, whatever its
//! brightness. An outline sets it apart from any surface.

use crate::render::{FrameSize, Surface};

/// A side of the edge between a thing and what is behind it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// The outermost pixels of the thing.
    Inner,
    /// The pixels next to the thing.
    Outer,
}

/// The side of an edge of a thing on which a pixel is, if it is next to one. The edge of the frame
/// is not an edge of a thing.
pub(crate) fn outline(
    frame: FrameSize,
    surface: impl Fn(u32, u32) -> Option<Surface>,
    x: u32,
    y: u32,
) -> Option<Edge> {
    let [last_x, last_y] = [frame.width, frame.height].map(|length| length.get() - 1);
    let is_thing = |x: u32, y: u32| surface(x.min(last_x), y.min(last_y)) == Some(Surface::Thing);
    let own = is_thing(x, y);
    let neighbours = [(x.saturating_sub(1), y), (x + 1, y), (x, y.saturating_sub(1)), (x, y + 1)];
    let is_at_edge = neighbours.into_iter().any(|(x, y)| is_thing(x, y) != own);
    is_at_edge.then_some(if own { Edge::Inner } else { Edge::Outer })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_edge_of_a_thing_has_two_sides() {
        let frame = FrameSize::new(9, 9).unwrap();
        let surface = |x: u32, y: u32| {
            let is_thing = (4..9).contains(&x) && (4..9).contains(&y);
            Some(if is_thing { Surface::Thing } else { Surface::WallX })
        };
        for (at, expected) in
            [(2, None), (3, Some(Edge::Outer)), (4, Some(Edge::Inner)), (5, None), (8, None)]
        {
            assert_eq!(outline(frame, surface, at, 6), expected, "{at}");
            assert_eq!(outline(frame, surface, 6, at), expected, "{at}");
        }
        assert_eq!(outline(frame, |_, _| None, 4, 6), None);
    }
}
