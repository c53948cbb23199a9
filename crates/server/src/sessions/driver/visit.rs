//! A visitor's driver: moves bytes between the link and the session, carries out the session's requests, and
//! holds the visitor's place in a room.
//!
//! - A visitor leaves the room when they ask to or when their connection ends.
//! - In a cluster, a visitor becomes away when their host shuts down. A visitor with an account who connects
//!   to any host within a minute gets their place back. If they go elsewhere while the host is looking for
//!   that place, they have left the room.

use std::fs;
use std::net::IpAddr;
use std::num::NonZero;
use std::sync::Arc;
use std::time::Duration;

use futures_util::future::OptionFuture;
use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::sync::{OwnedSemaphorePermit, mpsc, watch};
use tokio::task::{block_in_place, spawn_blocking};
use tokio::time::sleep_until;

use super::login::{self, AccountData};
use super::talk::{REPORT_BURST, REPORT_RATE, TALK_BURST, TALK_RATE};
use super::{Shared, results};
use crate::accounts::{
    Account, AccountKey, AccountSettings, Day, HostStore, Name, Origin, UnixTime,
};
use crate::admission::counted_address;
use crate::bucket::Bucket;
use crate::cluster::Entrant;
use crate::line::Line;
#[cfg(test)]
use crate::load::Work;
use crate::lock::locked;
use crate::logging;
use crate::rooms::directory::{Place, PublicRecording, RoomRefusal, Rooms};
use crate::rooms::invitation::{Guesser, RoomCode};
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{CHAT_COLUMNS, Command, Header, NAME_COLUMNS, RoomView};
use crate::rooms::sequencer::FinishedRun;
use crate::rooms::summary::{RoomId, RoomSummary};
use crate::sessions::session::{
    IdleLimits, Profile, RecordWish, RecordingRow, RoomEntry, Session, SessionContext,
    SessionEvent, SessionRequest,
};
use crate::ssh::{Arrival, Inbound, Link, Outbox, Visitor};
use crate::visitors::{Heard, Notice, Onlookers, Presence};
use cellcaster::app::Configuration;
use cellcaster::terminal::SessionOptions;
use cellcaster::world::Difficulty;

/// A visitor's driver.
pub(crate) struct Driver {
    pub(crate) shared: Arc<Shared>,
    pub(crate) session: Session,
    pub(crate) key: Option<AccountKey>,
    /// The address from which the visitor connects.
    pub(crate) address: IpAddr,
    account: Option<Account>,
    /// The name that a guest may take without further checks.
    offer: Name,
    /// The name, once it has been chosen.
    pub(crate) name: Option<Name>,
    presence: Presence,
    pub(crate) place: Option<Place>,
    /// The day on which the driver last compared the room's level with the day.
    compared: Option<Day>,
    rooms: watch::Receiver<Arc<[RoomSummary]>>,
    onlookers: watch::Receiver<Arc<Onlookers>>,
    /// Whether the session is told about changes of the rooms and the visitors.
    in_lobby: bool,
    /// Limits the rate of lines.
    pub(crate) talk: Bucket,
    /// Limits the rate of reports.
    pub(crate) reports: Bucket,
    pub(crate) replies: mpsc::Sender<Box<Reply>>,
    replied: mpsc::Receiver<Box<Reply>>,
    /// The time at which the session was last woken.
    woken_at: Duration,
    /// The arrival time of the oldest key that the frame in flight answers.
    answers_key: Option<Duration>,
    /// The time at which the session ends because the server shuts down.
    ends_at: Option<Duration>,
    /// The bytes of the frame in flight, and the bytes on the wire before it; `None` if there is none.
    sent: Option<(usize, u64)>,
    /// Whether the server is shutting down.
    is_draining: bool,
    /// Whether the host is looking for the place that the visitor had before.
    is_returning: bool,
    /// The permit to watch a record.
    record: Option<OwnedSemaphorePermit>,
}

/// An event that a driver waits for.
enum DriverEvent {
    Arrived(Arrival),
    Drained,
    RoomsChanged,
    OnlookersChanged,
    Replied(Box<Reply>),
    Notice(Notice),
    Time,
}

