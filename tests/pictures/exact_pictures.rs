//! Pictures against exact geometry: every pixel of a flat-coloured map, computed again in rational
//! arithmetic from nothing but the camera, by asking all faces of all walls which is the nearest.

use std::path::Path;

use cellcaster::color::Rgb;
use cellcaster::map;
use cellcaster::render::{Frame, FrameSize, PixelAspect, Renderer};
use cellcaster::world::{Camera, FieldOfView, Heading, Tile, TileKind, World};
use glam::DVec2;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

const MAP: &str = r##"
floor   = "#102030"
ceiling = "#405060"
sky     = { gradient = ["#87b5d9", "#87b5d9"] }
grid = '''
aaabbbc
b.....c
a..d..a
@.....a
c.dc..b
b.....b
aa.accc
'''
[tiles]
"a" = { wall = "#ff0102" }
"b" = { wall = "#03fe04" }
"c" = { wall = "#0506fd" }
"d" = { wall = "#fcfb07" }
[things]
"@" = { start = 0 }
"##;

const FLOOR: Rgb = Rgb::new(0x10, 0x20, 0x30);
const CEILING: Rgb = Rgb::new(0x40, 0x50, 0x60);

/// The same map with floor of several lights, and a wall with one of its own.
fn lit_map() -> String {
    let cells = MAP
        .replace("b.....c\na..d", "be..f.c\na.fd")
        .replace("c.dc..b\nb.....b", "cedc.eb\nbf..ffb");
    let d = r##""d" = { wall = "#fcfb07" }"##;
    let lit = "\"e\" = { light = 0.2 }\n\"f\" = { light = 0.9 }\n\"d\" = { wall = \"#fcfb07\", light = 0.7 }";
    assert!(cells.contains(d));
    cells.replace(d, lit).replace("floor   =", "light = 0.5\nfloor   =")
}

/// How near to an edge a pixel's centre may be before its colour is anybody's guess, in pixels.
const DOUBTFUL: f64 = 1e-6;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn every_pixel_is_where_geometry_says(
        position in (0.0..7.0, 0.0..7.0),
        degrees in prop_oneof![0.0..360.0, (0..8).prop_map(|eighth| 45.0 * f64::from(eighth))],
        field_of_view in prop_oneof![8 => 30.0..=120.0, 1 => Just(0.001), 1 => Just(179.9)],
        size in (1_u32..24, 1_u32..24),
        aspect in prop_oneof![Just(1.0), Just(2.0), 0.3..4.0],
    ) {
        let world = map::parse_str(MAP).unwrap();
        let camera = Camera::new(
            DVec2::from(position),
            Heading::from_degrees(degrees).unwrap(),
            FieldOfView::from_degrees(field_of_view).unwrap(),
        ).unwrap();
        let pixel_aspect = PixelAspect::new(aspect).unwrap();
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), pixel_aspect);
        Renderer::new().render(&world, &camera, &mut frame);

        let geometry = Geometry::new(&world, &camera, &frame);
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            if let Some(color) = geometry.color(x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Along a wall, light goes over from the middle of one cell before it to that of the next.
    #[test]
    fn every_pixel_of_a_wall_is_as_bright_as_geometry_says(
        position in (1.1..5.9, 1.1..5.9),
        degrees in 0.0..360.0,
        size in (1_u32..24, 1_u32..12),
    ) {
        let world = map::parse_str(&lit_map()).unwrap();
        let heading = Heading::from_degrees(degrees).unwrap();
        let camera = Camera::new(position.into(), heading, FieldOfView::default()).unwrap();
        let mut frame = Frame::new(FrameSize::new(size.0, size.1).unwrap(), PixelAspect::SQUARE);
        Renderer::new().render(&world, &camera, &mut frame);
        let geometry = Geometry::new(&world, &camera, &frame);
        for (x, y) in (0..size.0).flat_map(|x| (0..size.1).map(move |y| (x, y))) {
            if let Some(color) = geometry.lit_color(x, y) {
                prop_assert_eq!(frame.pixel(x, y), color, "at ({}, {})", x, y);
            }
        }
    }
}

#[test]
fn a_huge_picture_is_as_exact_as_a_small_one() {
    let world = map::parse_str(MAP).unwrap();
    let heading = Heading::from_degrees(33.0).unwrap();
    let camera = Camera::new(DVec2::new(1.7, 2.4), heading, FieldOfView::default()).unwrap();
    let mut frame = Frame::new(FrameSize::new(4000, 2000).unwrap(), PixelAspect::SQUARE);
    Renderer::new().render(&world, &camera, &mut frame);
    let geometry = Geometry::new(&world, &camera, &frame);
    let mut compared = 0;
    for (x, y) in (0..4000).step_by(97).flat_map(|x| (0..2000).step_by(211).map(move |y| (x, y))) {
        if let Some(color) = geometry.color(x, y) {
            assert_eq!(frame.pixel(x, y), color, "at ({x}, {y})");
            compared += 1;
        }
    }
    assert!(compared > 400);
}

