//! A whole game as bytes, and back.

use std::sync::Arc;

use super::codec::{Reader, Stored, StoredPart, Writer, check};
use super::{Unrestorable, after_first_line, first_line};
use crate::game::checksum::word_of;
use crate::game::{Checkpoint, Game, MultiplayerRules, Rules};
use crate::rng::hash;
use crate::world::{Cell, Changes, Figure, Thing};

/// What the first line calls a game.
const KIND: &str = "game";

impl Game {
    /// The whole state between two steps as bytes, without what the level gives. `None` in a generated
    /// level, which is not the same at each start.
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
        let mut out = Writer::default();
        out.raw(first_line(KIND).as_bytes());
        self.write(&mut out)?;
        Some(out.into_bytes())
    }

    /// The game that `bytes` were stored from. This one is at its start, of the same level and
    /// rules.
    ///
    /// # Errors
    /// If the bytes are not those of such a game, or are damaged. That they pass does not mean that the
    /// game was ever played.
    pub fn restored(self, bytes: &[u8]) -> Result<Self, Unrestorable> {
        let bytes = after_first_line(KIND, bytes)?;
        let grid = self.world.grid();
        let mut input = Reader::new(bytes, (grid.width(), grid.height()));
        let game = self.read(&mut input, true)?;
        if input.rest().is_empty() { Ok(game) } else { Err(Unrestorable::Longer) }
    }

    fn write(&self, out: &mut Writer) -> Option<()> {
        let Self {
            rules: _,
            world,
            is_mission: _,
            window,
            player,
            members,
            doors,
            mechanisms,
            spikes,
            missiles,
            smoke,
            guards,
            sprites,
            // Empty between steps.
            sounds: _,
            checkpoint,
            steps,
            revision,
            figure_revision,
            // Counted in each step.
            work: _,
        } = self;
        if window.is_some() {
            return None;
        }
        out.raw(&self.words_of_level().to_le_bytes());
        steps.write(out);
        revision.write(out);
        figure_revision.write(out);
        sprites.has_player().write(out);
        let Changes { things, figures, is_lamplit } = world.changes();
        is_lamplit.write(out);
        write_all(things, out);
        write_all(figures, out);
        doors.write(out);
        mechanisms.write(out);
        spikes.write(out);
        missiles.write(out);
        smoke.write(out);
        guards.write(out);
        match members {
            Some(members) => members.write(out),
            None => player.write(out),
        }
        let cell = checkpoint.cell();
        cell.write(out);
        // Without a cell it is the start, which is known.
        let game = checkpoint.game().filter(|_| cell.is_some());
        game.is_some().write(out);
        game.map_or(Some(()), |game| game.write(out))
    }

    /// Reads a game, of which this is the start, and the game at the checkpoint of its player, if it may
    /// have one.
    fn read(mut self, input: &mut Reader, has_checkpoint: bool) -> Result<Self, Unrestorable> {
        let start = (has_checkpoint && self.members.is_none()).then(|| self.clone());
        if input.raw(8)? != self.words_of_level().to_le_bytes() {
            return Err(Unrestorable::OtherLevel);
        }
        self.steps = Stored::read(input)?;
        let revisions = (Stored::read(input)?, Stored::read(input)?);
        if Stored::read(input)? {
            self.sprites.add_player(&mut self.world);
        }
        let is_lamplit = Stored::read(input)?;
        let things: Vec<Thing> = Stored::read(input)?;
        let figures: Vec<Figure> = Stored::read(input)?;
        self.doors = Stored::read(input)?;
        self.mechanisms.read_over(input)?;
        self.spikes.read_over(input)?;
        self.missiles = Stored::read(input)?;
        self.smoke = Stored::read(input)?;
        self.guards.read_over(input)?;
        match &mut self.members {
            Some(members) => members.read_over(input)?,
            None => self.player = Stored::read(input)?,
        }
        self.check()?;
        self.show_changes(things, is_lamplit)?;
        self.world.set_figures(figures.into_iter());
        (self.revision, self.figure_revision) = revisions;
        let cell: Option<Cell> = Stored::read(input)?;
        let saved = if Stored::read(input)? {
            let start = start.ok_or(Unrestorable::Damaged("a checkpoint"))?;
            Some(Arc::new(start.read(input, false)?))
        } else {
            None
        };
        if cell.is_some() {
            self.checkpoint = Checkpoint::new(saved, cell);
        }
        Ok(self)
    }

    /// Refuses a state in which a step could fail.
    fn check(&self) -> Result<(), Unrestorable> {
        self.missiles.check()?;
        self.guards.check(&self.world)?;
        match &self.members {
            Some(members) => members.check(&self.world, self.steps),
            None => self.player.check(&self.world, self.steps),
        }
    }

    /// Shows in the world of the start what has changed in it since.
    fn show_changes(&mut self, things: Vec<Thing>, is_lamplit: bool) -> Result<(), Unrestorable> {
        self.doors.show(&mut self.world)?;
        self.mechanisms.show(&mut self.world)?;
        check(self.world.leave_things(things), "a thing")?;
        if is_lamplit {
            self.world.make_room_for_light();
        }
        self.show_lamps();
        Ok(())
    }

    /// A number that differs, almost certainly, between levels, rules and companies.
    fn words_of_level(&self) -> u64 {
        let Rules { difficulty, seed } = self.rules;
        let multiplayer = self.multiplayer_rules().map_or(0, |rules| {
            let MultiplayerRules { collides, respawns, sees, strikes } = rules;
            1 | u64::from(collides) << 1
                | u64::from(respawns) << 2
                | (sees as u64) << 8
                | (strikes as u64) << 16
        });
        let world = &self.world;
        let title = world.title().bytes().map(u64::from);
        let posts = world.guards().iter().flat_map(|it| [it.kind as u64, word_of(it.cell)]);
        let size = [world.grid().width(), world.grid().height(), world.tiles().len() as u32];
        let words = [difficulty as u64, seed, multiplayer, word_of(world.start().cell)];
        let words = words.into_iter().chain(size.map(u64::from)).chain(title).chain(posts);
        hash(0, words)
    }
}

/// Appends a list.
fn write_all(list: &[impl Stored], out: &mut Writer) {
    out.number(list.len() as u64);
    for value in list {
        value.write(out);
    }
}
