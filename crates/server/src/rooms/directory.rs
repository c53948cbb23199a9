//! The directory of rooms: lists the rooms and lets visitors in.
//!
//! Each room is a task, which a [`Sequencer`] runs. The directory issues [`Place`]s in rooms; a visitor
//! leaves a room when their place is dropped. Lobbies watch a list of [`RoomSummary`], which is replaced
//! whenever a change of a room is visible in the lobby.
//!
//! If a standing room panics, the directory opens a new one in its place. The members of the old room go back
//! to the lobby.

mod recording;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::future::poll_fn;
use std::sync::{Arc, Mutex, Weak};
use std::task::Poll;
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::{Instant, timeout};

pub(crate) use self::recording::{CAST, PublicRecording, RecordingBounds, Recordings};
use crate::accounts::Day;
use crate::line::Line;
use crate::load::Load;
use crate::lock::locked;
use crate::logging;
use crate::rooms::invitation::RoomCode;
use crate::rooms::room::{Catalog, Command, Header, MemberId, Mode, Phase, Room, RoomView};
use crate::rooms::sequencer::{FinishedRun, RoomInterface, RoundLog, Sequencer, StepAlarm};
pub(crate) use crate::rooms::summary::RoomRefusal;
use crate::rooms::summary::{RoomId, RoomRequest, RoomSummary};
use cellcaster::rng::SplitMix64;

/// How long [`Rooms::end`] waits for the rooms to close.
const SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(1);
/// Shown to a member who was removed.
const DISMISSED: &str = "This host was cut off from the room for too long; enter it again.";

/// The rooms of a server. Clones share the same rooms.
#[derive(Clone, Debug)]
pub(crate) struct Rooms(Arc<Directory>);

/// A host's limits for its rooms.
#[derive(Clone, Debug)]
pub(crate) struct RoomLimits {
    /// The maximum number of rooms.
    pub(crate) most: usize,
    /// The maximum number of watchers per room.
    pub(crate) most_watchers: usize,
    /// How long a room stays open without members.
    pub(crate) closes_after: Duration,
    /// The rooms that are always open.
    pub(crate) standing: Vec<RoomRequest>,
}

#[derive(Debug)]
struct Directory {
    catalog: Arc<Catalog>,
    recordings: Recordings,
    load: Arc<Load>,
    summaries: watch::Sender<Arc<[RoomSummary]>>,
    state: Mutex<DirectoryState>,
}

/// The seeds of a host's chance.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Seeds {
    /// Determines all chance in the rooms. Recordings reveal it.
    pub(crate) rooms: u64,
    /// Determines the invitation codes.
    pub(crate) codes: u64,
}

#[derive(Debug)]
struct DirectoryState {
    limits: RoomLimits,
    /// By the host's clock.
    today: Day,
    /// The number of the newest room.
    last: u32,
    /// All chance in the rooms.
    chance: SplitMix64,
    /// The generator of invitation codes.
    codes: SplitMix64,
    rooms: BTreeMap<RoomId, OpenRoom>,
    /// The rooms that this host shares with other hosts.
    shared: Vec<RoomSummary>,
    /// Those of the shared rooms that somebody has entered on this host.
    entered: BTreeMap<RoomId, Weak<RoomInterface>>,
    /// The browsers that watch rooms on this host.
    browsers: BTreeMap<RoomId, usize>,
}

/// A room that is not running yet.
type NewRoom = (RoomId, Room, Arc<RoomInterface>);

#[derive(Debug)]
struct OpenRoom {
    interface: Arc<RoomInterface>,
    /// The summary, without the number of watchers and the code.
    summary: RoomSummary,
    /// The standing room for which it was opened, even if that request has been withdrawn since.
    stood_for: Option<RoomRequest>,
}

impl Rooms {
    /// Opens the standing rooms on the current runtime.
    pub(crate) fn new(
        limits: RoomLimits,
        catalog: Arc<Catalog>,
        recordings: Recordings,
        load: Arc<Load>,
        seeds: Seeds,
    ) -> Self {
        let state = DirectoryState {
            limits,
            today: Day::default(),
            last: 0,
            chance: SplitMix64::new(seeds.rooms),
            codes: SplitMix64::new(seeds.codes),
            rooms: BTreeMap::new(),
            shared: Vec::new(),
            entered: BTreeMap::new(),
            browsers: BTreeMap::new(),
        };
        let (summaries, state) = (watch::Sender::new(Arc::from([])), Mutex::new(state));
        let rooms = Self(Arc::new(Directory { catalog, recordings, load, summaries, state }));
        rooms.open_standing();
        rooms
    }

    /// The levels that a room can be played in.
    pub(crate) fn catalog(&self) -> &Arc<Catalog> {
        &self.0.catalog
    }

