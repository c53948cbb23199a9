//! The entry of players into a game: the nearest free cell that shows them the level as its author
//! intended.

use crate::game::Game;
use crate::game::player::{Motion, RADIUS, STEP_HEIGHT};
use crate::game::sight::Point;
use crate::world::{Cell, Heading, ThingKind, World};

/// The number of nearest cells that are considered.
const MAX_CELLS: usize = 64;

/// A requirement on the cell in which a player begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum CellRequirement {
    /// The floor is as high as at the start, no guard sees the cell, and the path to it passes
    /// neither doors nor hazards.
    Safe,
    /// Like `Safe`, but guards may see the cell.
    Level,
    /// A player can walk there.
    Reachable,
}

impl Game {
    /// A player who stands still in the cell nearest to `start` that has room. No two players
    /// overlap. Only if no cell is free, players share the start. `None` if players may not
    /// overlap, or if nobody fits at the start.
    pub(crate) fn free_place(&self, start: Cell) -> Option<Motion> {
        let demands = [CellRequirement::Safe, CellRequirement::Level, CellRequirement::Reachable];
        let free = demands.into_iter().find_map(|demand| self.nearest_place(start, demand));
        let collides = self.multiplayer_rules().is_some_and(|rules| rules.collides);
        let shared = || self.place_in(start).filter(|_| !collides);
        free.or_else(shared)
    }

    /// The nearest position that meets `demand`.
    fn nearest_place(&self, start: Cell, demand: CellRequirement) -> Option<Motion> {
        let mut cells = [start; MAX_CELLS];
        let (mut next, mut found) = (0, 1);
        let ahead = self.world.start().heading;
        while next < found {
            let cell = cells[next];
            next += 1;
            let is_fit = cell == start || self.meets(cell, demand);
            let place = is_fit.then(|| self.place_in(cell)).flatten();
            if let Some(motion) = place.filter(|motion| self.is_free_of_players(motion)) {
                return Some(motion);
            }
            for neighbor in neighbors(cell, ahead) {
                let is_new = !cells[..found].contains(&neighbor);
                if is_new && found < MAX_CELLS && self.leads(cell, neighbor, demand) {
                    cells[found] = neighbor;
                    found += 1;
                }
            }
        }
        None
    }

    /// Whether a player may begin in a cell other than the start.
    fn meets(&self, cell: Cell, demand: CellRequirement) -> bool {
        self.is_plain(cell) && (demand != CellRequirement::Safe || !self.is_seen_by_guards(cell))
    }

    /// Whether a player can walk from one cell into the next.
    fn leads(&self, from: Cell, to: Cell, demand: CellRequirement) -> bool {
        let climb = (self.world.floor_at(from) - self.world.floor_at(to)).abs();
        let is_level_and_plain =
            || climb == 0.0 && self.is_plain(to) && self.place_in(to).is_some();
        is_open(&self.world, to)
            && climb <= STEP_HEIGHT
            && (demand == CellRequirement::Reachable || is_level_and_plain())
    }

    /// Returns true if a player in the cell is not hurt, reaches nothing, and is not in the way of
    /// a door.
    fn is_plain(&self, cell: Cell) -> bool {
        let is_harmless = |kind| matches!(kind, ThingKind::Ornament | ThingKind::Flame);
        self.world.effect_in(cell).is_none()
            && self.world.door(cell).is_none()
            && self.world.things_in(cell).iter().all(|thing| is_harmless(thing.kind))
    }

    /// Whether a guard could see a player in a cell.
    fn is_seen_by_guards(&self, cell: Cell) -> bool {
        let Some(motion) = self.place_in(cell) else { return false };
        let height = f64::midpoint(motion.feet(), motion.head());
        self.guards.may_see(&self.world, Point { position: cell.center(), height })
    }

    /// A player in the middle of `cell`, if they fit there.
    fn place_in(&self, cell: Cell) -> Option<Motion> {
        Motion::new(&self.world).moved_to(&self.world, cell)
    }

    /// Whether a player at `motion` overlaps no other player.
    fn is_free_of_players(&self, motion: &Motion) -> bool {
        let least = 2.0 * RADIUS.cells();
        let is_far =
            |it: &Motion| it.position().distance_squared(motion.position()) >= least * least;
        self.playing().all(|(_, player)| is_far(&player.motion))
    }

    /// Revives the current player at their last checkpoint, if there is room.
    pub(crate) fn respawn(&mut self) {
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

/// The cells beside `cell`: the cell ahead, the cell behind, and the cells at the sides. With this
/// order, a player who begins at the start has others in view.
fn neighbors(cell: Cell, heading: Heading) -> impl Iterator<Item = Cell> {
    let facing = heading.direction();
    let ahead = if facing.x.abs() >= facing.y.abs() {
        [facing.x.signum(), 0.0]
    } else {
        [0.0, facing.y.signum()]
    };
    let [x, y] = ahead.map(|way| way as i64);
    [[x, y], [-x, -y], [-y, x], [y, -x]].into_iter().filter_map(move |[x, y]| cell.moved(x, y))
}

/// Whether a cell is on the map and not solid.
fn is_open(world: &World, Cell { column, row }: Cell) -> bool {
    let (column, row) = (i64::from(column), i64::from(row));
    world.grid().tile(column, row).is_some() && !world.grid().is_solid(column, row)
}
