//! The rooms in a browser: a page that shows the public rooms live, their records, and the boards.
//!
//! The service is plain HTTP/1.1 for a reverse proxy that encrypts. It answers one request on each connection:
//!
//! - `GET /` is the page, one file without anything from elsewhere.
//! - `GET /rooms`, `/records` and `/boards` are lists, as JSON; `/boards.txt` is the boards as text.
//! - `GET /rooms/ID/live` becomes a WebSocket, which carries the [pictures](picture) of a room, `/rooms/ID/stream` one
//!   that carries its [cast](alis) for asciinema's player.
//! - `GET /records/NAME/play?from=SECONDS&quarters=SPEED` becomes a WebSocket, which carries the pictures of a
//!   [record](records), and `/records/NAME.cast` is its cast.
//!
//! # Rules
//!
//! - Nothing that a browser sends reaches a room. A browser that sends data on the WebSocket is disconnected.
//! - Private rooms are neither listed nor shown. A picture shows what the lobby's live picture shows.
//! - A room is drawn once for all who watch it, see [`live`], and a room that nobody watches is not drawn. A second of a
//!   record is drawn once, see [`records`].
//! - Requests are limited to [`MAX_REQUESTS`], in size, and in time. A flood of them displaces itself, as in
//!   [`admission`](crate::admission). Watchers and downloads of casts are limited in total and by address.
//! - Only the configured `web-proxies` name the address of a visitor, in `X-Forwarded-For`.
//! - Another site's page cannot open the WebSocket: its `Origin` must name the host of the request.
//!
//! Rejected: `axum`, which brings hyper, tower and about 25 crates. `httparse` and `tokio-websockets` bring four.

mod alis;
mod boards;
mod live;
mod picture;
mod records;
#[cfg(test)]
mod tests;
mod watch;

use std::collections::BTreeMap;
use std::io::{self, Cursor};
use std::net::IpAddr;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use http::HeaderValue;
use http::header::SEC_WEBSOCKET_PROTOCOL;
use serde_json::{Value, json};
use tokio::fs::File;
use tokio::io::{AsyncReadExt, AsyncWriteExt, join};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, JoinSet};
use tokio::time::{Instant, sleep, timeout};
use tokio_websockets::{Limits as MessageLimits, ServerBuilder};

pub(crate) use self::boards::read as read_boards;
use self::boards::{AskBoards, Boards};
use self::live::{Form, LiveRooms, public_rooms};
use self::records::{MAX_QUARTERS, Records, USUAL_QUARTERS};
use self::watch::{SEND_TIMEOUT, Source, watch};
use crate::admission::{Admission, Admitted, ConnectionId, Limits, Outcome, Refusal};
use crate::config::LiveConfig;
use crate::line::Line;
use crate::load::Load;
use crate::lock::locked;
use crate::logging;
use crate::rooms::directory::Rooms;
use crate::rooms::summary::RoomId;
use crate::service::http::{
    ANSWER_TIMEOUT, Answer, Request, SEND_BUFFER, close, finish, head, read,
};
use cellcaster::rng::SplitMix64;

/// The most requests at a time. One more displaces the oldest of the busiest network.
const MAX_REQUESTS: u32 = 64;
/// The time for the head of a request.
const HEAD_TIMEOUT: Duration = Duration::from_secs(5);
/// The most bytes of a message from a browser, as for control frames.
const MAX_MESSAGE: usize = 125;
/// The pause after a failed `accept`.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(100);
/// The page. Its script and its styles have the nonce of the answer.
const PAGE: &str = include_str!("web/page.html");
const NONCE: &str = "NONCE";

/// The service for browsers.
pub(crate) struct Web {
    config: LiveConfig,
    rooms: Rooms,
    live: Arc<LiveRooms>,
    records: Arc<Records>,
    boards: Boards,
    begun: Instant,
    /// The connections whose requests are not answered yet.
    requests: Arc<Mutex<Admission>>,
    watchers: Arc<Mutex<Admission>>,
}

