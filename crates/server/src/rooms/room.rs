//! A room: a multiplayer game as a deterministic state machine.
//!
//! Only the entries of its [log] and steps change a room. The header of a round, its entries and the number
//! of steps therefore determine the room, bit for bit, on every machine. A room has no clock, no thread and
//! no connection. The [sequencer](crate::rooms::sequencer) decides in which step an entry takes effect.
//!
//! Sessions draw from a [`RoomView`], which shares the game with the room. A step copies the game only if a
//! session is still drawing from the previous step. Rejected: a lock around the game. One slow frame would
//! delay every member's step.
//!
//! A round in a [daily level](Day) stays in it. If a member's driver has told the room of a later day, the next round
//! is played in the level of that day.
//!
//! A member with an account may return from another host, so the room keeps their seat. While their host is
//! gone the member stands still, for at most [`AWAY`]. Each return has a token, which tells the hosts which
//! of them now plays for the member. A host that was cut off may still believe that it does.

mod catalog;
mod checkpoint;
mod log;
pub(crate) mod looks;
mod member;
mod mode;
mod replay;
mod round;
#[cfg(test)]
mod tests;
mod ways;

use std::collections::BTreeSet;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

pub(crate) use self::catalog::{Catalog, no_level};
pub(crate) use self::log::{
    CHAT_COLUMNS, Command, Emote, Entry, Header, Seat, first_header, is_of_other_version, parse_log,
};
use self::looks::FigureLook;
use self::member::{AWAY, Member, looking_only};
pub(crate) use self::member::{KeptPlace, MemberId, NAME_COLUMNS, line_within};
pub use self::mode::Mode;
pub(crate) use self::mode::SECOND;
use self::replay::MomentRecorder;
pub(crate) use self::replay::{Moment, RoundReplay};
use self::round::{Field, Round, STANDINGS};
pub(crate) use self::round::{Finish, Phase, Role, Standing, ordinal};
use self::ways::ExitWays;
use crate::accounts::Day;
use crate::line::Line;
use cellcaster::game::{Game, Input, Intents, PlayerColor, PlayerId, Rules};
use cellcaster::rng;
use cellcaster::world::{FieldOfView, Figure};

/// How long an emote is shown, in steps.
const EMOTE: u64 = 3 * SECOND;
/// The number of chat lines that a room keeps.
const SAID: usize = 8;

/// A room. Its serialized form is the state without the level, the header, the chat and the game.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Room {
    step: u64,
    next_member: u32,
    round: Round,
    members: Vec<Member>,
    /// The members who want to restart the round.
    again: BTreeSet<MemberId>,
    /// The latest day that the room has heard of in this round.
    today: Option<Day>,
    emotes: Vec<(MemberId, Emote, u64)>,
    #[serde(skip)]
    catalog: Arc<Catalog>,
    #[serde(skip)]
    header: Arc<Header>,
    #[serde(skip)]
    game: Arc<Game>,
    #[serde(skip)]
    said: Arc<[ChatLine]>,
    #[serde(skip)]
    said_count: u64,
    /// Recomputed in each step.
    #[serde(skip)]
    inputs: Vec<Input>,
    /// A copy of the round's standings.
    #[serde(skip)]
    standings: Arc<[Standing]>,
    /// The ways to the exit; `None` unless the mode is a race.
    #[serde(skip)]
    ways: Option<Arc<ExitWays>>,
    #[serde(skip)]
    recorder: MomentRecorder,
    #[serde(skip)]
    replay: Option<Arc<RoundReplay>>,
}

/// An immutable snapshot of a room. It shares the game with the room, which copies the game only if a
/// snapshot still exists in the next step.
#[derive(Clone, Debug)]
pub(crate) struct RoomView {
    /// The game of the current round.
    pub(crate) game: Arc<Game>,
    /// The state at the start of the round, including the level, the mode and the round's number.
    pub(crate) header: Arc<Header>,
    /// The current step of the round.
    pub(crate) step: u64,
    /// The phase of the round.
    pub(crate) phase: Phase,
    /// The step in which the play began; `None` unless the round is being played in a mode that ends at the exit.
    pub(crate) begun: Option<u64>,
    /// The members, in the order of joining.
    pub(crate) members: Arc<[MemberView]>,
    /// The members' intents in the last step, in the same order.
    pub(crate) acted: Vec<Intents>,
    /// The standings of the round, winner first; empty until the round ends.
    pub(crate) standings: Arc<[Standing]>,
    /// The winner's last seconds; `None` until the round ends, or if nobody won.
    pub(crate) replay: Option<Arc<RoundReplay>>,
    /// The latest chat lines, oldest first.
    pub(crate) said: Arc<[ChatLine]>,
}

