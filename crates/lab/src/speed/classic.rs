//! The classic loop: walls by column, and floors by column or by row, as found in tutorials.
//!
//! It follows the formulas of the tutorials: double precision, row-major textures of one size that
//! the compiler knows, and a row-major picture that is written column by column. It draws plain
//! walls only, and the camera must be inside a closed map.
//!
//! It takes as long as the same loop in C++, compiled by `g++ -O3`, or less. For that reason,
//! doubles become integers by an [addition](floor_of), because conversions in Rust saturate. Every
//! index into a texture or the map is masked, so that no bounds are checked there.

use glam::DVec2;

use cellcaster::world::{Camera, Ceiling, Covering, Paint, TileId, TileKind, World};

/// The classic loop's method for floor and ceiling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClassicFloor {
    /// One colour each.
    None,
    /// Below and above each wall, after the wall of the column.
    ByColumn,
    /// Row by row over the whole picture, before the walls.
    ByScanline,
}

/// The classic loop with its own copy of a map.
#[derive(Clone, Debug)]
pub(crate) struct Classic {
    /// 0 for floor, otherwise the wall's texture plus 1.
    map: [[u8; MAP]; MAP],
    textures: Vec<WallTexture>,
    floor: WallTexture,
    ceiling: WallTexture,
}

/// A row-major texture.
#[derive(Clone, Debug)]
struct WallTexture(Box<[u32; TEXELS * TEXELS]>);

/// A camera with precomputed sine and cosine of its heading.
struct View {
    position: DVec2,
    direction: DVec2,
    plane: DVec2,
}

/// The largest number of columns and rows of a map.
const MAP: usize = 32;
/// The width and the height of each texture.
const TEXELS: usize = 64;
const OF_TEXELS: f64 = TEXELS as f64;

impl Classic {
    /// The loop for `world`. It copies the walls, and the map's default floor and ceiling.
    ///
    /// # Panics
    /// Panics if the map has more than 32 columns or rows.
    pub(crate) fn new(world: &World) -> Self {
        let mut textures = Vec::new();
        let mut wall = |paint: Paint| {
            textures.push(WallTexture::of(world, paint));
            textures.len() as u8
        };
        let kinds: Vec<u8> = world
            .tiles()
            .iter()
            .map(|tile| match tile.kind {
                TileKind::Wall(paint) => wall(paint),
                _ => 0,
            })
            .collect();
        let mut map = [[0; MAP]; MAP];
        for (row, tiles) in world.grid().rows().enumerate() {
            for (column, &TileId(tile)) in tiles.iter().enumerate() {
                map[row][column] = kinds[usize::from(tile)];
            }
        }
        let covering = |covering: Covering| WallTexture::of(world, covering.pattern.first_paint());
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
    /// Panics if there are fewer pixels.
    pub(crate) fn draw(
        &self,
        camera: &Camera,
        floor: ClassicFloor,
        (width, height): (usize, usize),
        pixels: &mut [u32],
    ) {
        let view = &View {
            position: camera.position(),
            direction: camera.direction(),
            plane: camera.plane(),
        };
        match floor {
            ClassicFloor::None => {
                let (above, below) = pixels.split_at_mut(width * (height / 2));
                above.fill(self.ceiling.0[0]);
                below.fill(self.floor.0[0]);
            }
            ClassicFloor::ByColumn => {}
            ClassicFloor::ByScanline => self.draw_planes(view, (width, height), pixels),
        }
        for x in 0..width {
            self.draw_column(view, floor, (width, height), x, pixels);
        }
    }

    fn draw_column(
        &self,
        view: &View,
        floor: ClassicFloor,
        (width, height): (usize, usize),
        x: usize,
        pixels: &mut [u32],
    ) {
        let &View { position, direction, plane } = view;
        let across = 2.0 * x as f64 / width as f64 - 1.0;
        let ray = direction + plane * across;
        let (mut column, mut row) = (position.x as i32, position.y as i32);
        let delta = (1.0 / ray.x).abs();
        let delta_y = (1.0 / ray.y).abs();
        let (step_x, mut side_x) = if ray.x < 0.0 {
            (-1, (position.x - f64::from(column)) * delta)
        } else {
            (1, (f64::from(column) + 1.0 - position.x) * delta)
        };
        let (step_y, mut side_y) = if ray.y < 0.0 {
            (-1, (position.y - f64::from(row)) * delta_y)
        } else {
            (1, (f64::from(row) + 1.0 - position.y) * delta_y)
        };
        let kind_in = |column: i32, row: i32| self.map[row as usize % MAP][column as usize % MAP];
        // There are two loops, because a compiler would turn one loop into code without branches,
        // in which each step waits for the comparison before it.
        let (is_y_side, kind) = 'cast: loop {
            while side_x < side_y {
                side_x += delta;
                column += step_x;
                let kind = kind_in(column, row);
                if kind > 0 {
                    break 'cast (false, kind);
                }
            }
            side_y += delta_y;
            row += step_y;
            let kind = kind_in(column, row);
            if kind > 0 {
                break (true, kind);
            }
        };
        let texture = &self.textures[usize::from(kind) - 1];
        let distance = if is_y_side { side_y - delta_y } else { side_x - delta };

        let half = height as i32 / 2;
        let line = (height as f64 / distance) as i32;
        let start = (half - line / 2).max(0);
        let end = (half + line / 2 + 1).min(height as i32);
        let place =
            if is_y_side { position.x + distance * ray.x } else { position.y + distance * ray.y };
        let place = place - f64::from(place as i32);
        let mut texel_x = floor_of(place * OF_TEXELS) as usize % TEXELS;
        if (!is_y_side && ray.x > 0.0) || (is_y_side && ray.y < 0.0) {
            texel_x = TEXELS - texel_x - 1;
        }
        let step = OF_TEXELS / f64::from(line);
        let mut texel = f64::from(start - half + line / 2) * step;
        let mut index = start as usize * width + x;
        for _ in start..end {
            let texel_y = floor_of(texel) as usize % TEXELS;
            texel += step;
            let mut color = texture.0[TEXELS * texel_y + texel_x];
            if is_y_side {
                color = color >> 1 & 0x007f_7f7f;
            }
            pixels[index] = color;
            index += width;
        }
        if floor == ClassicFloor::ByColumn {
            let (column, row) = (f64::from(column), f64::from(row));
            let at_wall = match (is_y_side, ray.x > 0.0, ray.y > 0.0) {
                (false, true, _) => (column, row + place),
                (false, false, _) => (column + 1.0, row + place),
                (true, _, true) => (column + place, row),
                (true, _, false) => (column + place, row + 1.0),
            };
            for y in end..height as i32 {
                let here = height as f64 / f64::from(2 * y - height as i32);
                let weight = here / distance;
                let floor_x = weight * at_wall.0 + (1.0 - weight) * position.x;
                let floor_y = weight * at_wall.1 + (1.0 - weight) * position.y;
                let texel = texel_at(floor_x, floor_y);
                pixels[y as usize * width + x] = self.floor.0[texel];
                pixels[(height - y as usize) * width + x] = self.ceiling.0[texel];
            }
            // The middle row is not the mirror image of a floor row, so it is copied from the row
            // below.
            if start > 0 {
                pixels[x] = pixels[width + x];
            }
        }
    }

