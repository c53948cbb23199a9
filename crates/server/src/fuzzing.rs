//! Parts of the server without connections and tasks, for fuzz targets outside of the crate. The module is
//! compiled only with the feature `fuzzing`.

use std::fmt::Write as _;
use std::net::{IpAddr, Ipv4Addr};
use std::pin::pin;
use std::sync::{Arc, LazyLock};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

use tokio::sync::watch;

use crate::accounts::{AccountKey, AccountSettings, Day};
use crate::admin::RoomRow;
pub use crate::cluster::fuzzing::SharedRoom;
use crate::config::Config;
use crate::line::Line;
use crate::operator::{Operator, socket};
use crate::rooms::replayed::replayed;
use crate::rooms::room::{
    CHAT_COLUMNS, Catalog, Command, Entry, Header, MemberId, Mode, NAME_COLUMNS, Room,
};
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::session::{
    IdleLimits, Profile, RoomEntry, Session, SessionContext, SessionEvent, SessionRequest,
};
pub use crate::ssh::fuzzing::serve;
use crate::visitors::{Presence, Visitors};
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;
use cellcaster::game::{Intent, Intents, PlayerColor};
use cellcaster::map::builtin::LEVELS;
use cellcaster::rng::SplitMix64;
use cellcaster::terminal::{SessionOptions, WindowSize};
use cellcaster::world::Difficulty;

/// Read once, because that takes longer than most inputs.
static CATALOG: LazyLock<Arc<Catalog>> = LazyLock::new(|| Arc::new(Catalog::builtin()));

const ROOM: RoomId = RoomId(1);
/// The duration of a step, in microseconds.
const STEP: u64 = 1_000_000 / 60;

/// The number of checkpoints that a fuzz target can change.
pub const CHECKPOINTS: usize = 24;
/// The most steps that a room takes before its checkpoint.
const MAX_STEPS: usize = 900;

/// A room and its visitors.
pub struct FuzzedRoom {
    catalog: Arc<Catalog>,
    room: Room,
    /// The recording of the current round.
    recording: String,
    visitors: Vec<FuzzedVisitor>,
    now: Duration,
}

struct FuzzedVisitor {
    session: Session,
    member: Option<MemberId>,
    /// `true` while the visitor is in the room, as a member or a watcher.
    is_inside: bool,
    name: Line,
}

impl FuzzedRoom {
    /// A room of a built-in level, chosen by `seed`.
    pub fn new(seed: u64) -> Self {
        let catalog = Arc::clone(&CATALOG);
        let mut rng = SplitMix64::new(seed);
        let mode = Mode::ALL[rng.below(Mode::ALL.len())];
        let suited: Vec<&String> =
            catalog.names.iter().filter(|name| catalog.suits(name, mode)).collect();
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
        let recording = header.to_string();
        let room = Room::new(&catalog, header).expect("the catalog has the level");
        Self { catalog, room, recording, visitors: Vec::new(), now: Duration::ZERO }
    }

    /// Adds a visitor whose terminal has these options.
    pub fn arrive(&mut self, name: &str, options: SessionOptions, size: WindowSize) {
        let name = Line::of(name, NAME_COLUMNS).expect("a name");
        let identity = Profile {
            has_account: size.columns.is_multiple_of(2),
            name: name.clone(),
            is_named: size.rows.is_multiple_of(2),
            preferences: Preferences::default(),
            ignored: Vec::new(),
            configuration: Configuration::default(),
        };
        let host = SessionContext {
            name: name.clone(),
            message: Line::of("Be kind.", CHAT_COLUMNS),
            notice: None,
            compresses: false,
            ascii_locale: None,
            catalog: Arc::clone(&self.catalog),
            today: Day::default(),
            frame_time: Duration::from_millis(33),
            idle: IdleLimits::of(&Config::default()),
            has_recordings: true,
        };
        let session = Session::new(identity, options, size, host, self.now);
        self.visitors.push(FuzzedVisitor { session, member: None, is_inside: false, name });
    }

    /// Handles bytes from a visitor's terminal.
    pub fn receive(&mut self, visitor: usize, bytes: &[u8]) {
        self.visitors[visitor].session.receive(bytes, self.now);
        self.answer(visitor);
    }

    /// Like [`receive`](Self::receive), but the session's requests wait until the next output.
    pub fn press(&mut self, visitor: usize, bytes: &[u8]) {
        self.visitors[visitor].session.receive(bytes, self.now);
    }

    /// Changes the size of a visitor's window.
    pub fn resize(&mut self, visitor: usize, size: WindowSize) {
        self.visitors[visitor].session.resize(size, self.now);
        self.answer(visitor);
    }

    /// Sends a visitor an event from the host. `seconds` chooses the event.
    pub fn notify(&mut self, visitor: usize, seconds: u64) {
        let line = Line::of("The host speaks.", CHAT_COLUMNS).expect("it fits");
        let event = match seconds % 7 {
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
            4 => SessionEvent::Heard {
                from: line.clone(),
                text: line,
                is_private: seconds.is_multiple_of(2),
            },
            5 => SessionEvent::Players { names: [line].into(), moderates: true },
            _ => SessionEvent::Refused("The room is full.".to_owned()),
        };
        self.visitors[visitor].session.notify(event, self.now);
        self.answer(visitor);
    }

