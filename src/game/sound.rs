//! Sounds: their sources, their reach, and their listeners.
//!
//! A sound spreads over open cells, around corners and through open doors. Walls stop it. It also
//! passes over low walls and through the holes of masks. A closed door or glass weakens it: each
//! counts as [`DAMPING`] more half cells. Rejected: a straight line from the ear to the source.
//! Sounds would pass through walls, and a guard would know what happens behind a wall.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::distances::{Costs, Distances, STRAIGHT};
use super::stored::{RestoreError, check};
use crate::world::{Cell, Heading, Tile, TileKind, World};

/// A sound in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sound {
    /// The kind of sound.
    pub kind: SoundKind,
    /// The cell in which the sound is made.
    pub cell: Cell,
    /// The reach over open cells, in cells; at most [`Sound::FARTHEST`].
    pub reach: u8,
    /// The source of the sound.
    pub by: Source,
}

impl Sound {
    /// The largest reach that has an effect, in cells.
    pub const FARTHEST: u8 = 24;
}

/// The source of a sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Source {
    /// The player with that index.
    Player(usize),
    /// The guard with that index.
    Guard(usize),
    /// An object. No player or guard causes the sound at that moment, for example when a thrown
    /// pebble lands.
    Object,
}

/// A kind of sound.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum SoundKind {
    /// A footstep of somebody who walks.
    Walking,
    /// A footstep of somebody who runs.
    Running,
    /// A landing after a jump or a fall.
    Landing,
    /// A step into water.
    Splash,
    /// A door that begins to move.
    Door,
    /// A stone, a lever or a floor that moves.
    Mechanism,
    /// Spikes that are about to come out.
    Spikes,
    /// A pebble that lands.
    Knock,
    /// Something that breaks, such as a flask.
    Crash,
    /// A blow that hits.
    Blow,
    /// Somebody who is hurt.
    Cry,
    /// A guard who falls.
    Fall,
    /// A guard who has noticed something: "Hm?"
    Wonder,
    /// A guard who has lost their target and returns to duty.
    GiveUp,
    /// A guard who has seen the player and calls the others.
    Shout,
    /// The bell of a lantern-bearer.
    Bell,
    /// A hound that has seen or smelled the player.
    Bark,
    /// A guard who raises a weapon.
    Windup,
    /// An archer who draws the bow.
    Draw,
    /// An archer who shoots.
    Shot,
    /// A blow that meets nothing.
    Swing,
}

/// The additional cost of a closed door or of glass, in half cells.
const DAMPING: u16 = 12;
/// Sound passes over walls that are at most this much higher than the floor beside them, in cells.
const LOW_WALL: f64 = 0.75;
/// The number of steps after which the field is computed again, because doors may have moved.
const OLD: u64 = 30;

/// The distances of sounds from one cell to the surrounding cells.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct SoundField {
    center: Option<Cell>,
    distances: Distances,
    begun: u64,
}

impl SoundField {
    /// Finds the distances of the cells within `reach` around `center`. `now` is the number of the
    /// step. Returns the number of cells that were newly found.
    pub(crate) fn reach_out(&mut self, world: &World, center: Cell, reach: u16, now: u64) -> usize {
        let grid = world.grid();
        let is_old = now.saturating_sub(self.begun) > OLD;
        if self.center != Some(center) || is_old {
            self.distances.begin(center, (grid.width(), grid.height()));
            (self.center, self.begun) = (Some(center), now);
        }
        let reach = reach.min(half_cells(Sound::FARTHEST));
        let mut found = 0;
        while self.distances.radius() <= reach && self.distances.advance(&SoundCosts { world }) {
            found += 1;
        }
        found
    }

    /// The distance of `cell` from the centre, in half cells; `None` if the cell is beyond the
    /// reach.
    pub(crate) fn distance(&self, cell: Cell) -> Option<u16> {
        self.distances.distance(cell)
    }

    /// Whether the search fits a map with these numbers of columns and rows.
    pub(crate) fn is_possible(&self, map: (u32, u32)) -> bool {
        self.center.is_none_or(|center| self.distances.is_around(center, map))
    }

    /// Forgets the distances.
    pub(crate) fn forget(&mut self) {
        self.center = None;
    }
}

/// A reach in half cells.
pub(crate) fn half_cells(reach: u8) -> u16 {
    u16::from(reach) * STRAIGHT
}

/// The costs of steps for sound.
struct SoundCosts<'a> {
    world: &'a World,
}

impl SoundCosts<'_> {
    fn tile(&self, cell: Cell) -> Option<&Tile> {
        self.world.tile_in(cell)
    }

    /// Whether sound passes between two neighbours.
    fn passes(&self, one: Cell, other: Cell) -> bool {
        let (Some(one), Some(other)) = (self.tile(one), self.tile(other)) else { return false };
        is_low_beside(one, other) && is_low_beside(other, one) && have_common_air(one, other)
    }
}

impl Costs for SoundCosts<'_> {
    type Origin = Cell;

    fn origin(&self, cell: Cell) -> Cell {
        cell
    }

    fn straight(&self, &from: &Cell, to: Cell) -> Option<u16> {
        let is_dampened = self.tile(to).is_some_and(dampens);
        let cost = if is_dampened { STRAIGHT + DAMPING } else { STRAIGHT };
        self.passes(from, to).then_some(cost)
    }

    fn has_diagonal(&self, &from: &Cell, to: Cell, beside: [bool; 2]) -> bool {
        let is_free = |cell| self.tile(cell).is_some_and(|tile| !dampens(tile));
        let corners =
            [Cell { column: to.column, row: from.row }, Cell { column: from.column, row: to.row }];
        let passes =
            |corner| is_free(corner) && self.passes(from, corner) && self.passes(corner, to);
        beside != [false, false]
            && is_free(from)
            && is_free(to)
            && self.passes(from, to)
            && corners.into_iter().any(passes)
    }
}

