//! Parts of the server without connections and tasks, for fuzz targets outside of the crate. It is compiled with
//! `--cfg fuzzing` only.

mod desk;
mod resumed;

use std::sync::{Arc, LazyLock};
use std::time::Duration;

pub use self::desk::Desk;
pub use self::resumed::{CHECKPOINTS, checkpoint, resume};
use crate::accounts::AccountSettings;
pub use crate::cluster::fuzzing::SharedRoom;
use crate::rooms::room::{
    CHAT_COLUMNS, Catalog, Command, Entry, Header, Log, MemberId, Mode, NAME_COLUMNS, Queue,
    Recorded, Room, replayed,
};
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::line::Line;
use crate::sessions::session::{
    HostFacts, Identity, IdleLimits, Request, Session, SessionEvent, Way,
};
pub use crate::ssh::fuzzing::serve;
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;
use cellcaster::game::PlayerColor;
use cellcaster::map::builtin::LEVELS;
use cellcaster::rng::SplitMix64;
use cellcaster::terminal::{Options, WindowSize};
use cellcaster::world::Difficulty;

/// Read once: it takes longer than most inputs.
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::builtin()));

const ROOM: RoomId = RoomId(1);
/// The duration of a step, in microseconds.
const STEP: u64 = 1_000_000 / 60;

/// A room and its visitors.
pub struct Hall {
    catalog: Arc<Catalog>,
    room: Room,
    log: Recorded<Queue, Vec<u8>>,
    visitors: Vec<Visitor>,
    now: Duration,
}

struct Visitor {
    session: Session,
    member: Option<MemberId>,
    /// Whether they are in the room, as a member or to watch.
    is_inside: bool,
    name: Line,
}

impl Hall {
    /// A room of a built-in level, chosen by `seed`.
    pub fn new(seed: u64) -> Self {
        let catalog = Arc::clone(&CATALOG);
        let mut rng = SplitMix64::new(seed);
        let mode = Mode::ALL[rng.below(Mode::ALL.len())];
        let suited: Vec<&String> =
            catalog.names().iter().filter(|name| catalog.suits(name, mode)).collect();
        let level = suited[rng.below(suited.len())];
        let difficulty = [Difficulty::Easy, Difficulty::Normal, Difficulty::Hard][rng.below(3)];
        Self::of(Header::new(level, mode, difficulty, rng.bits()))
    }

    /// A room of the first level.
    pub fn small(seed: u64) -> Self {
        let mode = Mode::ALL[seed as usize % Mode::ALL.len()];
        Self::of(Header::new(LEVELS[0].name, mode, Difficulty::Normal, seed))
    }

    fn of(header: Header) -> Self {
        let catalog = Arc::clone(&CATALOG);
        let mut log = Recorded::new(Queue::default(), Vec::new());
        log.begin(&header).expect("it is in memory");
        let room = Room::new(&catalog, header).expect("the catalog has the level");
        Self { catalog, room, log, visitors: Vec::new(), now: Duration::ZERO }
    }

    /// A visitor comes, with a terminal of which `options` are known.
    pub fn arrive(&mut self, name: &str, options: Options, size: WindowSize) {
        let name = Line::of(name, NAME_COLUMNS).expect("a name");
        let identity = Identity {
            has_account: size.columns % 2 == 0,
            name: name.clone(),
            is_named: size.rows % 2 == 0,
            preferences: Preferences::default(),
            configuration: Configuration::default(),
        };
        let host = HostFacts {
            name: name.clone(),
            message: Line::of("Be kind.", CHAT_COLUMNS),
            notice: None,
            compresses: false,
            ascii_locale: None,
            catalog: Arc::clone(&self.catalog),
            idle: IdleLimits::default(),
            frame_time: Duration::from_millis(33),
        };
        let session = Session::new(identity, options, size, host, self.now);
        self.visitors.push(Visitor { session, member: None, is_inside: false, name });
    }

    /// A visitor's terminal sends `bytes`.
    pub fn receive(&mut self, visitor: usize, bytes: &[u8]) {
        self.visitors[visitor].session.receive(bytes, self.now);
        self.answer(visitor);
    }

    /// As [`receive`](Self::receive), but what the session asks for waits for the next output.
    pub fn press(&mut self, visitor: usize, bytes: &[u8]) {
        self.visitors[visitor].session.receive(bytes, self.now);
    }

    /// A visitor's window changes its size.
    pub fn resize(&mut self, visitor: usize, size: WindowSize) {
        self.visitors[visitor].session.resize(size, self.now);
        self.answer(visitor);
    }

    /// The host tells a visitor something.
    pub fn notify(&mut self, visitor: usize, seconds: u64) {
        let line = Line::of("The host speaks.", CHAT_COLUMNS).expect("it fits");
        let event = match seconds % 5 {
            0 => SessionEvent::Draining {
                ends_at: self.now.saturating_add(Duration::from_secs(seconds)),
                can_return: seconds.is_multiple_of(10),
            },
            1 => SessionEvent::Said(line),
            2 => SessionEvent::Result("It was refused.".to_owned()),
            3 => {
                self.leave(visitor);
                SessionEvent::Left("The room is closed.".to_owned())
            }
            _ => SessionEvent::Refused("The room is full.".to_owned()),
        };
        self.visitors[visitor].session.notify(event, self.now);
        self.answer(visitor);
    }