/// The public part of a member's state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct MemberView {
    pub(crate) id: MemberId,
    pub(crate) name: Line,
    pub(crate) color: PlayerColor,
    /// The member's player in the game; `None` if the game had no free slot.
    pub(crate) player: Option<PlayerId>,
    pub(crate) role: Role,
    pub(crate) look: FigureLook,
    /// The place in a race, from 1: by time for members at the exit, and then by the way to the exit. `None` if
    /// no race is on.
    pub(crate) place: Option<usize>,
    /// The finish, if the member has reached the exit.
    pub(crate) finish: Option<Finish>,
    pub(crate) points: u32,
    /// Whether the member's view is blank because the others are hiding.
    pub(crate) is_blind: bool,
    /// The latest emote, while it is shown.
    pub(crate) emote: Option<Emote>,
    /// Whether the member's host is gone. The member stands still meanwhile.
    pub(crate) is_away: bool,
}

/// A line of chat, or a remark of the room.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ChatLine {
    /// The line's number in the room, from 1, by which sessions recognise new lines.
    pub(crate) number: u64,
    /// The speaker's name and colour; `None` for a remark of the room.
    pub(crate) by: Option<(Line, PlayerColor)>,
    pub(crate) text: String,
}

impl Room {
    /// The room at the start of the round that `header` describes. `None` if the catalog does not contain the level.
    pub(crate) fn new(catalog: &Arc<Catalog>, header: Header) -> Option<Self> {
        let mut room = Self::without_members(catalog, header)?;
        let header = Arc::clone(&room.header);
        header.members.iter().for_each(|seat| room.seat(seat));
        Some(room)
    }

    /// The room before its first member.
    fn without_members(catalog: &Arc<Catalog>, header: Header) -> Option<Self> {
        let world = catalog.world(&header.level)?.as_ref().clone();
        let rules =
            Rules { difficulty: header.difficulty, seed: header.mode.game_seed(header.seed) };
        let game =
            Game::for_players(header.mode.prepared(world), rules, header.mode.multiplayer_rules());
        let round_seed = rng::hash(header.seed, [u64::from(header.round)]);
        Some(Self {
            catalog: Arc::clone(catalog),
            game: Arc::new(game),
            round: Round::new(header.mode, round_seed),
            members: Vec::new(),
            next_member: header.next_member,
            step: 0,
            again: BTreeSet::new(),
            today: None,
            emotes: Vec::new(),
            said: Arc::default(),
            said_count: 0,
            inputs: Vec::new(),
            standings: Arc::from([]),
            ways: (header.mode == Mode::Race).then(|| catalog.exit_ways(&header.level)).flatten(),
            recorder: MomentRecorder::default(),
            replay: None,
            header: Arc::new(header),
        })
    }

    /// The header of the next round. The log of the current round is not needed after it.
    pub(crate) fn next_header(&self) -> Header {
        let won = |id| self.standings.iter().find(|it| it.member == id).map_or(0, |it| it.points);
        let seat = |member: &Member| Seat {
            id: member.id,
            color: member.color,
            points: member.points.saturating_add(won(member.id)),
            kept: member.kept,
            name: member.name.clone(),
        };
        Header {
            level: self.next_level(),
            round: self.header.round.saturating_add(1),
            next_member: self.next_member,
            members: self.members.iter().map(seat).collect(),
            ..self.header.as_ref().clone()
        }
    }

    fn next_level(&self) -> String {
        let level = &self.header.level;
        if let Some(day) = Day::of_level(level) {
            return self.today.map_or(day, |today| today.max(day)).level();
        }
        let moves_on = self.header.mode.moves_on() && !self.standings.is_empty();
        if moves_on { self.catalog.after(level) } else { level }.to_owned()
    }

    pub(crate) fn begin_next(&mut self) {
        let Some(next) = Self::new(&self.catalog, self.next_header()) else { return };
        let (said, said_count) = (std::mem::take(&mut self.said), self.said_count);
        *self = Self { said, said_count, ..next };
    }

    /// The current step of the round. Entries with this step take effect before it.
    pub(crate) fn step(&self) -> u64 {
        self.step
    }

    /// The state at the start of the round.
    pub(crate) fn header(&self) -> &Header {
        &self.header
    }

    pub(crate) fn phase(&self) -> Phase {
        self.round.phase
    }

    pub(crate) fn game(&self) -> &Game {
        &self.game
    }

    /// The members' names, in the order of joining.
    pub(crate) fn names(&self) -> impl Iterator<Item = &Line> {
        self.members.iter().map(|member| &member.name)
    }

