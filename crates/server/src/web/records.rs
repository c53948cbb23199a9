//! Records of rooms, which are replayed and drawn for browsers.
//!
//! - A record is drawn in pieces of one second, each a message that begins with a whole picture. Browsers that watch
//!   the same second share the piece. A browser starts at any second and gets a piece each second, so nothing is drawn
//!   ahead for it, and a browser that does not read holds one piece.
//! - All work on records takes place in turn, on a thread that rests for as long as it has worked. So all browsers
//!   together, however often they seek, take at most half a processor from the rooms.
//! - A record is replayed once when it is opened. The replay leaves at most [`MAX_CHECKPOINTS`] copies of the room, from
//!   which pieces are drawn.
//! - At most [`MAX_OPEN`] records are open, each of at most [`MAX_BYTES`] and [`MAX_SECONDS`]; the rest of a longer one
//!   is not shown. A record that is being written is shown as it was when it was opened, at most [`STALE_INTERVAL`] ago.
//! - Records of private rooms and of players alone have other names, see
//!   [`Recordings`](crate::rooms::directory::Recordings). A record in the daily level of another day is not shown,
//!   because the level would have to be generated.
//!
//! Rejected: the player's keys on the WebSocket. To pause, the page closes it, and to seek, it opens another one. So
//! the rule that a browser sends nothing has no exception.

use std::collections::VecDeque;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::thread;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use bytes::Bytes;
use serde_json::{Value, json};
use tokio::sync::{Semaphore, oneshot, watch};
use tokio::task::{AbortHandle, spawn_blocking};
use tokio::time::sleep_until;
use tokio_websockets::Message;

use super::live::{PICTURES_PER_SECOND, words};
use super::picture;
use super::watch::Source;
use crate::accounts::Day;
use crate::lock::locked;
use crate::metrics::Metrics;
use crate::rooms::directory::{CAST, PublicRecording, Rooms};
use crate::rooms::replayed::RoomReplay;
use crate::rooms::room::{Catalog, Header, is_of_other_version};
use cellcaster::cli::ROOM_RECORDING;
use cellcaster::game::STEPS_PER_SECOND;

/// The most records that are open at a time.
const MAX_OPEN: usize = 4;
/// The most bytes of a record that are shown.
const MAX_BYTES: u64 = 8 << 20;
/// The most seconds of a record that are shown: four hours.
const MAX_SECONDS: u32 = 4 * 60 * 60;
/// The most copies of a room that are kept for a record.
const MAX_CHECKPOINTS: usize = 24;
/// The most pieces that are kept for a record, and the most copies of the room after them.
const MAX_PIECES: usize = 64;
const MAX_REPLAYS: usize = 8;
/// The longest time that a record is replayed before other work has its turn.
const WORK_INTERVAL: Duration = Duration::from_millis(20);
/// The time after which a record that has grown is opened again.
const STALE_INTERVAL: Duration = Duration::from_secs(30);
/// The time by which a browser gets pictures before it shows them.
const RESERVE_INTERVAL: Duration = Duration::from_secs(1);
/// The most finished records that are listed.
const MAX_LISTED: usize = 50;
/// The time for which a list is kept.
const LIST_INTERVAL: Duration = Duration::from_secs(5);
/// The steps of a second, and of a picture.
const SECOND_STEPS: u32 = STEPS_PER_SECOND;
const PICTURE_STEPS: u32 = STEPS_PER_SECOND / PICTURES_PER_SECOND;

/// The records of a host.
pub(crate) struct Records {
    rooms: Rooms,
    metrics: Arc<Metrics>,
    /// Who may work on a record.
    turn: Arc<Semaphore>,
    open: Mutex<Vec<Arc<OpenRecord>>>,
    list: tokio::sync::Mutex<Option<(Instant, Value)>>,
}

/// The result of opening a record.
type Opened = Result<Arc<WatchedRecord>, Arc<str>>;

/// A record that is open, or being opened.
struct OpenRecord {
    name: String,
    /// The size of its file.
    bytes: u64,
    since: Instant,
    opened: watch::Receiver<Option<Opened>>,
    opening: AbortHandle,
}

impl Drop for OpenRecord {
    fn drop(&mut self) {
        self.opening.abort();
    }
}