    /// Advances the room by `steps`, and wakes the sessions when they are due.
    pub fn pass(&mut self, steps: u64) {
        for _ in 0..steps {
            self.now += Duration::from_micros(STEP);
            self.step();
            for visitor in 0..self.visitors.len() {
                let session = &mut self.visitors[visitor].session;
                let room = self.room.view();
                let due_at = session.due_at(Some(&room), self.now);
                if session.wakes_at(due_at).is_some_and(|at| at <= self.now) {
                    session.wake(self.now);
                    self.answer(visitor);
                }
            }
        }
    }

    /// The bytes for a visitor's terminal, with a frame if one is due. They count as written at once.
    pub fn output(&mut self, visitor: usize) -> Vec<u8> {
        let FuzzedVisitor { session, is_inside, .. } = &mut self.visitors[visitor];
        let view = self.room.view();
        let view = is_inside.then_some(&view);
        let due_at = session.due_at(view, self.now);
        if session.output(self.now).is_empty() && due_at.is_some_and(|due| due <= self.now) {
            session.draw(view, self.now);
        }
        let output = std::mem::take(session.output(self.now));
        session.written(0, 0, self.now);
        self.answer(visitor);
        output
    }

    /// Returns true if a visitor's session has ended.
    pub fn is_over(&self, visitor: usize) -> bool {
        self.visitors[visitor].session.is_over()
    }

    /// The log of the round, and the checksum of the room.
    pub fn recording(&self) -> (String, u64) {
        (self.recording.clone(), self.room.checksum())
    }

    /// Plays the last round of a recording, and returns the checksum of the room.
    ///
    /// # Errors
    /// The reason why it cannot be played.
    pub fn replayed(text: &str) -> Result<Option<u64>, String> {
        let rounds = replayed(text, &CATALOG, &mut |_| Ok(()))?;
        Ok(rounds.last().map(|round| round.checksum))
    }

    /// The number of steps of the round.
    pub fn steps(&self) -> u64 {
        self.room.step()
    }

    fn step(&mut self) {
        if self.room.is_over() {
            self.room.begin_next();
            self.recording = self.room.header().to_string();
        }
        self.room.advance();
    }

    /// Answers the requests of a session.
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

    fn grant(&mut self, visitor: usize, ask: SessionRequest) -> Option<SessionEvent> {
        match ask {
            SessionRequest::Name(text) => {
                let line = Line::of(&text, NAME_COLUMNS).ok_or("Take another one.".to_owned());
                if let Ok(line) = &line {
                    self.visitors[visitor].name = line.clone();
                }
                Some(SessionEvent::Named(line))
            }
            SessionRequest::Rooms => {
                let rooms = [RoomSummary::of(ROOM, &self.room)].into();
                Some(SessionEvent::Rooms { rooms, today: Day::default() })
            }
            SessionRequest::Go(RoomEntry::Watch(_)) => {
                self.leave(visitor);
                self.visitors[visitor].is_inside = true;
                Some(SessionEvent::Entered { room: ROOM, member: None, code: None })
            }
            SessionRequest::Code(_) => {
                Some(SessionEvent::Refused("No room has this code.".to_owned()))
            }
            SessionRequest::Go(_) if self.room.is_full() => {
                Some(SessionEvent::Refused("The room is full.".to_owned()))
            }
            SessionRequest::Go(_) => {
                self.leave(visitor);
                let member = self.room.next_member();
                let name = self.visitors[visitor].name.clone();
                let color = PlayerColor::ALL[member.0 as usize % PlayerColor::ALL.len()];
                self.apply(member, Command::Join { color, name });
                let FuzzedVisitor { member: own, is_inside, .. } = &mut self.visitors[visitor];
                (*own, *is_inside) = (Some(member), true);
                Some(SessionEvent::Entered { room: ROOM, member: Some(member), code: None })
            }
            SessionRequest::Command(command) => {
                if let Some(member) = self.visitors[visitor].member {
                    self.apply(member, command);
                }
                None
            }
            SessionRequest::Leave => {
                self.leave(visitor);
                None
            }
            SessionRequest::Say(text) => {
                let from = self.visitors[visitor].name.clone();
                Some(SessionEvent::Heard { from, text, is_private: false })
            }
            SessionRequest::Tell { to, text } => Some(SessionEvent::Told { to, text }),
            SessionRequest::Players => {
                let names = self.visitors.iter().map(|visitor| visitor.name.clone()).collect();
                Some(SessionEvent::Players { names, moderates: true })
            }
            SessionRequest::Report { .. } | SessionRequest::Moderate { .. } => {
                Some(SessionEvent::Advice("It is done.".to_owned()))
            }
            SessionRequest::Board { level, difficulty } => {
                Some(SessionEvent::Board { level, difficulty, rows: [].into() })
            }
            SessionRequest::Ghosts { level, difficulty } => {
                Some(SessionEvent::Ghosts { level, difficulty, ghosts: [].into() })
            }
            SessionRequest::Recordings => Some(SessionEvent::Recordings([].into())),
            SessionRequest::Record(_) => {
                Some(SessionEvent::Record(Err("The recording is gone.".to_owned())))
            }
            SessionRequest::EndRecord => None,
            SessionRequest::Save(settings) => {
                assert!(settings.configuration.len() <= AccountSettings::MAX_BYTES);
                assert!(settings.ignored.len() <= AccountSettings::MAX_IGNORED);
                let read = Configuration::parse(&settings.configuration, "settings");
                assert!(read.is_ok(), "{}", settings.configuration);
                None
            }
        }
    }

