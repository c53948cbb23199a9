//! The mean light over each half of a cell.

use std::num::NonZeroU32;

use ratatui::layout::Size;

use cellcaster::cast::Side;
use cellcaster::color::srgb::{encoded, linear};
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::world::{Camera, World};

/// The factor by which the larger picture is wider and higher.
const SCALE: u32 = 8;

/// The halves of a window's cells, row by row.
pub(crate) struct Truth {
    pub(crate) halves: Vec<Half>,
}

/// The upper or the lower half of a cell.
#[derive(Clone, Copy)]
pub(crate) struct Half {
    /// The mean light in sRGB, not rounded, from 0 to 255.
    pub(crate) color: [f64; 3],
    /// Whether its samples show more than one surface.
    pub(crate) is_at_edge: bool,
}

/// What a sample shows: a surface, and for walls the line of the grid that they stand on.
type Shown = (Option<Surface>, Option<(Side, u32)>);

impl Truth {
    /// The view of `camera` in a window of `size` cells.
    pub(crate) fn new(world: &World, camera: &Camera, size: Size) -> Self {
        let (width, height) = (u32::from(size.width), 2 * u32::from(size.height));
        let scaled = |side: u32| NonZeroU32::new(side * SCALE).unwrap_or(NonZeroU32::MIN);
        let scaled = FrameSize { width: scaled(width), height: scaled(height) };
        let mut renderer = Renderer::new();
        renderer.set_filter(Filter::Nearest);
        renderer.keep_surfaces(true);
        let mut frame = Frame::new(scaled, PixelAspect::SQUARE);
        renderer.render(world, camera, &mut frame);
        let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self { halves: places.map(|(x, y)| half(&renderer, &frame, x, y)).collect() }
    }
}

fn half(renderer: &Renderer, frame: &Frame, x: u32, y: u32) -> Half {
    let samples = || {
        let rows = SCALE * y..SCALE * (y + 1);
        rows.flat_map(|y| (SCALE * x..SCALE * (x + 1)).map(move |x| (x, y)))
    };
    let mut light = [0.0; 3];
    for (x, y) in samples() {
        for (sum, channel) in light.iter_mut().zip(linear(frame.pixel(x, y))) {
            *sum += channel;
        }
    }
    let first = shown(renderer, SCALE * x, SCALE * y);
    Half {
        color: light.map(|sum| 255.0 * encoded(sum / f64::from(SCALE * SCALE))),
        is_at_edge: samples().any(|(x, y)| shown(renderer, x, y) != first),
    }
}

fn shown(renderer: &Renderer, x: u32, y: u32) -> Shown {
    let surface = renderer.surface(x, y);
    let is_wall = matches!(surface, Some(Surface::WallX | Surface::WallY));
    let hit = renderer.columns().get(x as usize).and_then(|column| column.hit);
    let line = hit.filter(|_| is_wall).map(|hit| match hit.side {
        Side::X => (hit.side, hit.cell.column),
        Side::Y => (hit.side, hit.cell.row),
    });
    (surface, line)
}
