//! The user interface of a session, without the terminal: its state, the driver's events, and timed actions.

use std::sync::Arc;
use std::time::Duration;

use super::commands::Players;
use super::endings::{Draining, Idle, IdleAction};
use super::ignored::Ignored;
use super::line_entry::LineEntry;
use super::lobby::Lobby;
use super::messages::{
    BoardRow, Profile, RecordingRow, SessionContext, SessionEvent, SessionRequest,
};
use super::pages::{Choice, LevelChoice, Page};
use super::playback::RoomPlayback;
use super::stay::Stay;
use super::talk::Talk;
use crate::accounts::Day;
use crate::line::Line;
use crate::rooms::room::{Command, NAME_COLUMNS, RoomView};
use crate::rooms::summary::{RoomId, RoomSummary};
use cellcaster::app::parts::{
    Clock, Controls, Detection, KeyContext, Pages, Pointer, Stats, StatusLine, TerminalLook,
};
use cellcaster::app::{Bindings, Configuration};
use cellcaster::game::Intents;
use cellcaster::terminal::{Key, Protocol};
use cellcaster::world::FieldOfView;

/// The maximum number of queued requests. Further ones are dropped, because only a paste produces that many.
const MAX_REQUESTS: usize = 64;

/// The state of a session's user interface.
#[expect(clippy::struct_excessive_bools, reason = "each is a state of its own")]
pub(crate) struct Ui {
    pub(crate) identity: Profile,
    pub(crate) host: SessionContext,
    pub(crate) requests: Vec<SessionRequest>,
    pub(crate) bindings: Bindings,
    pub(crate) controls: Controls,
    pub(crate) pointer: Pointer,
    pub(crate) clock: Clock,
    pub(crate) terminal: TerminalLook,
    /// Whether the terminal shows only ASCII.
    pub(crate) has_ascii_only: bool,
    pub(crate) field_of_view: FieldOfView,
    pub(crate) detection: Detection,
    pub(crate) pages: Pages<Page, Choice>,
    pub(crate) entry: LineEntry,
    /// Whether a new room is private.
    pub(crate) is_private: bool,
    /// Whether a request for a name is pending.
    pub(crate) awaits_name: bool,
    /// A sentence about the latest event.
    pub(crate) note: Option<String>,
    /// The server's shutdown, once announced.
    pub(crate) draining: Option<Draining>,
    pub(crate) rooms: Arc<[RoomSummary]>,
    pub(crate) lobby: Lobby,
    pub(crate) board: Board,
    /// The visitor's stay in a room; `None` in the lobby.
    pub(crate) stay: Option<Stay>,
    /// The record that the visitor watches.
    pub(crate) playback: Option<Box<RoomPlayback>>,
    /// The page from which the visitor chose a record.
    pub(crate) record_from: Page,
    /// The recordings that the host offers; `None` until they arrive.
    pub(crate) recordings: Option<Arc<[RecordingRow]>>,
    pub(crate) talk: Talk,
    pub(crate) ignored: Ignored,
    pub(crate) players: Players,
    pub(crate) status: StatusLine,
    /// The statistics of frames and the link, and whether the status line shows them.
    pub(crate) stats: Option<Stats>,
    pub(crate) shows_stats: bool,
    /// Whether compression would make pictures finer, as far as is known.
    pub(crate) wants_compression: bool,
    pub(crate) idle: Idle,
    /// The number of frames that the terminal has acknowledged.
    pub(crate) answered: u64,
    /// The time of the last event.
    pub(crate) now: Duration,
    /// Whether the screen must be redrawn, regardless of the room.
    pub(crate) is_stale: bool,
    /// The reason why the session ends, once it does.
    pub(crate) farewell: Option<String>,
}

/// The board on display.
#[derive(Clone, Debug)]
pub(crate) struct Board {
    pub(crate) level: LevelChoice,
    /// The day, if the level is a daily level.
    pub(crate) day: Day,
    /// The entries; `None` until they arrive.
    pub(crate) rows: Option<Arc<[BoardRow]>>,
}

