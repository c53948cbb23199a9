//! The view of a game for one of its players.

use glam::DVec2;

use crate::game::player::{Motion, Player};
use crate::game::rules::{PlayerId, ShownPlayers};
use crate::game::sight::{Point, is_in_sight};
use crate::game::{Flash, Game, GuardView, Health, Heard, Outcome, Tally};
use crate::world::sprite::builtin::PlayerColor;
use crate::world::{Camera, FieldOfView, Heading, Supply};

/// The height of the top of the head above the eyes, in cells.
const EYE: f64 = 0.2;
/// The height of the middle of a figure above the feet, in cells.
const MIDDLE: f64 = 0.35;

/// One player's view of a game.
#[derive(Clone, Copy, Debug)]
pub struct PlayerView<'a> {
    game: &'a Game,
    id: PlayerId,
    player: &'a Player,
}

/// Another player as one player sees them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherPlayer {
    /// The slot.
    pub id: PlayerId,
    /// The colour of the figure.
    pub color: PlayerColor,
    /// The position, in cells.
    pub position: DVec2,
    /// The height of the feet, in cells.
    pub feet: f64,
    /// The direction in which the player looks.
    pub heading: Heading,
    /// Whether the player lies on the floor, dead or stunned.
    pub is_down: bool,
    /// Whether nothing is between the two players.
    pub is_in_sight: bool,
}

impl Game {
    /// The players in the game, in the order of their slots. In a single-player game, this is the
    /// [first slot](PlayerId::FIRST).
    pub fn players(&self) -> impl Iterator<Item = PlayerId> {
        let alone = self.members.is_none().then_some(PlayerId::FIRST);
        let several = self.members.iter().flat_map(|members| members.each());
        alone.into_iter().chain(several.filter_map(|(index, _)| PlayerId::new(index)))
    }

    /// The view of a player; `None` if the player is not in the game.
    pub fn seen_by(&self, id: PlayerId) -> Option<PlayerView<'_>> {
        let player = match self.members.as_deref() {
            Some(members) => &members.member(id.index())?.player,
            None if id == PlayerId::FIRST => &self.player,
            None => return None,
        };
        Some(PlayerView { game: self, id, player })
    }

    /// The blows of the last step that hit other players, as pairs of attacker and victim.
    pub fn blows(&self) -> impl Iterator<Item = (PlayerId, PlayerId)> {
        let blows = self.members.iter().flat_map(|members| &members.blows);
        blows.filter_map(|&(by, struck)| Some((PlayerId::new(by)?, PlayerId::new(struck)?)))
    }
}

impl Game {
    /// Whether nothing hides the middle of the body `to` from the eyes of `from`.
    fn sees_body(&self, from: &Motion, to: &Motion) -> bool {
        let eye = Point { position: from.position(), height: from.head() - EYE };
        let middle = f64::midpoint(to.feet(), to.head());
        let body = Point { position: to.position(), height: middle };
        is_in_sight(&self.world, &self.smoke.clouds, eye, body)
    }
}

impl<'a> PlayerView<'a> {
    /// The slot of the player.
    pub fn id(&self) -> PlayerId {
        self.id
    }

    /// The camera. Once the player has reached the exit, the camera stays there.
    #[expect(clippy::missing_panics_doc, reason = "the player stands inside the map")]
    pub fn camera(&self, field_of_view: FieldOfView) -> Camera {
        self.player
            .motion
            .camera(&self.game.world, field_of_view)
            .expect("the player stands inside the map, where all places are finite")
    }

    /// The position, in cells.
    pub fn position(&self) -> DVec2 {
        self.player.motion.position()
    }

    /// The height of the feet, in cells above the map's own floor.
    pub fn feet(&self) -> f64 {
        self.player.motion.feet()
    }

    /// Whether the player is in the air: jumping or falling.
    pub fn is_airborne(&self) -> bool {
        !self.player.motion.stands(&self.game.world)
    }

    /// Whether the player neither walks nor falls.
    pub fn is_still(&self) -> bool {
        self.player.motion.is_still()
    }

    /// The health.
    pub fn health(&self) -> Health {
        self.player.health
    }

    /// The number of a tool that the player carries, at most 9.
    pub fn supplies(&self, supply: Supply) -> u8 {
        self.player.supplies.count(supply)
    }

    /// The names of the keys that the player has.
    pub fn keys(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        let Self { game, player, .. } = *self;
        player.keys.iter().map(|&key| game.world.key_name(key))
    }

    /// The value of the treasure that this player has found. [`Game::treasure`] counts all players.
    pub fn treasure(&self) -> u32 {
        self.player.treasure
    }

    /// Whether the lamp is lit.
    pub fn lamp_is_lit(&self) -> bool {
        self.player.has_light
    }

