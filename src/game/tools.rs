//! Tools: the player strikes, throws pebbles, shoots darts and throws flasks of smoke.
//!
//! Each press of a key uses a tool once. Aiming takes no skill. A blow hits the nearest guard in
//! front, a dart the nearest visible guard near the middle of the view. Pebbles and flasks fly
//! straight ahead.

mod missiles;
mod smoke;

use super::Game;
use super::intent::{Intent, Intents};
use super::multiplayer::playing;
use super::noise::reach;
use super::sound::{Sound, SoundKind, Source};
use crate::world::{Camera, GuardKind, Supply};
pub(crate) use missiles::{LandedMissile, Missile, MissileKind, MissileTarget, Missiles};
pub(crate) use smoke::{Puff, Smoke};

/// The reach of a blow, in cells, and the cosine of its angle to either side: 60°.
const BLOW_REACH: f64 = 1.0;
const BLOW_COSINE: f64 = 0.5;
/// The cosine of the angle within which a dart aims at a guard: 15°.
const AIM_COSINE: f64 = 0.965_925_826_289_068_3;

/// The number of steps until the next blow, after a blow that misses, stuns or pushes.
const AFTER_MISS: u16 = 20;
const AFTER_STUN: u16 = 30;
const AFTER_PUSH: u16 = 90;

/// The number of steps for which a stunned guard lies on the floor.
const STUNNED: u16 = 1200;
const HOUND_STUNNED: u16 = 480;
const WARDEN_SHOT: u16 = 300;

impl Game {
    /// Uses each tool whose intent begins in this step.
    pub(crate) fn use_tools(&mut self, fresh: Intents) {
        if fresh.contains(Intent::Lamp) {
            self.turn_lamp();
        }
        let strikes = fresh.contains(Intent::Strike) && self.player.strike_wait == 0;
        if strikes && (self.is_mission || self.has_blows()) {
            self.strike();
        }
        if !self.is_mission {
            return;
        }
        for (intent, supply) in [
            (Intent::Throw, Supply::Pebbles),
            (Intent::Shoot, Supply::Darts),
            (Intent::Smoke, Supply::Flasks),
        ] {
            if fresh.contains(intent) {
                self.launch(supply);
            }
        }
    }

    /// Lights the lamp or puts it out.
    fn turn_lamp(&mut self) {
        if !self.player.has_light && self.is_in_water() {
            return self.say("Your lamp does not burn in water.".to_owned());
        }
        self.player.has_light = !self.player.has_light;
        self.revision += 1;
    }

    fn strike(&mut self) {
        self.swing();
        let motion = self.player.motion;
        let (position, direction) = (motion.position(), motion.heading().direction());
        let guard =
            self.guards.guard_near(&self.world, position, direction, BLOW_REACH, BLOW_COSINE);
        if let Some(index) = self.player_struck(BLOW_REACH, BLOW_COSINE).filter(|_| guard.is_none())
        {
            self.player.strike_wait = AFTER_PUSH;
            self.sound(SoundKind::Blow, reach::BLOW);
            return self.strike_player(index, direction);
        }
        let Some(index) = guard else {
            self.player.strike_wait = AFTER_MISS;
            self.say("Nobody is within reach.".to_owned());
            return self.sound(SoundKind::Swing, reach::SWING);
        };
        self.sound(SoundKind::Blow, reach::BLOW);
        let is_behind = self.guards.is_behind(index, position);
        let kind = self.guards.views().nth(index).map(|view| view.kind);
        let is_surprised = self.guards.is_unaware(index) && kind != Some(GuardKind::Warden);
        if is_behind || is_surprised {
            self.player.strike_wait = AFTER_STUN;
            let is_hound = kind == Some(GuardKind::Hound);
            self.guards.stun(index, if is_hound { HOUND_STUNNED } else { STUNNED });
            self.count_stunned(kind);
        } else {
            self.player.strike_wait = AFTER_PUSH;
            self.guards.push(index, direction);
            self.say(match kind {
                Some(GuardKind::Warden) => "Only a blow from behind stuns a warden.".to_owned(),
                _ => "They stagger back.".to_owned(),
            });
        }
    }

    /// Counts a guard that the player has stunned.
    fn count_stunned(&mut self, kind: Option<GuardKind>) {
        self.player.counts.stunned += 1;
        if let Some(kind) = kind {
            self.say(format!("The {} goes down.", title(kind)));
        }
    }

    /// Throws or shoots one of `supply`.
    fn launch(&mut self, supply: Supply) {
        if !self.player.supplies.take(supply) {
            return self.say(format!("No {} left.", supply.name()));
        }
        self.revision += 1;
        let motion = self.player.motion;
        let eye = (motion.position(), motion.feet() + Camera::STANDING.min(motion.height() - 0.05));
        let (ahead, by) = (motion.heading().direction(), self.turn());
        self.missiles.launch(match supply {
            Supply::Pebbles => Missile::pebble(eye, ahead),
            Supply::Flasks => Missile::flask(eye, ahead),
            Supply::Darts => {
                let clouds = &self.smoke.clouds;
                let aim = self.guards.aim(&self.world, clouds, eye, ahead, AIM_COSINE);
                Missile::dart(eye, ahead, aim, by)
            }
        });
    }

    /// Moves the missiles and applies the effects of missiles that have ended.
    pub(crate) fn move_missiles(&mut self) {
        if self.missiles.is_empty() {
            return;
        }
        for landed in self.step_missiles() {
            self.land(landed);
        }
    }

    fn step_missiles(&mut self) -> Vec<LandedMissile> {
        let Self { player, members, missiles, world, guards, .. } = self;
        let bodies = playing(player, members.as_deref()).map(|(index, it)| (index, it.motion));
        missiles.step(world, guards, &bodies)
    }

    fn land(&mut self, landed: LandedMissile) {
        let LandedMissile { missile, cell, struck } = landed;
        let sound = |kind, reach| Sound { kind, cell, reach, by: Source::Object };
        match (missile.kind, struck) {
            (MissileKind::Dart { by }, MissileTarget::Guard(index)) => {
                let kind = self.guards.views().nth(index).map(|view| view.kind);
                let is_warden = kind == Some(GuardKind::Warden);
                self.sounds.push(sound(SoundKind::Blow, reach::BLOW));
                self.guards.stun(index, if is_warden { WARDEN_SHOT } else { STUNNED });
                self.in_turn(by, |game| game.count_stunned(kind));
            }
            (MissileKind::Bolt { points, from, by }, MissileTarget::Player(index)) => {
                self.in_turn(index, |game| game.hurt_by_bolt(by, from, points));
            }
            (MissileKind::Flask, _) => {
                self.sounds.push(sound(SoundKind::Crash, reach::CRASH));
                self.smoke.add(missile.position, missile.height);
            }
            (MissileKind::Pebble, _) => self.sounds.push(sound(SoundKind::Knock, reach::KNOCK)),
            (MissileKind::Dart { .. } | MissileKind::Bolt { .. }, _) => {
                self.sounds.push(sound(SoundKind::Knock, reach::TAP));
            }
        }
    }
}

/// The kind of guard as it appears in a sentence.
fn title(kind: GuardKind) -> &'static str {
    if kind == GuardKind::Lantern { "lantern-bearer" } else { kind.name() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dart_aims_within_15_degrees() {
        assert!((AIM_COSINE - libm::cos(15_f64.to_radians())).abs() < 1e-15);
    }
}