impl Ui {
    pub(crate) fn new(
        identity: Profile,
        host: SessionContext,
        has_ascii_only: bool,
        now: Duration,
    ) -> Self {
        let mut idle = Idle::default();
        idle.restart(now);
        let mut clock = Clock::default();
        clock.skip_to(now);
        let mut controls = Controls::default();
        controls.toggles.runs_by_default = identity.preferences.runs;
        Self {
            entry: LineEntry::offering(&identity.name, NAME_COLUMNS),
            requests: Vec::new(),
            bindings: bindings_of(&identity.configuration),
            controls,
            pointer: Pointer::new(identity.configuration.mouse),
            clock,
            terminal: TerminalLook::default(),
            has_ascii_only,
            field_of_view: identity.configuration.field_of_view,
            detection: Detection {
                ascii_locale: host.ascii_locale.as_ref().map(ToString::to_string),
                is_visitor: true,
                ..Detection::default()
            },
            pages: Pages::new(Page::Name),
            is_private: false,
            awaits_name: false,
            note: None,
            draining: None,
            rooms: Arc::from([]),
            lobby: Lobby::default(),
            board: Board { level: LevelChoice::Daily, day: host.today, rows: None },
            stay: None,
            playback: None,
            record_from: Page::Lobby,
            recordings: None,
            talk: Talk::default(),
            ignored: Ignored::new(identity.ignored.clone()),
            players: Players::default(),
            status: StatusLine::default(),
            stats: None,
            shows_stats: false,
            wants_compression: false,
            idle,
            answered: 0,
            now,
            is_stale: true,
            farewell: None,
            identity,
            host,
        }
    }

    /// Takes over the properties of the terminal.
    pub(crate) fn follow_terminal(&mut self, protocol: &Protocol) {
        self.terminal = TerminalLook::of(protocol);
        let is_chosen = self.identity.preferences.colors.is_some();
        self.detection.follow(protocol, self.depth(), is_chosen);
        self.pointer.set_columns(protocol.size().columns);
        self.is_stale = true;
    }

    /// Continues after a suspension. The time of the suspension does not count.
    pub(crate) fn resumed(&mut self, now: Duration) {
        self.clock.skip_to(now);
        self.release_keys();
        self.is_stale = true;
    }

    /// Queues a request to the driver.
    pub(crate) fn ask(&mut self, request: SessionRequest) {
        if self.requests.len() < MAX_REQUESTS {
            self.requests.push(request);
        }
    }

    /// The room with this number, if it is listed.
    pub(crate) fn room(&self, id: RoomId) -> Option<&RoomSummary> {
        self.rooms.iter().find(|room| room.id == id)
    }

    /// Returns true if a new picture would differ from the current one.
    pub(crate) fn is_stale(&self, room: Option<&RoomView>) -> bool {
        let (view, shows_ghosts) = (self.field_of_view, self.identity.preferences.ghost);
        let differs = |stay: &Stay| {
            room.is_some_and(|room| {
                stay.differs_from(room, view, shows_ghosts) || self.talk.is_behind(&room.said)
            })
        };
        let is_recorded = |it: &RoomPlayback| it.player.is_stale();
        match &self.playback {
            Some(playback) => self.is_stale || is_recorded(playback),
            None => self.is_stale || self.stay.as_ref().is_some_and(differs),
        }
    }

    /// Records that the screen was drawn.
    pub(crate) fn drawn(&mut self) {
        self.is_stale = false;
        self.playback.iter_mut().for_each(|playback| playback.player.drawn());
    }

    /// Follows the room before it is drawn.
    pub(crate) fn look_at(&mut self, room: &RoomView, now: Duration) {
        let Some(stay) = &mut self.stay else { return };
        if self.playback.is_some() {
            // A record has no ghosts.
            _ = stay.look_at(room, now);
            self.talk.forget_old(now);
            return;
        }
        self.talk.hear(&room.said, &self.ignored, now);
        self.talk.forget_old(now);
        self.requests.extend(stay.look_at(room, now));
    }

