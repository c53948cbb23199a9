//! Tempers: the priorities of a player, from staying unseen to just getting out.

use cellcaster::game::{Game, Mood};

/// The tempers, tried in turn: if a level cannot be left unseen, it is left in haste.
pub(crate) const TEMPERS: [Temper; 4] = [
    Temper { point: 900, alarm: 1200, noticed: 30, chased: 90, weight: 3, most_moves: 8_000 },
    Temper { point: 300, alarm: 200, noticed: 10, chased: 20, weight: 4, most_moves: 12_000 },
    Temper { point: 100, alarm: 0, noticed: 0, chased: 2, weight: 8, most_moves: 16_000 },
    Temper { point: 300, alarm: 600, noticed: 20, chased: 150, weight: 3, most_moves: 40_000 },
];

/// The price that a player puts on each event, in steps, and the length of the search.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Temper {
    /// The loss of a point of health.
    point: u64,
    /// An alarm.
    alarm: u64,
    /// A move while a guard wonders or searches, and a move while a guard follows.
    noticed: u64,
    chased: u64,
    /// The weight of the remaining way, in halves. Above 2, the search is faster and finds longer
    /// ways.
    pub(crate) weight: u64,
    /// The number of moves after which the search gives up.
    pub(crate) most_moves: usize,
}

impl Temper {
    /// The price of everything that happened between two states of a game, in steps.
    pub(crate) fn toll(self, before: &Game, after: &Game) -> u64 {
        let lost = before.health().points.saturating_sub(after.health().points);
        let alarms = after.tally().alarms.saturating_sub(before.tally().alarms);
        let attention = after.guards().map(|guard| match guard.mood {
            Mood::Wondering | Mood::Searching => self.noticed,
            Mood::Chasing | Mood::Attacking => self.chased,
            _ => 0,
        });
        u64::from(lost) * self.point + u64::from(alarms) * self.alarm + attention.sum::<u64>()
    }
}
