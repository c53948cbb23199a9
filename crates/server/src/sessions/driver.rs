//! Drivers: each connects a visitor's link with a session, a room and the store.
//!
//! # Rules
//!
//! - A frame is drawn from the latest snapshot, and only after the previous frame has left. Between frames, a
//!   driver holds no snapshot, so steps need not copy the game.
//! - Frames of large windows are drawn outside of the runtime's threads, at most one per two processors at a
//!   time. On the runtime's threads, a session with a window of 500×200 cells delayed other visitors' keys by
//!   up to a whole frame, because the drawing thread may be the thread that polls the sockets.
//! - Rooms step whether or not a session draws them, see [`Sequencer`](crate::rooms::sequencer::Sequencer).
//! - A muted visitor's talk is stopped before it reaches anybody, see [`talk`].
//! - The store runs on its own thread. A driver waits for it only at the start of a visit.
//! - The host's clock tells the day. [`follow_days`] prepares the daily level. A driver tells its room if the room's
//!   daily level is the level of an earlier day, so that the day is in the room's log.
//! - A result counts once the store's thread has replayed its script. If the store is unreachable or full,
//!   the result waits in a file or in memory, and is recorded later.

mod login;
mod results;
#[cfg(test)]
mod simulated;
mod talk;
mod visit;

use std::io;
use std::num::NonZero;
use std::sync::atomic::AtomicU32;
use std::sync::{Arc, Mutex, Weak};
use std::thread::available_parallelism;
use std::time::Duration;

use tokio::sync::{Semaphore, watch};
use tokio::time::{Instant, interval, timeout};

use self::results::ResultRecorder;
#[cfg(test)]
pub(crate) use self::simulated::{Setup, Simulated, Visiting};
use self::visit::Driver;
use crate::accounts::worker::{CallResult, StoreWorker};
use crate::accounts::{Day, HostStore, KnownPlayers, UnixTime, WaitingResults};
use crate::admin::RoomRow;
use crate::cluster::{Cluster, SharedRooms};
use crate::config::{Config, LiveConfig};
use crate::line::Line;
use crate::load::Load;
use crate::logging;
use crate::metrics::Metrics;
use crate::operator::Operator;
use crate::rooms::directory::{Recordings, Rooms, Seeds};
use crate::rooms::ghost::KeptRuns;
use crate::rooms::invitation::WrongCodes;
use crate::rooms::room::Catalog;
use crate::rooms::summary::RoomSummary;
use crate::sessions::session::SessionEvent;
use crate::ssh::{Departure, Host, Link, Visitor};
use crate::visitors::Visitors;

/// The host of the game: the rooms, the accounts, and a session per visitor.
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
    /// The shared rooms of a cluster; `None` outside of a cluster.
    cluster: Option<SharedRooms>,
    store: StoreWorker,
    recorder: ResultRecorder,
    /// The players that the host remembers while the database is away; `None` if the store is a file.
    known: Option<Arc<Mutex<KnownPlayers>>>,
    wrong_codes: Mutex<WrongCodes>,
    /// A cache of the best runs on the boards. Only the store's thread uses it.
    runs: Arc<Mutex<KeptRuns>>,
    load: Arc<Load>,
    /// Limits the number of large frames drawn at the same time.
    large_frames: Arc<Semaphore>,
    next_guest: AtomicU32,
    /// Limits the number of records that are watched at the same time.
    records: Arc<Semaphore>,
}

/// The clock by which a host knows the day.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clock {
    System,
    /// Simulated time, which was `at` when the runtime's clock showed `begun`.
    #[cfg(test)]
    Simulated {
        at: UnixTime,
        begun: Instant,
    },
}

impl Clock {
    pub(crate) fn now(self) -> UnixTime {
        match self {
            Self::System => UnixTime::now(),
            #[cfg(test)]
            Self::Simulated { at, begun } => at.after(begun.elapsed().as_secs()),
        }
    }

    fn today(self) -> Day {
        Day::of(self.now())
    }
}

/// The interval between two looks at the clock for a new day.
const DAY_INTERVAL: Duration = Duration::from_secs(5);
/// The interval between two decisions of the governor.
const GOVERNOR_INTERVAL: Duration = Duration::from_millis(250);
/// The maximum number of records that are watched at the same time. Each takes at most 30 MB.
const MAX_RECORDS: usize = 8;
/// The maximum number of queued calls to the store.
const MAX_CALLS: usize = 256;
/// Shown to a player that the host remembers while the database is away.
const AWAY: &str =
    "The host's database is away: results are recorded later, and changed settings are lost.";
