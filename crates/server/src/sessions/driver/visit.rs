//! The driver of one visitor.

use std::net::IpAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::sync::{OwnedSemaphorePermit, mpsc, watch};
use tokio::task::block_in_place;
use tokio::time::sleep_until;

use super::Shared;
use super::account::{self, Known, NameInUse};
use super::requests::{Reply, replies};
use super::terminal;
use crate::accounts::{Account, AccountKey, Name};
use crate::rooms::directory::Place;
use crate::rooms::summary::RoomSummary;
use crate::sessions::line::Line;
#[cfg(test)]
use crate::sessions::load::Work;
use crate::sessions::session::{HostFacts, Identity, IdleLimits, Session, SessionEvent};
use crate::sessions::visitors::{Notice, Presence};
use crate::ssh::{Arrival, Inbound, Link, Outbox, Visitor};
use cellcaster::app::Configuration;
use cellcaster::terminal::Options;

/// A visitor with everything that concerns them.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(crate) struct Visit {
    pub(crate) shared: Arc<Shared>,
    pub(crate) session: Session,
    pub(crate) key: Option<AccountKey>,
    /// The address that the visitor connects from.
    pub(crate) address: IpAddr,
    pub(crate) account: Option<Account>,
    /// The name that a guest may take without asking.
    pub(crate) offer: Name,
    /// The name, once it is chosen.
    pub(crate) name: Option<Name>,
    pub(crate) presence: Presence,
    pub(crate) guest_name: Option<NameInUse>,
    pub(crate) place: Option<Place>,
    pub(crate) rooms: watch::Receiver<Arc<[RoomSummary]>>,
    /// Whether the session is told of the rooms.
    pub(crate) in_lobby: bool,
    pub(crate) replies: mpsc::Sender<Reply>,
    replied: mpsc::Receiver<Reply>,
    /// When the session was woken last.
    woken_at: Duration,
    /// When the oldest key came that the frame on its way answers.
    answers_key: Option<Duration>,
    /// When the session is ended, since the server ends.
    pub(crate) ends_at: Option<Duration>,
    /// Whether a frame is on its way.
    is_sending: bool,
    /// Whether the server ends.
    pub(crate) is_draining: bool,
    /// Whether the visitor waits for the place in which they were before.
    pub(crate) is_returning: bool,
}

/// What a driver waits for.
enum DriverEvent {
    Arrived(Arrival),
    Drained,
    RoomsChanged,
    Replied(Reply),
    Notice(Notice),
    Time,
}

/// The time after which a session is woken again for what it has been woken for.
const AGAIN: Duration = Duration::from_millis(250);
/// A driver that sends, or that has a room and does not look at it, wakes after this time, since idle
/// visitors are put out and a room may close even if nothing is read or answered.
const PATIENCE: Duration = Duration::from_secs(1);
/// The most bytes that wait behind a frame. They are queries and no frame, so some hundred are usual.
const MOST_WAITING: usize = 64 << 10;
/// The widest message of the day, in columns.
const MESSAGE_COLUMNS: usize = 200;

impl Visit {
    pub(crate) fn new(
        shared: Arc<Shared>,
        visitor: &Visitor,
        known: Known,
        options: Options,
    ) -> Self {
        let Known { key, account, settings, offer } = known;
        let identity = Identity {
            has_account: key.is_some(),
            name: account::line(&offer),
            is_named: account.is_some(),
            preferences: settings.preferences,
            // What does not parse was written by another version.
            configuration: Configuration::parse(&settings.configuration, "settings")
                .unwrap_or_default(),
        };
        let ascii_locale = terminal::ascii_locale(visitor);
        let config = shared.config.get();
        let presence = shared.visitors.arrive(visitor.peer.ip(), key);
        if let Some(account) = &account {
            presence.set_name(account.name.as_str());
        }
        let host = HostFacts {
            name: host_name(&config.name),
            message: Line::of(&config.message, MESSAGE_COLUMNS),
            notice: visitor.notice.and_then(|notice| Line::of(notice, MESSAGE_COLUMNS)),
            compresses: visitor.compresses,
            ascii_locale: ascii_locale.and_then(|setting| Line::of(&setting, MESSAGE_COLUMNS)),
            catalog: Arc::clone(shared.rooms.catalog()),
            idle: IdleLimits::default(),
            frame_time: shared.load.frame_time(),
        };
        let now = shared.now();
        let session = Session::new(identity, options, visitor.size, host, now);
        let (replies, replied) = replies();
        Self {
            session,
            key,
            address: visitor.peer.ip(),
            name: account.as_ref().map(|account| account.name.clone()),
            account,
            offer,
            presence,
            guest_name: None,
            place: None,
            rooms: shared.rooms.summaries(),
            in_lobby: false,
            replies,
            replied,
            woken_at: Duration::ZERO,
            answers_key: None,
            ends_at: None,
            is_sending: false,
            is_draining: false,
            is_returning: false,
            shared,
        }
    }

