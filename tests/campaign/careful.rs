//! A search for a script that wins: best-first over the player's next moves, on copies of the game.
//!
//! The estimate of a state consists of its steps, its cost in health and alarms, and the walking
//! that is left. A move is played only when its estimate is the lowest, so a level without
//! resistance takes as many moves as its route has stretches. Rejected: a search by random play. It
//! only finds ways out of small rooms.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};
use std::rc::Rc;

use cellcaster::game::{Game, Intent, Mood, Outcome};
use cellcaster::world::{Cell, ThingKind};

use crate::pilot::{Pace, Pilot};
use crate::route::{Errand, Verb};
use crate::temper::{TEMPERS, Temper};
use crate::ways::Ways;

/// The estimated steps of an errand, apart from the walk to it.
const ERRAND: u64 = 100;
/// The steps of walking one cell, which has a cost of ten.
const CELL: u64 = 20;

/// A move of the player.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Move {
    Walk,
    Shun,
    Run,
    Flee,
    Duck,
    Pause,
    Wait,
    WaitLong,
    Strike,
    Retreat,
}

impl Move {
    const ALL: [Self; 10] = [
        Self::Walk,
        Self::Shun,
        Self::Run,
        Self::Flee,
        Self::Duck,
        Self::Pause,
        Self::Wait,
        Self::WaitLong,
        Self::Strike,
        Self::Retreat,
    ];

    /// Returns whether the move is made by tapping walking keys.
    fn is_tapped(self) -> bool {
        matches!(self, Self::Walk | Self::Shun | Self::Pause | Self::Wait | Self::WaitLong)
    }

    /// The surcharge of the move on the estimate before it is played.
    fn surcharge(self) -> u64 {
        match self {
            Self::Walk => 0,
            Self::Shun => 8,
            Self::Run => 16,
            Self::Flee => 24,
            Self::Duck => 30,
            Self::Pause => 18,
            Self::Wait => 45,
            Self::WaitLong => 160,
            Self::Strike => 40,
            Self::Retreat => 60,
        }
    }
}

/// A state of the search.
struct State {
    pilot: Pilot,
    /// The number of completed errands.
    done: usize,
    toll: u64,
}

/// The winning game that completes `errands`, starting from the state of `pilot`.
///
/// # Errors
/// The progress of each temper, if none wins.
pub(crate) fn search(pilot: &Pilot, errands: &[Errand]) -> Result<Pilot, String> {
    let mut failures = String::new();
    for temper in TEMPERS {
        match search_with(pilot.clone(), errands, temper) {
            Ok(pilot) => return Ok(pilot),
            Err(failure) => failures.push_str(&failure),
        }
    }
    Err(failures)
}

fn search_with(pilot: Pilot, errands: &[Errand], temper: Temper) -> Result<Pilot, String> {
    let (waiting, states, seen) = (BinaryHeap::new(), Vec::new(), BTreeSet::new());
    let after_errand = after_errands(&pilot.game, errands);
    let mut search = Search { errands, after_errand, temper, waiting, states, seen };
    search.add(State { pilot, done: 0, toll: 0 });
    for _ in 0..temper.most_moves {
        let Some((Reverse(_), Reverse(way), index)) = search.waiting.pop() else { break };
        let state = Rc::clone(&search.states[index]);
        let Some(next) = search.after(&state, way) else { continue };
        if next.pilot.game.outcome() == Outcome::Won {
            return Ok(next.pilot);
        }
        search.add(next);
    }
    Err(search.failure())
}

struct Search<'a> {
    errands: &'a [Errand],
    /// For each errand, the estimated steps that are left after it.
    after_errand: Vec<u64>,
    temper: Temper,
    waiting: BinaryHeap<(Reverse<u64>, Reverse<Move>, usize)>,
    states: Vec<Rc<State>>,
    seen: BTreeSet<(usize, Cell, u64, u32)>,
}

