//! Keys and doors: opening the door in front of the player.
//!
//! A locked door opens for a player who has its key. Otherwise a message names the key. A door with
//! a switch opens only by its switch.

use super::Game;
use super::doors::door_ahead;
use super::intent::{Intent, Intents};
use super::noise::reach;
use super::player::Notice;
use super::sound::SoundKind;
use crate::world::{Cell, Door};

impl Game {
    /// The intents, with [`Intent::Open`] in place of a jump if the player faces a door or a
    /// handle.
    pub(crate) fn at_a_door(&self, mut intents: Intents) -> Intents {
        let motion = &self.player.motion;
        let looking = motion.heading().direction();
        if intents.contains(Intent::Jump)
            && (self.handle_ahead().is_some()
                || !self.world.is_of_walls()
                    && door_ahead(&self.world, motion.position(), looking).is_some())
        {
            intents.remove(Intent::Jump);
            intents.insert(Intent::Open);
        }
        intents
    }

    /// The door in front of the player, if they want to open it or walk through it.
    pub(crate) fn door_wanted(&self, intents: Intents) -> Option<(Cell, Door)> {
        if self.world.is_of_walls() {
            return None;
        }
        let motion = &self.player.motion;
        let looking = intents.contains(Intent::Open).then(|| motion.heading().direction());
        let directions = [looking, motion.wanted_direction(intents)];
        let position = motion.position();
        directions.into_iter().flatten().find_map(|way| door_ahead(&self.world, position, way))
    }

    /// Opens the door that the player wants to open or walks into.
    pub(crate) fn open_doors(&mut self, intents: Intents) {
        if let Some((cell, door)) = self.door_wanted(intents) {
            self.try_to_open(cell, door);
        }
    }

    fn can_open(&self, door: Door) -> bool {
        door.switch.is_none() && door.key.is_none_or(|key| self.player.keys.contains(&key))
    }

    fn try_to_open(&mut self, cell: Cell, door: Door) {
        if !self.can_open(door) {
            return self.say(self.refusal(door));
        }
        if self.is_mission && self.doors.would_open(cell) {
            self.sound(SoundKind::Door, reach::DOOR);
        }
        self.doors.open(cell);
    }

    /// Whether [`Game::open_doors`] would change anything.
    pub(crate) fn would_answer(&self, cell: Cell, door: Door) -> bool {
        if self.can_open(door) {
            self.doors.would_open(cell)
        } else {
            self.player.notice.text() != Some(&self.refusal(door))
        }
    }

    /// Shows a message, unless it is already shown.
    pub(crate) fn say(&mut self, text: String) {
        if self.player.notice.text() != Some(&text) {
            self.player.notice = Notice::new(text);
            self.revision += 1;
        }
    }

    /// The message for a door that does not open.
    fn refusal(&self, door: Door) -> String {
        if door.switch.is_some() {
            return "This door is opened elsewhere.".to_owned();
        }
        let name = door.key.map_or("right", |key| self.world.key_name(key));
        format!("This door needs the {name} key.")
    }
}
