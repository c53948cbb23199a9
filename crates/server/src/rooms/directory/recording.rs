//! Recordings of rooms: files in a folder of bounded size.
//!
//! # Rules
//!
//! - The folder holds at most [`RecordingBounds::bytes`], counted in whole blocks per file, and no recording that was
//!   finished longer than [`RecordingBounds::age`] ago. The oldest finished recordings are removed first. A file that
//!   is still being written stays.
//! - A recording ends, with a whole entry, when the folder is full of files that are still being written, or
//!   when the recording reaches [`MAX_RECORDED_BYTES`]. Its room goes on, and the next round is recorded
//!   again.
//! - A round begins a new file if the last one has reached [`RecordingBounds::file`], so that long recordings age, too.
//! - The name says who may see the recording in a browser: `room-7.log` everybody, `private-7.log` nobody. Recordings of
//!   private rooms and of players who play alone are private.
//! - Beside each recording is its [cast](Cast), with the same name and the ending `.cast`. It is a recording of its own
//!   for the limits, and begins and ends with the log. If there is no room for it, the log goes on.
//!
//! Entries are few and short. They are buffered for at most a second, see
//! [`RoundLog`](crate::rooms::sequencer::RoundLog), so a killed server loses no more than that. Each write
//! ends with a whole line. Rejected: a thread for disk access, because the disk is used so rarely. The folder
//! is read once, when the server starts: reading 65,536 file names again would delay a room's step.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, Read, Write};
use std::mem;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::{Duration, SystemTime};

use crate::lock::locked;
use crate::rooms::cast::Cast;
use crate::rooms::replayed::MAX_RECORDED_BYTES;
use crate::rooms::room::{Entry, Header, Mode, RoomView, first_header};
use crate::rooms::sequencer::Recording;
use crate::rooms::summary::RoomId;
use cellcaster::app::store::private;

/// Opens the recordings of rooms.
#[derive(Clone)]
pub(crate) struct Recordings {
    open: Arc<OpenRecording>,
    /// The folder, if the recordings are in one.
    folder: Option<Arc<RecordingFolder>>,
}

/// Opens the recording of a room, which may be private.
type OpenRecording = dyn Fn(RoomId, bool) -> Option<Box<dyn Recording>> + Send + Sync;

impl Recordings {
    /// Recordings opened by `open`.
    pub(crate) fn new(
        open: impl Fn(RoomId, bool) -> Option<Box<dyn Recording>> + Send + Sync + 'static,
    ) -> Self {
        Self { open: Arc::new(open), folder: None }
    }

    /// Recordings in a folder; no recordings if there is no folder.
    pub(crate) fn in_folder(folder: Option<PathBuf>, bounds: RecordingBounds) -> Self {
        let Some(path) = folder else { return Self::new(|_, _| None) };
        let folder = Arc::new(RecordingFolder::open(path, bounds));
        let of_rooms = Arc::clone(&folder);
        let recordings = Self::new(move |room, is_private| {
            Some(Box::new(RecordedRoom::new(Arc::clone(&of_rooms), room, is_private)))
        });
        Self { folder: Some(folder), ..recordings }
    }

    /// Opens the recording of a new room, which may be private; `None` if the room is not recorded.
    pub(crate) fn open(&self, id: RoomId, is_private: bool) -> Option<Box<dyn Recording>> {
        (self.open)(id, is_private)
    }

    /// The public logs, latest first: the unfinished ones, and then at most `most` finished ones.
    pub(crate) fn public(&self, most: usize) -> Vec<PublicRecording> {
        let Some(folder) = &self.folder else { return Vec::new() };
        locked(&folder.held, |held| {
            let finished = held.finished.keys().rev().map(|(time, path)| (Some(*time), path));
            let finished = finished.filter(|(_, path)| is_public_log(path)).take(most);
            let written = held.written.iter().filter(|path| is_public_log(path));
            let written = written.map(|path| (None, path));
            let recording = |(time, path): (Option<SystemTime>, &PathBuf)| PublicRecording {
                name: path.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
                path: path.clone(),
                time,
            };
            written.chain(finished).map(recording).collect()
        })
    }

