//! Compares every pixel of a frame with an independent calculation.
//!
//! [`Solids`] is a world as a list of solids. The calculation tests the line through the middle of a pixel
//! against all of them. It is some thousand times slower than the renderer, and shares with it only what the
//! map says: tiles, textures, sprites, the light in each cell, and the camera.
//!
//! A pixel is *right* if none of its channels differs by more than one unit. A pixel that differs is *in doubt* if
//! points up to [`DOUBTFUL`] pixels beside its middle show something else, because rounding decides there;
//! otherwise it is *wrong*.
//!
//! ```
//! use cellcaster::map::builtin;
//! use cellcaster::render::FrameSize;
//! use cellcaster::world::FieldOfView;
//!
//! let world = builtin::LEVELS[0].world()?;
//! let camera = world.start_camera(FieldOfView::default());
//! let frame = cellcaster_certify::draw(&world, &camera, FrameSize::new(32, 18).unwrap());
//! let (counts, first) = cellcaster_certify::compare(&world, &camera, &frame);
//! assert_eq!((counts.pixels, counts.wrong, first), (32 * 18, 0, None));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The frame has the filter `nearest`, so that each pixel shows one texel. Animated things show their first
//! frame, and mirrors do not show the player.

mod solids;

use std::fmt;
use std::ops::AddAssign;

use cellcaster::color::Rgb;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, Figure, SpriteId, World};

pub use solids::{Met, Solids};

/// A pixel whose middle is at most this far from an edge, in pixels, is in doubt if it differs.
pub const DOUBTFUL: f64 = 1e-5;

/// The pixels of frames, by the result of their comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// The number of frames.
    pub frames: u64,
    /// The number of all pixels.
    pub pixels: u64,
    /// The number of pixels that differ where rounding decides.
    pub in_doubt: u64,
    /// The number of wrong pixels.
    pub wrong: u64,
}

/// Draws what `camera` sees of `world`, as [`compare`] expects it.
pub fn draw(world: &World, camera: &Camera, size: FrameSize) -> Frame {
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.render(&without_player(world, camera), camera, &mut frame);
    frame
}

/// Compares every pixel of `frame`, which shows `world` as `camera` sees it. Also describes the first wrong pixel.
pub fn compare(world: &World, camera: &Camera, frame: &Frame) -> (Counts, Option<String>) {
    let world = without_player(world, camera);
    let solids = Solids::of(&world, camera);
    let (mut counts, mut first) = (Counts { frames: 1, ..Counts::default() }, None);
    for (x, y) in (0..frame.height()).flat_map(|y| (0..frame.width()).map(move |x| (x, y))) {
        counts.pixels += 1;
        let drawn = frame.pixel(x, y);
        let color = meet(&solids, camera, frame, [x, y], [0.0; 2]).color;
        let [one, other] = [drawn, color].map(Rgb::channels);
        if (0..3).all(|channel| one[channel].abs_diff(other[channel]) <= 1) {
            continue;
        }
        match clear_color(&solids, camera, frame, [x, y]) {
            Some(expected) => {
                counts.wrong += 1;
                first.get_or_insert_with(|| format!("{drawn} instead of {expected} at {x},{y}"));
            }
            None => counts.in_doubt += 1,
        }
    }
    (counts, first)
}

/// The world with an invisible figure at the camera, in place of the player that mirrors would show.
fn without_player(world: &World, camera: &Camera) -> World {
    let mut world = world.clone();
    let (position, heading) = (camera.position(), camera.heading);
    let player = Figure { sprite: SpriteId(0), position, base: 0.0, heading, frame: 0, opacity: 0 };
    let figures = world.figures().to_vec();
    world.set_figures(figures.into_iter().chain([player]));
    world
}

/// The colour of a pixel; `None` if it is in doubt.
pub fn clear_color(
    solids: &Solids,
    camera: &Camera,
    frame: &Frame,
    pixel: [u32; 2],
) -> Option<Rgb> {
    let met = meet(solids, camera, frame, pixel, [0.0; 2]);
    let beside = [[-DOUBTFUL, 0.0], [DOUBTFUL, 0.0], [0.0, -DOUBTFUL], [0.0, DOUBTFUL]];
    let is_same = |offset| meet(solids, camera, frame, pixel, offset) == met;
    (!met.is_tied && beside.into_iter().all(is_same)).then_some(met.color)
}

/// The hits of the line at an `offset` from the middle of a pixel. The component of its direction along the camera's is 1.
fn meet(solids: &Solids, camera: &Camera, frame: &Frame, pixel: [u32; 2], offset: [f64; 2]) -> Met {
    let [x, y] = [0, 1].map(|axis| f64::from(pixel[axis]) + 0.5 + offset[axis]);
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    let focal_length = width / 2.0 / camera.field_of_view.half_width();
    let horizon = height / 2.0 + (camera.pitch.slope() * focal_length).round();
    let across = camera.direction() + camera.plane() * (2.0 * x / width - 1.0);
    solids.meet(across.extend((horizon - y) / focal_length))
}

impl AddAssign for Counts {
    fn add_assign(&mut self, other: Self) {
        self.frames += other.frames;
        self.pixels += other.pixels;
        self.in_doubt += other.in_doubt;
        self.wrong += other.wrong;
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, pixels, in_doubt, wrong } = self;
        write!(f, "{frames} frames, {pixels} pixels, {wrong} wrong, {in_doubt} in doubt")
    }
}
