//! The replay of a round's last seconds through the winner's eyes.
//!
//! While a round is played, the room records the members' cameras and the figures 20 times a second, for the
//! last five seconds: about 12 kB for each member. The replay draws the level as it is now from those cameras
//! with those figures, so doors that have moved since are shown as they are now. Rejected: a second game that
//! replays the log. It would step another game for each room whose round has ended.
//!
//! A recording is not part of the room's state: neither the checksum nor a checkpoint contains it. In a room
//! that was restored from a checkpoint, it begins at the checkpoint.

use std::collections::VecDeque;

use super::MemberId;
use crate::line::Line;
use cellcaster::world::{Camera, Figure};

/// The number of steps between two recorded moments.
const STEPS_A_MOMENT: u64 = 3;
/// The maximum number of recorded moments. Their five seconds are shown twice with the standings.
const MAX_MOMENTS: usize = 100;
/// The maximum number of figures in a moment. Players come last in a game's figures, so they are included.
const MAX_FIGURES: usize = 32;

/// The latest moments of a round.
#[derive(Clone, Debug, Default)]
pub(crate) struct MomentRecorder {
    moments: VecDeque<RecordedMoment>,
}

#[derive(Clone, Debug, Default)]
struct RecordedMoment {
    cameras: Vec<(MemberId, Camera)>,
    figures: Vec<Figure>,
}

/// The last seconds of a round.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RoundReplay {
    /// The name of the member through whose eyes it is shown.
    pub(crate) name: Line,
    moments: Box<[Moment]>,
}

/// A moment of a replay.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Moment {
    pub(crate) camera: Camera,
    pub(crate) figures: Vec<Figure>,
}

impl MomentRecorder {
    /// Returns true if the moment after `step` is recorded.
    pub(crate) fn is_due(step: u64) -> bool {
        step.is_multiple_of(STEPS_A_MOMENT)
    }

    pub(crate) fn record(
        &mut self,
        cameras: impl Iterator<Item = (MemberId, Camera)>,
        figures: &[Figure],
    ) {
        let is_full = self.moments.len() >= MAX_MOMENTS;
        let oldest = if is_full { self.moments.pop_front() } else { None };
        let mut moment = oldest.unwrap_or_default();
        moment.cameras.clear();
        moment.cameras.extend(cameras);
        moment.figures.clear();
        let first = figures.len().saturating_sub(MAX_FIGURES);
        moment.figures.extend_from_slice(&figures[first..]);
        self.moments.push_back(moment);
    }

    /// The replay through the eyes of `member`; `None` if they were not recorded.
    pub(crate) fn replay(&mut self, member: MemberId, name: Line) -> Option<RoundReplay> {
        let moments = std::mem::take(&mut self.moments).into_iter().filter_map(|moment| {
            let (_, camera) = *moment.cameras.iter().find(|it| it.0 == member)?;
            Some(Moment { camera, figures: moment.figures })
        });
        let moments: Box<[Moment]> = moments.collect();
        (!moments.is_empty()).then_some(RoundReplay { name, moments })
    }
}

impl RoundReplay {
    /// The moment to show `steps` steps after the end of the round. The replay repeats.
    pub(crate) fn moment(&self, steps: u64) -> &Moment {
        let count = self.moments.len() as u64;
        &self.moments[(steps / STEPS_A_MOMENT % count) as usize]
    }
}