/// The interval at which a session is woken again if waking it had no effect.
const RETRY_INTERVAL: Duration = Duration::from_millis(250);
/// The interval at which a driver wakes while it sends, or while it is in a room but does not wait for
/// snapshots. The visitor may become idle and the room may close even if nothing is read or acknowledged.
const WAKE_INTERVAL: Duration = Duration::from_secs(1);
/// The time after which a driver no longer waits for a step of the room.
const STEP_TIMEOUT: Duration = Duration::from_millis(50);
/// The maximum number of bytes queued behind a frame. They are only queries, so a few hundred are usual.
const MAX_WAITING_BYTES: usize = 64 << 10;
/// The widest message of the day, in columns.
const MESSAGE_COLUMNS: usize = 200;

/// A reply from the store or the cluster.
pub(crate) enum Reply {
    /// A name, with the account that now has it; `None` for a guest.
    Named(Name, Result<Option<Account>, String>),
    SessionEvent(SessionEvent),
    /// A place in one of the cluster's rooms.
    Place(Result<Place, RoomRefusal>),
    /// The place that the visitor had before.
    Returned(Result<Place, RoomRefusal>),
}

/// The maximum number of queued replies. Further ones are dropped, because they answer a flood of requests.
const MAX_REPLIES: usize = 16;

/// Shown while the host is looking for the visitor's place.
const LOOKS: &str = "You were in a room; the host is looking for your place.";
/// Shown when the place has been found.
const WELCOME: &str = "Welcome back: you are where you were.";
const GONE: &str = "Your place in the room is gone.";

impl Driver {
    pub(crate) fn new(
        shared: Arc<Shared>,
        visitor: &Visitor,
        known: AccountData,
        options: SessionOptions,
    ) -> Self {
        let AccountData { key, account, settings, offer, .. } = known;
        let identity = Profile {
            has_account: key.is_some(),
            name: login::line(&offer),
            is_named: account.is_some(),
            preferences: settings.preferences,
            ignored: settings.ignored,
            // Settings that cannot be parsed were written by another version.
            configuration: Configuration::parse(&settings.configuration, "settings")
                .unwrap_or_default(),
        };
        let ascii_locale = login::ascii_locale(visitor);
        let config = shared.config.get();
        let presence = shared.visitors.arrive(visitor.peer.ip(), key);
        if let Some(account) = &account {
            presence.set_name(account.name.as_str());
        }
        let host = SessionContext {
            name: host_name(&config.name),
            message: Line::of(&config.message, MESSAGE_COLUMNS),
            notice: visitor.notice.and_then(|notice| Line::of(notice, MESSAGE_COLUMNS)),
            compresses: visitor.compresses,
            ascii_locale: ascii_locale.and_then(|setting| Line::of(&setting, MESSAGE_COLUMNS)),
            catalog: Arc::clone(shared.rooms.catalog()),
            today: shared.rooms.today(),
            frame_time: shared.load.rate().frame_time,
            idle: IdleLimits::of(&config),
            has_recordings: shared.rooms.recordings().has_folder(),
        };
        let now = shared.now();
        let mut session = Session::new(identity, options, visitor.size, host, now);
        session.set_budget(NonZero::new(config.player_bytes_per_second));
        let (replies, replied) = mpsc::channel(MAX_REPLIES);
        Self {
            session,
            key,
            address: visitor.peer.ip(),
            name: account.as_ref().map(|account| account.name.clone()),
            account,
            offer,
            presence,
            place: None,
            compared: None,
            rooms: shared.rooms.summaries(),
            onlookers: shared.visitors.onlookers(),
            in_lobby: false,
            talk: Bucket::new(TALK_RATE, TALK_BURST, now),
            reports: Bucket::new(REPORT_RATE, REPORT_BURST, now),
            replies,
            replied,
            woken_at: Duration::ZERO,
            answers_key: None,
            ends_at: None,
            sent: None,
            is_draining: false,
            is_returning: false,
            record: None,
            shared,
        }
    }

    /// Drives the session to its end; returns the exit status. If the future is dropped earlier, `run` can be
    /// called again.
    pub(crate) async fn run(&mut self, link: &mut Link) -> u8 {
        let status = self.drive(link).await;
        if self.is_draining {
            self.part();
        } else {
            self.leave();
        }
        status
    }

