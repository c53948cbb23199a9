//! The validity of worlds: an oracle, applied to every world that a build with debug assertions
//! makes.
//!
//! The map reader verifies the same properties and reports faults. Here, errors of the reader and
//! of the generator are found at their origin.

use super::{
    Ceiling, Cell, Covering, Door, Driver, Duty, GuardPost, Mission, MovingTile, Paint, Sky,
    SwitchId, Thing, ThingKind, Tile, TileEffect, TileId, TileKind, World,
};

impl World {
    /// Returns whether the parts fit together as [`World::from_parts`] requires.
    pub(crate) fn fits_together(&self) -> bool {
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

    /// Returns whether everything that the mission refers to exists. `open` says which cells are
    /// open floor.
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
