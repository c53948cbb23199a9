//! Parts: the pieces that a world is made of.
//!
//! The map reader verifies that they fit together, and reports what does not. Assertions here find
//! errors of this program where they are made.

use super::door::Ajar;
use super::things::Things;
use super::{
    Ceiling, Cell, Covering, Door, Driver, Duty, Fog, Grid, GuardPost, Lamplight, Mission,
    MovingTile, Paint, Sky, Sprite, Start, SwitchId, Texture, Thing, ThingKind, Tile, TileEffect,
    TileId, TileKind, World,
};

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

impl World {
    /// A world of `parts` that fit together:
    ///
    /// - Every tile of the grid and every texture is in its list.
    /// - Open tiles come before solid ones, and the map's own floor is the first.
    /// - The start and all things are on open floor, and the grid knows which things block.
    /// - Every door has a doorway with the same character, and stands between solid cells that are
    ///   not doors and do not move.
    /// - The states of moving tiles are in the list, the first of each in no other one. The grid
    ///   shows no other states.
    /// - Switches and notes are in their lists. Guards and their waypoints are on open floor.
    ///
    /// The map reader establishes all of that.
    pub(crate) fn from_parts(parts: Parts) -> Self {
        let Parts {
            title,
            goal,
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
            keys,
            mission,
        } = parts;
        let moving = &mission.moving_tiles;
        clear(&mut grid, &tiles, moving);
        let level_grid = level_grid(&grid, &tiles, moving);
        let mut world = Self {
            title,
            goal,
            grid,
            level_grid,
            tiles,
            textures: textures.into(),
            floor,
            ceiling,
            sky,
            fog,
            start,
            sprites: sprites.into(),
            things: Things::new(things),
            figures: Vec::new(),
            lamplight: Lamplight::default(),
            light_varies: false,
            keys,
            mission,
            ajar: Ajar::default(),
        };
        world.light_up();
        debug_assert!(world.fits_together());
        world
    }

    /// Shows other cells of the same kinds: `grid`, in which no door is partly open, with its start
    /// and things, and without figures and moving lamps. They fit the other parts as in
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
        self.ajar = Ajar::default();
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
            Sky::Gradient(_) => true,
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
            && self.mission_fits(open)
    }

    /// Whether the mission refers to what there is; `open` says which cells are open floor.
    fn mission_fits(&self, open: impl Fn(Cell) -> bool) -> bool {
        let Mission { notes, switches, moving_tiles, guards, .. } = &self.mission;
        let known = |switch: SwitchId| usize::from(switch.0) < switches.len();
        let moves = |(index, moving): (usize, &MovingTile)| {
            let others = moving_tiles.iter().enumerate().filter(|&(other, _)| other != index);
            let is_driven = match moving.driver {
                Driver::Switch(switch) => known(switch),
                Driver::Hand | Driver::Weight => true,
            };
            is_driven
                && moving.states.len() >= 2
                && moving.states.iter().all(|state| usize::from(state.0) < self.tiles.len())
                && others.flat_map(|(_, it)| &it.states).all(|&state| state != moving.states[0])
        };
        let sets = |tile: &Tile| match (tile.effect, tile.kind) {
            (Some(TileEffect::Plate(switch)), _) => known(switch),
            (_, TileKind::Door(door) | TileKind::Doorway(door)) => door.switch.is_none_or(known),
            _ => true,
        };
        let is_used = |thing: &Thing| match thing.kind {
            ThingKind::Lever(switch) => known(switch),
            ThingKind::Note(note) => usize::from(note.0) < notes.len(),
            _ => true,
        };
        let watches = |post: &GuardPost| {
            open(post.cell)
                && match &post.duty {
                    Duty::Patrol(cells) => !cells.is_empty() && cells.iter().copied().all(&open),
                    Duty::Stand | Duty::Sleep | Duty::Wander(_) => true,
                }
        };
        moving_tiles.iter().enumerate().all(moves)
            && self.tiles.iter().all(sets)
            && self.things().iter().all(is_used)
            && guards.iter().all(watches)
    }
}

/// Computes the distance field of `grid`, where doors may close and moving tiles may become solid.
fn clear(grid: &mut Grid, tiles: &[Tile], moving: &[MovingTile]) {
    let first_solid = grid.first_solid();
    let changing = that_may_become(tiles.len(), moving, |state| state >= first_solid);
    let is_doorway = |id: TileId| matches!(tiles[usize::from(id.0)].kind, TileKind::Doorway(_));
    // A level grid has a tile of its own for what is not level.
    let may_change = |id: TileId| changing.get(usize::from(id.0)).is_some_and(|&changes| changes);
    grid.clear(|id| is_doorway(id) || may_change(id));
}

/// `grid` as rays see it that end at what is not level; `None` where everything is.
fn level_grid(grid: &Grid, tiles: &[Tile], moving: &[MovingTile]) -> Option<Grid> {
    let is_level = |TileId(index): TileId| tiles[usize::from(index)].is_level();
    if tiles.iter().all(Tile::is_level) {
        return None;
    }
    let first_solid = grid.first_solid();
    let ends_rays = |state: TileId| state >= first_solid || !is_level(state);
    let changing = that_may_become(tiles.len(), moving, ends_rays);
    let is_doorway = |id: TileId| matches!(tiles[usize::from(id.0)].kind, TileKind::Doorway(_));
    let mut level = grid.ending_at_others(is_level);
    level.clear(|id| is_doorway(id) || changing[usize::from(id.0)]);
    Some(level)
}

/// For each tile, whether it is among the states of a moving tile any of whose states `is_it`.
fn that_may_become(
    tile_count: usize,
    moving: &[MovingTile],
    is_it: impl Fn(TileId) -> bool,
) -> Vec<bool> {
    let mut may_become = vec![false; tile_count];
    let moving = moving.iter().filter(|moving| moving.states.iter().copied().any(&is_it));
    for &TileId(index) in moving.flat_map(|moving| &moving.states) {
        may_become[usize::from(index)] = true;
    }
    may_become
}
