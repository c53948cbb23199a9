//! Stations: a room on one host of a cluster.
//!
//! A station has the room as a [`Replica`], shows it to the host's own members and watchers, and passes on
//! what its members want. One of the stations of a room has its [`Office`] as well, and is the sequencer.
//!
//! # Rules
//!
//! - A station applies what the log has, and nothing else; the sequencer its own messages as well.
//! - Twice in [`BEAT`] the room takes a step; a message has both. So what a member wants waits for half of
//!   [`BEAT`] longer than
//!   in a room of one process, and for the way to the log.
//! - A station that hears nothing for [`SILENCE`] reads the log, and asks for the lease.
//! - A member is in the room when the log says so, and not before.
//! - Whoever is not claimed by a host for a while is removed. A host that is gone claims nobody.
//! - If nothing can be appended to the log, the room waits, and its members are told. Rooms that go on for one
//!   host alone were refused: two halves of a cluster would each have a round of their own to end.

mod guests;
mod reading;
mod sequencing;

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until};

pub(super) use self::guests::Asked;
use self::guests::Guest;
use super::Company;
use super::desk::Reply;
use super::office::Office;
use super::record::Record;
use super::replica::Replica;
use super::talk::Talk;
use crate::server::sequencer::{Doorway, STEP};
use crate::server::summary::RoomId;
use crate::store::host::Lease;

/// The time from one message of a sequencer to the next.
pub(super) const BEAT: Duration = STEP.saturating_mul(STEPS);
/// The steps in it.
const STEPS: u32 = 2;
/// The time without news after which a station looks for itself.
const SILENCE: Duration = Duration::from_secs(1);
/// The time without steps after which members are told.
const STANDSTILL: Duration = Duration::from_millis(1_500);
/// The time from one claim, or renewal, to the next.
const SECOND: Duration = Duration::from_secs(1);
/// The least time that a station is there without being needed.
const LEAST_STAY: Duration = Duration::from_secs(3);

/// What members read while the room waits.
const WAITS: &str = "The hosts of this room do not reach each other; the game waits.";
/// What they read then.
const GOES_ON: &str = "The game goes on.";

/// A room on one host.
pub(super) struct Station {
    id: RoomId,
    company: Arc<Company>,
    doorway: Arc<Doorway>,
    /// Who watches on this host.
    watchers: Arc<AtomicUsize>,
    /// The newest record.
    record: Record,
    replica: Replica,
    office: Option<Office>,
    talk: mpsc::Receiver<Vec<u8>>,
    asked: mpsc::Receiver<Asked>,
    guests: Vec<Guest>,
    leasing: Leasing,
    times: Times,
    /// Whether it is unknown if the log has the last message.
    is_doubtful: bool,
    is_told_to_wait: bool,
    /// Whether a lobby would show the room otherwise than its record.
    is_changed: bool,
    ending: watch::Receiver<bool>,
}

/// What was asked of the leases.
#[derive(Default)]
struct Leasing {
    acquiring: Option<Reply<Option<Lease>>>,
    renewing: Option<Reply<bool>>,
}

/// When things were last done.
struct Times {
    /// The room has taken steps, or was found to rest.
    moved: Instant,
    read: Option<Instant>,
    restored: Option<Instant>,
    claimed: Option<Instant>,
    leased: Option<Instant>,
    kept: Option<Instant>,
    published: Option<Instant>,
    /// Somebody needed the station.
    needed: Instant,
    /// Up to when the sequencer has taken steps.
    stepped: Instant,
}

/// What a station begins with.
pub(super) struct Beginning {
    pub(super) id: RoomId,
    pub(super) record: Record,
    pub(super) doorway: Arc<Doorway>,
    pub(super) watchers: Arc<AtomicUsize>,
    pub(super) replica: Replica,
    pub(super) talk: mpsc::Receiver<Vec<u8>>,
    pub(super) asked: mpsc::Receiver<Asked>,
}

impl Station {
    pub(super) fn new(company: Arc<Company>, beginning: Beginning) -> Self {
        let Beginning { id, record, doorway, watchers, replica, talk, asked } = beginning;
        let (now, ending) = (Instant::now(), company.ending.subscribe());
        let times = Times {
            moved: now,
            read: None,
            restored: None,
            claimed: None,
            leased: None,
            kept: None,
            published: None,
            needed: now,
            stepped: now,
        };
        Self {
            id,
            company,
            doorway,
            watchers,
            record,
            replica,
            office: None,
            talk,
            asked,
            guests: Vec::new(),
            leasing: Leasing::default(),
            times,
            is_doubtful: false,
            is_told_to_wait: false,
            is_changed: false,
            ending,
        }
    }

