//! Drivers: each connects the link of a visitor with a session, a room and the store.
//!
//! # Rules
//!
//! - A frame is drawn only when the one before has left, from the newest snapshot. Between frames, a
//!   driver holds no snapshot, so that steps do not copy the game.
//! - Frames of large windows are drawn on threads of their own, at most one for two processors at a time. On the
//!   threads of the runtime, one session with a window of 500×200 cells delayed the keys of others by up to a whole
//!   frame, since the drawing thread may be the thread that waits for sockets.
//! - Rooms step whether anybody draws or not, see [`Sequencer`](crate::rooms::sequencer::Sequencer).
//! - The store is called on a thread of its own, and no driver waits for it except at the beginning.
//! - A result counts when the store's thread has replayed its script. One that the store can't take now, because it
//!   is away or full, waits in a file or in memory, and is recorded later.

mod login;
mod results;
#[cfg(test)]
mod simulated;
mod visit;

use std::io;
use std::num::NonZero;
use std::sync::atomic::AtomicU32;
use std::sync::{Arc, Mutex, Weak};
use std::thread::available_parallelism;
use std::time::Duration;

use tokio::sync::{Notify, Semaphore, watch};
use tokio::time::{Instant, interval, timeout};

use self::results::Recorder;
#[cfg(test)]
pub(crate) use self::simulated::{Setup, Simulated, Visiting};
use self::visit::Driver;
use crate::accounts::worker::StoreWorker;
use crate::accounts::{HostStore, WaitingResults};
use crate::admin::RoomRow;
use crate::cluster::{Cluster, SharedRooms};
use crate::config::{Config, LiveConfig};
use crate::line::Line;
use crate::load::{Governor, Load};
use crate::metrics::Metrics;
use crate::operator::Operator;
use crate::rooms::directory::{Recordings, Rooms};
use crate::rooms::ghost::KeptRuns;
use crate::rooms::room::Catalog;
use crate::rooms::summary::RoomSummary;
use crate::ssh::{Departure, Host, Link, Visitor};
use crate::visitors::Visitors;

/// The host of the game: rooms, accounts, and a session for each visitor.
pub struct GameHost {
    shared: Arc<Shared>,
}

/// State shared by all drivers.
struct Shared {
    config: LiveConfig,
    metrics: Arc<Metrics>,
    visitors: Visitors,
    begun: Instant,
    rooms: Rooms,
    /// In a cluster, the ways into rooms.
    cluster: Option<SharedRooms>,
    store: StoreWorker,
    recorder: Recorder,
    /// The runs of boards that walk along. Only the thread of the store uses them.
    runs: Arc<Mutex<KeptRuns>>,
    load: Arc<Load>,
    /// The large frames that may be drawn at a time.
    large_frames: Arc<Semaphore>,
    next_guest: AtomicU32,
}

/// The time between two decisions of the governor.
const GOVERNED: Duration = Duration::from_millis(250);
/// The most calls of the store that wait.
const MOST_CALLS: usize = 256;
/// The most time that the store has for its end.
const STORE_END: Duration = Duration::from_secs(10);

/// The parts of a [`GameHost`], before it runs.
pub struct HostParts {
    pub(crate) live: LiveConfig,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) visitors: Visitors,
    pub(crate) catalog: Catalog,
    pub(crate) recordings: Recordings,
    pub(crate) load: Load,
    pub(crate) store: StoreWorker,
    /// The results that wait for the store. Those that come while it is away wait there, too.
    pub(crate) waiting: Option<WaitingResults>,
    /// The seed of all chance in rooms.
    pub(crate) seed: u64,
    /// The cluster whose rooms the host shares.
    pub(crate) cluster: Option<Cluster>,
}

impl HostParts {
    /// The parts of a host that keeps accounts and results in `store`, with the built-in levels. It adds to
    /// `metrics`, and its sessions are among `visitors`.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn new(
        live: LiveConfig,
        metrics: Arc<Metrics>,
        visitors: Visitors,
        store: HostStore,
    ) -> io::Result<Self> {
        Ok(Self {
            visitors,
            catalog: Catalog::builtin(),
            recordings: Recordings::in_folder(live.get().recordings.clone()),
            load: Load::new(Arc::clone(&metrics)),
            store: StoreWorker::start("store", MOST_CALLS, store)?,
            waiting: None,
            // Without random numbers from the system there would be no keys, either.
            seed: getrandom::u64().unwrap_or_default(),
            metrics,
            live,
            cluster: None,
        })
    }
}

