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

use std::num::NonZero;
use std::ops::{Add, Range};
use std::panic::resume_unwind;
use std::{fmt, thread};

use cellcaster::color::Rgb;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, Figure, Heading, SpriteId, World};
use glam::DVec3;

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

/// A pixel that differs from the calculation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongPixel {
    /// Its column, from the left.
    pub x: u32,
    /// Its row, from the top.
    pub y: u32,
    /// The colour in the frame.
    pub drawn: Rgb,
    /// The colour by the calculation.
    pub expected: Rgb,
}

/// Draws what `camera` sees of `world`, as [`compare`] expects it.
pub fn draw(world: &World, camera: &Camera, size: FrameSize) -> Frame {
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.render(&without_player(world, camera), camera, &mut frame);
    frame
}

/// Compares every pixel of `frame`, which shows `world` as `camera` sees it. Also returns the first wrong pixel.
pub fn compare(world: &World, camera: &Camera, frame: &Frame) -> (Counts, Option<WrongPixel>) {
    let world = without_player(world, camera);
    let solids = Solids::of(&world, camera);
    let threads = thread::available_parallelism().map_or(1, NonZero::get) as u32;
    let height = frame.height();
    let parts = (0..threads).map(|part| height * part / threads..height * (part + 1) / threads);
    let results: Vec<_> = thread::scope(|scope| {
        let workers: Vec<_> =
            parts.map(|rows| scope.spawn(|| compare_rows(&solids, camera, frame, rows))).collect();
        workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|it| resume_unwind(it)))
            .collect()
    });
    let counts =
        results.iter().fold(Counts { frames: 1, ..Counts::default() }, |sum, it| sum + it.0);
    (counts, results.iter().find_map(|it| it.1))
}

/// The world with an invisible figure at the camera, in place of the player that mirrors would show.
fn without_player(world: &World, camera: &Camera) -> World {
    let mut world = world.clone();
    let player = Figure {
        sprite: SpriteId(0),
        position: camera.position(),
        base: 0.0,
        heading: Heading::default(),
        frame: 0,
        opacity: 0,
    };
    let figures = world.figures().to_vec();
    world.set_figures(figures.into_iter().chain([player]));
    world
}

/// Compares the pixels of `rows`.
fn compare_rows(
    solids: &Solids,
    camera: &Camera,
    frame: &Frame,
    rows: Range<u32>,
) -> (Counts, Option<WrongPixel>) {
    let mut counts = Counts::default();
    let mut first = None;
    for (x, y) in rows.flat_map(|y| (0..frame.width()).map(move |x| (x, y))) {
        counts.pixels += 1;
        let (met, drawn) = (meet(solids, camera, frame, [x, y], [0.0; 2]), frame.pixel(x, y));
        if are_alike(drawn, met.color()) {
            continue;
        }
        match clear_color(solids, camera, frame, [x, y]) {
            Some(expected) => {
                counts.wrong += 1;
                first.get_or_insert(WrongPixel { x, y, drawn, expected });
            }
            None => counts.in_doubt += 1,
        }
    }
    (counts, first)
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
    (!met.is_tied() && beside.into_iter().all(is_same)).then(|| met.color())
}

/// The hits of the line at an `offset` from the middle of a pixel.
fn meet(solids: &Solids, camera: &Camera, frame: &Frame, pixel: [u32; 2], offset: [f64; 2]) -> Met {
    let [x, y] = [0, 1].map(|axis| f64::from(pixel[axis]) + 0.5 + offset[axis]);
    solids.meet(direction(camera, frame, x, y))
}

/// The line through a point of a picture, whose component along the camera's direction is 1.
fn direction(camera: &Camera, frame: &Frame, x: f64, y: f64) -> DVec3 {
    let (width, height) = (f64::from(frame.width()), f64::from(frame.height()));
    let focal_length = width / 2.0 / camera.field_of_view.half_width();
    let horizon = height / 2.0 + (camera.pitch.slope() * focal_length).round();
    let across = camera.direction() + camera.plane() * (2.0 * x / width - 1.0);
    across.extend((horizon - y) / focal_length)
}

fn are_alike(one: Rgb, other: Rgb) -> bool {
    one.channels().into_iter().zip(other.channels()).all(|(one, other)| one.abs_diff(other) <= 1)
}

impl Add for Counts {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            frames: self.frames + other.frames,
            pixels: self.pixels + other.pixels,
            in_doubt: self.in_doubt + other.in_doubt,
            wrong: self.wrong + other.wrong,
        }
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { frames, pixels, in_doubt, wrong } = self;
        write!(f, "{frames} frames, {pixels} pixels, {wrong} wrong, {in_doubt} in doubt")
    }
}