    /// The first member, their player, and their intents in the last step.
    pub(crate) fn first_member(&self) -> Option<(MemberId, PlayerId, Intents)> {
        let member = self.members.first()?;
        Some((member.id, member.player?, member.acted))
    }

    /// The members with their colours.
    pub(crate) fn colors(&self) -> impl Iterator<Item = (MemberId, PlayerColor)> {
        self.members.iter().map(|member| (member.id, member.color))
    }

    /// The number of members.
    pub(crate) fn len(&self) -> usize {
        self.members.len()
    }

    /// Returns true if no further member may join.
    pub(crate) fn is_full(&self) -> bool {
        self.members.len() >= self.header.mode.most()
    }

    /// The number that the next new member gets.
    pub(crate) fn next_member(&self) -> MemberId {
        MemberId(self.next_member)
    }

    /// The number of members who were caught by others, and the number of finishes and of ends of the round. Both
    /// only grow during a round.
    pub(crate) fn events(&self) -> [u32; 2] {
        let is_over = matches!(self.round.phase, Phase::Over { .. });
        [self.round.caught(), self.round.finished() as u32 + u32::from(is_over)]
    }

    /// Returns true when the next round must begin.
    pub(crate) fn is_over(&self) -> bool {
        self.round.is_over(self.step) || self.all_wish_again()
    }

    fn all_wish_again(&self) -> bool {
        let mut here = self.members.iter().filter(|member| !member.is_away());
        !self.again.is_empty() && here.all(|member| self.again.contains(&member.id))
    }

    /// Applies an entry. An entry has no effect if its member is not in the room, or if it arrives late for a
    /// member who is away.
    pub(crate) fn apply(&mut self, entry: &Entry) {
        let id = entry.member;
        match &entry.command {
            Command::Join { color, name } => self.join(id, *color, name),
            Command::Leave => self.leave(id),
            Command::Keep => self.keep(id),
            Command::Away => self.go_away(id),
            Command::Return { token } => self.take_back(id, *token),
            _ if self.is_away(id) => {}
            Command::Intents { seen, intents } => {
                // No member can have seen a future step.
                let seen = (*seen).min(self.game.steps());
                if let Some(member) = self.member_mut(id) {
                    (member.seen, member.intents) = (seen, *intents);
                }
            }
            Command::Again => {
                if self.member_mut(id).is_some() && self.again.insert(id) {
                    self.say(id, "wants to restart the round".to_owned());
                }
            }
            Command::Day(day) => {
                if self.member(id).is_some() {
                    self.today = self.today.max(Some(*day));
                }
            }
            Command::Say(line) => self.say(id, line.as_str().to_owned()),
            Command::Emote(emote) => {
                self.emotes.retain(|(member, _, _)| *member != id);
                self.emotes.push((id, *emote, self.step + EMOTE));
                self.say(id, format!("({})", emote.text()));
            }
        }
    }

    /// Advances the room by one step.
    pub(crate) fn advance(&mut self) {
        self.count_away();
        let Self { members, round, inputs, game, step, emotes, .. } = self;
        inputs.clear();
        inputs.extend(members.iter_mut().filter_map(|member| {
            let intents = member.begin_step();
            let is_held = round.holds(member.id, *step);
            let intents = if is_held { looking_only(intents) } else { intents };
            Some(Input { player: member.player?, intents, seen: member.seen })
        }));
        Arc::make_mut(game).step_all(inputs);
        let is_open = round.is_open();
        round.step(Field { game, members, step: *step });
        emotes.retain(|(_, _, until)| *until > *step);
        let finished: Vec<MemberId> = round.finished_in(*step).collect();
        *step += 1;
        self.record(is_open);
        for id in finished {
            self.announce_finish(id);
        }
        if self.standings.len() != self.round.standings.len() {
            self.standings = self.round.standings.as_slice().into();
            self.replay = self.replay_of_best().map(Arc::new);
        }
    }

    /// Records the step that has ended, if the round `is_open`.
    fn record(&mut self, is_open: bool) {
        if !is_open {
            if matches!(self.round.phase, Phase::Countdown { .. }) {
                self.recorder = MomentRecorder::default();
            }
        } else if MomentRecorder::is_due(self.step) && self.header.mode != Mode::Roam {
            let Self { recorder, members, game, round, step, .. } = self;
            let looks = members.iter().filter_map(|it| Some((it.player?, look(round, it, *step))));
            let figures = looks::figures(game, looks);
            let cameras = members.iter().filter_map(|member| {
                let player = game.seen_by(member.player?)?;
                Some((member.id, player.camera(FieldOfView::default())))
            });
            recorder.record(cameras, figures.as_deref().unwrap_or(game.world().figures()));
        }
    }

