//! Players of a game for several as bytes.

use super::members::{Member, Members};
use super::{MOST_PLAYERS, PlayerId};
use crate::game::stored::{Reader, Stored, StoredPart, Unrestorable, Writer, check};
use crate::world::World;

impl StoredPart for Members {
    fn write(&self, out: &mut Writer) {
        let Self {
            rules: _,
            slots,
            // Between steps, it is nobody's turn.
            turn: _,
            treasure_of_the_gone,
            keys: _,
            sprites: _,
            blows,
            // Filled in each step.
            targets: _,
            in_the_way: _,
            figures,
        } = self;
        slots.write(out);
        treasure_of_the_gone.write(out);
        blows.write(out);
        figures.write(out);
    }

    fn read_over(&mut self, input: &mut Reader) -> Result<(), Unrestorable> {
        self.slots = input.list(MOST_PLAYERS)?;
        self.treasure_of_the_gone = Stored::read(input)?;
        self.blows = Stored::read(input)?;
        self.figures = input.list(MOST_PLAYERS)?;
        check(self.slots.last().is_none_or(Option::is_some), "a player")
    }
}

impl Members {
    /// Refuses a state in which a step after the step `now` could fail.
    pub fn check(&self, world: &World, now: u64) -> Result<(), Unrestorable> {
        self.each().try_for_each(|(_, member)| {
            let Member { player, walked, .. } = member;
            check(*walked >= 0.0, "how far a player has walked")?;
            player.check(world, now)
        })
    }
}

impl Stored for PlayerId {
    fn write(&self, out: &mut Writer) {
        self.index().write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        Self::new(Stored::read(input)?).ok_or(Unrestorable::Damaged("a player"))
    }
}