    /// Handles everything that is due at `now`.
    pub(crate) fn wake(&mut self, now: Duration) {
        self.advance(now);
        self.settle();
        self.is_stale |= self.talk.forget_old(now);
        match self.idle.step(self.idle_limit(), now) {
            None => {}
            Some(IdleAction::Warn) => self.is_stale = true,
            Some(IdleAction::End) => self.put_out(),
        }
    }

    /// The time of the next wake-up.
    pub(crate) fn wakes_at(&self) -> Option<Duration> {
        let held = &self.controls.held;
        let tap = self.is_playing() && held.has_taps();
        let turns = self.is_playing() && self.pointer.is_busy();
        let stay = self.stay.as_ref();
        let times = [
            Some(self.idle.next_at(self.idle_limit())),
            self.pages.pending_until(),
            held.next_expiry(),
            (tap || turns).then(|| self.clock.step_after(0)),
            self.talk.next_end(),
            self.playback_wakes_at(),
            stay.and_then(|stay| stay.intents.next_at()),
            self.draining.and_then(|draining| draining.next_at(self.now)),
        ];
        times.into_iter().flatten().min()
    }

    /// Advances the controls step by step up to `now`, and sends the visitor's intents to the room.
    pub(crate) fn advance(&mut self, now: Duration) {
        let before = std::mem::replace(&mut self.now, now);
        if self.draining.is_some_and(|it| it.seconds(before) != it.seconds(now)) {
            self.renew_menu();
        }
        let context = self.key_context();
        let steps = self.clock.steps_until(now).min(Clock::MAX_STEPS);
        for _ in 0..steps {
            self.controls.advance(now, context);
            self.want();
            self.turn();
            self.fly();
            self.controls.held.step();
        }
        self.advance_playback(steps);
        self.controls.advance(now, context);
        self.want();
    }

    /// Turns the player by the mouse's movement in one step.
    fn turn(&mut self) {
        if !self.is_playing() {
            return;
        }
        if let Some(stay) = &mut self.stay {
            stay.intents.turn(self.pointer.look());
        }
        self.pointer.passed(1);
    }

    /// Sends the intents of held keys and mouse buttons to the room.
    pub(crate) fn want(&mut self) {
        let intents = if self.is_playing() {
            let keys = self.controls.intents(&self.bindings, self.key_context());
            keys.iter().chain(self.pointer.clicked().iter()).collect()
        } else {
            Intents::new()
        };
        let Some(stay) = self.stay.as_mut().filter(|stay| stay.member.is_some()) else { return };
        stay.intents.set(intents);
        if let Some(intents) = stay.intents.take(self.now) {
            let seen = stay.frames.seen(self.answered);
            self.ask(SessionRequest::Command(Command::Intents { seen, intents }));
        }
    }

    /// Returns true if keys control the player.
    pub(crate) fn is_playing(&self) -> bool {
        self.page() == Page::Room && self.stay.as_ref().is_some_and(|stay| stay.member.is_some())
    }

    pub(crate) fn key_context(&self) -> KeyContext {
        let is_airborne = self.stay.as_ref().is_some_and(|stay| stay.is_airborne);
        KeyContext { plays: self.is_playing() || self.flies(), is_airborne, flies: false }
    }

    /// Releases all held keys and stops continuous walking.
    pub(crate) fn release_keys(&mut self) {
        self.controls.held.release_all();
        self.controls.toggles.keeps_walking = false;
        self.want();
    }

    fn idle_limit(&self) -> Duration {
        match &self.stay {
            Some(stay) if stay.member.is_some() => self.host.idle.in_room,
            _ => self.host.idle.elsewhere,
        }
    }

    /// Removes an idle visitor from the room, or ends the session.
    fn put_out(&mut self) {
        let minutes = self.idle_limit().as_secs().div_ceil(60);
        self.idle.restart(self.now);
        let sentence = format!("You have not pressed a key for {minutes} minutes.");
        if self.stay.as_ref().is_some_and(|stay| stay.member.is_some()) {
            self.ask(SessionRequest::Leave);
            self.leave_room(Some(sentence));
        } else {
            self.farewell = Some(sentence);
        }
    }
}

