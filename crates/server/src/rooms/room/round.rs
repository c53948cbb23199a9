//! Rounds: their phases and standings.
//!
//! A round waits for enough members, counts down, is played, and shows its standings. Then the next round
//! begins. Time is counted in steps, and chance comes from the room's seed, so the log alone determines the
//! winner.
//!
//! A member gets a point for each member that they beat in a round. Rejected: points per place. First place
//! among two members would be worth as much as first place among eight.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::looks::FigureLook;
use super::member::{Member, MemberId};
use super::mode::{Mode, SECOND};
use cellcaster::app::parts::of_steps;
use cellcaster::game::stored::{RestoreError, check};
use cellcaster::game::{Game, Outcome, PlayerId};
use cellcaster::rng::SplitMix64;

/// How long the standings are shown, in steps.
pub(crate) const STANDINGS: u64 = 10 * SECOND;
/// Hide and seek: the number of members per seeker at the start.
const MEMBERS_A_SEEKER: usize = 4;
/// Tag: how long the new "it" stands still, so that the others can get away.
const PAUSE: u64 = SECOND + SECOND / 2;
/// Tag: how long the previous "it" cannot be touched.
const SPARED: u64 = 4 * SECOND;

/// The phase of a round. Times are in steps of the round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// There are not enough members yet. They can walk about meanwhile.
    Waiting,
    /// The play begins at `ends`.
    Countdown { ends: u64 },
    /// The play ends at `ends` at the latest.
    Playing { ends: u64 },
    /// The standings are shown until `ends`.
    Over { ends: u64 },
}

/// A member's role in a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Role {
    #[default]
    Player,
    /// The seeker (in tag, the player who is "it").
    Seeker,
    /// A player who has reached the exit.
    Done,
}

/// A member's place in the standings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Standing {
    pub(crate) member: MemberId,
    /// The points that the member gets for the round.
    pub(crate) points: u32,
    /// The time until the exit, as "it", or in hiding, in steps. `None` for a member who did not finish.
    pub(crate) steps: Option<u64>,
}

/// The view of the room that a mode may use.
#[derive(Clone, Copy)]
pub(crate) struct Field<'a> {
    pub(crate) game: &'a Game,
    pub(crate) members: &'a [Member],
    pub(crate) step: u64,
}

impl Field<'_> {
    fn ids(&self) -> impl Iterator<Item = MemberId> {
        self.members.iter().map(|member| member.id)
    }

    /// Returns true if `one` touches `other` in the frame that `one` saw.
    fn touches(&self, one: MemberId, other: MemberId) -> bool {
        let Some(seen) = self.member(one).map(|member| member.seen) else { return false };
        let [one, other] = [one, other].map(|id| self.player(id));
        one.zip(other).is_some_and(|(one, other)| self.game.touches(one, other, seen))
    }

    fn has_won(&self, id: MemberId) -> bool {
        let view = self.player(id).and_then(|player| self.game.seen_by(player));
        view.is_some_and(|view| view.outcome() == Outcome::Won)
    }

    fn member(&self, id: MemberId) -> Option<&Member> {
        self.members.iter().find(|member| member.id == id)
    }

    fn player(&self, id: MemberId) -> Option<PlayerId> {
        self.member(id)?.player
    }
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Round {
    mode: Mode,
    pub(crate) phase: Phase,
    play: Play,
    chance: SplitMix64,
    pub(crate) standings: Vec<Standing>,
}

/// The part of a round's state that is specific to its mode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Play {
    Roam,
    ToExit(Finishes),
    Tag(Tag),
    Hide(Hide),
}

impl Round {
    pub(crate) fn new(mode: Mode, seed: u64) -> Self {
        let play = match mode {
            Mode::Roam => Play::Roam,
            Mode::Together | Mode::Alone | Mode::Race => Play::ToExit(Finishes::default()),
            Mode::Tag => Play::Tag(Tag::default()),
            Mode::Hide => Play::Hide(Hide::default()),
        };
        let chance = SplitMix64::new(seed);
        Self { mode, phase: Phase::Waiting, play, chance, standings: Vec::new() }
    }

