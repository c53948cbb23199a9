//! Origins that are hard to cast from.

use glam::DVec2;

use super::{Set, all, hall, made, turned};
use cellcaster::cast::Ray;
use cellcaster::rng::SplitMix64;

pub(crate) fn sets(random: &mut SplitMix64) -> Vec<Set> {
    let set = |name, rays| Set { name, grid: hall(), rays };
    vec![
        set("on lines", all(&on_lines(), &slopes())),
        set("beside lines", all(&beside_lines(), &slopes())),
        set("beside zero", all(&beside_zero(), &slopes())),
        set("inside walls", all(&inside_walls(), &slopes())),
        far_end(),
        set("off the map", off_the_map(random)),
        set("very far off the map", very_far()),
    ]
}

fn slopes() -> Vec<DVec2> {
    [(1.0, 0.0), (1.0, 1.0), (2.0, 1.0), (0.3, 0.1), (1.0, 1e-9), (0.7, 1e-300)]
        .into_iter()
        .flat_map(|(x, y)| turned(x, y))
        .collect()
}

/// On lines of either kind, on both, and on all edges of the map.
fn on_lines() -> Vec<DVec2> {
    [
        (7.0, 5.3),
        (6.2, 5.0),
        (7.0, 5.0),
        (3.0, 2.0),
        (0.0, 5.5),
        (16.0, 2.5),
        (4.5, 12.0),
        (5.0, 0.0),
    ]
    .map(DVec2::from)
    .to_vec()
}

fn beside_lines() -> Vec<DVec2> {
    on_lines()
        .into_iter()
        .flat_map(|DVec2 { x, y }| {
            [(x.next_up(), y), (x.next_down(), y), (x, y.next_up()), (x.next_down(), y.next_up())]
        })
        .map(DVec2::from)
        .collect()
}

fn beside_zero() -> Vec<DVec2> {
    let sizes = [0.0, 5e-324, -5e-324, 1e-300, -1e-300, 1e-17, -1e-17];
    sizes.iter().flat_map(|&x| sizes.iter().map(move |&y| DVec2::new(x, y))).collect()
}

fn inside_walls() -> Vec<DVec2> {
    [(3.5, 2.5), (0.5, 0.5), (4.25, 3.75), (8.9, 6.1), (15.5, 11.5)].map(DVec2::from).to_vec()
}

/// The last cells of a map that is a million cells long.
fn far_end() -> Set {
    let grid = made(1_000_000, 4, |column, row| row % 3 == 0 || column % 499_999 == 0);
    let origins = [(999_998.25, 1.7), (999_999.0, 2.0), (999_997.9, 2.999_999)].map(DVec2::from);
    let directions = [(1.0, 0.1), (0.3, -0.8), (-1.0, 1e-3), (-3.0, -1.0), (-1.0, 1e-5)];
    Set { name: "far end", grid, rays: all(&origins, &directions.map(DVec2::from)) }
}

/// From outside the map towards it, past it and away from it.
fn off_the_map(random: &mut SplitMix64) -> Vec<Ray> {
    let mut rays = Vec::new();
    for distance in [1.0, 1e3, 1e6, 1e9, 1e12, 1e15] {
        for way in turned(1.0, 0.25).into_iter().chain(turned(1.0, 0.0)).chain(turned(1.0, 1.0)) {
            let target = DVec2::new(random.whole(0, 16), random.between(0.0, 12.0));
            rays.extend(all(&[target - way * distance], &[way, -way, way * 1e-3]));
        }
    }
    rays
}

fn very_far() -> Vec<Ray> {
    [1e16, 1e30, 1e100, 1e300, 1e308, f64::MAX]
        .into_iter()
        .flat_map(|distance| {
            turned(1.0, 1.0).into_iter().chain(turned(1.0, 0.0)).flat_map(move |way| {
                let origin = DVec2::new(5.0, 5.0) - way * distance;
                all(&[origin], &[way, way * 1e300, way * 5e-324])
            })
        })
        .collect()
}