    async fn drive(&mut self, link: &mut Link) -> u8 {
        let Link { inbound, outbox } = link;
        loop {
            self.run_requests();
            let mut wakes_at = None;
            if self.sent.is_none() {
                let _turn = self.turn().await;
                let bytes = self.frame(&mut wakes_at);
                if bytes.is_empty() && self.session.is_over() {
                    return 0;
                }
                let sent = (bytes.len(), outbox.on_wire());
                let is_sending = !bytes.is_empty() && outbox.try_send(bytes).is_ok();
                self.sent = is_sending.then_some(sent);
                // An empty frame is never in flight.
                self.answers_key.take_if(|_| !is_sending);
            }
            let event = self.wait(inbound, outbox, wakes_at).await;
            self.note_drained(outbox);
            let now = self.shared.now();
            match event {
                DriverEvent::Arrived(Arrival::Bytes(bytes)) => {
                    self.session.receive(&bytes, now);
                    #[cfg(test)]
                    self.shared.load.spend(Work::Arrival(bytes.len()));
                }
                DriverEvent::Arrived(Arrival::Resized(size)) => self.session.resize(size, now),
                DriverEvent::Arrived(Arrival::Drains) => self.drain(now),
                DriverEvent::Arrived(Arrival::Ended) => return 0,
                DriverEvent::Drained => {}
                DriverEvent::RoomsChanged => {
                    let event = self.rooms_event();
                    self.session.notify(event, now);
                }
                DriverEvent::OnlookersChanged => {
                    let onlookers = self.onlookers.borrow_and_update().clone();
                    self.session.notify(SessionEvent::Onlookers(onlookers), now);
                }
                DriverEvent::Replied(reply) => self.hear(*reply),
                DriverEvent::Notice(Notice::Removed(sentence)) => {
                    self.leave();
                    self.session.notify(SessionEvent::Ended(sentence), now);
                }
                DriverEvent::Notice(Notice::Said(text)) => {
                    if let Some(line) = Line::of(&text, MESSAGE_COLUMNS) {
                        self.session.notify(SessionEvent::Said(line), now);
                    }
                }
                DriverEvent::Notice(Notice::Heard(Heard { from, text, is_private })) => {
                    let from = Line::of(&from, NAME_COLUMNS);
                    if let Some((from, text)) = from.zip(Line::of(&text, CHAT_COLUMNS)) {
                        let event = SessionEvent::Heard { from, text, is_private };
                        self.session.notify(event, now);
                    }
                }
                DriverEvent::Time => self.wake(now),
            }
            if self.sent.is_some() && self.session.output(now).len() > MAX_WAITING_BYTES {
                // The client reads no frames but keeps sending queries that the session must answer.
                self.leave();
                return 1;
            }
        }
    }

    /// Records that the frame in flight has drained, if it has.
    fn note_drained(&mut self, outbox: &Outbox) {
        let sent = self.sent.take_if(|_| outbox.has_drained());
        let Some((bytes, before)) = sent else { return };
        let at = outbox.drained_at().saturating_duration_since(self.shared.begun);
        let on_wire = outbox.on_wire().saturating_sub(before);
        self.session.written(bytes, on_wire as usize, at);
        if let Some(key) = self.answers_key.take() {
            self.shared.metrics.key_time.observe(at.saturating_sub(key));
        }
    }

    /// Waits for a permit to draw, if the session's frames are large. Other sessions need none.
    async fn turn(&self) -> Option<OwnedSemaphorePermit> {
        let turns = self.session.is_large().then(|| Arc::clone(&self.shared.large_frames))?;
        // This cannot fail, because the semaphore is never closed.
        turns.acquire_owned().await.ok()
    }

