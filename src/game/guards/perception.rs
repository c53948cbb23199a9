//! The perception of guards: sight, smell, touch and hearing.
//!
//! Awareness is a whole number. Each look at a player increases it, depending on the light on the
//! player, their distance, and how far they are from the middle of the cone. No look adds so much
//! that a guard follows a player within half a second of noticing them, except at [`FACE_TO_FACE`].
//!
//! A sound alone makes guards wonder and go there. Only listeners, who are blind, follow players by
//! ear.

use glam::DVec2;

use super::context::{Context, PerceivedPlayer};
use super::guard::{ALARMED, GUESS_STEPS, Guard, GuardActivity, KnownPlayer, WONDERING};
use crate::game::sound::{Sound, SoundKind, Source, half_cells};
use crate::world::{Cell, Difficulty, GuardKind};

/// A guard looks around in every fourth step.
const LOOK_EACH: u64 = 4;
/// The maximum that one look adds to awareness.
const MAX_GAIN: u32 = 80;
/// The awareness that a guard loses with a look that finds nobody.
const LOSS: u16 = 8;
/// At this distance in front of a guard, a player is noticed at once, in cells.
const FACE_TO_FACE: f64 = 1.2;
/// At this distance, a guard feels a player, in cells.
const TOUCH: f64 = 0.55;
/// The light, out of 255, from which guards see as far as in full light.
const BRIGHT: u32 = 160;
/// The range of guards' sight in darkness, in sixteenths of a cell.
const IN_DARKNESS: u32 = 24;
/// The distance at which a lantern-bearer's lamp lights players, in cells.
const LANTERN: f64 = 4.0;
/// The distance at which a hound smells a trail, in cells.
pub(crate) const NOSE: f64 = 1.5;

impl Guard {
    /// Perceives players by sight, touch and smell.
    pub(crate) fn perceive(&mut self, context: &mut Context) {
        if let Some(quarry) = &mut self.quarry {
            quarry.unseen = quarry.unseen.saturating_add(context.stride);
        }
        let looks = (context.now + context.index as u64).is_multiple_of(LOOK_EACH);
        if looks {
            self.look_around(context);
        }
        self.extrapolate_position(context);
    }

    fn look_around(&mut self, context: &mut Context) {
        let mut most = 0;
        for index in 0..context.targets.len() {
            let Some(&target) = context.target(index) else { continue };
            let gain = self.gain(context, &target);
            if gain == 0 {
                continue;
            }
            let is_quarry = self.quarry.is_some_and(|quarry| quarry.target == index);
            if gain > most || is_quarry && self.state.is_alarmed() {
                self.quarry =
                    Some(KnownPlayer { target: index, position: target.position, unseen: 0 });
            }
            most = most.max(gain);
        }
        if most > 0 {
            let most = if self.is_wary && most < ALARMED { most + most / 2 } else { most };
            let most = if most < ALARMED { most.min(MAX_GAIN as u16) } else { most };
            self.awareness = (self.awareness + most).min(ALARMED);
            self.react(context);
        } else {
            self.awareness = self.awareness.saturating_sub(LOSS);
            self.smell(context);
        }
    }

    /// The increase of awareness from a look at `target`; [`ALARMED`] if the guard notices it at
    /// once.
    fn gain(&self, context: &Context, target: &PerceivedPlayer) -> u16 {
        let way = target.position - self.motion.position();
        let distance = way.length();
        let overlaps = target.feet < self.head() && self.motion.feet < target.head;
        if distance < TOUCH && overlaps {
            return if self.abilities().sight.is_none() { ALARMED } else { WONDERING / 2 };
        }
        let Some(sight) = self.abilities().sight.filter(|_| self.blind == 0) else { return 0 };
        let along = self.motion.facing.dot(way);
        let range = if self.state.is_alarmed() { sight.range * 1.25 } else { sight.range };
        let least = if self.state.is_alarmed() { -0.2 } else { sight.least_cosine };
        if distance > range || along < least * distance {
            return 0;
        }
        let light = self.light_on(context, target, distance);
        let sixteenths = (distance * 16.0) as u32;
        let lit = (range * 16.0) as u32 * light.min(BRIGHT) / BRIGHT;
        let lit = lit.max(IN_DARKNESS);
        if sixteenths > lit {
            return 0;
        }
        let parts = self.visible_parts(context, target);
        if parts == 0 {
            return 0;
        }
        if distance <= FACE_TO_FACE && along > 0.0 {
            return ALARMED;
        }
        let near = 256 - 208 * sixteenths / lit;
        let center = if along >= 0.866 * distance { 256 } else { 144 };
        let bright = 96 + light * 160 / 255;
        let gain = MAX_GAIN * near / 256 * center / 256 * bright / 256 * parts / 3;
        gain.clamp(3, MAX_GAIN) as u16
    }

    /// The light on a player as this guard sees it, at most 255.
    fn light_on(&self, context: &Context, target: &PerceivedPlayer, distance: f64) -> u32 {
        let is_lit_by_guard = self.kind == GuardKind::Lantern && distance <= LANTERN;
        if target.has_light || is_lit_by_guard {
            return 255;
        }
        let clearness = context.world.fog().map_or(1.0, |fog| fog.clearness(distance));
        (f64::from(target.visibility) * clearness) as u32
    }