    /// Whether rooms are recorded in a folder.
    pub(crate) fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// The path of a public log, by its name such as `room-7`; `None` if there is no such log.
    pub(crate) fn named(&self, name: &str) -> Option<PathBuf> {
        let file = format!("{name}.{LOG}");
        // Such a name has no separators, so the path does not leave the folder.
        let is_public = is_name_of(OsStr::new(&file), PUBLIC, LOG);
        let path = is_public.then_some(self.folder.as_ref()?.path.join(file))?;
        path.is_file().then_some(path)
    }
}

/// A recording that browsers and the lobby may show.
#[derive(Clone, Debug)]
pub(crate) struct PublicRecording {
    /// The name of the file without its ending.
    pub(crate) name: String,
    /// The path of the log.
    pub(crate) path: PathBuf,
    /// When it was finished; `None` if it is being written.
    pub(crate) time: Option<SystemTime>,
}

impl PublicRecording {
    /// The header of the first round; `None` if it cannot be read, or is of another version.
    pub(crate) fn header(&self) -> Option<Header> {
        let mut head = Vec::new();
        File::open(&self.path).ok()?.take(HEAD_BYTES).read_to_end(&mut head).ok()?;
        first_header(&String::from_utf8_lossy(&head))
    }
}

impl fmt::Debug for Recordings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recordings").finish_non_exhaustive()
    }
}

/// A room whose log is recorded in a folder.
struct RecordedRoom {
    folder: Arc<RecordingFolder>,
    room: RoomId,
    is_private: bool,
    /// `None` if the recording ended before this round.
    file: Option<RecordedFile>,
    cast: RecordedCast,
}

/// The cast beside a file.
enum RecordedCast {
    /// It begins with the next picture.
    Awaited,
    Drawn(Box<Cast>, RecordedFile),
    /// There is none until the next file, because it could not be written.
    Ended,
}

/// A recording that is being written.
struct RecordedFile {
    folder: Arc<RecordingFolder>,
    path: PathBuf,
    output: BufWriter<File>,
    bytes: u64,
}

/// The limits of a folder of recordings.
pub(crate) struct RecordingBounds {
    pub(crate) bytes: u64,
    pub(crate) age: Duration,
    /// The size of a file after which the next round begins a new one.
    pub(crate) file: u64,
}

/// A folder of recordings.
struct RecordingFolder {
    path: PathBuf,
    bounds: RecordingBounds,
    held: Mutex<Held>,
}

/// The recordings in a folder.
#[derive(Default)]
struct Held {
    /// The finished recordings with their sizes in bytes, oldest first.
    finished: BTreeMap<(SystemTime, PathBuf), u64>,
    /// The recordings that are being written.
    written: BTreeSet<PathBuf>,
    /// The total size of all recordings, in blocks.
    blocks: u64,
}

/// The beginnings of the names of recordings that everybody may see, and of the others.
const PUBLIC: &str = "room-";
const PRIVATE: &str = "private-";
/// The endings of the names of logs and casts.
const LOG: &str = "log";
pub(crate) const CAST: &str = "cast";
/// The number of bytes at the beginning of a log that hold the header of its first round.
const HEAD_BYTES: u64 = 4 << 10;
/// The least disk space that a file takes, including its directory entry.
const BLOCK: u64 = 4 << 10;

impl Default for RecordingBounds {
    fn default() -> Self {
        Self { bytes: 256 << 20, age: Duration::from_hours(30 * 24), file: 16 << 20 }
    }
}

impl Recording for RecordedRoom {
    fn begin(&mut self, header: &Header) -> io::Result<()> {
        let most = self.folder.bounds.file;
        let is_long = |file: &RecordedFile| file.bytes >= most;
        let has_long_cast = matches!(&self.cast, RecordedCast::Drawn(_, file) if is_long(file));
        if self.file.as_ref().is_none_or(is_long) || has_long_cast {
            // Finish the previous files first, so that they can be removed to make room for the new one.
            self.file = None;
            self.cast = RecordedCast::Awaited;
            let is_private = self.is_private || header.mode == Mode::Alone;
            let kind = if is_private { PRIVATE } else { PUBLIC };
            let name = format!("{kind}{}", self.room);
            self.file = RecordedFile::create(&self.folder, |folder| folder.free_path(&name))
                .inspect_err(|error| {
                    tracing::error!(%error, room = %self.room, "a room cannot be recorded");
                })
                .ok();
        }
        self.write(&header.to_string())?;
        self.flush()
    }

