//! The rooms of a cluster, on one of its hosts: which ones there are, and the ways into them.
//!
//! # Rules
//!
//! - A room is a record that every host knows, and has a number that is never used again. It takes no step
//!   until somebody enters it on some host; then that host has a [`Station`] for it.
//! - A standing room is made by the first host that has it in its configuration.
//! - A room whose record says that a host runs it, and that has not changed for [`ABANDONED`], has lost its host. Any
//!   other host runs it then, until it is empty.

mod standing;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::{mpsc, oneshot, watch};
use tokio::time::{Instant, interval, sleep, timeout};

use super::Company;
use super::bus::{BusFault, Key};
use super::record::Record;
use super::replica::Replica;
use super::station::{Asked, Beginning, Station};
use crate::server::line::Line;
use crate::server::locked;
#[cfg(test)]
use crate::server::room::RoomView;
use crate::server::room::{Header, MemberId, Mode};
use crate::server::rooms::{Place, RoomLimits, RoomRefusal, Rooms};
use crate::server::sequencer::{Doorway, Inbox, Shown};
use crate::server::summary::{RoomId, RoomWish};

/// The time without a change after which the record of a running room says that its host is gone.
const ABANDONED: Duration = Duration::from_secs(15);
/// The time from one look after all rooms to the next.
const TOUR: Duration = Duration::from_secs(5);
/// The most who wait to be asked for a place in one room.
const MOST_ASKED: usize = 64;
/// The time in which rooms are left to other hosts.
const ENDING: Duration = Duration::from_secs(2);
/// How often a room is entered that closes at that moment.
const TRIES: usize = 3;

/// The rooms that a host shares. Clones are the same.
#[derive(Clone)]
pub(in crate::server) struct SharedRooms(Arc<Inner>);

struct Inner {
    company: Arc<Company>,
    /// What lobbies see.
    rooms: Rooms,
    standing: Mutex<Vec<RoomWish>>,
    records: Mutex<BTreeMap<RoomId, Known>>,
    /// Locked while one is made, so that a room has one.
    stations: tokio::sync::Mutex<BTreeMap<RoomId, Door>>,
}

/// A record, and since when it is like that.
struct Known {
    record: Record,
    since: Instant,
}

/// The way into a room of this host.
#[derive(Clone)]
struct Door {
    doorway: Arc<Doorway>,
    watchers: Arc<AtomicUsize>,
    asked: mpsc::Sender<Asked>,
}

impl SharedRooms {
    /// The rooms of a cluster. It is to be called within a runtime, on which they run.
    pub(super) fn new(company: Arc<Company>, rooms: Rooms, standing: Vec<RoomWish>) -> Self {
        let (standing, records) = (Mutex::new(standing), Mutex::default());
        let shared = Self(Arc::new(Inner {
            company,
            rooms,
            standing,
            records,
            stations: tokio::sync::Mutex::default(),
        }));
        tokio::spawn(shared.clone().follow());
        tokio::spawn(shared.clone().look_after());
        shared
    }

    /// Opens a room, and joins it.
    pub(in crate::server) async fn open(
        &self,
        wish: &RoomWish,
        name: &Line,
    ) -> Result<Place, RoomRefusal> {
        let is_full = locked(&self.0.records, |it| it.len()) >= self.0.rooms.limits().most;
        if is_full {
            return Err(RoomRefusal::TooMany);
        }
        let company = &self.0.company;
        let header = self.header(wish).ok_or(RoomRefusal::NoLevel)?;
        let id = RoomId(company.bus.number().await.map_err(not_now)?);
        let record = Record::new(header, false).to_bytes();
        company.bus.create(Key::Room(id), record).await.map_err(not_now)?;
        self.join(id, name).await
    }

    /// Joins a room.
    pub(in crate::server) async fn enter(
        &self,
        id: RoomId,
        name: &Line,
    ) -> Result<Place, RoomRefusal> {
        let mode = locked(&self.0.records, |it| it.get(&id).map(|it| it.record.header.mode));
        if mode == Some(Mode::Alone) {
            return Err(RoomRefusal::Alone);
        }
        self.join(id, name).await
    }

