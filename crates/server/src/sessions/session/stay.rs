//! A visitor's stay in a room, as a member or a watcher.

use std::sync::Arc;
use std::time::Duration;

use super::ceremony::{Ceremony, Edge, edge, finishers};
use super::frames::ShownSteps;
use super::intent_queue::IntentQueue;
use super::messages::SessionRequest;
use crate::rooms::ghost::Ghost;
use crate::rooms::invitation::RoomCode;
use crate::rooms::room::{Header, MemberId, MemberView, Mode, Phase, RoomView};
use cellcaster::app::MapDisplay;
use cellcaster::app::parts::{MapPanel, Watch};
use cellcaster::game::{Intents, Look, Outcome, PlayerColor, PlayerView, STEPS_PER_SECOND};
use cellcaster::world::{Camera, Difficulty, FieldOfView, Figure};

/// A stay in a room.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(crate) struct Stay {
    /// The visitor's number as a member; `None` if they watch.
    pub(crate) member: Option<MemberId>,
    /// The invitation code, if the room is private.
    pub(crate) code: Option<RoomCode>,
    /// The member that is watched while the visitor does not play.
    watched: Option<MemberId>,
    /// Whether the last picture shows another member's view, because the visitor is a watcher or has finished.
    pub(crate) is_watching: bool,
    pub(crate) intents: IntentQueue,
    pub(crate) frames: ShownSteps,
    pub(crate) map: MapPanel,
    /// Detects events that ring the bell.
    pub(crate) watch: Watch,
    /// The game time at which the last picture changes by itself.
    pub(crate) next_change: Option<f64>,
    pub(crate) ghosts: Ghosts,
    pub(crate) ceremony: Ceremony,
    /// Whether the play has begun since the last picture, which rings the bell.
    begins_play: bool,
    pub(crate) shows_members: bool,
    /// Whether the player is airborne in the last picture.
    pub(crate) is_airborne: bool,
    /// The time since when pictures have shown the player dead; `None` if the last one does not.
    pub(crate) dead_since: Option<Duration>,
    /// Whether a dead player restarts the round instead of continuing from a checkpoint.
    pub(crate) dies_for_good: bool,
    /// The members who could be watched in the last picture.
    members: Vec<MemberId>,
    /// The state shown in the last picture; `None` before the first.
    shown: Option<PictureState>,
}

/// The part of a room's state that a picture depends on.
#[derive(Debug)]
struct PictureState {
    header: Arc<Header>,
    revision: u64,
    camera: Camera,
    phase: Phase,
    times: [Option<u64>; 2],
    members: Arc<[MemberView]>,
    ghosts: Vec<Figure>,
    standings: usize,
    large: Option<String>,
    edge: Edge,
    finishers: usize,
    /// The game time at which the picture next changes by itself.
    animates_at: Option<f64>,
}

impl Stay {
    pub(crate) fn new(member: Option<MemberId>, code: Option<RoomCode>, map: MapDisplay) -> Self {
        Self {
            member,
            code,
            watched: None,
            is_watching: false,
            intents: IntentQueue::default(),
            frames: ShownSteps::default(),
            map: MapPanel::new(map).narrow(),
            watch: Watch::default(),
            next_change: None,
            ghosts: Ghosts::default(),
            ceremony: Ceremony::default(),
            begins_play: false,
            shows_members: false,
            is_airborne: false,
            dead_since: None,
            dies_for_good: false,
            members: Vec::new(),
            shown: None,
        }
    }

    /// Updates the stay from `room` before it is drawn; returns a request for data that the picture needs.
    pub(crate) fn look_at(&mut self, room: &RoomView, now: Duration) -> Option<SessionRequest> {
        let is_same_round = |shown: &PictureState| Arc::ptr_eq(&shown.header, &room.header);
        let begins = !self.shown.as_ref().is_some_and(is_same_round);
        if begins && self.shown.is_some() {
            self.map.begin_level();
            self.frames.forget();
        }
        if let Some(player) = self.member.and_then(|id| room.member(id)?.player) {
            if begins {
                self.watch = Watch::of(&room.game, player);
            }
            self.watch.look_at(&room.game, player);
        }
        self.begins_play |= self.ceremony.look_at(room, self.member);
        // The blank view contains no part of the level that could change.
        self.next_change = None;
        let playing = room.members.iter().filter(|member| member.finish.is_none());
        self.members = playing.map(|member| member.id).collect();
        if self.watched.is_none_or(|id| !self.members.contains(&id)) {
            self.watched = self.members.first().copied();
        }
        let seen_through = self.seen_through(room).map(|(member, _)| member.id);
        self.is_watching = self.member.is_none() || seen_through != self.member;
        // Tab selects another member then.
        self.shows_members &= !self.is_watching;
        let own = self.member.and_then(|id| room.game.seen_by(room.member(id)?.player?));
        self.is_airborne = own.is_some_and(|player| player.is_airborne());
        let is_dead = |player: PlayerView| matches!(player.outcome(), Outcome::Dead { .. });
        self.dies_for_good = room.game.multiplayer_rules().is_some_and(|rules| !rules.respawns);
        let is_dead = own.is_some_and(is_dead);
        self.dead_since = is_dead.then(|| self.dead_since.unwrap_or(now));
        begins.then(|| self.ghosts.begin(room)).flatten()
    }

