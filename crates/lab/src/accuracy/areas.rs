//! Pictures compared with the mean over the area of each pixel.
//!
//! A picture has one sample in each pixel, and the truth is what a perfect camera sees: the mean
//! light over the pixel. It is computed from the renderer's own picture, eight times as wide and
//! high and without filtering: 64 samples of a pixel, averaged in linear light and not rounded. The
//! renderer's samples are verified elsewhere, against an independent tracer. An oracle in rational
//! arithmetic was refused here: 64 samples of it take seconds for each picture.
//!
//! What is compared is what a terminal shows of a window: each half of a cell, as the glyphs of the
//! window light it. A glyph's coverage is that of an 8×8 bitmap font.
//!
//! A half is at an edge if its samples show more than one surface: floor, ceiling, sky, a thing, or
//! one plane of walls. *Crawl* is the change from frame to frame that the truth does not have: the
//! mean of |change shown − true change| while the camera turns and walks slowly.

mod cells;
mod differences;
#[cfg(test)]
mod gains;
mod truth;

use std::time::Instant;

use ratatui::layout::Size;

use super::pictures::cameras;
use super::table::{Column, Diagram, Row, Table, Value};
use super::timing::time_in_rounds;
use cellcaster::color::palette::ColorDepth;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::tui::GlyphSet;
use cellcaster::world::{Camera, World};
use cells::Window;
use differences::Differences;
use truth::Truth;

/// What a window shows a picture by.
#[derive(Clone, Copy, Debug)]
struct Display {
    name: &'static str,
    glyphs: GlyphSet,
    depth: ColorDepth,
}

const DISPLAYS: [Display; 5] = [
    Display { name: "half", glyphs: GlyphSet::Half, depth: ColorDepth::True },
    Display { name: "half, 256 colours", glyphs: GlyphSet::Half, depth: ColorDepth::Indexed256 },
    Display { name: "half, 16 colours", glyphs: GlyphSet::Half, depth: ColorDepth::Indexed16 },
    Display { name: "ascii", glyphs: GlyphSet::Ascii, depth: ColorDepth::True },
    Display { name: "ramp", glyphs: GlyphSet::Ramp, depth: ColorDepth::True },
];

/// The sizes of windows, in cells.
const WINDOWS: [Size; 5] = [
    Size::new(40, 12),
    Size::new(80, 24),
    Size::new(160, 45),
    Size::new(200, 60),
    Size::new(320, 90),
];
/// The window in which displays other than the first are compared.
const TYPICAL: Size = WINDOWS[2];

/// The number of cameras: the start, and random places.
const CAMERAS: usize = 4;
/// The number of steps of each camera. Before each, it turns and walks.
const STEPS: usize = 3;
/// A ninth of a degree.
const TURN: f64 = 0.002;
/// In cells.
const STRIDE: f64 = 0.01;
/// The errors on the diagrams.
const RANGE: [f64; 2] = [0.1, 255.0];

/// The errors of each filter and each glyph set, in pictures of `world`. Each is timed in `rounds`
/// rounds.
pub(crate) fn table(world: &World, seed: u64, rounds: usize) -> Table {
    let ways: Vec<Vec<Camera>> = cameras(world, seed).take(CAMERAS).map(way).collect();
    let mut rows = Vec::new();
    for window in WINDOWS {
        let displays = if window == TYPICAL { &DISPLAYS[..] } else { &DISPLAYS[..1] };
        let shown: Vec<(Display, Filter)> = displays
            .iter()
            .flat_map(|&display| Filter::ALL.map(|filter| (display, filter)))
            .collect();
        let mut all = vec![Differences::default(); shown.len()];
        for way in &ways {
            compare(world, way, window, &shown, &mut all);
        }
        let starts: Vec<Camera> = ways.iter().map(|way| way[0]).collect();
        let times = time_in_rounds(shown.len(), rounds, |index| {
            let (display, filter) = shown[index];
            let mut picture = Window::new(window, display.glyphs, display.depth, filter);
            picture.show(world, &starts[0]);
            let start = Instant::now();
            for camera in &starts {
                picture.show(world, camera);
            }
            start.elapsed().as_secs_f64() * 1e6 / starts.len() as f64
        });
        for (((display, filter), differences), time) in shown.iter().zip(&all).zip(times) {
            let keys = [
                display.name.to_owned(),
                filter.name().to_owned(),
                format!("{}x{}", window.width, window.height),
            ];
            let mut values = differences.values();
            let order = order(&rows, &keys, &values);
            values.extend([order, time]);
            rows.push(Row { keys, values });
        }
    }
    rows.sort_by_key(|row| DISPLAYS.iter().position(|display| display.name == row.keys[0]));
    Table {
        name: "areas",
        title: "What a window shows, compared with the mean light over each half of a cell (64 samples)",
        keys: ["display", "filter", "window"],
        columns: vec![
            Column::new("pixels", ""),
            Column::new("mean error", "of 255"),
            Column::new("off by more than 24", ""),
            Column::new("worst error", "of 255"),
            Column::new("at an edge", ""),
            Column::new("mean error at edges", "of 255"),
            Column::new("mean error of textures", "of 255"),
            Column::new("crawl", "of 255"),
            Column::new("crawl at edges", "of 255"),
            Column::new("crawl of textures", "of 255"),
            Column::new("order", ""),
            Column::new("time", "µs a frame"),
        ],
        rows,
        diagrams: vec![
            Diagram { columns: [11, 1], range: RANGE },
            Diagram { columns: [11, 7], range: RANGE },
        ],
    }
}

