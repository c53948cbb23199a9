//! Lamplight: the light that lamps add to nearby cells.
//!
//! A cell is lit if the straight line from the middle of the lamp's cell to its own middle passes
//! only through open floor, masks and glass. For the lamps of things, doors count as closed.
//! Rejected: lamplight that passes through opening doors. All lamps around a door would have to be
//! computed again, for a small difference. A lamp that moves shines through doors that are fully
//! open, because the player carries one.
//!
//! The sum of all lamps is stored for each cell, without a limit. When one lamp moves, goes out, or
//! has a wall moved in front of it, its share is subtracted exactly, and the other lamps are not
//! computed again. Maps in which lamps change nothing store nothing.
//!
//! The lines from a lamp to the cells within its reach are the same at every position, and many of
//! them share their first cells. They are computed once for each kind of lamp, as a tree, its
//! [`Glow`]. Each lamp follows the branches of the tree until they meet an obstacle. A change
//! therefore costs at most the cells within the reach of the lamps that it concerns. Rejected:
//! following every line by itself. A generated level has hundreds of lamps, and that took most of
//! the time in which its window moves.
//!
//! Both ends of a line are middles of cells, so the order in which it crosses the lines of the grid
//! is an order of fractions of small integers. It is the order of a [`Ray`](crate::cast::Ray)
//! between the two middles.

use std::sync::Arc;

use glam::DVec2;

use super::{Cell, Grid, Light, Thing, ThingKind, Tile, TileId, TileKind, World};
use crate::sort;

/// The light of a lamp.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp {
    /// The light that it adds in its own cell.
    pub light: Light,
    /// The distance that its light reaches.
    pub reach: Reach,
}

/// A distance that light reaches, in cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach(f64);

impl Reach {
    /// The longest reach, in cells.
    const MAX: f64 = 32.0;

    /// A reach from 1 to 32 cells. `None` outside that range.
    pub fn new(cells: f64) -> Option<Self> {
        (1.0..=Self::MAX).contains(&cells).then_some(Self(cells))
    }

    /// The reach in cells.
    pub const fn cells(self) -> f64 {
        self.0
    }

    /// The number of cells that a lamp with this reach lights if nothing stands around it.
    pub(crate) fn cell_count(self) -> u64 {
        let most = self.0 as i64;
        let around = (-most..=most).flat_map(|row| (-most..=most).map(move |column| (column, row)));
        let is_reached =
            |&(column, row): &(i64, i64)| ((column * column + row * row) as f64).sqrt() < self.0;
        around.filter(is_reached).count() as u64
    }
}

impl Default for Reach {
    /// Four cells.
    fn default() -> Self {
        Self(4.0)
    }
}

impl Lamp {
    /// The light that it adds in a cell whose middle is `distance` cells away: `light · (1 − (distance /
    /// reach)²)²`, which ends smoothly at the reach.
    pub(crate) fn light_at(&self, distance: f64) -> Light {
        let part = (distance / self.reach.0).min(1.0);
        let nearness = 1.0 - part * part;
        self.light.dimmed(nearness * nearness)
    }
}

/// The light that lamps add in each cell.
#[derive(Clone, Debug, PartialEq, Default)]
pub(crate) struct Lamplight {
    width: usize,
    /// The sums of the light of all lamps, in 256ths, row by row from the north; empty if no lamp
    /// adds anything.
    sums: Vec<u32>,
    /// `true` if any cell is not fully lit without lamps.
    is_needed: bool,
    /// The lamps that move, and the cells that they are in.
    moving: Vec<(Cell, Lamp)>,
    glows: Glows,
}

impl Lamplight {
    /// Returns whether no lamp adds any light.
    pub(crate) fn is_dark(&self) -> bool {
        self.sums.is_empty()
    }

    /// The light that lamps add in `cell`.
    #[inline]
    pub(crate) fn at(&self, cell: Cell) -> Light {
        let is_on_map = (cell.column as usize) < self.width;
        let sum = self.sums.get(self.place(cell)).filter(|_| is_on_map);
        sum.map_or(Light::NONE, |&sum| Light::saturated(sum))
    }

    /// Reserves memory for the cells of `grid`, without any light yet.
    fn begin(&mut self, grid: &Grid) {
        let (width, height) = (grid.width() as usize, grid.height() as usize);
        self.width = width;
        self.sums.clear();
        self.sums.resize(width * height, 0);
    }

