//! The directory of rooms: which ones there are, and the ways into them.
//!
//! Each room is a task, which a [`Sequencer`] runs. The directory gives out [`Place`]s in rooms; a place
//! that is dropped is left. Lobbies watch a list of [`RoomSummary`], which is replaced when a room
//! changes for them.
//!
//! A standing room that has ended by a panic is opened anew; its members are in the lobby then.

mod ending;
mod place;
mod recording;
mod refusal;
mod shared;
mod standing;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::watch;

pub(crate) use self::place::Place;
pub(crate) use self::recording::Logs;
pub(crate) use self::refusal::RoomRefusal;
use crate::lock::locked;
use crate::ops::config::Config;
use crate::ops::logging::events;
use crate::rooms::room::{Catalog, Header, Mode, Phase, Room};
use crate::rooms::sequencer::{Inbox, RoomInterface, RoundLog, Sequencer, Shown};
use crate::rooms::summary::{RoomId, RoomSummary, RoomWish};
use crate::sessions::line::Line;
use crate::sessions::load::Load;
use cellcaster::rng::SplitMix64;

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
}

impl RoomLimits {
    /// What a configuration allows.
    pub(crate) fn of(config: &Config) -> Self {
        Self {
            most: config.rooms as usize,
            most_watchers: config.watchers as usize,
            closes_after: config.empty_room,
            standing: config.standing.iter().map(|room| room.0.clone()).collect(),
        }
    }
}

#[derive(Debug)]
struct Directory {
    limits: Mutex<RoomLimits>,
    catalog: Arc<Catalog>,
    logs: Logs,
    load: Arc<Load>,
    open: Mutex<OpenRooms>,
    summaries: watch::Sender<Arc<[RoomSummary]>>,
    /// The rooms that this host shares with others.
    shared: Mutex<Vec<RoomSummary>>,
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
    interface: Arc<RoomInterface>,
}

#[derive(Debug)]
struct OpenRoom {
    interface: Arc<RoomInterface>,
    /// Without the number of watchers.
    summary: RoomSummary,
    watchers: Arc<AtomicUsize>,
    /// What it was opened for as a standing room, even if it does not stand any more.
    stood_for: Option<RoomWish>,
}

impl Rooms {
    /// The standing rooms. Each room takes its steps from one of `logs`, and all chance in rooms comes
    /// from `seed`.
    ///
    /// It is to be called within a runtime, on which the rooms run.
    pub(crate) fn new(
        limits: RoomLimits,
        catalog: Arc<Catalog>,
        logs: Logs,
        load: Arc<Load>,
        seed: u64,
    ) -> Self {
        let chance = SplitMix64::new(seed);
        let open = Mutex::new(OpenRooms { last: 0, chance, rooms: BTreeMap::new() });
        let summaries = watch::Sender::new(Arc::from([]));
        let limits = Mutex::new(limits);
        let rooms = Self(Arc::new(Directory {
            limits,
            catalog,
            logs,
            load,
            open,
            summaries,
            shared: Mutex::default(),
        }));
        rooms.open_standing();
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
        let room = self.add(wish, false)?;
        // Before the room runs: one for a single member is closed as soon as nobody is in it.
        let member = room.interface.inbox.join(name).map_err(RoomRefusal::from)?;
        let place = Place::member(room.id, member, Arc::clone(&room.interface));
        self.spawn(room);
        Ok(place)
    }

    /// Joins a room.
    pub(crate) fn enter(&self, id: RoomId, name: &Line) -> Result<Place, RoomRefusal> {
        let interface = locked(&self.0.open, |open| {
            let room = open.rooms.get(&id).ok_or(RoomRefusal::Gone)?;
            match room.summary.mode {
                Mode::Alone => Err(RoomRefusal::Alone),
                _ => Ok(Arc::clone(&room.interface)),
            }
        })?;
        let member = interface.inbox.join(name).map_err(RoomRefusal::from)?;
        Ok(Place::member(id, member, interface))
    }

