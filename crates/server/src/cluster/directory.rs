//! The directory of a cluster's rooms on one of its hosts. It lists the rooms, and starts a [`Replica`] of each room
//! that somebody enters here.
//!
//! # Rules
//!
//! - Every host knows the record of every room. The number of a room is never used again. A room takes no steps until
//!   somebody enters it.
//! - The first host with a standing room in its configuration creates it. A host lists the standing rooms of its own
//!   configuration, and other standing rooms while somebody is in them. Their records stay, because another host may
//!   have them in its configuration.
//! - If the record of a running room has not changed for [`RECORD_TIMEOUT`], the room has lost its host. Any other host then
//!   runs the room until it is empty.
//! - The bus stores the room and the member of each player with a key, so that any host finds them again. The entry is
//!   put when the player joins, and removed when they leave. Otherwise only the room ends a member. So the entry may be
//!   out of date, and the room decides.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::{mpsc, oneshot};
use tokio::time::{Instant, MissedTickBehavior, interval, sleep, timeout};

use super::bus::{BusFault, Key};
use super::host::HostContext;
use super::leases::RENEWAL_INTERVAL;
use super::message::{Record, RequestedMember, to_bytes, version};
use super::replica::{MemberRequest, Replica};
use super::visits::{ANNOUNCEMENT_INTERVAL, Visits};
use crate::accounts::AccountKey;
use crate::line::Line;
use crate::lock::locked;
use crate::rooms::directory::{Place, RoomLimits, RoomRefusal};
use crate::rooms::room::{Header, MemberId, Mode};
use crate::rooms::sequencer::RoomInterface;
use crate::rooms::summary::{RoomId, RoomRequest};
use cellcaster::rng;

/// How long the record of a running room may stay unchanged before its host counts as gone.
const RECORD_TIMEOUT: Duration = Duration::from_secs(15);
/// The time between two rounds of maintenance.
const MAINTENANCE_INTERVAL: Duration = Duration::from_secs(5);
/// The most requests to be a member that wait in one room.
const MAX_REQUESTS: usize = 64;
/// The time limit for leaving the rooms to other hosts.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(2);
/// How many times a request is tried, because a replica may end at that moment.
const TRIES: usize = 3;

/// The rooms that a host shares with other hosts. Clones refer to the same rooms.
#[derive(Clone)]
pub(crate) struct SharedRooms(Arc<SharedRoomsState>);

struct SharedRoomsState {
    context: Arc<HostContext>,
    standing: Mutex<Vec<RoomRequest>>,
    /// The numbers of the standing rooms.
    own_standing: Mutex<BTreeSet<RoomId>>,
    records: Mutex<BTreeMap<RoomId, ReceivedRecord>>,
    /// Locked while a replica is created, so that a room has at most one.
    replicas: tokio::sync::Mutex<BTreeMap<RoomId, RoomHandle>>,
}

/// A record, and the time when it was received.
struct ReceivedRecord {
    record: Record,
    since: Instant,
}

/// The handle of a replica on this host.
#[derive(Clone)]
struct RoomHandle {
    interface: Arc<RoomInterface>,
    requests: mpsc::Sender<MemberRequest>,
}

/// A player who joins a room.
#[derive(Clone, Debug)]
pub(crate) struct Entrant {
    pub(crate) name: Line,
    /// The key of their account, with which they can return; `None` for a guest.
    pub(crate) key: Option<AccountKey>,
}

impl SharedRooms {
    /// Starts the directory on the current runtime.
    pub(crate) fn new(context: Arc<HostContext>, standing: Vec<RoomRequest>) -> Self {
        let shared = Self(Arc::new(SharedRoomsState {
            context,
            standing: Mutex::new(standing),
            own_standing: Mutex::default(),
            records: Mutex::default(),
            replicas: tokio::sync::Mutex::default(),
        }));
        tokio::spawn(shared.clone().follow());
        tokio::spawn(shared.clone().maintain());
        tokio::spawn(shared.clone().announce());
        tokio::spawn(shared.clone().renew_leases());
        tokio::spawn(shared.clone().compare_maps());
        shared
    }

