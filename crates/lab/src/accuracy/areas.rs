//! Pictures compared with the mean over the area of each pixel.
//!
//! A picture has one sample in each pixel. The reference is the picture of a perfect camera: the
//! mean light over the pixel. It is computed from the renderer's own picture, eight times as wide
//! and high and without filtering. The 64 samples of each pixel are averaged in linear light and
//! not rounded. The renderer's samples are verified elsewhere, by `crates/certify`.
//! Rejected: an oracle in rational arithmetic. 64 samples of it take seconds for each picture.
//!
//! Each half of a cell is compared, as the glyphs of the window light it. The coverage of a glyph
//! comes from an 8×8 bitmap font.
//!
//! A half is at an edge if its samples show more than one surface: floor, ceiling, sky, a thing, or
//! one plane of walls. *Crawl* is the change from frame to frame that the reference does not have:
//! the mean of |change shown − true change| while the camera turns and walks slowly.

use std::num::NonZeroU32;

use font8x8::{BASIC_FONTS, BLOCK_FONTS, UnicodeFonts};
use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Rect, Size};
use ratatui::widgets::StatefulWidget;

use crate::report::{Diagram, Row, Table, Value, headings, seconds, time_in_rounds};
use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::color::Rgb;
use cellcaster::color::palette::ColorDepth;
use cellcaster::color::srgb::{encoded, linear};
use cellcaster::map::builtin;
use cellcaster::render::{Filter, Frame, FrameSize, PixelAspect, Renderer, Surface};
use cellcaster::tui::{FirstPerson, GlyphSet, View, rgb_of};
use cellcaster::world::{Camera, FieldOfView, World};

/// The glyphs and colours with which a window shows a picture.
#[derive(Clone, Copy, Debug)]
struct Display {
    name: &'static str,
    glyphs: GlyphSet,
    depth: ColorDepth,
}

const DISPLAYS: [Display; 6] = [
    Display { name: "half", glyphs: GlyphSet::Half, depth: ColorDepth::True },
    Display { name: "half, 256 colours", glyphs: GlyphSet::Half, depth: ColorDepth::Indexed256 },
    Display { name: "half, 16 colours", glyphs: GlyphSet::Half, depth: ColorDepth::Indexed16 },
    Display { name: "quadrant", glyphs: GlyphSet::Quadrant, depth: ColorDepth::True },
    Display { name: "ascii", glyphs: GlyphSet::Ascii, depth: ColorDepth::True },
    Display { name: "ramp", glyphs: GlyphSet::Ramp, depth: ColorDepth::True },
];

/// The compared filters. `nearest` is left out: it takes as long as `mip` and has larger errors.
const FILTERS: [Filter; 2] = [Filter::Mip, Filter::Area];

/// The sizes of windows, in cells, of one aspect.
const WINDOWS: [Size; 3] = [Size::new(80, 24), Size::new(160, 48), Size::new(320, 96)];

/// The number of steps of each camera. It turns and walks before each step.
const STEPS: usize = 2;
/// The angle between frames, in radians: a ninth of a degree.
const TURN: f64 = 0.002;
/// The distance between frames, in cells.
const STRIDE: f64 = 0.01;

