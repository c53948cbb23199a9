//! The whole state of a game as bytes, and back.
//!
//! Only the state that changes is stored. The rest comes from a game at its start in the same level
//! with the same rules: the map, the posts of guards, sprites and textures. State computed from the
//! stored state is not stored either: the openings of doors and the states of moving tiles in the
//! grid, and the light of lamps.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use super::Game;
use super::checkpoint::Checkpoint;
use super::multiplayer::Members;
use super::rules::{MultiplayerRules, Rules};
use super::stored::{OfLevel, Reader, RestoreError, check, checksum, written};
use crate::rng::hash;
use crate::world::{Cell, Changes, Thing};

/// The kind of stored data in the first line.
const KIND: &str = "game";

impl Game {
    /// The whole state between two steps as bytes, without the parts that the level provides.
    /// `None` in a generated level, which differs at each start.
    ///
    /// ```
    /// use cellcaster::game::{Game, Intent};
    /// use cellcaster::map::builtin;
    ///
    /// let world = builtin::LEVELS[0].world()?;
    /// let mut game = Game::new(world.clone());
    /// (0..60).for_each(|_| game.step([Intent::Forward].into_iter().collect()));
    /// let bytes = game.stored().expect("the level is built in");
    /// assert_eq!(Game::new(world).restored(&bytes), Ok(game));
    /// # Ok::<(), cellcaster::fault::Faults>(())
    /// ```
    pub fn stored(&self) -> Option<Vec<u8>> {
        self.window.is_none().then(|| written(KIND, &GameState(self)))
    }

    /// The game that `bytes` were stored from. `self` must be at its start, in the same level with
    /// the same rules.
    ///
    /// # Errors
    /// If the bytes do not contain such a game, or are damaged. Accepted bytes do not prove that
    /// the game was ever played.
    pub fn restored(self, bytes: &[u8]) -> Result<Self, RestoreError> {
        let grid = self.world.grid();
        let mut input = Reader::new(KIND, bytes, (grid.width(), grid.height()))?;
        let game = self.read(&mut input, true)?;
        if input.rest().is_empty() { Ok(game) } else { Err(RestoreError::Longer) }
    }

    /// A checksum of the whole state: the world, the player, the guards and everything that moves.
    /// Games in different states very likely have different checksums, on every machine.
    pub fn checksum(&self) -> u64 {
        let rows = self.world.grid().rows();
        let tiles = rows.map(|row| hash(0, row.iter().map(|tile| u64::from(tile.0))));
        hash(checksum(&self.rules_state()) ^ self.level_hash(), tiles)
    }

    /// The part of the state that the rules depend on.
    fn rules_state(&self) -> impl Serialize {
        let Self {
            rules: _,
            world,
            is_mission: _,
            window: _,
            player,
            members,
            doors,
            mechanisms,
            spikes,
            missiles,
            smoke,
            guards,
            // Empty between steps.
            sounds: _,
            steps,
            // Counted in each step.
            work: _,
            // Not part of the rules, or copies of past states.
            sprites: _,
            checkpoint: _,
            revision: _,
            figure_revision: _,
        } = self;
        let things = world.changes().things;
        (things, steps, doors, mechanisms, spikes, missiles, smoke, guards, player, members)
    }

    /// Reads a game on top of its start `self`. If `has_checkpoint` is true, also reads the game at
    /// the player's checkpoint.
    fn read(mut self, input: &mut Reader, has_checkpoint: bool) -> Result<Self, RestoreError> {
        let start = (has_checkpoint && self.members.is_none()).then(|| self.clone());
        if input.read::<[u8; 8]>()? != self.level_hash().to_le_bytes() {
            return Err(RestoreError::OtherLevel);
        }
        let (revision, figure_revision, has_player, is_lamplit) = input.read()?;
        if has_player {
            self.sprites.add_player(&mut self.world);
        }
        let figures: Vec<_> = input.read()?;
        let things = input.read()?;
        self.steps = input.read()?;
        self.doors = input.read()?;
        self.mechanisms = input.read_with(self.mechanisms)?;
        self.spikes = input.read_with(self.spikes)?;
        (self.missiles, self.smoke) = input.read()?;
        self.guards = input.read_with(self.guards)?;
        self.player = input.read()?;
        let members: Option<Members> = input.read()?;
        self.members = match (members, self.members) {
            (Some(members), Some(start)) => Some(Box::new(members.of_level(*start)?)),
            (None, None) => None,
            _ => return Err(RestoreError::OtherLevel),
        };
        self.check()?;
        self.show_changes(things, is_lamplit)?;
        self.world.set_figures(figures.into_iter());
        (self.revision, self.figure_revision) = (revision, figure_revision);
        let cell: Option<Cell> = input.read()?;
        let saved = if input.read()? {
            let start = start.ok_or(RestoreError::Damaged("a checkpoint"))?;
            Some(Arc::new(start.read(input, false)?))
        } else {
            None
        };
        if cell.is_some() {
            self.checkpoint = Checkpoint::new(saved, cell);
        }
        Ok(self)
    }

    /// Returns an error if a step could fail in this state.
    fn check(&self) -> Result<(), RestoreError> {
        self.missiles.check()?;
        self.smoke.check()?;
        self.guards.check(&self.world)?;
        self.player.check(&self.world, self.steps)?;
        self.members.as_ref().map_or(Ok(()), |members| members.check(&self.world, self.steps))
    }

    /// Applies the changes since the start to the world, which is still in its initial state.
    fn show_changes(&mut self, things: Vec<Thing>, is_lamplit: bool) -> Result<(), RestoreError> {
        self.doors.show(&mut self.world)?;
        self.mechanisms.show(&mut self.world)?;
        check(self.world.leave_things(things), "a thing")?;
        if is_lamplit {
            self.world.make_room_for_light();
        }
        self.show_lamps();
        Ok(())
    }

    /// A hash of the level, the rules and the multiplayer rules. Different combinations almost
    /// certainly have different hashes.
    fn level_hash(&self) -> u64 {
        let Rules { difficulty, seed } = self.rules;
        let multiplayer = self.multiplayer_rules().map_or(0, |rules| {
            let MultiplayerRules { collides, respawns, shows_on_map, strikes } = rules;
            1 | u64::from(collides) << 1
                | u64::from(respawns) << 2
                | (shows_on_map as u64) << 8
                | (strikes as u64) << 16
        });
        let world = &self.world;
        let place = |cell: Cell| u64::from(cell.row) << 32 | u64::from(cell.column);
        let title = world.title().bytes().map(u64::from);
        let posts = world.guards().iter().flat_map(|it| [it.kind as u64, place(it.cell)]);
        let size = [world.grid().width(), world.grid().height(), world.tiles().len() as u32];
        let words = [difficulty as u64, seed, multiplayer, place(world.start().cell)];
        hash(0, words.into_iter().chain(size.map(u64::from)).chain(title).chain(posts))
    }
}

/// The part of a game that the level does not provide.
struct GameState<'a>(&'a Game);

impl Serialize for GameState<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Self(game) = self;
        let level = game.level_hash().to_le_bytes();
        let Changes { things: _, figures, is_lamplit } = game.world.changes();
        let shown = (game.revision, game.figure_revision, game.sprites.has_player(), is_lamplit);
        let cell = game.checkpoint.cell;
        // Without a cell, the checkpoint is the start, which is known.
        let saved = game.checkpoint.game().filter(|_| cell.is_some()).map(GameState);
        (level, shown, figures, game.rules_state(), cell, saved).serialize(to)
    }
}