    /// The player's visibility to guards, from 0 for invisible to 255.
    pub fn visibility(&self) -> u8 {
        self.game.target_at(self.player).visibility
    }

    /// The current message to the player. A message lasts for a few seconds.
    pub fn message(&self) -> Option<&'a str> {
        self.player.notice.text()
    }

    /// The text of the note that the player has reached.
    pub fn note(&self) -> Option<&'a str> {
        self.game.note_reached_by(self.player)
    }

    /// The recent sounds that the player has heard, newest last.
    pub fn heard(&self) -> &'a [Heard] {
        &self.player.hearing.heard
    }

    /// The current flash at the edge of the screen.
    pub fn flash(&self) -> Option<Flash> {
        self.player.flash
    }

    /// The remaining steps for which the player lies on the floor, stunned by another player.
    pub fn stunned(&self) -> u16 {
        self.member().map_or(0, |member| member.stunned)
    }

    /// The colour of the player's figure; `None` in a single-player game.
    pub fn color(&self) -> Option<PlayerColor> {
        Some(self.member()?.color)
    }

    /// The outcome of the game for this player.
    pub fn outcome(&self) -> Outcome {
        match (self.member(), self.player.killed_by) {
            (None, _) => self.game.outcome(),
            (Some(member), _) if member.has_won => Outcome::Won,
            (_, Some(cause)) => Outcome::Dead { cause: cause.name() },
            _ => Outcome::Playing,
        }
    }

    /// The player's results. The time runs from joining to the exit or to death. Treasure and
    /// secrets count for all players.
    pub fn tally(&self) -> Tally {
        let Some(member) = self.member() else { return self.game.tally() };
        let steps = member.ended.unwrap_or(self.game.steps).saturating_sub(member.joined);
        Tally {
            steps,
            treasure: self.game.treasure(),
            secrets: self.game.secrets(),
            alarms: self.player.counts.alarms,
            deaths: self.player.counts.deaths,
            stunned: self.player.counts.stunned,
            taken_back: 0,
        }
    }

    /// The other players who have a figure: all except players who have reached the exit.
    pub fn others(&self) -> impl Iterator<Item = OtherPlayer> + use<'a> {
        let Self { game, id, player } = *self;
        let members = game.members.iter().flat_map(|members| members.each());
        let others = members.filter(move |(index, it)| *index != id.index() && !it.has_won);
        others.filter_map(move |(index, member)| {
            let motion = &member.player.motion;
            Some(OtherPlayer {
                id: PlayerId::new(index)?,
                color: member.color,
                position: motion.position(),
                feet: motion.feet(),
                heading: motion.heading(),
                is_down: member.is_down(),
                is_in_sight: game.sees_body(&player.motion, motion),
            })
        })
    }

    /// The [other players](Self::others) that this player's map shows.
    pub fn others_on_map(&self) -> impl Iterator<Item = OtherPlayer> + use<'a> {
        let shown =
            self.game.multiplayer_rules().map_or(ShownPlayers::Nobody, |rules| rules.shows_on_map);
        self.others().filter(move |other| match shown {
            ShownPlayers::Nobody => false,
            ShownPlayers::InSight => other.is_in_sight,
            ShownPlayers::All => true,
        })
    }

    /// Whether nothing hides the middle of a figure that stands at `position`.
    pub fn sees_figure(&self, position: DVec2, feet: f64) -> bool {
        let Self { game, player, .. } = *self;
        let motion = &player.motion;
        let eye = Point { position: motion.position(), height: motion.head() - EYE };
        let middle = Point { position, height: feet + MIDDLE };
        is_in_sight(&game.world, &game.smoke.clouds, eye, middle)
    }

    /// The guards in the picture of `camera`, which is this player's, unless something hides both
    /// the middle and the top of their bodies.
    pub fn guards_in_sight(&self, camera: &Camera) -> impl Iterator<Item = GuardView> + use<'a> {
        let Self { game, player, .. } = *self;
        let (direction, half_width) = (camera.direction(), camera.field_of_view.half_width());
        let eye = player.motion.position();
        let from = Point { position: eye, height: player.motion.head() - EYE };
        let in_picture = game.guards().filter(move |guard| {
            let way = guard.position - eye;
            let depth = way.dot(direction);
            depth > 0.0 && way.dot(direction.perp()).abs() <= depth * half_width
        });
        in_picture.filter(move |guard| {
            let parts = [0.5, 0.95].map(|part| Point {
                position: guard.position,
                height: guard.feet + guard.kind.height() * part,
            });
            let clouds = &game.smoke.clouds;
            parts.iter().any(|&to| is_in_sight(&game.world, clouds, from, to))
        })
    }

    fn member(&self) -> Option<&'a super::Member> {
        self.game.members.as_deref()?.member(self.id.index())
    }
}