/// The errors of each display, filter and window at the start of `map`, or of each built-in level. Each is timed in
/// `rounds` rounds.
pub(crate) fn table(map: Option<&World>, rounds: usize) -> Table {
    let levels = || builtin::LEVELS.iter().filter_map(|level| level.world().ok()).collect();
    let worlds: Vec<World> = map.map_or_else(levels, |map| vec![map.clone()]);
    let start = |world: &World| world.start_camera(FieldOfView::default());
    let shown: Vec<(Display, Filter)> =
        DISPLAYS.iter().flat_map(|&display| FILTERS.map(|filter| (display, filter))).collect();
    let mut rows = Vec::new();
    for window in WINDOWS {
        let in_world = |world: &World| {
            let mut all = vec![Differences::default(); shown.len()];
            compare(world, &way(start(world)), window, &shown, &mut all);
            all
        };
        let differences: Vec<Vec<Differences>> = worlds.iter().map(in_world).collect();
        let times = time_in_rounds(shown.len(), rounds, |index| {
            let mut picture = Window::new(window, shown[index]);
            let mut show = || worlds.iter().for_each(|world| picture.show(world, &start(world)));
            show();
            seconds(show) * 1e6 / worlds.len() as f64
        });
        for (index, ((display, filter), time)) in shown.iter().zip(times).enumerate() {
            let figures: Vec<[f64; 3]> = differences.iter().map(|it| it[index].figures()).collect();
            let spread = |figure: usize| Value::of(figures.iter().map(|it| it[figure]).collect());
            let size = format!("{}x{}", window.width, window.height);
            let values = [0, 1, 2].into_iter().map(spread).chain([time]).collect();
            rows.push(Row::new([display.name, filter.name(), &size], values));
        }
    }
    rows.sort_by_key(|row| DISPLAYS.iter().position(|display| display.name == row.keys[0]));
    Table {
        name: "areas",
        title: "Pictures at the starts of all levels, compared with the mean light over halves of cells"
            .to_owned(),
        keys: ["display", "filter", "window"],
        columns: headings([
            "mean error, of 255",
            "mean error at edges, of 255",
            "crawl at edges, of 255",
            "time, µs a frame",
        ]),
        rows,
        diagrams: vec![Diagram { columns: [0, 3], range: Diagram::ALL }],
    }
}

/// The cameras of a walk that begins at `first`.
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

/// Adds the differences of each entry of `shown` along `way`.
fn compare(
    world: &World,
    way: &[Camera],
    size: Size,
    shown: &[(Display, Filter)],
    all: &mut [Differences],
) {
    let truths: Vec<Vec<Half>> = way.iter().map(|camera| truth(world, camera, size)).collect();
    for (&shown, differences) in shown.iter().zip(all) {
        let mut window = Window::new(size, shown);
        let pictures = way.iter().map(|camera| {
            window.show(world, camera);
            window.halves()
        });
        let pictures: Vec<Vec<[f64; 3]>> = pictures.collect();
        differences.add_still(&truths[0], &pictures[0]);
        for (truths, pictures) in truths.windows(2).zip(pictures.windows(2)) {
            differences.add_motion(truths, pictures);
        }
    }
}

// The appearance of a window's cells.

/// A window that shows pictures.
struct Window {
    display: Display,
    filter: Filter,
    view: View,
    buffer: Buffer,
}

impl Window {
    /// A window of `size` cells.
    fn new(size: Size, (display, filter): (Display, Filter)) -> Self {
        let buffer = Buffer::empty(Rect::from(size));
        Self { display, filter, view: View::default(), buffer }
    }

    /// Draws and paints the view of `camera`.
    fn show(&mut self, world: &World, camera: &Camera) {
        let Self { display: Display { glyphs, depth, .. }, filter, view, buffer } = self;
        let widget = FirstPerson::new(world, camera).glyphs(*glyphs).color_depth(*depth);
        widget.filter(*filter).render(buffer.area, buffer, view);
    }

    /// The mean light of each half of a cell in sRGB, from 0 to 255, row by row of halves.
    fn halves(&self) -> Vec<[f64; 3]> {
        let rows = self.buffer.content.chunks(usize::from(self.buffer.area.width).max(1));
        rows.flat_map(|cells| {
            [0, 1].into_iter().flat_map(move |half| cells.iter().map(move |cell| light(cell, half)))
        })
        .collect()
    }
}

/// The mean light of the upper half of a cell (0) or the lower half (1).
fn light(cell: &Cell, half: usize) -> [f64; 3] {
    const DOTS: f64 = 32.0;
    let character = cell.symbol().chars().next().unwrap_or(' ');
    let glyph = BASIC_FONTS.get(character).or_else(|| BLOCK_FONTS.get(character));
    let rows = glyph.unwrap_or_default();
    let dots: u32 = rows[4 * half..4 * (half + 1)].iter().map(|row| row.count_ones()).sum();
    let share = f64::from(dots) / DOTS;
    let [text, ground] = [cell.fg, cell.bg].map(|it| rgb_of(it).unwrap_or(Rgb::BLACK));
    if share == 0.0 || share == 1.0 {
        let color = if share == 0.0 { ground } else { text };
        return color.channels().map(f64::from);
    }
    let [text, ground] = [text, ground].map(linear);
    std::array::from_fn(|channel| {
        255.0 * encoded(share * text[channel] + (1.0 - share) * ground[channel])
    })
}

