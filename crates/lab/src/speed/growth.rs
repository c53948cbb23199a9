//! Costs that grow with the map: the cost of a ray with the open distance, and the cost of a frame
//! with the area and with the number of things.
//!
//! All subjects of a comparison take turns, so that a busy machine slows all of them. In each turn
//! the work is repeated, and the first repetition is not counted, because a game stays in one map,
//! which is then in the caches.

use std::fmt::Write;
use std::hint::black_box;
use std::time::{Duration, Instant};

use glam::{DVec2, Vec2Swizzles};

use super::drawing::size;
use crate::report::{Diagram, Row, Table, Value, headings, median, seconds};
use cellcaster::cast::{Caster, Exact, Ray};
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, World};

/// The sides of the open maps: of a usual map, of a large map, and of the
/// largest map.
const SIDES: [u32; 3] = [64, 1024, 4096];
/// The numbers of things in a crowded map.
const CROWDS: [usize; 3] = [100, 10_000, 100_000];
/// The size of the pictures, in pixels.
const PICTURE: FrameSize = size(160, 90);
/// The number of timings in a turn, and the smallest number in total.
const A_TURN: usize = 8;
const MIN: usize = 3 * A_TURN;

/// The costs of open maps, measured within about `time`, which does not include making the maps.
pub(crate) fn measure_maps(time: Duration) -> Table {
    let loaded = |ground| SIDES.map(|side| LoadedMap::new(ground, side));
    let mut loaded: Vec<LoadedMap> = Ground::ALL.into_iter().flat_map(loaded).collect();
    let rays = in_turns(&mut loaded, time / 2, LoadedMap::cast);
    let rays = rays.into_iter().map(|seconds| seconds / f64::from(RAYS)).collect();
    let frames = in_turns(&mut loaded, time / 2, |map| map.drawing.draw());
    let (rays, frames) = (compared(rays, SIDES.len()), compared(frames, SIDES.len()));
    let rows = loaded.iter().zip(rays.zip(frames)).map(|(map, ((ray, rays), (frame, frames)))| {
        let cells = f64::from(map.side) * f64::from(map.side);
        let bytes = map.drawing.world.grid().bytes() as f64;
        let reading = map.loading.as_secs_f64() * 1e3;
        let figures = [ray * 1e9, rays, frame * 1e6, frames, reading, bytes / cells];
        let count = Value::Count(map.side.into());
        let values = std::iter::once(count).chain(figures.map(Value::Number)).collect();
        Row::new(["", map.ground.name(), &map.side.to_string()], values)
    });
    Table {
        name: "maps",
        title: format!(
            "An empty hall, and a plain with a pillar in one cell of 4096, by the cells along a side:\n\
             rays across the map, and frames of 160x90 with a view across it. Ratios are to {} cells",
            SIDES[0]
        ),
        keys: ["", "ground", "side"],
        columns: headings([
            "cells",
            "time, ns/ray",
            "ray ratio",
            "time, µs/frame",
            "frame ratio",
            "load time, ms",
            "bytes/cell",
        ]),
        rows: rows.collect(),
        diagrams: vec![
            Diagram { columns: [0, 1], range: Diagram::ALL },
            Diagram { columns: [0, 3], range: Diagram::ALL },
        ],
    }
}

/// The time of a frame in crowded maps, always with the same number of things in view, measured
/// within about `time`.
pub(crate) fn measure_crowds(time: Duration) -> Table {
    let crowd = |vista: Vista| CROWDS.map(|count| (vista, count, Drawing::new(vista.world(count))));
    let mut crowds: Vec<_> = Vista::ALL.into_iter().flat_map(crowd).collect();
    let frames = in_turns(&mut crowds, time, |(_, _, drawing)| drawing.draw());
    let rows = crowds.iter().zip(compared(frames, CROWDS.len()));
    let rows = rows.map(|((vista, count, _), (frame, ratio))| {
        let figures = [frame * 1e6, ratio].map(Value::Number);
        let values = std::iter::once(Value::Count(*count as u64)).chain(figures).collect();
        Row::new(["", vista.name(), &count.to_string()], values)
    });
    Table {
        name: "things",
        title: format!(
            "Frames of 160x90, by the number of things on the map, about sixty in view, in a\n\
             straight hall and in a diagonal one. Ratios are to {} things",
            CROWDS[0]
        ),
        keys: ["", "hall", "things"],
        columns: headings(["number", "time, µs/frame", "ratio"]),
        rows: rows.collect(),
        diagrams: vec![Diagram { columns: [0, 1], range: Diagram::ALL }],
    }
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
    while times.first().is_some_and(|times| times.len() < MIN) || begun.elapsed() < time {
        for (subject, times) in subjects.iter_mut().zip(&mut times) {
            work(subject);
            times.extend((0..A_TURN).map(|_| seconds(|| work(subject))));
        }
    }
    times.into_iter().map(median).collect()
}

/// Each of `times` with its ratio to the first time of its group. Groups have `size` entries.
fn compared(times: Vec<f64>, size: usize) -> impl Iterator<Item = (f64, f64)> {
    let bases: Vec<f64> = times.chunks(size).map(|group| group[0]).collect();
    times.into_iter().enumerate().map(move |(index, time)| (time, time / bases[index / size]))
}

// Open maps of any size, and rays across them.

/// The contents of an open map, apart from the walls around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Ground {
    /// Nothing.
    Hall,
    /// A pillar in one cell of 4096.
    Plain,
}

