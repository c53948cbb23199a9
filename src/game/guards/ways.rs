//! Ways: for each goal, the distance of the cells around it, which all guards share who go there.
//!
//! A search begins at the goal and ends when it has found those who ask. Guards who follow the same
//! player have the same goal, so that twenty of them cost hardly more than one. All searches
//! together find at most [`MOST_CELLS`] cells in a step and go on in the next; a guard without a
//! way yet walks on where they went before. A search for each guard (A*) was refused: it finds
//! fewer cells for one guard, and all of them again for the next.
//!
//! Doors and moving floors change ways. A step that is not possible any more begins the search
//! anew, and so does a search that has become old.

use serde::{Deserialize, Serialize};

use super::terrain::{Backwards, Gait, Terrain, cost_between};
use crate::game::flood::{Flood, neighbor};
use crate::game::stored::{Unrestorable, at_most, check};
use crate::world::{Cell, World};

/// The number of cells that all searches together find in one step.
pub(crate) const MOST_CELLS: usize = 200;
/// The number of goals at a time.
const MOST_FIELDS: usize = 12;
/// The steps after which a search begins anew: that of a goal that could be reached, and that of
/// one that could not.
const OLD: u64 = 1200;
const OLD_IN_VAIN: u64 = 150;

/// The distances from some goals.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Ways {
    #[serde(deserialize_with = "at_most::<MOST_FIELDS, _, _>")]
    fields: Vec<Field>,
    /// The number of the present step.
    now: u64,
    cells_left: usize,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Field {
    goal: Cell,
    gait: Gait,
    flood: Flood,
    begun: u64,
    used: u64,
}

/// The answer to the question for a way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// The neighbouring cell to go to.
    Next(Cell),
    /// This is the goal.
    Here,
    /// Not known yet.
    Unknown,
    /// There is none.
    Impossible,
}

impl Ways {
    /// Refuses searches from the future, and such that do not fit a map with that many columns and rows.
    pub(crate) fn check(&self, map: (u32, u32)) -> Result<(), Unrestorable> {
        let is_possible = |it: &Field| {
            it.begun <= self.now && it.used <= self.now && it.flood.is_around(it.goal, map)
        };
        check(self.fields.iter().all(is_possible), "a search")
    }

    /// Begins a step of the game.
    pub(crate) fn begin_step(&mut self) {
        self.now += 1;
        self.cells_left = MOST_CELLS;
    }

    /// Advances the clock by `steps` in which nobody asks for a way.
    pub(crate) fn wait(&mut self, steps: u64) {
        self.now += steps;
        if steps > 0 {
            self.cells_left = MOST_CELLS;
        }
    }

    /// Forgets all ways, as when the whole map has changed.
    pub(crate) fn forget(&mut self) {
        self.fields.clear();
    }

    /// The next cell on the shortest way from `from` to `goal`.
    pub(crate) fn towards(
        &mut self,
        world: &World,
        terrain: &Terrain,
        gait: Gait,
        from: Cell,
        goal: Cell,
    ) -> Way {
        if from == goal {
            return Way::Here;
        }
        let Some(index) = self.field(terrain, gait, goal) else { return Way::Unknown };
        let (now, field) = (self.now, &mut self.fields[index]);
        field.used = now;
        let costs = Backwards { terrain, world, gait };
        while field.flood.distance(from).is_none() && !field.flood.is_over() {
            if self.cells_left == 0 {
                return Way::Unknown;
            }
            self.cells_left -= 1;
            field.flood.advance(&costs);
        }
        let age = now - field.begun;
        let Some(distance) = field.flood.distance(from) else {
            if age > OLD_IN_VAIN {
                field.begin(terrain, now);
            }
            return Way::Impossible;
        };
        let next = field.next(&costs, from, distance);
        if next.is_none() || age > OLD {
            field.begin(terrain, now);
        }
        next.map_or(Way::Unknown, Way::Next)
    }

    /// The cell after `from` on a way that has been found already.
    pub(crate) fn after(
        &self,
        world: &World,
        terrain: &Terrain,
        gait: Gait,
        from: Cell,
        goal: Cell,
    ) -> Option<Cell> {
        let field = self.fields.iter().find(|it| it.goal == goal && it.gait == gait)?;
        let costs = Backwards { terrain, world, gait };
        field.next(&costs, from, field.flood.distance(from)?)
    }

    /// The index of the field of a goal, which may be a new one; `None` if all are in use.
    fn field(&mut self, terrain: &Terrain, gait: Gait, goal: Cell) -> Option<usize> {
        let mut fields = self.fields.iter();
        if let Some(index) = fields.position(|it| it.goal == goal && it.gait == gait) {
            return Some(index);
        }
        let (begun, used) = (self.now, self.now);
        if self.fields.len() < MOST_FIELDS {
            self.fields.push(Field { goal, gait, flood: Flood::default(), begun, used });
        } else {
            let oldest = self.fields.iter_mut().min_by_key(|field| field.used)?;
            if oldest.used + 1 >= self.now {
                return None;
            }
            (oldest.goal, oldest.gait) = (goal, gait);
        }
        let index = self.fields.iter().position(|it| it.goal == goal && it.gait == gait)?;
        self.fields[index].begin(terrain, begun);
        Some(index)
    }
}

impl Field {
    fn begin(&mut self, terrain: &Terrain, now: u64) {
        self.flood.begin(self.goal, terrain.size());
        (self.begun, self.used) = (now, now);
    }

    /// The neighbour of `from`, at this distance from the goal, that is nearest to it.
    fn next(&self, costs: &Backwards, from: Cell, distance: u16) -> Option<Cell> {
        let neighbors = (0..8).filter_map(|side| neighbor(from, side));
        let nearer = neighbors.filter_map(|cell| {
            let there = self.flood.distance(cell).filter(|&there| there < distance)?;
            Some((there.saturating_add(cost_between(from, cell)), cell))
        });
        let possible = nearer.filter(|&(_, cell)| costs.leads(from, cell));
        Some(possible.min_by_key(|&(distance, _)| distance)?.1)
    }
}

impl Backwards<'_> {
    /// Whether the step from `from` to its neighbour `to` is possible now.
    fn leads(&self, from: Cell, to: Cell) -> bool {
        use crate::game::flood::Costs;
        let straight = |from, to| self.straight(&self.origin(to), from).is_some();
        if from.column == to.column || from.row == to.row {
            return straight(from, to);
        }
        let beside =
            [Cell { column: from.column, row: to.row }, Cell { column: to.column, row: from.row }];
        self.has_diagonal(&self.origin(to), from, beside.map(|cell| straight(cell, to)))
    }
}
