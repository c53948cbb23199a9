//! A world: a grid of tiles, the things that stand on it, and their colours and textures.
//!
//! A [`World`] is valid by construction: every index in it points at something, and its start is on
//! open floor. No later stage checks it again. [`map::parse`](crate::map::parse) and its siblings
//! make worlds, and report every fault of a map with its place. Rejected: building a world by hand.
//! Its faults would have no place to report.
//!
//! In the world of a map, all doors are closed and all keys are in their places. A game opens doors
//! and takes keys in its own copy of the world, so a renderer needs nothing else.
//!
//! Rendering and collision skip features that a world lacks, such as mirrors. These properties
//! depend on the kinds of tile, which never change, and not on the cells.

pub(crate) mod art;
mod camera;
mod distance_field;
mod door;
mod flood;
mod grid;
mod lamplight;
mod light;
mod mission;
pub(crate) mod scene;
mod sectors;
pub mod sprite;
#[cfg(any(test, debug_assertions))]
mod tests;
pub mod texture;
mod things;
mod tile;
mod tile_facts;

use std::sync::Arc;

use crate::color::Rgb;
pub use camera::{Camera, FieldOfView, Heading, Pitch};
pub(crate) use distance_field::DistanceField;
use door::PartlyOpenDoors;
pub use door::{Door, KeyId, Opening};
pub(crate) use flood::Flood;
pub use grid::{Cell, Grid, TileId};
use lamplight::Lamplight;
pub use lamplight::{Lamp, Reach};
pub(crate) use light::FaceLight;
pub use light::{Fog, Light, Sky, SkyGradient};
pub(crate) use mission::Mission;
pub use mission::{
    Difficulty, Driver, Duty, GuardKind, GuardPost, MovingTile, SwitchId, TileEffect,
};
pub(crate) use sectors::{
    GapObject, PlaneSide, PlaneSurface, Sector, SectorId, Sectors, TileSectors,
};
pub use sprite::{Anchor, Facings, FrameTime, Sprite, SpriteHeight, SpriteId};
pub use texture::Texture;
use things::Things;
pub use things::{Figure, NoteId, Rhythm, Supply, Thing, ThingKind};
pub use tile::{
    Ceiling, Covering, Gap, Glass, Heights, Line, Outline, Paint, Pattern, PillarRadius, Scale,
    Shape, ShapeHeight, TextureId, Tile, TileKind,
};
pub(crate) use tile_facts::TileFacts;

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
    /// The grid as seen by rays that stop at uneven cells (only if the map has any).
    level_grid: Option<Grid>,
    tiles: Arc<[Tile]>,
    tile_facts: TileFacts,
    sectors: Arc<Sectors>,
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
    /// `true` if cells may differ in light.
    light_varies: bool,
    keys: Vec<String>,
    mission: Mission,
    ajar: PartlyOpenDoors,
}

/// The place where the player starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The cell in whose middle the player stands.
    pub cell: Cell,
    /// The direction in which the player looks.
    pub heading: Heading,
}

/// The pieces of a world, before they are known to fit together.
pub(crate) struct Parts {
    pub(crate) title: String,
    pub(crate) goal: Option<String>,
    pub(crate) grid: Grid,
    pub(crate) tiles: Vec<Tile>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) floor: Covering,
    pub(crate) ceiling: Ceiling,
    pub(crate) sky: Sky,
    pub(crate) fog: Option<Fog>,
    pub(crate) start: Start,
    pub(crate) sprites: Vec<Sprite>,
    pub(crate) things: Vec<Thing>,
    pub(crate) keys: Vec<String>,
    pub(crate) mission: Mission,
}

/// The changes that a game has made to its world, except changes that follow from its doors, its
/// mechanisms and its lamps.
pub(crate) struct Changes<'a> {
    pub(crate) things: &'a [Thing],
    pub(crate) figures: &'a [Figure],
    /// `true` if lamps have ever added light.
    pub(crate) is_lamplit: bool,
}

impl World {
    /// The name of the level; empty if the map has none.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The goal, if the map names one.
    pub fn goal(&self) -> Option<&str> {
        self.goal.as_deref()
    }

    /// The grid: the tile of each cell.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The grid as seen by rays that stop at uneven cells: uneven cells are solid in it. `None` if
    /// all tiles are level.
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

    /// The heights of floor and ceiling in `cell`. Outside the map, returns the heights of the
    /// map's own floor.
    pub fn room_in(&self, cell: Cell) -> Heights {
        self.tile_in(cell).unwrap_or(&self.tiles[0]).heights
    }

    /// The height of the floor in `cell`, or of the top of a wall; 0 outside the map.
    pub fn floor_at(&self, cell: Cell) -> f64 {
        self.tile_in(cell).map_or(0.0, |tile| tile.heights.floor())
    }

