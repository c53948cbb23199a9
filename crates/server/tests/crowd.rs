//! The memory that a server needs for a thousand clients that never read, and the frame rate of another
//! client that reads meanwhile.
//!
//! The clients run in another process, so that their memory does not count.
//! `cargo test -p cellcaster-server --test crowd -- --nocapture` prints the figures.

use std::net::SocketAddr;
use std::process::{Child, Command};
use std::sync::Arc;
use std::time::{Duration, Instant};
use std::{env, fs, future};

use cellcaster_server::config::Config;
use cellcaster_server::metrics::Metrics;
use cellcaster_server::ssh::host_key::HostKey;
use cellcaster_server::ssh::{Arrival, Departure, Host, Link, Server, Visitor};
use russh::client::{self, Handle, Handler, Session};
use russh::keys::PublicKeyOrCertificate;
use russh::{Channel, ChannelId, ChannelMsg, Error};
use tokio::runtime::Runtime;
use tokio::task::JoinSet;
use tokio::time::sleep;

/// A host that sends frames at the pace of a game.
struct Frames;

/// A client that never reads.
#[derive(Clone, Copy)]
struct Deaf;

/// A client that reads everything.
#[derive(Clone, Copy)]
struct Awake;

const CLIENTS: usize = 1000;
/// The average size of an exact frame of 80×24 cells, in bytes. Without flow control, each client holds one frame.
const FRAME: usize = 16_000;
const FRAME_TIME: Duration = Duration::from_millis(33);
/// How long the frames of the reading client are counted.
const COUNTED: Duration = Duration::from_secs(3);
/// The memory limit for all clients together, in bytes.
const MAX_MEMORY: usize = 64 << 20;
/// The number of clients that connect at the same time.
const LANES: usize = 8;
/// The environment variable that turns this program into the clients of the server at the given address.
const ADDRESS: &str = "CELLCASTER_CROWD";
const TIMEOUT: Duration = Duration::from_mins(2);

impl Host for Frames {
    async fn serve(&self, _: Visitor, mut link: Link) -> Departure {
        loop {
            tokio::select! {
                arrival = link.inbound.next() => if arrival == Arrival::Ended {
                    return Departure::default();
                },
                () = async {
                    sleep(FRAME_TIME).await;
                    link.outbox.drained().await;
                } => {
                    _ = link.outbox.try_send(vec![b'x'; FRAME]);
                }
            }
        }
    }
}

impl Handler for Deaf {
    type Error = Error;

    async fn check_server_key(&mut self, _: &PublicKeyOrCertificate) -> Result<bool, Error> {
        Ok(true)
    }

    async fn data(&mut self, _: ChannelId, _: &[u8], _: &mut Session) -> Result<(), Error> {
        future::pending().await
    }
}

impl Handler for Awake {
    type Error = Error;

    async fn check_server_key(&mut self, _: &PublicKeyOrCertificate) -> Result<bool, Error> {
        Ok(true)
    }
}

fn main() {
    match env::var(ADDRESS) {
        Ok(address) => Runtime::new().unwrap().block_on(crowd(address.parse().unwrap())),
        Err(_) => clients_that_never_read_need_little_memory(),
    }
}

fn clients_that_never_read_need_little_memory() {
    let folder = env::temp_dir().join(format!("cellcaster-crowd-{}", std::process::id()));
    let key = HostKey::open(&folder).unwrap();
    fs::remove_dir_all(&folder).unwrap();
    let mut config = Config { listen: ([127, 0, 0, 1], 0).into(), ..Config::default() };
    config.connections_per_address = 2 * CLIENTS as u32;
    (config.silence, config.stall) = (TIMEOUT, TIMEOUT);
    let runtime = Runtime::new().unwrap();
    let server = runtime.block_on(Server::bind(config, key)).unwrap();
    let (address, metrics) = (server.address().unwrap(), server.metrics());
    runtime.spawn(server.run(Frames, future::pending()));
    let (_client, mut channel) = runtime.block_on(connect(address, Awake));
    let alone = runtime.block_on(frames(&mut channel));
    let before = memory();
    let mut crowd = Command::new(env::current_exe().unwrap())
        .env(ADDRESS, address.to_string())
        .spawn()
        .unwrap();
    wait_for_crowd(&metrics, &mut crowd);
    let added = memory().zip(before).map(|(after, before)| after - before);
    let among = runtime.block_on(frames(&mut channel));
    crowd.kill().unwrap();
    crowd.wait().unwrap();
    println!("frames of another client in {COUNTED:?}: {alone} alone, {among} among them");
    assert!(2 * among > alone, "{among} frames of {alone}");
    let Some(added) = added else { return println!("Memory is measured on Linux only.") };
    println!("{CLIENTS} clients that never read add {} KB each", added / CLIENTS / 1024);
    assert!(added < MAX_MEMORY, "{added} bytes");
}

/// The resident memory of this process in bytes; `None` except on Linux.
fn memory() -> Option<usize> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    Some(1024 * line.trim().strip_suffix(" kB")?.parse::<usize>().ok()?)
}

/// Waits until all clients are connected and the amount of held data no longer changes.
fn wait_for_crowd(metrics: &Metrics, crowd: &mut Child) {
    let end = Instant::now() + TIMEOUT;
    let mut still_since = Instant::now();
    let mut sent = 0;
    while still_since.elapsed() < Duration::from_secs(2) {
        assert!(Instant::now() < end, "{} sessions", metrics.sessions.get());
        assert!(crowd.try_wait().unwrap().is_none(), "the clients have left");
        std::thread::sleep(Duration::from_millis(100));
        let held = metrics.held.get();
        let sessions = metrics.sessions.get();
        if sessions <= CLIENTS as i64 || held != sent {
            still_since = Instant::now();
        }
        sent = held;
    }
}

/// Connects all clients and then waits forever.
async fn crowd(address: SocketAddr) {
    let mut lanes = JoinSet::new();
    for _ in 0..LANES {
        lanes.spawn(async move {
            let mut clients = Vec::new();
            for _ in 0..CLIENTS / LANES {
                clients.push(connect(address, Deaf).await);
            }
            clients
        });
    }
    let _clients = lanes.join_all().await;
    future::pending::<()>().await;
}

async fn connect<H: Handler<Error = Error> + Send + Copy + 'static>(
    address: SocketAddr,
    handler: H,
) -> (Handle<H>, Channel<client::Msg>) {
    let mut client = loop {
        // The server drops some connections at random.
        match client::connect(Arc::default(), address, handler).await {
            Ok(client) => break client,
            Err(_) => sleep(Duration::from_millis(10)).await,
        }
    };
    assert!(client.authenticate_none("guest").await.unwrap().success());
    let channel = client.channel_open_session().await.unwrap();
    channel.request_pty(false, "xterm", 120, 40, 0, 0, &[]).await.unwrap();
    channel.request_shell(false).await.unwrap();
    (client, channel)
}

/// Counts the frames that a client receives within [`COUNTED`], after reading old ones for as long.
async fn frames(channel: &mut Channel<client::Msg>) -> usize {
    let mut bytes = 0;
    let begun = Instant::now() + COUNTED;
    while Instant::now() < begun + COUNTED {
        if let ChannelMsg::Data { data } = channel.wait().await.unwrap()
            && Instant::now() >= begun
        {
            bytes += data.len();
        }
    }
    bytes / FRAME
}