/// How long the store may take to shut down.
const STORE_SHUTDOWN_TIMEOUT: Duration = Duration::from_secs(10);

/// The parts from which a [`GameHost`] is started.
pub struct HostParts {
    pub(crate) live: LiveConfig,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) visitors: Visitors,
    pub(crate) clock: Clock,
    pub(crate) catalog: Catalog,
    pub(crate) recordings: Recordings,
    pub(crate) load: Load,
    pub(crate) store: StoreWorker,
    /// Results that wait for the store. New results are added here while the store is unreachable.
    pub(crate) waiting: Option<WaitingResults>,
    /// The players that the host lets in while the database is away.
    pub(crate) known: Option<KnownPlayers>,
    pub(crate) seeds: Seeds,
    /// The cluster with which the host shares its rooms.
    pub(crate) cluster: Option<Cluster>,
}

impl HostParts {
    /// The parts of a host with the built-in levels that keeps accounts and results in `store`. The host
    /// counts in `metrics` and lists its sessions in `visitors`.
    ///
    /// # Errors
    /// Fails if the store's thread cannot be started.
    pub fn new(
        live: LiveConfig,
        metrics: Arc<Metrics>,
        visitors: Visitors,
        store: HostStore,
    ) -> io::Result<Self> {
        let config = live.get();
        Ok(Self {
            visitors,
            clock: Clock::System,
            catalog: Catalog::builtin(),
            recordings: Recordings::in_folder(config.recordings.clone(), config.recording_bounds()),
            load: Load::new(Arc::clone(&metrics)),
            store: StoreWorker::start("store", MAX_CALLS, store)?,
            waiting: None,
            known: None,
            seeds: Seeds { rooms: random(), codes: random() },
            metrics,
            live,
            cluster: None,
        })
    }
}

impl GameHost {
    /// Starts a host from these parts.
    ///
    /// Must be called within a runtime, on which the rooms then run.
    pub fn start(parts: HostParts) -> Self {
        let HostParts { live, metrics, visitors, clock, .. } = parts;
        let (mut limits, load) = (live.get().room_limits(), Arc::new(parts.load));
        // In a cluster, the standing rooms are shared ones.
        let shared_standing = parts
            .cluster
            .as_ref()
            .map(|_| std::mem::take(&mut limits.standing))
            .unwrap_or_default();
        let catalog = Arc::new(parts.catalog);
        let rooms = Rooms::new(limits, catalog, parts.recordings, Arc::clone(&load), parts.seeds);
        rooms.set_today(clock.today());
        let cluster = parts.cluster.map(|cluster| {
            cluster.rooms(rooms.clone(), shared_standing, Arc::clone(&load), visitors.clone())
        });
        let recorder = ResultRecorder {
            catalog: Arc::clone(rooms.catalog()),
            clock,
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
            known: parts.known.map(|known| Arc::new(Mutex::new(known))),
            wrong_codes: Mutex::default(),
            runs: Arc::default(),
            load,
            large_frames: Arc::new(Semaphore::new((processors / 2).max(1))),
            next_guest: AtomicU32::new(1),
            records: Arc::new(Semaphore::new(MAX_RECORDS)),
        });
        tokio::spawn(govern(Arc::downgrade(&shared)));
        tokio::spawn(follow_days(Arc::downgrade(&shared)));
        tokio::spawn(talk::follow_mutes(Arc::downgrade(&shared)));
        tokio::spawn(follow_limits(
            shared.config.subscribe(),
            shared.rooms.clone(),
            shared.cluster.clone(),
        ));
        if let Some(known) = shared.known.clone() {
            tokio::spawn(login::remember_all(Arc::downgrade(&shared), known));
        }
        if shared.recorder.waiting.is_some() {
            tokio::spawn(results::record_all(Arc::downgrade(&shared)));
        }
        Self { shared }
    }

    /// Shuts down after the last session: first the rooms, so that their recordings are complete, then the
    /// store, after all queued calls.
    pub fn ending(&self) -> impl Future<Output = ()> + use<> {
        let shared = Arc::clone(&self.shared);
        async move {
            if let Some(rooms) = &shared.cluster {
                rooms.end().await;
            }
            shared.rooms.end().await;
            let (recorder, known) = (shared.recorder.clone(), shared.known.clone());
            let ended = shared.store.call(move |store| {
                if let Some(known) = &known {
                    login::save(known);
                }
                recorder.end(store);
            });
            _ = timeout(STORE_SHUTDOWN_TIMEOUT, ended).await;
        }
    }

    /// An operator of this host, who counts requests to shut the host down in `ends`.
    pub fn operator(&self, ends: watch::Sender<u32>) -> Operator {
        let Shared { visitors, cluster, .. } = &*self.shared;
        Operator::new(visitors.clone(), self.room_rows(), ends, cluster.clone())
    }

    /// The rooms, and the measurements of how busy the host is.
    pub(crate) fn rooms(&self) -> (Rooms, Arc<Load>) {
        (self.shared.rooms.clone(), Arc::clone(&self.shared.load))
    }

    /// A function that runs `act` on the store; it returns `None` once the host has ended.
    pub(crate) fn store_calls<T: Send + 'static>(
        &self,
        act: fn(&mut HostStore) -> T,
    ) -> impl Fn() -> Option<CallResult<T>> + use<T> {
        // The last owner of the host shuts down the store's thread.
        let shared = Arc::downgrade(&self.shared);
        move || Some(shared.upgrade()?.store.call(act))
    }

    /// A function that lists the rooms for an operator.
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
        is_private: room.code.is_some(),
    }
}

