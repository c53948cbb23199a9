//! The rooms in a browser: a page that lists the public rooms and shows one of them live.
//!
//! The service is plain HTTP/1.1 for a reverse proxy that encrypts. It answers one request on each connection:
//!
//! - `GET /` is the page, one file without anything from elsewhere.
//! - `GET /rooms` is the list of rooms, as JSON.
//! - `GET /rooms/ID/live` becomes a WebSocket, which carries the [pictures](picture) of a room.
//!
//! # Rules
//!
//! - Nothing that a browser sends reaches a room. A browser that sends data on the WebSocket is disconnected.
//! - Private rooms are neither listed nor shown. A picture shows what the lobby's live picture shows.
//! - A room is drawn once for all who watch it, see [`live`], and a room that nobody watches is not drawn.
//! - Requests are limited to [`MAX_REQUESTS`], in size, and in time. A flood of them displaces itself, as in
//!   [`admission`](crate::admission). Watchers are limited in total and by address.
//! - Only the configured `web-proxies` name the address of a visitor, in `X-Forwarded-For`.
//! - Another site's page cannot open the WebSocket: its `Origin` must name the host of the request.
//!
//! Rejected: `axum`, which brings hyper, tower and about 25 crates. `httparse` and `tokio-websockets` bring four.

mod live;
mod picture;
mod request;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::io::{self, Cursor};
use std::net::{IpAddr, SocketAddr};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use serde_json::json;
use tokio::io::{AsyncReadExt, AsyncWriteExt, copy, join, sink};
use tokio::net::{TcpListener, TcpStream};
use tokio::task::{AbortHandle, JoinSet};
use tokio::time::{Instant, sleep, timeout};
use tokio_websockets::{Limits as MessageLimits, ServerBuilder};

use self::live::{LiveRooms, public_rooms, watch};
use self::request::Request;
use crate::admission::{Admission, ConnectionId, Limits, Outcome, Refusal};
use crate::config::LiveConfig;
use crate::line::Line;
use crate::load::Load;
use crate::lock::locked;
use crate::logging;
use crate::rooms::directory::Rooms;
use crate::rooms::summary::RoomId;
use crate::service;
use cellcaster::rng::SplitMix64;

/// The most requests at a time. One more displaces the oldest of the busiest network.
const MAX_REQUESTS: u32 = 64;
/// The time for the head of a request.
const HEAD_TIMEOUT: Duration = Duration::from_secs(5);
/// The time for an answer.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(10);
/// The most bytes of a message from a browser, as for control frames.
const MAX_MESSAGE: usize = 125;
/// The pause after a failed `accept`.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(100);
/// The size of a socket's send buffer, in bytes. It holds about ten pictures.
const SEND_BUFFER: u32 = 64 << 10;
/// The maximum number of connections that wait to be accepted.
const BACKLOG: u32 = 128;
/// The page. Its script and its styles have the nonce of the answer.
const PAGE: &str = include_str!("web/page.html");
const NONCE: &str = "NONCE";

/// The service for browsers.
pub(crate) struct Web {
    config: LiveConfig,
    rooms: Rooms,
    live: Arc<LiveRooms>,
    begun: Instant,
    requests: Arc<Mutex<Requests>>,
    watchers: Arc<Mutex<Admission>>,
}

/// The connections whose requests are not answered yet.
struct Requests {
    admission: Admission,
    chance: SplitMix64,
    open: BTreeMap<ConnectionId, AbortHandle>,
}

/// An answer, except for its headers that are always the same.
struct Answer {
    status: &'static str,
    kind: &'static str,
    /// Further headers, each with its line ending.
    headers: String,
    body: String,
}

/// Listens for browsers.
///
/// # Errors
/// Fails if the address cannot be bound.
pub(crate) fn listen(address: SocketAddr) -> io::Result<TcpListener> {
    service::listen(address, SEND_BUFFER, BACKLOG)
}