    /// The day whose daily level lobbies offer.
    pub(crate) fn today(&self) -> Day {
        self.locked(|it| it.today)
    }

    /// Records the day by the host's clock, and tells the lobbies.
    pub(crate) fn set_today(&self, today: Day) {
        self.locked(|it| it.today = today);
        self.publish();
    }

    /// The recordings of rooms.
    pub(crate) fn recordings(&self) -> &Recordings {
        &self.0.recordings
    }

    /// The list of rooms that lobbies show.
    pub(crate) fn summaries(&self) -> watch::Receiver<Arc<[RoomSummary]>> {
        self.0.summaries.subscribe()
    }

    /// Opens a room and joins it. Others enter a private room with its code only.
    pub(crate) fn open(
        &self,
        request: &RoomRequest,
        is_private: bool,
        name: &Line,
    ) -> Result<Place, RoomRefusal> {
        let (id, room, interface) =
            self.add(request, false, is_private.then(|| self.new_code()))?;
        // Join before the room runs: a room for a single member closes as soon as it is empty.
        let member = interface.inbox.join(name)?;
        let place = Place::member(id, member, Arc::clone(&interface));
        self.spawn((id, room, interface));
        Ok(place)
    }

    /// Joins a room.
    pub(crate) fn enter(&self, id: RoomId, name: &Line) -> Result<Place, RoomRefusal> {
        let interface = self.locked(|it| {
            let room = it.rooms.get(&id).ok_or(RoomRefusal::Gone)?;
            match room.summary.mode {
                Mode::Alone => Err(RoomRefusal::Alone),
                _ => Ok(Arc::clone(&room.interface)),
            }
        })?;
        let member = interface.inbox.join(name)?;
        Ok(Place::member(id, member, interface))
    }