    /// Watches a room.
    pub(crate) fn watch(&self, id: RoomId) -> Result<Place, RoomRefusal> {
        let most = locked(&self.0.limits, |limits| limits.most_watchers);
        let (interface, watchers) = locked(&self.0.open, |open| {
            let room = open.rooms.get(&id).ok_or(RoomRefusal::Gone)?;
            if room.watchers.fetch_add(1, Ordering::AcqRel) >= most {
                room.watchers.fetch_sub(1, Ordering::AcqRel);
                return Err(RoomRefusal::Full);
            }
            Ok((Arc::clone(&room.interface), Arc::clone(&room.watchers)))
        })?;
        let place = Place::watcher(id, interface, watchers, self.clone());
        self.publish();
        Ok(place)
    }

    /// Adds a room, which does not run yet.
    fn add(&self, wish: &RoomWish, stands: bool) -> Result<NewRoom, RoomRefusal> {
        let Directory { limits, catalog, open, .. } = &*self.0;
        let (most, closes_after) = locked(limits, |it| (it.most, it.closes_after));
        let closes_after = match wish.mode {
            // Nobody else can go on with what one plays alone.
            Mode::Alone => Some(Duration::ZERO),
            _ => (!stands).then_some(closes_after),
        };
        let (id, seed) = locked(open, |open| {
            open.last += 1;
            (RoomId(open.last), open.chance.bits())
        });
        let level = catalog.named(&wish.level).unwrap_or(&wish.level);
        let header = Header::new(level, wish.mode, wish.difficulty, seed);
        let room = Room::new(catalog, header).ok_or(RoomRefusal::NoLevel)?;
        let interface = Arc::new(RoomInterface {
            inbox: Inbox::new(wish.mode, room.next_member()),
            shown: Shown::new(room.view()),
            closes_after: watch::Sender::new(closes_after),
        });
        let open_room = OpenRoom {
            interface: Arc::clone(&interface),
            summary: summary(id, &room),
            watchers: Arc::default(),
            stood_for: stands.then(|| wish.clone()),
        };
        locked(open, |open| {
            let is_allowed = open.rooms.len() < most;
            if is_allowed {
                open.rooms.insert(id, open_room);
            }
            is_allowed.then_some(NewRoom { id, room, interface }).ok_or(RoomRefusal::TooMany)
        })
    }

    /// Runs a room until it is closed.
    fn spawn(&self, new: NewRoom) {
        let NewRoom { id, room, interface } = new;
        let header = room.header();
        events::room_opened(id.0, &header.level, header.mode.name());
        self.publish();
        let log = RoundLog::new(self.0.logs.open(id), &room);
        let load = Arc::clone(&self.0.load);
        let sequencer = Sequencer::new(room, log, interface, load);
        let rooms = self.clone();
        tokio::spawn(async move {
            let ended = sequencer.run(|room| rooms.change(id, room)).await;
            locked(&rooms.0.open, |open| open.rooms.remove(&id));
            rooms.publish();
            match ended {
                Ok(()) => events::room_closed(id.0),
                Err(panic) => {
                    events::room_failed(id.0, panic);
                    rooms.open_standing();
                }
            }
        });
    }

    /// Records what is new in a room.
    fn change(&self, id: RoomId, room: &Room) {
        let is_over = |phase| matches!(phase, Phase::Over { .. });
        let summary = summary(id, room);
        let ends = is_over(summary.phase);
        let before = locked(&self.0.open, |open| {
            let open = open.rooms.get_mut(&id)?;
            Some(std::mem::replace(&mut open.summary, summary))
        });
        if ends && before.is_some_and(|before| !is_over(before.phase)) {
            let view = room.view();
            let winner = view.winner().map(|member| member.name.as_str());
            events::round_ended(id.0, view.step, winner);
        }
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
            let rooms = open.rooms.values().map(summary);
            let rooms = rooms.chain(locked(&self.0.shared, |shared| shared.clone()));
            let summaries: Arc<[RoomSummary]> = rooms.collect();
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
