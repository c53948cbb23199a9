//! Replicas: a room on one host of a cluster.
//!
//! A replica applies the room's log to its [`RoomState`], shows the room to the members and watchers on its host, and
//! sends their commands to the sequencer. One replica of each room is the sequencer, and has a [`ClusterSequencer`] as
//! well.
//!
//! # Rules
//!
//! - A replica applies only messages of the log.
//! - A message contains the two steps of a [`MESSAGE_INTERVAL`]. So a command waits for up to a period and for the round
//!   trip to the log. In a room of one process, it waits for up to a step.
//! - A replica that receives nothing for [`SILENCE_TIMEOUT`] reads the log, and asks for the lease.
//! - A member is in the room once the log has their `join` entry.
//! - Members who are not claimed for a while are away. A host that has ended claims nobody.
//! - A member who was away has returned once the log has the token of the request. A host with another token for the
//!   member lets them go.
//! - If the bus does not answer, a room goes on if all its members are on the host with the lease. Otherwise it waits,
//!   or another host takes it over. Members are told. See [`alone`].

mod alone;

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::oneshot::error::TryRecvError;
use tokio::sync::{mpsc, oneshot, watch};
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep, sleep_until};

use super::bus::{BusFault, Key};
use super::host::HostContext;
use super::leases::LeaseAnswer;
use super::message::{LogMessage, PeerMessage, Record, RequestedMember, Token, to_bytes};
use super::room_state::{Position, RoomState};
use super::sequencer::ClusterSequencer;
use crate::accounts::Lease;
use crate::logging;
use crate::rooms::room::{MemberId, Room};
use crate::rooms::sequencer::{
    FAULT, MAX_CAUGHT_UP, RoomInterface, STEP, message as panic_message,
};
use crate::rooms::summary::{RoomId, RoomRefusal};
use cellcaster::game::PlayerColor;

/// The time between two messages of a sequencer.
pub(crate) const MESSAGE_INTERVAL: Duration = STEP.saturating_mul(STEPS);
/// The steps in a message period.
const STEPS: u32 = 2;
/// How long a replica receives no messages before it reads the log.
const SILENCE_TIMEOUT: Duration = Duration::from_secs(1);
/// How long a room takes no steps before members are told.
const STANDSTILL_TIMEOUT: Duration = Duration::from_millis(1_500);
/// The least time for which a replica exists without members and watchers.
const MIN_STAY: Duration = Duration::from_secs(3);
/// The time between two claims, between two checkpoints that are restored, and between two probes of the bus.
const CLAIM_INTERVAL: Duration = Duration::from_secs(1);
/// The time after which a request is sent again.
const REQUEST_RETRY_INTERVAL: Duration = Duration::from_millis(500);
/// The time after which a request fails. Another host takes over a room sooner.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(8);
/// The most messages for which a host that ends waits until the log has its last entries.
const MAX_LAST_MESSAGES: usize = 15;
/// The time between two checkpoints.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(5);
/// The time between two requests for the lease.
const LEASE_RETRY_INTERVAL: Duration = Duration::from_millis(500);

/// A room on one host.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(crate) struct Replica {
    id: RoomId,
    context: Arc<HostContext>,
    interface: Arc<RoomInterface>,
    /// The newest record.
    record: Record,
    state: RoomState,
    sequencer: Option<ClusterSequencer>,
    broadcasts: mpsc::Receiver<Vec<u8>>,
    requests: mpsc::Receiver<MemberRequest>,
    pending: Vec<PendingRequest>,
    /// The tokens of this host's members who have returned.
    tokens: BTreeMap<MemberId, Token>,
    /// The call for the lease that is not answered yet.
    acquiring: Option<LeaseAnswer<Option<Lease>>>,
    times: Times,
    /// `true` while it is unknown whether the log has the message that was appended last.
    is_append_unknown: bool,
    /// The messages of a room that goes on without the bus.
    alone: Option<Alone>,
    /// `true` if the state contains messages that the log will not have.
    is_diverged: bool,
    /// `true` if the bus answered when this replica last read the log without a sequencer.
    reaches_bus: bool,
    /// The progress that members were last told.
    told: Progress,
    /// `true` if the record of the room is out of date.
    is_changed: bool,
    ending: watch::Receiver<bool>,
}

