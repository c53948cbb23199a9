//! Treasure and keys of several players.

use crate::game::Game;
use crate::world::{Thing, ThingKind};

impl Game {
    /// The worth of the treasure that has been found, by all players together.
    pub(crate) fn treasure_found(&self) -> u32 {
        let Some(members) = self.members.as_deref() else { return self.player.treasure };
        let found = members.each().map(|(index, member)| {
            let player = if members.turn == Some(index) { &self.player } else { &member.player };
            player.treasure
        });
        found.fold(members.treasure_of_the_gone, u32::saturating_add)
    }

    /// Puts the keys of a player back where they were found.
    pub(crate) fn put_keys_back(&mut self, index: usize) {
        let Self { members, world, .. } = self;
        let Some(members) = members.as_deref_mut() else { return };
        let Some(member) = members.member_mut(index) else { return };
        let keys = std::mem::take(&mut member.player.keys);
        if keys.is_empty() {
            return;
        }
        let is_lost = |thing: &&Thing| match thing.kind {
            ThingKind::Key(key) => keys.contains(&key),
            _ => false,
        };
        for &thing in members.keys.iter().filter(is_lost) {
            let lies_there = world.things_in(thing.cell).iter().any(|it| it.kind == thing.kind);
            if !lies_there {
                world.put_thing(thing);
            }
        }
        self.revision += 1;
    }
}