    /// Runs the room on this host, as long as it is needed here.
    pub(super) async fn run(mut self) {
        // What was appended before it heard the others.
        _ = self.read().await;
        let mut next = Instant::now();
        loop {
            tokio::select! {
                biased;
                () = sleep_until(next) => {
                    next = (next + BEAT).max(Instant::now());
                    self.beat().await;
                    if self.is_over() {
                        return self.end().await;
                    }
                }
                Some(bytes) = self.talk.recv() => self.hear(&bytes).await,
                Some(asked) = self.asked.recv() => self.receive(asked).await,
            }
        }
    }

    async fn beat(&mut self) {
        let now = Instant::now();
        self.pass_on().await;
        self.ask_again(now).await;
        self.claim(now).await;
        self.mind_lease(now).await;
        if self.office.is_some() {
            self.sequence(now).await;
            self.keep(now).await;
        } else if is_due(self.times.read, now, SILENCE) && self.is_silent(now) {
            _ = self.read().await;
        }
        self.tell(now);
    }

    /// Passes on what the members of this host want.
    async fn pass_on(&mut self) {
        let mut wants = Vec::new();
        for _ in 0..STEPS {
            self.doorway.inbox.take(|member, deed| wants.push((member, deed)));
        }
        match &mut self.office {
            Some(office) => wants.into_iter().for_each(|(member, deed)| office.want(member, deed)),
            None if wants.is_empty() => {}
            None => self.say(&Talk::Wants(wants)).await,
        }
    }

    async fn claim(&mut self, now: Instant) {
        if !is_due(self.times.claimed, now, SECOND) {
            return;
        }
        self.times.claimed = Some(now);
        self.dismiss_removed();
        let own = self.doorway.inbox.seated();
        match &mut self.office {
            Some(office) => {
                office.claim(&own, now);
                office.remove_unclaimed(now);
            }
            None if own.is_empty() => {}
            None => self.say(&Talk::Claim(own)).await,
        }
    }

    /// Does what somebody in the room has said.
    async fn hear(&mut self, bytes: &[u8]) {
        let now = Instant::now();
        let talk = match Talk::parse(bytes) {
            Ok(talk) => talk,
            Err(fault) => return tracing::warn!(room = %self.id, "a host says {fault:?}"),
        };
        match (talk, &mut self.office) {
            (Talk::News(number, message), _) => {
                if !self.take(number, &message).await {
                    _ = self.read().await;
                }
            }
            (Talk::Wants(wants), Some(office)) => {
                for (member, deed) in wants {
                    office.want(member, deed);
                }
            }
            (Talk::Claim(members), Some(office)) => office.claim(&members, now),
            (Talk::Join(token, name), Some(office)) => {
                if let Some(answer) = office.ask(token, &name, now) {
                    self.say(&answer).await;
                }
            }
            (talk @ (Talk::Joined(..) | Talk::Full(_)), _) => self.answer(&talk),
            (Talk::Wants(_) | Talk::Claim(_) | Talk::Join(..), None) => {}
        }
    }

    /// Says something to the other hosts. What is lost is said again, or read in the log.
    async fn say(&mut self, talk: &Talk) {
        _ = self.company.bus.say(self.id, talk.to_bytes()).await;
    }

    fn is_silent(&self, now: Instant) -> bool {
        now.duration_since(self.times.moved) >= SILENCE
    }

    /// Tells members when the room begins to wait, and when it goes on.
    fn tell(&mut self, now: Instant) {
        let has_members = self.replica.room().len() > 0 && !self.doorway.inbox.seated().is_empty();
        let waits = has_members && now.duration_since(self.times.moved) >= STANDSTILL;
        if waits != self.is_told_to_wait {
            self.is_told_to_wait = waits;
            self.company.tell(self.id, if waits { WAITS } else { GOES_ON });
        }
    }

    /// Whether the station is not needed any more.
    fn is_over(&mut self) -> bool {
        let now = Instant::now();
        let has_work = self
            .office
            .as_ref()
            .is_some_and(|office| self.replica.room().len() > 0 || !office.is_empty());
        let is_needed = has_work
            || !self.guests.is_empty()
            || !self.doorway.inbox.seated().is_empty()
            || self.watchers.load(Ordering::Acquire) > 0;
        if is_needed {
            self.times.needed = now;
        }
        let closes_after = *self.doorway.closes_after.borrow();
        let stay = closes_after.filter(|_| self.office.is_some()).unwrap_or_default();
        let is_idle = now.duration_since(self.times.needed) >= stay.max(LEAST_STAY);
        is_idle || *self.ending.borrow() || self.doorway.inbox.is_closed()
    }
}

/// Whether what was last done at `last` is to be done again.
fn is_due(last: Option<Instant>, now: Instant, pause: Duration) -> bool {
    last.is_none_or(|last| now.duration_since(last) >= pause)
}