    /// Checks that the round has this `mode` and began no later than `step`.
    pub(crate) fn check(&self, mode: Mode, step: u64) -> Result<(), RestoreError> {
        check(self.mode == mode, "the mode")?;
        let is_possible = match (&self.play, self.mode) {
            (Play::Roam, Mode::Roam) => true,
            (Play::ToExit(finishes), Mode::Together | Mode::Alone | Mode::Race) => {
                finishes.begun <= step
            }
            (Play::Tag(tag), Mode::Tag) => tag.since <= step,
            (Play::Hide(hide), Mode::Hide) => hide.since.is_none_or(|since| since <= step),
            _ => false,
        };
        check(is_possible, "the progress of a round")
    }

    /// Returns true when the next round must begin.
    pub(crate) fn is_over(&self, step: u64) -> bool {
        matches!(self.phase, Phase::Over { ends } if ends <= step)
    }

    pub(crate) fn role(&self, member: MemberId) -> Role {
        match &self.play {
            Play::Roam => Role::Player,
            Play::ToExit(finishes) => finishes.role(member),
            Play::Tag(tag) => tag.role(member),
            Play::Hide(hide) => hide.role(member),
        }
    }

    /// The look of a member's figure before `step`.
    pub(crate) fn look(&self, member: MemberId, step: u64) -> FigureLook {
        match &self.play {
            _ if self.role(member) == Role::Seeker => FigureLook::Marked,
            Play::Tag(tag) if tag.spares(member, step) => FigureLook::Pale,
            _ => FigureLook::Usual,
        }
    }

    /// Returns true while the round is played and nobody has reached the exit.
    pub(crate) fn is_open(&self) -> bool {
        matches!(self.phase, Phase::Playing { .. }) && self.finished() == 0
    }

    /// The member with the best result: the first at the exit or, in modes without an exit, the first in the
    /// standings.
    pub(crate) fn best(&self) -> Option<MemberId> {
        match self.finishes() {
            Some(finishes) => Some(*finishes.times.iter().min_by_key(|it| it.1)?.0),
            None => Some(self.standings.first().filter(|it| it.steps.is_some())?.member),
        }
    }

    /// A member's finish, if they have reached the exit.
    pub(crate) fn finish(&self, member: MemberId) -> Option<Finish> {
        self.finishes()?.of(member)
    }

    /// The number of members who have reached the exit, including members who have left since.
    pub(crate) fn finished(&self) -> usize {
        self.finishes().map_or(0, |finishes| finishes.times.len())
    }

    /// The members who finished in `step`.
    pub(crate) fn finished_in(&self, step: u64) -> impl Iterator<Item = MemberId> {
        self.finishes().into_iter().flat_map(move |finishes| finishes.in_step(step))
    }

    /// The step in which the play began; `None` unless the round is being played in a mode that ends at the exit.
    pub(crate) fn begun(&self) -> Option<u64> {
        let is_played = matches!(self.phase, Phase::Playing { .. });
        self.finishes().filter(|_| is_played).map(|finishes| finishes.begun)
    }

    fn finishes(&self) -> Option<&Finishes> {
        if let Play::ToExit(finishes) = &self.play { Some(finishes) } else { None }
    }

    /// Returns true if a member currently cannot walk.
    pub(crate) fn holds(&self, member: MemberId, step: u64) -> bool {
        match (&self.play, self.phase) {
            (_, Phase::Waiting | Phase::Countdown { .. }) if self.mode == Mode::Race => true,
            (Play::Hide(hide), Phase::Countdown { .. }) => hide.role(member) == Role::Seeker,
            (Play::Tag(tag), Phase::Playing { .. }) => tag.holds(member, step),
            _ => false,
        }
    }

