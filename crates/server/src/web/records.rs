//! Records of rooms, which are replayed and drawn for browsers.
//!
//! - A record is drawn in pieces of one second, each a message that begins with a whole picture. Browsers that watch
//!   the same second share the piece. A browser starts at any second and gets a piece each second, so nothing is drawn
//!   ahead for it, and a browser that does not read holds one piece.
//! - All work on records takes place in turn, on a thread that rests for as long as it has worked. So all browsers
//!   together, however often they seek, take at most half a processor from the rooms.
//! - A record is read once when it is opened. The [`Reader`] keeps states on the way, from which pieces are drawn, and
//!   the marks of events. The page shows at most [`MARKS_PER_KIND`] of each kind.
//! - At another speed, a browser gets its pieces faster or more slowly. If the thread cannot draw as fast, it gets them
//!   when they are drawn.
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
use crate::queue::push_within;
use crate::rooms::directory::{CAST, PublicRecording, Rooms};
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{Catalog, Header, Room};
use cellcaster::app::parts::{Cursor, MarkKind, Reader};
use cellcaster::game::STEPS_PER_SECOND;

/// The most records that are open at a time.
const MAX_OPEN: usize = 4;
/// The most bytes of a record that are shown.
const MAX_BYTES: u64 = 8 << 20;
/// The most seconds of a record that are shown: four hours.
const MAX_SECONDS: u32 = 4 * 60 * 60;
/// The most marks of a kind that are shown, at equal parts of the record.
const MARKS_PER_KIND: u64 = 240;
/// The most pieces that are kept for a record.
const MAX_PIECES: usize = 64;
/// The usual speed and the greatest one, in quarters of a second each second.
pub(crate) const USUAL_QUARTERS: u32 = 4;
pub(crate) const MAX_QUARTERS: u32 = 64;
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
    /// The permission to work on a record.
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
    /// The marks, each with its second, its sign and its name, as JSON.
    marks: Value,
    catalog: Arc<Catalog>,
    /// The reader, and the room at the latest picture.
    reader: Mutex<(Reader<RoomRecord>, Cursor, Room)>,
    /// The latest pieces, by second.
    pieces: Mutex<VecDeque<(u32, Piece)>>,
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

    /// Watches a record from a second on, at a speed in quarters of the usual one.
    ///
    /// # Errors
    /// A sentence, if browsers may not watch this record now.
    pub(crate) fn watch(
        self: &Arc<Self>,
        name: &str,
        from: u32,
        quarters: u32,
    ) -> Result<RecordPictures, String> {
        let open = self.open(name)?;
        let (records, opened) = (Arc::clone(self), open.opened.clone());
        let interval = Duration::from_secs(USUAL_QUARTERS.into()) / quarters;
        let words = "".into();
        Ok(RecordPictures { records, open, opened, second: from, interval, due: None, words })
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

    /// Reads a record.
    async fn load(&self, path: PathBuf) -> Result<WatchedRecord, String> {
        let sentence = |reason: String| format!("This record cannot be shown: {reason}.");
        let ended = || sentence("the server ends".to_owned());
        let rooms = self.rooms.clone();
        let begun = self.work(move || begin(&rooms, &path)).await;
        let (mut reader, start) = begun.ok_or_else(ended)?.map_err(sentence)?;
        let most = u64::from(MAX_SECONDS * SECOND_STEPS);
        while !reader.is_read() && reader.steps_read() < most {
            let read = move || {
                let begun = Instant::now();
                reader.read(&|| begun.elapsed() >= WORK_INTERVAL);
                reader
            };
            reader = self.work(read).await.ok_or_else(ended)?;
        }
        let steps = reader.steps_read().min(most);
        Ok(WatchedRecord {
            seconds: (steps as u32).div_ceil(SECOND_STEPS).max(1),
            marks: marks(&reader, steps),
            catalog: Arc::clone(self.rooms.catalog()),
            reader: Mutex::new((reader, Cursor::default(), start)),
            pieces: Mutex::default(),
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

/// A reader of the log in a file, or of its first part, and the room at its beginning.
fn begin(rooms: &Rooms, path: &Path) -> Result<(Reader<RoomRecord>, Room), String> {
    let read = || -> io::Result<String> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MAX_BYTES).read_to_end(&mut bytes)?;
        bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        String::from_utf8(bytes).map_err(io::Error::other)
    };
    let text = read().map_err(|error| error.to_string())?;
    let record = RoomRecord::parse(&text, rooms.catalog())?;
    if !record.headers().all(|header| is_shown(rooms, header)) {
        return Err("the host no longer has its level".to_owned());
    }
    Reader::new(record).ok_or_else(|| "it is empty".to_owned())
}

/// The marks in the first `steps` steps, as JSON: of each kind at most one in each of [`MARKS_PER_KIND`] equal parts.
fn marks(reader: &Reader<RoomRecord>, steps: u64) -> Value {
    let part = |step: u64| step * MARKS_PER_KIND / steps.max(1);
    let of_kind = |kind: MarkKind| {
        let (name, sign) = kind.name();
        let mut steps: Vec<u64> = reader.marks_of(kind).filter(|step| *step <= steps).collect();
        steps.dedup_by_key(|step| part(*step));
        let second = move |step: u64| (step - 1) / u64::from(SECOND_STEPS);
        steps.into_iter().map(move |step| json!([second(step), sign, name]))
    };
    MarkKind::ALL.into_iter().flat_map(of_kind).collect()
}

impl WatchedRecord {
    /// A piece that is drawn already.
    fn known(&self, second: u32) -> Option<Piece> {
        locked(&self.pieces, |pieces| {
            pieces.iter().find(|it| it.0 == second).map(|it| it.1.clone())
        })
    }

    /// Draws a piece, and keeps it. `None` if nothing can be drawn.
    fn draw(&self, second: u32, metrics: &Metrics) -> Option<Piece> {
        let first = second * SECOND_STEPS;
        let mut message = picture::Message::default();
        let (mut said, mut before) = (None, Vec::new());
        locked(&self.reader, |(reader, cursor, room)| {
            for step in (first..first + SECOND_STEPS).step_by(PICTURE_STEPS as usize) {
                reader.seek(step.into(), (cursor, room), &|| false);
                if cursor.step != u64::from(step) {
                    break;
                }
                // The snapshot is dropped before the next step, which would copy its game.
                let view = room.view();
                let cells = picture::draw(&view, &self.catalog);
                metrics.web_pictures.inc();
                if said.is_none() {
                    said = Some(words(&view, &self.catalog).into());
                    message.push_whole(step, &cells);
                } else {
                    message.push_changes(step, &before, &cells);
                }
                before = cells;
            }
        });
        let piece = Piece { message: message.take()?, words: said? };
        let kept = (second, piece.clone());
        locked(&self.pieces, |pieces| push_within(pieces, kept, MAX_PIECES));
        Some(piece)
    }
}

/// The messages about a record for one browser.
pub(crate) struct RecordPictures {
    records: Arc<Records>,
    /// Keeps the record open.
    open: Arc<OpenRecord>,
    opened: watch::Receiver<Option<Opened>>,
    /// The next second.
    second: u32,
    /// The time between two pieces.
    interval: Duration,
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
            let facts = json!({ "seconds": record.seconds, "marks": record.marks });
            messages.push(Message::text(facts.to_string()));
            now() - RESERVE_INTERVAL
        };
        let piece = self.records.piece(&record, self.second).await;
        let piece = piece.ok_or("The rest of the record cannot be shown.")?;
        self.second += 1;
        self.due = Some((due + self.interval).max(now() - RESERVE_INTERVAL));
        if self.words != piece.words {
            self.words = Arc::clone(&piece.words);
            messages.push(Message::text(piece.words.to_string()));
        }
        messages.push(Message::binary(piece.message));
        Ok(messages)
    }
}