/// A request whose answer lasts.
enum Wanted {
    Room(RoomId, Form),
    /// The record with this name, from a second on, at a speed in quarters of the usual one.
    Record(String, u32, u32),
    /// The cast in this file.
    Cast(PathBuf),
}

impl Web {
    pub(crate) fn new(
        config: LiveConfig,
        rooms: Rooms,
        load: Arc<Load>,
        boards: AskBoards,
    ) -> Self {
        Self {
            config,
            records: Arc::new(Records::new(rooms.clone(), Arc::clone(&load.metrics))),
            live: Arc::new(LiveRooms::new(rooms.clone(), load)),
            boards: Boards::new(boards),
            rooms,
            begun: Instant::now(),
            requests: Arc::new(Mutex::new(Admission::new(unlimited(MAX_REQUESTS)))),
            watchers: Arc::new(Mutex::new(Admission::new(unlimited(u32::MAX)))),
        }
    }

    /// Serves browsers until the future is dropped.
    pub(crate) async fn serve(self, listener: TcpListener) {
        let (web, mut chance) = (Arc::new(self), SplitMix64::new(0));
        // Dropping the set aborts its tasks.
        let mut tasks = JoinSet::new();
        let mut open = BTreeMap::<ConnectionId, AbortHandle>::new();
        loop {
            let (socket, peer) = match listener.accept().await {
                Ok((socket, peer)) => (socket, peer.ip()),
                Err(error) => {
                    logging::fault("accept", error);
                    sleep(ACCEPT_RETRY_INTERVAL).await;
                    continue;
                }
            };
            while tasks.try_join_next().is_some() {}
            open.retain(|_, task| !task.is_finished());
            let now = web.begun.elapsed();
            let admitted = locked(&web.requests, |it| it.arrive(peer, now, &mut chance));
            let Ok(Admitted { id, displaced }) = admitted else { continue };
            let displaced = displaced.and_then(|id| open.remove(&id));
            displaced.inspect(AbortHandle::abort);
            let place = Counted { among: Arc::clone(&web.requests), id };
            let web = Arc::clone(&web);
            let answered = async move { _ = web.answer(socket, peer, place).await };
            open.insert(id, tasks.spawn(answered));
        }
    }

    async fn answer(&self, mut socket: TcpStream, peer: IpAddr, place: Counted) -> io::Result<()> {
        _ = socket.set_nodelay(true);
        let (head, request) = match timeout(HEAD_TIMEOUT, read(&mut socket)).await {
            Ok(Ok((head, Some(request)))) => (head, request),
            Ok(Ok((_, None))) => return finish(socket, Answer::bad_request()).await,
            Ok(Err(_)) | Err(_) => return Ok(()),
        };
        let wanted = match self.route(&request).await {
            Ok(wanted) => wanted,
            Err(answer) => return finish(socket, answer).await,
        };
        let address = self.visitor(&request, peer);
        let _counted = match self.count(address) {
            Ok(counted) => counted,
            Err(sentence) => return finish(socket, unavailable(sentence)).await,
        };
        // Watchers are limited on their own.
        drop(place);
        match wanted {
            Wanted::Cast(path) => send_file(socket, &path).await,
            Wanted::Room(id, form) => match self.live.watch(id, form) {
                Some(room) => self.show((socket, head), &request, room).await,
                None => finish(socket, no_room()).await,
            },
            Wanted::Record(name, from, quarters) => match self.records.watch(&name, from, quarters)
            {
                Ok(record) => self.show((socket, head), &request, record).await,
                Err(sentence) => finish(socket, unavailable(sentence + "\n")).await,
            },
        }
    }

