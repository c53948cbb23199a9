//! Players with arbitrary intents, and a player who follows a script.

use cellcaster::game::{Game, Input, Intent, Intents, Look, PlayerColor, PlayerId};
use cellcaster::rng::SplitMix64;

/// The intents of players in the coming steps.
pub(crate) struct Crowd {
    script: std::vec::IntoIter<Intents>,
    most: usize,
    random: SplitMix64,
    /// The intents of each slot, and the number of steps for which they last.
    wants: [(Intents, usize); 16],
}

impl Crowd {
    /// At most `most` players. The player in the first slot follows `script` to its end.
    pub(crate) fn new(script: Vec<Intents>, most: usize, random: SplitMix64) -> Self {
        Self { script: script.into_iter(), most, random, wants: [(Intents::new(), 0); 16] }
    }

    /// Applies the same inputs to all `games`, which must be equal.
    pub(crate) fn step(&mut self, games: &mut [&mut Game]) {
        let present: Vec<PlayerId> = games[0].players().collect();
        let joins = present.is_empty() || self.random.one_in(120);
        if joins && present.len() < self.most {
            let color = PlayerColor::ALL[self.random.below(8)];
            let joined: Vec<_> = games.iter_mut().map(|game| game.join(color)).collect();
            assert!(joined.iter().all(|id| *id == joined[0]));
        } else if present.len() > 1 && self.random.one_in(600) {
            let gone = present[1 + self.random.below(present.len() - 1)];
            for game in games.iter_mut() {
                game.leave(gone);
            }
        }
        let now = games[0].steps();
        let inputs: Vec<Input> = games[0]
            .players()
            .map(|player| {
                let intents = self.want(player.index());
                let ago = self.random.below(20) as u64;
                let seen = if ago == 0 { u64::MAX } else { now.saturating_sub(ago) };
                Input { player, intents, seen }
            })
            .collect();
        for game in games {
            game.step_all(&inputs);
        }
    }

    /// The same in single-player games.
    pub(crate) fn step_alone(&mut self, games: &mut [&mut Game]) {
        let intents = self.want(0);
        for game in games {
            game.step(intents);
        }
    }

    /// The intents of the player in a slot for the next step.
    pub(crate) fn want(&mut self, slot: usize) -> Intents {
        if let Some(intents) = self.script.next().filter(|_| slot == 0) {
            return intents;
        }
        let (wanted, left) = &mut self.wants[slot];
        if *left > 0 {
            *left -= 1;
            return *wanted;
        }
        let random = &mut self.random;
        let mut intents = Intents::new();
        let often = [Intent::Forward, Intent::Run, Intent::Open, Intent::Retry];
        for intent in often.into_iter().filter(|_| !random.one_in(3)) {
            intents.insert(intent);
        }
        (0..random.below(4)).for_each(|_| intents.insert(Intent::ALL[random.below(23)]));
        if random.one_in(4) {
            let look = Look { turn: random.whole(-300, 300) as i16, tilt: 40 };
            intents = intents.with_look(look);
        }
        self.wants[slot] = (intents, random.below(60));
        intents
    }
}