    /// Adds `light` in `cell`, or takes away light that was added before.
    fn change(&mut self, cell: Cell, light: Light, change: LightChange) {
        let place = self.place(cell);
        if let Some(sum) = self.sums.get_mut(place) {
            *sum = match change {
                LightChange::Add => *sum + light.in_256ths(),
                LightChange::TakeAway => *sum - light.in_256ths(),
            };
        }
    }

    fn place(&self, cell: Cell) -> usize {
        cell.row as usize * self.width + cell.column as usize
    }
}

/// The cells that a kind of lamp lights if nothing stands around it.
#[derive(Debug)]
struct Glow {
    /// The light that it adds in its own cell.
    light: Light,
    /// The cells as a tree: each comes before those behind it.
    branches: Vec<Branch>,
}

/// A cell that light passes through, coming from the cell before it in the tree. A lamp of the
/// longest reach has 25,000 of them, so they are kept small.
#[derive(Debug)]
struct Branch {
    /// The offset from the lamp in columns to the east and rows to the south, each at most the
    /// longest reach.
    offset: (i8, i8),
    /// The light that the lamp adds there; none if its light only passes through.
    light: Light,
    /// The index of the first cell whose line does not lead through this one.
    next_beside: u32,
}

impl Glow {
    pub(crate) fn of(lamp: &Lamp) -> Self {
        let mut lines = lines(lamp);
        // Lines that share their first cells are neighbours, and shorter ones come first.
        sort::by(&mut lines, |one, other| one.cells.cmp(&other.cells));
        let mut branches: Vec<Branch> = Vec::new();
        let mut open: Vec<usize> = Vec::new();
        let mut before: &[Offset] = &[];
        for LampLine { cells, light } in &lines {
            let shared = before.iter().zip(cells).take_while(|(one, other)| one == other).count();
            close(&mut branches, open.drain(shared..));
            for &(columns, rows) in &cells[shared..] {
                open.push(branches.len());
                let offset = (columns as i8, rows as i8);
                branches.push(Branch { offset, light: Light::NONE, next_beside: 0 });
            }
            if let Some(end) = branches.last_mut() {
                end.light = *light;
            }
            before = cells;
        }
        close(&mut branches, open.drain(..));
        Self { light: lamp.light_at(0.0), branches }
    }

    /// Calls `add` for each cell of `grid` that a lamp at `place` lights, with the light that it
    /// adds there. Light passes through tiles for which `is_clear` is true.
    pub(crate) fn shine(
        &self,
        grid: &Grid,
        place: Cell,
        is_clear: impl Fn(TileId) -> bool,
        mut add: impl FnMut(Cell, Light),
    ) {
        add(place, self.light);
        let mut index = 0;
        while let Some(branch) = self.branches.get(index) {
            let column = i64::from(place.column) + i64::from(branch.offset.0);
            let row = i64::from(place.row) + i64::from(branch.offset.1);
            let next = grid.cell(column, row).filter(|&(_, tile)| is_clear(tile));
            if let Some((cell, _)) = next {
                add(cell, branch.light);
                index += 1;
            } else {
                index = branch.next_beside as usize;
            }
        }
    }
}

/// Ends the branches at `indices`: no later cell's line leads through them.
fn close(branches: &mut [Branch], indices: impl Iterator<Item = usize>) {
    let end = branches.len() as u32;
    indices.for_each(|index| branches[index].next_beside = end);
}

type Offset = (i64, i64);

/// The cells on the line from a lamp to a cell, excluding the lamp's own and including the last
/// one.
struct LampLine {
    cells: Vec<Offset>,
    light: Light,
}

/// The lines from a lamp to all other cells within its reach.
fn lines(lamp: &Lamp) -> Vec<LampLine> {
    let reach = lamp.reach.cells() as i64;
    let around = (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (column, row)));
    let ends = around.filter(|&end| end != (0, 0)).filter_map(|end| {
        let distance = DVec2::new(end.0 as f64, end.1 as f64).length();
        let is_reached = distance < lamp.reach.cells();
        is_reached.then(|| LampLine { cells: cells_to(end), light: lamp.light_at(distance) })
    });
    ends.collect()
}