    /// Opens a room, and joins it. Others enter a private room with its code only.
    pub(crate) async fn open(
        &self,
        request: &RoomRequest,
        is_private: bool,
        visitor: &Entrant,
    ) -> Result<Place, RoomRefusal> {
        let listed = self.0.context.rooms.summaries().borrow().len();
        let is_full = listed >= self.0.context.rooms.limits().most;
        if is_full {
            return Err(RoomRefusal::TooMany);
        }
        let context = &self.0.context;
        let header = self.header(request).ok_or(RoomRefusal::NoLevel)?;
        let id = RoomId(context.bus.next_number().await.map_err(not_now)?);
        let code = is_private.then(|| self.0.context.rooms.new_code());
        let record = to_bytes(&Record::new(header, false, code));
        context.bus.create(Key::Room(id), record).await.map_err(not_now)?;
        self.join(id, visitor).await
    }

    /// Joins a room.
    pub(crate) async fn enter(&self, id: RoomId, visitor: &Entrant) -> Result<Place, RoomRefusal> {
        let mode = locked(&self.0.records, |it| it.get(&id).map(|it| it.record.header.mode));
        if mode == Some(Mode::Alone) {
            return Err(RoomRefusal::Alone);
        }
        self.join(id, visitor).await
    }

    /// Watches a room.
    pub(crate) async fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let handle = self.handle(id).await?;
        self.0.context.rooms.place_to_watch(id, handle.interface)
    }

    pub(crate) fn context(&self) -> &HostContext {
        &self.0.context
    }

    /// The visits of this host, which are counted together with the visits of all hosts.
    pub(crate) fn visits(&self) -> &Visits {
        &self.0.context.visits
    }

    /// Announces this host again and again.
    async fn announce(self) {
        let mut periods = interval(ANNOUNCEMENT_INTERVAL);
        while !*self.0.context.ending.borrow() {
            periods.tick().await;
            self.visits().announce(self.0.context.visitors.count());
        }
    }

    /// Renews the leases of this host again and again.
    async fn renew_leases(self) {
        let mut periods = interval(RENEWAL_INTERVAL);
        periods.set_missed_tick_behavior(MissedTickBehavior::Delay);
        loop {
            periods.tick().await;
            self.0.context.leases.renew().await;
        }
    }

    async fn join(&self, id: RoomId, entrant: &Entrant) -> Result<Place, RoomRefusal> {
        let Entrant { name, key } = entrant;
        let requested = RequestedMember::Join { name: name.clone(), is_kept: key.is_some() };
        let place = self.be_member(id, requested).await?;
        if let Some((key, member)) = key.zip(place.member_id()) {
            self.note_place(key, id, member).await;
        }
        Ok(place)
    }

    /// The room and the member in which a player's previous host may have left them.
    pub(crate) async fn place_of(&self, key: AccountKey) -> Option<(RoomId, MemberId)> {
        let bytes = self.0.context.bus.get(Key::Place(key)).await.ok()??;
        let (id, member) = str::from_utf8(&bytes).ok()?.split_once(' ')?;
        Some((RoomId(id.parse().ok()?), MemberId::parse(member)?))
    }

    /// Brings a player back to the room and the member.
    pub(crate) async fn resume(
        &self,
        key: AccountKey,
        (id, member): (RoomId, MemberId),
    ) -> Result<Place, RoomRefusal> {
        let place = self.be_member(id, RequestedMember::Return(member)).await;
        if matches!(place, Err(RoomRefusal::Gone | RoomRefusal::NoLevel)) {
            self.forget_place(key).await;
        }
        place
    }

    /// Forgets the place of a player who has left.
    pub(crate) async fn forget_place(&self, key: AccountKey) {
        // If this fails, the room says later that they have left.
        _ = self.0.context.bus.remove(Key::Place(key)).await;
    }

    async fn note_place(&self, key: AccountKey, id: RoomId, member: MemberId) {
        let bus = &self.0.context.bus;
        let text = format!("{id} {member}");
        // The first call fails if another host has put the last entry. Without an entry, the player cannot return.
        for _ in 0..2 {
            if bus.put(Key::Place(key), text.clone().into_bytes()).await != Err(BusFault::Refused) {
                return;
            }
        }
    }

    /// Replaces the limits of the host.
    pub(crate) fn set_limits(&self, mut limits: RoomLimits) {
        let standing = std::mem::take(&mut limits.standing);
        locked(&self.0.standing, |it| *it = standing);
        self.0.context.rooms.set_limits(limits);
    }

    /// Hands all rooms over to the other hosts, and leaves the cluster.
    pub(crate) async fn end(&self) {
        self.0.context.ending.send_replace(true);
        let all_ended = async {
            for handle in self.0.replicas.lock().await.values() {
                handle.requests.closed().await;
            }
            self.visits().leave().await;
        };
        _ = timeout(SHUTDOWN_TIMEOUT, all_ended).await;
    }

    /// Becomes a member of a room.
    async fn be_member(
        &self,
        id: RoomId,
        requested: RequestedMember,
    ) -> Result<Place, RoomRefusal> {
        for _ in 0..TRIES {
            let handle = self.handle(id).await?;
            let (reply, answer) = oneshot::channel::<Result<MemberId, RoomRefusal>>();
            let request = (requested.clone(), reply);
            if handle.requests.send(request).await.is_err() {
                continue;
            }
            if let Ok(answer) = answer.await {
                return Ok(Place::member(id, answer?, handle.interface));
            }
        }
        Err(RoomRefusal::Gone)
    }

    /// The handle of a room's replica. Starts the replica if this host has none.
    async fn handle(&self, id: RoomId) -> Result<RoomHandle, RoomRefusal> {
        let SharedRoomsState { context, replicas, .. } = &*self.0;
        if *context.ending.borrow() {
            return Err(RoomRefusal::NotNow);
        }
        let mut replicas = replicas.lock().await;
        if let Some(handle) = replicas.get(&id).filter(|handle| !handle.requests.is_closed()) {
            return Ok(handle.clone());
        }
        let broadcasts = context.bus.subscribe(id).await.map_err(not_now)?;
        let loaded = context.load_state(id).await?;
        let (requests, receiver) = mpsc::channel(MAX_REQUESTS);
        let closes_after = self.0.context.rooms.limits().closes_after;
        let (state, record) = &loaded;
        let interface = RoomInterface::new(&state.room, record.stands, closes_after, record.code);
        self.0.context.rooms.note_entered(id, &interface);
        let handle = RoomHandle { interface: Arc::clone(&interface), requests };
        let context = Arc::clone(context);
        let replica = Replica::new(context, id, loaded, interface, broadcasts, receiver);
        tokio::spawn(replica.run());
        replicas.insert(id, handle.clone());
        Ok(handle)
    }

    /// Keeps the records of all rooms up to date.
    async fn follow(self) {
        loop {
            if let Ok(mut changes) = self.0.context.bus.watch().await {
                while let Some((id, bytes)) = changes.recv().await {
                    self.note(id, bytes.as_deref());
                }
            }
            sleep(MAINTENANCE_INTERVAL).await;
        }
    }

    fn note(&self, id: RoomId, bytes: Option<&[u8]>) {
        // A record that cannot be read belongs to a room of another version, which does not exist for this host.
        let record = bytes.and_then(|bytes| Record::parse(bytes).ok());
        let now = Instant::now();
        locked(&self.0.records, |records| match record {
            Some(record) => _ = records.insert(id, ReceivedRecord { record, since: now }),
            None => _ = records.remove(&id),
        });
        self.show();
    }

    /// Creates the standing rooms, forgets replicas that have ended, and runs rooms that have lost their host, again
    /// and again.
    async fn maintain(self) {
        let mut periods = interval(MAINTENANCE_INTERVAL);
        loop {
            periods.tick().await;
            if *self.0.context.ending.borrow() {
                return;
            }
            self.make_standing().await;
            self.0.replicas.lock().await.retain(|_, handle| !handle.requests.is_closed());
            for id in self.abandoned() {
                if let Err(refusal) = self.handle(id).await {
                    tracing::warn!(room = %id, "a room without a host can't be taken over: {refusal}");
                }
            }
        }
    }

    /// Creates the missing standing rooms, and notes which ones the configuration has.
    async fn make_standing(&self) {
        let standing = locked(&self.0.standing, |standing| standing.clone());
        let (mut own, mut is_known) = (BTreeSet::new(), true);
        for (index, request) in standing.iter().enumerate() {
            let number = standing[..index].iter().filter(|other| *other == request).count();
            match self.header(request) {
                Some(header) => match self.make_standing_room(number, header).await {
                    Ok(id) => own.extend(id),
                    Err(_) => is_known = false,
                },
                None => {
                    tracing::error!(
                        level = request.level,
                        "a standing room can't be opened: there is no such level"
                    );
                }
            }
        }
        locked(&self.0.own_standing, |known| {
            if is_known {
                known.clear();
            }
            known.append(&mut own);
        });
        self.show();
    }

    /// Shows the rooms to lobbies.
    fn show(&self) {
        // The lock ensures that an older list never replaces a newer one.
        locked(&self.0.records, |records| {
            let own = locked(&self.0.own_standing, |own| own.clone());
            let summaries = records.iter().filter_map(|(id, known)| {
                let summary = known.record.summary(*id);
                let is_listed =
                    !known.record.stands || own.contains(id) || !summary.members.is_empty();
                is_listed.then_some(summary)
            });
            self.0.context.rooms.show_shared(summaries.collect());
        });
    }

    /// Creates a standing room if it is missing. Returns its number.
    async fn make_standing_room(
        &self,
        number: usize,
        header: Header,
    ) -> Result<Option<RoomId>, BusFault> {
        let bus = &self.0.context.bus;
        // The version is part of the key, because rooms of another version do not exist for this host.
        let Header { level, mode, difficulty, .. } = &header;
        let text = format!("{} {level} {} {}", version(), mode.name(), difficulty.name());
        let hash = rng::hash(number as u64, text.bytes().map(u64::from));
        let key = Key::Standing(format!("{hash:016x}"));
        if bus.get(key.clone()).await?.is_none() {
            let own = bus.next_number().await?;
            match bus.create(key.clone(), own.to_string().into_bytes()).await {
                // Another host was faster.
                Ok(()) | Err(BusFault::Refused) => {}
                Err(fault) => return Err(fault),
            }
        }
        let kept = bus.get(key).await?.unwrap_or_default();
        let kept = str::from_utf8(&kept).ok().and_then(|text| text.parse().ok());
        let Some(id) = kept.map(RoomId) else { return Ok(None) };
        if locked(&self.0.records, |records| records.contains_key(&id)) {
            return Ok(Some(id));
        }
        match bus.create(Key::Room(id), to_bytes(&Record::new(header, true, None))).await {
            Ok(()) | Err(BusFault::Refused) => Ok(Some(id)),
            Err(fault) => Err(fault),
        }
    }

    fn abandoned(&self) -> Vec<RoomId> {
        let now = Instant::now();
        let catalog = self.0.context.rooms.catalog();
        // A host without the level leaves the room to other hosts.
        let is_abandoned = |known: &ReceivedRecord| {
            known.record.is_running
                && now.duration_since(known.since) >= RECORD_TIMEOUT
                && catalog.has(&known.record.level)
        };
        locked(&self.0.records, |records| {
            let abandoned = records.iter().filter(|(_, known)| is_abandoned(known));
            abandoned.map(|(id, _)| *id).collect()
        })
    }

    /// The header of a new room; `None` if there is no such level.
    fn header(&self, request: &RoomRequest) -> Option<Header> {
        let catalog = self.0.context.rooms.catalog();
        let level = catalog.named(&request.level).unwrap_or(&request.level);
        let header =
            || Header::new(level, request.mode, request.difficulty, self.0.context.chance());
        catalog.has(level).then(header)
    }
}

fn not_now(_: BusFault) -> RoomRefusal {
    RoomRefusal::NotNow
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rooms::room::RoomView;

    impl SharedRooms {
        /// The snapshot of a room on this host.
        pub(crate) fn view(&self, id: RoomId) -> Option<Arc<RoomView>> {
            let replicas = self.0.replicas.try_lock().ok()?;
            let handle = replicas.get(&id).filter(|handle| !handle.requests.is_closed())?;
            handle.interface.view()
        }
    }
}