    /// The bytes to send: queued bytes, or else a frame if one is due.
    fn frame(&mut self, wakes_at: &mut Option<Duration>) -> Vec<u8> {
        let now = self.shared.now();
        let waiting = std::mem::take(self.session.output(now));
        if !waiting.is_empty() {
            return waiting;
        }
        // The snapshot is dropped before the driver waits.
        let view = match &mut self.place {
            Some(place) => place.view(),
            None => self.lively_room(),
        };
        self.session.set_rate(self.shared.load.rate());
        let mut due_at = self.session.due_at(view.as_deref(), now);
        if due_at.is_some_and(|due| due <= now) {
            let session = &mut self.session;
            aside(session.is_large(), || session.draw(view.as_deref(), now));
            #[cfg(test)]
            self.shared.load.spend(Work::Frame);
            let time = self.shared.now().saturating_sub(now);
            self.shared.metrics.frame_time.observe(time);
            self.answers_key = self.session.answered();
            due_at = self.session.due_at(view.as_deref(), now);
        } else if let Some(view) = &view {
            self.session.look_at(view);
        }
        *wakes_at = self.after_wake(self.session.wakes_at(due_at));
        std::mem::take(self.session.output(now))
    }

    /// `time`, or a later time if waking at this time had no effect, for example because the terminal never replies.
    fn after_wake(&self, time: Option<Duration>) -> Option<Duration> {
        time.map(|time| if time > self.woken_at { time } else { self.woken_at + RETRY_INTERVAL })
    }

    /// The snapshot of the room that the lobby shows.
    pub(crate) fn lively_room(&self) -> Option<Arc<RoomView>> {
        let rooms = self.session.lively_rooms();
        rooms.into_iter().find_map(|room| self.shared.rooms.view(room))
    }

    async fn wait(
        &mut self,
        inbound: &mut Inbound,
        outbox: &mut Outbox,
        wakes_at: Option<Duration>,
    ) -> DriverEvent {
        let is_sending = self.sent.is_some();
        let now = self.shared.now();
        let drains_at = is_sending.then(|| self.session.needs_drain_at());
        let awaits_drain = drains_at.is_some_and(|time| time <= now);
        let drains_at = drains_at.filter(|_| !awaits_drain);
        let acts_at = drains_at.and_then(|_| self.after_wake(self.session.acts_at()));
        // The step of the room from which the next frame is drawn. It comes late only if the room stands still.
        let looks_at = if is_sending { drains_at } else { self.session.looks_at(now) };
        let drain_check = drains_at.map(|time| time + STEP_TIMEOUT);
        // Outside of a room, the driver is told of every change.
        let must_look = is_sending || self.place.is_some();
        let next_look = must_look.then_some(now + WAKE_INTERVAL);
        let picture =
            self.session.picture_time().filter(|_| !must_look).map(|interval| now + interval);
        let times = [wakes_at, drain_check, acts_at, self.ends_at, next_look, picture];
        let time = times.into_iter().flatten().min();
        let begun = self.shared.begun;
        let Self { place, rooms, onlookers, replied, in_lobby, presence, .. } = self;
        let step = place.as_ref().zip(looks_at).map(|(place, time)| place.changed(begun + time));
        tokio::select! {
            biased;
            arrival = inbound.next() => DriverEvent::Arrived(arrival),
            () = outbox.drained(), if awaits_drain => DriverEvent::Drained,
            Some(reply) = replied.recv() => DriverEvent::Replied(reply),
            notice = presence.notice() => DriverEvent::Notice(notice),
            Some(()) = OptionFuture::from(step) => DriverEvent::Time,
            Ok(()) = rooms.changed(), if *in_lobby => DriverEvent::RoomsChanged,
            Ok(()) = onlookers.changed(), if *in_lobby => DriverEvent::OnlookersChanged,
            () = sleep_until(begun + time.unwrap_or_default()), if time.is_some() => DriverEvent::Time,
        }
    }

    fn wake(&mut self, now: Duration) {
        self.session.wake(now);
        self.woken_at = now;
        if let Some(sentence) = self.place.as_ref().and_then(Place::closed) {
            self.part();
            self.session.notify(SessionEvent::Left(sentence.to_string()), now);
        }
        self.tell_day();
        if let Some(place) = &self.place
            && let Some(run) = place.finished()
        {
            self.submit(run);
        }
        if self.ends_at.take_if(|end| *end <= now).is_some() {
            self.session.notify(SessionEvent::Ended(self.last_sentence().to_owned()), now);
        }
    }
}

/// Requests from the session.
impl Driver {
    /// Carries out all requests of the session.
    fn run_requests(&mut self) {
        loop {
            let requests = self.session.requests();
            if requests.is_empty() {
                return;
            }
            for ask in requests {
                self.run_request(ask);
            }
        }
    }

