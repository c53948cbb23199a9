//! Where players come into a game: the nearest free place.

use crate::game::Game;
use crate::game::player::{Motion, RADIUS, STEP_HEIGHT};
use crate::world::{Cell, ThingKind, World};

/// The cells that are considered, from the nearest on.
const MOST_CELLS: usize = 64;

impl Game {
    /// A player who stands still in the cell nearest to `start` where there is room; `None` if there
    /// is none near it. Only ways that can be walked count.
    pub(super) fn free_place(&self, start: Cell) -> Option<Motion> {
        let mut cells = [start; MOST_CELLS];
        let (mut next, mut found) = (0, 1);
        while next < found {
            let cell = cells[next];
            next += 1;
            if let Some(motion) = self.place_in(cell, start) {
                return Some(motion);
            }
            for neighbor in neighbors(cell) {
                let is_new = !cells[..found].contains(&neighbor);
                if is_new && found < MOST_CELLS && leads(&self.world, cell, neighbor) {
                    cells[found] = neighbor;
                    found += 1;
                }
            }
        }
        None
    }

    /// A player in the middle of `cell`, unless they would be in anything, be hurt, or take or reach
    /// something there.
    fn place_in(&self, cell: Cell, start: Cell) -> Option<Motion> {
        let is_harmless = |kind| matches!(kind, ThingKind::Ornament | ThingKind::Flame);
        let is_plain = self.world.effect_in(cell).is_none()
            && self.world.things_in(cell).iter().all(|thing| is_harmless(thing.kind));
        if cell != start && !is_plain {
            return None;
        }
        let motion = Motion::new(&self.world).moved_to(&self.world, cell)?;
        self.is_free_of_players(&motion).then_some(motion)
    }

    /// Whether nobody is in the way of a player who is at `motion`.
    fn is_free_of_players(&self, motion: &Motion) -> bool {
        let collides = self.multiplayer_rules().is_some_and(|rules| rules.collides);
        let least = 2.0 * RADIUS.cells();
        let is_far =
            |it: &Motion| it.position().distance_squared(motion.position()) >= least * least;
        !collides || self.playing().all(|(_, player)| is_far(&player.motion))
    }

    /// Lets the player whose turn it is go on from their last checkpoint, if there is room.
    pub(super) fn respawn(&mut self) {
        let checkpoint = self.last_checkpoint();
        let Some(motion) = self.free_place(checkpoint.unwrap_or(self.world.start().cell)) else {
            return;
        };
        self.player = self.player.clone().at(motion);
        self.player.health = self.player.health.revived();
        (self.player.killed_by, self.player.flash) = (None, None);
        (self.player.in_water, self.player.last_thrust) = (0, None);
        self.player.warnings.clear();
        self.revision += 1;
        if let Some(member) = self.member_in_turn() {
            member.ended = None;
            (member.stunned, member.swing) = (0, 0);
        }
    }
}

/// The cells beside `cell`.
fn neighbors(Cell { column, row }: Cell) -> impl Iterator<Item = Cell> {
    let west = column.checked_sub(1).map(|column| Cell { column, row });
    let north = row.checked_sub(1).map(|row| Cell { column, row });
    let east = Cell { column: column.saturating_add(1), row };
    let south = Cell { column, row: row.saturating_add(1) };
    [Some(east), Some(south), west, north].into_iter().flatten()
}

/// Whether a player walks from one cell into the next.
fn leads(world: &World, from: Cell, to: Cell) -> bool {
    let (column, row) = (i64::from(to.column), i64::from(to.row));
    let is_open = world.grid().tile(column, row).is_some() && !world.grid().is_solid(column, row);
    is_open && (world.floor_at(from) - world.floor_at(to)).abs() <= STEP_HEIGHT
}
