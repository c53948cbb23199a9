//! Keys and doors: opening the door in front of the player, and taking keys.
//!
//! A locked door opens for a player who has its key; otherwise a message names the key.

use super::Game;
use super::doors::door_ahead;
use super::intent::{Intent, Intents};
use super::notice::Notice;
use crate::world::{Cell, Door, ThingKind};

impl Game {
    /// The intents, with a jump in front of a door replaced by opening it.
    pub(super) fn at_a_door(&self, mut intents: Intents) -> Intents {
        let looking = self.player.heading().direction();
        if intents.contains(Intent::Jump)
            && !self.world.is_of_walls()
            && door_ahead(&self.world, self.player.position(), looking).is_some()
        {
            intents.remove(Intent::Jump);
            intents.insert(Intent::Open);
        }
        intents
    }

    /// The door in front of the player, if they want to open it or walk through it.
    pub(super) fn door_wanted(&self, intents: Intents) -> Option<(Cell, Door)> {
        if self.world.is_of_walls() {
            return None;
        }
        let looking = intents.contains(Intent::Open).then(|| self.player.heading().direction());
        let directions = [looking, self.player.wanted_direction(intents)];
        let position = self.player.position();
        directions.into_iter().flatten().find_map(|way| door_ahead(&self.world, position, way))
    }

    fn can_open(&self, door: Door) -> bool {
        door.key.is_none_or(|key| self.keys.contains(&key))
    }

    pub(super) fn try_to_open(&mut self, cell: Cell, door: Door) {
        if self.can_open(door) {
            self.doors.open(cell);
        } else {
            self.say(self.refusal(door));
        }
    }

    /// Whether [`Game::try_to_open`] would change anything.
    pub(super) fn would_answer(&self, cell: Cell, door: Door) -> bool {
        if self.can_open(door) {
            self.doors.would_open(cell)
        } else {
            self.notice.text() != Some(&self.refusal(door))
        }
    }

    fn say(&mut self, text: String) {
        if self.notice.text() != Some(&text) {
            self.notice = Notice::new(text);
            self.revision += 1;
        }
    }

    /// The message of a locked door.
    fn refusal(&self, door: Door) -> String {
        let name = door.key.map_or("right", |key| self.world.key_name(key));
        format!("This door needs the {name} key.")
    }

    /// Takes the keys that the player has reached.
    pub(super) fn take_keys(&mut self) {
        let cell = self.player.cell();
        let found = self.things_reached().find_map(|thing| match thing.kind {
            ThingKind::Key(key) => Some(key),
            _ => None,
        });
        if let Some(key) = found {
            self.keys.insert(key);
            self.world.take_things(cell, |kind| kind == ThingKind::Key(key));
            self.revision += 1;
            self.say(format!("You have the {} key.", self.world.key_name(key)));
        }
    }
}