/// A record that can be shown from any second.
struct WatchedRecord {
    seconds: u32,
    catalog: Arc<Catalog>,
    /// Replays at some of the seconds.
    checkpoints: Vec<(u32, RoomReplay)>,
    drawn: Mutex<Drawn>,
}

/// The latest pieces of a record, by second, and replays at the ends of some.
#[derive(Default)]
struct Drawn {
    pieces: VecDeque<(u32, Piece)>,
    replays: VecDeque<(u32, RoomReplay)>,
}

/// A second of a record.
#[derive(Clone)]
struct Piece {
    message: Bytes,
    /// The room in words at its beginning, as JSON.
    words: Arc<str>,
}

impl Records {
    pub(crate) fn new(rooms: Rooms, metrics: Arc<Metrics>) -> Self {
        let turn = Arc::new(Semaphore::new(1));
        Self { rooms, metrics, turn, open: Mutex::default(), list: tokio::sync::Mutex::default() }
    }

    /// The records that browsers may watch, latest first.
    pub(crate) async fn list(&self) -> Value {
        let mut list = self.list.lock().await;
        if let Some((at, list)) = &*list
            && at.elapsed() < LIST_INTERVAL
        {
            return list.clone();
        }
        let rooms = self.rooms.clone();
        let listed = spawn_blocking(move || listed(&rooms)).await.unwrap_or_default();
        *list = Some((Instant::now(), listed.clone()));
        listed
    }

    /// The cast of a record; `None` if there is none that browsers may watch.
    pub(crate) fn cast(&self, name: &str) -> Option<PathBuf> {
        let cast = self.rooms.recordings().named(name)?.with_extension(CAST);
        cast.is_file().then_some(cast)
    }

    /// Watches a record from a second on.
    ///
    /// # Errors
    /// A sentence, if browsers may not watch this record now.
    pub(crate) fn watch(self: &Arc<Self>, name: &str, from: u32) -> Result<RecordPictures, String> {
        let open = self.open(name)?;
        let (records, opened) = (Arc::clone(self), open.opened.clone());
        Ok(RecordPictures { records, open, opened, second: from, due: None, words: "".into() })
    }

    fn open(self: &Arc<Self>, name: &str) -> Result<Arc<OpenRecord>, String> {
        let none = || "there is no such record".to_owned();
        let path = self.rooms.recordings().named(name).ok_or_else(none)?;
        let bytes = fs::metadata(&path).map_err(|_| none())?.len();
        let name = name.to_owned();
        locked(&self.open, |open| {
            let is_current =
                |it: &OpenRecord| it.bytes == bytes || it.since.elapsed() < STALE_INTERVAL;
            if let Some(known) = open.iter().find(|it| it.name == name && is_current(it)) {
                return Ok(Arc::clone(known));
            }
            if open.len() >= MAX_OPEN {
                // A record that nobody else holds is not watched.
                let unused = open.iter().position(|it| Arc::strong_count(it) == 1);
                let full = || format!("at most {MAX_OPEN} records can be watched at a time");
                open.remove(unused.ok_or_else(full)?);
            }
            let (sender, opened) = watch::channel(None);
            let records = Arc::clone(self);
            let opening = tokio::spawn(async move {
                let record = records.load(path).await.map(Arc::new).map_err(Arc::from);
                sender.send_replace(Some(record));
            });
            let (since, opening) = (Instant::now(), opening.abort_handle());
            let record = Arc::new(OpenRecord { name, bytes, since, opened, opening });
            open.push(Arc::clone(&record));
            Ok(record)
        })
    }

    /// Reads a record, and replays it.
    async fn load(&self, path: PathBuf) -> Result<WatchedRecord, String> {
        let sentence = |reason: String| format!("This record cannot be shown: {reason}.");
        let ended = || sentence("the server ends".to_owned());
        let rooms = self.rooms.clone();
        let read = move || begin(&rooms, &path);
        let replay = self.work(read).await.ok_or_else(ended)?.map_err(sentence)?;
        let mut scan = Scan::new(replay);
        loop {
            let scanned = self.work(move || scan.go_on().map(|is_over| (is_over, scan))).await;
            let (is_over, next) = scanned.ok_or_else(ended)?.map_err(sentence)?;
            scan = next;
            if is_over {
                break;
            }
        }
        Ok(WatchedRecord {
            seconds: scan.steps.div_ceil(SECOND_STEPS).max(1),
            catalog: Arc::clone(self.rooms.catalog()),
            checkpoints: scan.checkpoints,
            drawn: Mutex::default(),
        })
    }