/// A random number of the system's. If it had none, the server would have no keys either.
fn random() -> u64 {
    getrandom::u64().unwrap_or_default()
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
        let _counted = match shared.begin_visit(&visitor, known.key, known.is_remembered).await {
            Ok(counted) => counted,
            Err((sentence, departure)) => return refuse(link, &sentence, departure).await,
        };
        let options = login::terminal_options(&visitor);
        let is_remembered = known.is_remembered;
        let mut driver = Driver::new(shared, &visitor, known, options);
        if is_remembered {
            driver.notify(SessionEvent::Result(AWAY.to_owned()));
        }
        driver.look_for_place();
        Departure { status: driver.run(&mut link).await, refusal: None }
    }
}

impl Shared {
    /// The time since the server started.
    fn now(&self) -> Duration {
        self.begun.elapsed()
    }

    /// Prepares a day, and tells the rooms. The result fails if the store accepts no more calls.
    fn prepare(&self, today: Day) -> CallResult<()> {
        let rooms = self.rooms.clone();
        self.store.call(move |store| {
            rooms.catalog().world(&today.level());
            if let Err(failure) = store.forget_dailies() {
                logging::store_failed(failure);
            }
            rooms.set_today(today);
        })
    }
}

/// Tells a visitor why they may not play, and returns `departure`.
async fn refuse(link: Link, sentence: &str, departure: Departure) -> Departure {
    let Link { mut outbox, .. } = link;
    _ = outbox.try_send(format!("{sentence}\r\n").into_bytes());
    outbox.drained().await;
    departure
}

/// Passes new limits on to the rooms whenever the configuration is reloaded.
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

/// Tells the rooms each new day, for as long as the host exists. Before, the store's thread generates the daily level,
/// because a driver's thread would draw no frames meanwhile, and removes old boards.
async fn follow_days(shared: Weak<Shared>) {
    let mut ticks = interval(DAY_INTERVAL);
    let mut prepared = None;
    loop {
        ticks.tick().await;
        // The host is not held while waiting: its last owner shuts down the store's thread.
        let Some((today, answer)) = shared.upgrade().map(|shared| {
            let today = shared.recorder.clock.today();
            let is_new = prepared != Some(today);
            (today, is_new.then(|| shared.prepare(today)))
        }) else {
            return;
        };
        if let Some(answer) = answer
            && answer.await.is_ok()
        {
            prepared = Some(today);
        }
    }
}

/// Adjusts the frame rate for as long as the host exists.
async fn govern(shared: Weak<Shared>) {
    let mut ticks = interval(GOVERNOR_INTERVAL);
    loop {
        ticks.tick().await;
        let Some(shared) = shared.upgrade() else { return };
        shared.load.decide(GOVERNOR_INTERVAL, shared.config.get().frames_per_second);
    }
}