/// The cells that a line from the middle of a cell to the middle of the cell at `end` enters. If it
/// meets a column line and a row line at once, it crosses the row line first.
fn cells_to(end: Offset) -> Vec<Offset> {
    let (columns, rows) = (end.0.abs(), end.1.abs());
    let (mut column, mut row) = (0, 0);
    let mut cells = Vec::with_capacity((columns + rows) as usize);
    while (column, row) != (columns, rows) {
        // The next lines are at (2 column + 1) / (2 columns) and at (2 row + 1) / (2 rows) of the way.
        if (2 * row + 1) * columns <= (2 * column + 1) * rows {
            row += 1;
        } else {
            column += 1;
        }
        cells.push((column * end.0.signum(), row * end.1.signum()));
    }
    cells
}

/// Whether light is added or taken away.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LightChange {
    Add,
    TakeAway,
}

/// The carrier of a lamp, which decides the tiles that the light passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Carrier {
    Thing,
    /// Something that moves.
    Mover,
}

/// The glow of each kind of lamp that has been needed. It does not affect the equality of worlds.
#[derive(Clone, Debug, Default)]
struct Glows {
    list: Vec<(Lamp, Arc<Glow>)>,
}

impl World {
    /// Replaces all lamps that move, each in a cell. Computes only the light of lamps that differ
    /// from the previous lamp at the same index. Returns whether any lamp differs.
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
            for (lamp, change) in [(old, LightChange::TakeAway), (new, LightChange::Add)] {
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

    /// Lights the [flames](ThingKind::Flame) in `cell`, or puts them out. A flame that is out gives
    /// no light and shows the last frame of its sprite.
    pub(crate) fn set_flame(&mut self, cell: Cell, burns: bool) {
        let change = if burns { LightChange::Add } else { LightChange::TakeAway };
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
                let (lamp, carrier, change) = ((cell, lamp), Carrier::Thing, LightChange::TakeAway);
                shine(&self.grid, &self.tiles, &mut self.lamplight, lamp, carrier, change);
            }
        }
    }

    /// Sets the tile of `cell` to a state of the door or the moving tile there. From now on,
    /// lamplight passes through the cell or stops at it accordingly.
    pub(crate) fn set_tile(&mut self, cell: Cell, tile: TileId) {
        let kind = |id: TileId| self.tiles[usize::from(id.0)].kind;
        let before = self.grid.tile_in(cell).map(kind);
        let changes = |carrier: &Carrier| {
            !self.lamplight.is_dark()
                && before.map(|kind| carrier.lets_through(kind))
                    != Some(carrier.lets_through(kind(tile)))
        };
        let changed = [Carrier::Thing, Carrier::Mover].map(|it| Some(it).filter(changes));
        for &carrier in changed.iter().flatten() {
            self.shine_around(cell, carrier, LightChange::TakeAway);
        }
        self.grid.set(cell, tile);
        let is_level = self.tile(tile).is_level();
        if let Some(grid) = &mut self.level_grid {
            grid.set(cell, if is_level { tile } else { TileId(u8::MAX) });
        }
        for &carrier in changed.iter().flatten() {
            self.shine_around(cell, carrier, LightChange::Add);
        }
    }

    /// Computes all lamplight again, without lamps that move.
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
                lamplight.change(cell, light, LightChange::Add);
            });
        }
        self.light_varies = !self.lamplight.is_dark() || self.tiles_differ_in_light();
    }

    /// Adds or takes away the light of all lamps of a carrier whose light may pass through `cell`.
    fn shine_around(&mut self, cell: Cell, carrier: Carrier, change: LightChange) {
        let Self { grid, tiles, things, sprites, lamplight, .. } = self;
        let is_near = |&(place, lamp): &(Cell, Lamp)| {
            place.center().distance(cell.center()) < lamp.reach.cells()
        };
        match carrier {
            Carrier::Thing => {
                let most = Reach::MAX as u32;
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

    /// Returns whether cells may differ in light without lamps.
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
    /// Returns whether it gives light, if its sprite is a lamp.
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
    change: LightChange,
) {
    if lamplight.is_dark() || grid.tile_in(cell).is_none() {
        return;
    }
    let glow = lamplight.glows.of(lamp);
    let is_clear = |tile: TileId| carrier.lets_through(tiles[usize::from(tile.0)].kind);
    glow.shine(grid, cell, is_clear, |cell, light| lamplight.change(cell, light, change));
}

#[cfg(test)]
mod tests;
