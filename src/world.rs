//! What exists: a grid of tiles, the things that stand on it, their colours and textures.
//!
//! A [`World`] is valid by construction: every index in it points at something, its start is on
//! open floor, and no later stage checks again. It is made by [`map::parse`](crate::map::parse)
//! and its siblings, which name every fault of a map with its place; building one by hand, with
//! faults that have no place to name, was refused.
//!
//! A map's world has all doors closed and all keys in their places. What happens to them happens in
//! a game's own world, so that whoever draws it needs to be handed nothing else.

mod air;
mod camera;
mod clearance;
mod color;
mod covering;
mod door;
mod face_light;
mod grid;
mod heights;
mod lamplight;
mod parts;
mod pitch;
mod shafts;
mod shape;
pub mod sprite;
mod summary;
pub mod texture;
mod things;
mod tile;

pub use air::{Fog, Light, Sky};
pub use camera::{Camera, FieldOfView, Heading};
pub(crate) use clearance::Clearance;
pub use color::{NotAColor, Rgb};
pub use covering::{Ceiling, Covering, Pattern, Scale};
use door::Ajar;
pub use door::{Door, KeyId, Opening};
pub(crate) use face_light::FaceLight;
pub use grid::{Cell, Grid, TileId};
pub use heights::{Gap, Heights};
pub(crate) use lamplight::Lamplight;
pub use lamplight::{Lamp, Reach};
pub(crate) use parts::Parts;
pub use pitch::Pitch;
pub(crate) use shafts::{Bundle, FRACTION_BITS, STRIP, Shafts};
pub use shape::{Line, Outline, PillarRadius, Shape, ShapeHeight};
pub use sprite::{Anchor, Facings, FrameTime, Sprite, SpriteHeight, SpriteId};
pub use texture::Texture;
use things::Things;
pub use things::{Thing, ThingKind};
pub use tile::{Glass, Paint, TextureId, Tile, TileKind};

/// What a level consists of.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    title: String,
    goal: Option<String>,
    grid: Grid,
    /// The same as rays see it that end at what is not level, where anything is not.
    level_grid: Option<Grid>,
    tiles: Vec<Tile>,
    textures: Vec<Texture>,
    floor: Covering,
    ceiling: Ceiling,
    sky: Sky,
    fog: Option<Fog>,
    start: Start,
    sprites: Vec<Sprite>,
    things: Things,
    lamplight: Lamplight,
    /// Whether cells may be lit differently.
    light_varies: bool,
    keys: Vec<String>,
    ajar: Ajar,
}

/// Where the player starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The cell in whose middle the player stands.
    pub cell: Cell,
    /// Which way the player looks.
    pub heading: Heading,
}

impl World {
    /// The level's name; empty where the map gives none.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// What the map tells the player to do, if it says so.
    pub fn goal(&self) -> Option<&str> {
        self.goal.as_deref()
    }

    /// Which tile each cell holds.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The grid as rays see it that end at what is not level: that is solid in it. `None` where everything
    /// is level.
    pub(crate) fn level_grid(&self) -> Option<&Grid> {
        self.level_grid.as_ref()
    }

    /// The kinds of tile that the grid refers to.
    pub fn tiles(&self) -> &[Tile] {
        &self.tiles
    }

    /// What `id`, a tile of this world's grid, stands for.
    ///
    /// # Panics
    /// Where `id` is from another world that has more tiles.
    pub fn tile(&self, id: TileId) -> Tile {
        self.tiles[usize::from(id.0)]
    }

    /// The heights of the floor and the ceiling in `cell`; off the map, those of the map's own floor.
    pub fn room_in(&self, cell: Cell) -> Heights {
        self.tile_at(cell).unwrap_or(self.ground()).heights
    }

    /// How high the floor in `cell` is, or the top of a wall; 0 off the map.
    pub fn floor_at(&self, cell: Cell) -> f64 {
        self.tile_at(cell).map_or(0.0, |tile| tile.heights.floor())
    }

    /// How bright it is in `cell`: as its tile says, and what lamps add; of a wall, as its own sides
    /// are, where it says so.
    pub fn light_in(&self, cell: Cell) -> Light {
        let own = self.tile_at(cell).unwrap_or(self.ground()).light;
        own.unwrap_or(Light::FULL).plus(self.lamplight.at(cell))
    }

    /// What lamps add to the light in `cell`.
    #[inline]
    pub(crate) fn lamplight_in(&self, cell: Cell) -> Light {
        self.lamplight.at(cell)
    }

    /// The texture `id` of this world.
    ///
    /// # Panics
    /// Where `id` is from another world that has more textures.
    pub fn texture(&self, id: TextureId) -> &Texture {
        &self.textures[usize::from(id.0)]
    }

    /// The one colour that stands for `paint`: itself, or the mean of its texture.
    pub fn mean_color(&self, paint: Paint) -> Rgb {
        match paint {
            Paint::Color(color) => color,
            Paint::Texture(id) => self.texture(id).mean(),
        }
    }

    /// What the floor is laid with where no tile has its own, and beyond the edge of the map.
    pub fn floor(&self) -> Covering {
        self.floor
    }

    /// What is overhead where no tile has its own ceiling. Beyond the edge of the map is sky.
    pub fn ceiling(&self) -> Ceiling {
        self.ceiling
    }

    /// The open floor that is as the map says: what `.` stands for.
    pub fn ground(&self) -> Tile {
        self.tiles[0]
    }

    /// What the sky looks like.
    pub fn sky(&self) -> Sky {
        self.sky
    }

    /// What everything fades into, if anything.
    pub fn fog(&self) -> Option<Fog> {
        self.fog
    }

    /// Where the player starts.
    pub fn start(&self) -> Start {
        self.start
    }

    /// A camera where the player starts.
    pub fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        let camera = Camera::in_cell(self.start.cell, self.start.heading, field_of_view);
        camera.with_eye(self.floor_at(self.start.cell) + Camera::STANDING).unwrap_or(camera)
    }

    /// The sprite `id` of this world.
    ///
    /// # Panics
    /// Where `id` is from another world that has more sprites.
    pub fn sprite(&self, id: SpriteId) -> &Sprite {
        &self.sprites[usize::from(id.0)]
    }

    /// The sprites that the things refer to.
    pub(crate) fn sprites(&self) -> &[Sprite] {
        &self.sprites
    }

    fn tile_at(&self, cell: Cell) -> Option<Tile> {
        let tile = self.grid.tile(i64::from(cell.column), i64::from(cell.row))?;
        Some(self.tile(tile))
    }
}