    /// A number that grows when a member is caught by another one.
    pub(crate) fn caught(&self) -> u32 {
        match &self.play {
            Play::Tag(tag) if tag.before.is_some() => tag.since as u32,
            Play::Hide(hide) => hide.seekers.values().flatten().count() as u32,
            _ => 0,
        }
    }

    /// Returns true if a member currently sees nothing.
    pub(crate) fn is_blind(&self, member: MemberId) -> bool {
        matches!(self.mode, Mode::Hide) && self.holds(member, 0)
    }

    /// Advances the round by one step.
    pub(crate) fn step(&mut self, field: Field) {
        let (step, enough) = (field.step, field.members.len() >= self.mode.fewest());
        match self.phase {
            Phase::Waiting if enough => self.count_down(field),
            Phase::Countdown { .. } | Phase::Playing { .. } if !enough => {
                *self = Self { chance: self.chance.clone(), ..Self::new(self.mode, 0) };
            }
            Phase::Countdown { ends } if ends <= step => self.begin(field),
            Phase::Playing { ends } => {
                let is_decided = self.play(field);
                let ends = self.last_step().map_or(ends, |last| last.min(ends));
                self.phase = Phase::Playing { ends };
                if is_decided || ends <= step {
                    self.end(field);
                }
            }
            Phase::Waiting | Phase::Countdown { .. } | Phase::Over { .. } => {}
        }
    }

    fn count_down(&mut self, field: Field) {
        if let Play::Hide(hide) = &mut self.play {
            hide.choose(field, &mut self.chance);
        }
        self.phase = Phase::Countdown { ends: field.step + self.mode.countdown() };
        if self.mode.countdown() == 0 {
            self.begin(field);
        }
    }

    fn begin(&mut self, field: Field) {
        if let Play::Tag(tag) = &mut self.play {
            tag.choose(field, &mut self.chance);
        }
        if let Play::ToExit(finishes) = &mut self.play {
            finishes.begun = field.step;
        }
        self.phase = Phase::Playing { ends: field.step + self.mode.longest() };
    }

    /// Plays one step; returns whether the round is decided.
    fn play(&mut self, field: Field) -> bool {
        match &mut self.play {
            Play::Roam => false,
            Play::ToExit(finishes) => finishes.step(field),
            Play::Tag(tag) => {
                tag.step(field);
                false
            }
            Play::Hide(hide) => hide.step(field),
        }
    }

    /// The last possible step of the round, once the first member has finished.
    fn last_step(&self) -> Option<u64> {
        Some(self.finishes()?.first()? + self.mode.after_first()?)
    }

    fn end(&mut self, field: Field) {
        let steps = |id| match &self.play {
            Play::Roam => None,
            Play::ToExit(finishes) => finishes.times.get(&id).copied(),
            Play::Tag(tag) => Some(tag.time(id)),
            Play::Hide(hide) => Some(hide.time(id, field.step)),
        };
        let members = field.ids().filter(|_| self.mode != Mode::Roam);
        let results: Vec<_> = members.map(|id| (id, steps(id))).collect();
        self.standings = standings(self.mode, &results);
        self.phase = Phase::Over { ends: field.step + STANDINGS };
    }
}

/// The rank of a result; the lowest wins. Without one, a member comes last. In the campaign, all members who have reached
/// the exit are equal. In hide and seek, the longest time in hiding wins, and the first seekers come last.
fn rank(mode: Mode, steps: Option<u64>) -> u64 {
    match (mode, steps) {
        (_, None) => u64::MAX,
        (Mode::Together, _) => 0,
        (Mode::Hide, Some(steps)) => u64::MAX - steps,
        (_, Some(steps)) => steps,
    }
}