#[test]
fn a_wall_before_the_nose_shows_the_texels_at_eye_height() {
    // The texture has 64 rows, whose red is their number; the wall's face is at x = 0.
    let world = map::load(Path::new("tests/maps/nose.toml")).unwrap();
    let mut frame = Frame::new(FrameSize::new(40, 24).unwrap(), PixelAspect::SQUARE);
    for gap in [1e-12, 1e-30, 1e-300, 5e-324] {
        let position = DVec2::new(-gap, 0.5);
        let camera = Camera::new(position, Heading::default(), FieldOfView::default()).unwrap();
        Renderer::new().render(&world, &camera, &mut frame);
        for (y, row) in frame.rows().enumerate() {
            let texel = if y < 12 { 31 } else { 32 };
            assert!(row.iter().all(|pixel| pixel.red() == texel), "row {y}, {gap} from the wall");
        }
    }
}

/// A camera before a world, in exact numbers.
struct Geometry<'a> {
    world: &'a World,
    origin: Point,
    direction: Point,
    plane: Point,
    width: BigRational,
    height: BigRational,
    focal_length: BigRational,
}

struct Point {
    x: BigRational,
    y: BigRational,
}

/// What a ray meets: a face of a wall, or the edge of the map.
struct Met {
    place: Option<(i64, i64, Face)>,
    distance: BigRational,
}

#[derive(Clone, Copy, PartialEq)]
enum Face {
    X,
    Y,
}

impl<'a> Geometry<'a> {
    fn new(world: &'a World, camera: &Camera, frame: &Frame) -> Self {
        let width = exact(f64::from(frame.width()));
        let half_width = exact(camera.field_of_view.half_width());
        let pixel_aspect = exact(frame.pixel_aspect().height_over_width());
        Self {
            world,
            origin: Point::from(camera.position()),
            direction: Point::from(camera.direction()),
            plane: Point::from(camera.plane()),
            focal_length: &width / exact(2.0) / half_width / pixel_aspect,
            width,
            height: exact(f64::from(frame.height())),
        }
    }

    /// The colour of a pixel; `None` where its centre is too near to an edge.
    fn color(&self, x: u32, y: u32) -> Option<Rgb> {
        let (across, doubt) = (exact(f64::from(x) + 0.5), exact(DOUBTFUL));
        let met = self.cast(&across);
        for beside in [&across - &doubt, &across + &doubt] {
            if self.cast(&beside).place != met.place {
                return None;
            }
        }
        // Rows from the horizon, downwards: to the pixel's centre, and to the wall's end.
        let below = exact(f64::from(y) + 0.5) - &self.height / exact(2.0);
        let half = &self.focal_length / exact(2.0) / &met.distance;
        if (below.abs() - &half).abs() < doubt {
            return None;
        }
        let background = if below.is_negative() { CEILING } else { FLOOR };
        if below.abs() > half {
            return Some(background);
        }
        match met.place {
            Some((column, row, face)) => {
                let color = self.wall_color(column, row);
                Some(if face == Face::Y { color.halved() } else { color })
            }
            None if below.abs() < doubt => None,
            None if below.is_negative() => Some(Rgb::SKY),
            None => Some(FLOOR),
        }
    }

    /// As [`Geometry::color`], of a wall in its light; `None` elsewhere, too.
    fn lit_color(&self, x: u32, y: u32) -> Option<Rgb> {
        let color = self.color(x, y)?;
        let across = f64::from(x) + 0.5;
        let met = self.cast(&exact(across));
        let (column, row, face) = met.place?;
        let below = exact(f64::from(y) + 0.5) - &self.height / exact(2.0);
        if below.abs() > &self.focal_length / exact(2.0) / &met.distance {
            return None;
        }
        let lights = [across - DOUBTFUL, across, across + DOUBTFUL]
            .map(|across| self.light(&exact(across), (column, row, face)));
        let [red, green, blue] = self.wall_color(column, row).channels();
        let share = lights[1] / if face == Face::Y { 2 } else { 1 };
        let lit = |channel: u8| (u32::from(channel) * share / 256) as u8;
        assert!(color == self.wall_color(column, row) || face == Face::Y);
        lights
            .windows(2)
            .all(|pair| pair[0] == pair[1])
            .then(|| Rgb::new(lit(red), lit(green), lit(blue)))
    }