    /// The light in `cell`: the light of its tile, plus the light that lamps add. A wall with a
    /// light of its own has that light only.
    pub fn light_in(&self, cell: Cell) -> Light {
        let own = self.tile_in(cell).unwrap_or(&self.tiles[0]).light;
        own.unwrap_or(Light::FULL).plus(self.lamplight.at(cell))
    }

    /// The light that lamps add in `cell`.
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

    /// The number of mip levels of textures and sprites that have been made. Mip levels of built-in
    /// textures and sprites are made when they are first read.
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

    /// The floor of tiles without their own floor, and of the area outside the map.
    pub fn floor(&self) -> Covering {
        self.floor
    }

    /// The ceiling of tiles without their own ceiling. Outside the map there is sky.
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

    /// The tile in `cell`; `None` outside the map.
    #[inline]
    pub(crate) fn tile_in(&self, cell: Cell) -> Option<&Tile> {
        self.grid.tile_in(cell).map(|id| &self.tiles[usize::from(id.0)])
    }

    /// The properties that all kinds of tile share.
    pub(crate) fn tile_facts(&self) -> &TileFacts {
        &self.tile_facts
    }

    /// The sectors. Gaps under the sky have no top.
    pub(crate) fn sectors(&self) -> &Sectors {
        &self.sectors
    }

    /// Returns whether all floors are at 0, and all ceilings, walls and shapes reach 1. Every ray
    /// then ends at the first wall or shape.
    pub fn is_level(&self) -> bool {
        self.tile_facts.are_level
    }

    /// Returns whether any tile is a mirror that shows an image.
    pub fn has_mirrors(&self) -> bool {
        self.tile_facts.reflect
    }

    /// Returns whether every solid tile is a wall, which shows one side and hides everything behind
    /// it.
    pub(crate) fn is_of_walls(&self) -> bool {
        self.tile_facts.are_of_walls
    }

    /// Returns whether lamps add light anywhere.
    pub(crate) fn has_lamplight(&self) -> bool {
        !self.lamplight.is_dark()
    }

    /// The width of the widest sprite, in cells; 0 if there is none.
    pub(crate) fn widest_sprite(&self) -> f64 {
        self.sprites.iter().map(Sprite::width).fold(0.0, f64::max)
    }

    /// An upper bound on the height that any thing reaches, wherever it stands or hangs; −∞ if
    /// there are no sprites.
    pub(crate) fn limit_of_things(&self) -> f64 {
        let tallest = |anchor: Anchor| {
            let sprites = self.sprites.iter().filter(|sprite| sprite.anchor == anchor);
            sprites.map(|sprite| sprite.height.cells()).fold(f64::NEG_INFINITY, f64::max)
        };
        let TileFacts { highest_floor_of_things, highest_ceiling_of_things, .. } = self.tile_facts;
        let standing = highest_floor_of_things + tallest(Anchor::Floor);
        let hangs = tallest(Anchor::Ceiling) > 0.0;
        if hangs { standing.max(highest_ceiling_of_things) } else { standing }
    }

    /// Builds a world of `parts` that fit together:
    ///
    /// - Every tile of the grid and every texture is in its list.
    /// - Open tiles come before solid ones, and the map's own floor is the first.
    /// - The start and all things are on open floor, and the grid knows which things block.
    /// - Every door has a doorway with the same character, and stands between solid cells that are
    ///   not doors and do not move.
    /// - The states of moving tiles are in the list of tiles. The first state of each belongs to no
    ///   other moving tile, and the grid shows no other states.
    /// - Switches and notes are in their lists. Guards and their waypoints are on open floor.
    ///
    /// The map reader guarantees all of this, and tests verify it.
    pub(crate) fn from_parts(mut parts: Parts) -> Self {
        let moving = &parts.mission.moving_tiles;
        clear(&mut parts.grid, &parts.tiles, moving);
        let level_grid = level_grid(&parts.grid, &parts.tiles, moving);
        let mut world = Self {
            title: parts.title,
            goal: parts.goal,
            grid: parts.grid,
            level_grid,
            tile_facts: TileFacts::new(&parts.tiles, parts.floor, parts.ceiling),
            sectors: Sectors::new(&parts.tiles).into(),
            tiles: parts.tiles.into(),
            textures: parts.textures.into(),
            floor: parts.floor,
            ceiling: parts.ceiling,
            sky: parts.sky,
            fog: parts.fog,
            start: parts.start,
            sprites: parts.sprites.into(),
            things: Things::new(parts.things),
            figures: Vec::new(),
            lamplight: Lamplight::default(),
            light_varies: false,
            keys: parts.keys,
            mission: parts.mission,
            ajar: PartlyOpenDoors::default(),
        };
        world.light_up();
        #[cfg(any(test, debug_assertions))]
        assert!(world.fits_together());
        world
    }

