//! The baseline renderer. It draws a flat scene as the program did before it had textured floors, a
//! sky, fog and things.
//!
//! Each column is a ray, each half of the picture is a fill, and each pixel of a wall is the
//! nearest texel of the full-size texture. It is kept unchanged to measure how much all later
//! features cost a scene without them.

use std::ops::Range;

use cellcaster::cast::{Caster, Exact, Hit, Ray, Side};
use cellcaster::color::Rgb;
use cellcaster::render::FrameSize;
use cellcaster::world::{Camera, Ceiling, Paint, TileKind, World};
use glam::DVec2;

/// Draws walls between two fills, on square pixels.
pub(crate) struct Baseline {
    width: u32,
    height: u32,
    columns: Vec<Column>,
    pixels: Vec<Rgb>,
}

/// The hit of the ray of one pixel column.
struct Column {
    hit: Option<Hit>,
    rows: Range<u32>,
}

impl Baseline {
    /// A renderer for pictures of this size.
    pub(crate) fn new(size: FrameSize) -> Self {
        let (width, height) = (size.width.get(), size.height.get());
        let pixels = vec![Rgb::BLACK; width as usize * height as usize];
        Self { width, height, columns: Vec::new(), pixels }
    }

    /// Draws the view of `camera` into `world`, which must consist of open floor and walls inside
    /// an enclosing wall.
    pub(crate) fn render(&mut self, world: &World, camera: &Camera) {
        let projection = Projection::new(camera, self.width, self.height);
        self.columns.clear();
        self.columns.extend((0..self.width).map(|column| {
            let ray = projection.ray(column);
            let hit = Exact.cast(world.grid(), &ray);
            Column { hit, rows: projection.wall_rows(hit.map_or(f64::INFINITY, |hit| hit.t)) }
        }));
        self.fill(world);
        self.draw_walls(world, &projection);
    }

    /// The pixels of the last picture, row by row from the top.
    pub(crate) fn pixels(&self) -> &[Rgb] {
        &self.pixels
    }

    fn fill(&mut self, world: &World) {
        let horizon = self.width as usize * (self.height / 2) as usize;
        let (above, below) = self.pixels.split_at_mut(horizon);
        if let Ceiling::Covered(covering) = world.ceiling() {
            above.fill(world.mean_color(covering.pattern.first_paint()));
        }
        below.fill(world.mean_color(world.floor().pattern.first_paint()));
    }

    fn draw_walls(&mut self, world: &World, projection: &Projection) {
        let width = self.width as usize;
        for (x, column) in self.columns.iter().enumerate() {
            let Some(hit) = &column.hit else { continue };
            let rows = column.rows.clone();
            let pixels = self.pixels[x..].iter_mut().step_by(width);
            let pixels = pixels.skip(rows.start as usize).take(rows.len());
            match paint_of(world, hit) {
                Paint::Color(color) => {
                    let color = shaded(color, hit.side);
                    pixels.for_each(|pixel| *pixel = color);
                }
                Paint::Texture(texture) => {
                    let texels = world.texture(texture).column(hit.u);
                    let texel = projection.texel_on_the_wall(hit.t, texels.len());
                    for (row, pixel) in rows.zip(pixels) {
                        *pixel = shaded(texels[texel(row)], hit.side);
                    }
                }
            }
        }
    }
}

fn paint_of(world: &World, hit: &Hit) -> Paint {
    let tile = world.grid().tile(i64::from(hit.cell.column), i64::from(hit.cell.row));
    match tile.map(|tile| world.tile(tile).kind) {
        Some(TileKind::Wall(paint)) => paint,
        _ => world.floor().pattern.first_paint(),
    }
}

fn shaded(color: Rgb, side: Side) -> Rgb {
    match side {
        Side::X => color,
        Side::Y => color.halved(),
    }
}

/// The mapping from the world to pixels.
struct Projection {
    origin: DVec2,
    direction: DVec2,
    plane: DVec2,
    width: f64,
    height: f64,
    horizon: f64,
    focal_length: f64,
}

impl Projection {
    fn new(camera: &Camera, width: u32, height: u32) -> Self {
        let (width, height) = (f64::from(width), f64::from(height));
        Self {
            origin: camera.position(),
            direction: camera.direction(),
            plane: camera.plane(),
            width,
            height,
            horizon: height / 2.0,
            focal_length: width / 2.0 / camera.field_of_view.half_width(),
        }
    }

    fn ray(&self, column: u32) -> Ray {
        let across = (f64::from(column) * 2.0 + 1.0 - self.width) / self.width;
        Ray::new(self.origin, self.direction + self.plane * across)
            .expect("a camera is at a finite place, and its plane is not parallel to its view")
    }

    fn wall_rows(&self, t: f64) -> Range<u32> {
        let half = 0.5 * self.focal_length / t;
        self.first_row_below(self.horizon - half)..self.first_row_below(self.horizon + half)
    }

    fn texel_on_the_wall(&self, t: f64, count: usize) -> impl Fn(u32) -> usize {
        let texels_per_row = (t / self.focal_length * count as f64).max(f64::MIN_POSITIVE);
        let middle = (count / 2) as i64;
        let from_middle = if count.is_multiple_of(2) { 0.0 } else { 0.5 };
        let last = count as i64 - 1;
        let horizon = self.horizon;
        move |row| {
            let below = (f64::from(row) + 0.5 - horizon) * texels_per_row + from_middle;
            (middle + floor(below)).clamp(0, last) as usize
        }
    }

    fn first_row_below(&self, y: f64) -> u32 {
        (y - 0.5).ceil().clamp(0.0, self.height) as u32
    }
}

fn floor(value: f64) -> i64 {
    let truncated = value as i64;
    truncated - i64::from(value < truncated as f64)
}