    /// Lets that many steps pass, in which the sessions are woken.
    pub fn pass(&mut self, steps: u64) {
        for _ in 0..steps {
            self.now += Duration::from_micros(STEP);
            self.step();
            for visitor in 0..self.visitors.len() {
                let session = &mut self.visitors[visitor].session;
                let room = self.room.view();
                if session.wakes_at(Some(&room), self.now).is_some_and(|at| at <= self.now) {
                    session.wake(self.now);
                    self.answer(visitor);
                }
            }
        }
    }

    /// The bytes for a visitor's terminal, with a frame if one is due. They leave at once.
    pub fn output(&mut self, visitor: usize) -> Vec<u8> {
        let Visitor { session, is_inside, .. } = &mut self.visitors[visitor];
        let view = self.room.view();
        let view = is_inside.then_some(&view);
        if session.output(self.now).is_empty() && session.is_due(view, self.now) {
            session.draw(view, self.now);
        }
        let output = std::mem::take(session.output(self.now));
        session.written(self.now);
        self.answer(visitor);
        output
    }

    /// Whether a visitor's session has ended.
    pub fn is_over(&self, visitor: usize) -> bool {
        self.visitors[visitor].session.is_over()
    }

    /// The round as its log has it, and the checksum of the room.
    pub fn recording(&self) -> (String, u64) {
        let text = String::from_utf8_lossy(self.log.output()).into_owned();
        (text, self.room.checksum())
    }

    /// Plays the last round of a recording, and returns the checksum of the room.
    ///
    /// # Errors
    /// Why it cannot be played.
    pub fn replayed(text: &str) -> Result<Option<u64>, String> {
        let rounds = replayed(text, &CATALOG)?;
        Ok(rounds.last().map(|round| round.checksum))
    }

    /// The number of steps of the round.
    pub fn steps(&self) -> u64 {
        self.room.step()
    }

    fn step(&mut self) {
        if self.room.is_over() {
            self.room.begin_next();
            self.log = Recorded::new(Queue::default(), Vec::new());
            self.log.begin(self.room.header()).expect("it is in memory");
        }
        self.room.advance();
    }

    /// Does what a session asks for.
    fn answer(&mut self, visitor: usize) {
        for _ in 0..8 {
            let requests = self.visitors[visitor].session.requests();
            if requests.is_empty() {
                return;
            }
            for ask in requests {
                if let Some(event) = self.grant(visitor, ask) {
                    self.visitors[visitor].session.notify(event, self.now);
                }
            }
        }
    }

    fn grant(&mut self, visitor: usize, ask: Request) -> Option<SessionEvent> {
        match ask {
            Request::Name(text) => {
                let line = Line::of(&text, NAME_COLUMNS).ok_or("Take another one.".to_owned());
                if let Ok(line) = &line {
                    self.visitors[visitor].name = line.clone();
                }
                Some(SessionEvent::Named(line))
            }
            Request::Rooms => Some(SessionEvent::Rooms([self.summary()].into())),
            Request::Go(Way::Watch(_)) => {
                self.leave(visitor);
                self.visitors[visitor].is_inside = true;
                Some(SessionEvent::Entered { room: ROOM, member: None })
            }
            Request::Go(_) if self.room.is_full() => {
                Some(SessionEvent::Refused("The room is full.".to_owned()))
            }
            Request::Go(_) => {
                self.leave(visitor);
                let member = self.room.next_member();
                let name = self.visitors[visitor].name.clone();
                let color = PlayerColor::ALL[member.0 as usize % PlayerColor::ALL.len()];
                self.apply(member, Command::Join { color, name });
                let Visitor { member: own, is_inside, .. } = &mut self.visitors[visitor];
                (*own, *is_inside) = (Some(member), true);
                Some(SessionEvent::Entered { room: ROOM, member: Some(member) })
            }
            Request::Command(command) => {
                if let Some(member) = self.visitors[visitor].member {
                    self.apply(member, command);
                }
                None
            }
            Request::Leave => {
                self.leave(visitor);
                None
            }
            Request::Board { level, difficulty } => {
                Some(SessionEvent::Board { level, difficulty, rows: [].into() })
            }
            Request::Ghosts { level, difficulty } => {
                Some(SessionEvent::Ghosts { level, difficulty, ghosts: [].into() })
            }
            Request::Save(settings) => {
                assert!(settings.configuration.len() <= AccountSettings::MOST_BYTES);
                let read = Configuration::parse(&settings.configuration, "settings");
                assert!(read.is_ok(), "{}", settings.configuration);
                None
            }
        }
    }

    fn leave(&mut self, visitor: usize) {
        let Visitor { member, is_inside, .. } = &mut self.visitors[visitor];
        *is_inside = false;
        if let Some(member) = member.take() {
            self.apply(member, Command::Leave);
        }
    }

    /// Adds an entry to the log and applies it.
    fn apply(&mut self, member: MemberId, command: Command) {
        let entry = Entry { step: self.room.step(), member, command };
        assert_eq!(Entry::parse(&entry.to_string()).as_ref(), Some(&entry), "as it is written");
        self.room.apply(&entry);
        self.log.append(entry).expect("it is in memory");
    }

    fn summary(&self) -> RoomSummary {
        let header = self.room.header();
        RoomSummary {
            id: ROOM,
            level: header.level.clone(),
            mode: header.mode,
            difficulty: header.difficulty,
            phase: self.room.phase(),
            members: self.room.names().cloned().collect(),
            watchers: 0,
        }
    }
}