impl Web {
    pub(crate) fn new(config: LiveConfig, rooms: Rooms, load: Arc<Load>) -> Self {
        let admission = Admission::new(unlimited(MAX_REQUESTS));
        let requests = Requests { admission, chance: SplitMix64::new(0), open: BTreeMap::new() };
        Self {
            config,
            live: Arc::new(LiveRooms::new(rooms.clone(), load)),
            rooms,
            begun: Instant::now(),
            requests: Arc::new(Mutex::new(requests)),
            watchers: Arc::new(Mutex::new(Admission::new(unlimited(u32::MAX)))),
        }
    }

    /// Serves browsers until the future is dropped.
    pub(crate) async fn serve(self, listener: TcpListener) {
        let web = Arc::new(self);
        // Dropping the set aborts its tasks.
        let mut tasks = JoinSet::new();
        loop {
            match listener.accept().await {
                Ok((socket, peer)) => web.admit(&mut tasks, socket, peer.ip()),
                Err(error) => {
                    logging::fault("accept", error);
                    sleep(ACCEPT_RETRY_INTERVAL).await;
                }
            }
            while tasks.try_join_next().is_some() {}
        }
    }

    /// Answers a connection, and closes the connection that it displaces.
    fn admit(self: &Arc<Self>, tasks: &mut JoinSet<()>, socket: TcpStream, peer: IpAddr) {
        let web = Arc::clone(self);
        // The lock also delays the end of the task until the task is listed.
        locked(&self.requests, |requests| {
            let Requests { admission, chance, open } = requests;
            let Ok(admitted) = admission.arrive(peer, self.begun.elapsed(), chance) else { return };
            let displaced = admitted.displaced.and_then(|id| open.remove(&id));
            displaced.inspect(AbortHandle::abort);
            let place = Waiting { requests: Arc::clone(&self.requests), id: admitted.id };
            let answered = async move { _ = web.answer(socket, peer, place).await };
            open.insert(admitted.id, tasks.spawn(answered));
        });
    }

    async fn answer(&self, mut socket: TcpStream, peer: IpAddr, place: Waiting) -> io::Result<()> {
        _ = socket.set_nodelay(true);
        let read = timeout(HEAD_TIMEOUT, request::read(&mut socket)).await;
        let (head, request) = match read {
            Ok(Ok((head, Some(request)))) => (head, request),
            Ok(Ok((_, None))) => return finish(socket, Answer::bad_request()).await,
            Ok(Err(_)) | Err(_) => return Ok(()),
        };
        let id = match self.route(&request) {
            Ok(id) => id,
            Err(answer) => return finish(socket, answer).await,
        };
        let address = self.visitor(&request, peer);
        let _counted = match self.count(address) {
            Ok(counted) => counted,
            Err(sentence) => {
                return finish(socket, Answer::text("503 Service Unavailable", sentence)).await;
            }
        };
        let Some(pictures) = self.live.watch(id) else {
            return finish(socket, Answer::no_room()).await;
        };
        // Watchers are limited on their own.
        drop(place);
        let (reader, writer) = socket.split();
        let stream = join(Cursor::new(head).chain(reader), writer);
        let limits = MessageLimits::default().max_payload_len(Some(MAX_MESSAGE));
        let server = ServerBuilder::new().limits(limits);
        if let Ok(Ok((_, socket))) = timeout(ANSWER_TIMEOUT, server.accept(stream)).await {
            watch(socket, pictures, &self.live.load.metrics).await;
        }
        Ok(())
    }

