//! Pickups: treasure, healing, supplies and keys, which the player takes by reaching them. Notes
//! can be read but stay where they are.

use super::Game;
use super::guards::Alarm;
use super::health::Flash;
use super::player::{Player, Supplies};
use crate::world::{Cell, Difficulty, Supply, ThingKind};

/// The minimum value of a cup and of a crown.
const CUP: u16 = 25;
const CROWN: u16 = 100;

impl Game {
    /// The text of the note that the player has reached.
    pub fn note(&self) -> Option<&str> {
        self.note_reached_by(&self.player)
    }

    pub(crate) fn note_reached_by(&self, player: &Player) -> Option<&str> {
        self.things_reached_by(player).find_map(|thing| match thing.kind {
            ThingKind::Note(id) => Some(self.world.note(id)),
            _ => None,
        })
    }

    /// The kind of thing that the player has reached and would take.
    pub(crate) fn find(&self) -> Option<ThingKind> {
        if self.world.things().is_empty() {
            return None;
        }
        self.things_reached().map(|thing| thing.kind).find(|&kind| match kind {
            ThingKind::Key(_) | ThingKind::Treasure(_) => true,
            ThingKind::Healing(_) => self.player.health.is_hurt(),
            ThingKind::Supply(supply, _) => self.player.supplies.count(supply) < Supplies::MAX,
            _ => false,
        })
    }

    /// Takes one thing that the player has reached. At most one thing is taken in each step.
    pub(crate) fn take_finds(&mut self) {
        let Some(kind) = self.find() else { return };
        match kind {
            ThingKind::Key(key) => {
                self.player.keys.insert(key);
                self.say(format!("You have the {} key.", self.world.key_name(key)));
            }
            ThingKind::Treasure(worth) => {
                self.player.treasure = self.player.treasure.saturating_add(worth.into());
                self.say(format!("{}: {worth}.", name_of_treasure(worth)));
            }
            ThingKind::Healing(points) => {
                let before = self.player.health.points;
                self.player.health = self.player.health.healed(points);
                let more = self.player.health.points - before;
                self.say(format!("You feel better: {more} more health."));
            }
            ThingKind::Supply(supply, count) => {
                self.player.supplies.add(supply, count);
                self.say(format!("{}.", count_of(supply, count)));
            }
            _ => return,
        }
        self.revision += 1;
        if self.is_mission {
            self.player.flash = Some(Flash::gain());
        }
        self.world.take_things(self.player.motion.cell(), |it| it == kind);
    }

    /// Tells a player who has come from `before` why they cannot take something or leave.
    pub(crate) fn refuse(&mut self, before: Cell) {
        if self.player.motion.cell() == before || !self.is_mission {
            return;
        }
        let refusal = self.things_reached().find_map(|thing| match thing.kind {
            ThingKind::Exit => {
                let missing = self.treasure_missing();
                if missing > 0 {
                    Some(format!("The exit is closed: {missing} gold missing."))
                } else {
                    let text = "The exit is closed while the alarm is raised.";
                    self.alarm_closes_exits().then(|| text.to_owned())
                }
            }
            ThingKind::Supply(supply, _) if self.player.supplies.count(supply) == Supplies::MAX => {
                Some(format!("You cannot carry more {}.", supply.name()))
            }
            _ => None,
        });
        if let Some(text) = refusal {
            self.say(text);
        }
    }

    /// The value of the treasure that is missing before the exit opens.
    pub(crate) fn treasure_missing(&self) -> u32 {
        self.world.treasure_needed().saturating_sub(self.treasure_found())
    }

    /// Whether the exits are closed because guards follow a player. Only on the hardest difficulty.
    pub(crate) fn alarm_closes_exits(&self) -> bool {
        self.rules.difficulty == Difficulty::Hard && self.guards.alarm() == Alarm::Raised
    }
}

fn name_of_treasure(worth: u16) -> &'static str {
    match worth {
        CROWN.. => "A golden crown",
        CUP.. => "A golden cup",
        _ => "Coins",
    }
}

fn count_of(supply: Supply, count: u8) -> String {
    match (count, supply) {
        (1, Supply::Pebbles) => "A pebble".to_owned(),
        (1, Supply::Darts) => "A dart".to_owned(),
        (1, Supply::Flasks) => "A flask of smoke".to_owned(),
        (_, Supply::Flasks) => format!("{count} flasks of smoke"),
        _ => format!("{count} {}", supply.name()),
    }
}