impl Search<'_> {
    /// Adds the moves from a state, unless a similar state is known.
    fn add(&mut self, state: State) {
        let steps = state.pilot.steps();
        let health = u32::from(state.pilot.game.health().points);
        let grain = if is_near_spikes(&state.pilot) { 12 } else { 40 };
        if !self.seen.insert((state.done, state.pilot.cell(), steps / grain, health)) {
            return;
        }
        let taps = state.pilot.taps();
        let estimate = steps + state.toll + self.left(&state) * self.temper.weight / 2;
        let index = self.states.len();
        self.states.push(Rc::new(state));
        for way in Move::ALL.into_iter().filter(|way| way.is_tapped() || !taps) {
            self.waiting.push((Reverse(estimate + way.surcharge()), Reverse(way), index));
        }
    }

    /// Describes the state that made the most progress.
    fn failure(&self) -> String {
        let farthest = self.states.iter().min_by_key(|state| self.left(state));
        let Some(state) = farthest else { return String::new() };
        let (cell, health) = (state.pilot.cell(), state.pilot.game.health().points);
        let (count, steps) = (self.states.len(), state.pilot.steps());
        let left = self.left(state);
        format!(
            "\n  {count} states; errand {}, {cell:?}, {steps} steps, {left} left, health {health}",
            state.done
        )
    }

    /// The estimated steps that are left.
    fn left(&self, state: &State) -> u64 {
        let Some(ways) = self.ways(state, |_| 0) else { return 0 };
        let next = walk(&ways, state.pilot.cell(), self.errands[state.done].cell);
        next + self.after_errand[state.done]
    }

    /// The ways to the next errand.
    fn ways(&self, state: &State, dread: impl Fn(Cell) -> u32) -> Option<Ways> {
        let errand = self.errands.get(state.done)?;
        Some(match errand.verb {
            Verb::Go => Ways::new(&state.pilot.game, errand.cell, dread),
            Verb::Open => Ways::beside(&state.pilot.game, errand.cell, dread),
            Verb::Hop | Verb::Straight | Verb::Throw => {
                Ways::new(&state.pilot.game, state.pilot.cell(), dread)
            }
        })
    }

    /// The state after a move; `None` if the move makes no sense there or kills the player.
    fn after(&self, state: &State, way: Move) -> Option<State> {
        let mut pilot = state.pilot.clone();
        let mut done = state.done;
        match way {
            Move::Pause if is_near_spikes(&pilot) => pilot.wait(12),
            Move::Pause => return None,
            Move::Wait => pilot.wait(40),
            Move::WaitLong => pilot.wait(150),
            Move::Strike => strike(&mut pilot)?,
            Move::Retreat => self.retreat(state, &mut pilot)?,
            Move::Walk => done += self.errand(state, &mut pilot, Pace::Walk, 40, |_| 0)?,
            Move::Run => done += self.errand(state, &mut pilot, Pace::Run, 24, |_| 0)?,
            Move::Duck => done += self.errand(state, &mut pilot, Pace::Duck, 60, |_| 0)?,
            Move::Shun | Move::Flee => {
                let feared = feared(&pilot.game);
                if feared.is_empty() {
                    return None;
                }
                let dread = |cell| dread(&feared, cell);
                let (pace, steps) =
                    if way == Move::Shun { (Pace::Walk, 40) } else { (Pace::Run, 24) };
                done += self.errand(state, &mut pilot, pace, steps, dread)?;
            }
        }
        let toll = state.toll + self.temper.toll(&state.pilot.game, &pilot.game);
        let is_alive = !matches!(pilot.game.outcome(), Outcome::Dead { .. });
        is_alive.then_some(State { pilot, done, toll })
    }

    /// Runs back towards the last errand, away from guards who follow. `None` if no guard follows.
    fn retreat(&self, state: &State, pilot: &mut Pilot) -> Option<()> {
        pilot.game.guards().find(|guard| matches!(guard.mood, Mood::Chasing | Mood::Attacking))?;
        let last = self.errands[..state.done].last();
        let home = last.map_or(pilot.game.world().start().cell, |errand| errand.cell);
        pilot.go(&Ways::beside(&pilot.game, home, |_| 0), Pace::Run, 60);
        Some(())
    }

    /// Continues with the next errand. Returns the number of errands that this completes, 0 or 1.
    fn errand(
        &self,
        state: &State,
        pilot: &mut Pilot,
        pace: Pace,
        steps: u32,
        dread: impl Fn(Cell) -> u32,
    ) -> Option<usize> {
        let errand = self.errands.get(state.done)?;
        match errand.verb {
            Verb::Hop => return pilot.hop(errand.cell, errand.height).then_some(1),
            Verb::Straight => return pilot.straight(errand.cell).then_some(1),
            Verb::Throw => {
                pilot.act_towards(errand.cell, Intent::Throw);
                return Some(1);
            }
            Verb::Go | Verb::Open => {}
        }
        let ways = self.ways(state, dread)?;
        if ways.cost(pilot.cell()) == u32::MAX {
            return None;
        }
        let has_arrived = pilot.go(&ways, pace, steps);
        if has_arrived && errand.verb == Verb::Open {
            pilot.open(errand.cell);
        }
        Some(usize::from(has_arrived))
    }
}