    /// Returns true if `room` has acted on all of the member's intents.
    pub(crate) fn has_acted(&self, room: &RoomView) -> bool {
        self.acted(room).is_none_or(|acted| acted == self.intents.newest())
    }

    /// Returns true if `room` acts on these intents of the member, or on the newest ones.
    pub(crate) fn shows_intents(&self, room: &RoomView, wanted: Option<Intents>) -> bool {
        self.has_acted(room) || wanted.is_some() && wanted == self.acted(room)
    }

    /// The member's intents on which `room` has acted.
    fn acted(&self, room: &RoomView) -> Option<Intents> {
        Some(room.acted(self.member?)?.with_look(Look::NONE))
    }

    /// Returns true if the bell rings, for the last picture or since then.
    pub(crate) fn take_ring(&mut self) -> bool {
        std::mem::take(&mut self.begins_play) | self.watch.take_ring()
    }

    /// The text in large letters over the picture.
    pub(crate) fn large(&self, room: &RoomView) -> Option<String> {
        self.ceremony.large(room, self.member.and_then(|id| room.member(id)))
    }

    /// The edge of the picture.
    pub(crate) fn edge(&self, room: &RoomView) -> Edge {
        self.seen_through(room).map_or(Edge::Plain, |(member, _)| edge(room, member))
    }

    /// The colour of the visitor's own figure and ghost.
    pub(crate) fn own_color(&self, room: &RoomView) -> Option<PlayerColor> {
        self.member.and_then(|id| room.member(id)).map(|member| member.color)
    }

    /// The figures of the ghosts in the picture.
    pub(crate) fn ghosts<'r>(
        &'r self,
        room: &'r RoomView,
        is_on: bool,
    ) -> impl Iterator<Item = Figure> {
        let own = self.own_color(room);
        self.ghosts.seen(room, own, is_on).map(|seen| seen.figure)
    }

    /// The member through whose eyes the room is shown: the visitor until they finish, and then the watched
    /// member. Members who have finished are used only if nobody is still playing. `None` if the room is
    /// empty.
    pub(crate) fn seen_through<'r>(
        &self,
        room: &'r RoomView,
    ) -> Option<(&'r MemberView, PlayerView<'r>)> {
        let own = self.member.and_then(|id| room.member(id));
        let watched = self.watched.and_then(|id| room.member(id));
        let candidates = || own.into_iter().chain(watched).chain(room.members.iter());
        let seen = |it: &'r MemberView| Some((it, room.game.seen_by(it.player?)?));
        let playing = candidates().filter(|it| it.finish.is_none()).find_map(seen);
        playing.or_else(|| candidates().find_map(seen))
    }

    /// The camera of the picture.
    pub(crate) fn camera(&self, room: &RoomView, view: FieldOfView) -> Camera {
        if let Some((_, moment)) = room.replayed() {
            let mut camera = moment.camera;
            camera.field_of_view = view;
            return camera;
        }
        let start = || room.game.world().start_camera(view);
        self.seen_through(room).map_or_else(start, |(_, player)| player.camera(view))
    }

    /// Watches the next member, or the previous one if `forward` is false.
    pub(crate) fn watch_another(&mut self, forward: bool) {
        let count = self.members.len();
        if count > 0 {
            let index = self.members.iter().position(|&id| Some(id) == self.watched).unwrap_or(0);
            let by = if forward { 1 } else { count - 1 };
            self.watched = self.members.get((index + by) % count).copied();
        }
    }

    /// Returns true if a picture of `room` would differ from the last one.
    pub(crate) fn differs_from(
        &self,
        room: &RoomView,
        view: FieldOfView,
        shows_ghosts: bool,
    ) -> bool {
        let Some(shown) = &self.shown else { return true };
        let elapsed = room.game.elapsed();
        shown.revision != room.game.revision()
            || shown.camera != self.camera(room, view)
            || std::mem::discriminant(&shown.phase) != std::mem::discriminant(&room.phase)
            || shown.times != times(room)
            || shown.members != room.members
            || !self.ghosts(room, shows_ghosts).eq(shown.ghosts.iter().copied())
            || shown.standings != room.standings.len()
            || shown.large != self.large(room)
            || shown.edge != self.edge(room)
            || shown.finishers != finishers(room).len()
            || shown.animates_at.is_some_and(|time| time <= elapsed)
            || !Arc::ptr_eq(&shown.header, &room.header)
    }

    /// Records that `room` was drawn.
    pub(crate) fn drawn(&mut self, room: &RoomView, view: FieldOfView, shows_ghosts: bool) {
        self.shown = Some(PictureState {
            header: Arc::clone(&room.header),
            revision: room.game.revision(),
            camera: self.camera(room, view),
            phase: room.phase,
            times: times(room),
            members: Arc::clone(&room.members),
            ghosts: self.ghosts(room, shows_ghosts).collect(),
            standings: room.standings.len(),
            large: self.large(room),
            edge: self.edge(room),
            finishers: finishers(room).len(),
            animates_at: self.next_change,
        });
    }
}

