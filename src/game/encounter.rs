//! Encounters: a step of the guards, and what they do to the rest of the game.

use super::Game;
use super::guards::Act;
use super::tools::Missile;

impl Game {
    pub(super) fn move_guards(&mut self) {
        if self.guards.is_empty() {
            return;
        }
        let (alarm, target) = (self.guards.alarm(), self.target());
        let clouds = self.smoke.clouds();
        let count = self.guards.step(&self.world, &[target], &self.sounds, clouds).len();
        for index in 0..count {
            if let Some(act) = self.guards.act(index) {
                self.answer(act);
            }
        }
        self.revision += u64::from(self.guards.alarm() != alarm);
    }

    /// Does to the rest of the game what a guard does.
    fn answer(&mut self, act: Act) {
        match act {
            Act::Hurt { by, from, points, .. } => {
                let guard = self.guards.views().nth(by);
                self.hurt_by_guard(guard, from, points);
            }
            Act::Open(cell) => self.doors.open(cell),
            Act::Sound(sound) => self.sounds.push(sound),
            Act::Bolt { from, height, direction, slope, points, .. } => {
                self.missiles.launch(Missile::bolt((from, height), direction, slope, points));
            }
            Act::Raised => self.counts.alarms += 1,
        }
    }
}
