//! Rounds: the phases of what is played in a room, and its standings.
//!
//! A round waits for enough members, counts down, is played, and shows its standings; then the next
//! one begins. Time is counted in steps, and chance comes from the room's seed, so that the log
//! alone determines who wins.
//!
//! A member gains a point for each other one whom they beat in a round. Points for a place were
//! refused: with two members, the first of them would be worth as much as with eight.

mod finishes;
mod hide;
mod tag;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

pub(crate) use self::finishes::Finish;
use self::finishes::Finishes;
use self::hide::Hide;
use self::tag::Tag;
use super::entry::MemberId;
use super::member::Member;
use super::mode::Mode;
use cellcaster::game::stored::{Unrestorable, check};
use cellcaster::game::{Game, Outcome, PlayerId};
use cellcaster::rng::SplitMix64;

/// Steps of a game in a second.
pub(crate) const SECOND: u64 = 60;
/// How long the standings are shown.
const STANDINGS: u64 = 10 * SECOND;

/// The phase of a round. Times are steps of the round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Phase {
    /// There are not enough members; they walk about.
    Waiting,
    /// The play begins at `ends`.
    Countdown { ends: u64 },
    /// The play ends at `ends` at the latest.
    Playing { ends: u64 },
    /// The standings are shown until `ends`.
    Over { ends: u64 },
}

/// What a member is in a round.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(crate) enum Role {
    /// One of many.
    #[default]
    Player,
    /// Who is "it", or seeks.
    Seeker,
    /// At the exit, or found last.
    Done,
}

/// A member's place in the standings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Standing {
    pub(crate) member: MemberId,
    /// The points that the round gives.
    pub(crate) points: u32,
    /// What counts in the mode, in steps: the time to the exit, as "it", or hidden. `None` for a member who did not
    /// finish.
    pub(crate) steps: Option<u64>,
}

/// What a mode sees of its room.
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

    /// Whether `one` touches `other`, in the picture that `one` saw.
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

/// A round.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Round {
    mode: Mode,
    phase: Phase,
    play: Play,
    chance: SplitMix64,
    standings: Vec<Standing>,
}

/// What a mode remembers of a round.
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

    /// Refuses a round of another mode, what another mode remembers, and what begins after `step`.
    pub(crate) fn check(&self, mode: Mode, step: u64) -> Result<(), Unrestorable> {
        check(self.mode == mode, "the mode")?;
        let is_possible = match (&self.play, self.mode) {
            (Play::Roam, Mode::Roam) => true,
            (Play::ToExit(finishes), Mode::Together | Mode::Alone | Mode::Race) => {
                finishes.begun() <= step
            }
            (Play::Tag(tag), Mode::Tag) => tag.begins_until(step),
            (Play::Hide(hide), Mode::Hide) => hide.begins_until(step),
            _ => false,
        };
        check(is_possible, "what is played")
    }

    pub(crate) fn phase(&self) -> Phase {
        self.phase
    }

    /// The standings, the winner first; empty before the end.
    pub(crate) fn standings(&self) -> &[Standing] {
        &self.standings
    }

    /// Whether the next round is due.
    pub(crate) fn is_over(&self, step: u64) -> bool {
        matches!(self.phase, Phase::Over { ends } if ends <= step)
    }

    /// What a member is.
    pub(crate) fn role(&self, member: MemberId) -> Role {
        match &self.play {
            Play::Roam => Role::Player,
            Play::ToExit(finishes) => finishes.role(member),
            Play::Tag(tag) => tag.role(member),
            Play::Hide(hide) => hide.role(member),
        }
    }

    /// The finish of a member, if they have reached the exit.
    pub(crate) fn finish(&self, member: MemberId) -> Option<Finish> {
        self.finishes()?.of(member)
    }

    /// The members who have finished in `step`.
    pub(crate) fn finished_in(&self, step: u64) -> impl Iterator<Item = MemberId> {
        self.finishes().into_iter().flat_map(move |finishes| finishes.in_step(step))
    }

    /// The step in which the play began, while it goes on in a mode that ends at the exit.
    pub(crate) fn begun(&self) -> Option<u64> {
        let is_played = matches!(self.phase, Phase::Playing { .. });
        self.finishes().filter(|_| is_played).map(Finishes::begun)
    }

    fn finishes(&self) -> Option<&Finishes> {
        if let Play::ToExit(finishes) = &self.play { Some(finishes) } else { None }
    }

    /// Whether a member cannot walk at present.
    pub(crate) fn holds(&self, member: MemberId, step: u64) -> bool {
        match (&self.play, self.phase) {
            (_, Phase::Waiting | Phase::Countdown { .. }) if self.mode == Mode::Race => true,
            (Play::Hide(hide), Phase::Countdown { .. }) => hide.role(member) == Role::Seeker,
            (Play::Tag(tag), Phase::Playing { .. }) => tag.holds(member, step),
            _ => false,
        }
    }

    /// Whether a member sees nothing at present.
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
            finishes.begin(field.step);
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

    /// The step in which the round ends at the latest, once the first member has finished.
    fn last_step(&self) -> Option<u64> {
        Some(self.finishes()?.first()? + self.mode.after_first()?)
    }

    fn end(&mut self, field: Field) {
        let scores = match &self.play {
            Play::Roam => BTreeMap::new(),
            Play::ToExit(finishes) => finishes.scores(self.mode, field),
            Play::Tag(tag) => tag.scores(field),
            Play::Hide(hide) => hide.scores(field),
        };
        self.standings = standings(&scores);
        self.phase = Phase::Over { ends: field.step + STANDINGS };
    }
}

/// What counts in a round: the lower rank wins, and the steps are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Score {
    rank: u64,
    steps: Option<u64>,
}

/// The standings from `scores`. Members of the same rank have the same points.
fn standings(scores: &BTreeMap<MemberId, Score>) -> Vec<Standing> {
    let beaten = |score: &Score| scores.values().filter(|other| other.rank > score.rank).count();
    let standing = |(&member, score): (&MemberId, &Score)| Standing {
        member,
        points: beaten(score) as u32,
        steps: score.steps,
    };
    let mut standings: Vec<Standing> = scores.iter().map(standing).collect();
    standings.sort_by_key(|standing| (std::cmp::Reverse(standing.points), standing.member));
    standings
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_a_member_beaten() {
        let score = |(id, rank)| (MemberId(id), Score { rank, steps: Some(rank * 10) });
        let scores = [(1, 5), (2, 3), (3, 5), (4, 9)].map(score).into_iter().collect();
        let places: Vec<_> =
            standings(&scores).iter().map(|it| (it.member.0, it.points, it.steps)).collect();
        let expected = [(2, 3, 30), (1, 1, 50), (3, 1, 50), (4, 0, 90)];
        assert_eq!(places, expected.map(|(id, points, steps)| (id, points, Some(steps))));
    }
}
