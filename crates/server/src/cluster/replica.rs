//! Replicas: a room on one host of a cluster.
//!
//! A replica applies the room's log to its [`RoomState`], shows the room to the members and watchers of its host,
//! and sends their commands to the sequencer. One of the replicas of a room is the sequencer: it has a
//! [`ClusterSequencer`] as well.
//!
//! # Rules
//!
//! - A replica applies messages of the log, and nothing else.
//! - A message has the two steps of a [`MESSAGE_PERIOD`]. So a command waits for up to a period and for the round
//!   trip to the log; in a room of one process it waits for up to a step.
//! - A replica that receives nothing for [`SILENCE`] reads the log, and asks for the lease.
//! - A member is in the room once the log has their joining.
//! - Members whom no host claims for a while are away. A host that has ended claims nobody.
//! - A member who was away has returned once the log has it, with the token of the request. A host that has another
//!   token for a member lets them go.
//! - If the bus does not answer, a room goes on if all its members are on the host that has the lease; otherwise it
//!   waits, or another host takes it over. Members are told. See [`alone`].

mod alone;
mod broadcasts;
mod joining;
mod progress;
mod reading;
mod returning;
mod sequencing;
mod times;

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use tokio::sync::{mpsc, watch};
use tokio::time::{Instant, sleep_until};

use self::alone::Alone;
use self::joining::PendingJoin;
pub(crate) use self::joining::{JoinRequest, Wish};
use self::progress::Progress;
use self::returning::PendingReturn;
use self::times::{SECOND, Times, is_due};
use super::HostContext;
use super::lease_worker::Reply;
use super::peer_message::PeerMessage;
use super::record::Record;
use super::room_state::RoomState;
use super::sequencer::ClusterSequencer;
use crate::accounts::Lease;
use crate::ops::metrics::RoomFigures;
use crate::rooms::room::MemberId;
use crate::rooms::sequencer::{RoomInterface, STEP};
use crate::rooms::summary::RoomId;

/// The time from one message of a sequencer to the next.
pub(crate) const MESSAGE_PERIOD: Duration = STEP.saturating_mul(STEPS);
/// The steps in it.
const STEPS: u32 = 2;
/// The time without messages after which a replica reads the log.
const SILENCE: Duration = Duration::from_secs(1);
/// The least time that a replica exists without members and watchers.
const LEAST_STAY: Duration = Duration::from_secs(3);

/// A room on one host.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(crate) struct Replica {
    id: RoomId,
    context: Arc<HostContext>,
    interface: Arc<RoomInterface>,
    figures: Arc<RoomFigures>,
    /// Who watches on this host.
    watchers: Arc<AtomicUsize>,
    /// The newest record.
    record: Record,
    state: RoomState,
    sequencer: Option<ClusterSequencer>,
    broadcasts: mpsc::Receiver<Vec<u8>>,
    join_requests: mpsc::Receiver<JoinRequest>,
    pending_joins: Vec<PendingJoin>,
    pending_returns: Vec<PendingReturn>,
    /// The tokens of this host's members who have returned.
    tokens: BTreeMap<MemberId, u64>,
    leasing: Leasing,
    times: Times,
    /// Whether it is unknown if the log has the message that was appended last.
    is_append_unknown: bool,
    /// The messages of a room that goes on without the bus.
    alone: Option<Alone>,
    /// Whether the state has messages that the log will not have.
    is_diverged: bool,
    /// Whether the bus has answered when the log was last read without a sequencer.
    reaches_bus: bool,
    /// What members were told last.
    told: Progress,
    /// Whether the record of the room is out of date.
    is_changed: bool,
    ending: watch::Receiver<bool>,
}

/// The calls to the leases that are not answered yet.
#[derive(Default)]
struct Leasing {
    acquiring: Option<Reply<Option<Lease>>>,
    renewing: Option<Reply<bool>>,
}

/// The parts of a new replica.
pub(crate) struct Beginning {
    pub(crate) id: RoomId,
    pub(crate) record: Record,
    pub(crate) interface: Arc<RoomInterface>,
    pub(crate) watchers: Arc<AtomicUsize>,
    pub(crate) state: RoomState,
    pub(crate) broadcasts: mpsc::Receiver<Vec<u8>>,
    pub(crate) join_requests: mpsc::Receiver<JoinRequest>,
}