/// Events from the driver.
impl Ui {
    /// Handles an event from the driver.
    pub(crate) fn notify(&mut self, event: SessionEvent) {
        self.is_stale = true;
        match event {
            SessionEvent::Named(answer) => self.named(answer),
            SessionEvent::Rooms { rooms, today } => {
                (self.rooms, self.host.today) = (rooms, today);
                if self.stay.is_none() {
                    self.ask_for_lobby_board();
                    self.renew_menu();
                }
            }
            SessionEvent::Entered { member, code, .. } => {
                self.note = None;
                self.talk.enter_room();
                self.stay = Some(Stay::new(member, code, self.identity.configuration.minimap));
                self.clock.skip_to(self.now);
                self.show(Page::Room);
            }
            SessionEvent::Refused(sentence) | SessionEvent::Left(sentence) => {
                self.leave_room(Some(sentence));
            }
            SessionEvent::Board { level, difficulty, rows } => {
                self.lobby.receive(&level, &rows);
                if self.asked_board() == Some((level, difficulty)) {
                    self.board.rows = Some(rows);
                    self.renew_menu();
                }
            }
            SessionEvent::Ghosts { level, difficulty, ghosts } => {
                if let Some(stay) = &mut self.stay {
                    stay.ghosts.receive(level, difficulty, ghosts);
                }
            }
            SessionEvent::Recordings(rows) => {
                self.recordings = Some(rows);
                self.renew_menu();
            }
            SessionEvent::Record(Ok(record)) => {
                let from = if self.page() == Page::Entering { self.record_from } else { return };
                self.begin_playback(record, Some(from));
            }
            SessionEvent::Record(Err(sentence)) => {
                self.close();
                self.hear(sentence);
            }
            SessionEvent::Onlookers(onlookers) => self.lobby.onlookers = onlookers,
            SessionEvent::Result(sentence) => self.hear(sentence),
            SessionEvent::Said(line) => self.hear(format!("{}: {line}", self.host.name)),
            SessionEvent::Heard { from, text, is_private } => {
                if !self.ignored.contains(&from) {
                    self.talk.hear_visitor(from, &text, is_private, self.now);
                }
            }
            SessionEvent::Told { to, text } => self.talk.told(&to, &text, self.now),
            SessionEvent::Advice(sentence) => self.advise(sentence),
            SessionEvent::Players { names, moderates } => {
                (self.players.names, self.players.moderates) = (Some(names), moderates);
                self.renew_menu();
            }
            SessionEvent::Draining { ends_at, can_return } => {
                self.draining = Some(Draining { ends_at, can_return });
                self.renew_menu();
            }
            SessionEvent::Ended(sentence) => self.farewell = Some(sentence),
        }
    }

    fn named(&mut self, answer: Result<Line, String>) {
        self.awaits_name = false;
        match answer {
            Ok(name) => {
                self.identity.name = name;
                self.identity.is_named = true;
                self.enter_lobby();
            }
            Err(sentence) => self.note = Some(sentence),
        }
    }

    /// Shows the lobby after the name is chosen.
    pub(crate) fn enter_lobby(&mut self) {
        self.note = None;
        self.lobby.begin();
        self.ask(SessionRequest::Rooms);
        self.show(Page::Lobby);
    }

    pub(crate) fn hear(&mut self, sentence: String) {
        if self.stay.is_some() {
            self.talk.hear_host(sentence, self.now);
        } else {
            self.note = Some(sentence);
            self.renew_menu();
        }
    }
}

/// The key bindings without the keys that have another meaning in a room.
pub(crate) fn bindings_of(configuration: &Configuration) -> Bindings {
    let keys = ['/', ';', '1', '7'].map(Key::Char);
    let others = [Key::Enter, Key::Tab, Key::Backspace];
    configuration.bindings.clone().without(&keys).without(&others)
}
