//! Encounters: a step of the guards, and what they do to the rest of the game.

use super::Game;
use super::guards::Act;
use super::multiplayer::playing_mut;
use super::tools::Missile;

impl Game {
    pub(crate) fn move_guards(&mut self) {
        if self.guards.is_empty() {
            return;
        }
        let alarm = self.guards.alarm();
        self.find_targets();
        let home = [self.target()];
        let Self { world, guards, sounds, smoke, members, .. } = self;
        let targets = members.as_deref().map_or(&home[..], |members| &members.targets);
        let count = guards.step(world, targets, sounds, smoke.clouds()).len();
        for index in 0..count {
            if let Some(act) = self.guards.act(index) {
                self.answer(act);
            }
        }
        self.revision += u64::from(self.guards.alarm() != alarm);
    }

    fn count_alarm(&mut self) {
        let Self { player, members, .. } = self;
        for (_, player) in playing_mut(player, members.as_deref_mut()) {
            player.counts.alarms += 1;
        }
    }

    /// Does to the rest of the game what a guard does.
    fn answer(&mut self, act: Act) {
        match act {
            Act::Hurt { target, by, from, points } => {
                self.in_turn(target, |game| game.hurt_by_guard(by, from, points));
            }
            Act::Open(cell) => self.doors.open(cell),
            Act::Sound(sound) => self.sounds.push(sound),
            Act::Bolt { by, from, height, direction, slope, points } => {
                let bolt = Missile::bolt((from, height), direction, slope, (by, points));
                self.missiles.launch(bolt);
            }
            Act::Raised => self.count_alarm(),
        }
    }
}