// The mean light over each half of a cell.

/// The factor by which the larger picture is wider and higher.
const SCALE: u32 = 8;

/// The upper or the lower half of a cell.
#[derive(Clone, Copy)]
struct Half {
    /// The mean light in sRGB, not rounded, from 0 to 255.
    color: [f64; 3],
    /// `true` if its samples show more than one surface.
    is_at_edge: bool,
}

/// The halves of the cells of a window of `size`, row by row, in the view of `camera`.
fn truth(world: &World, camera: &Camera, size: Size) -> Vec<Half> {
    let (width, height) = (u32::from(size.width), 2 * u32::from(size.height));
    let scaled = |side: u32| NonZeroU32::new(side * SCALE).unwrap_or(NonZeroU32::MIN);
    let scaled = FrameSize { width: scaled(width), height: scaled(height) };
    let mut renderer = Renderer::new();
    renderer.set_filter(Filter::Nearest);
    renderer.keep_surfaces(true);
    let mut frame = Frame::new(scaled, PixelAspect::SQUARE);
    renderer.render(world, camera, &mut frame);
    let lines: Vec<_> = (0..scaled.width.get()).map(|x| line(world, camera, scaled, x)).collect();
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    places.map(|(x, y)| half(&renderer, &lines, &frame, x, y)).collect()
}

/// A grid line on which a wall stands.
type GridLine = (Side, u32);

/// The line of the wall that the ray of column `x` hits, in a picture of this size.
fn line(world: &World, camera: &Camera, size: FrameSize, x: u32) -> Option<GridLine> {
    let across = (2.0 * f64::from(x) + 1.0) / f64::from(size.width.get()) - 1.0;
    let plane = camera.direction().perp() * camera.field_of_view.half_width();
    let ray = Ray::new(camera.position(), camera.direction() + plane * across).ok()?;
    let Hit { cell, side, .. } = Exact.cast(world.grid(), &ray)?;
    Some((side, if side == Side::X { cell.column } else { cell.row }))
}

fn half(renderer: &Renderer, lines: &[Option<GridLine>], frame: &Frame, x: u32, y: u32) -> Half {
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
    let shown = |x: u32, y: u32| {
        let surface = renderer.surface(x, y);
        let is_wall = matches!(surface, Some(Surface::WallX | Surface::WallY));
        (surface, lines[x as usize].filter(|_| is_wall))
    };
    let first = shown(SCALE * x, SCALE * y);
    Half {
        color: light.map(|sum| 255.0 * encoded(sum / f64::from(SCALE * SCALE))),
        is_at_edge: samples().any(|(x, y)| shown(x, y) != first),
    }
}

// The distance between pictures and the reference, summed over the halves of their cells.

/// Sums over halves of cells. Pairs are for textures and for edges, in this order.
#[derive(Clone, Debug, Default)]
struct Differences {
    pixels: [u64; 2],
    errors: [f64; 2],
    moved: [u64; 2],
    changes: [f64; 2],
}

impl Differences {
    /// Adds a picture of a camera that stands still.
    fn add_still(&mut self, truth: &[Half], picture: &[[f64; 3]]) {
        for (half, shown) in truth.iter().zip(picture) {
            let differences: [f64; 3] =
                std::array::from_fn(|channel| (shown[channel] - half.color[channel]).abs());
            let place = usize::from(half.is_at_edge);
            self.pixels[place] += 1;
            self.errors[place] += differences.iter().sum::<f64>() / 3.0;
        }
    }

    /// Adds the change from the first of two pictures to the second.
    fn add_motion(&mut self, truths: &[Vec<Half>], pictures: &[Vec<[f64; 3]>]) {
        let halves = truths[0].iter().zip(&truths[1]);
        for ((one, other), (before, after)) in halves.zip(pictures[0].iter().zip(&pictures[1])) {
            let place = usize::from(one.is_at_edge || other.is_at_edge);
            let change: f64 = (0..3)
                .map(|channel| {
                    let shown = after[channel] - before[channel];
                    (shown - (other.color[channel] - one.color[channel])).abs()
                })
                .sum();
            self.moved[place] += 1;
            self.changes[place] += change / 3.0;
        }
    }