/// The standings from the members' results, in steps. Members of equal rank get equal points.
fn standings(mode: Mode, results: &[(MemberId, Option<u64>)]) -> Vec<Standing> {
    let rank = |steps| rank(mode, steps);
    let beaten = |steps| results.iter().filter(|other| rank(other.1) > rank(steps)).count() as u32;
    let standing = |&(member, steps)| Standing { member, points: beaten(steps), steps };
    let mut standings: Vec<Standing> = results.iter().map(standing).collect();
    standings.sort_by_key(|standing| (std::cmp::Reverse(standing.points), standing.member));
    standings
}

/// A member's finish.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Finish {
    /// The place, from 1. Members who reach the exit in the same step share a place.
    pub(crate) place: usize,
    /// The steps from the start to the exit.
    pub(crate) steps: u64,
}

/// The finish times, in modes that end at the exit: races, and the campaign, alone or together.
#[derive(Clone, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
struct Finishes {
    begun: u64,
    /// The steps to the exit. Members who have left since are included.
    times: BTreeMap<MemberId, u64>,
}

impl Finishes {
    fn role(&self, member: MemberId) -> Role {
        if self.times.contains_key(&member) { Role::Done } else { Role::Player }
    }

    fn of(&self, member: MemberId) -> Option<Finish> {
        let steps = *self.times.get(&member)?;
        let before = self.times.values().filter(|&&other| other < steps).count();
        Some(Finish { place: before + 1, steps })
    }

    /// The members who finished in `step`.
    fn in_step(&self, step: u64) -> impl Iterator<Item = MemberId> {
        let finished = self.times.iter().filter(move |(_, time)| self.begun + **time == step);
        finished.map(|(&member, _)| member)
    }

    /// The step in which the first member finished.
    fn first(&self) -> Option<u64> {
        self.times.values().min().map(|time| self.begun + time)
    }

    /// Records the members at the exit; returns whether all have finished.
    fn step(&mut self, field: Field) -> bool {
        let time = field.step - self.begun;
        for id in field.ids().filter(|&id| field.has_won(id)) {
            self.times.entry(id).or_insert(time);
        }
        field.ids().all(|id| self.times.contains_key(&id))
    }
}

impl Finish {
    /// The place as an ordinal.
    pub(crate) fn ordinal(self) -> String {
        ordinal(self.place)
    }

    /// The time to the exit, formatted for display.
    pub(crate) fn time(self) -> String {
        of_steps(self.steps)
    }
}

/// A place as an ordinal: 1st, 2nd and so on.
pub(crate) fn ordinal(place: usize) -> String {
    let ending = match (place % 10, place % 100) {
        (_, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{place}{ending}")
}

impl fmt::Display for Finish {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {}", self.ordinal(), self.time())
    }
}

/// The state of a round of tag. One member is "it" until they touch another member.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Tag {
    it: Option<MemberId>,
    /// The step in which "it" last changed.
    since: u64,
    /// The previous "it".
    before: Option<MemberId>,
    /// How long each member was "it", in steps.
    times: BTreeMap<MemberId, u64>,
}

impl Tag {
    /// Chooses the first "it".
    fn choose(&mut self, field: Field, chance: &mut SplitMix64) {
        let ids: Vec<MemberId> = field.ids().collect();
        self.it = ids.get(chance.below(ids.len())).copied();
        self.since = field.step;
    }

    fn role(&self, member: MemberId) -> Role {
        if self.it == Some(member) { Role::Seeker } else { Role::Player }
    }

    /// Returns true while a member stands still because they have just become "it".
    fn holds(&self, member: MemberId, step: u64) -> bool {
        self.it == Some(member) && step < self.since + PAUSE
    }

    /// Returns true while a member cannot be touched because they have just been "it".
    fn spares(&self, member: MemberId, step: u64) -> bool {
        self.before == Some(member)
            && self.it != Some(member)
            && step < self.since.saturating_add(SPARED)
    }