/// The ghosts of the current level.
#[derive(Debug, Default)]
pub(crate) struct Ghosts {
    /// The level for which they were requested.
    level: Option<(String, Difficulty)>,
    ghosts: Option<Arc<[Ghost]>>,
}

/// A ghost at its current position.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SeenGhost<'g> {
    pub(crate) ghost: &'g Ghost,
    pub(crate) color: PlayerColor,
    pub(crate) figure: Figure,
}

impl Ghosts {
    /// Resets the ghosts at the start of a round; returns the request for the ghosts of its level.
    pub(crate) fn begin(&mut self, room: &RoomView) -> Option<SessionRequest> {
        *self = Self::default();
        let header = &room.header;
        header.mode.has_ghosts().then(|| {
            let (level, difficulty) = (header.level.clone(), header.difficulty);
            self.level = Some((level.clone(), difficulty));
            SessionRequest::Ghosts { level, difficulty }
        })
    }

    /// Stores the ghosts of a level, if it is still the current one.
    pub(crate) fn receive(&mut self, level: String, difficulty: Difficulty, ghosts: Arc<[Ghost]>) {
        if self.level == Some((level, difficulty)) {
            self.ghosts = Some(ghosts);
        }
    }

    /// The ghosts at their current positions, if they are switched on. The visitor's own ghost has their
    /// colour. There are none unless the round is being played.
    pub(crate) fn seen<'g>(
        &'g self,
        room: &'g RoomView,
        own: Option<PlayerColor>,
        is_on: bool,
    ) -> impl Iterator<Item = SeenGhost<'g>> {
        let step = room.begun.map(|begun| room.step.saturating_sub(begun));
        let ghosts = self.ghosts.as_deref().filter(|_| is_on).unwrap_or_default();
        step.into_iter().flat_map(move |step| {
            ghosts.iter().filter_map(move |ghost| {
                let color = ghost.color(own);
                let figure = ghost.figure(step, room.game.sprite_of_players(color)?)?;
                Some(SeenGhost { ghost, color, figure })
            })
        })
    }
}

/// The times that the picture may show, in seconds.
fn times(room: &RoomView) -> [Option<u64>; 2] {
    [seconds_left(room), run_seconds(room)]
}

/// The running time of the round, in seconds; `None` in modes that do not count it.
pub(crate) fn run_seconds(room: &RoomView) -> Option<u64> {
    match room.header.mode {
        Mode::Race | Mode::Together | Mode::Alone => {
            Some(room.step.saturating_sub(room.begun?) / u64::from(STEPS_PER_SECOND))
        }
        Mode::Roam | Mode::Tag | Mode::Hide => None,
    }
}

/// The seconds left in the countdown that the picture shows; `None` if it shows none.
pub(crate) fn seconds_left(room: &RoomView) -> Option<u64> {
    let counts = |ends: u64| match room.header.mode {
        Mode::Tag | Mode::Hide => true,
        // After the first finish, the time left is limited.
        mode => mode.after_first().is_some_and(|last| ends.saturating_sub(room.step) <= last),
    };
    match room.phase {
        Phase::Countdown { ends } | Phase::Over { ends } => Some(ends),
        Phase::Playing { ends } if counts(ends) => Some(ends),
        Phase::Playing { .. } | Phase::Waiting => None,
    }
    .map(|ends| ends.saturating_sub(room.step).div_ceil(u64::from(STEPS_PER_SECOND)))
}