/// For each errand, the estimated steps that are left after it: the walks from each errand to the
/// next in the first state of the game. The estimate does not jump at the end of an errand.
/// Otherwise the search would turn back to states before that point.
fn after_errands(game: &Game, errands: &[Errand]) -> Vec<u64> {
    let walks = errands.windows(2).map(|pair| {
        ERRAND + walk(&Ways::beside(game, pair[1].cell, |_| 0), pair[0].cell, pair[1].cell)
    });
    let walks: Vec<u64> = walks.chain([0]).collect();
    (0..errands.len()).map(|index| walks[index..].iter().sum()).collect()
}

/// The steps of walking along `ways`. If they lead nowhere yet, returns the steps of one and a half
/// times the straight line.
fn walk(ways: &Ways, from: Cell, to: Cell) -> u64 {
    let cost = match ways.cost(from) {
        u32::MAX => (from.center() - to.center()).length() * 15.0,
        cost => f64::from(cost),
    };
    cost as u64 * CELL / 10
}

/// The guards who are awake and on their feet, with their positions and viewing directions.
fn feared(game: &Game) -> Vec<(glam::DVec2, glam::DVec2)> {
    let awake = game.guards().filter(|guard| !guard.is_down && guard.mood != Mood::Asleep);
    awake.map(|guard| (guard.position, guard.heading.direction())).collect()
}

/// The additional cost of a cell near guards or in front of them.
pub(crate) fn dread(feared: &[(glam::DVec2, glam::DVec2)], cell: Cell) -> u32 {
    let cost = |&(position, ahead): &(glam::DVec2, glam::DVec2)| {
        let to = cell.center() - position;
        let distance = to.length();
        let is_before = ahead.dot(to) > 0.4 * distance;
        if distance < 2.0 || is_before && distance < 8.0 { 60 } else { 0 }
    };
    feared.iter().map(cost).sum()
}

/// Strikes the nearest guard within reach, if there is one.
fn strike(pilot: &mut Pilot) -> Option<()> {
    let position = pilot.position();
    let standing = pilot.game.guards().filter(|guard| !guard.is_down);
    let near = standing.map(|guard| guard.position).find(|at| at.distance(position) < 1.1)?;
    pilot.face_point(near);
    pilot.press(Intent::Strike);
    pilot.wait(6);
    Some(())
}

/// Returns whether there are spikes close to the player.
fn is_near_spikes(pilot: &Pilot) -> bool {
    let Cell { column, row } = pilot.cell();
    let world = pilot.game.world();
    let around = (row.saturating_sub(2)..=row + 2).flat_map(|row| {
        (column.saturating_sub(2)..=column + 2).map(move |column| Cell { column, row })
    });
    let mut things = around.flat_map(|cell| world.things_in(cell));
    things.any(|thing| matches!(thing.kind, ThingKind::Spikes(_)))
}