/// The progress of the room while the bus may not answer.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Progress {
    Usual,
    Waiting,
    Alone,
}

impl Progress {
    /// The sentence that members see when it begins.
    const fn sentence(self) -> &'static str {
        match self {
            Self::Usual => "The hosts of this room are connected again.",
            Self::Waiting => "The hosts of this room are disconnected; the game waits.",
            Self::Alone => "Other hosts are out of reach; the game goes on here.",
        }
    }
}

/// The times when a replica last did its periodic work.
struct Times {
    /// When the room last took steps, or was found to rest.
    moved: Instant,
    read: Option<Instant>,
    restored: Option<Instant>,
    claimed: Option<Instant>,
    leased: Option<Instant>,
    kept: Option<Instant>,
    published: Option<Instant>,
    /// When somebody last needed the replica.
    needed: Instant,
    /// The time up to which the sequencer has taken steps.
    stepped: Instant,
}

impl Times {
    /// The times at the start, when nothing else has happened yet.
    fn new(now: Instant) -> Self {
        Self {
            moved: now,
            read: None,
            restored: None,
            claimed: None,
            leased: None,
            kept: None,
            published: None,
            needed: now,
            stepped: now,
        }
    }
}

/// The sender of a request's answer.
type MemberReply = oneshot::Sender<Result<MemberId, RoomRefusal>>;

/// A request to be a member, from a visitor of this host.
pub(crate) type MemberRequest = (RequestedMember, MemberReply);

/// A request that is neither granted nor refused yet.
struct PendingRequest {
    token: Token,
    requested: RequestedMember,
    /// `None` for a member of this host who was away because the host was cut off.
    reply: Option<MemberReply>,
    since: Instant,
    sent: Instant,
}

/// The messages of a room that goes on alone, which the log does not have yet.
struct Alone {
    since: Instant,
    /// The log may have the first one, so it stays unchanged.
    messages: VecDeque<LogMessage>,
    /// A task that asks whether the bus answers again.
    probe: Option<JoinHandle<bool>>,
    probed: Instant,
}

impl Drop for Replica {
    fn drop(&mut self) {
        self.context.leases.drop_hold(self.id);
    }
}

