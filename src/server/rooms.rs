//! The directory of rooms: which ones there are, and the ways into them.
//!
//! Each room is a task, which a [`Sequencer`] runs. The directory gives out [`Place`]s in rooms; a place
//! that is dropped is left. Lobbies watch a list of [`RoomSummary`], which is replaced when a room
//! changes for them.

mod place;
mod recording;

use std::collections::BTreeMap;
use std::fmt;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::watch;
use tokio::time::timeout;

pub(crate) use self::place::Place;
pub(crate) use self::recording::Recordings;
use super::line::Line;
use super::load::Load;
use super::locked;
use super::logging::events;
use super::room::{Catalog, Header, Mode, Room};
use super::sequencer::{Doorway, Inbox, JoinRefusal, RoundLog, Sequencer, Shown};
use super::summary::{RoomId, RoomSummary, RoomWish};
use crate::rng::SplitMix64;

/// The rooms of a server. Clones are the same rooms.
#[derive(Clone, Debug)]
pub(crate) struct Rooms(Arc<Directory>);

/// What a host allows of rooms.
#[derive(Clone, Debug)]
pub(crate) struct RoomLimits {
    /// The most rooms.
    pub(crate) most: usize,
    /// The most who watch one room.
    pub(crate) most_watchers: usize,
    /// The time without members after which a room is closed.
    pub(crate) closes_after: Duration,
    /// The rooms that are always there.
    pub(crate) standing: Vec<RoomWish>,
    /// Where rooms are recorded.
    pub(crate) recordings: Recordings,
}

/// Why somebody cannot be in a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum RoomRefusal {
    /// There is no such room any more.
    Gone,
    /// It is full.
    Full,
    /// One plays alone in it.
    Alone,
    /// There are as many rooms as the host allows.
    TooMany,
    /// There is no such level.
    NoLevel,
}

#[derive(Debug)]
struct Directory {
    limits: RoomLimits,
    catalog: Arc<Catalog>,
    load: Arc<Load>,
    open: Mutex<OpenRooms>,
    summaries: watch::Sender<Arc<[RoomSummary]>>,
}

#[derive(Debug)]
struct OpenRooms {
    /// The number of the newest room.
    last: u32,
    chance: SplitMix64,
    rooms: BTreeMap<RoomId, OpenRoom>,
}

/// A room that does not run yet.
struct NewRoom {
    id: RoomId,
    room: Room,
    doorway: Arc<Doorway>,
}

#[derive(Debug)]
struct OpenRoom {
    doorway: Arc<Doorway>,
    /// Without the number of watchers.
    summary: RoomSummary,
    watchers: Arc<AtomicUsize>,
}

/// The time in which rooms end.
const ENDING: Duration = Duration::from_secs(1);

impl Rooms {
    /// The standing rooms. All chance in rooms comes from `seed`.
    ///
    /// It is to be called within a runtime, on which the rooms run.
    pub(crate) fn new(
        limits: RoomLimits,
        catalog: Arc<Catalog>,
        load: Arc<Load>,
        seed: u64,
    ) -> Self {
        let chance = SplitMix64::new(seed);
        let open = Mutex::new(OpenRooms { last: 0, chance, rooms: BTreeMap::new() });
        let summaries = watch::Sender::new(Arc::from([]));
        let rooms = Self(Arc::new(Directory { limits, catalog, load, open, summaries }));
        for wish in &rooms.0.limits.standing {
            match rooms.add(wish) {
                Ok(room) => rooms.spawn(room, None),
                Err(refusal) => tracing::error!(level = wish.level, "no standing room: {refusal}"),
            }
        }
        rooms
    }

    /// The levels that rooms can be in.
    pub(crate) fn catalog(&self) -> &Arc<Catalog> {
        &self.0.catalog
    }

    /// The rooms, as lobbies show them.
    pub(crate) fn summaries(&self) -> watch::Receiver<Arc<[RoomSummary]>> {
        self.0.summaries.subscribe()
    }

    /// Opens a room, and joins it.
    pub(crate) fn open(&self, wish: &RoomWish, name: &Line) -> Result<Place, RoomRefusal> {
        let room = self.add(wish)?;
        // Before the room runs: one for a single member is closed as soon as nobody is in it.
        let member = room.doorway.inbox.join(name).map_err(RoomRefusal::from)?;
        let place = Place::member(room.id, member, Arc::clone(&room.doorway));
        self.spawn(room, Some(self.0.limits.closes_after));
        Ok(place)
    }

    /// Joins a room.
    pub(crate) fn enter(&self, id: RoomId, name: &Line) -> Result<Place, RoomRefusal> {
        let doorway = locked(&self.0.open, |open| {
            let room = open.rooms.get(&id).ok_or(RoomRefusal::Gone)?;
            match room.summary.mode {
                Mode::Alone => Err(RoomRefusal::Alone),
                _ => Ok(Arc::clone(&room.doorway)),
            }
        })?;
        let member = doorway.inbox.join(name).map_err(RoomRefusal::from)?;
        Ok(Place::member(id, member, doorway))
    }