    /// The room that a request wants to watch, or the answer to another request.
    fn route(&self, request: &Request) -> Result<RoomId, Answer> {
        if request.method != "GET" {
            let answer = Answer::text("405 Method Not Allowed", "use the method GET\n".to_owned());
            return Err(Answer { headers: "Allow: GET\r\n".to_owned(), ..answer });
        }
        match request.path() {
            "/" => return Err(Answer::page()),
            "/rooms" => return Err(Answer::json(self.list())),
            _ => {}
        }
        let id = request.path().strip_prefix("/rooms/").and_then(|it| it.strip_suffix("/live"));
        let id = id.and_then(|id| id.parse().ok()).map(RoomId).ok_or_else(|| {
            Answer::text("404 Not Found", "the page is at / and the list at /rooms\n".to_owned())
        })?;
        if !request.is_upgrade {
            let text = "a room is watched through a WebSocket\n".to_owned();
            let headers = "Upgrade: websocket\r\n".to_owned();
            return Err(Answer { headers, ..Answer::text("426 Upgrade Required", text) });
        }
        if !request.is_of_same_host() {
            let text = "only this host's own page can watch a room\n".to_owned();
            return Err(Answer::text("403 Forbidden", text));
        }
        Ok(id)
    }

    /// The public rooms, as JSON.
    fn list(&self) -> String {
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
        json!({ "name": self.config.get().name, "rooms": rooms.collect::<Vec<_>>() }).to_string()
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
    fn count(&self, address: IpAddr) -> Result<Watching, String> {
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
            Ok(Watching { watchers: Arc::clone(&self.watchers), id: admitted.id })
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

/// The place of a connection among the [`Requests`].
struct Waiting {
    requests: Arc<Mutex<Requests>>,
    id: ConnectionId,
}

impl Drop for Waiting {
    fn drop(&mut self) {
        locked(&self.requests, |requests| {
            requests.open.remove(&self.id);
            requests.admission.leave(self.id, Outcome::Served, Duration::ZERO);
        });
    }
}

/// The place of a watcher.
struct Watching {
    watchers: Arc<Mutex<Admission>>,
    id: ConnectionId,
}

impl Drop for Watching {
    fn drop(&mut self) {
        let (id, served) = (self.id, Outcome::Served);
        locked(&self.watchers, |watchers| watchers.leave(id, served, Duration::ZERO));
    }
}

impl Answer {
    fn text(status: &'static str, body: String) -> Self {
        Self { status, kind: "text/plain; charset=utf-8", headers: String::new(), body }
    }

    fn bad_request() -> Self {
        let most = request::MAX_HEAD >> 10;
        let text = format!("this is not an HTTP/1.1 request of at most {most} KiB\n");
        Self::text("400 Bad Request", text)
    }

    fn no_room() -> Self {
        Self::text("404 Not Found", "there is no such public room\n".to_owned())
    }

    fn json(body: String) -> Self {
        Self { kind: "application/json", ..Self::text("200 OK", body) }
    }

    fn page() -> Self {
        // A page could not use a nonce that it does not know, and nothing from a visitor is in the page.
        let nonce = format!("{:016x}", getrandom::u64().unwrap_or_default());
        let headers = format!(
            "Content-Security-Policy: default-src 'none'; script-src 'nonce-{nonce}'; style-src 'nonce-{nonce}'; \
             connect-src 'self'; img-src data:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
        );
        let body = PAGE.replace(NONCE, &nonce);
        Self { kind: "text/html; charset=utf-8", headers, ..Self::text("200 OK", body) }
    }
}

/// Sends the answer and closes the connection.
async fn finish(mut socket: TcpStream, answer: Answer) -> io::Result<()> {
    let Answer { status, kind, headers, body } = answer;
    let text = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\n{headers}\
         Cache-Control: no-store\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
         Connection: close\r\n\r\n{body}",
        body.len()
    );
    let sent = async {
        socket.write_all(text.as_bytes()).await?;
        socket.shutdown().await?;
        // If the connection were closed with unread bytes, it would be reset, and the client might lose the answer.
        copy(&mut socket, &mut sink()).await
    };
    _ = timeout(ANSWER_TIMEOUT, sent).await;
    Ok(())
}
