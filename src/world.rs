//! A world: a grid of tiles, the things that stand on it, and their colours and textures.
//!
//! A [`World`] is valid by construction: every index in it points at something, and its start is on
//! open floor. No later stage checks it again. [`map::parse`](crate::map::parse) and its siblings
//! make worlds, and report every fault of a map with its place. Building a world by hand was
//! refused, since its faults would have no place to report.
//!
//! In the world of a map, all doors are closed and all keys are in their places. A game opens doors
//! and takes keys in its own copy of the world, so that a renderer needs nothing else.

mod air;
mod beam_table;
mod camera;
mod covering;
mod distance_field;
mod door;
mod face_light;
mod figure;
mod flood;
mod grid;
mod guard_post;
mod heights;
mod lamplight;
mod mechanism;
mod mission;
mod parts;
mod pitch;
mod restored;
pub(crate) mod scene;
mod shape;
pub mod sprite;
mod summary;
pub mod texture;
mod things;
mod tile;

use std::sync::Arc;

use crate::color::Rgb;
pub use air::{Fog, Light, Sky, SkyGradient};
pub(crate) use beam_table::{BeamTable, Beams, FRACTION_BITS, STRIP};
pub use camera::{Camera, FieldOfView, Heading};
pub use covering::{Ceiling, Covering, Pattern, Scale};
pub(crate) use distance_field::DistanceField;
use door::Ajar;
pub use door::{Door, KeyId, Opening};
pub(crate) use face_light::FaceLight;
pub use figure::Figure;
pub(crate) use flood::Flood;
pub use grid::{Cell, Grid, TileId};
pub use guard_post::{Difficulty, Duty, GuardKind, GuardPost};
pub use heights::{Gap, Heights};
use lamplight::Lamplight;
pub use lamplight::{Lamp, Reach};
pub use mechanism::{Driver, MovingTile, SwitchId, TileEffect};
pub(crate) use mission::Mission;
pub(crate) use parts::Parts;
pub use pitch::Pitch;
pub(crate) use restored::Changes;
pub use shape::{Line, Outline, PillarRadius, Shape, ShapeHeight};
pub use sprite::{Anchor, Facings, FrameTime, Sprite, SpriteHeight, SpriteId};
pub use texture::Texture;
use things::Things;
pub use things::{NoteId, Rhythm, Supply, Thing, ThingKind};
pub use tile::{Glass, Paint, TextureId, Tile, TileKind};

/// The contents of a level.
///
/// ```
/// use cellcaster::map::builtin;
/// use cellcaster::world::{Cell, FieldOfView};
///
/// let world = builtin::LEVELS[0].world()?;
/// assert!(world.grid().is_solid(0, 0));
/// assert_eq!(world.start().cell, Cell { column: 1, row: 1 });
/// let camera = world.start_camera(FieldOfView::default());
/// assert_eq!(camera.position(), world.start().cell.center());
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    title: String,
    goal: Option<String>,
    grid: Grid,
    /// The same as rays see it that end at what is not level, where anything is not.
    level_grid: Option<Grid>,
    tiles: Vec<Tile>,
    textures: Arc<[Texture]>,
    floor: Covering,
    ceiling: Ceiling,
    sky: Sky,
    fog: Option<Fog>,
    start: Start,
    sprites: Arc<[Sprite]>,
    things: Things,
    figures: Vec<Figure>,
    lamplight: Lamplight,
    /// Whether cells may differ in light.
    light_varies: bool,
    keys: Vec<String>,
    mission: Mission,
    ajar: Ajar,
}

/// The place where the player starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The cell in whose middle the player stands.
    pub cell: Cell,
    /// The direction in which the player looks.
    pub heading: Heading,
}

impl World {
    /// The name of the level; empty if the map has none.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The goal that the map names, if it does.
    pub fn goal(&self) -> Option<&str> {
        self.goal.as_deref()
    }

    /// The grid: the tile of each cell.
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

    /// The tile `id` of the grid.
    ///
    /// # Panics
    /// If `id` comes from another world that has more tiles.
    pub fn tile(&self, id: TileId) -> Tile {
        self.tiles[usize::from(id.0)]
    }

    /// The heights of floor and ceiling in `cell`; outside the map, those of the map's own floor.
    pub fn room_in(&self, cell: Cell) -> Heights {
        self.tile_at(cell).unwrap_or(self.ground()).heights
    }

    /// The height of the floor in `cell`, or of the top of a wall; 0 outside the map.
    pub fn floor_at(&self, cell: Cell) -> f64 {
        self.tile_at(cell).map_or(0.0, |tile| tile.heights.floor())
    }

    /// The light in `cell`: that of its tile, and what lamps add. For a wall with a light of its
    /// own, that light.
    pub fn light_in(&self, cell: Cell) -> Light {
        let own = self.tile_at(cell).unwrap_or(self.ground()).light;
        own.unwrap_or(Light::FULL).plus(self.lamplight.at(cell))
    }

    /// What lamps add to the light in `cell`.
    #[inline]
    pub(crate) fn lamplight_in(&self, cell: Cell) -> Light {
        self.lamplight.at(cell)
    }

    /// The texture `id`.
    ///
    /// # Panics
    /// If `id` comes from another world that has more textures.
    pub fn texture(&self, id: TextureId) -> &Texture {
        &self.textures[usize::from(id.0)]
    }

    /// The number of mip levels of textures and sprites made so far. Those of built-in ones are made when they are
    /// first read.
    pub fn mip_levels_made(&self) -> usize {
        let pictures = self.sprites.iter().flat_map(Sprite::pictures);
        self.textures.iter().chain(pictures).map(Texture::levels_made).sum()
    }

    /// The colour that represents `paint`: itself, or the mean of its texture.
    pub fn mean_color(&self, paint: Paint) -> Rgb {
        match paint {
            Paint::Color(color) => color,
            Paint::Texture(id) => self.texture(id).mean(),
        }
    }

    /// The floor of tiles without their own, and outside the map.
    pub fn floor(&self) -> Covering {
        self.floor
    }

    /// The ceiling of tiles without their own. Outside the map there is sky.
    pub fn ceiling(&self) -> Ceiling {
        self.ceiling
    }

    /// The map's own open floor: the tile of `.`.
    pub fn ground(&self) -> Tile {
        self.tiles[0]
    }

    /// The sky.
    pub fn sky(&self) -> Sky {
        self.sky
    }

    /// The fog, if the map has any.
    pub fn fog(&self) -> Option<Fog> {
        self.fog
    }

    /// The place where the player starts.
    pub fn start(&self) -> Start {
        self.start
    }

    /// A camera at the start.
    pub fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        let camera = Camera::in_cell(self.start.cell, self.start.heading, field_of_view);
        camera.with_eye(self.floor_at(self.start.cell) + Camera::STANDING).unwrap_or(camera)
    }

    /// The sprite `id`.
    ///
    /// # Panics
    /// If `id` comes from another world that has more sprites.
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