    fn replay_of_best(&mut self) -> Option<RoundReplay> {
        let best = self.round.best()?;
        let name = self.member(best)?.name.clone();
        self.recorder.replay(best, name)
    }

    /// The lengths of the members' ways to the exit, in quarters of a cell; `u32::MAX` if there is no way.
    fn ways_to_exit(&self) -> Vec<(MemberId, u32)> {
        let is_played = matches!(self.round.phase, Phase::Playing { .. });
        let Some(ways) = self.ways.as_deref().filter(|_| is_played) else { return Vec::new() };
        let way = |member: &Member| {
            let position = self.game.seen_by(member.player?)?.position();
            Some((ways.from(position)? * 4.0).round() as u32)
        };
        self.members.iter().map(|member| (member.id, way(member).unwrap_or(u32::MAX))).collect()
    }

    /// The place of a member in a race, from the lengths of all `ways`. Members who are less than a quarter of
    /// a cell apart share a place.
    fn place(&self, id: MemberId, ways: &[(MemberId, u32)]) -> Option<usize> {
        if let Some(finish) = self.round.finish(id) {
            return (self.header.mode == Mode::Race).then_some(finish.place);
        }
        let own = ways.iter().find(|it| it.0 == id)?.1;
        let is_ahead =
            |&&(other, way): &&(MemberId, u32)| way < own && self.round.finish(other).is_none();
        Some(self.round.finished() + ways.iter().filter(is_ahead).count() + 1)
    }

    /// A snapshot of the room.
    pub(crate) fn view(&self) -> RoomView {
        let emote = |id| self.emotes.iter().find(|it| it.0 == id).map(|it| it.1);
        let ways = self.ways_to_exit();
        let member = |member: &Member| MemberView {
            id: member.id,
            name: member.name.clone(),
            color: member.color,
            player: member.player,
            role: self.round.role(member.id),
            look: look(&self.round, member, self.step),
            place: self.place(member.id, &ways),
            finish: self.round.finish(member.id),
            points: member.points,
            is_blind: self.round.is_blind(member.id),
            emote: emote(member.id),
            is_away: member.is_away(),
        };
        RoomView {
            game: Arc::clone(&self.game),
            header: Arc::clone(&self.header),
            step: self.step,
            phase: self.round.phase,
            begun: self.round.begun(),
            members: self.members.iter().map(member).collect(),
            acted: self.members.iter().map(|member| member.acted).collect(),
            standings: Arc::clone(&self.standings),
            replay: self.replay.clone(),
            said: Arc::clone(&self.said),
        }
    }

    /// Returns true if a member is away.
    pub(crate) fn is_away(&self, id: MemberId) -> bool {
        self.member(id).is_some_and(Member::is_away)
    }

    /// The seat that is kept for a member; `None` for a guest.
    pub(crate) fn kept_place(&self, id: MemberId) -> Option<KeptPlace> {
        self.member(id)?.kept
    }

    /// Returns true if a member was in the room and has left.
    pub(crate) fn has_lost(&self, id: MemberId) -> bool {
        id < self.next_member() && self.member(id).is_none()
    }

    fn join(&mut self, id: MemberId, color: PlayerColor, name: &Line) {
        if self.is_full() || self.member(id).is_some() {
            return;
        }
        self.next_member = self.next_member.max(id.0.saturating_add(1));
        self.seat(&Seat { id, color, points: 0, name: name.clone(), kept: None });
        self.announce(format!("{name} has joined."));
    }

    fn seat(&mut self, seat: &Seat) {
        let game = Arc::make_mut(&mut self.game);
        let player = game.join(seat.color);
        self.members.push(Member {
            id: seat.id,
            name: seat.name.clone(),
            color: seat.color,
            player,
            points: seat.points,
            kept: seat.kept,
            intents: Intents::new(),
            acted: Intents::new(),
            seen: game.steps(),
        });
    }

    fn leave(&mut self, id: MemberId) {
        let Some(index) = self.members.iter().position(|member| member.id == id) else { return };
        let member = self.members.remove(index);
        self.again.remove(&id);
        if let Some(player) = member.player {
            Arc::make_mut(&mut self.game).leave(player);
        }
        self.announce(format!("{} leaves.", member.name));
    }

    /// Keeps a member's seat from now on.
    fn keep(&mut self, id: MemberId) {
        if let Some(member) = self.member_mut(id) {
            member.kept.get_or_insert_default();
        }
    }

