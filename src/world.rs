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
mod grid;
mod heights;
mod lamplight;
mod pitch;
mod shafts;
mod shape;
pub mod sprite;
pub mod texture;
mod things;

pub use air::{Fog, Light, Sky};
pub use camera::{Camera, FieldOfView, Heading};
pub(crate) use clearance::Clearance;
pub use color::{NotAColor, Rgb};
pub use covering::{Ceiling, Covering, Pattern, Scale};
use door::Ajar;
pub use door::{Door, KeyId, Opening};
pub use grid::{Cell, Grid, TileId};
pub use heights::{Gap, Heights};
pub(crate) use lamplight::Lamplight;
pub use lamplight::{Lamp, Reach};
pub use pitch::Pitch;
pub(crate) use shafts::{Bundle, FRACTION_BITS, STRIP, Shafts};
pub use shape::{Line, Outline, PillarRadius, Shape, ShapeHeight};
pub use sprite::{Anchor, Facings, FrameTime, Sprite, SpriteHeight, SpriteId};
pub use texture::Texture;
use things::Things;
pub use things::{Thing, ThingKind};

/// What a level consists of.
#[derive(Clone, Debug, PartialEq)]
pub struct World {
    title: String,
    grid: Grid,
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
    keys: Vec<String>,
    ajar: Ajar,
}

/// One kind of tile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tile {
    /// The character that draws it in a map.
    pub character: char,
    /// What it is.
    pub kind: TileKind,
    /// What its floor is laid with: its own, or the map's.
    pub floor: Covering,
    /// What is overhead there: its own ceiling, or the map's.
    pub ceiling: Ceiling,
    /// Of open floor, how bright it is, and the walls that it is seen from; of a wall, how bright its
    /// own sides are. `None` where the map does not say: full for open floor, and for a wall as
    /// bright as the floor before it.
    pub light: Option<Light>,
    /// How high its floor, its ceiling and what hangs above that are.
    pub heights: Heights,
    /// How the sides look of what its floor lies on, where they are seen from a lower one; a wall's
    /// own sides, and its top.
    pub riser: Paint,
    /// How the sides look of what hangs above its ceiling, where they are seen from below a higher
    /// one; and its roof.
    pub lintel: Paint,
}

/// What a tile is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TileKind {
    /// Floor to walk on, and to see across.
    Open,
    /// Where a door is that is all open: floor between two jambs.
    Doorway(Door),
    /// A solid block, as high as its floor says: what is above it is open.
    Wall(Paint),
    /// A door that is closed, or not all open. It stands between two solid cells, open floor before
    /// and behind it.
    Door(Door),
    /// A solid cube whose sides have holes where the texture is clear.
    Mask(TextureId),
    /// A solid cube of tinted glass.
    Glass(Glass),
    /// A block as a wall's, with sides that reflect under a tint.
    Mirror(Glass),
    /// A wall that does not fill the cell, and may be lower than its ceiling. Rays and walkers that
    /// know no shapes take the cell for solid; the others pass it by.
    Shape(Shape),
}

/// Glass to look through, or into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glass {
    /// Its tint.
    pub color: Rgb,
    /// How much of the tint is seen in place of what is behind, or reflected: from 0 for none to 255
    /// for all.
    pub opacity: u8,
}

/// How a surface looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Paint {
    /// The same colour all over.
    Color(Rgb),
    /// A texture.
    Texture(TextureId),
}

/// Which texture: an index into the world's list of textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TextureId(pub u16);

/// Where the player starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The cell in whose middle the player stands.
    pub cell: Cell,
    /// Which way the player looks.
    pub heading: Heading,
}

/// The pieces of a world, not yet known to fit together.
pub(crate) struct Parts {
    pub(crate) title: String,
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
    pub(crate) lamplight: Lamplight,
    pub(crate) keys: Vec<String>,
}

impl World {
    /// A world of `parts` that fit together: every tile of the grid and every texture is in its
    /// list, open tiles come before solid ones, the map's own floor first, the start and all things stand on open floor, those that block are known to the grid, every
    /// door has a doorway by the same character, and stands between solid cells that are no doors.
    /// The map's own checks establish all of that, and name what does not fit.
    pub(crate) fn from_parts(parts: Parts) -> Self {
        let Parts {
            title,
            mut grid,
            tiles,
            textures,
            floor,
            ceiling,
            sky,
            fog,
            start,
            sprites,
            things,
            lamplight,
            keys,
        } = parts;
        clear(&mut grid, &tiles);
        let world = Self {
            title,
            grid,
            tiles,
            textures,
            floor,
            ceiling,
            sky,
            fog,
            start,
            sprites,
            things: Things::new(things),
            lamplight,
            keys,
            ajar: Ajar::default(),
        };
        debug_assert!(world.fits_together());
        world
    }