    fn run_request(&mut self, ask: SessionRequest) {
        match ask {
            SessionRequest::Name(text) => self.choose_name(&text),
            SessionRequest::Rooms => {
                self.in_lobby = true;
                let onlookers = self.onlookers.borrow_and_update().clone();
                self.notify(SessionEvent::Onlookers(onlookers));
                let event = self.rooms_event();
                self.notify(event);
            }
            SessionRequest::Go(way) => self.go(way),
            SessionRequest::Code(code) => match self.room_with_code(&code) {
                Ok(room) => self.go(RoomEntry::Enter(room)),
                Err(sentence) => self.notify(SessionEvent::Refused(sentence)),
            },
            SessionRequest::Command(command) => self.act(command),
            SessionRequest::Say(text) => self.say_in_lobby(&text),
            SessionRequest::Tell { to, text } => self.tell(to, text),
            SessionRequest::Players => self.list_players(),
            SessionRequest::Report { player, reason, lines } => {
                self.report(&player, reason.as_ref(), lines);
            }
            SessionRequest::Moderate { player, act, reason } => {
                self.moderate(&player, act, reason.as_ref());
            }
            SessionRequest::Recordings => self.list_recordings(),
            SessionRequest::Record(wish) => self.show_record(wish),
            SessionRequest::EndRecord => self.record = None,
            SessionRequest::Leave => self.leave(),
            SessionRequest::Board { level, difficulty } => self.show_board(level, difficulty),
            SessionRequest::Ghosts { level, difficulty } => self.show_ghosts(level, difficulty),
            SessionRequest::Save(settings) => self.save(settings),
        }
    }

    /// Handles a reply.
    fn hear(&mut self, reply: Reply) {
        let event = match reply {
            Reply::SessionEvent(event) => event,
            Reply::Named(name, Ok(account)) => self.take_name(name, account),
            Reply::Named(_, Err(sentence)) => SessionEvent::Named(Err(sentence)),
            Reply::Place(place) => return self.enter(place),
            Reply::Returned(place) => return self.returned(place),
        };
        self.notify(event);
    }

    /// Submits a run to be verified and recorded.
    fn submit(&mut self, run: FinishedRun) {
        let Some(account) = self.account.clone() else {
            let sentence = "A guest's result does not count: connect with a public key.";
            return self.notify(SessionEvent::Result(sentence.to_owned()));
        };
        let recorder = self.shared.recorder.clone();
        let is_accepted = self.call_store(move |store| {
            let sentence = recorder.record(store, &account, &run);
            Some(Reply::SessionEvent(SessionEvent::Result(sentence)))
        });
        if !is_accepted {
            self.notify(SessionEvent::Result("The host can't check your result now.".to_owned()));
        }
    }

    pub(crate) fn notify(&mut self, event: SessionEvent) {
        let now = self.shared.now();
        self.session.notify(event, now);
    }

    fn rooms_event(&mut self) -> SessionEvent {
        let rooms = self.rooms.borrow_and_update().clone();
        SessionEvent::Rooms { rooms, today: self.shared.rooms.today() }
    }

    fn choose_name(&mut self, text: &str) {
        let offered =
            (self.key.is_none() && text == self.offer.as_str()).then(|| self.offer.clone());
        let name = match offered.map_or_else(|| Name::new(text), Ok) {
            Ok(name) => name,
            Err(fault) => return self.notify(SessionEvent::Named(Err(fault.to_string()))),
        };
        if self.name.as_ref() == Some(&name) {
            return self.notify(SessionEvent::Named(Ok(login::line(&name))));
        }
        let (key, account) = (self.key, self.account.clone());
        let origin = Origin::new(self.address, self.shared.config.get().accounts());
        let known = self.shared.known.clone();
        let is_accepted = self.call_store(move |store| {
            let result = login::choose_name(store, &origin, key, account, &name);
            if let (Some(known), Ok(Some(account))) = (known, &result) {
                locked(&known, |known| known.note_name(account, UnixTime::now()));
            }
            Some(Reply::Named(name, result))
        });
        if !is_accepted {
            self.notify(SessionEvent::Named(Err("The host is busy; try again.".to_owned())));
        }
    }