    /// Watches a room.
    pub(in crate::server) async fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let door = self.door(id).await?;
        if door.watchers.fetch_add(1, Ordering::AcqRel) >= self.0.rooms.limits().most_watchers {
            door.watchers.fetch_sub(1, Ordering::AcqRel);
            return Err(RoomRefusal::Full);
        }
        Ok(Place::watcher(id, door.doorway, door.watchers, self.0.rooms.clone()))
    }

    /// Replaces what the host allows.
    pub(in crate::server) fn set_limits(&self, mut limits: RoomLimits) {
        let standing = std::mem::take(&mut limits.standing);
        locked(&self.0.standing, |it| *it = standing);
        self.0.rooms.set_limits(limits);
    }

    /// Leaves all rooms to the other hosts.
    pub(in crate::server) async fn end(&self) {
        self.0.company.ending.send_replace(true);
        let all_ended = async {
            for door in self.0.stations.lock().await.values() {
                door.asked.closed().await;
            }
        };
        _ = timeout(ENDING, all_ended).await;
    }

    /// What this host shows of a room.
    #[cfg(test)]
    pub(super) fn view(&self, id: RoomId) -> Option<Arc<RoomView>> {
        let stations = self.0.stations.try_lock().ok()?;
        let door = stations.get(&id).filter(|door| !door.asked.is_closed())?;
        door.doorway.shown.view()
    }

    async fn join(&self, id: RoomId, name: &Line) -> Result<Place, RoomRefusal> {
        for _ in 0..TRIES {
            let door = self.door(id).await?;
            let (reply, answer) = oneshot::channel::<Result<MemberId, RoomRefusal>>();
            if door.asked.send(Asked { name: name.clone(), reply }).await.is_err() {
                continue;
            }
            if let Ok(answer) = answer.await {
                return Ok(Place::member(id, answer?, door.doorway));
            }
        }
        Err(RoomRefusal::Gone)
    }

    /// The way into a room, which this host has from now on.
    async fn door(&self, id: RoomId) -> Result<Door, RoomRefusal> {
        let Inner { company, stations, .. } = &*self.0;
        let mut stations = stations.lock().await;
        if let Some(door) = stations.get(&id).filter(|door| !door.asked.is_closed()) {
            return Ok(door.clone());
        }
        let talk = company.bus.hear(id).await.map_err(not_now)?;
        let (replica, record) = company.load_replica(id).await?;
        let (asked, asking) = mpsc::channel(MOST_ASKED);
        let (watchers, room) = (Arc::<AtomicUsize>::default(), replica.room());
        let closes_after = match room.header().mode {
            Mode::Alone => Some(Duration::ZERO),
            _ => (!record.stands).then(|| self.0.rooms.limits().closes_after),
        };
        let doorway = Arc::new(Doorway {
            inbox: Inbox::new(room.header().mode, room.next_member()),
            shown: Shown::new(room.view()),
            closes_after: watch::Sender::new(closes_after),
        });
        let door = Door { doorway: Arc::clone(&doorway), watchers: Arc::clone(&watchers), asked };
        let beginning = Beginning { id, record, doorway, watchers, replica, talk, asked: asking };
        tokio::spawn(Station::new(Arc::clone(company), beginning).run());
        stations.insert(id, door.clone());
        Ok(door)
    }

    /// Follows the records of all rooms.
    async fn follow(self) {
        let mut pause = TOUR;
        loop {
            let Ok(mut changes) = self.0.company.bus.watch().await else {
                sleep(std::mem::replace(&mut pause, TOUR)).await;
                continue;
            };
            while let Some((id, bytes)) = changes.recv().await {
                self.note(id, bytes.as_deref());
            }
            sleep(pause).await;
        }
    }

    fn note(&self, id: RoomId, bytes: Option<&[u8]>) {
        // A record that cannot be read is of a room of another version, which is none for this host.
        let record = bytes.and_then(Record::parse);
        let now = Instant::now();
        let summaries = locked(&self.0.records, |records| {
            match record {
                Some(record) => _ = records.insert(id, Known { record, since: now }),
                None => _ = records.remove(&id),
            }
            records.iter().map(|(id, known)| known.record.summary(*id)).collect()
        });
        self.0.rooms.show_shared(summaries);
    }

    /// Makes the standing rooms, forgets stations that have ended, and runs rooms that have lost their host.
    async fn look_after(self) {
        let mut tours = interval(TOUR);
        loop {
            tours.tick().await;
            if *self.0.company.ending.borrow() {
                return;
            }
            self.make_standing().await;
            self.0.stations.lock().await.retain(|_, door| !door.asked.is_closed());
            for id in self.abandoned() {
                if let Err(refusal) = self.door(id).await {
                    tracing::warn!(room = %id, "a room has no host: {refusal}");
                }
            }
        }
    }

    fn abandoned(&self) -> Vec<RoomId> {
        let now = Instant::now();
        let is_abandoned =
            |known: &Known| known.record.is_awake && now.duration_since(known.since) >= ABANDONED;
        locked(&self.0.records, |records| {
            let abandoned = records.iter().filter(|(_, known)| is_abandoned(known));
            abandoned.map(|(id, _)| *id).collect()
        })
    }

    /// The header of a new room. `None` if there is no such level.
    fn header(&self, wish: &RoomWish) -> Option<Header> {
        let catalog = &self.0.company.catalog;
        let level = catalog.named(&wish.level).unwrap_or(&wish.level);
        let header = Header::new(level, wish.mode, wish.difficulty, self.0.company.chance());
        Replica::new(catalog, header.clone()).map(|_| header)
    }
}

impl fmt::Debug for SharedRooms {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedRooms").finish_non_exhaustive()
    }
}

fn not_now(_: BusFault) -> RoomRefusal {
    RoomRefusal::NotNow
}
