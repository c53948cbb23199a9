//! Rooms that are watched: each is drawn by one task for all who watch it.
//!
//! - A task draws at most [`PICTURES_PER_SECOND`] times a second, less often if the processor is busy, and only if
//!   the room has taken a step. It ends with its room or its last watcher.
//! - The task keeps the latest picture only. A watcher who has read the picture before gets the changes, and a
//!   watcher who is behind gets the whole picture. So a watcher who does not read holds one picture, and nothing is
//!   queued.
//! - A message is encoded once. The whole picture is encoded when the first watcher needs it.
//!
//! While a player turned for five seconds, 1, 16 and 100 watchers had 49, 49 and 50 pictures drawn. Each watcher got
//! 54 kB a second, and all hundred together cost 0.08 s of processor time.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use bytes::Bytes;
use futures_util::{SinkExt, StreamExt};
use serde_json::json;
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::watch;
use tokio::time::{Instant, MissedTickBehavior, interval_at, sleep, timeout};
use tokio_websockets::{CloseCode, Error, Message, WebSocketStream};

use super::picture::{self, Cell};
use crate::bucket::Bucket;
use crate::load::Load;
use crate::lock::locked;
use crate::metrics::Metrics;
use crate::rooms::directory::Rooms;
use crate::rooms::room::{Catalog, Mode, Phase, RoomView};
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::session::lobby::seen_through;
use cellcaster::app::parts::of_steps;

/// The maximum number of pictures per second.
const PICTURES_PER_SECOND: u32 = 10;
/// The number of a session's usual frames in the time of one picture.
const FRAMES_PER_PICTURE: u32 = 3;
/// The interval between two pings.
const PING_INTERVAL: Duration = Duration::from_secs(30);
/// The time that a browser may take to accept a message.
const SEND_TIMEOUT: Duration = Duration::from_secs(30);
/// The control frames that a browser may send in a second, and at once.
const CONTROLS: [f64; 2] = [1.0, 10.0];

/// The rooms that are watched.
pub(crate) struct LiveRooms {
    rooms: Rooms,
    pub(crate) load: Arc<Load>,
    watched: Mutex<BTreeMap<RoomId, watch::Sender<Arc<Picture>>>>,
}

/// The latest picture of a room.
#[derive(Debug, Default)]
pub(crate) struct Picture {
    /// The number of pictures before this one, which is 0 before the first.
    number: u64,
    step: u32,
    cells: Vec<Cell>,
    /// The changes since the previous picture; `None` if the cells are the same.
    changes: Option<Bytes>,
    whole: OnceLock<Bytes>,
    /// The room in words, as JSON.
    words: Arc<str>,
}

/// The rooms that everybody may watch.
pub(crate) fn public_rooms(rooms: &Rooms) -> Vec<RoomSummary> {
    let summaries = rooms.summaries();
    let summaries = summaries.borrow();
    summaries.iter().filter(|room| is_public(rooms, room)).cloned().collect()
}

/// Returns true if a room is open to everybody, runs on this host, and is in a level that the host has.
fn is_public(rooms: &Rooms, room: &RoomSummary) -> bool {
    let is_open = room.mode != Mode::Alone && room.code.is_none();
    is_open && rooms.catalog().has(&room.level) && rooms.view(room.id).is_some()
}

impl LiveRooms {
    pub(crate) fn new(rooms: Rooms, load: Arc<Load>) -> Self {
        Self { rooms, load, watched: Mutex::default() }
    }

    /// Watches a public room.
    pub(crate) fn watch(self: &Arc<Self>, id: RoomId) -> Option<watch::Receiver<Arc<Picture>>> {
        self.is_public(id).then(|| {
            locked(&self.watched, |watched| {
                let pictures = watched.entry(id).or_insert_with(|| {
                    let pictures = watch::Sender::default();
                    tokio::spawn(Arc::clone(self).draw(id, pictures.clone()));
                    pictures
                });
                let mut pictures = pictures.subscribe();
                pictures.mark_changed();
                pictures
            })
        })
    }

    fn is_public(&self, id: RoomId) -> bool {
        let summaries = self.rooms.summaries();
        let summaries = summaries.borrow();
        summaries.iter().any(|room| room.id == id && is_public(&self.rooms, room))
    }

    /// Draws a room for as long as it is watched.
    async fn draw(self: Arc<Self>, id: RoomId, pictures: watch::Sender<Arc<Picture>>) {
        loop {
            let is_public = self.is_public(id);
            let goes_on = locked(&self.watched, |watched| {
                let goes_on = is_public && pictures.receiver_count() > 0;
                if !goes_on {
                    watched.remove(&id);
                }
                goes_on
            });
            if !goes_on {
                return;
            }
            // The snapshot is dropped before the task waits.
            if let Some(room) = self.rooms.view(id) {
                let before = Arc::clone(&pictures.borrow());
                let next = before.next(&room, self.rooms.catalog(), &self.load.metrics);
                if let Some(next) = next {
                    pictures.send_replace(Arc::new(next));
                }
            }
            let picture_time = self.load.rate().frame_time * FRAMES_PER_PICTURE;
            sleep(picture_time.max(Duration::from_secs(1) / PICTURES_PER_SECOND)).await;
        }
    }
}