    /// Marks a member away because their host is gone. A member without a kept seat leaves.
    fn go_away(&mut self, id: MemberId) {
        let Some(member) = self.member_mut(id) else { return };
        let Some(kept) = &mut member.kept else { return self.leave(id) };
        if kept.away.is_none() {
            kept.away = Some(AWAY);
            member.intents = Intents::new();
            let line = format!("{} is away.", member.name);
            self.again.remove(&id);
            self.announce(line);
        }
    }

    /// Brings a member back, on another host.
    fn take_back(&mut self, id: MemberId, token: u64) {
        let Some(member) = self.member_mut(id) else { return };
        let Some(kept) = &mut member.kept else { return };
        kept.token = token;
        if kept.away.take().is_some() {
            let line = format!("{} is back.", member.name);
            self.announce(line);
        }
    }

    /// Counts down the time of members who are away, and removes those whose time is up.
    fn count_away(&mut self) {
        let kept = self.members.iter_mut().filter_map(|member| member.kept.as_mut());
        for left in kept.filter_map(|kept| kept.away.as_mut()) {
            *left = left.saturating_sub(1);
        }
        let is_late = |member: &Member| member.kept.is_some_and(|kept| kept.away == Some(0));
        while let Some(id) = self.members.iter().find(|it| is_late(it)).map(|member| member.id) {
            self.leave(id);
        }
    }

    fn member(&self, id: MemberId) -> Option<&Member> {
        self.members.iter().find(|member| member.id == id)
    }

    fn member_mut(&mut self, id: MemberId) -> Option<&mut Member> {
        self.members.iter_mut().find(|member| member.id == id)
    }

    fn say(&mut self, id: MemberId, text: String) {
        if let Some(by) = self.member(id).map(|member| (member.name.clone(), member.color)) {
            self.remember(Some(by), text);
        }
    }

    fn announce(&mut self, text: String) {
        self.remember(None, text);
    }

    /// Announces that a member has reached the exit. In other modes, the picture says it.
    fn announce_finish(&mut self, id: MemberId) {
        let Some((finish, member)) = self.round.finish(id).zip(self.member(id)) else { return };
        if self.header.mode == Mode::Together {
            self.announce(format!("{} is out after {}.", member.name, finish.time()));
        }
    }

    fn remember(&mut self, by: Option<(Line, PlayerColor)>, text: String) {
        self.said_count += 1;
        let line = ChatLine { number: self.said_count, by, text };
        let first = self.said.len().saturating_sub(SAID - 1);
        self.said = self.said[first..].iter().cloned().chain([line]).collect();
    }
}

impl RoomView {
    /// The member with this number.
    pub(crate) fn member(&self, id: MemberId) -> Option<&MemberView> {
        self.members.iter().find(|member| member.id == id)
    }

    /// A member's intents in the last step.
    pub(crate) fn acted(&self, id: MemberId) -> Option<Intents> {
        let index = self.members.iter().position(|member| member.id == id)?;
        self.acted.get(index).copied()
    }

    /// The winner, if the round has ended and the winner is still in the room.
    pub(crate) fn winner(&self) -> Option<&MemberView> {
        let first = self.standings.first().filter(|standing| standing.steps.is_some());
        self.member(first?.member)
    }

    /// The moment of the replay to show, and the name of the member through whose eyes; `None` if there is no
    /// replay.
    pub(crate) fn replayed(&self) -> Option<(&Line, &Moment)> {
        let Phase::Over { ends } = self.phase else { return None };
        let replay = self.replay.as_deref()?;
        let since = self.step.saturating_add(STANDINGS).saturating_sub(ends);
        Some((&replay.name, replay.moment(since)))
    }

    /// The number of steps since the play began; `None` unless the round is being played.
    pub(crate) fn played(&self) -> Option<u64> {
        let Phase::Playing { ends } = self.phase else { return None };
        let begun = self.begun.unwrap_or_else(|| ends.saturating_sub(self.header.mode.longest()));
        Some(self.step.saturating_sub(begun))
    }

    /// The figures with the members' looks; `None` if all look as usual.
    pub(crate) fn figures(&self) -> Option<Vec<Figure>> {
        let looks = self.members.iter().filter_map(|member| Some((member.player?, member.look)));
        looks::figures(&self.game, looks)
    }

    /// The member who controls `player`.
    pub(crate) fn member_of(&self, player: PlayerId) -> Option<&MemberView> {
        self.members.iter().find(|member| member.player == Some(player))
    }
}

/// The look of a member's figure.
fn look(round: &Round, member: &Member, step: u64) -> FigureLook {
    if member.is_away() { FigureLook::Pale } else { round.look(member.id, step) }
}