    fn leave(&mut self, visitor: usize) {
        let FuzzedVisitor { member, is_inside, .. } = &mut self.visitors[visitor];
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
        // Writing to a string cannot fail.
        _ = writeln!(self.recording, "{entry}");
    }
}

/// A host with three visitors, and its operator.
pub struct FuzzedHost {
    operator: Operator,
    _visitors: Vec<Presence>,
}

impl Default for FuzzedHost {
    fn default() -> Self {
        let all = Visitors::default();
        let visitors = (0..3).zip(["Ada", "Bo", "字"]).map(|(number, name)| {
            let address = IpAddr::from(Ipv4Addr::new(10, 0, 0, number));
            let visitor = all.arrive(address, Some(AccountKey::new([number; 32])));
            visitor.set_name(name);
            visitor
        });
        let visitors = visitors.collect();
        let operator = Operator::new(all, Vec::<RoomRow>::new, watch::Sender::default(), None);
        Self { operator, _visitors: visitors }
    }
}

impl FuzzedHost {
    /// The answer on a connection that delivers `bytes` and then ends.
    ///
    /// # Panics
    /// If the answer fails or waits.
    pub fn answer(&self, bytes: &[u8]) -> Vec<u8> {
        let mut stream = tokio::io::join(bytes, Vec::new());
        let answered = {
            let answer = pin!(socket::answer(&mut stream, &self.operator));
            answer.poll(&mut Context::from_waker(Waker::noop()))
        };
        assert!(matches!(answered, Poll::Ready(Ok(()))), "{answered:?}");
        stream.into_inner().1
    }
}

static MADE: LazyLock<Vec<Vec<u8>>> = LazyLock::new(|| (0..CHECKPOINTS).map(made).collect());

/// The checkpoint of a room after some steps. `number` is below [`CHECKPOINTS`].
pub fn checkpoint(number: usize) -> &'static [u8] {
    &MADE[number]
}

/// Restores a room from `bytes`, and plays it for `steps` steps.
///
/// # Errors
/// A sentence, if `bytes` are not a checkpoint.
///
/// # Panics
/// If restoring the room's own checkpoint changes it.
pub fn resume(bytes: &[u8], seed: u64, steps: usize) -> Result<(), String> {
    let mut room = Room::restore(&CATALOG, bytes)?;
    let bytes = room.checkpoint();
    let again = Room::restore(&CATALOG, &bytes).map(|room| room.checkpoint());
    assert_eq!(again.as_ref(), Ok(&bytes), "a checkpoint of a restored room");
    play(&mut room, &mut SplitMix64::new(seed), steps);
    _ = (room.view().winner(), room.checksum());
    Ok(())
}

fn made(number: usize) -> Vec<u8> {
    let mode = Mode::ALL[number % Mode::ALL.len()];
    let level = LEVELS[number % LEVELS.len()].name;
    let seed = number as u64;
    let header = Header::new(level, mode, Difficulty::ALL[number % 3], seed);
    let mut room = Room::new(&CATALOG, header).expect("the level is built in");
    let mut random = SplitMix64::new(seed);
    let steps = random.below(MAX_STEPS);
    play(&mut room, &mut random, steps);
    room.checkpoint()
}

/// Lets members join, act at random and leave.
fn play(room: &mut Room, random: &mut SplitMix64, steps: usize) {
    let mut wanted = Intents::new();
    for _ in 0..steps {
        let (step, next) = (room.step(), room.next_member());
        let mut commands = Vec::new();
        if room.len() < 3 && random.one_in(60) || room.len() == 0 {
            let name = Line::of("Ada", NAME_COLUMNS).expect("it fits");
            commands.push((next, Command::Join { color: PlayerColor::ALL[random.below(8)], name }));
        }
        if let Some((member, ..)) = room.first_member() {
            if random.one_in(20) {
                wanted = [Intent::Forward, Intent::Run].into_iter().collect();
                (0..random.below(4)).for_each(|_| {
                    wanted.insert(Intent::ALL[random.below(Intent::ALL.len())]);
                });
            }
            commands
                .push((member, Command::Intents { seen: room.game().steps(), intents: wanted }));
            if random.one_in(100) {
                let token = random.bits();
                let all = [Command::Leave, Command::Keep, Command::Away, Command::Return { token }];
                commands.extend(all.into_iter().nth(random.below(4)).map(|it| (member, it)));
            }
        }
        for (member, command) in commands {
            room.apply(&Entry { step, member, command });
        }
        room.advance();
        if room.is_over() {
            room.begin_next();
        }
    }
}
