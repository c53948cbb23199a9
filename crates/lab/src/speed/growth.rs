//! Costs that grow with the map: a ray with the open distance, a frame with the area and with the
//! number of things.
//!
//! All subjects of a comparison take turns, so that a busy machine slows all of them. In each turn
//! the work is repeated, and the first repetition is not counted: a game stays in one map, which is
//! then in the caches.

use std::hint::black_box;
use std::time::{Duration, Instant};

use super::drawing::{median, seconds, size};
use super::ground::RAYS;
use super::{Ground, Vista, crossing_rays};
use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

/// The results.
#[derive(Clone, Debug, PartialEq)]
pub struct Growth {
    /// Open maps, by ground, from small to large.
    pub maps: Vec<MapRow>,
    /// Crowded maps, by vista, from few things to many.
    pub crowds: Vec<CrowdRow>,
}

/// The costs of an open map: of a ray across it, of a frame, and of the map itself.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapRow {
    /// The contents of the map.
    pub ground: Ground,
    /// The side of the map, in cells.
    pub side: u32,
    /// The time of a ray.
    pub ray: Measured,
    /// The time of a frame of 160×90 pixels.
    pub frame: Measured,
    /// The time to read the map.
    pub loading: Duration,
    /// The size of its [grid](cellcaster::world::Grid::bytes), in bytes for each cell.
    pub bytes_a_cell: f64,
}

/// The time of a frame in a crowded map, with always the same number of things in view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrowdRow {
    /// The visible part.
    pub vista: Vista,
    /// The number of things.
    pub count: usize,
    /// The time of a frame of 160×90 pixels.
    pub frame: Measured,
}

/// A time and its ratio to a base.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// The median, in seconds.
    pub seconds: f64,
    /// The ratio to the time with [`USUAL_SIDE`], or with the fewest things.
    pub ratio: f64,
}

/// The sides of the open maps.
pub const SIDES: [u32; 5] = [16, 64, 256, 1024, 4096];
/// The side with which others are compared.
pub const USUAL_SIDE: u32 = SIDES[USUAL];
const USUAL: usize = 1;
/// The numbers of things in a crowded map.
pub const CROWDS: [usize; 3] = [100, 10_000, 100_000];
/// The size of the pictures, in pixels.
const PICTURE: FrameSize = size(160, 90);
/// The number of timings in a turn, and the least number in all.
const A_TURN: usize = 8;
const FEWEST: usize = 3 * A_TURN;

/// Measures everything within about `time`, in addition to the time to make the maps.
pub fn measure_growth(time: Duration) -> Growth {
    let share = time / 3;
    Growth { maps: measure_maps(share * 2), crowds: measure_crowds(share) }
}

fn measure_maps(time: Duration) -> Vec<MapRow> {
    let loaded = |ground| SIDES.map(|side| LoadedMap::new(ground, side));
    let mut loaded: Vec<LoadedMap> = Ground::ALL.into_iter().flat_map(loaded).collect();
    let rays = in_turns(&mut loaded, time / 2, LoadedMap::cast);
    let rays = rays.into_iter().map(|seconds| seconds / f64::from(RAYS)).collect();
    let frames = in_turns(&mut loaded, time / 2, |map| map.drawing.draw());
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
    let crowd = |vista: Vista| CROWDS.map(|count| (vista, count, Drawing::new(vista.world(count))));
    let mut crowds: Vec<_> = Vista::ALL.into_iter().flat_map(crowd).collect();
    let frames = in_turns(&mut crowds, time, |(_, _, drawing)| drawing.draw());
    let rows = crowds.iter().zip(compared(frames, CROWDS.len(), 0));
    rows.map(|(&(vista, count, _), frame)| CrowdRow { vista, count, frame }).collect()
}

/// A map with its rays and its view.
struct LoadedMap {
    ground: Ground,
    side: u32,
    loading: Duration,
    rays: Vec<Ray>,
    drawing: Drawing,
}

impl LoadedMap {
    fn new(ground: Ground, side: u32) -> Self {
        let text = ground.map(side);
        let start = Instant::now();
        let world =
            map::parse_str(&text).expect("the map is sound, and no larger than maps may be");
        let loading = start.elapsed();
        Self { ground, side, loading, rays: crossing_rays(side), drawing: Drawing::new(world) }
    }

    fn cast(&mut self) {
        for ray in &self.rays {
            black_box(Exact.cast(self.drawing.world.grid(), black_box(ray)));
        }
    }

    fn bytes_a_cell(&self) -> f64 {
        self.drawing.world.grid().bytes() as f64 / (f64::from(self.side) * f64::from(self.side))
    }
}

/// A world, the camera at its start, and a renderer.
struct Drawing {
    world: World,
    camera: Camera,
    renderer: Renderer,
    frame: Frame,
}

impl Drawing {
    fn new(world: World) -> Self {
        let camera = world.start_camera(FieldOfView::default());
        let frame = Frame::new(PICTURE, PixelAspect::SQUARE);
        Self { world, camera, renderer: Renderer::new(), frame }
    }

    fn draw(&mut self) {
        self.renderer.render(&self.world, black_box(&self.camera), black_box(&mut self.frame));
    }
}

/// The median time of `work` on each of `subjects`, in seconds, over all turns within `time`.
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

/// Each of `times`, in groups of `size`, with its ratio to the one at `base` in its group.
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
