//! Reachable keys: a search from the start through open floor, doors, and locked doors whose keys
//! or switches have been found.
//!
//! It overestimates what the player can reach: walls that sink are open, all floors are at one
//! height, and a plate that a guard may step on is pressed.
//!
//! Facts about cells are stored in arrays with a value for each cell. Rejected: ordered sets of
//! cells. A map with a pillar in each of a million cells took 1.3 s, most of it in the sets.

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroU32;

use super::legend::{Meaning, Symbol};
use super::plan::Plan;
use crate::sort;
use crate::world::{Cell, Flood, Grid};

/// A key or a switch that opens doors.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Opener<'a> {
    /// The key with this name.
    Key(&'a str),
    /// The switch with this name.
    Switch(&'a str),
}

/// The number of an opener, counted from 1.
type OpenerId = NonZeroU32;

/// A value for each cell of a grid, initially the default.
struct PerCell<T> {
    width: usize,
    values: Vec<T>,
}

impl<T: Copy + Default> PerCell<T> {
    fn new(grid: &Grid) -> Self {
        let (width, height) = (grid.width() as usize, grid.height() as usize);
        Self { width, values: vec![T::default(); width * height] }
    }

    fn set(&mut self, cell: Cell, value: T) {
        self.values[cell.row as usize * self.width + cell.column as usize] = value;
    }

    fn get(&self, cell: Cell) -> T {
        self.values[cell.row as usize * self.width + cell.column as usize]
    }
}

/// A level for the search.
pub(crate) struct KeySearch<'l> {
    grid: &'l Grid,
    openers: BTreeMap<Opener<'l>, OpenerId>,
    /// Solid cells that can be passed: doors; walls that sink; shapes, which may leave room beside
    /// them; and things that the player may jump over.
    passable: PerCell<bool>,
    /// The opener of the door in a cell, if it is locked.
    locks: PerCell<Option<OpenerId>>,
    /// The key or the plate in a cell.
    found: PerCell<Option<OpenerId>>,
    /// The switches of levers, for each cell from which the player can reach them.
    levers: BTreeMap<Cell, Vec<OpenerId>>,
    /// The switches of plates that guards may step on.
    given: BTreeSet<OpenerId>,
}

impl<'l> KeySearch<'l> {
    /// The level of `plan` with the cells of `grid`. The player may jump over things in `low_cells`.
    pub(crate) fn of(
        plan: Plan<'l>,
        grid: &'l Grid,
        low_cells: impl Iterator<Item = Cell>,
    ) -> Self {
        let mut reach = Self {
            grid,
            openers: BTreeMap::new(),
            passable: PerCell::new(grid),
            locks: PerCell::new(grid),
            found: PerCell::new(grid),
            levers: BTreeMap::new(),
            given: BTreeSet::new(),
        };
        for cell in low_cells {
            reach.passable.set(cell, true);
        }
        let is_guard = |(_, it): (char, &Symbol<'_>)| matches!(it.meaning, Meaning::Guard(_));
        let has_guards = plan.symbols().any(is_guard);
        let matters = |character| {
            plan.symbol(character).is_some_and(|symbol| match &symbol.meaning {
                Meaning::Door(_) | Meaning::Shape(_) | Meaning::Key(_) => true,
                Meaning::Wall(wall) => wall.moves(),
                _ => symbol.sets().is_some(),
            })
        };
        for (cell, character) in plan.drawing.cells_of(matters) {
            let Some(symbol) = plan.symbol(character) else { continue };
            match &symbol.meaning {
                Meaning::Door(door) => {
                    let switch = door.switch.as_ref().map(|switch| Opener::Switch(switch.text));
                    let lock = door.key.as_ref().map(|key| Opener::Key(key.text)).or(switch);
                    let lock = lock.map(|opener| reach.id(opener));
                    reach.passable.set(cell, true);
                    reach.locks.set(cell, lock);
                }
                Meaning::Key(key) => {
                    let key = reach.id(Opener::Key(key.text));
                    reach.found.set(cell, Some(key));
                }
                Meaning::Lever(switch) => {
                    let opener = reach.id(Opener::Switch(switch.text));
                    for it in cells_around(cell) {
                        reach.levers.entry(it).or_default().push(opener);
                    }
                }
                _ => match symbol.sets() {
                    Some(plate) => {
                        let opener = reach.id(Opener::Switch(plate.text));
                        reach.found.set(cell, Some(opener));
                        reach.given.extend(has_guards.then_some(opener));
                    }
                    None => reach.passable.set(cell, true),
                },
            }
        }
        reach
    }

    /// The number of `opener`, assigned at its first use. There are fewer openers than characters.
    fn id(&mut self, opener: Opener<'l>) -> OpenerId {
        let new = NonZeroU32::MIN.saturating_add(self.openers.len() as u32);
        *self.openers.entry(opener).or_insert(new)
    }

    /// The keys that the player can reach from `start`.
    pub(crate) fn keys_from(&self, start: Cell) -> BTreeSet<&'l str> {
        let mut taken = self.given.clone();
        let mut waiting = BTreeMap::<OpenerId, Vec<Cell>>::new();
        let mut flood = Flood::new((self.grid.width(), self.grid.height()), start);
        while let Some((cell, _)) = flood.next(|cell| {
            let missing = self.locks.get(cell).filter(|opener| !taken.contains(opener));
            if let Some(opener) = missing {
                waiting.entry(opener).or_default().push(cell);
            }
            missing.is_none() && self.can_enter(cell)
        }) {
            let at_levers = self.levers.get(&cell).into_iter().flatten().copied();
            for opener in self.found.get(cell).into_iter().chain(at_levers) {
                if taken.insert(opener) {
                    let doors = waiting.remove(&opener).unwrap_or_default();
                    for door in doors {
                        flood.enter(door);
                    }
                }
            }
        }
        sort::gathered(self.openers.iter().filter_map(|(opener, id)| match opener {
            Opener::Key(name) if taken.contains(id) => Some(*name),
            _ => None,
        }))
    }

    fn can_enter(&self, cell: Cell) -> bool {
        let (column, row) = (i64::from(cell.column), i64::from(cell.row));
        let is_barred = self.grid.is_solid(column, row) || self.grid.is_occupied(column, row);
        !is_barred || self.passable.get(cell)
    }
}

/// The cell and its eight neighbours, from which a player can reach a lever in it.
fn cells_around(cell: Cell) -> impl Iterator<Item = Cell> {
    let beside = |place: u32| place.saturating_sub(1)..=place.saturating_add(1);
    let columns = beside(cell.column);
    beside(cell.row).flat_map(move |row| columns.clone().map(move |column| Cell { column, row }))
}