impl Picture {
    /// The picture of `room`, if it differs from this one.
    fn next(&self, room: &RoomView, catalog: &Catalog, metrics: &Metrics) -> Option<Self> {
        let step = u32::try_from(room.step).unwrap_or(u32::MAX);
        let words = words(room, catalog);
        let is_first = self.number == 0;
        if !is_first && step == self.step && *words == *self.words {
            return None;
        }
        let cells = picture::draw(room, catalog);
        metrics.web_pictures.inc();
        let changes = picture::changes(step, &self.cells, &cells);
        if !is_first && changes.is_none() && *words == *self.words {
            return None;
        }
        let (number, whole) = (self.number + 1, OnceLock::new());
        Some(Self { number, step, cells, changes, whole, words: words.into() })
    }

    /// The message for a watcher who has read picture `read`.
    fn message(&self, read: u64) -> Option<Bytes> {
        if read > 0 && read + 1 == self.number {
            return self.changes.clone();
        }
        let whole = self.whole.get_or_init(|| picture::whole(self.step, &self.cells));
        Some(whole.clone())
    }
}

/// The room in words: its mode and level, and the players with their points and places.
fn words(room: &RoomView, catalog: &Catalog) -> String {
    let players = room.members.iter().map(|member| {
        json!({
            "name": member.name.as_str(),
            "points": member.points,
            "place": member.finish.map(|finish| finish.place).or(member.place),
            "time": member.finish.map(|finish| of_steps(finish.steps)),
        })
    });
    let phase = match room.phase {
        Phase::Waiting => "The round waits for players.",
        Phase::Countdown { .. } => "The round begins soon.",
        Phase::Playing { .. } if room.header.mode == Mode::Roam => "",
        Phase::Playing { .. } => "A round is being played.",
        Phase::Over { .. } => "The round is over.",
    };
    json!({
        "mode": room.header.mode.title(),
        "level": catalog.title(&room.header.level),
        "phase": phase,
        "seen": seen_through(room).map(|(member, _)| member.name.as_str()),
        "players": players.collect::<Vec<_>>(),
    })
    .to_string()
}

/// Sends the pictures to a browser until the room closes, or the browser leaves, sends data or does not read.
pub(crate) async fn watch<S: AsyncRead + AsyncWrite + Unpin>(
    mut socket: WebSocketStream<S>,
    mut pictures: watch::Receiver<Arc<Picture>>,
    metrics: &Metrics,
) {
    metrics.web_watchers.inc();
    let _counted = Counted(metrics);
    if let Some((code, reason)) = send_pictures(&mut socket, &mut pictures, metrics).await {
        let goodbye = Message::close(Some(code), reason);
        _ = timeout(SEND_TIMEOUT, socket.send(goodbye)).await;
    }
}

struct Counted<'a>(&'a Metrics);

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.web_watchers.dec();
    }
}

/// Sends pictures. Returns the code and the reason to tell the browser, unless it has gone.
async fn send_pictures<S: AsyncRead + AsyncWrite + Unpin>(
    socket: &mut WebSocketStream<S>,
    pictures: &mut watch::Receiver<Arc<Picture>>,
    metrics: &Metrics,
) -> Option<(CloseCode, &'static str)> {
    let begun = Instant::now();
    let [per_second, most] = CONTROLS;
    let mut controls = Bucket::new(per_second, most, Duration::ZERO);
    let mut pings = interval_at(begun + PING_INTERVAL, PING_INTERVAL);
    pings.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let (mut read, mut words, mut is_alive): (u64, Arc<str>, bool) = (0, "".into(), true);
    loop {
        tokio::select! {
            changed = pictures.changed() => {
                if changed.is_err() {
                    return Some((CloseCode::NORMAL_CLOSURE, "The room has closed."));
                }
                let picture = Arc::clone(&pictures.borrow_and_update());
                if picture.number == 0 {
                    continue;
                }
                if words != picture.words {
                    words = Arc::clone(&picture.words);
                    send(socket, Message::text(words.to_string())).await?;
                }
                let message = picture.message(read);
                read = picture.number;
                // Only the message stays in memory while the browser does not read.
                drop(picture);
                if let Some(message) = message {
                    metrics.web_bytes.inc_by(message.len() as u64);
                    send(socket, Message::binary(message)).await?;
                }
            }
            message = socket.next() => {
                let message = match message? {
                    Ok(message) => message,
                    Err(Error::Io(_)) => return None,
                    Err(_) => return Some((CloseCode::POLICY_VIOLATION, NO_DATA)),
                };
                if !(message.is_ping() || message.is_pong() || message.is_close()) {
                    return Some((CloseCode::POLICY_VIOLATION, NO_DATA));
                }
                is_alive = true;
                if !controls.takes_one(begun.elapsed()) {
                    return Some((CloseCode::POLICY_VIOLATION, "There are too many control frames."));
                }
            }
            _ = pings.tick() => {
                if !std::mem::take(&mut is_alive) {
                    return None;
                }
                send(socket, Message::ping("")).await?;
            }
        }
    }
}

/// Told to a browser that sends data.
const NO_DATA: &str = "This socket only shows a room.";

/// Sends a message, and waits until the socket has taken it. Returns `None` if the browser has gone or does not read.
async fn send<S: AsyncRead + AsyncWrite + Unpin>(
    socket: &mut WebSocketStream<S>,
    message: Message,
) -> Option<()> {
    timeout(SEND_TIMEOUT, socket.send(message)).await.ok()?.ok()
}