    /// The number of parts of a player that this guard sees, of three: the head counts as one, the
    /// body as two.
    fn visible_parts(&self, context: &Context, target: &PerceivedPlayer) -> u32 {
        let sees = |height| u32::from(self.sees(context, target.position, height));
        2 * sees(target.middle()) + sees(target.head - 0.05)
    }

    /// Begins to wonder or raises the alarm, depending on awareness.
    fn react(&mut self, context: &mut Context) {
        let Some(quarry) = self.quarry else { return };
        match self.state {
            GuardActivity::Asleep
            | GuardActivity::Down { .. }
            | GuardActivity::Attacking { .. }
            | GuardActivity::Chasing { .. } => {}
            _ if self.awareness >= ALARMED => self.raise_alarm(context),
            GuardActivity::Wondering { hurries, wakes, looks, goes, .. } => {
                self.state = GuardActivity::Wondering {
                    about: quarry.position,
                    hurries,
                    wakes,
                    looks,
                    goes,
                };
            }
            _ if self.awareness >= WONDERING => {
                self.begin_to_wonder(context, quarry.position, false);
            }
            _ => {}
        }
    }

    /// Follows a player who was in sight a moment ago around the corner.
    fn extrapolate_position(&mut self, context: &Context) {
        let Some(quarry) = &mut self.quarry else { return };
        if self.state.is_alarmed()
            && quarry.unseen <= GUESS_STEPS
            && self.kind != GuardKind::Listener
            && let Some(target) = context.target(quarry.target)
        {
            quarry.position = target.position;
        }
    }

    /// Makes an idle hound smell the trails of players.
    fn smell(&mut self, context: &mut Context) {
        let is_busy =
            matches!(self.state, GuardActivity::Tracking { .. }) || self.state.is_alarmed();
        if self.kind != GuardKind::Hound || is_busy || self.blind > 0 {
            return;
        }
        for (target, trail) in context.trails.iter().enumerate() {
            let position = self.motion.position();
            let ground = context.ground(self.gait());
            let smells = |place: DVec2| {
                place.distance(position) <= NOSE && ground.is_straight(position, place)
            };
            if let Some(mark) = trail.newest(|cell| smells(cell.center())) {
                self.state = GuardActivity::Tracking { target, mark, lost: 0 };
                context.sound(SoundKind::Wonder, self.motion.cell(), 7);
                return;
            }
        }
    }
}

/// The maximum awareness that a guard who sees can reach by sounds alone.
const MAX_BY_EAR: u16 = 700;

impl Guard {
    /// The distance at which this guard hears `sound`, in half cells; 0 if they ignore it.
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
        if self.state == GuardActivity::Asleep { reach / 2 } else { reach }
    }

    /// Hears `sound` at `distance`, of at most `earshot`, in half cells. `told` is the quarry of
    /// the guard who calls.
    pub(crate) fn hear(
        &mut self,
        context: &mut Context,
        sound: &Sound,
        (distance, earshot): (u16, u16),
        told: Option<KnownPlayer>,
    ) {
        let place = sound.cell.center();
        if is_call(sound) {
            if !self.state.is_alarmed() {
                self.quarry = self.quarry.or(told);
                self.answer_call(told.map_or(place, |quarry| quarry.position));
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
        self.awareness = (self.awareness + gain).min(MAX_BY_EAR.max(self.awareness));
        if self.awareness >= WONDERING || self.state == GuardActivity::Asleep {
            self.wonder_about(context, place);
        }
    }

    /// Makes a guard who has lost a player go to where they hear that player.
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
                self.quarry = Some(KnownPlayer { target, position: place, unseen: 0 });
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
            GuardActivity::Wondering { about, goes, .. } => (*about, *goes) = (place, true),
            GuardActivity::Searching { around, next, .. } => {
                let cell = Cell::at(place);
                (*around, *next) = (cell, Some(cell));
            }
            _ => self.begin_to_wonder(context, place, true),
        }
    }

    /// Answers the call of a guard who has seen a player.
    fn answer_call(&mut self, about: DVec2) {
        let looks = if self.state == GuardActivity::Asleep { 60 } else { 20 };
        self.awareness = self.awareness.max(WONDERING);
        self.state =
            GuardActivity::Wondering { about, looks, goes: true, hurries: true, wakes: None };
    }
}

/// Whether a sound makes guards go to its source to investigate.
fn is_startling(sound: &Sound) -> bool {
    match sound.by {
        Source::Guard(_) => sound.kind == SoundKind::Fall,
        Source::Player(_) | Source::Object => startle(sound.kind) > 0,
    }
}

/// Whether `sound` is a guard's call to other guards.
fn is_call(sound: &Sound) -> bool {
    matches!(sound.by, Source::Guard(_))
        && matches!(sound.kind, SoundKind::Shout | SoundKind::Bell | SoundKind::Bark)
}

/// The increase of awareness from a sound nearby.
fn startle(kind: SoundKind) -> u32 {
    match kind {
        SoundKind::Walking => 200,
        SoundKind::Mechanism => 240,
        SoundKind::Running | SoundKind::Door => 280,
        SoundKind::Splash | SoundKind::Cry | SoundKind::Blow => 340,
        SoundKind::Landing => 380,
        // These make every guard who hears them wonder.
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