    fn draw_planes(&self, view: &View, (width, height): (usize, usize), pixels: &mut [u32]) {
        let &View { position, direction, plane } = view;
        let (left, right) = (direction - plane, direction + plane);
        for y in height / 2..height {
            let below = y as f64 - height as f64 / 2.0;
            let distance = 0.5 * height as f64 / below.max(0.5);
            let step = (right - left) * (distance / width as f64);
            let mut place = position + left * distance;
            let (above, below) = pixels.split_at_mut(y * width);
            let ceiling = &mut above[(height - y - 1) * width..];
            for (floor, ceiling) in below[..width].iter_mut().zip(ceiling) {
                let texel = texel_at(place.x, place.y);
                *floor = self.floor.0[texel];
                *ceiling = self.ceiling.0[texel];
                place += step;
            }
        }
    }
}

impl WallTexture {
    fn of(world: &World, paint: Paint) -> Self {
        const OF_BOTH: u64 = 2 * TEXELS as u64;
        let color = |x: u32, y: u32| match paint {
            Paint::Color(color) => color,
            Paint::Texture(id) => {
                let level = world.texture(id).level(0);
                // If the texture has another size, the nearest texels are taken.
                let middle = |index: u32| u64::from(2 * index + 1) * (u64::MAX / OF_BOTH);
                level.at_fraction(middle(x), middle(y))
            }
        };
        let texels = (0..TEXELS as u32).flat_map(|y| (0..TEXELS as u32).map(move |x| (x, y)));
        let texels: Vec<u32> = texels.map(|(x, y)| color(x, y).to_bits()).collect();
        Self(texels.try_into().expect("it is as long as the array"))
    }
}

/// The index of the texel at a point of the floor.
fn texel_at(x: f64, y: f64) -> usize {
    let texel = |along: f64| floor_of(along * OF_TEXELS) as usize % TEXELS;
    TEXELS * texel(y) + texel(x)
}

/// The largest integer not above `number`, modulo a power of two. Off by one if `number` is less
/// than 2⁻²⁰ below an integer.
fn floor_of(number: f64) -> u32 {
    // A double of this size has 20 bits after the binary point.
    const LARGE: f64 = (3_u64 << 31) as f64;
    ((number + LARGE).to_bits() >> 20) as u32
}