    fn append(&mut self, entry: &Entry) -> io::Result<()> {
        self.write(&format!("{entry}\n"))
    }

    fn look(&mut self, room: &RoomView) -> io::Result<()> {
        let drawn = self.draw(room);
        if drawn.is_err() {
            self.cast = RecordedCast::Ended;
        }
        drawn
    }

    fn flush(&mut self) -> io::Result<()> {
        let log = self.file.as_mut().map_or(Ok(()), |file| file.output.flush());
        let cast = match &mut self.cast {
            RecordedCast::Drawn(_, file) => file.output.flush(),
            RecordedCast::Awaited | RecordedCast::Ended => Ok(()),
        };
        log.and(cast)
    }
}

impl RecordedRoom {
    fn new(folder: Arc<RecordingFolder>, room: RoomId, is_private: bool) -> Self {
        Self { folder, room, is_private, file: None, cast: RecordedCast::Awaited }
    }

    /// Writes all of `text` or nothing. Discards it if the recording has ended.
    fn write(&mut self, text: &str) -> io::Result<()> {
        let Some(file) = &mut self.file else { return Ok(()) };
        let written = file.write(text);
        if written.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::QuotaExceeded) {
            self.file = None;
            self.cast = RecordedCast::Ended;
        }
        written
    }

    /// Draws the next picture of the cast, which begins with the first one.
    fn draw(&mut self, room: &RoomView) -> io::Result<()> {
        if let (RecordedCast::Awaited, Some(log)) = (&self.cast, &self.file) {
            let path = log.path.with_extension(CAST);
            let mut file = RecordedFile::create(&self.folder, |_| path)?;
            file.write(&Cast::header())?;
            self.cast = RecordedCast::Drawn(Box::new(Cast::new()), file);
        }
        let RecordedCast::Drawn(cast, file) = &mut self.cast else { return Ok(()) };
        cast.line(room).map_or(Ok(()), |line| file.write(&line))
    }
}

impl RecordedFile {
    /// Creates a new file in the folder. It contains the players' chat, so only its owner can read it.
    fn create(
        folder: &Arc<RecordingFolder>,
        path: impl FnOnce(&RecordingFolder) -> PathBuf,
    ) -> io::Result<Self> {
        private::create_folder(&folder.path)?;
        if !folder.take(1) {
            return Err(io::ErrorKind::QuotaExceeded.into());
        }
        // Making room may have freed a name.
        let path = path(folder);
        let mut options = OpenOptions::new();
        private::restrict_file(&mut options);
        let file = options.write(true).create_new(true).open(&path);
        let file = file.inspect_err(|_| locked(&folder.held, |held| held.blocks -= 1))?;
        locked(&folder.held, |held| held.written.insert(path.clone()));
        Ok(Self { folder: Arc::clone(folder), path, output: BufWriter::new(file), bytes: 0 })
    }

    /// Writes all of `text` or, with the error `QuotaExceeded`, nothing.
    fn write(&mut self, text: &str) -> io::Result<()> {
        let bytes = self.bytes + text.len() as u64;
        let more = blocks(bytes) - blocks(self.bytes);
        if bytes > MAX_RECORDED_BYTES || !self.folder.take(more) {
            let reason = "it ends here, because the recordings have reached their limit of bytes";
            return Err(io::Error::new(io::ErrorKind::QuotaExceeded, reason));
        }
        self.bytes = bytes;
        self.output.write_all(text.as_bytes())
    }
}

impl Drop for RecordedFile {
    fn drop(&mut self) {
        // Errors were already reported when the entries were written.
        _ = self.output.flush();
        let key = (SystemTime::now(), mem::take(&mut self.path));
        locked(&self.folder.held, |held| {
            held.written.remove(&key.1);
            held.finished.insert(key, self.bytes);
        });
    }
}