    /// Opens the WebSocket for a request whose bytes are in `head`, and shows `source`.
    async fn show(
        &self,
        (mut socket, head): (TcpStream, Vec<u8>),
        request: &Request,
        mut source: impl Source,
    ) -> io::Result<()> {
        let (reader, writer) = socket.split();
        let stream = join(Cursor::new(head).chain(reader), writer);
        let limits = MessageLimits::default().max_payload_len(Some(MAX_MESSAGE));
        let mut server = ServerBuilder::new().limits(limits);
        // A browser ends the connection if the answer names a protocol that it has not offered.
        if request.protocols.iter().any(|it| it == alis::PROTOCOL) {
            let protocol = HeaderValue::from_static(alis::PROTOCOL);
            server =
                server.add_header(SEC_WEBSOCKET_PROTOCOL, protocol).map_err(io::Error::other)?;
        }
        if let Ok(Ok((_, socket))) = timeout(ANSWER_TIMEOUT, server.accept(stream)).await {
            watch(socket, &mut source, &self.live.load.metrics).await;
        }
        Ok(())
    }

    /// The request if its answer lasts, or otherwise the answer.
    async fn route(&self, request: &Request) -> Result<Wanted, Answer> {
        if request.method != "GET" {
            return Err(Answer::other_method());
        }
        let catalog = self.rooms.catalog();
        match request.path() {
            "/" => return Err(page()),
            "/rooms" => return Err(json_of(&self.list())),
            "/records" => return Err(json_of(&self.records.list().await)),
            "/boards" => return Err(json_of(&self.boards.json(catalog).await)),
            "/boards.txt" => {
                return Err(Answer::text("200 OK", self.boards.text(catalog).await));
            }
            _ => {}
        }
        let not_found = || {
            let text = "the page is at /, the lists are at /rooms, /records and /boards\n";
            Answer::text("404 Not Found", text.to_owned())
        };
        let mut parts = request.path().splitn(4, '/').skip(1);
        let parts = [parts.next(), parts.next(), parts.next()].map(Option::unwrap_or_default);
        let wanted = match parts {
            ["rooms", id, form @ ("live" | "stream")] => {
                let id = id.parse().map_err(|_| not_found())?;
                let is_live = form == "live";
                Wanted::Room(RoomId(id), if is_live { Form::Cells } else { Form::Cast })
            }
            ["records", name, "play"] => {
                let number = |name, usual: u32| {
                    request.query(name).map_or(Ok(usual), str::parse).map_err(|_| not_found())
                };
                let (from, quarters) = (number("from", 0)?, number("quarters", USUAL_QUARTERS)?);
                if !(1..=MAX_QUARTERS).contains(&quarters) {
                    return Err(not_found());
                }
                Wanted::Record(name.to_owned(), from, quarters)
            }
            ["records", file, ""] => {
                let cast = file.strip_suffix(".cast").and_then(|name| self.records.cast(name));
                return cast.map(Wanted::Cast).ok_or_else(not_found);
            }
            _ => return Err(not_found()),
        };
        if !request.is_upgrade {
            let text = "a room is watched through a WebSocket\n".to_owned();
            let headers = "Upgrade: websocket\r\n".to_owned();
            return Err(Answer { headers, ..Answer::text("426 Upgrade Required", text) });
        }
        if !request.is_of_same_host() {
            let text = "only this host's own page can watch a room\n".to_owned();
            return Err(Answer::text("403 Forbidden", text));
        }
        Ok(wanted)
    }

    /// The public rooms, as JSON.
    fn list(&self) -> Value {
        let catalog = self.rooms.catalog();
        let rooms = public_rooms(&self.rooms);
        let rooms = rooms.iter().map(|room| {
            json!({
                "id": room.id.0,
                "mode": room.mode.title(),
                "level": catalog.title(&room.level),
                "players": room.members.iter().map(Line::as_str).collect::<Vec<_>>(),
                "most": room.mode.most(),
            })
        });
        json!({ "name": self.config.get().name, "rooms": rooms.collect::<Vec<_>>() })
    }

