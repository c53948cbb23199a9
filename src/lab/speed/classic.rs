//! The classic loop: walls by column, and floors by column or by row, as in tutorials.
//!
//! It follows their formulas and is deliberately not improved: double precision, row-major
//! textures, and a row-major picture that is written column by column. It draws plain walls only,
//! and the camera must be inside a closed map.

use crate::color::Rgb;
use crate::world::texture::MipLevel;
use crate::world::{Camera, Ceiling, Covering, Paint, TileId, TileKind, World};

/// The classic loop's method for floor and ceiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClassicFloor {
    /// One colour each.
    None,
    /// Below and above each wall, after the wall of the column.
    ByColumn,
    /// Row by row over the whole picture, before the walls.
    ByScanline,
}

/// The classic loop with its own copy of a map.
#[derive(Clone, Debug)]
pub struct Classic {
    /// 0 for floor, otherwise the wall's texture plus 1.
    map: Vec<Vec<usize>>,
    textures: Vec<Picture>,
    floor: Picture,
    ceiling: Picture,
}

/// A row-major texture.
#[derive(Clone, Debug)]
struct Picture {
    width: usize,
    height: usize,
    texels: Vec<u32>,
}

impl Classic {
    /// The loop for `world`. It copies the walls, and the map's default floor and ceiling.
    pub fn new(world: &World) -> Self {
        let mut textures = Vec::new();
        let mut wall = |paint: Paint| {
            textures.push(Picture::of(world, paint));
            textures.len()
        };
        let kinds: Vec<usize> = world
            .tiles()
            .iter()
            .map(|tile| match tile.kind {
                TileKind::Wall(paint) => wall(paint),
                _ => 0,
            })
            .collect();
        let kind = |tile: &TileId| kinds[usize::from(tile.0)];
        let map = world.grid().rows().map(|row| row.iter().map(kind).collect()).collect();
        let covering = |covering: Covering| Picture::of(world, covering.pattern.first_paint());
        let floor = covering(world.floor());
        let ceiling = match world.ceiling() {
            Ceiling::Covered(ceiling) => covering(ceiling),
            Ceiling::Sky => floor.clone(),
        };
        Self { map, textures, floor, ceiling }
    }

    /// Draws the view of `camera` into `pixels`, row by row, `width` × `height` of them.
    ///
    /// # Panics
    /// Panics if there are fewer pixels, or if a ray leaves the map.
    pub fn draw(
        &self,
        camera: &Camera,
        floor: ClassicFloor,
        (width, height): (usize, usize),
        pixels: &mut [u32],
    ) {
        match floor {
            ClassicFloor::None => {
                let (above, below) = pixels.split_at_mut(width * (height / 2));
                above.fill(self.ceiling.texels[0]);
                below.fill(self.floor.texels[0]);
            }
            ClassicFloor::ByColumn => {}
            ClassicFloor::ByScanline => self.draw_planes(camera, (width, height), pixels),
        }
        for x in 0..width {
            self.draw_column(camera, floor, (width, height), x, pixels);
        }
    }