    /// The light, in 256ths, where the ray through `across` meets a face.
    fn light(&self, across: &BigRational, (column, row, face): (i64, i64, Face)) -> u32 {
        let tile_in = |column: i64, row: i64| {
            self.world.grid().tile(column, row).map(|id| self.world.tile(id))
        };
        let own = tile_in(column, row).and_then(|tile| tile.light);
        if let Some(own) = own {
            return own.in_256ths();
        }
        let share = across * exact(2.0) / &self.width - exact(1.0);
        let direction = Point {
            x: &self.direction.x + &self.plane.x * &share,
            y: &self.direction.y + &self.plane.y * &share,
        };
        let before = |along: &BigRational| if along.is_positive() { -1 } else { 1 };
        let t = self.cast(across).distance;
        // The cell before the face, the way along it, and how far along that is.
        let (here, way, along) = match face {
            Face::X => {
                ((column + before(&direction.x), row), (0, 1), &self.origin.y + &t * &direction.y)
            }
            Face::Y => {
                ((column, row + before(&direction.y)), (1, 0), &self.origin.x + &t * &direction.x)
            }
        };
        let index = exact(if face == Face::X { row } else { column } as f64);
        let from_middle = along - index - exact(0.5);
        let sign = if from_middle.is_negative() { -1 } else { 1 };
        let next = tile_in(here.0 + sign * way.0, here.1 + sign * way.1);
        let light = |tile: Tile| exact(f64::from(tile.light.unwrap().in_256ths()));
        let light_here = light(tile_in(here.0, here.1).unwrap());
        let light_next = match next {
            Some(next) if next.kind == TileKind::Open => light(next),
            _ => light_here.clone(),
        };
        let share = from_middle.abs();
        let light = &light_here * (exact(1.0) - &share) + light_next * share;
        u32::try_from((light + exact(0.5)).to_integer()).unwrap()
    }

    fn wall_color(&self, column: i64, row: i64) -> Rgb {
        let tile = self.world.tile(self.world.grid().tile(column, row).unwrap());
        match tile.character {
            'a' => Rgb::new(0xff, 1, 2),
            'b' => Rgb::new(3, 0xfe, 4),
            'c' => Rgb::new(5, 6, 0xfd),
            'd' => Rgb::new(0xfc, 0xfb, 7),
            other => panic!("{other} is no wall"),
        }
    }

    /// What the ray through the points of the picture at `across` meets.
    fn cast(&self, across: &BigRational) -> Met {
        let share = across * exact(2.0) / &self.width - exact(1.0);
        let direction = Point {
            x: &self.direction.x + &self.plane.x * &share,
            y: &self.direction.y + &self.plane.y * &share,
        };
        let grid = self.world.grid();
        let cells = (0..i64::from(grid.height()))
            .flat_map(|row| (0..i64::from(grid.width())).map(move |column| (column, row)));
        cells
            .filter(|&(column, row)| grid.is_solid(column, row))
            .flat_map(|(column, row)| {
                let x = entry(&self.origin.x, &direction.x, column)
                    .filter(|t| is_within(&(&self.origin.y + t * &direction.y), row))
                    .map(|distance| Met { place: Some((column, row, Face::X)), distance });
                let y = entry(&self.origin.y, &direction.y, row)
                    .filter(|t| is_within(&(&self.origin.x + t * &direction.x), column))
                    .map(|distance| Met { place: Some((column, row, Face::Y)), distance });
                x.into_iter().chain(y)
            })
            .min_by(|one, other| one.distance.cmp(&other.distance))
            .unwrap_or_else(|| Met { place: None, distance: self.edge(&direction) })
    }

    /// How far the map goes on along a ray that starts on it.
    fn edge(&self, direction: &Point) -> BigRational {
        let grid = self.world.grid();
        let x = leaving(&self.origin.x, &direction.x, grid.width());
        let y = leaving(&self.origin.y, &direction.y, grid.height());
        x.into_iter().chain(y).min().unwrap()
    }
}

/// How far it is to the line by which a ray enters the cells of that index; `None` if it does not.
fn entry(origin: &BigRational, direction: &BigRational, index: i64) -> Option<BigRational> {
    let line = if direction.is_positive() { index } else { index + 1 };
    let t = (!direction.is_zero()).then(|| (exact(line as f64) - origin) / direction)?;
    (!t.is_negative()).then_some(t)
}

fn leaving(origin: &BigRational, direction: &BigRational, count: u32) -> Option<BigRational> {
    let line = if direction.is_positive() { f64::from(count) } else { 0.0 };
    (!direction.is_zero()).then(|| (exact(line) - origin) / direction)
}

fn is_within(coordinate: &BigRational, index: i64) -> bool {
    exact(index as f64) <= *coordinate && *coordinate <= exact(index as f64 + 1.0)
}

fn exact(number: f64) -> BigRational {
    BigRational::from_float(number).unwrap()
}

impl From<DVec2> for Point {
    fn from(vector: DVec2) -> Self {
        Self { x: exact(vector.x), y: exact(vector.y) }
    }
}