impl Replica {
    pub(crate) fn new(
        context: Arc<HostContext>,
        id: RoomId,
        (state, record): (RoomState, Record),
        interface: Arc<RoomInterface>,
        broadcasts: mpsc::Receiver<Vec<u8>>,
        requests: mpsc::Receiver<MemberRequest>,
    ) -> Self {
        let (now, ending) = (Instant::now(), context.ending.subscribe());
        let times = Times::new(now);
        Self {
            id,
            context,
            interface,
            record,
            state,
            sequencer: None,
            broadcasts,
            requests,
            pending: Vec::new(),
            tokens: BTreeMap::new(),
            acquiring: None,
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
        // Read the messages that were appended before this replica subscribed.
        self.reaches_bus = self.read().await.is_ok();
        let mut next = Instant::now();
        loop {
            tokio::select! {
                biased;
                () = sleep_until(next) => {
                    next = (next + MESSAGE_INTERVAL).max(Instant::now());
                    self.run_period().await;
                    if self.is_over() {
                        return self.end().await;
                    }
                }
                Some(bytes) = self.broadcasts.recv() => self.receive_broadcast(&bytes).await,
                Some(request) = self.requests.recv() => self.receive_request(request).await,
            }
        }
    }

    async fn run_period(&mut self) {
        let now = Instant::now();
        self.send_commands().await;
        self.repeat_requests(now).await;
        self.claim(now).await;
        self.keep_lease(now).await;
        if self.sequencer.is_some() {
            self.sequence(now).await;
            self.keep(now).await;
        } else if is_due(self.times.read, now, SILENCE_TIMEOUT) && self.is_silent(now) {
            self.reaches_bus = self.read().await.is_ok();
        }
        self.tell(now);
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
        if !is_due(self.times.claimed, now, CLAIM_INTERVAL) {
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

    async fn receive_broadcast(&mut self, bytes: &[u8]) {
        let now = Instant::now();
        let message = match PeerMessage::parse(bytes) {
            Ok(message) => message,
            Err(fault) => {
                return tracing::warn!(room = %self.id, "a broadcast cannot be read: {fault}");
            }
        };
        match (message, &mut self.sequencer) {
            (PeerMessage::Appended(number, message), _) => {
                if !self.take(number, &message).await {
                    _ = self.read().await;
                }
            }
            (PeerMessage::Commands(commands), Some(sequencer)) => {
                for (member, command) in commands {
                    sequencer.command(member, command, now);
                }
            }
            (PeerMessage::Claim(members), Some(sequencer)) => {
                let answers = sequencer.claim(&members, now);
                self.send_answers(answers).await;
            }
            (PeerMessage::Request(token, requested), Some(sequencer)) => {
                if let Some(answer) = sequencer.request(token, &requested, now) {
                    self.broadcast(&answer).await;
                }
            }
            // Ask for the lease at once, and do not wait until the room is silent.
            (PeerMessage::Released, None) => self.times.leased = None,
            (answer @ (PeerMessage::Joined(..) | PeerMessage::Refused(..)), _) => {
                self.answer(&answer);
            }
            (PeerMessage::Commands(_) | PeerMessage::Claim(_) | PeerMessage::Request(..), None)
            | (PeerMessage::Released, Some(_)) => {}
        }
    }

    /// Sends a message to the other hosts. A lost message is sent again, or read from the log.
    async fn broadcast(&mut self, message: &PeerMessage) {
        _ = self.context.bus.broadcast(self.id, to_bytes(message)).await;
    }

    /// Passes on the sequencer's answers, on all hosts.
    async fn send_answers(&mut self, answers: Vec<PeerMessage>) {
        for answer in answers {
            self.answer(&answer);
            self.broadcast(&answer).await;
        }
    }

    /// Passes on an answer of the sequencer, if the request was made on this host.
    fn answer(&mut self, answer: &PeerMessage) {
        match *answer {
            PeerMessage::Joined(token, member, color) => self.admit(token, member, color),
            PeerMessage::Refused(token, refusal) => self.refuse_request(token, refusal),
            _ => {}
        }
    }

    /// Takes a message of the log, and answers the requests that it fulfils. Returns false if the state does not have
    /// the messages before it, or differs from the log.
    async fn take(&mut self, number: u64, message: &LogMessage) -> bool {
        if self.is_ahead_of(message) {
            return true;
        }
        if self.is_diverged {
            return false;
        }
        match self.state.position(number, message) {
            Position::Known => return true,
            Position::Later => return false,
            Position::Next => {
                if message.check.is_some() && self.sequencer.is_none() {
                    self.context.load.metrics.checks(true).inc();
                }
            }
            Position::Differs => {
                let (room, tick) = (self.id, message.tick);
                tracing::error!(%room, tick, "the state of a room differs from the sequencer's, which is a bug");
                self.context.load.metrics.checks(false).inc();
                _ = self.restore().await;
                return false;
            }
        }
        self.apply(Some(number), message);
        self.times.moved = Instant::now();
        let sequencer = self.sequencer.take_if(|sequencer| sequencer.epoch() >= message.epoch);
        let Some(mut sequencer) = sequencer else {
            // Another host runs the room now.
            self.sequencer = None;
            return true;
        };
        let answers = sequencer.note(message, &self.state, self.times.moved);
        self.sequencer = Some(sequencer);
        self.send_answers(answers).await;
        true
    }

    /// Applies a message, and shows the room after it. A panic ends the room on this host.
    fn apply(&mut self, number: Option<u64>, message: &LogMessage) {
        let Self { state, interface, .. } = self;
        let apply = || {
            interface.replace_view(|| {
                let changes = state.apply(number, message);
                (state.room.view(), changes)
            })
        };
        let changes = match catch_unwind(AssertUnwindSafe(apply)) {
            Ok(changes) => changes,
            Err(panic) => {
                logging::room_failed(self.id.0, panic_message(&*panic));
                return self.interface.close(FAULT);
            }
        };
        self.context.load.metrics.entries.inc_by(changes.entries);
        if let Some(run) = changes.finished {
            self.interface.inbox.finish(run);
        }
        self.is_changed |= changes.summary;
    }

    /// Reads the log to its end.
    async fn read(&mut self) -> Result<(), BusFault> {
        self.times.read = Some(Instant::now());
        if self.is_diverged {
            self.restore().await?;
        }
        loop {
            let next = self.context.bus.read(self.id, self.state.number).await?;
            let Some((number, bytes)) = next else { return Ok(()) };
            let Ok(message) = LogMessage::parse(&bytes) else {
                tracing::error!(room = %self.id, number, "a message in a room's log cannot be read");
                self.interface.close("A host with another version has taken over this room.");
                return Err(BusFault::Unknown);
            };
            if !self.take(number, &message).await {
                // The messages before it were dropped, because a checkpoint contains their effects.
                self.restore().await?;
            }
        }
    }

    /// Replaces the state with the newest checkpoint.
    async fn restore(&mut self) -> Result<(), BusFault> {
        let now = Instant::now();
        if !is_due(self.times.restored, now, CLAIM_INTERVAL) {
            return Err(BusFault::Unknown);
        }
        self.times.restored = Some(now);
        let loaded = self.context.load_state(self.id).await;
        let (state, _) = loaded.map_err(|_| BusFault::Unknown)?;
        self.interface.replace_view(|| (state.room.view(), ()));
        self.state = state;
        self.is_diverged = false;
        // The lease of the sequencer may have ended long ago.
        self.sequencer.take_if(|sequencer| sequencer.epoch() < self.state.epoch);
        self.is_changed = true;
        Ok(())
    }

    /// Tells members when the room begins to wait, goes on alone, or goes on as usual.
    fn tell(&mut self, now: Instant) {
        let has_members = self.state.room.len() > 0 && !self.interface.inbox.seated().is_empty();
        let waits = has_members && now.duration_since(self.times.moved) >= STANDSTILL_TIMEOUT;
        let progress = match &self.alone {
            _ if waits => Progress::Waiting,
            Some(_) => Progress::Alone,
            None => Progress::Usual,
        };
        if progress != self.told {
            self.told = progress;
            self.context.visitors.say_in(&self.id.place(), progress.sentence());
        }
    }

    fn is_silent(&self, now: Instant) -> bool {
        now.duration_since(self.times.moved) >= SILENCE_TIMEOUT
    }

    /// Returns true if the replica is no longer needed.
    fn is_over(&mut self) -> bool {
        let now = Instant::now();
        let has_work = self
            .sequencer
            .as_ref()
            .is_some_and(|sequencer| self.state.room.len() > 0 || !sequencer.is_empty());
        let is_needed = has_work
            || !self.pending.is_empty()
            || !self.interface.inbox.seated().is_empty()
            || self.interface.watchers() > 0;
        if is_needed {
            self.times.needed = now;
        }
        let closes_after = *self.interface.closes_after.borrow();
        let stay = closes_after.filter(|_| self.sequencer.is_some()).unwrap_or_default();
        let is_idle = now.duration_since(self.times.needed) >= stay.max(MIN_STAY);
        is_idle || *self.ending.borrow() || self.interface.inbox.is_closed()
    }
}

impl PendingRequest {
    /// Returns true if it asks to return to a member who has left.
    fn is_lost(&self, room: &Room) -> bool {
        matches!(self.requested, RequestedMember::Return(member) if room.has_lost(member))
    }

    /// The member that `room` lets it return to.
    fn granted(&self, room: &Room) -> Option<MemberId> {
        let RequestedMember::Return(member) = self.requested else { return None };
        let kept = room.kept_place(member)?;
        (kept.token == self.token.0).then_some(member)
    }

    fn refuse(self, refusal: RoomRefusal) {
        if let Some(reply) = self.reply {
            _ = reply.send(Err(refusal));
        }
    }
}

/// Requests to be a member, from visitors of this host, and the seats of this host's members.
///
/// A request has a token, which identifies its answer. A request to return is granted once the log has the token,
/// whichever host wrote it.
impl Replica {
    async fn receive_request(&mut self, (requested, reply): MemberRequest) {
        if let RequestedMember::Return(member) = requested
            && self.interface.inbox.seated().contains(&member)
        {
            _ = reply.send(Err(RoomRefusal::Taken));
            return;
        }
        self.begin_request(requested, Some(reply), Instant::now()).await;
    }

    async fn begin_request(
        &mut self,
        requested: RequestedMember,
        reply: Option<MemberReply>,
        now: Instant,
    ) {
        let token = Token(self.context.chance());
        self.pending.push(PendingRequest {
            token,
            requested: requested.clone(),
            reply,
            since: now,
            sent: now,
        });
        self.send_request(token, requested, now).await;
    }

    async fn send_request(&mut self, token: Token, requested: RequestedMember, now: Instant) {
        match &mut self.sequencer {
            Some(sequencer) => {
                if let Some(answer) = sequencer.request(token, &requested, now) {
                    self.answer(&answer);
                }
            }
            None => self.broadcast(&PeerMessage::Request(token, requested)).await,
        }
    }

    /// Sends unanswered requests again.
    async fn repeat_requests(&mut self, now: Instant) {
        self.settle_requests(now);
        let is_due = |pending: &&mut PendingRequest| {
            now.duration_since(pending.sent) >= REQUEST_RETRY_INTERVAL
        };
        let due = self.pending.iter_mut().filter(is_due).map(|pending| {
            pending.sent = now;
            (pending.token, pending.requested.clone())
        });
        for (token, requested) in due.collect::<Vec<_>>() {
            self.send_request(token, requested, now).await;
        }
    }

    /// Notes which requests the log has granted, and fails the requests that are too old.
    fn settle_requests(&mut self, now: Instant) {
        let Self { pending, state, tokens, interface, .. } = self;
        let room = &state.room;
        for granted in pending.extract_if(.., |pending| pending.granted(room).is_some()) {
            let Some(member) = granted.granted(room) else { continue };
            tokens.insert(member, granted.token);
            let color = room.colors().find(|(other, _)| *other == member).map(|it| it.1);
            if let Some((reply, color)) = granted.reply.zip(color) {
                interface.inbox.admit(member, color);
                if reply.send(Ok(member)).is_err() {
                    interface.inbox.part(member);
                }
            }
        }
        let is_over = |pending: &mut PendingRequest| {
            pending.is_lost(room) || now.duration_since(pending.since) >= REQUEST_TIMEOUT
        };
        for pending in pending.extract_if(.., is_over) {
            let is_lost = pending.is_lost(room);
            pending.refuse(if is_lost { RoomRefusal::Gone } else { RoomRefusal::NotNow });
        }
    }

    /// Gives a seat to the visitor of this host who asked for it.
    fn admit(&mut self, token: Token, member: MemberId, color: PlayerColor) {
        let Some(pending) = self.take_pending(token) else { return };
        self.interface.inbox.admit(member, color);
        if pending.reply.is_none_or(|reply| reply.send(Ok(member)).is_err()) {
            self.interface.inbox.leave(member);
        }
    }

    /// Refuses a request that was made on this host.
    fn refuse_request(&mut self, token: Token, refusal: RoomRefusal) {
        // The log may have granted it in the meantime.
        self.settle_requests(Instant::now());
        if let Some(pending) = self.take_pending(token) {
            pending.refuse(refusal);
        }
    }

    fn take_pending(&mut self, token: Token) -> Option<PendingRequest> {
        let index = self.pending.iter().position(|pending| pending.token == token)?;
        Some(self.pending.swap_remove(index))
    }

    /// Asks to return for this host's members who were away while it was cut off.
    async fn return_own(&mut self, now: Instant) {
        self.settle_requests(now);
        let is_pending = |member: &MemberId| {
            self.pending.iter().any(|it| it.requested == RequestedMember::Return(*member))
        };
        let room = &self.state.room;
        let mut away = self.interface.inbox.seated();
        away.retain(|member| room.is_away(*member) && self.is_own(*member) && !is_pending(member));
        for member in away {
            self.begin_request(RequestedMember::Return(member), None, now).await;
        }
    }

    /// Frees the seats of members who have left the room since this host last claimed them, or who are on another host
    /// now.
    fn dismiss_lost(&mut self) {
        for member in self.interface.inbox.seated() {
            // A member whose join is not in the log yet does not count as lost.
            if self.state.room.has_lost(member) || !self.is_own(member) {
                self.interface.inbox.dismiss(member);
            }
        }
        let seated = self.interface.inbox.seated();
        self.tokens.retain(|member, _| seated.contains(member));
    }

    /// Returns true if nobody has returned to the member on another host, as far as this replica knows the log.
    fn is_own(&self, member: MemberId) -> bool {
        let token = self.state.room.kept_place(member).map_or(0, |kept| kept.token);
        token == self.tokens.get(&member).map_or(0, |token| token.0)
    }

    /// Marks this host's members away because the host ends. If it is the sequencer, the log has that afterwards.
    async fn part_with_members(&mut self) {
        for member in self.interface.inbox.seated() {
            self.interface.inbox.part(member);
        }
        self.send_commands().await;
        for _ in 0..MAX_LAST_MESSAGES {
            if self.sequencer.as_ref().is_none_or(ClusterSequencer::is_settled) {
                return;
            }
            sleep(MESSAGE_INTERVAL).await;
            self.sequence(Instant::now()).await;
        }
    }
}

/// The duties of the sequencer: the lease, the messages and the checkpoints.
impl Replica {
    /// Steps down if the lease is lost, and asks for it if no host seems to have it.
    async fn keep_lease(&mut self, now: Instant) {
        // Without the database no other host gets the lease, and the log refuses a host that has lost it.
        if self.sequencer.is_some() && self.lease_end().is_none() {
            self.diverge();
        }
        if let Some(reply) = &mut self.acquiring {
            match reply.try_recv() {
                Err(TryRecvError::Empty) => return,
                Ok(Ok(Some(lease))) => self.take_over(lease).await,
                _ => {}
            }
            self.acquiring = None;
        }
        let is_time = self.times.leased.is_none()
            || self.is_silent(now) && is_due(self.times.leased, now, LEASE_RETRY_INTERVAL);
        // A host that cannot write the log would keep the room from hosts that can.
        if self.sequencer.is_none() && is_time && self.reaches_bus {
            let leases = &self.context.leases;
            self.acquiring = Some(leases.acquire(&self.id.place(), self.state.epoch));
            self.times.leased = Some(now);
        }
    }

    /// The end of the sequencer's lease; `None` if this host does not hold it.
    fn lease_end(&self) -> Option<Instant> {
        self.context.leases.end_of(self.id, &self.sequencer.as_ref()?.lease)
    }

    /// Becomes the sequencer. Its first message begins a new epoch at the end of the log.
    async fn take_over(&mut self, lease: Lease) {
        let is_read = self.read().await.is_ok();
        if self.state.epoch >= lease.epoch {
            // The answer came so late that other hosts have run the room since.
            return;
        }
        let now = Instant::now();
        tracing::info!(room = %self.id, epoch = lease.epoch, "this host has taken over a room");
        self.context.leases.hold(self.id, lease.clone(), self.times.leased.unwrap_or(now));
        self.sequencer = Some(ClusterSequencer::new(lease, &self.state));
        self.times.stepped = now;
        self.is_append_unknown = !is_read;
        self.is_changed = true;
    }

    fn step_down(&mut self) {
        if let Some(sequencer) = self.sequencer.take() {
            tracing::warn!(room = %self.id, epoch = sequencer.epoch(), "this host has given up a room");
        }
        self.context.leases.drop_hold(self.id);
    }

    /// Appends the next message to the log, if one is due.
    async fn sequence(&mut self, now: Instant) {
        if self.alone.is_some() {
            return self.go_on_alone(now).await;
        }
        if self.is_append_unknown {
            if self.read().await.is_err() {
                return self.lack_bus(now);
            }
            self.is_append_unknown = false;
        }
        let Some(sequencer) = &mut self.sequencer else { return };
        if self.state.room.len() == 0 && sequencer.is_empty() {
            (self.times.stepped, self.times.moved) = (now, now);
            return;
        }
        let steps = steps_due(&mut self.times.stepped, now);
        if steps == 0 && !sequencer.is_sending() {
            return;
        }
        let message = sequencer.next(&self.state, steps);
        match self.context.bus.append(self.id, message.last, to_bytes(&message)).await {
            Ok(number) => {
                self.times.published = Some(now);
                self.take(number, &message).await;
                self.broadcast(&PeerMessage::Appended(number, message)).await;
            }
            Err(BusFault::Refused) => self.is_append_unknown = self.read().await.is_err(),
            Err(BusFault::Unknown) => self.is_append_unknown = true,
        }
    }

    /// Stores a checkpoint and the record of the room every few seconds, and the record also when it changes.
    async fn keep(&mut self, now: Instant) {
        let is_time = is_due(self.times.kept, now, CHECKPOINT_INTERVAL);
        // A host that was replaced and has not noticed has appended nothing now, and must not store an old state.
        let is_surely_sequencer = self.times.published == Some(now);
        if self.sequencer.is_none() || self.is_append_unknown || !(is_time || self.is_changed) {
            return;
        }
        if is_time && is_surely_sequencer && self.keep_checkpoint().await.is_err() {
            return;
        }
        if is_time {
            self.times.kept = Some(now);
        }
        self.is_changed = self.keep_record(true).await.is_err();
    }

    async fn keep_checkpoint(&mut self) -> Result<(), BusFault> {
        let bus = &self.context.bus;
        bus.put(Key::Checkpoint(self.id), self.state.checkpoint()).await?;
        bus.drop_before(self.id, self.state.number).await
    }

    async fn keep_record(&mut self, is_running: bool) -> Result<(), BusFault> {
        let record = self.record.clone().next(&self.state.room, is_running);
        self.context.bus.put(Key::Room(self.id), to_bytes(&record)).await?;
        self.record = record;
        Ok(())
    }

    /// Leaves the room to other hosts, or closes it if nobody needs it.
    async fn end(mut self) {
        if *self.ending.borrow() {
            self.requests.close();
            self.part_with_members().await;
        }
        let is_broken = self.interface.inbox.is_closed();
        if let Some(sequencer) = self.sequencer.take_if(|_| !self.is_append_unknown) {
            let is_empty = self.state.room.len() == 0;
            let (context, mut is_gone) = (Arc::clone(&self.context), false);
            if is_broken || is_empty && !self.record.stands {
                // The lease keeps the epochs of a standing room, which is created again under its number, and of a room
                // that is broken or was not removed, because other hosts may go on with it.
                is_gone = self.close().await.is_ok() && !is_broken && !self.record.stands;
            } else {
                // The first call fails if the predecessor put the last checkpoint.
                for _ in 0..2 {
                    if self.keep_checkpoint().await.is_ok() {
                        break;
                    }
                }
                if self.keep_record(!is_empty).await.is_err() {
                    _ = self.keep_record(!is_empty).await;
                }
            }
            let lease = &sequencer.lease;
            let leases = &context.leases;
            _ = if is_gone { leases.forget(lease) } else { leases.release(lease) }.await;
            self.broadcast(&PeerMessage::Released).await;
        }
        let ends = *self.ending.borrow();
        let sentence =
            if ends { "The server has ended." } else { "The room was empty and is closed." };
        self.interface.close(sentence);
    }

    /// Removes everything that the bus stores about the room.
    async fn close(&mut self) -> Result<(), BusFault> {
        let bus = &self.context.bus;
        let mut removed = Ok(());
        for key in [Key::Room(self.id), Key::Checkpoint(self.id)] {
            removed = removed.and(bus.remove(key).await);
        }
        removed.and(bus.drop_log(self.id).await)
    }
}

/// The steps that are due since `stepped`. Moves `stepped` forward.
fn steps_due(stepped: &mut Instant, now: Instant) -> u64 {
    const MAX: u64 = MAX_CAUGHT_UP as u64;
    let due = now.saturating_duration_since(*stepped).div_duration_f64(STEP) as u64;
    *stepped = if due > MAX { now } else { *stepped + STEP * due as u32 };
    due.min(MAX)
}

/// Returns true if `pause` has passed since `last`.
fn is_due(last: Option<Instant>, now: Instant, pause: Duration) -> bool {
    last.is_none_or(|last| now.duration_since(last) >= pause)
}