    fn take_name(&mut self, name: Name, account: Option<Account>) -> SessionEvent {
        if account.is_none() && !self.presence.take_guest_name(&name) {
            let sentence = "Somebody here already has this name; choose another.";
            return SessionEvent::Named(Err(sentence.to_owned()));
        }
        let line = login::line(&name);
        self.presence.set_name(name.as_str());
        logging::named(self.key.as_ref(), name.as_str());
        self.account = account.or(self.account.take());
        self.name = Some(name);
        SessionEvent::Named(Ok(line))
    }

    fn show_board(&mut self, level: String, difficulty: Difficulty) {
        let own = self.account.as_ref().map(|account| account.id);
        self.call_store(move |store| {
            let rows = results::board(store, &level, difficulty, own).into();
            Some(Reply::SessionEvent(SessionEvent::Board { level, difficulty, rows }))
        });
    }

    fn list_recordings(&self) {
        let (rooms, replies) = (self.shared.rooms.clone(), self.replies.clone());
        spawn_blocking(move || {
            let row = |recording: PublicRecording| {
                let Header { mode, level, .. } = recording.header()?;
                Some(RecordingRow { name: recording.name, mode, level, ended: recording.time? })
            };
            let recordings = rooms.recordings().public(MAX_LISTED_RECORDINGS);
            let rows = recordings.into_iter().filter_map(row).collect();
            _ = replies.try_send(Box::new(Reply::SessionEvent(SessionEvent::Recordings(rows))));
        });
    }

    /// Loads a record, if not too many are watched.
    fn show_record(&mut self, wish: RecordWish) {
        self.record = None;
        let Ok(permit) = Arc::clone(&self.shared.records).try_acquire_owned() else {
            let sentence = "Others watch as many records as the host can show: try again later.";
            return self.notify(SessionEvent::Record(Err(sentence.to_owned())));
        };
        self.record = Some(permit);
        let (rooms, replies) = (self.shared.rooms.clone(), self.replies.clone());
        match wish {
            RecordWish::Room(name) => {
                spawn_blocking(move || {
                    let text = text_of_recording(&rooms, &name);
                    let record = text.and_then(|text| RoomRecord::parse(&text, rooms.catalog()));
                    let record = record
                        .map_err(|reason| format!("The recording cannot be shown: {reason}."));
                    _ = replies
                        .try_send(Box::new(Reply::SessionEvent(SessionEvent::Record(record))));
                });
            }
            RecordWish::Run { level, difficulty, name } => {
                let is_accepted = self.call_store(move |store| {
                    let record = results::run(store, rooms.catalog(), (&level, difficulty), name);
                    Some(Reply::SessionEvent(SessionEvent::Record(record)))
                });
                if !is_accepted {
                    let sentence = "The host is busy; try again.".to_owned();
                    self.notify(SessionEvent::Record(Err(sentence)));
                }
            }
        }
    }

    /// Loads the ghosts of a level. They are for this visitor only, because each member may want different ones.
    fn show_ghosts(&mut self, level: String, difficulty: Difficulty) {
        let own = self.account.as_ref().map(|account| account.id);
        let (runs, catalog) =
            (Arc::clone(&self.shared.runs), Arc::clone(self.shared.rooms.catalog()));
        self.call_store(move |store| {
            let board = (level.as_str(), difficulty);
            match locked(&runs, |runs| runs.ghosts(store, &catalog, board, own)) {
                Ok(ghosts) => {
                    let ghosts = ghosts.into();
                    Some(Reply::SessionEvent(SessionEvent::Ghosts { level, difficulty, ghosts }))
                }
                Err(failure) => {
                    logging::store_failed(failure);
                    None
                }
            }
        });
    }

    fn save(&mut self, settings: AccountSettings) {
        let Some(key) = self.account.as_ref().map(|account| account.key) else { return };
        let known = self.shared.known.clone();
        self.shared.store.run(move |store| {
            match store.of_key(&key).and_then(|id| store.set_settings(id, &settings)) {
                Ok(()) => {
                    if let Some(known) = known {
                        locked(&known, |known| known.note_settings(&key, &settings));
                    }
                }
                Err(failure) => logging::store_failed(failure),
            }
        });
    }