    fn step(&mut self, field: Field) {
        let Some(it) = self.it.filter(|&it| field.member(it).is_some()) else {
            // The member who was "it" has left. The member with the longest time follows, so that nobody gains by it.
            let longest = field.ids().max_by_key(|id| self.time(*id));
            return self.become_it(longest, field.step);
        };
        *self.times.entry(it).or_default() += 1;
        if self.holds(it, field.step) {
            return;
        }
        let can_be_touched = |id| id != it && !self.spares(id, field.step);
        let touched = field.ids().find(|&id| can_be_touched(id) && field.touches(it, id));
        if touched.is_some() {
            self.become_it(touched, field.step);
        }
    }

    fn become_it(&mut self, next: Option<MemberId>, step: u64) {
        self.before = self.it;
        self.it = next;
        self.since = step;
    }

    /// How long a member was "it". The shortest time wins.
    fn time(&self, id: MemberId) -> u64 {
        self.times.get(&id).copied().unwrap_or(0)
    }
}

/// The state of a round of hide and seek. Found members become seekers.
#[derive(Clone, Debug, PartialEq, Default, Serialize, Deserialize)]
struct Hide {
    /// The seekers, with the number of steps that they stayed hidden; `None` for the first seekers.
    seekers: BTreeMap<MemberId, Option<u64>>,
    /// The step in which the search began.
    since: Option<u64>,
}

impl Hide {
    /// Chooses the first seekers.
    fn choose(&mut self, field: Field, chance: &mut SplitMix64) {
        let mut ids: Vec<MemberId> = field.ids().collect();
        let count = ids.len().div_ceil(MEMBERS_A_SEEKER).min(ids.len().saturating_sub(1));
        for _ in 0..count {
            let chosen = ids.remove(chance.below(ids.len()));
            self.seekers.insert(chosen, None);
        }
    }

    fn role(&self, member: MemberId) -> Role {
        if self.seekers.contains_key(&member) { Role::Seeker } else { Role::Player }
    }

    /// Finds the hidden members that a seeker touches. Returns true once the round is decided: all are found,
    /// or no seeker is left.
    fn step(&mut self, field: Field) -> bool {
        let since = *self.since.get_or_insert(field.step);
        let is_seeker = |id: &MemberId| self.seekers.contains_key(id);
        let (seekers, hidden): (Vec<MemberId>, Vec<MemberId>) = field.ids().partition(is_seeker);
        let is_found = |id: &&MemberId| seekers.iter().any(|&seeker| field.touches(seeker, **id));
        let found: Vec<MemberId> = hidden.iter().filter(is_found).copied().collect();
        let left = hidden.len() - found.len();
        self.seekers.extend(found.into_iter().map(|id| (id, Some(field.step - since))));
        left == 0 || seekers.is_empty()
    }

    /// How long a member has stayed hidden by `step`. The first seekers never hid.
    fn time(&self, id: MemberId, step: u64) -> u64 {
        let found = self.seekers.get(&id).map(|found| found.unwrap_or(0));
        found.unwrap_or(step - self.since.unwrap_or(step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_member_beaten_scores_a_point() {
        let results = [(1, 50), (2, 30), (3, 50), (4, 90)];
        let results = results.map(|(id, steps)| (MemberId(id), Some(steps)));
        let standings = standings(Mode::Tag, &results);
        let places: Vec<_> =
            standings.iter().map(|it| (it.member.0, it.points, it.steps)).collect();
        let expected = [(2, 3, 30), (1, 1, 50), (3, 1, 50), (4, 0, 90)];
        assert_eq!(places, expected.map(|(id, points, steps)| (id, points, Some(steps))));
    }

    #[test]
    fn places_are_written_as_ordinals() {
        let finish = |place| Finish { place, steps: 231 }.to_string();
        let told = [1, 2, 3, 4, 11, 12, 13, 21, 112].map(finish);
        let expected = ["1st", "2nd", "3rd", "4th", "11th", "12th", "13th", "21st", "112th"];
        assert_eq!(told, expected.map(|place| format!("{place}, 0:03.8")));
    }
}
