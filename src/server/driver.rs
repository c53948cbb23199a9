//! Drivers: each connects the link of a visitor with a session, a room and the store.
//!
//! # Rules
//!
//! - A frame is drawn only when the one before has left, from the newest snapshot. Between frames, a
//!   driver holds no snapshot, so that steps do not copy the game.
//! - Rooms step whether anybody draws or not, see [`Sequencer`](super::sequencer::Sequencer).
//! - The store is called on a thread of its own, and no driver waits for it except at the beginning.
//! - A result counts when the store's thread has replayed its script.

mod account;
mod errands;
mod results;
#[cfg(test)]
mod simulated;
mod store_worker;
mod visit;

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, SystemTime, UNIX_EPOCH};

use tokio::time::{Instant, interval};

use self::account::NamesInUse;
#[cfg(test)]
pub(super) use self::simulated::{Setup, Simulated, Visiting};
use self::store_worker::StoreWorker;
use self::visit::Visit;
use super::governor::Governor;
use super::line::Line;
use super::load::Load;
use super::room::{Catalog, Mode};
use super::rooms::{Recordings, RoomLimits, Rooms};
use super::summary::{RoomSummary, RoomWish};
use super::{Departure, Host, Link, LiveConfig, Metrics, RoomRow, Visitor, Visitors};
use crate::store::host::{HostStore, UnixTime};
use crate::world::Difficulty;

/// The host of the game: rooms, accounts, and a session for each visitor.
#[derive(Debug)]
pub struct GameHost {
    shared: Arc<Shared>,
}

/// The parts of a host.
struct Parts {
    live: LiveConfig,
    metrics: Arc<Metrics>,
    visitors: Visitors,
    catalog: Catalog,
    /// The rooms that are always there.
    standing: Vec<RoomWish>,
    recordings: Recordings,
    load: Load,
    store: StoreWorker,
    /// Of all chance in rooms.
    seed: u64,
}

/// What the drivers have in common.
#[derive(Debug)]
struct Shared {
    config: LiveConfig,
    metrics: Arc<Metrics>,
    visitors: Visitors,
    begun: Instant,
    rooms: Rooms,
    store: StoreWorker,
    names: NamesInUse,
    load: Arc<Load>,
    next_guest: AtomicU32,
}

/// The time between two decisions of the governor.
const GOVERNED: Duration = Duration::from_millis(250);

impl GameHost {
    /// A host that keeps accounts and results in `store`, with the built-in levels. It adds to `metrics`,
    /// and its sessions are among `visitors`.
    ///
    /// It is to be called within a runtime, on which the rooms run.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn new(
        live: LiveConfig,
        metrics: Arc<Metrics>,
        visitors: Visitors,
        store: Box<dyn HostStore>,
    ) -> io::Result<Self> {
        let load = Load::new(Arc::clone(&metrics));
        let config = live.get();
        Ok(Self::of(Parts {
            visitors,
            catalog: Catalog::builtin(),
            standing: standing_rooms(),
            recordings: config.recordings.clone().map_or(Recordings::Nowhere, Recordings::Folder),
            load,
            store: StoreWorker::start(store)?,
            // Without random numbers from the system there would be no keys, either.
            seed: getrandom::u64().unwrap_or_default(),
            metrics,
            live,
        }))
    }

    fn of(parts: Parts) -> Self {
        let Parts { live, metrics, visitors, catalog, standing, recordings, load, store, seed } =
            parts;
        let (config, load) = (live.get(), Arc::new(load));
        let limits = RoomLimits {
            most: config.rooms as usize,
            most_watchers: config.watchers as usize,
            closes_after: config.empty_room,
            standing,
            recordings,
        };
        let rooms = Rooms::new(limits, Arc::new(catalog), Arc::clone(&load), seed);
        let shared = Arc::new(Shared {
            config: live,
            metrics,
            visitors,
            begun: Instant::now(),
            rooms,
            store,
            names: NamesInUse::default(),
            load,
            next_guest: AtomicU32::new(1),
        });
        tokio::spawn(govern(Arc::downgrade(&shared)));
        Self { shared }
    }

    /// Ends the rooms after the last session, so that their recordings are whole.
    pub fn ending(&self) -> impl Future<Output = ()> + use<> {
        let rooms = self.shared.rooms.clone();
        async move { rooms.end().await }
    }

    /// Lists the rooms, for an operator.
    pub fn room_rows(&self) -> impl Fn() -> Vec<RoomRow> + Send + Sync + use<> {
        let summaries = self.shared.rooms.summaries();
        move || summaries.borrow().iter().map(room_row).collect()
    }
}

fn room_row(room: &RoomSummary) -> RoomRow {
    RoomRow {
        room: room.id.0,
        mode: room.mode.name().to_owned(),
        level: room.level.clone(),
        difficulty: room.difficulty.name().to_owned(),
        members: room.members.iter().map(Line::to_string).collect(),
        most: room.mode.most(),
        watchers: room.watchers,
    }
}

impl Host for GameHost {
    async fn serve(&self, visitor: Visitor, mut link: Link) -> Departure {
        let shared = Arc::clone(&self.shared);
        let status = match shared.log_in(&visitor).await {
            Ok(known) => {
                let options = visit::options(&visitor);
                Visit::new(shared, visitor, known, options).run(&mut link).await
            }
            Err(sentence) => {
                refuse(link, &sentence).await;
                1
            }
        };
        Departure { status }
    }
}

impl Shared {
    /// The time since the server began.
    fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    /// The number of the next guest.
    fn guest_number(&self) -> u32 {
        self.next_guest.fetch_add(1, Ordering::Relaxed)
    }
}

/// Tells somebody who may not play why.
async fn refuse(link: Link, sentence: &str) {
    let Link { mut outbox, .. } = link;
    _ = outbox.try_send(format!("{sentence}\r\n").into_bytes());
    outbox.drained().await;
}

/// Sets the frame rate as long as the host exists.
async fn govern(shared: std::sync::Weak<Shared>) {
    let mut governor = Governor::new();
    let mut ticks = interval(GOVERNED);
    loop {
        ticks.tick().await;
        let Some(shared) = shared.upgrade() else { return };
        let most = shared.config.get().frames_per_second;
        let sample = shared.load.sample(GOVERNED);
        shared.load.set_frame_time(governor.decide(sample, most));
    }
}

/// The rooms that are always there: one to walk about in, and one to play in.
fn standing_rooms() -> Vec<RoomWish> {
    let room =
        |mode| RoomWish { level: "museum".to_owned(), mode, difficulty: Difficulty::default() };
    [Mode::Roam, Mode::Tag].map(room).into()
}

/// The time of the clock on the wall.
fn unix_time() -> UnixTime {
    let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    UnixTime::new(time.as_secs())
}