    /// Watches a room.
    pub(crate) fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let most = self.0.limits.most_watchers;
        let (doorway, watchers) = locked(&self.0.open, |open| {
            let room = open.rooms.get(&id).ok_or(RoomRefusal::Gone)?;
            if room.watchers.fetch_add(1, Ordering::AcqRel) >= most {
                room.watchers.fetch_sub(1, Ordering::AcqRel);
                return Err(RoomRefusal::Full);
            }
            Ok((Arc::clone(&room.doorway), Arc::clone(&room.watchers)))
        })?;
        let place = Place::watcher(id, doorway, watchers, self.clone());
        self.publish();
        Ok(place)
    }

    /// Closes all rooms, and waits until their recordings are written, for [`ENDING`] at most.
    pub(crate) async fn end(&self) {
        let doorways: Vec<Arc<Doorway>> = locked(&self.0.open, |open| {
            open.rooms.values().map(|room| Arc::clone(&room.doorway)).collect()
        });
        doorways.iter().for_each(|doorway| doorway.close("The server has ended."));
        let mut summaries = self.summaries();
        let all_closed = async { _ = summaries.wait_for(|rooms| rooms.is_empty()).await };
        _ = timeout(ENDING, all_closed).await;
    }

    /// The newest snapshot of a room; `None` if there is no such room.
    #[cfg(test)]
    pub(crate) fn view(&self, id: RoomId) -> Option<Arc<super::room::RoomView>> {
        locked(&self.0.open, |open| open.rooms.get(&id).and_then(|room| room.doorway.shown.view()))
    }

    /// Ends a room as a fault does.
    #[cfg(test)]
    pub(crate) fn close(&self, id: RoomId, sentence: &str) {
        locked(&self.0.open, |open| open.rooms[&id].doorway.close(sentence));
    }

    /// Adds a room, which does not run yet.
    fn add(&self, wish: &RoomWish) -> Result<NewRoom, RoomRefusal> {
        let Directory { limits, catalog, open, .. } = &*self.0;
        let (id, seed) = locked(open, |open| {
            open.last += 1;
            (RoomId(open.last), open.chance.bits())
        });
        let header = Header::new(&wish.level, wish.mode, wish.difficulty, seed);
        let room = Room::new(catalog, header).ok_or(RoomRefusal::NoLevel)?;
        let doorway = Arc::new(Doorway {
            inbox: Inbox::new(wish.mode, room.next_member()),
            shown: Shown::new(room.view()),
        });
        let open_room = OpenRoom {
            doorway: Arc::clone(&doorway),
            summary: summary(id, &room),
            watchers: Arc::default(),
        };
        locked(open, |open| {
            let is_allowed = open.rooms.len() < limits.most;
            if is_allowed {
                open.rooms.insert(id, open_room);
            }
            is_allowed.then_some(NewRoom { id, room, doorway }).ok_or(RoomRefusal::TooMany)
        })
    }

    /// Runs a room until it is closed.
    fn spawn(&self, new: NewRoom, closes_after: Option<Duration>) {
        let NewRoom { id, room, doorway } = new;
        let header = room.header();
        events::room_opened(id.0, &header.level, header.mode.name());
        self.publish();
        let log = RoundLog::new(self.0.limits.recordings.log(id), &room);
        let load = Arc::clone(&self.0.load);
        // Nobody else can go on with what one plays alone.
        let is_alone = room.header().mode == Mode::Alone;
        let closes_after = if is_alone { Some(Duration::ZERO) } else { closes_after };
        let sequencer = Sequencer::new(room, log, doorway, load, closes_after);
        let rooms = self.clone();
        tokio::spawn(async move {
            sequencer.run(|room| rooms.change(id, summary(id, room))).await;
            locked(&rooms.0.open, |open| open.rooms.remove(&id));
            events::room_closed(id.0);
            rooms.publish();
        });
    }

    fn change(&self, id: RoomId, summary: RoomSummary) {
        locked(&self.0.open, |open| {
            if let Some(room) = open.rooms.get_mut(&id) {
                room.summary = summary;
            }
        });
        self.publish();
    }

    /// Shows all lobbies the present rooms.
    fn publish(&self) {
        let summary = |room: &OpenRoom| RoomSummary {
            watchers: room.watchers.load(Ordering::Acquire),
            ..room.summary.clone()
        };
        // Under the lock, so that an older list never replaces a newer one.
        locked(&self.0.open, |open| {
            let summaries: Arc<[RoomSummary]> = open.rooms.values().map(summary).collect();
            let metrics = self.0.load.metrics();
            metrics.rooms.set(summaries.len() as i64);
            metrics.members.set(summaries.iter().map(|room| room.members.len() as i64).sum());
            metrics.watchers.set(summaries.iter().map(|room| room.watchers as i64).sum());
            self.0.summaries.send_replace(summaries);
        });
    }
}

/// A room as lobbies show it, without those who watch.
fn summary(id: RoomId, room: &Room) -> RoomSummary {
    let header = room.header();
    RoomSummary {
        id,
        level: header.level.clone(),
        mode: header.mode,
        difficulty: header.difficulty,
        phase: room.phase(),
        members: room.names().cloned().collect(),
        watchers: 0,
    }
}

impl From<JoinRefusal> for RoomRefusal {
    fn from(refusal: JoinRefusal) -> Self {
        match refusal {
            JoinRefusal::Closed => Self::Gone,
            JoinRefusal::Full => Self::Full,
        }
    }
}

impl fmt::Display for RoomRefusal {
    /// Writes a sentence for the visitor.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Gone => "This room is closed.",
            Self::Full => "This room is full.",
            Self::Alone => "Somebody plays alone in this room; you can watch.",
            Self::TooMany => "There are as many rooms as this server allows; enter one of them.",
            Self::NoLevel => "There is no such level.",
        })
    }
}