    /// Watches a room.
    pub(crate) fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let interface = self.locked(|it| {
            it.rooms.get(&id).map(|room| Arc::clone(&room.interface)).ok_or(RoomRefusal::Gone)
        })?;
        let place = self.place_to_watch(id, interface)?;
        self.publish();
        Ok(place)
    }

    /// A watcher's place, if the room has fewer watchers than the host allows.
    pub(crate) fn place_to_watch(
        &self,
        id: RoomId,
        interface: Arc<RoomInterface>,
    ) -> Result<Place, RoomRefusal> {
        if interface.add_watcher(self.limits().most_watchers) {
            Ok(Place::new(id, Occupant::Watcher(self.clone()), interface))
        } else {
            Err(RoomRefusal::Full)
        }
    }

    /// The latest snapshot of a room that runs on this host.
    pub(crate) fn view(&self, id: RoomId) -> Option<Arc<RoomView>> {
        let interface = self.locked(|it| match it.rooms.get(&id) {
            Some(room) => Some(Arc::clone(&room.interface)),
            None => it.entered.get(&id)?.upgrade(),
        });
        interface?.view()
    }

    /// Records that this host runs a shared room.
    pub(crate) fn note_entered(&self, id: RoomId, interface: &Arc<RoomInterface>) {
        self.locked(|it| {
            it.entered.retain(|_, interface| interface.strong_count() > 0);
            it.entered.insert(id, Arc::downgrade(interface));
        });
    }

    /// Records the number of browsers that watch a room on this host, and tells the lobbies if it has changed.
    pub(crate) fn note_browsers(&self, id: RoomId, count: usize) {
        let before = self.locked(|it| match count {
            0 => it.browsers.remove(&id),
            count => it.browsers.insert(id, count),
        });
        if before.unwrap_or_default() != count {
            self.publish();
        }
    }

    /// A code for a new private room.
    pub(crate) fn new_code(&self) -> RoomCode {
        self.locked(|it| RoomCode::random(&mut it.codes))
    }

    /// The private room with this code.
    pub(crate) fn with_code(&self, code: RoomCode) -> Option<RoomId> {
        let summaries = self.0.summaries.borrow();
        summaries.iter().find(|room| room.code == Some(code)).map(|room| room.id)
    }

    /// The host's limits.
    pub(crate) fn limits(&self) -> RoomLimits {
        self.locked(|it| it.limits.clone())
    }

    /// Replaces the host's limits. New standing rooms open. Rooms that are no longer standing close once they
    /// are empty, like any other room. The other limits apply from now on.
    pub(crate) fn set_limits(&self, limits: RoomLimits) {
        self.locked(|it| it.limits = limits);
        self.open_standing();
        self.publish();
    }

    /// Adds the rooms that this host shares with other hosts to the lobby's list.
    pub(crate) fn show_shared(&self, rooms: Vec<RoomSummary>) {
        self.locked(|it| it.shared = rooms);
        self.publish();
    }

    /// Closes all rooms and waits until their recordings are written, for at most [`SHUTDOWN_TIMEOUT`].
    pub(crate) async fn end(&self) {
        let interfaces: Vec<Arc<RoomInterface>> =
            self.locked(|it| it.rooms.values().map(|room| Arc::clone(&room.interface)).collect());
        for interface in &interfaces {
            interface.close("The server has ended.");
        }
        let mut summaries = self.summaries();
        let all_closed = async { _ = summaries.wait_for(|rooms| rooms.is_empty()).await };
        _ = timeout(SHUTDOWN_TIMEOUT, all_closed).await;
    }

    /// Opens the missing standing rooms, and lets rooms that are no longer wanted close.
    fn open_standing(&self) {
        let missing = self.locked(|it| {
            let mut missing = it.limits.standing.clone();
            let closes_after = it.limits.closes_after;
            for room in it.rooms.values() {
                let Some(request) = &room.stood_for else { continue };
                let wanted = missing.iter().position(|missing| missing == request);
                match wanted.filter(|_| !room.interface.inbox.is_closed()) {
                    Some(index) => {
                        missing.remove(index);
                        room.interface.closes_after.send_replace(None);
                    }
                    None => _ = room.interface.closes_after.send_replace(Some(closes_after)),
                }
            }
            missing
        });
        for request in missing {
            match self.add(&request, true, None) {
                Ok(room) => self.spawn(room),
                Err(refusal) => tracing::error!(
                    level = request.level,
                    "a standing room can't be opened: {refusal}"
                ),
            }
        }
    }

    /// Adds a room without running it.
    fn add(
        &self,
        request: &RoomRequest,
        stands: bool,
        code: Option<RoomCode>,
    ) -> Result<NewRoom, RoomRefusal> {
        let catalog = self.catalog();
        let (id, seed, closes_after) = self.locked(|it| {
            it.last += 1;
            (RoomId(it.last), it.chance.bits(), it.limits.closes_after)
        });
        let level = catalog.named(&request.level).unwrap_or(&request.level);
        let header = Header::new(level, request.mode, request.difficulty, seed);
        let room = Room::new(catalog, header).ok_or(RoomRefusal::NoLevel)?;
        let interface = RoomInterface::new(&room, stands, closes_after, code);
        let open_room = OpenRoom {
            interface: Arc::clone(&interface),
            summary: RoomSummary::of(id, &room),
            stood_for: stands.then(|| request.clone()),
        };
        self.locked(|it| {
            if it.rooms.len() >= it.limits.most {
                return Err(RoomRefusal::TooMany);
            }
            it.rooms.insert(id, open_room);
            Ok((id, room, interface))
        })
    }

    /// Runs a room until it closes.
    fn spawn(&self, (id, room, interface): NewRoom) {
        let header = room.header();
        logging::room_opened(id.0, &header.level, header.mode.name());
        self.publish();
        let log = RoundLog::new(self.0.recordings.open(id, interface.code.is_some()), &room);
        let load = Arc::clone(&self.0.load);
        let sequencer = Sequencer { room, log, interface, load };
        let rooms = self.clone();
        tokio::spawn(async move {
            let ended = sequencer.run(|room| rooms.change(id, room)).await;
            rooms.locked(|it| it.rooms.remove(&id));
            rooms.publish();
            match ended {
                Ok(()) => logging::room_closed(id.0),
                Err(panic) => {
                    logging::room_failed(id.0, panic);
                    rooms.open_standing();
                }
            }
        });
    }

    /// Updates a room's summary, and logs the end of a round.
    fn change(&self, id: RoomId, room: &Room) {
        let is_over = |phase| matches!(phase, Phase::Over { .. });
        let summary = RoomSummary::of(id, room);
        let ends = is_over(summary.phase);
        let before =
            self.locked(|it| Some(std::mem::replace(&mut it.rooms.get_mut(&id)?.summary, summary)));
        if ends && before.is_some_and(|before| !is_over(before.phase)) {
            let view = room.view();
            let winner = view.winner().map(|member| member.name.as_str());
            logging::round_ended(id.0, view.step, winner);
        }
        self.publish();
    }

    /// Publishes the current rooms to all lobbies.
    fn publish(&self) {
        let metrics = &self.0.load.metrics;
        // Sent under the lock, so that an older list never replaces a newer one.
        self.locked(|it| {
            let own = it.rooms.values().map(|room| RoomSummary {
                watchers: room.interface.watchers(),
                code: room.interface.code,
                ..room.summary.clone()
            });
            let listed = own.chain(it.shared.iter().cloned()).map(|room| RoomSummary {
                browsers: it.browsers.get(&room.id).copied().unwrap_or_default(),
                ..room
            });
            let summaries: Arc<[RoomSummary]> = listed.collect();
            metrics.rooms.set(summaries.len() as i64);
            metrics.members.set(summaries.iter().map(|room| room.members.len() as i64).sum());
            metrics.watchers.set(summaries.iter().map(|room| room.watchers as i64).sum());
            self.0.summaries.send_replace(summaries);
        });
    }

    fn locked<T>(&self, run: impl FnOnce(&mut DirectoryState) -> T) -> T {
        locked(&self.0.state, run)
    }
}