    /// Drives the session to its end; returns the exit status. The future may be dropped before, and
    /// the session driven on.
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
            if !self.is_sending {
                let _turn = self.turn().await;
                let bytes = self.frame(&mut wakes_at);
                if bytes.is_empty() && self.session.is_over() {
                    return 0;
                }
                self.is_sending = !bytes.is_empty() && outbox.try_send(bytes).is_ok();
                // A frame without bytes leaves at no time.
                self.answers_key.take_if(|_| !self.is_sending);
            }
            let event = self.wait(inbound, outbox, wakes_at).await;
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
                DriverEvent::Drained => {
                    self.session.written(now);
                    self.is_sending = false;
                    if let Some(key) = self.answers_key.take() {
                        self.shared.metrics.key_time.observe(now.saturating_sub(key).as_secs_f64());
                    }
                }
                DriverEvent::RoomsChanged => {
                    let rooms = self.rooms.borrow_and_update().clone();
                    self.session.notify(SessionEvent::Rooms(rooms), now);
                }
                DriverEvent::Replied(reply) => self.hear(reply),
                DriverEvent::Notice(Notice::Removed(sentence)) => {
                    self.leave();
                    self.session.notify(SessionEvent::Ended(sentence), now);
                }
                DriverEvent::Notice(Notice::Said(text)) => {
                    if let Some(line) = Line::of(&text, MESSAGE_COLUMNS) {
                        self.session.notify(SessionEvent::Said(line), now);
                    }
                }
                DriverEvent::Time => self.wake(now),
            }
            if self.is_sending && self.session.output(now).len() > MOST_WAITING {
                // A client that reads no frame, and sends what the session must answer.
                self.leave();
                return 1;
            }
        }
    }

    /// Waits for the turn of a session whose frames are large. Others have none.
    async fn turn(&self) -> Option<OwnedSemaphorePermit> {
        let turns = self.session.is_large().then(|| Arc::clone(&self.shared.large_frames))?;
        // It is never closed.
        turns.acquire_owned().await.ok()
    }

    /// The bytes to send: those that wait, or else a frame, if one is due.
    fn frame(&mut self, wakes_at: &mut Option<Duration>) -> Vec<u8> {
        let now = self.shared.now();
        let waiting = std::mem::take(self.session.output(now));
        if !waiting.is_empty() {
            return waiting;
        }
        // The snapshot is dropped before the driver waits.
        let view = self.place.as_mut().and_then(Place::view);
        let frame_time = self.shared.load.frame_time();
        self.session.set_frame_time(frame_time);
        if self.session.is_due(view.as_deref(), now) {
            let session = &mut self.session;
            aside(session.is_large(), || session.draw(view.as_deref(), now));
            #[cfg(test)]
            self.shared.load.spend(Work::Frame);
            let time = self.shared.now().saturating_sub(now);
            self.shared.metrics.frame_time.observe(time.as_secs_f64());
            self.answers_key = self.session.answered();
        } else if let Some(view) = &view {
            self.session.look_at(view);
        }
        // What waking did not change, waking again will not, as where a terminal never answers.
        let time = self.session.wakes_at(view.as_deref(), now);
        *wakes_at =
            time.map(|time| if time > self.woken_at { time } else { self.woken_at + AGAIN });
        std::mem::take(self.session.output(now))
    }

    async fn wait(
        &mut self,
        inbound: &mut Inbound,
        outbox: &mut Outbox,
        wakes_at: Option<Duration>,
    ) -> DriverEvent {
        let is_sending = self.is_sending;
        let now = self.shared.now();
        let is_free = !is_sending && self.place.is_some();
        let looks_at = self.session.looks_at(now).filter(|_| is_free);
        let looks = looks_at.is_some_and(|time| time <= now);
        let quiet_end = looks_at.filter(|_| !looks);
        // Elsewhere, it is told when something happens.
        let is_patient = is_sending || self.place.is_some() && !looks;
        let patience = is_patient.then_some(now + PATIENCE);
        let times = [wakes_at, quiet_end, self.ends_at, patience];
        let time = times.into_iter().flatten().min();
        let begun = self.shared.begun;
        let Self { place, rooms, replied, in_lobby, presence, .. } = self;
        tokio::select! {
            biased;
            arrival = inbound.next() => DriverEvent::Arrived(arrival),
            () = outbox.drained(), if is_sending => DriverEvent::Drained,
            Some(reply) = replied.recv() => DriverEvent::Replied(reply),
            notice = presence.notice() => DriverEvent::Notice(notice),
            () = changed(place.as_mut()), if looks => DriverEvent::Time,
            Ok(()) = rooms.changed(), if *in_lobby => DriverEvent::RoomsChanged,
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

/// Draws a frame. For a large one, other tasks go on meanwhile.
fn aside(is_large: bool, draw: impl FnOnce()) {
    // There is one thread in simulated time.
    let has_threads = Handle::current().runtime_flavor() == RuntimeFlavor::MultiThread;
    if is_large && has_threads { block_in_place(draw) } else { draw() }
}

/// The name of the host as the lobby shows it.
fn host_name(name: &str) -> Line {
    const COLUMNS: usize = 40;
    let line = Line::of(name, COLUMNS).or_else(|| Line::of("Cellcaster", COLUMNS));
    line.expect("printable characters")
}

/// Waits for a newer snapshot.
async fn changed(place: Option<&mut Place>) {
    match place {
        Some(place) => place.changed().await,
        None => std::future::pending().await,
    }
}