    /// A piece of a record; `None` if the server ends.
    async fn piece(&self, record: &Arc<WatchedRecord>, second: u32) -> Option<Piece> {
        if let Some(piece) = record.known(second) {
            return Some(piece);
        }
        let (record, metrics) = (Arc::clone(record), Arc::clone(&self.metrics));
        self.work(move || record.known(second).or_else(|| record.draw(second, &metrics))).await?
    }

    /// Runs `act` when it is its turn. Then the thread rests, also if nobody waits for the result any more.
    async fn work<T: Send + 'static>(&self, act: impl FnOnce() -> T + Send + 'static) -> Option<T> {
        let turn = Arc::clone(&self.turn).acquire_owned().await.ok()?;
        let (sender, result) = oneshot::channel();
        spawn_blocking(move || {
            let begun = Instant::now();
            _ = sender.send(act());
            thread::sleep(begun.elapsed());
            drop(turn);
        });
        result.await.ok()
    }
}

/// The list of records, as JSON.
fn listed(rooms: &Rooms) -> Value {
    let recordings = rooms.recordings().public(MAX_LISTED);
    let entry = |recording: PublicRecording| {
        let header = recording.header()?;
        is_shown(rooms, &header).then(|| {
            json!({
                "name": recording.name,
                "mode": header.mode.title(),
                "level": rooms.catalog().title(&header.level),
                "time": recording.time.map(seconds),
            })
        })
    };
    recordings.into_iter().filter_map(entry).collect()
}

/// The seconds since 1970.
fn seconds(time: SystemTime) -> u64 {
    time.duration_since(UNIX_EPOCH).unwrap_or_default().as_secs()
}

/// Returns true if the host has the level of a round, without generating it.
fn is_shown(rooms: &Rooms, header: &Header) -> bool {
    let is_today = |day| day == rooms.today();
    rooms.catalog().has(&header.level) && Day::of_level(&header.level).is_none_or(is_today)
}

/// The replay of the log in a file, or of its first part.
fn begin(rooms: &Rooms, path: &Path) -> Result<RoomReplay, String> {
    let read = || -> io::Result<String> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MAX_BYTES).read_to_end(&mut bytes)?;
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        String::from_utf8(bytes).map_err(io::Error::other)
    };
    let text = read().map_err(|error| error.to_string())?;
    // The first part may end within the header of a round.
    let catalog = rooms.catalog();
    let replay = RoomReplay::new(&text, catalog).or_else(|fault| {
        let last = text.rfind(ROOM_RECORDING).filter(|last| *last > 0);
        last.filter(|_| !is_of_other_version(&text))
            .map_or(Err(fault), |last| RoomReplay::new(&text[..last], catalog))
    })?;
    if !replay.headers().all(|header| is_shown(rooms, header)) {
        return Err("the host no longer has its level".to_owned());
    }
    Ok(replay)
}

/// The first replay of a record.
struct Scan {
    replay: RoomReplay,
    steps: u32,
    checkpoints: Vec<(u32, RoomReplay)>,
    /// The seconds between two checkpoints.
    interval: u32,
}

impl Scan {
    fn new(replay: RoomReplay) -> Self {
        Self { replay, steps: 0, checkpoints: Vec::new(), interval: 10 }
    }

    /// Replays for at most [`WORK_INTERVAL`]. Returns true at the end.
    fn go_on(&mut self) -> Result<bool, String> {
        let begun = Instant::now();
        loop {
            if self.steps.is_multiple_of(SECOND_STEPS) {
                let second = self.steps / SECOND_STEPS;
                if second >= MAX_SECONDS {
                    return Ok(true);
                }
                self.keep(second);
            }
            if !self.replay.step()? {
                return Ok(true);
            }
            self.steps += 1;
            if self.steps.is_multiple_of(SECOND_STEPS) && begun.elapsed() >= WORK_INTERVAL {
                return Ok(false);
            }
        }
    }

