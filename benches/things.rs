//! The same things in view, among few and among many that are not.
//!
//! `cargo bench --no-default-features --bench things`. A hall with some sixty plants is all that is
//! seen; the rest of the map is packed with more of them. A hall along the axes leaves them outside
//! the rectangle that holds the view, a diagonal one has ten thousand of them inside. All numbers of
//! things take turns within a hall, so compare within one run only.

use std::hint::black_box;

use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{FieldOfView, World};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};

/// How many things there are in a map, those in view among them.
const COUNTS: [usize; 3] = [100, 10_000, 100_000];

/// A map's side that has room for the longest hall, whatever else is in it.
const SHORTEST_SIDE: u32 = 100;

/// The part of a map that is seen.
struct Hall {
    name: &'static str,
    /// Where the player looks, in degrees, from the cell (1, 1).
    heading: u32,
    holds: fn(u32, u32) -> bool,
}

const HALLS: [Hall; 2] = [
    Hall {
        name: "straight",
        heading: 25,
        holds: |column, row| (1..=24).contains(&column) && (1..=12).contains(&row),
    },
    Hall {
        name: "diagonal",
        heading: 45,
        holds: |column, row| {
            let on_map = |place| (1..SHORTEST_SIDE - 2).contains(&place);
            on_map(column) && on_map(row) && column.abs_diff(row) <= 1
        },
    },
];

impl Hall {
    /// A map with this hall and `count` things.
    fn world(&self, count: usize) -> World {
        let side = SHORTEST_SIDE.max((count as f64).sqrt() as u32 + 10);
        let places = || (0..side).flat_map(|row| (0..side).map(move |column| (column, row)));
        let in_hall = places().filter(|&(column, row)| self.is_plant(column, row)).count();
        let mut elsewhere = count - in_hall;
        let mut grid = String::new();
        for (column, row) in places() {
            if column == 0 {
                grid.push('\n');
            }
            grid.push(match (column, row) {
                (1, 1) => '@',
                _ if self.is_plant(column, row) => 'p',
                _ if (self.holds)(column, row) => '.',
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
            self.heading
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{faults}"))
    }

    fn is_plant(&self, column: u32, row: u32) -> bool {
        (self.holds)(column, row) && (column + 2 * row).is_multiple_of(5)
    }

    fn is_beside(&self, column: u32, row: u32) -> bool {
        let around = |place: u32| place.saturating_sub(1)..=place + 1;
        around(row).any(|row| around(column).any(|column| (self.holds)(column, row)))
    }
}

fn things(criterion: &mut Criterion) {
    let size = FrameSize::new(160, 90).expect("neither is zero");
    let mut frame = Frame::new(size, PixelAspect::SQUARE);
    for hall in HALLS {
        let mut group = criterion.benchmark_group(hall.name);
        for count in COUNTS {
            let world = hall.world(count);
            let camera = world.start_camera(FieldOfView::default());
            let mut renderer = Renderer::new();
            group.bench_function(BenchmarkId::from_parameter(count), |bencher| {
                bencher.iter(|| renderer.render(&world, black_box(&camera), &mut frame));
            });
        }
        group.finish();
    }
}

criterion_group!(benches, things);
criterion_main!(benches);
