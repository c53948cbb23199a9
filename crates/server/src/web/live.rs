//! Rooms that are watched: each is drawn by one task for all who watch it in the same [form](Form).
//!
//! - A task draws at most [`PICTURES_PER_SECOND`] times a second, less often if the processor is busy, and only if
//!   the room has taken a step. It ends with its room or its last watcher.
//! - [`PICTURES_PER_MESSAGE`] pictures make a message, which the page shows one after the other. So half a thousand
//!   watchers cost a thousand messages a second, not five.
//! - The task keeps the latest message only. A watcher who has read the message before gets the changes, and a
//!   watcher who is behind gets the whole picture. So a watcher who does not read holds one message, and nothing is
//!   queued.
//! - A message is encoded once. The whole picture is encoded when the first watcher needs it.
//!
//! `cellcaster-lab load --browsers 500` measures the cost. docs/performance.md has the result.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use bytes::Bytes;
use serde_json::json;
use tokio::sync::watch;
use tokio::time::{Instant, sleep};
use tokio_websockets::Message;

use super::alis;
use super::picture::{self, Cell};
use super::watch::Source;
use crate::load::Load;
use crate::lock::locked;
use crate::metrics::Metrics;
use crate::rooms::cast::{self, Cast};
use crate::rooms::directory::Rooms;
use crate::rooms::room::{Catalog, Mode, Phase, RoomView};
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::session::lobby::seen_through;
use cellcaster::app::parts::of_steps;
use cellcaster::game::STEPS_PER_SECOND;

/// The maximum number of pictures per second.
pub(crate) const PICTURES_PER_SECOND: u32 = 10;
/// The number of pictures in a message.
const PICTURES_PER_MESSAGE: u32 = 5;
/// The number of a session's usual frames in the time of one picture.
const FRAMES_PER_PICTURE: u32 = 3;
/// The time between two pictures of a cast.
const CAST_INTERVAL: Duration =
    Duration::from_millis(1000 * cast::INTERVAL / STEPS_PER_SECOND as u64);

/// The form in which a room is watched.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Form {
    /// The view of a member, in messages for the page.
    Cells,
    /// The room from above, in events for asciinema's player.
    Cast,
}

/// The rooms that are watched.
pub(crate) struct LiveRooms {
    rooms: Rooms,
    pub(crate) load: Arc<Load>,
    watched: Mutex<BTreeMap<(RoomId, Form), Pictures>>,
}

/// The sender of the messages about a room.
type Pictures = watch::Sender<Arc<Picture>>;

/// The latest message about a room.
#[derive(Debug, Default)]
struct Picture {
    /// The number of messages before this one, which is 0 before the first.
    number: u64,
    /// The changes since the previous message; `None` if the pictures are the same.
    changes: Option<Bytes>,
    /// The step and the cells of the last picture.
    last: (u32, Vec<Cell>),
    whole: OnceLock<Bytes>,
    /// The room in words, as JSON; empty in a cast.
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
    pub(crate) fn watch(self: &Arc<Self>, id: RoomId, form: Form) -> Option<LivePictures> {
        self.is_public(id).then(|| {
            locked(&self.watched, |watched| {
                let pictures = watched.entry((id, form)).or_insert_with(|| {
                    let pictures = Pictures::default();
                    tokio::spawn(Arc::clone(self).draw((id, form), pictures.clone()));
                    pictures
                });
                let mut pictures = pictures.subscribe();
                pictures.mark_changed();
                LivePictures { form, pictures, read: 0, words: "".into(), has_ended: false }
            })
        })
    }

    fn is_public(&self, id: RoomId) -> bool {
        let summaries = self.rooms.summaries();
        let summaries = summaries.borrow();
        summaries.iter().any(|room| room.id == id && is_public(&self.rooms, room))
    }

    /// Draws a room for as long as it is watched.
    async fn draw(self: Arc<Self>, (id, form): (RoomId, Form), pictures: Pictures) {
        let mut drawing = match form {
            Form::Cells => Drawing::Cells(Cells::default()),
            Form::Cast => Drawing::Cast(Box::new(DrawnCast::new())),
        };
        loop {
            let is_public = self.is_public(id);
            let (goes_on, browsers) = locked(&self.watched, |watched| {
                let goes_on = is_public && pictures.receiver_count() > 0;
                if !goes_on {
                    watched.remove(&(id, form));
                }
                let of_room = watched.iter().filter(|(it, _)| it.0 == id);
                (goes_on, of_room.map(|(_, pictures)| pictures.receiver_count()).sum())
            });
            self.rooms.note_browsers(id, if is_public { browsers } else { 0 });
            if !goes_on {
                return;
            }
            // The snapshot is dropped before the task waits.
            if let Some(room) = self.rooms.view(id) {
                let next = drawing.next(&room, self.rooms.catalog(), &self.load.metrics);
                if let Some(next) = next {
                    pictures.send_replace(Arc::new(next));
                }
            }
            let picture_time = self.load.rate().frame_time * FRAMES_PER_PICTURE;
            let least = match form {
                Form::Cells => Duration::from_secs(1) / PICTURES_PER_SECOND,
                Form::Cast => CAST_INTERVAL,
            };
            sleep(picture_time.max(least)).await;
        }
    }
}