/// The order of convergence from the next smaller window with the same display and filter: the power of the
/// width of a pixel with which the mean error falls.
fn order(smaller: &[Row], keys: &[String; 3], values: &[Value]) -> Value {
    let width = |keys: &[String; 3]| keys[2].split('x').next()?.parse::<f64>().ok();
    let order = || {
        let before = smaller.iter().rfind(|row| row.keys[..2] == keys[..2])?;
        let error = |values: &[Value]| values[MEAN_ERROR].number();
        let fall = error(&before.values)? / error(values)?;
        let growth = width(keys)? / width(&before.keys)?;
        Some(fall.ln() / growth.ln())
    };
    order().filter(|order| order.is_finite()).map_or(Value::None, Value::Number)
}

/// The column of the mean error.
const MEAN_ERROR: usize = 1;

/// The cameras of a way that begins at `first`.
fn way(first: Camera) -> Vec<Camera> {
    std::iter::successors(Some(first), |camera| {
        let mut next = *camera;
        next.heading = next.heading.turned(TURN);
        let position = next.position() + STRIDE * next.direction();
        Camera::new(position, next.heading, next.field_of_view)
            .and_then(|moved| moved.with_eye(camera.eye()))
    })
    .take(STEPS + 1)
    .collect()
}

/// Adds the differences of each of `shown` along `way`.
fn compare(
    world: &World,
    way: &[Camera],
    size: Size,
    shown: &[(Display, Filter)],
    all: &mut [Differences],
) {
    let mut windows: Vec<Window> = shown
        .iter()
        .map(|(display, filter)| Window::new(size, display.glyphs, display.depth, *filter))
        .collect();
    let mut before: Option<(Truth, Vec<Vec<[f64; 3]>>)> = None;
    for camera in way {
        let truth = Truth::new(world, camera, size);
        let pictures: Vec<Vec<[f64; 3]>> = windows
            .iter_mut()
            .map(|window| {
                window.show(world, camera);
                window.halves()
            })
            .collect();
        match &before {
            None => {
                for (differences, picture) in all.iter_mut().zip(&pictures) {
                    differences.add_still(&truth, picture);
                }
            }
            Some((truth_before, pictures_before)) => {
                for ((differences, picture), picture_before) in
                    all.iter_mut().zip(&pictures).zip(pictures_before)
                {
                    differences.add_motion([truth_before, &truth], [picture_before, picture]);
                }
            }
        }
        before = Some((truth, pictures));
    }
}

/// The mean change of a channel from frame to frame, in steps of 8 bits, over sixty frames in which
/// `camera` turns by a ninth of a degree each. Edges that move change pixels with every filter.
pub fn shimmer(world: &World, camera: &Camera, size: FrameSize, filter: Filter) -> f64 {
    const TURNS: u32 = 60;
    let mut camera = *camera;
    let mut renderer = Renderer::new();
    renderer.set_filter(filter);
    let mut before = Frame::new(size, PixelAspect::SQUARE);
    let mut after = before.clone();
    renderer.render(world, &camera, &mut before);
    let (mut sum, mut count) = (0_u64, 0_u64);
    for _ in 0..TURNS {
        camera.heading = camera.heading.turned(TURN);
        renderer.render(world, &camera, &mut after);
        for (one, other) in before.rows().flatten().zip(after.rows().flatten()) {
            let channels = one.channels().into_iter().zip(other.channels());
            sum += channels.map(|(one, other)| u64::from(one.abs_diff(other))).sum::<u64>();
            count += 3;
        }
        std::mem::swap(&mut before, &mut after);
    }
    sum as f64 / count.max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use cellcaster::map;

    fn room(wall: &str, floor: &str) -> World {
        let text = format!(
            "floor = '{floor}'\nceiling = '{floor}'\n\
             grid = '''\n####\n#@.#\n#..#\n####\n'''\n\
             tiles.'#'.wall = '{wall}'\nthings.'@'.start = 0\n"
        );
        map::parse_str(&text).unwrap()
    }

    /// The values of the first display in a small window: mean error, of edges and of textures, and
    /// crawl.
    fn values(world: &World, filter: Filter) -> [f64; 4] {
        let ways = cameras(world, 5).take(2).map(way);
        let mut all = [Differences::default()];
        for way in ways {
            compare(world, &way, Size::new(40, 12), &[(DISPLAYS[0], filter)], &mut all);
        }
        let values = all[0].values();
        [1, 5, 6, 7].map(|index: usize| values[index].number().unwrap())
    }

    #[test]
    fn one_colour_has_no_error_and_does_not_crawl() {
        for filter in Filter::ALL {
            let values = values(&room("#000000", "#000000"), filter);
            assert!(values.iter().all(|&value| value < 1e-9), "{values:?}");
        }
    }

    #[test]
    fn plain_colours_have_errors_at_edges_only() {
        let [mean, edges, textures, crawl] = values(&room("#ff0000", "#0000ff"), Filter::Mip);
        assert!(mean > 0.1 && edges > 10.0 && textures < 1e-9 && crawl > 0.1);
    }

    #[test]
    fn mip_levels_have_less_error_than_texels() {
        let world = room("brick", "tile");
        let [mip, nearest] = [Filter::Mip, Filter::Nearest].map(|filter| values(&world, filter));
        for (mip, nearest) in mip.into_iter().zip(nearest) {
            assert!(mip < nearest && mip > 0.1, "{mip} {nearest}");
        }
    }
}