    /// Replaces the cells by `grid`, in which no door is partly open, together with the start and
    /// the things. Removes figures and moving lamps. The new parts must fit the others as in
    /// [`World::from_parts`].
    pub(crate) fn redraw(&mut self, grid: Grid, start: Start, things: Vec<Thing>) {
        self.grid = grid;
        let moving = &self.mission.moving_tiles;
        clear(&mut self.grid, &self.tiles, moving);
        self.level_grid = level_grid(&self.grid, &self.tiles, moving);
        self.start = start;
        self.things = Things::new(things);
        self.figures.clear();
        self.light_up();
        self.ajar = PartlyOpenDoors::default();
    }

    /// The world with another start, which must be on open floor with room to stand.
    pub(crate) fn starting_at(self, start: Start) -> Self {
        Self { start, ..self }
    }

    /// The changes that a game has made.
    pub(crate) fn changes(&self) -> Changes<'_> {
        let Self {
            title: _,
            goal: _,
            // The tiles that have changed follow from doors and mechanisms.
            grid: _,
            level_grid: _,
            tiles: _,
            tile_facts: _,
            sectors: _,
            textures: _,
            floor: _,
            ceiling: _,
            sky: _,
            fog: _,
            start: _,
            // A game adds its own sprites when it starts.
            sprites: _,
            things,
            figures,
            lamplight,
            // It follows from lamplight.
            light_varies: _,
            keys: _,
            mission: _,
            // It follows from doors.
            ajar: _,
        } = self;
        Changes { things: things.all(), figures, is_lamplit: !lamplight.is_dark() }
    }

    /// Keeps only the things in `left`, which may show other frames, and computes all lamplight
    /// again, without moving lamps. Returns `false`, and changes nothing, if `left` is not in
    /// order, contains a thing that is not in the world, or shows a frame that its sprite does not
    /// have.
    pub(crate) fn leave_things(&mut self, left: Vec<Thing>) -> bool {
        let place = |cell: Cell| (cell.row, cell.column);
        let mut is_used = vec![false; self.things().len()];
        let mut is_there = |thing: &Thing| {
            let before = self.things();
            let first = before.partition_point(|it| place(it.cell) < place(thing.cell));
            let here = before[first..].iter().take_while(|it| it.cell == thing.cell);
            let is_it = |it: &Thing| Thing { frame: thing.frame, ..*it } == *thing;
            let found = (first..).zip(here).find(|&(index, it)| !is_used[index] && is_it(it));
            let Some((index, _)) = found else { return false };
            is_used[index] = true;
            thing.frame.is_none_or(|frame| frame <= self.sprite(thing.sprite).last_frame())
        };
        if !left.is_sorted_by_key(|thing| place(thing.cell)) || !left.iter().all(&mut is_there) {
            return false;
        }
        self.things = Things::new(left);
        self.light_up();
        true
    }

    /// The number of keys. Their ids are the numbers below it.
    pub(crate) fn key_count(&self) -> usize {
        self.keys.len()
    }
}

/// Computes the distance field of `grid`, in which doors may close and moving tiles may become
/// solid.
fn clear(grid: &mut Grid, tiles: &[Tile], moving: &[MovingTile]) {
    let first_solid = grid.first_solid();
    let changing = may_become(tiles.len(), moving, |state| state >= first_solid);
    let is_doorway = |id: TileId| matches!(tiles[usize::from(id.0)].kind, TileKind::Doorway(_));
    // A level grid has an extra tile for uneven cells, which is in no list.
    let may_change = |id: TileId| changing.get(usize::from(id.0)).is_some_and(|&changes| changes);
    grid.clear(|id| is_doorway(id) || may_change(id));
}

/// `grid` as seen by rays that stop at uneven cells; `None` if all tiles are level.
fn level_grid(grid: &Grid, tiles: &[Tile], moving: &[MovingTile]) -> Option<Grid> {
    let is_level = |TileId(index): TileId| tiles[usize::from(index)].is_level();
    if tiles.iter().all(Tile::is_level) {
        return None;
    }
    let first_solid = grid.first_solid();
    let ends_rays = |state: TileId| state >= first_solid || !is_level(state);
    let changing = may_become(tiles.len(), moving, ends_rays);
    let is_doorway = |id: TileId| matches!(tiles[usize::from(id.0)].kind, TileKind::Doorway(_));
    let mut level = grid.ending_at_others(is_level);
    level.clear(|id| is_doorway(id) || changing[usize::from(id.0)]);
    Some(level)
}

/// For each tile, whether it is a state of a moving tile that has a state for which `is_it` is true.
fn may_become(
    tile_count: usize,
    moving: &[MovingTile],
    is_it: impl Fn(TileId) -> bool,
) -> Vec<bool> {
    let mut marked = vec![false; tile_count];
    let moving = moving.iter().filter(|moving| moving.states.iter().copied().any(&is_it));
    for &TileId(index) in moving.flat_map(|moving| &moving.states) {
        marked[usize::from(index)] = true;
    }
    marked
}