/// A visitor's place in a room, as a member or a watcher. Dropping it takes the visitor out of the room, or
/// marks them away if their host is shutting down.
#[derive(Debug)]
pub(crate) struct Place {
    room: RoomId,
    role: Occupant,
    interface: Arc<RoomInterface>,
    /// The number of the member's seat. A member who was removed and returns through another connection gets
    /// another seat.
    seat: Option<u64>,
    /// Whether dropping the place marks the member away instead of leaving.
    is_kept: bool,
    /// The number of snapshots at the last [`Place::view`].
    seen: u64,
    alarm: Arc<StepAlarm>,
}

#[derive(Debug)]
enum Occupant {
    Member(MemberId),
    Watcher(Rooms),
}

impl Place {
    pub(crate) fn member(room: RoomId, member: MemberId, interface: Arc<RoomInterface>) -> Self {
        Self::new(room, Occupant::Member(member), interface)
    }

    fn new(room: RoomId, role: Occupant, interface: Arc<RoomInterface>) -> Self {
        let seat = match role {
            Occupant::Member(member) => interface.inbox.seat_number(member),
            Occupant::Watcher(_) => None,
        };
        let (seen, alarm) = (interface.snapshots(), interface.alarm());
        Self { room, role, interface, seat, is_kept: false, seen, alarm }
    }

    pub(crate) fn room(&self) -> RoomId {
        self.room
    }

    /// The member's number; `None` for a watcher.
    pub(crate) fn member_id(&self) -> Option<MemberId> {
        match self.role {
            Occupant::Member(member) => Some(member),
            Occupant::Watcher(_) => None,
        }
    }

    /// The invitation code, if the room is private.
    pub(crate) fn code(&self) -> Option<RoomCode> {
        self.interface.code
    }

    /// The latest snapshot; `None` after a fault of the room.
    pub(crate) fn view(&mut self) -> Option<Arc<RoomView>> {
        self.seen = self.interface.snapshots();
        self.interface.view()
    }

    /// The sentence that says why the room is closed to this visitor, if it is.
    pub(crate) fn closed(&self) -> Option<Arc<str>> {
        let closed = self.interface.closed().cloned();
        closed.or_else(|| self.is_dismissed().then(|| DISMISSED.into()))
    }

    /// Returns true if the member was removed while the room goes on.
    fn is_dismissed(&self) -> bool {
        self.member_id().is_some_and(|member| {
            self.seat.is_none() || self.interface.inbox.seat_number(member) != self.seat
        })
    }

    /// Sets whether the room keeps the seat when the place is dropped because the host is shutting down.
    pub(crate) fn set_kept(&mut self, is_kept: bool) {
        self.is_kept = is_kept;
    }

    /// Waits until `due` and for a snapshot newer than the last [`Place::view`], or for the room to close.
    pub(crate) async fn changed(&self, due: Instant) {
        poll_fn(|context| {
            self.alarm.set(due, context.waker());
            let is_newer = self.interface.snapshots() != self.seen && Instant::now() >= due;
            let is_over = is_newer || self.interface.closed().is_some();
            if is_over { Poll::Ready(()) } else { Poll::Pending }
        })
        .await;
    }

    /// Submits a command to the room. Returns false if it is not for members, or the visitor is none.
    pub(crate) fn act(&self, command: Command) -> bool {
        let member = self.member_id().filter(|_| !self.is_dismissed());
        member.is_some_and(|member| self.interface.inbox.act(member, command))
    }

    /// The run that the visitor has finished since the last call, if any.
    pub(crate) fn finished(&self) -> Option<FinishedRun> {
        self.interface.inbox.finished(self.member_id()?)
    }
}

impl Drop for Place {
    fn drop(&mut self) {
        self.interface.remove_alarm(&self.alarm);
        match &self.role {
            Occupant::Member(_) if self.is_dismissed() => {}
            Occupant::Member(member) if self.is_kept => self.interface.inbox.part(*member),
            Occupant::Member(member) => self.interface.inbox.leave(*member),
            Occupant::Watcher(rooms) => {
                self.interface.remove_watcher();
                rooms.publish();
            }
        }
    }
}