impl Replica {
    pub(crate) fn new(context: Arc<HostContext>, beginning: Beginning) -> Self {
        let Beginning { id, record, interface, watchers, state, broadcasts, join_requests } =
            beginning;
        let (now, ending) = (Instant::now(), context.ending.subscribe());
        let times = Times::new(now);
        let figures = context.load.metrics().add_room(id.0);
        Self {
            id,
            context,
            interface,
            figures,
            watchers,
            record,
            state,
            sequencer: None,
            broadcasts,
            join_requests,
            pending_joins: Vec::new(),
            pending_returns: Vec::new(),
            tokens: BTreeMap::new(),
            leasing: Leasing::default(),
            times,
            is_append_unknown: false,
            alone: None,
            is_diverged: false,
            reaches_bus: true,
            told: Progress::Usual,
            is_changed: false,
            ending,
        }
    }

    /// Runs the room on this host, as long as it is needed here.
    pub(crate) async fn run(mut self) {
        // What was appended before it subscribed.
        self.reaches_bus = self.read().await.is_ok();
        let mut next = Instant::now();
        loop {
            tokio::select! {
                biased;
                () = sleep_until(next) => {
                    next = (next + MESSAGE_PERIOD).max(Instant::now());
                    self.run_period().await;
                    if self.is_over() {
                        return self.end().await;
                    }
                }
                Some(bytes) = self.broadcasts.recv() => self.receive_broadcast(&bytes).await,
                Some(request) = self.join_requests.recv() => self.receive_join(request).await,
            }
        }
    }

    async fn run_period(&mut self) {
        let now = Instant::now();
        self.send_commands().await;
        self.repeat_joins(now).await;
        self.repeat_returns(now).await;
        self.claim(now).await;
        self.keep_lease(now).await;
        if self.sequencer.is_some() {
            self.sequence(now).await;
            self.keep(now).await;
        } else if is_due(self.times.read, now, SILENCE) && self.is_silent(now) {
            self.reaches_bus = self.read().await.is_ok();
        }
        self.tell(now);
        self.figures.members.set(self.state.room().len() as i64);
        self.figures.watchers.set(self.watchers.load(Ordering::Acquire) as i64);
        self.figures.writes.set(self.sequencer.is_some().into());
    }

    /// Sends the commands of this host's members to the sequencer.
    async fn send_commands(&mut self) {
        let (mut commands, now) = (Vec::new(), Instant::now());
        for _ in 0..STEPS {
            self.interface.inbox.take(|member, command| commands.push((member, command)));
        }
        match &mut self.sequencer {
            Some(sequencer) => commands
                .into_iter()
                .for_each(|(member, command)| sequencer.command(member, command, now)),
            None if commands.is_empty() => {}
            None => self.broadcast(&PeerMessage::Commands(commands)).await,
        }
    }

    async fn claim(&mut self, now: Instant) {
        if !is_due(self.times.claimed, now, SECOND) {
            return;
        }
        self.times.claimed = Some(now);
        self.return_own(now).await;
        self.dismiss_lost();
        let own = self.interface.inbox.seated();
        match &mut self.sequencer {
            Some(sequencer) => {
                let answers = sequencer.claim(&own, now);
                sequencer.set_unclaimed_away(now);
                self.send_answers(answers).await;
            }
            None if own.is_empty() => {}
            None => self.broadcast(&PeerMessage::Claim(own)).await,
        }
    }

    fn is_silent(&self, now: Instant) -> bool {
        now.duration_since(self.times.moved) >= SILENCE
    }

    /// Whether the replica is not needed any more.
    fn is_over(&mut self) -> bool {
        let now = Instant::now();
        let has_work = self
            .sequencer
            .as_ref()
            .is_some_and(|sequencer| self.state.room().len() > 0 || !sequencer.is_empty());
        let is_needed = has_work
            || !self.pending_joins.is_empty()
            || !self.pending_returns.is_empty()
            || !self.interface.inbox.seated().is_empty()
            || self.watchers.load(Ordering::Acquire) > 0;
        if is_needed {
            self.times.needed = now;
        }
        let closes_after = *self.interface.closes_after.borrow();
        let stay = closes_after.filter(|_| self.sequencer.is_some()).unwrap_or_default();
        let is_idle = now.duration_since(self.times.needed) >= stay.max(LEAST_STAY);
        is_idle || *self.ending.borrow() || self.interface.inbox.is_closed()
    }
}