    /// Queues a call to the store, whose reply arrives later; returns whether it was accepted.
    pub(crate) fn call_store(
        &self,
        act: impl FnOnce(&mut HostStore) -> Option<Reply> + Send + 'static,
    ) -> bool {
        let replies = self.replies.clone();
        self.shared.store.run(move |store| {
            if let Some(reply) = act(store) {
                _ = replies.try_send(Box::new(reply));
            }
        })
    }
}

/// The visitor's place in a room.
impl Driver {
    /// Enters or watches a room. Only a visitor with a name can become a member.
    fn go(&mut self, way: RoomEntry) {
        if !matches!(way, RoomEntry::Watch(_)) {
            self.leave();
        }
        let name = self.name.as_ref().map(login::line);
        if let Some(rooms) = self.shared.cluster.clone() {
            self.is_returning = false;
            let key = self.account.as_ref().map(|account| account.key);
            let entrant = name.map(|name| Entrant { name, key });
            let replies = self.replies.clone();
            tokio::spawn(async move {
                let place = match (&way, &entrant) {
                    (RoomEntry::Watch(room), _) => rooms.watch(*room).await,
                    (RoomEntry::Enter(room), Some(entrant)) => rooms.enter(*room, entrant).await,
                    (RoomEntry::Open { request, is_private }, Some(entrant)) => {
                        rooms.open(request, *is_private, entrant).await
                    }
                    (_, None) => Err(RoomRefusal::Gone),
                };
                // If the visitor has gone, the place is dropped, which leaves the room.
                _ = replies.send(Box::new(Reply::Place(place))).await;
            });
            return;
        }
        let rooms = &self.shared.rooms;
        let place = match (way, &name) {
            (RoomEntry::Watch(room), _) => rooms.watch(room),
            (RoomEntry::Enter(room), Some(name)) => rooms.enter(room, name),
            (RoomEntry::Open { request, is_private }, Some(name)) => {
                rooms.open(&request, is_private, name)
            }
            (_, None) => Err(RoomRefusal::Gone),
        };
        self.enter(place);
    }

    /// The private room with a code that the visitor typed, unless they have guessed too often.
    fn room_with_code(&self, typed: &Line) -> Result<RoomId, String> {
        let Shared { wrong_codes, rooms, .. } = &*self.shared;
        let now = self.shared.now();
        let address = Guesser::Address(counted_address(self.address));
        let guessers: Vec<Guesser> =
            [address].into_iter().chain(self.key.map(Guesser::Key)).collect();
        locked(wrong_codes, |wrong| {
            if !wrong.may_try(&guessers, now) {
                return Err("Too many wrong codes: wait a minute.".to_owned());
            }
            let room = RoomCode::parse(typed.as_str()).and_then(|code| rooms.with_code(code));
            room.ok_or_else(|| {
                wrong.count(&guessers, now);
                format!("No room has the code {typed}; ask a member for it.")
            })
        })
    }

    fn enter(&mut self, place: Result<Place, RoomRefusal>) {
        match place {
            Ok(place) => {
                let place = self.kept_while_draining(place);
                self.in_lobby = false;
                self.presence.set_room(Some(place.room().place()));
                self.presence.set_watching(place.member_id().is_none());
                let (room, member, code) = (place.room(), place.member_id(), place.code());
                let event = SessionEvent::Entered { room, member, code };
                self.place = Some(place);
                self.compared = None;
                self.notify(event);
            }
            Err(refusal) => self.notify(SessionEvent::Refused(refusal.to_string())),
        }
    }

    /// Tells the room the day, if its daily level is the level of an earlier day.
    fn tell_day(&mut self) {
        let Self { shared, place: Some(place), compared, .. } = self else { return };
        let today = shared.rooms.today();
        if compared.replace(today) == Some(today) {
            return;
        }
        let view = shared.rooms.view(place.room());
        let day = view.and_then(|room| Day::of_level(&room.header.level));
        if day.is_some_and(|day| day < today) {
            // Watchers can tell nothing, but every member's driver does.
            place.act(Command::Day(today));
        }
    }

    /// Leaves the room, and submits a run won in it.
    fn leave(&mut self) {
        self.give_place_up();
        self.part();
    }

    /// Ends the stay in the room, and submits a run won in it. During a shutdown, the room keeps the place.
    fn part(&mut self) {
        let Some(place) = self.place.take() else { return };
        self.presence.set_room(None);
        if let Some(run) = place.finished() {
            self.submit(run);
        }
    }