    /// The address of the visitor: the peer's, or if the peer is a proxy, the last one in `X-Forwarded-For` that is not
    /// a proxy's.
    fn visitor(&self, request: &Request, peer: IpAddr) -> IpAddr {
        let config = self.config.get();
        let is_proxy = |address| config.web_proxies.iter().any(|range| range.contains(address));
        if !is_proxy(peer) {
            return peer;
        }
        let named = request.forwarded.iter().rev().map_while(|text| text.parse().ok());
        named.into_iter().find(|address| !is_proxy(*address)).unwrap_or(peer)
    }

    /// Counts a watcher, or returns the sentence for one too many.
    fn count(&self, address: IpAddr) -> Result<Counted, String> {
        let config = self.config.get();
        let limits = Limits {
            connections: config.web_watchers,
            per_address: config.web_watchers_per_address,
            ..unlimited(u32::MAX)
        };
        let now = self.begun.elapsed();
        locked(&self.watchers, |watchers| {
            watchers.set_limits(limits);
            let admitted = watchers.arrive(address, now, &mut SplitMix64::new(0));
            let admitted = admitted.map_err(|refusal| match refusal {
                Refusal::Address => {
                    let most = limits.per_address;
                    format!("at most {most} browsers can watch from one address\n")
                }
                _ => format!("at most {} browsers can watch at a time\n", limits.connections),
            })?;
            // The limit was checked on arrival.
            _ = watchers.log_in(admitted.id, None, now);
            Ok(Counted { among: Arc::clone(&self.watchers), id: admitted.id })
        })
    }
}

/// Limits that admit everybody, with at most `startups` unauthenticated connections and without penalties.
fn unlimited(startups: u32) -> Limits {
    Limits {
        connections: u32::MAX,
        per_address: u32::MAX,
        per_key: u32::MAX,
        startups,
        failures: u32::MAX,
        forget: Duration::from_secs(1),
    }
}

/// The place of a request, or of a watcher.
struct Counted {
    among: Arc<Mutex<Admission>>,
    id: ConnectionId,
}

impl Drop for Counted {
    fn drop(&mut self) {
        locked(&self.among, |it| it.leave(self.id, Outcome::Served, Duration::ZERO));
    }
}

/// The answer with the page.
fn page() -> Answer {
    // A page could not use a nonce that it does not know, and nothing from a visitor is in the page.
    let nonce = format!("{:016x}", getrandom::u64().unwrap_or_default());
    let headers = format!(
        "Content-Security-Policy: default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; \
         connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    );
    let body = PAGE.replace(NONCE, &nonce);
    Answer { kind: "text/html; charset=utf-8", headers, ..Answer::text("200 OK", body) }
}

fn json_of(value: &Value) -> Answer {
    Answer { kind: "application/json", ..Answer::text("200 OK", value.to_string()) }
}

fn no_room() -> Answer {
    Answer::text("404 Not Found", "there is no such public room\n".to_owned())
}

fn unavailable(sentence: String) -> Answer {
    Answer::text("503 Service Unavailable", sentence)
}

/// Sends the content of a file as it is now, and closes the connection.
async fn send_file(mut socket: TcpStream, path: &Path) -> io::Result<()> {
    let mut file = File::open(path).await?;
    let length = file.metadata().await?.len();
    let head = head("200 OK", "application/x-asciicast", "", length);
    timeout(SEND_TIMEOUT, socket.write_all(head.as_bytes())).await??;
    let mut part = vec![0; SEND_BUFFER as usize];
    let mut left = length as usize;
    while left > 0 {
        let most = part.len().min(left);
        let count = file.read(&mut part[..most]).await?;
        if count == 0 {
            break;
        }
        timeout(SEND_TIMEOUT, socket.write_all(&part[..count])).await??;
        left -= count;
    }
    timeout(SEND_TIMEOUT, close(socket)).await?
}