/// The drawing of a room.
enum Drawing {
    Cells(Cells),
    Cast(Box<DrawnCast>),
}

/// The cells of a room, and the message that is being written.
#[derive(Default)]
struct Cells {
    /// The number of messages up to now.
    messages: u64,
    /// The number of pictures since the last message, including pictures without a change.
    waiting: u32,
    /// The step and the cells of the last picture.
    last: (u32, Vec<Cell>),
    message: picture::Message,
    words: Arc<str>,
}

struct DrawnCast {
    cast: Cast,
    begun: Instant,
    /// The number and the time of the last event, and the room's step.
    number: u64,
    time: u64,
    step: u64,
}

impl Drawing {
    /// Draws `room`. Returns the next message, if one is complete and differs from the one before.
    fn next(&mut self, room: &RoomView, catalog: &Catalog, metrics: &Metrics) -> Option<Picture> {
        match self {
            Self::Cells(cells) => cells.next(room, catalog, metrics),
            Self::Cast(cast) => cast.next(room, metrics),
        }
    }
}

impl Cells {
    fn next(&mut self, room: &RoomView, catalog: &Catalog, metrics: &Metrics) -> Option<Picture> {
        let step = u32::try_from(room.step).unwrap_or(u32::MAX);
        let is_first = self.messages == 0;
        if is_first || step != self.last.0 {
            let cells = picture::draw(room, catalog);
            metrics.web_pictures.inc();
            if !is_first {
                self.message.push_changes(step, &self.last.1, &cells);
            }
            self.last = (step, cells);
        }
        self.waiting += 1;
        if !is_first && self.waiting < PICTURES_PER_MESSAGE {
            return None;
        }
        self.waiting = 0;
        let (changes, words) = (self.message.take(), words(room, catalog));
        if !is_first && changes.is_none() && *words == *self.words {
            return None;
        }
        self.words = words.into();
        self.messages += 1;
        Some(Picture {
            number: self.messages,
            changes,
            last: self.last.clone(),
            whole: OnceLock::new(),
            words: Arc::clone(&self.words),
        })
    }
}

impl DrawnCast {
    fn new() -> Self {
        Self { cast: Cast::new(), begun: Instant::now(), number: 0, time: 0, step: 0 }
    }

    fn next(&mut self, room: &RoomView, metrics: &Metrics) -> Option<Picture> {
        if self.number > 0 && room.step == self.step {
            return None;
        }
        self.step = room.step;
        let text = self.cast.next(room);
        metrics.web_pictures.inc();
        if text.is_empty() {
            return None;
        }
        self.number += 1;
        let time = self.begun.elapsed().as_micros() as u64;
        let since = time - std::mem::replace(&mut self.time, time);
        let screen = Cast::new().next(room);
        Some(Picture {
            number: self.number,
            changes: Some(alis::output(self.number, since, &text)),
            whole: alis::start(self.number, time, cast::SIZE, &screen).into(),
            ..Picture::default()
        })
    }
}

impl Picture {
    /// The message for a watcher who has read message `read`.
    fn message(&self, read: u64) -> Option<Bytes> {
        if read > 0 && read + 1 == self.number {
            return self.changes.clone();
        }
        let whole = self.whole.get_or_init(|| {
            let (step, cells) = &self.last;
            let mut message = picture::Message::default();
            message.push_whole(*step, cells);
            message.take().unwrap_or_default()
        });
        Some(whole.clone())
    }
}

/// The messages about a room for one browser.
pub(crate) struct LivePictures {
    form: Form,
    pictures: watch::Receiver<Arc<Picture>>,
    /// The number of the last message that was read.
    read: u64,
    words: Arc<str>,
    has_ended: bool,
}

impl Source for LivePictures {
    async fn next(&mut self) -> Result<Vec<Message>, String> {
        let mut messages = Vec::new();
        while messages.is_empty() {
            if self.has_ended || self.pictures.changed().await.is_err() {
                if self.form == Form::Cells || self.has_ended {
                    return Err("The room has closed.".to_owned());
                }
                self.has_ended = true;
                return Ok(vec![Message::binary(alis::END)]);
            }
            let picture = Arc::clone(&self.pictures.borrow_and_update());
            if picture.number == 0 {
                continue;
            }
            if self.words != picture.words {
                self.words = Arc::clone(&picture.words);
                messages.push(Message::text(self.words.to_string()));
            }
            if self.form == Form::Cast && self.read == 0 {
                messages.push(Message::binary(alis::MAGIC));
            }
            messages.extend(picture.message(self.read).map(Message::binary));
            self.read = picture.number;
        }
        Ok(messages)
    }
}

/// The room in words: its mode and level, and the players with their points and places.
pub(crate) fn words(room: &RoomView, catalog: &Catalog) -> String {
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
