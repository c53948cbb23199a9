//! How a room goes on while the bus does not answer, and what its members are told of it.

use std::time::Duration;

use tokio::time::Instant;

use super::Replica;

/// The time without steps after which members are told.
pub(crate) const STANDSTILL: Duration = Duration::from_millis(1_500);

/// How the room goes on.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Progress {
    Usual,
    Waiting,
    Alone,
}

impl Progress {
    /// What members read when it begins.
    const fn sentence(self) -> &'static str {
        match self {
            Self::Usual => "The hosts of this room reach each other again.",
            Self::Waiting => "The hosts of this room do not reach each other; the game waits.",
            Self::Alone => "Other hosts are out of reach; the game goes on alone.",
        }
    }
}

impl Replica {
    /// Tells members when the room begins to wait, goes on alone, or goes on as usual.
    pub(crate) fn tell(&mut self, now: Instant) {
        let has_members = self.state.room().len() > 0 && !self.interface.inbox.seated().is_empty();
        let waits = has_members && now.duration_since(self.times.moved) >= STANDSTILL;
        let progress = match &self.alone {
            _ if waits => Progress::Waiting,
            Some(_) => Progress::Alone,
            None => Progress::Usual,
        };
        if progress != self.told {
            self.told = progress;
            self.context.tell(self.id, progress.sentence());
        }
    }
}
