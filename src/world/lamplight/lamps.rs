//! Lamps: those of things and those that move, and what changes when one is lit, put out or moved.
//!
//! All light is added and taken away along the tree of a [`Glow`], which is computed once for each
//! kind of lamp. A change costs at most the cells within the reach of the lamps that it concerns.

use std::sync::Arc;

use super::glow::Glow;
use super::{Lamp, Lamplight, Reach};
use crate::world::{Cell, Grid, Light, Thing, ThingKind, Tile, TileId, TileKind, World};

/// Whether light is added or taken away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    Add,
    TakeAway,
}

/// What carries a lamp: it decides which tiles the light passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carrier {
    Thing,
    /// Something that moves.
    Mover,
}

/// The glow of each kind of lamp that was needed so far. Worlds that differ in it are equal.
#[derive(Clone, Debug, Default)]
pub(crate) struct Glows {
    list: Vec<(Lamp, Arc<Glow>)>,
}

impl World {
    /// Replaces all lamps that move, each in a cell. Only light of lamps is computed that differ
    /// from those set before at the same index. Returns whether any does.
    pub(crate) fn set_moving_lamps(
        &mut self,
        lamps: impl Iterator<Item = (Cell, Lamp)> + Clone,
    ) -> bool {
        let Lamplight { is_needed, ref moving, .. } = self.lamplight;
        if !is_needed || lamps.clone().eq(moving.iter().copied()) {
            return false;
        }
        let before = moving.len();
        self.make_room_for_light();
        let mut new_lamps = lamps.clone().fuse();
        for index in 0..before.max(lamps.clone().count()) {
            let (old, new) = (self.lamplight.moving.get(index).copied(), new_lamps.next());
            if old == new {
                continue;
            }
            for (lamp, change) in [(old, Change::TakeAway), (new, Change::Add)] {
                if let Some(lamp) = lamp {
                    shine(
                        &self.grid,
                        &self.tiles,
                        &mut self.lamplight,
                        lamp,
                        Carrier::Mover,
                        change,
                    );
                }
            }
        }
        self.lamplight.moving.clear();
        self.lamplight.moving.extend(lamps);
        true
    }

    /// Lights the [flames](ThingKind::Flame) in `cell`, or puts them out: then they give no light
    /// and show the last frame of their sprite.
    pub(crate) fn set_flame(&mut self, cell: Cell, burns: bool) {
        let change = if burns { Change::Add } else { Change::TakeAway };
        let is_it = |thing: &&mut Thing| thing.kind == ThingKind::Flame && thing.burns() != burns;
        for thing in self.things.in_cell_mut(cell).iter_mut().filter(is_it) {
            let sprite = &self.sprites[usize::from(thing.sprite.0)];
            thing.frame = (!burns).then(|| sprite.last_frame());
            if let Some(lamp) = sprite.lamp {
                let lamp = (cell, lamp);
                shine(&self.grid, &self.tiles, &mut self.lamplight, lamp, Carrier::Thing, change);
            }
        }
    }

    /// Takes away the light of the things in `cell` for which `is_taken` is true.
    pub(crate) fn put_out(&mut self, cell: Cell, is_taken: impl Fn(ThingKind) -> bool) {
        for thing in self.things.between(cell.row, cell.column, cell.column) {
            let lamp = self.sprites[usize::from(thing.sprite.0)].lamp;
            if let Some(lamp) = lamp.filter(|_| is_taken(thing.kind) && thing.burns()) {
                let (lamp, carrier, change) = ((cell, lamp), Carrier::Thing, Change::TakeAway);
                shine(&self.grid, &self.tiles, &mut self.lamplight, lamp, carrier, change);
            }
        }
    }

    /// Sets the tile of `cell`, which must be on the map. Lamplight passes it from now on, or no
    /// longer does.
    pub(crate) fn set_tile(&mut self, cell: Cell, tile: TileId) {
        let kind = |id: TileId| self.tiles[usize::from(id.0)].kind;
        let before = self.grid.tile(i64::from(cell.column), i64::from(cell.row)).map(kind);
        let changes = |carrier: &Carrier| {
            !self.lamplight.is_dark()
                && before.map(|kind| carrier.lets_through(kind))
                    != Some(carrier.lets_through(kind(tile)))
        };
        let changed = [Carrier::Thing, Carrier::Mover].map(|it| Some(it).filter(changes));
        for &carrier in changed.iter().flatten() {
            self.shine_around(cell, carrier, Change::TakeAway);
        }
        self.grid.set(cell, tile);
        for &carrier in changed.iter().flatten() {
            self.shine_around(cell, carrier, Change::Add);
        }
    }

