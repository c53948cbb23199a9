//! The visible state of a game in its world: guards, missiles and smoke as figures, and lamps that
//! move.

use super::Game;
use super::guards::PerceivedPlayer;
use super::multiplayer::playing;
use super::player::Player;
use super::tools::{Missile, MissileKind, Puff};
use crate::world::sprite::builtin;
use crate::world::{Figure, Heading, Lamp, Light, Reach, SpriteId, World};

/// The sprites of missiles and smoke; each is `None` in a level in which nothing can fly.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(crate) struct Sprites {
    pebble: Option<SpriteId>,
    dart: Option<SpriteId>,
    flask: Option<SpriteId>,
    bolt: Option<SpriteId>,
    smoke: Option<SpriteId>,
    /// Added to the world when it is first shown.
    player: Option<SpriteId>,
}

impl Sprites {
    /// Adds the sprites to `world`.
    pub(crate) fn added_to(world: &mut World) -> Self {
        let mut add = |name| builtin::named(name).map(|sprite| world.add_sprite(sprite));
        Self {
            pebble: add("pebble"),
            dart: add("dart"),
            flask: add("flask"),
            bolt: add("bolt"),
            smoke: add("smoke"),
            player: None,
        }
    }

    /// Whether the sprite for a guest exists.
    pub(crate) fn has_player(self) -> bool {
        self.player.is_some()
    }

    /// Adds the sprite for a guest to `world`, unless it exists already.
    pub(crate) fn add_player(&mut self, world: &mut World) {
        if self.player.is_none() {
            self.player = builtin::named("player").map(|sprite| world.add_sprite(sprite));
        }
    }

    fn missile(&self, missile: &Missile) -> Option<Figure> {
        let sprite = match missile.kind {
            MissileKind::Pebble => self.pebble,
            MissileKind::Dart { .. } => self.dart,
            MissileKind::Flask => self.flask,
            MissileKind::Bolt { .. } => self.bolt,
        };
        let velocity = missile.velocity;
        let degrees = libm::atan2(velocity.y, velocity.x).to_degrees();
        Some(Figure {
            sprite: sprite?,
            position: missile.position,
            base: missile.height,
            heading: Heading::from_degrees(degrees).unwrap_or_default(),
            frame: 0,
            opacity: u8::MAX,
        })
    }

    fn puff(&self, puff: Puff) -> Option<Figure> {
        Some(Figure {
            sprite: self.smoke?,
            position: puff.position,
            base: puff.height,
            heading: Heading::default(),
            frame: puff.frame,
            opacity: puff.opacity,
        })
    }
}

impl Game {
    /// The game, with its figures and lamps shown.
    #[must_use]
    pub(crate) fn shown(mut self) -> Self {
        self.show();
        self
    }

    /// Updates the figures and lamps.
    pub(crate) fn show(&mut self) {
        self.show_lamps();
        if self.is_mission || self.members.is_some() {
            self.show_figures();
        }
    }

    /// Shows the figure of a guest, who is not in the game, or no guest, until the next step. The
    /// figure has the sprite `player`, which no other figure uses.
    #[cfg(feature = "terminal")]
    pub(crate) fn show_guest(&mut self, guest: impl FnOnce(SpriteId) -> Option<Figure>) {
        self.sprites.add_player(&mut self.world);
        let Some(sprite) = self.sprites.player else { return };
        let own = self.world.figures().iter().filter(|figure| figure.sprite != sprite);
        let all: Vec<Figure> = own.copied().chain(guest(sprite)).collect();
        self.world.set_figures(all.into_iter());
    }

    /// Whether a guest was shown.
    #[cfg(feature = "terminal")]
    pub(crate) fn has_guest(&self) -> bool {
        self.sprites.player.is_some()
    }

    /// The figures of the game itself, without the guest's.
    #[cfg(feature = "terminal")]
    pub(crate) fn figures(&self) -> impl Iterator<Item = &Figure> {
        let is_guest = |figure: &&Figure| Some(figure.sprite) == self.sprites.player;
        self.world.figures().iter().filter(move |figure| !is_guest(figure))
    }

    /// The state of the player that guards can perceive.
    pub(crate) fn target(&self) -> PerceivedPlayer {
        self.target_at(&self.player)
    }

    pub(crate) fn target_at(&self, player: &Player) -> PerceivedPlayer {
        let motion = &player.motion;
        let light = self.world.light_in(motion.cell()).in_256ths();
        let posed = if motion.is_ducking() { light / 2 } else { light };
        let visibility = if motion.is_still() { posed * 4 / 5 } else { posed };
        PerceivedPlayer {
            position: motion.position(),
            feet: motion.feet(),
            head: motion.head(),
            visibility: visibility.min(u8::MAX.into()) as u8,
            has_light: player.has_light,
            is_noticeable: !player.health.is_gone() && player.has_acted,
        }
    }

    fn show_figures(&mut self) {
        let Self { guards, missiles, smoke, sprites, members, world, .. } = self;
        let have_moved = members.as_deref_mut().is_some_and(|members| members.pose(world));
        let players = members.as_deref().map_or(&[][..], |members| members.figures());
        let is_still =
            !guards.has_changed() && !have_moved && missiles.is_empty() && smoke.is_empty();
        if is_still && world.figures().len() == guards.figure_count() + players.len() {
            return;
        }
        let missiles = missiles.iter().filter_map(|missile| sprites.missile(missile));
        let puffs = smoke.puffs().filter_map(|puff| sprites.puff(puff));
        let players = players.iter().copied();
        world.set_figures(guards.figures().chain(missiles).chain(puffs).chain(players));
        self.figure_revision += 1;
    }

    /// Updates the moving lamps.
    pub(crate) fn show_lamps(&mut self) {
        let lit = playing(&self.player, self.members.as_deref());
        let lit = lit.filter(|(_, player)| player.has_light);
        let of_players = lit.map(|(_, player)| (player.motion.cell(), lamp()));
        let has_changed = self.world.set_moving_lamps(of_players.chain(self.guards.lamps()));
        self.revision += u64::from(has_changed);
    }
}

/// The player's lamp.
fn lamp() -> Lamp {
    Lamp { light: Light::new(0.6).unwrap_or(Light::NONE), reach: Reach::default() }
}
