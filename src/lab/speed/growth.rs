//! What grows with the map: a ray with the open distance, a frame with the area and with all that
//! stands on it.
//!
//! What is compared takes turns, so that a machine that is busy slows all of it down. In a turn it is
//! done several times, of which the first does not count: a game stays in one map, and finds it in the
//! caches.

use std::hint::black_box;
use std::time::{Duration, Instant};

use super::drawing::{median, seconds, size};
use super::ground::RAYS;
use super::{Ground, Vista, crossing_rays};
use crate::cast::{Caster, Exact, Ray};
use crate::map;
use crate::render::{Frame, FrameSize, PixelAspect, Renderer};
use crate::world::{Camera, FieldOfView, World};

/// What was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Open maps, ground by ground and from small to large.
    pub maps: Vec<MapRow>,
    /// Crowded ones, vista by vista and from few things to many.
    pub crowds: Vec<CrowdRow>,
}

/// What an open map takes: a ray that crosses it, a picture of it, and the map itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapRow {
    /// What the map is.
    pub ground: Ground,
    /// How many cells it has on a side, and a ray before it.
    pub side: u32,
    /// How long a ray takes.
    pub ray: Measured,
    /// How long a frame takes, of 160×90 pixels.
    pub frame: Measured,
    /// How long it took to read the map.
    pub loading: Duration,
    /// How many bytes its [grid](crate::world::Grid::bytes) takes, a cell.
    pub bytes_a_cell: f64,
}

/// What a frame takes among things, as many of which are in view every time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrowdRow {
    /// What is seen.
    pub vista: Vista,
    /// How many things there are.
    pub count: usize,
    /// How long a frame takes, of 160×90 pixels.
    pub frame: Measured,
}

/// A time, and how it compares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// In seconds, in the median.
    pub seconds: f64,
    /// The same, as a multiple of what it is with [`USUAL_SIDE`] cells, or the fewest things.
    pub ratio: f64,
}

/// The sides of the open maps.
pub const SIDES: [u32; 5] = [16, 64, 256, 1024, 4096];
/// The side that others are compared with.
pub const USUAL_SIDE: u32 = SIDES[USUAL];
const USUAL: usize = 1;
/// How many things there are in a crowded map.
pub const CROWDS: [usize; 3] = [100, 10_000, 100_000];
/// The pictures that are drawn, in pixels.
const PICTURE: FrameSize = size(160, 90);
/// How often everything is timed in a turn, and at least.
const A_TURN: usize = 8;
const FEWEST: usize = 3 * A_TURN;

/// Measures all of it for about so long altogether, besides the time that it takes to make the maps.
pub fn measure_growth(time: Duration) -> Growth {
    let share = time / 3;
    Growth { maps: measure_maps(share * 2), crowds: measure_crowds(share) }
}

fn measure_maps(time: Duration) -> Vec<MapRow> {
    let loaded = |ground| SIDES.map(|side| Loaded::new(ground, side));
    let mut loaded: Vec<Loaded> = Ground::ALL.into_iter().flat_map(loaded).collect();
    let rays = in_turns(&mut loaded, time / 2, Loaded::cast);
    let rays = rays.into_iter().map(|seconds| seconds / f64::from(RAYS)).collect();
    let frames = in_turns(&mut loaded, time / 2, |map| map.easel.draw());
    let times = compared(rays, SIDES.len(), USUAL).zip(compared(frames, SIDES.len(), USUAL));
    let rows = loaded.iter().zip(times).map(|(map, (ray, frame))| MapRow {
        ground: map.ground,
        side: map.side,
        ray,
        frame,
        loading: map.loading,
        bytes_a_cell: map.bytes_a_cell(),
    });
    rows.collect()
}

fn measure_crowds(time: Duration) -> Vec<CrowdRow> {
    let crowd = |vista: Vista| CROWDS.map(|count| (vista, count, Easel::new(vista.world(count))));
    let mut crowds: Vec<_> = Vista::ALL.into_iter().flat_map(crowd).collect();
    let frames = in_turns(&mut crowds, time, |(_, _, easel)| easel.draw());
    let rows = crowds.iter().zip(compared(frames, CROWDS.len(), 0));
    rows.map(|(&(vista, count, _), frame)| CrowdRow { vista, count, frame }).collect()
}

/// A map, and what looks at it.
struct Loaded {
    ground: Ground,
    side: u32,
    loading: Duration,
    rays: Vec<Ray>,
    easel: Easel,
}

impl Loaded {
    fn new(ground: Ground, side: u32) -> Self {
        let text = ground.map(side);
        let start = Instant::now();
        let world =
            map::parse_str(&text).expect("the map is sound, and no larger than maps may be");
        let loading = start.elapsed();
        Self { ground, side, loading, rays: crossing_rays(side), easel: Easel::new(world) }
    }

    fn cast(&mut self) {
        for ray in &self.rays {
            black_box(Exact.cast(self.easel.world.grid(), black_box(ray)));
        }
    }

    fn bytes_a_cell(&self) -> f64 {
        self.easel.world.grid().bytes() as f64 / (f64::from(self.side) * f64::from(self.side))
    }
}

/// A world, the view from its start, and what draws it.
struct Easel {
    world: World,
    camera: Camera,
    renderer: Renderer,
    frame: Frame,
}

impl Easel {
    fn new(world: World) -> Self {
        let camera = world.start_camera(FieldOfView::default());
        let frame = Frame::new(PICTURE, PixelAspect::SQUARE);
        Self { world, camera, renderer: Renderer::new(), frame }
    }

    fn draw(&mut self) {
        self.renderer.render(&self.world, black_box(&self.camera), black_box(&mut self.frame));
    }
}

/// How long `work` takes on each of `subjects`, in seconds: the median of as many turns as there is
/// time for.
fn in_turns<T>(subjects: &mut [T], time: Duration, work: impl Fn(&mut T)) -> Vec<f64> {
    let mut times = vec![Vec::new(); subjects.len()];
    let begun = Instant::now();
    while times.first().is_some_and(|times| times.len() < FEWEST) || begun.elapsed() < time {
        for (subject, times) in subjects.iter_mut().zip(&mut times) {
            work(subject);
            times.extend((0..A_TURN).map(|_| seconds(|| work(subject))));
        }
    }
    times.into_iter().map(median).collect()
}

/// Each of `times`, in groups of `size`, beside the one at `base` in its group.
fn compared(times: Vec<f64>, size: usize, base: usize) -> impl Iterator<Item = Measured> {
    let bases: Vec<f64> = times.chunks(size).map(|group| group[base]).collect();
    let measured =
        move |(index, seconds)| Measured { seconds, ratio: seconds / bases[index / size] };
    times.into_iter().enumerate().map(measured)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_compared_within_their_group() {
        let ratios: Vec<f64> =
            compared(vec![1.0, 2.0, 6.0, 8.0], 2, 1).map(|measured| measured.ratio).collect();
        assert_eq!(ratios, [0.5, 1.0, 0.75, 1.0]);
    }
}