fn dampens(tile: &Tile) -> bool {
    matches!(tile.kind, TileKind::Door(_) | TileKind::Glass(_))
}

/// Whether `tile` is not a wall, or is a low wall beside the floor of `other`.
fn is_low_beside(tile: &Tile, other: &Tile) -> bool {
    let is_wall = matches!(tile.kind, TileKind::Wall(_) | TileKind::Mirror(_));
    !is_wall || tile.heights.floor() - other.heights.floor() <= LOW_WALL
}

/// Whether a gap of one tile overlaps a gap of the other.
fn have_common_air(one: &Tile, other: &Tile) -> bool {
    one.gaps()
        .any(|gap| other.gaps().any(|there| gap.bottom.max(there.bottom) < gap.top.min(there.top)))
}

/// The number of steps for which a sound is shown.
const DURATION: u16 = 45;
/// The maximum number of sounds shown at once.
const MAX: usize = 8;

/// A sound as a player hears it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Heard {
    /// The direction on the map from which the sound comes.
    pub bearing: Heading,
    /// The loudness, from 1 to 3.
    pub strength: u8,
    /// The kind of sound.
    pub kind: SoundKind,
    /// The remaining steps for which the sound is shown.
    pub left: u16,
}

/// The hearing of a player: the sounds of the last steps.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
pub(crate) struct Hearing {
    field: SoundField,
    /// The sounds heard in the last steps, newest last.
    pub(crate) heard: Vec<Heard>,
    /// The sound for each entry of `heard`.
    sounds: Vec<Sound>,
    steps: u64,
}

impl Hearing {
    /// Advances by one step, in which `sounds` are made. The player `listener`, at `position`,
    /// hears the sounds of others. Returns whether a sound is heard or fades away.
    pub(crate) fn step(
        &mut self,
        world: &World,
        listener: usize,
        position: DVec2,
        sounds: &[Sound],
    ) -> bool {
        let before = self.heard.len();
        self.wait(1);
        self.fade();
        let has_faded = self.heard.len() != before;
        let mut has_heard = false;
        for sound in sounds.iter().filter(|sound| sound.by != Source::Player(listener)) {
            if let Some(strength) = self.strength(world, position, sound) {
                self.hear(sound, position, strength);
                has_heard = true;
            }
        }
        has_faded || has_heard
    }

    /// Returns an error for a state that no sequence of sounds can produce.
    pub(crate) fn check(&self, world: &World) -> Result<(), RestoreError> {
        let map = (world.grid().width(), world.grid().height());
        check(self.field.is_possible(map), "the search of a sound")?;
        let is_audible = |heard: &Heard| {
            (1..=3).contains(&heard.strength) && (1..=DURATION).contains(&heard.left)
        };
        let is_known = self.sounds.len() == self.heard.len() && self.heard.len() <= MAX;
        check(is_known && self.heard.iter().all(is_audible), "what a player hears")
    }

    /// Advances the clock by `steps` steps in which no sound is heard or shown.
    pub(crate) fn wait(&mut self, steps: u64) {
        self.steps = self.steps.saturating_add(steps);
    }

    /// Removes the sounds whose time ends in this step.
    fn fade(&mut self) {
        self.heard.iter_mut().for_each(|heard| heard.left -= 1);
        while let Some(index) = self.heard.iter().position(|heard| heard.left == 0) {
            self.remove(index);
        }
    }

    /// Forgets the distances of sounds, for example when the whole map has changed.
    pub(crate) fn forget(&mut self) {
        self.field.forget();
    }

    /// The loudness of a sound at `position`, from 1 to 3; `None` if the sound does not reach it.
    fn strength(&mut self, world: &World, position: DVec2, sound: &Sound) -> Option<u8> {
        let reach = half_cells(sound.reach.min(Sound::FARTHEST));
        let from = sound.cell.center();
        if from.distance(position) > f64::from(sound.reach) * 1.1 + 1.5 {
            return None;
        }
        let cell = Cell::at(position);
        self.field.reach_out(world, cell, reach, self.steps);
        let distance = self.field.distance(sound.cell).filter(|&distance| distance <= reach)?;
        Some(3 - (u32::from(distance) * 3 / (u32::from(reach) + 1)) as u8)
    }

    /// Records a sound. It replaces an older sound of the same source and kind. Of such sounds in
    /// one step, the nearest is kept.
    fn hear(&mut self, sound: &Sound, position: DVec2, strength: u8) {
        let way = sound.cell.center() - position;
        let degrees = libm::atan2(way.y, way.x).to_degrees();
        let bearing = Heading::from_degrees(degrees).unwrap_or_default();
        let is_same = |other: &Sound| (other.by, other.kind) == (sound.by, sound.kind);
        if let Some(index) = self.sounds.iter().position(is_same) {
            let is_new = self.heard[index].left == DURATION;
            let distance = self.sounds[index].cell.center().distance(position);
            if is_new && distance <= way.length() {
                return;
            }
            self.remove(index);
        } else if self.heard.len() == MAX {
            self.remove(0);
        }
        self.sounds.push(*sound);
        self.heard.push(Heard { bearing, strength, kind: sound.kind, left: DURATION });
    }

    fn remove(&mut self, index: usize) {
        self.heard.remove(index);
        self.sounds.remove(index);
    }
}
