//! Drivers in simulated time: the store runs as a task, and tests can inspect visits.

use std::sync::Arc;
use std::time::Duration;

use tokio::sync::{mpsc, oneshot};
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep};

use super::visit::Driver;
use super::{Clock, GameHost, HostParts, Shared, login, refuse};
use crate::accounts::worker::StoreWorker;
use crate::accounts::{HostStore, UnixTime};
use crate::config::LiveConfig;
use crate::load::{Load, Worker};
use crate::metrics::Metrics;
use crate::rooms::directory::{Place, Recordings, Rooms, Seeds};
use crate::rooms::room::{Catalog, RoomView};
use crate::sessions::session::Session;
use crate::ssh::{Link, Visitor};
use crate::visitors::Visitors;
use cellcaster::terminal::SessionOptions;

/// A host in simulated time.
pub(crate) struct Simulated {
    host: GameHost,
}

/// The parts of a host in simulated time.
pub(crate) struct Setup {
    pub(crate) live: LiveConfig,
    pub(crate) visitors: Visitors,
    /// The time at the start.
    pub(crate) time: UnixTime,
    pub(crate) catalog: Catalog,
    pub(crate) recordings: Recordings,
    pub(crate) store: HostStore,
    /// The duration of each call to the store.
    pub(crate) store_time: Duration,
    pub(crate) worker: Worker,
    pub(crate) seed: u64,
}

/// A running visit.
pub(crate) struct Visiting {
    looks: mpsc::UnboundedSender<Look>,
    task: JoinHandle<u8>,
}

type Look = Box<dyn FnOnce(&mut Driver) + Send>;

impl Simulated {
    /// Must be called within a runtime.
    pub(crate) fn new(setup: Setup) -> Self {
        let metrics = Arc::<Metrics>::default();
        let (store, mut queue) = StoreWorker::new(super::MAX_CALLS);
        let (mut database, time) = (setup.store, setup.store_time);
        tokio::spawn(async move {
            while let Some(call) = queue.recv().await {
                sleep(time).await;
                call(&mut database);
            }
        });
        let host = GameHost::start(HostParts {
            live: setup.live,
            visitors: setup.visitors,
            clock: Clock::Simulated { at: setup.time, begun: Instant::now() },
            catalog: setup.catalog,
            recordings: setup.recordings,
            load: Load::simulated(Arc::clone(&metrics), setup.worker),
            metrics,
            store,
            waiting: None,
            known: None,
            seeds: Seeds { rooms: setup.seed, codes: setup.seed },
            cluster: None,
        });
        Self { host }
    }

    pub(crate) fn metrics(&self) -> &Metrics {
        &self.host.shared.metrics
    }

    pub(crate) fn rooms(&self) -> &Rooms {
        &self.host.shared.rooms
    }

    /// Serves a visitor. `change` adjusts the terminal options found in their environment.
    pub(crate) fn serve(
        &self,
        visitor: Visitor,
        link: Link,
        change: impl FnOnce(&mut SessionOptions),
    ) -> Visiting {
        let mut options = login::terminal_options(&visitor);
        change(&mut options);
        let (looks, looked) = mpsc::unbounded_channel();
        let shared = Arc::clone(&self.host.shared);
        Visiting { looks, task: tokio::spawn(serve(shared, visitor, link, options, looked)) }
    }
}

/// Serves a visitor like [`GameHost`] does, with inspections in between.
async fn serve(
    shared: Arc<Shared>,
    visitor: Visitor,
    mut link: Link,
    options: SessionOptions,
    mut looked: mpsc::UnboundedReceiver<Look>,
) -> u8 {
    let known = match shared.log_in(&visitor).await {
        Ok(known) => known,
        Err((sentence, departure)) => return refuse(link, &sentence, departure).await.status,
    };
    let mut driver = Driver::new(shared, &visitor, known, options);
    loop {
        tokio::select! {
            biased;
            Some(look) = looked.recv() => look(&mut driver),
            status = driver.run(&mut link) => return status,
        }
    }
}

impl Visiting {
    /// Inspects the session together with the latest snapshot of its room; `None` if the session has ended.
    pub(crate) async fn look<T: Send + 'static>(
        &self,
        look: impl FnOnce(&mut Session, Option<&RoomView>) -> T + Send + 'static,
    ) -> Option<T> {
        let (answer, answered) = oneshot::channel();
        let look = move |driver: &mut Driver| {
            let room = driver.place.as_ref().map(Place::room);
            let view = match room {
                Some(room) => driver.shared.rooms.view(room),
                None => driver.lively_room(),
            };
            _ = answer.send(look(&mut driver.session, view.as_deref()));
        };
        self.looks.send(Box::new(look)).ok()?;
        answered.await.ok()
    }

    pub(crate) fn is_over(&self) -> bool {
        self.task.is_finished()
    }
}