/// The number of rays cast in a map.
const RAYS: u32 = 256;

impl Ground {
    /// All grounds.
    const ALL: [Self; 2] = [Self::Hall, Self::Plain];

    /// The name.
    const fn name(self) -> &'static str {
        match self {
            Self::Hall => "hall",
            Self::Plain => "plain",
        }
    }

    /// The text of the map of `side` × `side` cells; `side` is at least 4.
    fn map(self, side: u32) -> String {
        let last = side - 1;
        let mut text = String::from("grid = '''\n");
        text.reserve(side as usize * (side as usize + 1));
        for row in 0..side {
            text.extend((0..side).map(|column| {
                let is_edge = row == 0 || column == 0 || row == last || column == last;
                match self {
                    _ if is_edge => '#',
                    Self::Plain if is_pillar(column, row) => '#',
                    _ if (column, row) == (1, side / 2) => '@',
                    _ => '.',
                }
            }));
            text.push('\n');
        }
        // Writing to a string cannot fail.
        _ = writeln!(text, "'''\n[tiles]\n'#'.wall = 'brick'\n[things]\n'@'.start = 0");
        text
    }
}

/// Returns whether a plain has a pillar there. There is one in each block of 64 × 64 cells, at or
/// near its middle.
fn is_pillar(column: u32, row: u32) -> bool {
    let (within, block) = (|place: u32| place % 64, |place: u32| place / 64);
    let moved = |by: u32| 16 + (block(column) * 37 + block(row) * 101 + by * 53) % 32;
    (within(column), within(row)) == (moved(0), moved(1))
}

/// Rays that cross a map of `side` × `side` cells, half of them along rows and half along columns.
/// On a plain, pillars stop some of them.
fn crossing_rays(side: u32) -> Vec<Ray> {
    let ray = |index: u32| {
        let share = f64::from(index) / f64::from(RAYS);
        let start = DVec2::new(1.5, f64::from(side) * (0.45 + 0.1 * share));
        let direction = DVec2::new(1.0, 0.8 * (share * 7.3).fract() - 0.4);
        if index.is_multiple_of(2) { (start, direction) } else { (start.yx(), direction.yx()) }
    };
    let cast = |index| {
        let (start, direction) = ray(index);
        Ray::new(start, direction).expect("both are finite, and it goes somewhere")
    };
    (0..RAYS).map(cast).collect()
}

// Crowded maps: the same things in view, with few or many things elsewhere.

/// The visible part of a map: a hall with about sixty plants. The rest of the map is full of
/// plants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Vista {
    /// A hall along the axes. The other things are outside the rectangle that contains the view.
    Straight,
    /// A diagonal hall. Ten thousand other things are inside the rectangle that contains the view.
    Diagonal,
}

/// The least side of a map with room for the longest hall.
const MIN_SIDE: u32 = 100;

impl Vista {
    /// All vistas.
    const ALL: [Self; 2] = [Self::Straight, Self::Diagonal];

    /// The name.
    const fn name(self) -> &'static str {
        match self {
            Self::Straight => "straight",
            Self::Diagonal => "diagonal",
        }
    }

    /// A map with this hall and `count` things, including the things in view.
    fn world(self, count: usize) -> World {
        let side = MIN_SIDE.max((count as f64).sqrt() as u32 + 10);
        let places = || (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let in_view = places().filter(|&(column, row)| self.is_plant(column, row)).count();
        let mut elsewhere = count - in_view;
        let mut grid = String::new();
        for (column, row) in places() {
            if column == 0 {
                grid.push('\n');
            }
            grid.push(match (column, row) {
                (1, 1) => '@',
                _ if self.is_plant(column, row) => 'p',
                _ if self.holds(column, row) => '.',
                _ if self.is_beside(column, row) || elsewhere == 0 => '#',
                _ => {
                    elsewhere -= 1;
                    'p'
                }
            });
        }
        assert_eq!(elsewhere, 0, "there is room for all things");
        let text = format!(
            "grid = '''{grid}\n'''\ntiles.'#'.wall = 'brick'\n\
             things = {{ '@'.start = {}, 'p'.sprite = 'plant' }}\n",
            self.heading()
        );
        map::parse_str(&text).expect("the map is sound, but for its size")
    }

    /// The player's heading in degrees, at the cell (1, 1).
    fn heading(self) -> u32 {
        match self {
            Self::Straight => 25,
            Self::Diagonal => 45,
        }
    }

    fn holds(self, column: u32, row: u32) -> bool {
        match self {
            Self::Straight => (1..=24).contains(&column) && (1..=12).contains(&row),
            Self::Diagonal => {
                let is_on_map = |place| (1..MIN_SIDE - 2).contains(&place);
                is_on_map(column) && is_on_map(row) && column.abs_diff(row) <= 1
            }
        }
    }

    fn is_plant(self, column: u32, row: u32) -> bool {
        self.holds(column, row) && (column + 2 * row).is_multiple_of(5)
    }

    fn is_beside(self, column: u32, row: u32) -> bool {
        let around = |place: u32| place.saturating_sub(1)..=place + 1;
        around(row).any(|row| around(column).any(|column| self.holds(column, row)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_compared_within_a_group() {
        let ratios: Vec<f64> =
            compared(vec![2.0, 1.0, 6.0, 9.0], 2).map(|(_, ratio)| ratio).collect();
        assert_eq!(ratios, [1.0, 0.5, 1.0, 1.5]);
    }
}