impl GameHost {
    /// A host of these parts.
    ///
    /// It is to be called within a runtime, on which the rooms run.
    pub fn start(parts: HostParts) -> Self {
        let HostParts { live, metrics, visitors, .. } = parts;
        let (mut limits, load) = (live.get().room_limits(), Arc::new(parts.load));
        // The rooms of a cluster stand on the bus.
        let shared_standing = parts
            .cluster
            .as_ref()
            .map(|_| std::mem::take(&mut limits.standing))
            .unwrap_or_default();
        let catalog = Arc::new(parts.catalog);
        let rooms = Rooms::new(limits, catalog, parts.recordings, Arc::clone(&load), parts.seed);
        let cluster = parts.cluster.map(|cluster| {
            cluster.rooms(&rooms, shared_standing, Arc::clone(&load), visitors.clone())
        });
        let recorder = Recorder {
            catalog: Arc::clone(rooms.catalog()),
            metrics: Arc::clone(&metrics),
            visitors: visitors.clone(),
            waiting: parts.waiting.map(|waiting| Arc::new(Mutex::new(waiting))),
        };
        let processors = available_parallelism().map_or(1, NonZero::get);
        let shared = Arc::new(Shared {
            config: live,
            metrics,
            visitors,
            begun: Instant::now(),
            rooms,
            cluster,
            store: parts.store,
            recorder,
            runs: Arc::default(),
            load,
            large_frames: Arc::new(Semaphore::new((processors / 2).max(1))),
            next_guest: AtomicU32::new(1),
        });
        tokio::spawn(govern(Arc::downgrade(&shared)));
        tokio::spawn(follow_limits(
            shared.config.subscribe(),
            shared.rooms.clone(),
            shared.cluster.clone(),
        ));
        if shared.recorder.waiting.is_some() {
            tokio::spawn(results::record_all(Arc::downgrade(&shared)));
        }
        Self { shared }
    }

    /// Ends the rooms after the last session, so that their recordings are whole, and then the store, after
    /// all that was asked of it.
    pub fn ending(&self) -> impl Future<Output = ()> + use<> {
        let shared = Arc::clone(&self.shared);
        async move {
            if let Some(rooms) = &shared.cluster {
                rooms.end().await;
            }
            shared.rooms.end().await;
            let recorder = shared.recorder.clone();
            let ended = shared.store.call(move |store| recorder.end(store));
            _ = timeout(STORE_END, ended).await;
        }
    }

    /// An operator of this host, who notifies `drain` to end it.
    pub fn operator(&self, drain: Arc<Notify>) -> Operator {
        let Shared { visitors, cluster, .. } = &*self.shared;
        Operator::new(visitors.clone(), self.room_rows(), drain, cluster.clone())
    }

    /// Lists the rooms, for an operator.
    pub fn room_rows(&self) -> impl Fn() -> Vec<RoomRow> + Send + Sync + use<> {
        let summaries = self.shared.rooms.summaries();
        let catalog = Arc::clone(self.shared.rooms.catalog());
        move || summaries.borrow().iter().map(|room| room_row(room, &catalog)).collect()
    }
}

fn room_row(room: &RoomSummary, catalog: &Catalog) -> RoomRow {
    RoomRow {
        room: room.id.0,
        mode: room.mode.name().to_owned(),
        level: catalog.short(&room.level).to_owned(),
        difficulty: room.difficulty.name().to_owned(),
        members: room.members.iter().map(Line::to_string).collect(),
        most: room.mode.most(),
        watchers: room.watchers,
    }
}

impl Host for GameHost {
    async fn serve(&self, visitor: Visitor, mut link: Link) -> Departure {
        let shared = Arc::clone(&self.shared);
        if let Some(sentence) = login::terminal_refusal(&visitor) {
            return refuse(link, &sentence, Departure::REFUSED).await;
        }
        let known = match shared.log_in(&visitor).await {
            Ok(known) => known,
            Err((sentence, departure)) => return refuse(link, &sentence, departure).await,
        };
        let _counted = match shared.begin_visit(&visitor, known.key).await {
            Ok(counted) => counted,
            Err((sentence, departure)) => return refuse(link, &sentence, departure).await,
        };
        let options = login::terminal_options(&visitor);
        let mut driver = Driver::new(shared, &visitor, known, options);
        driver.look_for_place();
        Departure { status: driver.run(&mut link).await, refusal: None }
    }
}

impl Shared {
    /// The time since the server began.
    fn now(&self) -> Duration {
        self.begun.elapsed()
    }
}

/// Tells somebody who may not play why, and returns their `departure`.
async fn refuse(link: Link, sentence: &str, departure: Departure) -> Departure {
    let Link { mut outbox, .. } = link;
    _ = outbox.try_send(format!("{sentence}\r\n").into_bytes());
    outbox.drained().await;
    departure
}

/// Tells the rooms what the host allows, whenever the configuration is read again.
async fn follow_limits(
    mut config: watch::Receiver<Arc<Config>>,
    rooms: Rooms,
    cluster: Option<SharedRooms>,
) {
    while config.changed().await.is_ok() {
        let limits = config.borrow_and_update().room_limits();
        match &cluster {
            Some(cluster) => cluster.set_limits(limits),
            None => rooms.set_limits(limits),
        }
    }
}

/// Sets the frame rate as long as the host exists.
async fn govern(shared: Weak<Shared>) {
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
