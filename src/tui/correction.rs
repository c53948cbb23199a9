//! Contrast: corrections of a picture for players who see contrast poorly or cannot tell red from green, and outlines
//! of things in pictures without colours.
//!
//! A correction changes pixels before they become cells of any depth. It depends only on the picture, so that a still
//! picture stays still. An outline sets a thing apart from any surface. Without it, a guard a few pixels wide is lost
//! among the dots and characters of the wall behind, whatever its brightness.

use serde::{Deserialize, Serialize};

use crate::color::Rgb;
use crate::render::{Frame, FrameSize, Surface};

/// A correction of the picture for the player's eyesight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Correction {
    /// No correction.
    #[default]
    None,
    /// Edges and things stand out from their surroundings.
    Contrast,
    /// Reds and greens differ in blue, too, and edges stand out.
    RedGreen,
}

impl Correction {
    /// Corrects the pixels of `frame`, whose cells have `pixels_per_cell` columns and rows of pixels. `luma` is
    /// scratch memory that each call reuses.
    pub(crate) fn apply(self, frame: &mut Frame, pixels_per_cell: [u32; 2], luma: &mut Vec<u8>) {
        if self == Self::None {
            return;
        }
        if self == Self::RedGreen {
            frame.rows_mut().flatten().for_each(|pixel| *pixel = apart(*pixel));
        }
        luma.clear();
        luma.extend(frame.rows().flatten().map(|pixel| pixel.luma()));
        let (width, height) = (frame.width(), frame.height());
        let luma = |x: u32, y: u32| luma[(y * width + x) as usize];
        for (y, row) in (0..).zip(frame.rows_mut()) {
            for (x, pixel) in (0..).zip(row) {
                *pixel =
                    raised(*pixel, local_contrast([width, height], luma, [x, y], pixels_per_cell));
            }
        }
    }
}

/// The difference in luma between the pixel at `place` and the mean of the pixels around it. A cell is
/// `pixels_per_cell` wide and high. The eight pixels around it are three columns of cells and one and a half rows of
/// cells away.
pub(crate) fn local_contrast(
    size: [u32; 2],
    luma: impl Fn(u32, u32) -> u8,
    place: [u32; 2],
    pixels_per_cell: [u32; 2],
) -> i32 {
    let [columns, rows] = pixels_per_cell;
    let reach = [3 * columns, 3 * rows / 2];
    let [xs, ys] = [0, 1].map(|axis| {
        let at = place[axis];
        [at.saturating_sub(reach[axis]), at, at + reach[axis]].map(|at| at.min(size[axis] - 1))
    });
    let luma = |at: usize| i32::from(luma(xs[at % 3], ys[at / 3]));
    let around: i32 = (0..9).filter(|&at| at != 4).map(luma).sum();
    luma(4) - around / 8
}

/// `color`, made lighter or darker by `by` steps of luma. The result has between a third and twice the luma of
/// `color`.
pub(crate) fn raised(color: Rgb, by: i32) -> Rgb {
    let luma = i32::from(color.luma());
    let wanted = (luma + by).clamp(luma / 3, 2 * luma + 1);
    let scaled = |channel: u8| (i32::from(channel) * wanted / luma.max(1)).min(255) as u8;
    let [red, green, blue] = color.channels().map(scaled);
    Rgb::new(red, green, blue)
}

/// `color` with more blue if it is more red than green, and with less blue if it is more green than red. People
/// without red or green cones see blue.
///
/// Rejected: moving the lost part of red and green to green and blue (Fidaner and others, 2005). Two of six simulated
/// pairs become more alike.
fn apart(color: Rgb) -> Rgb {
    let [red, green, blue] = color.channels();
    let moved = (i32::from(red) - i32::from(green)) * 7 / 10;
    Rgb::new(red, green, (i32::from(blue) + moved).clamp(0, 255) as u8)
}

/// A side of the edge between a thing and its background.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// The outermost pixels of the thing.
    Inner,
    /// The pixels next to the thing.
    Outer,
}

/// The side of a thing's edge on which a pixel is, if it is next to an edge. The edge of the frame is not an edge of
/// a thing.
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
    use crate::color::blindness::{BLIND, distance};
    use crate::render::{FrameSize, PixelAspect};

    #[test]
    fn reds_and_greens_of_one_lightness_differ_for_the_red_green_blind() {
        let pairs = [
            [Rgb::new(200, 60, 40), Rgb::new(110, 120, 30)],
            [Rgb::new(150, 80, 60), Rgb::new(90, 105, 60)],
            [Rgb::new(90, 160, 60), Rgb::new(190, 120, 60)],
        ];
        for pair in pairs {
            for blind in &BLIND {
                let apart = distance(pair.map(apart), blind);
                assert!(apart > distance(pair, blind) + 0.02, "{pair:?}");
            }
        }
        let grey = Rgb::new(90, 90, 90);
        let [red, green, blue] = apart(grey).channels();
        assert!(red.abs_diff(green) < 3 && red.abs_diff(blue) < 3);
    }

    #[test]
    fn an_edge_stands_out_and_a_flat_wall_stays() {
        let size = FrameSize::new(16, 4).unwrap();
        let mut frame = Frame::new(size, PixelAspect::SQUARE);
        for row in frame.rows_mut() {
            row[..8].fill(Rgb::new(80, 60, 40));
            row[8..].fill(Rgb::new(110, 90, 70));
        }
        Correction::Contrast.apply(&mut frame, [1, 2], &mut Vec::new());
        assert_eq!(frame.pixel(0, 1), Rgb::new(80, 60, 40));
        assert!(frame.pixel(7, 1).luma() < 60 && frame.pixel(8, 1).luma() > 96);
    }

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