    fn fits_together(&self) -> bool {
        let known = |paint: Paint| match paint {
            Paint::Color(_) => true,
            Paint::Texture(id) => usize::from(id.0) < self.textures.len(),
        };
        let covers = |covering: Covering| covering.pattern.paints().iter().copied().all(known);
        let ceils = |ceiling| match ceiling {
            Ceiling::Sky => true,
            Ceiling::Covered(covering) => covers(covering),
        };
        let sky_is_known = match self.sky {
            Sky::Gradient { .. } => true,
            Sky::Panorama(id) => known(Paint::Texture(id)),
        };
        let open = |cell: Cell| {
            let (column, row) = (i64::from(cell.column), i64::from(cell.row));
            self.grid.tile(column, row).is_some() && !self.grid.is_solid(column, row)
        };
        let stands = |thing: &Thing| {
            let blocks = self.sprites.get(usize::from(thing.sprite.0)).is_some_and(|it| it.blocks);
            let (column, row) = (i64::from(thing.cell.column), i64::from(thing.cell.row));
            usize::from(thing.sprite.0) < self.sprites.len()
                && (!blocks || self.grid.is_occupied(column, row))
        };
        let opens = |door: Door| {
            let is_known = door.key.is_none_or(|key| usize::from(key.0) < self.keys.len());
            is_known && known(door.leaf) && known(door.jamb)
        };
        let tile_fits = |(index, tile): (usize, &Tile)| {
            let is_solid = self.grid.is_solid_tile(TileId(index as u8));
            match tile.kind {
                TileKind::Open => !is_solid,
                TileKind::Doorway(door) => !is_solid && opens(door),
                TileKind::Wall(paint) => is_solid && known(paint),
                TileKind::Door(door) => {
                    is_solid && opens(door) && self.doorway(tile.character).is_some()
                }
                TileKind::Mask(texture) => is_solid && known(Paint::Texture(texture)),
                TileKind::Glass(_) | TileKind::Mirror(_) => is_solid,
                TileKind::Shape(shape) => is_solid && known(shape.paint),
            }
        };
        self.tiles.iter().enumerate().all(tile_fits)
            && self.tiles.iter().all(|tile| covers(tile.floor) && ceils(tile.ceiling))
            && self.tiles.iter().all(|tile| known(tile.riser) && known(tile.lintel))
            && self.grid.rows().flatten().all(|tile| usize::from(tile.0) < self.tiles.len())
            && covers(self.floor)
            && ceils(self.ceiling)
            && sky_is_known
            && open(self.start.cell)
            && self.things().iter().all(|thing| open(thing.cell) && stands(thing))
    }

