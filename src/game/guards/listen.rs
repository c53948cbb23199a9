//! Hearing: what guards make of sounds.
//!
//! A sound alone makes guards wonder and go there. Only listeners, who do not see, follow players
//! by ear.

use glam::DVec2;

use super::context::Context;
use super::guard::{ALARMED, Guard, WONDERS};
use super::state::{Quarry, State};
use crate::game::sound::{Sound, SoundKind, Source, half_cells};
use crate::world::{Difficulty, GuardKind};

/// The most that sounds alone add up to for those who see.
const MOST_BY_EAR: u16 = 700;

impl Guard {
    /// How far this guard hears `sound`, in half cells; 0 if they do not care.
    pub(crate) fn earshot(&self, sound: &Sound, difficulty: Difficulty) -> u16 {
        let reach = half_cells(sound.reach.min(Sound::FARTHEST));
        let is_listener = self.kind == GuardKind::Listener;
        if self.state.is_down() || !is_startling(sound) && !is_call(sound) {
            return 0;
        }
        if difficulty == Difficulty::Easy && (is_call(sound) || sound.kind == SoundKind::Walking) {
            return 0;
        }
        let reach = match sound.kind {
            SoundKind::Walking if !is_listener => 0,
            SoundKind::Walking => reach.min(half_cells(3)),
            _ => (reach * self.abilities().hearing / 2).min(half_cells(Sound::FARTHEST)),
        };
        if self.state == State::Asleep { reach / 2 } else { reach }
    }

    /// Hears `sound` at this distance of the `earshot`. `told` is what the guard knows who calls.
    pub(crate) fn hear(
        &mut self,
        context: &mut Context,
        sound: &Sound,
        (distance, earshot): (u16, u16),
        told: Option<Quarry>,
    ) {
        let place = sound.cell.center();
        if is_call(sound) {
            if !self.state.is_alarmed() {
                self.quarry = self.quarry.or(told);
                self.come(told.map_or(place, |quarry| quarry.position));
            }
            return;
        }
        let nearness = 256 - 192 * u32::from(distance) / u32::from(earshot.max(1));
        let gain = (startle(sound.kind) * nearness / 256) as u16;
        if self.kind == GuardKind::Listener {
            self.listen(context, sound, gain * 2, place);
            return;
        }
        if self.state.is_alarmed() {
            self.turn_to_sound(sound, place);
            return;
        }
        self.awareness = (self.awareness + gain).min(MOST_BY_EAR.max(self.awareness));
        if self.awareness >= WONDERS || self.state == State::Asleep {
            self.wonder_about(context, place);
        }
    }

    /// A guard who has lost a player goes where they hear them.
    fn turn_to_sound(&mut self, sound: &Sound, place: DVec2) {
        if let (Some(quarry), Source::Player(target)) = (&mut self.quarry, sound.by)
            && quarry.target == target
            && quarry.unseen > 0
        {
            quarry.position = place;
        }
    }

    fn listen(&mut self, context: &mut Context, sound: &Sound, gain: u16, place: DVec2) {
        self.awareness = (self.awareness + gain).min(ALARMED);
        match sound.by {
            Source::Player(target) => {
                self.quarry = Some(Quarry { target, position: place, unseen: 0 });
                if self.awareness >= ALARMED && !self.state.is_alarmed() {
                    self.raise_alarm(context);
                } else if !self.state.is_alarmed() {
                    self.wonder_about(context, place);
                }
            }
            Source::Guard(_) | Source::Object if self.state.is_alarmed() => {
                // A blind guard takes every loud noise for the player.
                if let Some(quarry) = &mut self.quarry {
                    (quarry.position, quarry.unseen) = (place, 0);
                }
            }
            Source::Guard(_) | Source::Object => self.wonder_about(context, place),
        }
    }

    fn wonder_about(&mut self, context: &mut Context, place: DVec2) {
        match &mut self.state {
            State::Wondering { about, goes, .. } => (*about, *goes) = (place, true),
            State::Searching { around, next, .. } => {
                let cell = crate::world::Cell::at(place);
                (*around, *next) = (cell, Some(cell));
            }
            _ => self.begin_to_wonder(context, place, true),
        }
    }

    /// Runs where another guard has seen a player.
    fn come(&mut self, about: DVec2) {
        let looks = if self.state == State::Asleep { 60 } else { 20 };
        self.awareness = self.awareness.max(WONDERS);
        self.state = State::Wondering { about, looks, goes: true, hurries: true, wakes: None };
    }
}

/// Whether guards go where a sound is made that they do not understand.
fn is_startling(sound: &Sound) -> bool {
    match sound.by {
        Source::Guard(_) => sound.kind == SoundKind::Fall,
        Source::Player(_) | Source::Object => startle(sound.kind) > 0,
    }
}

/// Whether `sound` calls guards.
fn is_call(sound: &Sound) -> bool {
    matches!(sound.by, Source::Guard(_))
        && matches!(sound.kind, SoundKind::Shout | SoundKind::Bell | SoundKind::Bark)
}

/// What a sound from nearby adds to awareness.
fn startle(kind: SoundKind) -> u32 {
    match kind {
        SoundKind::Walking => 200,
        SoundKind::Mechanism => 240,
        SoundKind::Running | SoundKind::Door => 280,
        SoundKind::Splash | SoundKind::Cry | SoundKind::Blow => 340,
        SoundKind::Landing => 380,
        // They make every guard wonder who hears them.
        SoundKind::Knock | SoundKind::Crash | SoundKind::Fall => 1200,
        // Guards are used to spikes.
        SoundKind::Spikes
        | SoundKind::Wonder
        | SoundKind::GiveUp
        | SoundKind::Shout
        | SoundKind::Bell
        | SoundKind::Bark
        | SoundKind::Windup
        | SoundKind::Draw
        | SoundKind::Shot
        | SoundKind::Swing => 0,
    }
}
