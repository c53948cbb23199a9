//! The ceremony of rounds: the large text in the middle of the picture, the picture's edge, and the line of finishers.
//! All of it is derived from snapshots of the room.

use crate::rooms::room::{Finish, MemberId, MemberView, Mode, Phase, Role, RoomView, SECOND};

/// The number of seconds that are counted down large.
const COUNTED: u64 = 3;
/// How long the place of a finisher is shown large, in steps.
const FINISHED: u64 = 2 * SECOND;
/// How long a new role is shown large, in steps.
const NEW_ROLE: u64 = SECOND;
/// How long a line in the picture says who has finished, in steps.
const ANNOUNCED: u64 = 5 * SECOND;
/// The distances to the nearest seeker, in cells, below which the edge of a hidden player's picture warns, from
/// cold to hot.
const WARMTH: [f64; 4] = [12.0, 8.0, 5.0, 3.0];

/// A visitor's part in the ceremony of a round.
#[derive(Debug, Default)]
pub(crate) struct Ceremony {
    counts_down: bool,
    /// The step since when the visitor has been the seeker; `None` if they are not.
    seeker_since: Option<u64>,
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