    /// The level's name; empty where the map gives none.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The heights of the floor and the ceiling in `cell`; off the map, those of the map's own floor.
    pub fn room_in(&self, cell: Cell) -> Heights {
        self.tile_at(cell).unwrap_or(self.ground()).heights
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

    /// Whether lamps add anything anywhere.
    pub(crate) fn has_lamplight(&self) -> bool {
        !self.lamplight.is_dark()
    }

    /// Which tile each cell holds.
    pub fn grid(&self) -> &Grid {
        &self.grid
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

    /// Whether all floors are at 0, and all ceilings, walls and shapes a cell above that: every ray ends
    /// where it meets the first of those.
    pub fn is_level(&self) -> bool {
        let level = |tile: &Tile| match tile.kind {
            TileKind::Wall(_) | TileKind::Mirror(_) => Heights::LEVEL_WALL,
            _ => Heights::LEVEL,
        };
        let is_as_high = |tile: &Tile| match tile.kind {
            TileKind::Shape(_) => tile.top_of_what_stands() == Heights::LEVEL.ceiling(),
            _ => true,
        };
        self.tiles.iter().all(|tile| tile.heights == level(tile) && is_as_high(tile))
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

    /// What stands in the cells, the start excepted: row by row from the north, each from the west.
    pub fn things(&self) -> &[Thing] {
        self.things.all()
    }

    /// What stands in `cell`.
    pub fn things_in(&self, cell: Cell) -> &[Thing] {
        self.things.between(cell.row, cell.column, cell.column)
    }

    /// What stands in `row` between two columns, themselves included.
    pub(crate) fn things_between(&self, row: u32, first: u32, last: u32) -> &[Thing] {
        self.things.between(row, first, last)
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

    /// How wide the widest sprite is, in cells; 0 where nothing stands anywhere.
    pub(crate) fn widest_sprite(&self) -> f64 {
        self.sprites.iter().map(Sprite::width).fold(0.0, f64::max)
    }

    /// How high the highest sprite is, in cells; 0 where nothing stands anywhere.
    pub(crate) fn tallest_sprite(&self) -> f64 {
        self.sprites.iter().map(|sprite| sprite.height.cells()).fold(0.0, f64::max)
    }

    /// What the key `id` of this world is called, such as "brass".
    ///
    /// # Panics
    /// Where `id` is from another world that has more keys.
    pub fn key_name(&self, id: KeyId) -> &str {
        &self.keys[usize::from(id.0)]
    }

    /// The door in `cell`, however far it is open; `None` where there is none.
    pub fn door(&self, cell: Cell) -> Option<Door> {
        match self.kind_at(cell)? {
            TileKind::Door(door) | TileKind::Doorway(door) => Some(door),
            _ => None,
        }
    }

    /// How far the door in `cell` is open; closed where there is none.
    pub fn opening(&self, cell: Cell) -> Opening {
        match self.kind_at(cell) {
            Some(TileKind::Doorway(_)) => Opening::OPEN,
            _ => self.ajar.opening(cell).unwrap_or(Opening::CLOSED),
        }
    }

    /// Moves the door in `cell`; does nothing where there is none. The cell is open floor where the
    /// door is all open, and solid otherwise.
    pub fn set_opening(&mut self, cell: Cell, opening: Opening) {
        let Some(tile) = self.tile_at(cell) else { return };
        if !matches!(tile.kind, TileKind::Door(_) | TileKind::Doorway(_)) {
            return;
        }
        let solid = |kind: &TileKind| matches!(kind, TileKind::Door(_));
        let id = match opening {
            Opening::OPEN => self.doorway(tile.character),
            _ => self.tile_id(tile.character, solid),
        };
        if let Some(id) = id {
            self.grid.set(cell, id);
            self.ajar.set(cell, opening);
        }
    }

    /// Shows other cells of the same kinds: `grid`, with no door that is ajar, and what stands there.
    /// They fit together with the rest as in [`World::from_parts`].
    pub(crate) fn redraw(
        &mut self,
        grid: Grid,
        start: Start,
        things: Vec<Thing>,
        lamplight: Lamplight,
    ) {
        self.grid = grid;
        clear(&mut self.grid, &self.tiles);
        self.start = start;
        self.things = Things::new(things);
        self.lamplight = lamplight;
        self.ajar = Ajar::default();
    }

    /// Takes away all things in `cell` of which `is_taken` says so.
    pub(crate) fn take_things(&mut self, cell: Cell, is_taken: impl Fn(ThingKind) -> bool) {
        self.things.remove(|thing| thing.cell == cell && is_taken(thing.kind));
    }

    /// Whether any tile is a mirror.
    pub fn has_mirrors(&self) -> bool {
        self.tiles.iter().any(|tile| matches!(tile.kind, TileKind::Mirror(_)))
    }

    /// Whether any tile is a shape.
    pub(crate) fn has_shapes(&self) -> bool {
        self.tiles.iter().any(|tile| matches!(tile.kind, TileKind::Shape(_)))
    }

    /// Whether all that is solid is walls, which show one side each and hide what is behind.
    pub(crate) fn is_of_walls(&self) -> bool {
        let is_plain = |tile: &Tile| matches!(tile.kind, TileKind::Open | TileKind::Wall(_));
        self.tiles.iter().all(is_plain)
    }

    fn tile_at(&self, cell: Cell) -> Option<Tile> {
        let tile = self.grid.tile(i64::from(cell.column), i64::from(cell.row))?;
        Some(self.tile(tile))
    }

    fn kind_at(&self, cell: Cell) -> Option<TileKind> {
        self.tile_at(cell).map(|tile| tile.kind)
    }

    fn doorway(&self, character: char) -> Option<TileId> {
        self.tile_id(character, |kind| matches!(kind, TileKind::Doorway(_)))
    }

    fn tile_id(&self, character: char, is_kind: impl Fn(&TileKind) -> bool) -> Option<TileId> {
        let is_it = |tile: &Tile| tile.character == character && is_kind(&tile.kind);
        self.tiles.iter().position(is_it).map(|index| TileId(index as u8))
    }

    /// A camera where the player starts.
    pub fn start_camera(&self, field_of_view: FieldOfView) -> Camera {
        let camera = Camera::in_cell(self.start.cell, self.start.heading, field_of_view);
        camera.with_eye(self.floor_at(self.start.cell) + Camera::STANDING).unwrap_or(camera)
    }

    /// How high the floor in `cell` is, or the top of a wall; 0 off the map.
    pub fn floor_at(&self, cell: Cell) -> f64 {
        self.tile_at(cell).map_or(0.0, |tile| tile.heights.floor())
    }
}

/// Lets rays know what is empty in `grid`, where doors may close.
fn clear(grid: &mut Grid, tiles: &[Tile]) {
    let is_doorway = |id: TileId| matches!(tiles[usize::from(id.0)].kind, TileKind::Doorway(_));
    grid.clear(is_doorway);
}