    /// Computes all lamplight anew, without lamps that move.
    pub(crate) fn light_up(&mut self) {
        let is_dim = |tile: &Tile| tile.light.is_some_and(|light| light != Light::FULL);
        let is_needed = self.tiles.iter().any(is_dim);
        self.lamplight.is_needed = is_needed;
        self.lamplight.moving.clear();
        self.lamplight.sums.clear();
        let passes = |tile: &Tile| Carrier::Thing.lets_through(tile.kind);
        let passed: Vec<bool> = self.tiles.iter().map(passes).collect();
        let lamp = |thing: &&Thing| {
            let lamp = self.sprites[usize::from(thing.sprite.0)].lamp;
            lamp.filter(|_| thing.burns()).map(|lamp| (thing.cell, thing.sprite, lamp))
        };
        let lamps = self.things.all().iter().filter_map(|thing| lamp(&thing));
        let lamplight = &mut self.lamplight;
        // Looked up once for each sprite: a map may have as many lamps as cells.
        let mut glow_of = vec![None; self.sprites.len()];
        for (cell, sprite, lamp) in lamps.take_while(|_| is_needed) {
            if lamplight.is_dark() {
                lamplight.begin(&self.grid);
            }
            let glow: &Arc<Glow> =
                glow_of[usize::from(sprite.0)].get_or_insert_with(|| lamplight.glows.of(lamp));
            let is_clear = |tile: TileId| passed[usize::from(tile.0)];
            glow.shine(&self.grid, cell, is_clear, |cell, light| {
                lamplight.change(cell, light, Change::Add);
            });
        }
        self.light_varies = !self.lamplight.is_dark() || self.tiles_differ_in_light();
    }

    /// Adds or takes away the light of all lamps of a carrier that may shine through `cell`.
    fn shine_around(&mut self, cell: Cell, carrier: Carrier, change: Change) {
        let Self { grid, tiles, things, sprites, lamplight, .. } = self;
        let is_near = |&(place, lamp): &(Cell, Lamp)| {
            place.center().distance(cell.center()) < lamp.reach.cells()
        };
        match carrier {
            Carrier::Thing => {
                let most = Reach::MOST as u32;
                let around = |index: u32| index.saturating_sub(most)..=index.saturating_add(most);
                let (rows, columns) = (around(cell.row), around(cell.column));
                let things =
                    rows.flat_map(|row| things.between(row, *columns.start(), *columns.end()));
                let lamps = things.filter(|thing| thing.burns()).filter_map(|thing| {
                    Some((thing.cell, sprites[usize::from(thing.sprite.0)].lamp?))
                });
                for lamp in lamps.filter(is_near) {
                    shine(grid, tiles, lamplight, lamp, carrier, change);
                }
            }
            Carrier::Mover => {
                for index in 0..lamplight.moving.len() {
                    let lamp = lamplight.moving[index];
                    if is_near(&lamp) {
                        shine(grid, tiles, lamplight, lamp, carrier, change);
                    }
                }
            }
        }
    }

    /// Reserves memory for lamplight, if there is none yet.
    pub(crate) fn make_room_for_light(&mut self) {
        if self.lamplight.is_dark() {
            self.lamplight.begin(&self.grid);
            self.light_varies = true;
        }
    }

    /// Whether cells may differ in light without lamps.
    fn tiles_differ_in_light(&self) -> bool {
        // A wall without a light is as bright as the floor before it.
        let is_wall = |tile: &Tile| matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
        let light = |tile: &Tile| tile.light.or((!is_wall(tile)).then_some(Light::FULL));
        let mut lights = self.tiles.iter().filter_map(light);
        let first = lights.next();
        lights.any(|light| Some(light) != first)
    }
}

impl Thing {
    /// Whether it gives light, if its sprite is a lamp.
    fn burns(&self) -> bool {
        self.kind != ThingKind::Flame || self.frame.is_none()
    }
}

impl Carrier {
    fn lets_through(self, kind: TileKind) -> bool {
        match kind {
            TileKind::Open | TileKind::Mask(_) | TileKind::Glass(_) => true,
            TileKind::Doorway(_) => self == Self::Mover,
            TileKind::Wall(_) | TileKind::Door(_) | TileKind::Mirror(_) | TileKind::Shape(_) => {
                false
            }
        }
    }
}

impl Glows {
    fn of(&mut self, lamp: Lamp) -> Arc<Glow> {
        if let Some((_, glow)) = self.list.iter().find(|(known, _)| *known == lamp) {
            return Arc::clone(glow);
        }
        let glow = Arc::new(Glow::of(&lamp));
        self.list.push((lamp, Arc::clone(&glow)));
        glow
    }
}

impl PartialEq for Glows {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// Adds or takes away the light of one lamp. Off the map, it lights nothing.
fn shine(
    grid: &Grid,
    tiles: &[Tile],
    lamplight: &mut Lamplight,
    (cell, lamp): (Cell, Lamp),
    carrier: Carrier,
    change: Change,
) {
    if lamplight.is_dark() || grid.tile(i64::from(cell.column), i64::from(cell.row)).is_none() {
        return;
    }
    let glow = lamplight.glows.of(lamp);
    let is_clear = |tile: TileId| carrier.lets_through(tiles[usize::from(tile.0)].kind);
    glow.shine(grid, cell, is_clear, |cell, light| lamplight.change(cell, light, change));
}

#[cfg(test)]
mod tests;
