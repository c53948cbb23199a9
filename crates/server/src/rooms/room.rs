//! Rooms: a game that several play, as a deterministic state machine.
//!
//! A room changes by entries of its [log](Log) and by steps, and by nothing else: the header of a
//! round, its entries and the number of steps give the room, bit for bit, on every machine. It has
//! no clock, no thread and no connection. The [sequencer](crate::rooms::sequencer) decides in which step
//! an entry takes effect.
//!
//! Sessions draw from a [`RoomView`], which shares the game: a step copies it only if a session
//! still draws from the step before. A lock around the game was refused: one slow picture would
//! delay everybody's step.

mod catalog;
mod checkpoint;
mod entry;
mod header;
mod log;
mod member;
mod mode;
mod presence;
mod replayed;
mod round;
mod talk;
#[cfg(test)]
mod tests;
mod view;

use std::collections::{BTreeSet, VecDeque};
use std::sync::Arc;

pub(crate) use self::catalog::Catalog;
pub(crate) use self::entry::{CHAT_COLUMNS, Command, Emote, Entry, MemberId, NAME_COLUMNS};
pub(crate) use self::header::{Header, Seat};
#[cfg(test)]
pub(crate) use self::log::parse as parse_log;
pub(crate) use self::log::{Log, Queue, Recorded};
use self::member::{Member, looking_only};
pub(crate) use self::mode::Mode;
pub(crate) use self::replayed::replayed;
use self::round::{Field, Round, SECOND};
pub(crate) use self::round::{Finish, Phase, Role, Standing};
pub(crate) use self::view::{MemberView, RoomView, Said};
use crate::sessions::line::Line;
use cellcaster::game::PlayerColor;
use cellcaster::game::{Game, Input, Intents, PlayerId, Rules};
use cellcaster::rng;

/// How long an emotion is shown, in steps.
const EMOTE: u64 = 3 * SECOND;

/// A room.
#[derive(Clone, Debug)]
pub(crate) struct Room {
    catalog: Arc<Catalog>,
    header: Arc<Header>,
    game: Arc<Game>,
    round: Round,
    members: Vec<Member>,
    next_member: u32,
    step: u64,
    /// The members who wish to begin the round again.
    again: BTreeSet<MemberId>,
    emotes: Vec<(MemberId, Emote, u64)>,
    said: VecDeque<Said>,
    said_count: u64,
    inputs: Vec<Input>,
    standings: Arc<[Standing]>,
}

impl Room {
    /// The room at the start of the round that `header` describes. `None` if the catalog has no such
    /// level.
    pub(crate) fn new(catalog: &Arc<Catalog>, header: Header) -> Option<Self> {
        let mut room = Self::without_members(catalog, header)?;
        let header = Arc::clone(&room.header);
        header.members.iter().for_each(|seat| room.seat(seat));
        Some(room)
    }

    /// The room before anybody is in it.
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
            emotes: Vec::new(),
            said: VecDeque::new(),
            said_count: 0,
            inputs: Vec::new(),
            standings: Arc::from([]),
            header: Arc::new(header),
        })
    }

    /// The header of the next round, after which the log of this one is not needed.
    pub(crate) fn next_header(&self) -> Header {
        let level = &self.header.level;
        let moves_on = self.header.mode.moves_on() && !self.standings.is_empty();
        let level = if moves_on { self.catalog.after(level) } else { level };
        let won = |id| self.standings.iter().find(|it| it.member == id).map_or(0, |it| it.points);
        let seat = |member: &Member| Seat {
            id: member.id,
            color: member.color,
            points: member.points.saturating_add(won(member.id)),
            kept: member.kept,
            name: member.name.clone(),
        };
        Header {
            level: level.to_owned(),
            round: self.header.round.saturating_add(1),
            next_member: self.next_member,
            members: self.members.iter().map(seat).collect(),
            ..self.header.as_ref().clone()
        }
    }

    /// Begins the next round.
    pub(crate) fn begin_next(&mut self) {
        let Some(next) = Self::new(&self.catalog, self.next_header()) else { return };
        let (said, said_count) = (std::mem::take(&mut self.said), self.said_count);
        *self = Self { said, said_count, ..next };
    }

    /// The step of the round: entries of this step take effect before it.
    pub(crate) fn step(&self) -> u64 {
        self.step
    }

    /// The state at the start of the round.
    pub(crate) fn header(&self) -> &Header {
        &self.header
    }

    /// The phase of the round.
    pub(crate) fn phase(&self) -> Phase {
        self.round.phase()
    }

    /// The game of the round.
    pub(crate) fn game(&self) -> &Game {
        &self.game
    }

    /// The members' names, in the order in which they joined.
    pub(crate) fn names(&self) -> impl Iterator<Item = &Line> {
        self.members.iter().map(|member| &member.name)
    }

    /// The first member, their player, and what they wanted in the last step.
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

    /// Whether nobody else may join.
    pub(crate) fn is_full(&self) -> bool {
        self.members.len() >= self.header.mode.most()
    }

    /// The number of the next member who joins.
    pub(crate) fn next_member(&self) -> MemberId {
        MemberId(self.next_member)
    }

    /// Whether the next round is due.
    pub(crate) fn is_over(&self) -> bool {
        self.round.is_over(self.step) || self.all_wish_again()
    }

    fn all_wish_again(&self) -> bool {
        // One who is away wishes for nothing.
        let mut here = self.members.iter().map(|member| member.id).filter(|id| !self.is_away(*id));
        !self.again.is_empty() && here.all(|id| self.again.contains(&id))
    }

    /// Applies an entry. One of a member who is not there has no effect, and what a host sends late for one who is
    /// away has none.
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
                // Nobody has seen a step that is yet to come.
                let seen = (*seen).min(self.game.steps());
                if let Some(member) = self.member_mut(id) {
                    (member.seen, member.intents) = (seen, *intents);
                }
            }
            Command::Again => {
                if self.member_mut(id).is_some() && self.again.insert(id) {
                    self.say(id, "wishes to begin again".to_owned());
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
        round.step(Field { game, members, step: *step });
        emotes.retain(|(_, _, until)| *until > *step);
        let finished: Vec<MemberId> = round.finished_in(*step).collect();
        *step += 1;
        for id in finished {
            self.announce_finish(id);
        }
        if self.standings.len() != self.round.standings().len() {
            self.standings = self.round.standings().into();
        }
    }

    /// A snapshot.
    pub(crate) fn view(&self) -> RoomView {
        let emote = |id| self.emotes.iter().find(|it| it.0 == id).map(|it| it.1);
        let member = |member: &Member| MemberView {
            id: member.id,
            name: member.name.clone(),
            color: member.color,
            player: member.player,
            role: self.round.role(member.id),
            finish: self.round.finish(member.id),
            points: member.points,
            is_blind: self.round.is_blind(member.id),
            emote: emote(member.id),
            is_away: self.is_away(member.id),
        };
        RoomView {
            game: Arc::clone(&self.game),
            header: Arc::clone(&self.header),
            step: self.step,
            phase: self.round.phase(),
            begun: self.round.begun(),
            members: self.members.iter().map(member).collect(),
            acted: self.members.iter().map(|member| member.acted).collect(),
            standings: Arc::clone(&self.standings),
            said: self.said.iter().cloned().collect(),
        }
    }
}
