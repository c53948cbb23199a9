//! Browsers that watch the room with the most players, and read.

use std::error::Error;
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use serde_json::Value;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::task::JoinSet;
use tokio::time::{interval, sleep};

use super::report::Figures;
use super::server::ServerProcess;
use super::soak::figures;

/// The time for the server to draw the room for all.
const WARM_UP: Duration = Duration::from_secs(2);
/// A masked pong frame, and the interval at which the server must hear from a browser.
const PONG: &[u8] = b"\x8a\x80\0\0\0\0";
const PONG_INTERVAL: Duration = Duration::from_secs(20);

/// The cost of browsers.
pub(crate) struct Browsers {
    count: usize,
    /// The share of a core that the server has used for its players and the browsers.
    busy: f64,
    /// Frames a second for all players.
    frames: f64,
    /// Pictures of the room a second.
    pictures: f64,
    /// Kilobytes a second for each browser.
    kilobytes: f64,
    /// The number of browsers that were disconnected.
    lost: usize,
}

/// Lets `count` browsers watch for `seconds`.
pub(crate) async fn watch(
    (count, seconds): (usize, u64),
    server: &ServerProcess,
) -> Result<Browsers, Box<dyn Error>> {
    let address = server.web;
    let room = liveliest(address).await?;
    let bytes = Arc::<AtomicU64>::default();
    let mut browsers = JoinSet::new();
    for _ in 0..count {
        let socket = open(address, &room).await?;
        browsers.spawn(read(socket, Arc::clone(&bytes)));
    }
    sleep(WARM_UP).await;
    let counts = || -> Result<_, Box<dyn Error>> {
        let figures = figures(server)?;
        let names = ["cellcaster_frames_total", "cellcaster_web_pictures_total"];
        Ok(names.map(|name| figures.get(name).copied().unwrap_or(f64::NAN)))
    };
    let (before, first, read) = (server.usage(), counts()?, bytes.load(Ordering::Relaxed));
    sleep(Duration::from_secs(seconds)).await;
    let (after, last, read) = (server.usage(), counts()?, bytes.load(Ordering::Relaxed) - read);
    let [frames, pictures] = [0, 1].map(|it| (last[it] - first[it]) / seconds as f64);
    let lost = std::iter::from_fn(|| browsers.try_join_next()).count();
    let used = after.processor.saturating_sub(before.processor);
    Ok(Browsers {
        count,
        busy: used.as_secs_f64() / seconds as f64,
        frames,
        pictures,
        kilobytes: read as f64 / (count as u64 * seconds) as f64 / 1000.0,
        lost,
    })
}

/// The path of the WebSocket of the room with the most players.
async fn liveliest(address: SocketAddr) -> Result<String, Box<dyn Error>> {
    let mut socket = TcpStream::connect(address).await?;
    socket.write_all(b"GET /rooms HTTP/1.1\r\nHost: load\r\n\r\n").await?;
    let mut answer = String::new();
    socket.read_to_string(&mut answer).await?;
    let (_, list) = answer.split_once("\r\n\r\n").ok_or("no list of rooms")?;
    let list: Value = serde_json::from_str(list)?;
    let rooms = list["rooms"].as_array().ok_or("no list of rooms")?;
    let room = rooms.iter().max_by_key(|room| room["players"].as_array().map(Vec::len));
    Ok(format!("/rooms/{}/live", room.ok_or("no room is open")?["id"]))
}

async fn open(address: SocketAddr, path: &str) -> Result<TcpStream, Box<dyn Error>> {
    let mut socket = TcpStream::connect(address).await?;
    let request = format!(
        "GET {path} HTTP/1.1\r\nHost: load\r\nOrigin: http://load\r\nConnection: Upgrade\r\n\
         Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    socket.write_all(request.as_bytes()).await?;
    let mut status = [0; 12];
    socket.read_exact(&mut status).await?;
    if &status == b"HTTP/1.1 101" { Ok(socket) } else { Err("a browser was rejected".into()) }
}

/// Counts bytes until the server closes the connection.
async fn read(mut socket: TcpStream, bytes: Arc<AtomicU64>) {
    let mut part = vec![0; 64 << 10];
    let mut pongs = interval(PONG_INTERVAL);
    loop {
        tokio::select! {
            count = socket.read(&mut part) => match count {
                Ok(count) if count > 0 => _ = bytes.fetch_add(count as u64, Ordering::Relaxed),
                _ => return,
            },
            _ = pongs.tick() => if socket.write_all(PONG).await.is_err() { return },
        }
    }
}

impl Browsers {
    /// Prints the cost of the browsers, beside that of the players alone.
    pub(crate) fn print(&self, alone: &Figures) {
        let share = |busy: f64| format!("{:.1} %", busy * 100.0);
        // With browsers, the players may have got fewer frames.
        let frames = alone.frames * alone.sessions as f64;
        let added = self.busy - alone.busy() * self.frames / frames.max(1.0);
        let player = alone.busy() / alone.sessions.max(1) as f64;
        println!(
            "browsers      {} with {:.1} pictures and {:.1} KB a second each, {} of them disconnected",
            self.count, self.pictures, self.kilobytes, self.lost
        );
        println!(
            "processor     {} of a core with browsers at {:.0} frames a second, {} for the players alone at \
             {frames:.0}: the browsers cost {}, as much as {:.1} players",
            share(self.busy),
            self.frames,
            share(alone.busy()),
            share(added),
            added / player
        );
    }
}