    /// The mean error, the mean error at edges, and the mean crawl at edges.
    fn figures(&self) -> [f64; 3] {
        let mean = |sum: f64, count: u64| sum / count.max(1) as f64;
        let everywhere = mean(self.errors.iter().sum(), self.pixels.iter().sum());
        [everywhere, mean(self.errors[1], self.pixels[1]), mean(self.changes[1], self.moved[1])]
    }
}

#[cfg(test)]
mod tests {
    use ratatui::style::Color;

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

    /// The differences of the first display in a small window.
    fn differences(world: &World, filter: Filter) -> Differences {
        let way = way(world.start_camera(FieldOfView::default()));
        let mut all = [Differences::default()];
        compare(world, &way, Size::new(40, 12), &[(DISPLAYS[0], filter)], &mut all);
        let [differences] = all;
        differences
    }

    #[test]
    fn a_uniform_colour_has_no_error_and_does_not_crawl() {
        for filter in Filter::ALL {
            let figures = differences(&room("#000000", "#000000"), filter).figures();
            assert!(figures.iter().all(|&mean| mean < 1e-9), "{figures:?}");
        }
    }

    #[test]
    fn plain_colours_have_errors_only_at_edges() {
        let differences = differences(&room("#ff0000", "#0000ff"), Filter::Mip);
        let [mean, at_edges, crawl] = differences.figures();
        let [of_textures, _] = differences.errors;
        assert!(mean > 0.1 && at_edges > 10.0 && of_textures < 1e-9 && crawl > 0.1);
    }

    #[test]
    fn mip_levels_have_less_error_than_texels() {
        let world = room("brick", "tile");
        let [mip, nearest] =
            [Filter::Mip, Filter::Nearest].map(|filter| differences(&world, filter).figures());
        for (mip, nearest) in mip.into_iter().zip(nearest) {
            assert!(mip < nearest && mip > 0.1, "{mip} {nearest}");
        }
    }

    #[test]
    fn a_half_block_lights_half_a_cell() {
        let mut cell = Cell::default();
        cell.set_char('▀').set_fg(Color::Rgb(200, 10, 0)).set_bg(Color::Indexed(16));
        assert_eq!((light(&cell, 0), light(&cell, 1)), ([200.0, 10.0, 0.0], [0.0; 3]));
        cell.set_char(' ').set_bg(Color::Rgb(7, 8, 9));
        assert_eq!((light(&cell, 0), light(&cell, 1)), ([7.0, 8.0, 9.0], [7.0, 8.0, 9.0]));
    }

    #[test]
    fn a_letter_lights_part_of_a_cell() {
        let mut cell = Cell::default();
        cell.set_char('#').set_fg(Color::Rgb(255, 255, 255)).set_bg(Color::Rgb(0, 0, 0));
        let [red, green, blue] = light(&cell, 0);
        assert!(red == green && green == blue && red > 100.0 && red < 255.0, "{red}");
    }

    #[test]
    fn nine_samples_have_less_than_half_of_the_error() {
        let level = builtin::LEVELS.iter().find(|level| level.name == "museum");
        let world = level.unwrap().world().unwrap();
        let shown = [Filter::Area, Filter::Mip].map(|filter| (DISPLAYS[0], filter));
        for size in [Size::new(80, 24), Size::new(160, 48)] {
            let mut all = [Differences::default(), Differences::default()];
            compare(
                &world,
                &way(world.start_camera(FieldOfView::default())),
                size,
                &shown,
                &mut all,
            );
            let [area, mip] = all.map(|differences| differences.figures());
            for (most, (area, mip)) in [0.45, 0.6, 0.9].into_iter().zip(area.into_iter().zip(mip)) {
                assert!(0.0 < area && area < most * mip, "{size}: {area} {mip}");
            }
        }
    }
}
