//! The colours of the pixels of a map with plain colours, in rational arithmetic.

use cellcaster::color::Rgb;
use cellcaster::render::Frame;
use cellcaster::world::{Camera, Tile, TileKind, World};
use glam::DVec2;
use num_rational::BigRational;
use num_traits::{Signed, Zero};

use super::{CEILING, DOUBTFUL, FLOOR};

/// A camera and a world in exact numbers.
pub(crate) struct Geometry<'a> {
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

/// The hit of a ray: a face of a wall, or the edge of the map.
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
    pub(crate) fn new(world: &'a World, camera: &Camera, frame: &Frame) -> Self {
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

    /// The colour of a pixel; `None` if its centre is too close to an edge.
    pub(crate) fn color(&self, x: u32, y: u32) -> Option<Rgb> {
        let (across, doubt) = (exact(f64::from(x) + 0.5), exact(DOUBTFUL));
        let met = self.cast(&across);
        for beside in [&across - &doubt, &across + &doubt] {
            if self.cast(&beside).place != met.place {
                return None;
            }
        }
        // The distances from the horizon downwards, to the pixel's centre and to the wall's end.
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

    /// The same as [`Geometry::color`], for a wall with light; `None` for anything else.
    pub(crate) fn lit_color(&self, x: u32, y: u32) -> Option<Rgb> {
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

    /// The light at the hit of the ray through `across`, in 256ths.
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
        // The cell in front of the face, the direction along the face, and the position along it.
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
        let tile_here = tile_in(here.0, here.1).unwrap();
        let light_here = light(tile_here);
        // A camera inside a wall sees the next wall in the light of its own cell, into which no
        // light passes.
        let is_open = |tile: &Tile| tile.kind == TileKind::Open;
        let light_next = match next {
            Some(next) if is_open(&next) && is_open(&tile_here) => light(next),
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

    /// The hit of the ray through the column `across`.
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

    /// The distance to the edge of the map along a ray that starts on the map.
    fn edge(&self, direction: &Point) -> BigRational {
        let grid = self.world.grid();
        let x = leaving(&self.origin.x, &direction.x, grid.width());
        let y = leaving(&self.origin.y, &direction.y, grid.height());
        x.into_iter().chain(y).min().unwrap()
    }
}

/// The distance to the line by which a ray enters the cells with this index; `None` if it does not.
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