    fn draw_column(
        &self,
        camera: &Camera,
        floor: ClassicFloor,
        (width, height): (usize, usize),
        x: usize,
        pixels: &mut [u32],
    ) {
        let (position, direction, plane) = (camera.position(), camera.direction(), camera.plane());
        let across = 2.0 * x as f64 / width as f64 - 1.0;
        let ray = direction + plane * across;
        let (mut column, mut row) = (position.x as usize, position.y as usize);
        let delta = (1.0 / ray.x).abs();
        let delta_y = (1.0 / ray.y).abs();
        let (step_x, mut side_x) = if ray.x < 0.0 {
            (usize::MAX, (position.x - column as f64) * delta)
        } else {
            (1, (column as f64 + 1.0 - position.x) * delta)
        };
        let (step_y, mut side_y) = if ray.y < 0.0 {
            (usize::MAX, (position.y - row as f64) * delta_y)
        } else {
            (1, (row as f64 + 1.0 - position.y) * delta_y)
        };
        let mut is_y_side;
        loop {
            if side_x < side_y {
                side_x += delta;
                column = column.wrapping_add(step_x);
                is_y_side = false;
            } else {
                side_y += delta_y;
                row = row.wrapping_add(step_y);
                is_y_side = true;
            }
            if self.map[row][column] > 0 {
                break;
            }
        }
        let distance = if is_y_side { side_y - delta_y } else { side_x - delta };

        let line = (height as f64 / distance) as i64;
        let start = (height as i64 / 2 - line / 2).max(0);
        let end = (height as i64 / 2 + line / 2).min(height as i64 - 1);
        let place =
            if is_y_side { position.x + distance * ray.x } else { position.y + distance * ray.y };
        let place = place - place.floor();
        let texture = &self.textures[self.map[row][column] - 1];
        let mut texel_x = (place * texture.width as f64) as usize;
        if (!is_y_side && ray.x > 0.0) || (is_y_side && ray.y < 0.0) {
            texel_x = texture.width - texel_x - 1;
        }
        let step = texture.height as f64 / line as f64;
        let mut texel = (start - height as i64 / 2 + line / 2) as f64 * step;
        for y in start..=end {
            let texel_y = texel as usize & (texture.height - 1);
            texel += step;
            let mut color = texture.texels[texture.width * texel_y + texel_x];
            if is_y_side {
                color = color >> 1 & 0x007f_7f7f;
            }
            pixels[y as usize * width + x] = color;
        }
        if floor == ClassicFloor::ByColumn {
            let at_wall = match (is_y_side, ray.x > 0.0, ray.y > 0.0) {
                (false, true, _) => (column as f64, row as f64 + place),
                (false, false, _) => (column as f64 + 1.0, row as f64 + place),
                (true, _, true) => (column as f64 + place, row as f64),
                (true, _, false) => (column as f64 + place, row as f64 + 1.0),
            };
            for y in end as usize + 1..height {
                let here = height as f64 / (2.0 * y as f64 - height as f64);
                let weight = here / distance;
                let floor_x = weight * at_wall.0 + (1.0 - weight) * position.x;
                let floor_y = weight * at_wall.1 + (1.0 - weight) * position.y;
                pixels[y * width + x] = self.floor.at(floor_x, floor_y);
                pixels[(height - y) * width + x] = self.ceiling.at(floor_x, floor_y);
            }
            // The middle row, which is not the mirror image of a floor row.
            if start > 0 {
                pixels[x] = pixels[width + x];
            }
        }
    }

    fn draw_planes(&self, camera: &Camera, (width, height): (usize, usize), pixels: &mut [u32]) {
        let (position, direction, plane) = (camera.position(), camera.direction(), camera.plane());
        let (left, right) = (direction - plane, direction + plane);
        for y in height / 2..height {
            let below = y as f64 - height as f64 / 2.0;
            let distance = 0.5 * height as f64 / below.max(0.5);
            let step = (right - left) * (distance / width as f64);
            let mut place = position + left * distance;
            for x in 0..width {
                pixels[y * width + x] = self.floor.at(place.x, place.y);
                pixels[(height - y - 1) * width + x] = self.ceiling.at(place.x, place.y);
                place += step;
            }
        }
    }
}

impl Picture {
    fn of(world: &World, paint: Paint) -> Self {
        match paint {
            Paint::Color(color) => Self { width: 1, height: 1, texels: vec![packed(color)] },
            Paint::Texture(id) => Self::of_level(world.texture(id).level(0)),
        }
    }

    fn of_level(level: &MipLevel) -> Self {
        let (width, height) = (level.width(), level.height());
        let at = |x: u32, y: u32| {
            let middle = |index: u32, count: u32| {
                (((2 * u128::from(index) + 1) << 63) / u128::from(count)) as u64
            };
            packed(level.at_fraction(middle(x, width), middle(y, height)))
        };
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        Self {
            width: width as usize,
            height: height as usize,
            texels: texels.map(|(x, y)| at(x, y)).collect(),
        }
    }

    fn at(&self, x: f64, y: f64) -> u32 {
        let texel_x = (x * self.width as f64) as usize & (self.width - 1);
        let texel_y = (y * self.height as f64) as usize & (self.height - 1);
        self.texels[self.width * texel_y + texel_x]
    }
}

fn packed(color: Rgb) -> u32 {
    let [red, green, blue] = color.channels();
    u32::from_be_bytes([0, red, green, blue])
}