    /// Keeps a copy if one is due. If there are too many, keeps every second one.
    fn keep(&mut self, second: u32) {
        if !second.is_multiple_of(self.interval) {
            return;
        }
        if self.checkpoints.len() >= MAX_CHECKPOINTS {
            self.interval *= 2;
            let interval = self.interval;
            self.checkpoints.retain(|(second, _)| second.is_multiple_of(interval));
        }
        if second.is_multiple_of(self.interval) {
            self.checkpoints.push((second, self.replay.clone()));
        }
    }
}

impl WatchedRecord {
    /// A piece that is drawn already.
    fn known(&self, second: u32) -> Option<Piece> {
        locked(&self.drawn, |drawn| {
            drawn.pieces.iter().find(|it| it.0 == second).map(|it| it.1.clone())
        })
    }

    /// Draws a piece, and keeps it. `None` if the record has no checkpoint before it.
    fn draw(&self, second: u32, metrics: &Metrics) -> Option<Piece> {
        let recent = locked(&self.drawn, |drawn| {
            let before = drawn.replays.iter().filter(|it| it.0 <= second);
            before.max_by_key(|it| it.0).cloned()
        });
        let kept = self.checkpoints.iter().rev().find(|it| it.0 <= second).cloned();
        let (at, mut replay) = recent.into_iter().chain(kept).max_by_key(|it| it.0)?;
        for _ in at * SECOND_STEPS..second * SECOND_STEPS {
            replay.step().ok()?;
        }
        let mut message = picture::Message::default();
        let (mut said, mut before) = (None, Vec::new());
        for step in
            (second * SECOND_STEPS..(second + 1) * SECOND_STEPS).step_by(PICTURE_STEPS as usize)
        {
            // The snapshot is dropped before the next step, which would copy its game.
            let view = replay.room.view();
            let cells = picture::draw(&view, &self.catalog);
            metrics.web_pictures.inc();
            if said.is_none() {
                said = Some(words(&view, &self.catalog).into());
                message.push_whole(step, &cells);
            } else {
                message.push_changes(step, &before, &cells);
            }
            before = cells;
            drop(view);
            if !(0..PICTURE_STEPS).all(|_| replay.step().unwrap_or_default()) {
                break;
            }
        }
        let piece = Piece { message: message.take()?, words: said? };
        locked(&self.drawn, |drawn| {
            push(&mut drawn.pieces, (second, piece.clone()), MAX_PIECES);
            push(&mut drawn.replays, (second + 1, replay), MAX_REPLAYS);
        });
        Some(piece)
    }
}

fn push<T>(queue: &mut VecDeque<T>, item: T, most: usize) {
    if queue.len() >= most {
        queue.pop_front();
    }
    queue.push_back(item);
}

/// The messages about a record for one browser.
pub(crate) struct RecordPictures {
    records: Arc<Records>,
    /// Keeps the record open.
    open: Arc<OpenRecord>,
    opened: watch::Receiver<Option<Opened>>,
    /// The next second.
    second: u32,
    /// When the piece after it is due; `None` before the first one.
    due: Option<tokio::time::Instant>,
    words: Arc<str>,
}

impl Source for RecordPictures {
    async fn next(&mut self) -> Result<Vec<Message>, String> {
        let opened = self.opened.wait_for(Option::is_some).await.map(|opened| opened.clone());
        let ended = || format!("The record {} is no longer open.", self.open.name);
        let record = opened.ok().flatten().ok_or_else(ended)?;
        let record = record.map_err(|sentence| sentence.to_string())?;
        if self.second >= record.seconds && self.due.is_some() {
            return Err("The record has ended.".to_owned());
        }
        let now = tokio::time::Instant::now;
        let mut messages = Vec::new();
        let due = if let Some(due) = self.due {
            sleep_until(due).await;
            due
        } else {
            self.second = self.second.min(record.seconds - 1);
            messages.push(Message::text(json!({ "seconds": record.seconds }).to_string()));
            now() - RESERVE_INTERVAL
        };
        let piece = self.records.piece(&record, self.second).await;
        let piece = piece.ok_or("The rest of the record cannot be shown.")?;
        self.second += 1;
        self.due = Some((due + Duration::from_secs(1)).max(now() - RESERVE_INTERVAL));
        if self.words != piece.words {
            self.words = Arc::clone(&piece.words);
            messages.push(Message::text(piece.words.to_string()));
        }
        messages.push(Message::binary(piece.message));
        Ok(messages)
    }
}