    /// Handles the announcement that the server will shut down soon.
    fn drain(&mut self, now: Duration) {
        let time = self.shared.config.get().drain;
        self.is_draining = true;
        if let Some(place) = self.place.take() {
            self.place = Some(self.kept_while_draining(place));
        }
        let ends_at = now + time;
        let event = SessionEvent::Draining { ends_at, can_return: self.can_return() };
        self.session.notify(event, now);
        self.ends_at = Some(ends_at);
    }

    /// The visitor's last sentence when the server shuts down.
    fn last_sentence(&self) -> &'static str {
        if self.can_return() {
            "This server has ended. Connect again to continue where you were."
        } else {
            "The server has ended. Come back soon!"
        }
    }

    /// Returns true if the visitor can return to the room through another host.
    fn can_return(&self) -> bool {
        self.shared.cluster.is_some() && self.account.is_some()
    }

    /// Brings a visitor with an account back to the room that they had on another host.
    pub(crate) fn look_for_place(&mut self) {
        let Some(rooms) = self.shared.cluster.clone() else { return };
        let Some(key) = self.account.as_ref().map(|account| account.key) else { return };
        self.is_returning = true;
        let replies = self.replies.clone();
        tokio::spawn(async move {
            if let Some(at) = rooms.place_of(key).await {
                _ = replies
                    .send(Box::new(Reply::SessionEvent(SessionEvent::Result(LOOKS.to_owned()))))
                    .await;
                _ = replies.send(Box::new(Reply::Returned(rooms.resume(key, at).await))).await;
            }
        });
    }

    /// Handles the result of the search for the visitor's place.
    fn returned(&mut self, place: Result<Place, RoomRefusal>) {
        if !std::mem::take(&mut self.is_returning) {
            return;
        }
        let sentence = match place {
            Ok(place) => {
                self.enter(Ok(place));
                WELCOME.to_owned()
            }
            Err(RoomRefusal::Gone) => GONE.to_owned(),
            Err(refusal) => refusal.to_string(),
        };
        self.notify(SessionEvent::Result(sentence));
    }

    fn kept_while_draining(&self, mut place: Place) -> Place {
        place.set_kept(self.is_draining && self.shared.cluster.is_some());
        place
    }

    /// Tells the room and the cluster not to keep the place any longer.
    fn give_place_up(&mut self) {
        let Some(place) = &mut self.place else { return };
        place.set_kept(false);
        let key = self.account.as_ref().map(|account| account.key);
        // A member who was removed may have a place elsewhere by now.
        let is_member = place.member_id().is_some() && place.closed().is_none();
        if let (Some(rooms), Some(key), true) = (self.shared.cluster.clone(), key, is_member) {
            tokio::spawn(async move { rooms.forget_place(key).await });
        }
    }
}

/// The most finished recordings that the lobby lists.
const MAX_LISTED_RECORDINGS: usize = 20;
/// The largest recording that visitors can watch, in bytes: an hour of eight players. It takes three times as much memory.
const MAX_WATCHED_BYTES: u64 = 4 << 20;

/// The text of a public recording.
fn text_of_recording(rooms: &Rooms, name: &str) -> Result<String, String> {
    let path = rooms.recordings().named(name).ok_or("it is gone")?;
    let length = fs::metadata(&path).map_err(|error| error.to_string())?.len();
    if length > MAX_WATCHED_BYTES {
        return Err(format!("it has more than {} MiB", MAX_WATCHED_BYTES >> 20));
    }
    fs::read_to_string(path).map_err(|error| error.to_string())
}

/// Draws a frame. A large frame does not block other tasks.
fn aside(is_large: bool, draw: impl FnOnce()) {
    // Simulated time uses a single thread.
    let has_threads = Handle::current().runtime_flavor() == RuntimeFlavor::MultiThread;
    if is_large && has_threads { block_in_place(draw) } else { draw() }
}

/// The host's name for the lobby.
fn host_name(name: &str) -> Line {
    const COLUMNS: usize = 40;
    let line = Line::of(name, COLUMNS).or_else(|| Line::of("Cellcaster", COLUMNS));
    line.expect("printable characters")
}