impl RecordingFolder {
    /// Opens a folder and counts the recordings in it.
    fn open(path: PathBuf, bounds: RecordingBounds) -> Self {
        let mut held = Held::default();
        for (key, bytes) in recordings(&path) {
            held.blocks += blocks(bytes);
            held.finished.insert(key, bytes);
        }
        let folder = Self { path, bounds, held: Mutex::new(held) };
        folder.take(0);
        folder
    }

    /// The path of a new log whose name begins with `name`.
    fn free_path(&self, name: &str) -> PathBuf {
        // A cast may be older than its log by one write, and therefore stay longer.
        let is_taken = |path: &Path| path.exists() || path.with_extension(CAST).exists();
        let mut path = self.path.join(format!("{name}.{LOG}"));
        for number in 1_u64.. {
            if !is_taken(&path) {
                break;
            }
            path = self.path.join(format!("{name}-{number}.{LOG}"));
        }
        path
    }

    /// Removes recordings that are too old or exceed the limit, then reserves `more` blocks. Returns whether
    /// there is space for them.
    fn take(&self, more: u64) -> bool {
        let now = SystemTime::now();
        let most = self.bounds.bytes / BLOCK;
        locked(&self.held, |held| {
            while let Some(oldest) = held.finished.first_entry() {
                let age = now.duration_since(oldest.key().0).unwrap_or_default();
                if held.blocks + more <= most && age <= self.bounds.age {
                    break;
                }
                let ((_, path), bytes) = oldest.remove_entry();
                held.blocks -= blocks(bytes);
                remove(&path);
            }
            let has_room = held.blocks + more <= most;
            if has_room {
                held.blocks += more;
            }
            has_room
        })
    }
}

/// The number of blocks that a file takes.
fn blocks(bytes: u64) -> u64 {
    bytes.div_ceil(BLOCK).max(1)
}

/// The recordings in a folder, with their times and sizes in bytes; none if the folder cannot be read or does
/// not exist yet.
fn recordings(folder: &Path) -> impl Iterator<Item = ((SystemTime, PathBuf), u64)> {
    fs::read_dir(folder).into_iter().flatten().flatten().filter_map(|entry| {
        let data = entry.metadata().ok()?;
        let is_recording = data.is_file() && is_name(&entry.file_name());
        is_recording.then_some(((data.modified().ok()?, entry.path()), data.len()))
    })
}

/// Returns true for the name of a recording or a cast, such as `room-7.log` or `private-7-2.cast`.
fn is_name(name: &OsStr) -> bool {
    let has_kind = |kind: &str| [LOG, CAST].iter().any(|ending| is_name_of(name, kind, ending));
    has_kind(PUBLIC) || has_kind(PRIVATE)
}

fn is_public_log(path: &Path) -> bool {
    path.file_name().is_some_and(|name| is_name_of(name, PUBLIC, LOG))
}

/// Returns true for a name with this beginning and this ending.
fn is_name_of(name: &OsStr, kind: &str, ending: &str) -> bool {
    let parts = name.to_str().and_then(|name| name.strip_prefix(kind)?.split_once('.'));
    let numbers = parts.filter(|parts| parts.1 == ending).map(|parts| parts.0);
    numbers.is_some_and(|text| text.split('-').all(|number| number.parse::<u32>().is_ok()))
}

