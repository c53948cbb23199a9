//! Clients that come and go leave nothing behind in the server.
//!
//! `cellcaster-lab load --soak --seconds 600` does the same for ten minutes.

use std::collections::BTreeMap;
use std::fs;
use std::future;
use std::net::SocketAddr;
use std::sync::Arc;
use std::thread;
use std::time::{Duration, Instant};

use cellcaster_server::accounts::HostStore;
use cellcaster_server::admin::RoomRow;
use cellcaster_server::config::Config;
use cellcaster_server::metrics::Metrics;
use cellcaster_server::sessions::driver::{GameHost, HostParts};
use cellcaster_server::ssh::Server;
use cellcaster_server::ssh::host_key::HostKey;
use cellcaster_server::visitors::Visitors;
use russh::client;
use tokio::runtime::{Builder, Runtime};
use tokio::sync::oneshot;
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

use self::wanderer::{Anyone, Leaving};
use crate::transport::{TIMEOUT, folder};

#[path = "../support/wanderer.rs"]
pub(crate) mod wanderer;

/// A server with access to its internal counts.
struct Counted {
    runtime: Runtime,
    address: SocketAddr,
    metrics: Arc<Metrics>,
    visitors: Visitors,
    rooms: Box<dyn Fn() -> Vec<RoomRow>>,
}

/// The objects that a server holds.
#[derive(Debug, PartialEq, Eq)]
struct Held {
    tasks: usize,
    connections: i64,
    sessions: i64,
    frame_bytes: i64,
    visitors: usize,
    rooms: usize,
    members: i64,
    watchers: i64,
}

const CLIENTS: u64 = 16;
const TIME: Duration = Duration::from_secs(10);
const MAX_DURATION: Duration = Duration::from_secs(2);

impl Counted {
    fn start() -> Self {
        let folder = folder();
        let mut config = Config { listen: ([127, 0, 0, 1], 0).into(), ..Config::default() };
        config.connections_per_address = 1000;
        config.startups = 1000;
        config.bytes_per_second = 1 << 20;
        config.silence = Duration::from_secs(3);
        // This test is not about clients that never read.
        config.stall = 2 * TIMEOUT;
        config.empty_room = Duration::from_secs(1);
        let key = HostKey::open(&folder).unwrap();
        let store = HostStore::open(&folder).unwrap();
        let runtime = Builder::new_multi_thread().worker_threads(2).enable_all().build().unwrap();
        let server = runtime.block_on(Server::bind(config, key)).unwrap();
        let (address, metrics) = (server.address().unwrap(), server.metrics());
        let visitors = Visitors::default();
        let guard = runtime.enter();
        let (counts, seen) = (Arc::clone(&metrics), visitors.clone());
        let host = HostParts::new(server.config(), counts, seen, store);
        let host = GameHost::start(host.unwrap());
        drop(guard);
        let rooms = Box::new(host.room_rows());
        runtime.spawn(server.run(host, future::pending()));
        fs::remove_dir_all(&folder).unwrap();
        Self { runtime, address, metrics, visitors, rooms }
    }

    fn held(&self) -> Held {
        Held {
            tasks: self.runtime.metrics().num_alive_tasks(),
            connections: self.metrics.connections.get(),
            sessions: self.metrics.sessions.get(),
            frame_bytes: self.metrics.held.get(),
            visitors: self.visitors.list().len(),
            rooms: (self.rooms)().len(),
            members: self.metrics.members.get(),
            watchers: self.metrics.watchers.get(),
        }
    }

    fn wait_until(&self, is_right: impl Fn(&Held) -> bool) {
        let end = Instant::now() + TIMEOUT;
        while !is_right(&self.held()) {
            assert!(Instant::now() < end, "{:?}", self.held());
            thread::sleep(Duration::from_millis(20));
        }
    }
}

#[test]
fn clients_that_come_and_go_leave_nothing_behind() {
    let server = Counted::start();
    let before = server.held();
    assert_eq!((before.connections, before.visitors, before.rooms), (0, 0, 2), "{before:?}");
    let address = server.address;
    // The clients have their own runtime, so that their tasks do not count.
    let clients = thread::spawn(move || {
        Builder::new_current_thread().enable_all().build().unwrap().block_on(soak(address))
    });
    let mut most = 0;
    while !clients.is_finished() {
        most = most.max(server.held().members);
        thread::sleep(Duration::from_millis(20));
    }
    let ends = clients.join().unwrap();
    for leaving in [Leaving::ByKeys, Leaving::Disconnected, Leaving::Cut] {
        assert!(ends.get(&leaving).is_some_and(|&count| count > 2), "{ends:?}");
    }
    assert!(most > 2, "{most} members");
    server.wait_until(|held| *held == before);
    server.runtime.shutdown_background();
}

/// The queries of a session must not pile up for a client that reads nothing.
#[test]
fn a_client_that_provokes_queries_without_reading_is_closed() {
    let server = Counted::start();
    let before = server.held();
    let address = server.address;
    let (stop, stopped) = oneshot::channel::<()>();
    let client = thread::spawn(move || {
        let runtime = Builder::new_current_thread().enable_all().build().unwrap();
        runtime.block_on(async {
            tokio::select! {
                () = provoke(address) => {}
                _ = stopped => {}
            }
        });
    });
    server.wait_until(|held| held.sessions == 1);
    server.wait_until(|held| *held == before);
    drop(stop);
    client.join().unwrap();
    server.runtime.shutdown_background();
}

/// Takes a single byte of the server's output, and then states over and over that the terminal is xterm,
/// which makes the server query its colours. Runs until the connection ends.
async fn provoke(address: SocketAddr) {
    let config = client::Config { window_size: 1, ..client::Config::default() };
    let mut client = client::connect(Arc::new(config), address, Anyone).await.unwrap();
    while !client.authenticate_none("provoker").await.unwrap().success() {}
    let channel = client.channel_open_session().await.unwrap();
    channel.request_pty(false, "xterm", 80, 24, 0, 0, &[]).await.unwrap();
    channel.request_shell(false).await.unwrap();
    let answers = b"\x1bP>|XTerm(390)\x1b\\".repeat(100);
    while channel.data(&answers[..]).await.is_ok() {}
}

/// Lets clients come and go; returns how many left in each way.
async fn soak(address: SocketAddr) -> BTreeMap<Leaving, usize> {
    let mut clients = JoinSet::new();
    for client in 0..CLIENTS {
        clients.spawn(async move {
            let mut ends = BTreeMap::<Leaving, usize>::new();
            _ = timeout(TIME, async {
                for visit in 0.. {
                    let seed = client << 32 | visit;
                    match wanderer::visit(address, seed, MAX_DURATION).await {
                        Ok(leaving) => *ends.entry(leaving).or_default() += 1,
                        Err(_) => sleep(Duration::from_millis(50)).await,
                    }
                }
            })
            .await;
            ends
        });
    }
    let all = clients.join_all().await;
    all.into_iter().fold(BTreeMap::new(), |mut all, ends| {
        for (leaving, count) in ends {
            *all.entry(leaving).or_default() += count;
        }
        all
    })
}
