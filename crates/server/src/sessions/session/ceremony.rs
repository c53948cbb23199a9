//! The ceremony of rounds: the large text in the middle of the picture, the picture's edge, and the sentence about a
//! racer who passes another.
//!
//! All of it is derived from snapshots of the room. Places come from the room with every snapshot, which takes
//! one look-up for each member. They are compared four times a second, so that two racers side by side do not
//! pass each other in every frame.

use std::cmp::Ordering;

use crate::line::Line;
use crate::rooms::room::{Finish, MemberId, MemberView, Mode, Phase, Role, RoomView, SECOND};

/// The number of seconds that are counted down large.
const COUNTED: u64 = 3;
/// How long the place of a finisher is shown large, in steps.
const FINISHED: u64 = 2 * SECOND;
/// How long a new role is shown large, in steps.
const NEW_ROLE: u64 = SECOND;
/// How long a line in the picture says who has finished, in steps.
const ANNOUNCED: u64 = 5 * SECOND;
/// The number of steps between two comparisons of places, and how long the result is shown, in steps.
const COMPARED: u64 = SECOND / 4;
const PASSED: u64 = 2 * SECOND;
/// The distances to the nearest seeker, in cells, below which the edge of a hidden player's picture warns, from
/// cold to hot.
const WARMTH: [f64; 4] = [12.0, 8.0, 5.0, 3.0];

/// A visitor's part in the ceremony of a round.
#[derive(Debug, Default)]
pub(crate) struct Ceremony {
    counts_down: bool,
    /// The step since when the visitor has been the seeker; `None` if they are not.
    seeker_since: Option<u64>,
    /// The period of the last comparison, and the racers who were ahead then; `None` before the first.
    compared: Option<(u64, Vec<MemberId>)>,
    /// The latest pass, and the step until which it is shown.
    passed: Option<(Pass, u64)>,
}

/// One racer passes another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Pass {
    /// The name of the other racer.
    pub(crate) name: Line,
    /// Whether the visitor passes the other racer.
    pub(crate) gains: bool,
}

/// The edge of the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    Plain,
    /// The visitor is "it", or seeks.
    Seeker,
    /// A hidden visitor is near a seeker: from 1 to 4 quarters of the edge.
    Near(usize),
}

impl Ceremony {
    /// Follows a snapshot, as the member `own` or as a watcher. Returns true when the play begins.
    pub(crate) fn look_at(&mut self, room: &RoomView, own: Option<MemberId>) -> bool {
        let counts_down = matches!(room.phase, Phase::Countdown { .. });
        let begins = self.counts_down && matches!(room.phase, Phase::Playing { .. });
        self.counts_down = counts_down;
        let own = own.and_then(|id| room.member(id));
        let seeks = own.is_some_and(|member| member.role == Role::Seeker);
        self.seeker_since = seeks.then(|| self.seeker_since.unwrap_or(room.step));
        self.compare(room, own);
        begins
    }

    /// The text in large letters, at most three of them; `None` for none.
    pub(crate) fn large(&self, room: &RoomView, own: Option<&MemberView>) -> Option<String> {
        let mode = room.header.mode;
        match room.phase {
            Phase::Countdown { ends } => {
                let seconds = ends.saturating_sub(room.step).div_ceil(SECOND);
                let is_blind = own.is_some_and(|member| member.is_blind);
                let is_counted = (1..=COUNTED).contains(&seconds) && !is_blind;
                is_counted.then(|| seconds.to_string())
            }
            Phase::Playing { .. } => {
                let played = room.played()?;
                let finish = own.and_then(|member| member.finish).filter(|_| mode == Mode::Race);
                let is_new = |since: u64| room.step < since.saturating_add(NEW_ROLE);
                if let Some(finish) =
                    finish.filter(|finish| played < finish.steps.saturating_add(FINISHED))
                {
                    Some(finish.ordinal().to_uppercase())
                } else if self.seeker_since.is_some_and(is_new) {
                    Some(if mode == Mode::Tag { "IT" } else { "SEEK" }.to_owned())
                } else {
                    (mode.countdown() > 0 && played < SECOND).then(|| "GO".to_owned())
                }
            }
            Phase::Waiting | Phase::Over { .. } => None,
        }
    }

    /// The latest pass, while it is shown.
    pub(crate) fn passed(&self, room: &RoomView) -> Option<&Pass> {
        let (pass, until) = self.passed.as_ref()?;
        (room.step < *until).then_some(pass)
    }

    /// Compares the visitor's place in a race with the places of the others. Racers who share a place stay in
    /// the order of the last comparison.
    fn compare(&mut self, room: &RoomView, own: Option<&MemberView>) {
        let Some(own) = own.filter(|own| own.finish.is_none() && own.place.is_some()) else {
            (self.compared, self.passed) = (None, None);
            return;
        };
        let period = room.step / COMPARED;
        let before = self.compared.as_ref();
        if before.is_some_and(|before| before.0 == period) {
            return;
        }
        let was_ahead = |id| before.is_some_and(|(_, ahead)| ahead.contains(&id));
        let is_ahead = |other: &MemberView| match other.place.cmp(&own.place) {
            Ordering::Less => true,
            Ordering::Equal => was_ahead(other.id),
            Ordering::Greater => false,
        };
        let others = || room.members.iter().filter(|other| other.id != own.id);
        let has_changed =
            |other: &&MemberView| other.finish.is_none() && was_ahead(other.id) != is_ahead(other);
        if let Some(other) = others().find(has_changed).filter(|_| before.is_some()) {
            let pass = Pass { name: other.name.clone(), gains: !is_ahead(other) };
            self.passed = Some((pass, room.step.saturating_add(PASSED)));
        }
        let ahead = others().filter(|other| is_ahead(other)).map(|other| other.id).collect();
        self.compared = Some((period, ahead));
    }
}

/// The edge of the picture through the eyes of `member`.
pub(crate) fn edge(room: &RoomView, member: &MemberView) -> Edge {
    let is_on = matches!(room.phase, Phase::Countdown { .. } | Phase::Playing { .. });
    match (member.role, room.header.mode) {
        _ if !is_on => Edge::Plain,
        (Role::Seeker, _) => Edge::Seeker,
        (Role::Player, Mode::Hide) if room.played().is_some() => warmth(room, member),
        _ => Edge::Plain,
    }
}

/// The nearness of the nearest seeker to a hidden member.
fn warmth(room: &RoomView, hidden: &MemberView) -> Edge {
    let position = |member: &MemberView| Some(room.game.seen_by(member.player?)?.position());
    let Some(own) = position(hidden) else { return Edge::Plain };
    let seekers = room.members.iter().filter(|member| member.role == Role::Seeker);
    let nearest = seekers.filter_map(position).map(|it| it.distance(own)).reduce(f64::min);
    let quarters = WARMTH.iter().filter(|&&limit| nearest.is_some_and(|it| it < limit)).count();
    if quarters > 0 { Edge::Near(quarters) } else { Edge::Plain }
}

/// The latest finishers of a race, best first, while a line says so.
pub(crate) fn finishers(room: &RoomView) -> Vec<(Finish, &MemberView)> {
    let played = room.played().filter(|_| room.header.mode == Mode::Race);
    let is_new =
        |finish: &Finish| played.is_some_and(|it| it < finish.steps.saturating_add(ANNOUNCED));
    let finished = room.members.iter().filter_map(|member| Some((member.finish?, member)));
    let mut finishers: Vec<_> = finished.filter(|(finish, _)| is_new(finish)).collect();
    finishers.sort_by_key(|(finish, member)| (finish.place, member.id));
    finishers
}