fn remove(path: &Path) {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => {
            tracing::error!(%error, "an old recording of a room cannot be removed");
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use std::num::NonZero;
    use std::{env, process};

    use super::*;
    use crate::line::Line;
    use serde_json::{Value, json};

    use crate::rooms::room::{CHAT_COLUMNS, Command, MemberId, Room, parse_log};
    use crate::rooms::sequencer::RoundLog;
    use crate::simulation::{HALL, catalog};
    use cellcaster::game::{Intent, PlayerColor};
    use cellcaster::world::Difficulty;

    const DAY: Duration = Duration::from_hours(24);

    /// A folder that does not exist yet and is removed at the end.
    struct TemporaryFolder(PathBuf);

    impl TemporaryFolder {
        fn new(name: &str) -> Self {
            let path =
                env::temp_dir().join(format!("cellcaster-recordings-{}-{name}", process::id()));
            _ = fs::remove_dir_all(&path);
            Self(path)
        }

        fn open(&self, bytes: u64) -> Arc<RecordingFolder> {
            let bounds = RecordingBounds { bytes, file: 3 * BLOCK, ..RecordingBounds::default() };
            Arc::new(RecordingFolder::open(self.0.clone(), bounds))
        }

        /// Adds recordings of an earlier server run, with their ages in days.
        fn with_old(self, old: &[(&str, u64)]) -> Self {
            fs::create_dir_all(&self.0).unwrap();
            for (name, days) in old {
                let file = File::create(self.0.join(name)).unwrap();
                file.set_len(BLOCK).unwrap();
                file.set_modified(SystemTime::now() - DAY * *days as u32).unwrap();
            }
            self
        }

        fn names(&self) -> Vec<String> {
            let entries = fs::read_dir(&self.0).unwrap();
            let mut names: Vec<String> =
                entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
            names.sort_unstable();
            names
        }

        fn bytes(&self) -> u64 {
            recordings(&self.0).map(|(_, bytes)| blocks(bytes) * BLOCK).sum()
        }
    }

    impl Drop for TemporaryFolder {
        fn drop(&mut self) {
            _ = fs::remove_dir_all(&self.0);
        }
    }

    fn header() -> Header {
        Header::new("hall", Mode::Tag, Difficulty::Normal, 7)
    }

    /// The log of a room in its first round.
    fn begun(folder: &Arc<RecordingFolder>, room: u32) -> RecordedRoom {
        let mut log = RecordedRoom::new(folder.clone(), RoomId(room), false);
        log.begin(&header()).unwrap();
        log
    }

    fn say(log: &mut RecordedRoom, lines: u64) -> io::Result<()> {
        let text = Line::of("They said the tower had no door.", CHAT_COLUMNS).unwrap();
        (0..lines).try_for_each(|step| {
            let said = Entry { step, member: MemberId(1), command: Command::Say(text.clone()) };
            log.append(&said)
        })
    }

    #[test]
    fn the_oldest_finished_recordings_are_removed_first() {
        let place = TemporaryFolder::new("oldest").with_old(&[
            ("room-1.log", 2),
            ("room-2.log", 3),
            ("notes.txt", 90),
        ]);
        let folder = place.open(4 * BLOCK);
        let (_one, two) = (begun(&folder, 11), begun(&folder, 12));
        assert_eq!(
            place.names(),
            ["notes.txt", "room-1.log", "room-11.log", "room-12.log", "room-2.log"]
        );
        let _three = begun(&folder, 13);
        assert_eq!(
            place.names(),
            ["notes.txt", "room-1.log", "room-11.log", "room-12.log", "room-13.log"]
        );
        drop(two);
        let (_four, _five) = (begun(&folder, 14), begun(&folder, 15));
        assert_eq!(
            place.names(),
            ["notes.txt", "room-11.log", "room-13.log", "room-14.log", "room-15.log"]
        );
    }

    #[test]
    fn recordings_older_than_thirty_days_are_removed() {
        let place = TemporaryFolder::new("age").with_old(&[("room-1.log", 29), ("room-2.log", 31)]);
        let _folder = place.open(1 << 20);
        assert_eq!(place.names(), ["room-1.log"]);
    }

    /// The folder stays within its limit, no matter how many rooms write how much, and every recording can be parsed.
    #[test]
    fn a_folder_never_exceeds_its_size_limit() {
        let place = TemporaryFolder::new("bytes");
        let folder = place.open(8 * BLOCK);
        let mut logs = [1, 2, 3].map(|room| begun(&folder, room));
        for round in 0..20 {
            for log in &mut logs {
                _ = say(log, 10 + 7 * round);
                log.flush().unwrap();
                assert!(place.bytes() <= 8 * BLOCK, "{} bytes", place.bytes());
            }
            for log in &mut logs {
                _ = log.begin(&header());
            }
        }
        drop(logs);
        assert!(place.bytes() > 4 * BLOCK, "{} bytes", place.bytes());
        for (_, path) in recordings(&place.0).map(|(key, _)| key) {
            let text = fs::read_to_string(path).unwrap();
            assert!(parse_log(&text).is_some(), "{text}");
        }
    }

    #[test]
    fn a_recording_that_fills_the_folder_is_replaced_next_round() {
        let place = TemporaryFolder::new("full");
        let folder = place.open(2 * BLOCK);
        let mut log = begun(&folder, 1);
        assert_eq!(say(&mut log, 1000).unwrap_err().kind(), io::ErrorKind::QuotaExceeded);
        say(&mut log, 1).unwrap();
        assert_eq!(place.names(), ["room-1.log"]);
        log.begin(&header()).unwrap();
        say(&mut log, 20).unwrap();
        log.flush().unwrap();
        assert_eq!(place.names(), ["room-1.log"]);
        let text = fs::read_to_string(place.0.join("room-1.log")).unwrap();
        assert_eq!(parse_log(&text).unwrap()[0].1.len(), 20);
        assert!(place.bytes() <= 2 * BLOCK);
    }

    #[test]
    fn a_round_after_a_long_recording_begins_another_file() {
        let place = TemporaryFolder::new("next");
        let folder = place.open(1 << 20);
        let mut log = begun(&folder, 7);
        log.begin(&header()).unwrap();
        assert_eq!(place.names(), ["room-7.log"]);
        say(&mut log, 400).unwrap();
        log.begin(&header()).unwrap();
        assert_eq!(place.names(), ["room-7-1.log", "room-7.log"]);
    }

    /// Plays in the hall for some steps: one member walks while another speaks.
    fn play(recording: RecordedRoom, steps: u64) {
        let (mara, jon) = (MemberId(1), MemberId(2));
        let line = |text| Line::of(text, CHAT_COLUMNS).unwrap();
        let join = |name, color| Command::Join { color, name: line(name) };
        let mut room = Room::new(&Arc::new(catalog(HALL)), header()).unwrap();
        let mut log = RoundLog::new(Some(Box::new(recording)), &room);
        for step in 0..steps {
            log.step(&mut room, |pass| match step {
                0 => {
                    pass(mara, join("Mara", PlayerColor::Red));
                    pass(jon, join("Jon", PlayerColor::Blue));
                }
                10 => pass(jon, Command::Say(line("behind you"))),
                20 => {
                    let intents = [Intent::Forward].into_iter().collect();
                    pass(mara, Command::Intents { seen: 1, intents });
                }
                _ => {}
            });
        }
    }

    #[test]
    fn a_cast_beside_the_log_shows_the_room_from_above() {
        let place = TemporaryFolder::new("cast");
        play(RecordedRoom::new(place.open(1 << 20), RoomId(7), false), 300);
        assert_eq!(place.names(), ["room-7.cast", "room-7.log"]);
        let cast = fs::read_to_string(place.0.join("room-7.cast")).unwrap();
        let mut lines = cast.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let header = lines.next().unwrap();
        assert_eq!((&header["version"], &header["width"]), (&json!(2), &json!(80)));
        let [rows, columns] = [24, 80].map(|length| NonZero::new(length).unwrap());
        let mut terminal = vt100::Parser::new(rows, columns, 0);
        let mut last = 0.0;
        for event in lines {
            let time = event[0].as_f64().unwrap();
            assert!(time >= last && event[1] == "o", "{event}");
            last = time;
            terminal.process(event[2].as_str().unwrap().as_bytes());
        }
        assert!((4.0..5.0).contains(&last), "{last}");
        insta::assert_snapshot!(terminal.screen().contents());
    }

    #[test]
    fn casts_count_for_the_limit_of_the_folder() {
        let place = TemporaryFolder::new("casts");
        let folder = place.open(6 * BLOCK);
        for room in 1..=4 {
            play(RecordedRoom::new(folder.clone(), RoomId(room), false), 2000);
            assert!(place.bytes() <= 6 * BLOCK, "{} bytes", place.bytes());
        }
        assert!(place.names().contains(&"room-4.log".to_owned()), "{:?}", place.names());
    }
}
