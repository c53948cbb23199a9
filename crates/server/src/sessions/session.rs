//! A visitor's session: draws the visitor's screen and handles their keys.
//!
//! A session owns neither the connection nor the clock nor the room. Its driver passes it input with the time
//! of arrival, takes bytes and [requests](SessionRequest) from it, notifies it of [events](SessionEvent), and shows
//! it the latest [snapshot](RoomView) of the room: the visitor's room, or in the lobby the liveliest one. The
//! driver calls it in this order:
//!
//! - after each [`receive`](Session::receive), [`resize`](Session::resize), [`notify`](Session::notify),
//!   [`wake`](Session::wake) and [`draw`](Session::draw): take [`requests`](Session::requests) and
//!   [`output`](Session::output);
//! - when the outbox is empty, at [`due_at`](Session::due_at): [`draw`](Session::draw), and take the output;
//! - at [`wakes_at`](Session::wakes_at): [`wake`](Session::wake).
//!
//! A frame is drawn only if the terminal has acknowledged the previous ones and the picture has changed. The
//! session of a client that does not read therefore holds one frame, and visitors who all stand still cost no
//! bytes.
//!
//! Keys pressed faster than anybody types are dropped. Some open a page or change a setting, which takes a
//! hundred times as long as decoding them.

mod ceremony;
mod commands;
pub(crate) mod draw;
mod endings;
mod frames;
mod ignored;
mod intent_queue;
mod keys;
mod line_entry;
pub(crate) mod lobby;
mod messages;
mod pages;
pub(crate) mod playback;
pub(crate) mod replayed;
mod settings;
mod stay;
mod talk;
#[cfg(test)]
mod tests;
mod ui;

use std::num::NonZero;
use std::time::Duration;

pub(crate) use self::endings::IdleLimits;
use self::frames::{Pace, Unanswered};
pub(crate) use self::messages::{
    BoardRow, Moderation, Profile, RecordWish, RecordingRow, RoomEntry, SessionContext,
    SessionEvent, SessionRequest,
};
use self::stay::Stay;
use self::ui::Ui;
use crate::bucket::Bucket;
use crate::load::Rate;
use crate::rooms::room::RoomView;
use crate::rooms::sequencer::STEP;
use crate::rooms::summary::RoomId;
use cellcaster::app::parts::Meter;
use cellcaster::game::Intents;
use cellcaster::terminal::{Event, KeyEvent, Phase, Protocol, SessionOptions, WindowSize};

/// The number of keys that a visitor may press per second. A held key repeats about 30 times a second.
const KEYS: f64 = 200.0;
/// The number of keys that a visitor may press in a burst: more than a pasted line of chat has characters.
const KEYS_AT_ONCE: f64 = 300.0;
/// The number of cells above which a frame is large. A frame of 200×60 cells takes 1.2 ms, one of 500×200
/// eight times as long.
const LARGE: usize = 12_000;
/// The shortest round-trip time of a link that is not local.
const MIN_REMOTE_ROUND_TRIP: Duration = Duration::from_millis(3);

/// A visitor's session.
pub(crate) struct Session {
    protocol: Protocol,
    ui: Ui,
    ending: Ending,
    pace: Pace,
    /// Limits the rate of keys.
    keys: Bucket,
    /// The keys that no frame has answered yet.
    unanswered: Unanswered,
    /// The arrival time of the oldest key that the last frame answers.
    answered: Option<Duration>,
    meter: Meter,
    /// Whether the link has made pictures of a room coarser; `None` if no room has been shown yet.
    is_limited: Option<bool>,
}

/// The progress of the session's end.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Ending {
    /// The session goes on.
    Not,
    /// The terminal has been asked to acknowledge all output; then it shows this sentence.
    Asked(String),
    /// The session has ended, and all its output is ready.
    Over,
}

impl Session {
    /// A session on a terminal with these `options`.
    pub(crate) fn new(
        identity: Profile,
        options: SessionOptions,
        size: WindowSize,
        host: SessionContext,
        now: Duration,
    ) -> Self {
        let mut protocol = Protocol::new(options, size);
        protocol.begin(now);
        let pace = Pace::new(host.frame_time);
        let mut session = Self {
            protocol,
            ui: Ui::new(identity, host, options.is_ascii, now),
            ending: Ending::Not,
            pace,
            keys: Bucket::new(KEYS, KEYS_AT_ONCE, now),
            unanswered: Unanswered::default(),
            answered: None,
            meter: Meter::default(),
            is_limited: None,
        };
        session.follow_terminal();
        session.show_choices();
        session
    }

    /// Handles bytes from the terminal, which may be split anywhere.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Duration) {
        self.protocol.receive(bytes, now);
        self.handle_events(now);
    }

    /// Records a new window size.
    pub(crate) fn resize(&mut self, size: WindowSize, now: Duration) {
        self.protocol.resize(size, now);
        self.handle_events(now);
    }

    /// Records an event from the driver.
    pub(crate) fn notify(&mut self, event: SessionEvent, now: Duration) {
        self.ui.advance(now);
        self.ui.notify(event);
        self.finish(now);
    }

    /// Handles everything that is due at `now` without input.
    pub(crate) fn wake(&mut self, now: Duration) {
        self.protocol.wake(now);
        self.handle_events(now);
        self.ui.wake(now);
        self.finish(now);
    }

    /// The arrival time of the oldest key that the frames since the last call answer; `None` if they answer none.
    pub(crate) fn answered(&mut self) -> Option<Duration> {
        self.answered.take()
    }

    /// Looks at the latest snapshot. A key that has changed nothing in the room no longer waits for a frame.
    pub(crate) fn look_at(&mut self, room: &RoomView) {
        let has_acted = |stay: &Stay| stay.has_acted(room);
        if self.unanswered.awaits(true)
            && self.ui.stay.as_ref().is_none_or(has_acted)
            && !self.ui.is_stale(Some(room))
        {
            self.unanswered.forget_wanted();
        }
    }

    fn shows_intents(&self, room: Option<&RoomView>) -> bool {
        let stay = self.ui.stay.as_ref().zip(room);
        stay.is_none_or(|(stay, room)| stay.shows_intents(room, self.unanswered.wanted()))
    }

    /// Takes the session's requests since the last call.
    pub(crate) fn requests(&mut self) -> Vec<SessionRequest> {
        std::mem::take(&mut self.ui.requests)
    }

    /// Returns true if drawing a frame may take longer than other tasks should have to wait.
    pub(crate) fn is_large(&self) -> bool {
        let WindowSize { columns, rows, .. } = self.protocol.size();
        usize::from(columns) * usize::from(rows) > LARGE
    }

    /// Draws a frame into the output.
    pub(crate) fn draw(&mut self, room: Option<&RoomView>, now: Duration) {
        let recorded = self.ui.playback.as_ref().map(|playback| playback.view());
        let room = recorded.as_ref().or(room);
        if self.stale_from(room).is_some_and(|from| from <= now) {
            self.draw_anew(room, now);
        } else {
            self.protocol.refine();
        }
        self.protocol.output(now);
        if let (Some(stay), Some(room)) = (&mut self.ui.stay, room) {
            stay.frames.drawn(self.protocol.frames_sent(), room.game.steps());
        }
        self.pace.drawn(now);
    }

    fn draw_anew(&mut self, room: Option<&RoomView>, now: Duration) {
        // Measured before drawing, so that the picture shows the newest figures.
        self.measure(now);
        let shows_intents = self.shows_intents(room);
        let answered = self.unanswered.answer(shows_intents);
        self.answered = self.answered.into_iter().chain(answered).min();
        let Self { protocol, ui, .. } = self;
        if let Some(room) = room {
            ui.look_at(room, now);
        }
        let rings = ui.stay.as_mut().is_some_and(Stay::take_ring);
        if rings && ui.identity.preferences.bell {
            protocol.ring_bell();
        }
        protocol.draw(|screen| ui.draw(screen, room));
        ui.drawn();
        if let (Some(stay), Some(room)) = (&mut ui.stay, room) {
            stay.drawn(room, ui.field_of_view, ui.identity.preferences.ghost);
        } else {
            ui.lobby.drawn(room, ui.field_of_view, now);
        }
    }

    /// Updates the statistics of the frames.
    fn measure(&mut self, now: Duration) {
        let Self { protocol, ui, meter, .. } = self;
        if let Some(mut stats) = meter.measure(protocol, now) {
            let is_limited = stats.wants_compression;
            self.is_limited = ui.stay.is_some().then_some(is_limited).or(self.is_limited);
            stats.wants_compression &= !ui.host.compresses;
            ui.stats = Some(stats);
        }
    }

    /// The bytes to send. The driver takes all of them.
    pub(crate) fn output(&mut self, now: Duration) -> &mut Vec<u8> {
        self.protocol.output(now)
    }

    /// Records that all bytes taken from the output have been sent: `bytes` bytes, with `on_wire` bytes on the
    /// wire.
    pub(crate) fn written(&mut self, bytes: usize, on_wire: usize, now: Duration) {
        self.protocol.written(now);
        self.protocol.carried(bytes, on_wire);
    }

    /// The time from which on the driver must know at once that a frame has been sent. Until then, the terminal's
    /// answer comes first in most cases, so that one event tells of both.
    pub(crate) fn needs_drain_at(&self) -> Duration {
        let Self { protocol, ui, .. } = self;
        let is_answered =
            protocol.round_trip().is_some() && protocol.frames_answered() < protocol.frames_sent();
        if is_answered && ui.stay.is_some() { self.next_frame(false) } else { Duration::ZERO }
    }

    /// The time of the next [`wake`](Self::wake) if nothing happens before and the next frame is
    /// [due](Self::due_at) at `due_at`; `None` for never.
    pub(crate) fn wakes_at(&self, due_at: Option<Duration>) -> Option<Duration> {
        // In a room, the next step wakes the driver, unless the room stands still.
        let grace = if self.ui.stay.is_some() { STEP } else { Duration::ZERO };
        due_at.map(|due| due + grace).into_iter().chain(self.acts_at()).min()
    }

    /// The time of the next [`wake`](Self::wake) if nothing happens before; `None` for never.
    pub(crate) fn acts_at(&self) -> Option<Duration> {
        let ui = self.ui.wakes_at().filter(|_| self.ending == Ending::Not);
        ui.into_iter().chain(self.protocol.wakes_at()).min()
    }

    /// The earliest time at which a newer snapshot may lead to a frame; `None` until the terminal replies or
    /// [`wakes_at`](Self::wakes_at) is reached.
    pub(crate) fn looks_at(&self, now: Duration) -> Option<Duration> {
        let ready_at = self.protocol.ready_at(now).filter(|_| self.ending == Ending::Not)?;
        Some(self.next_frame(self.unanswered.awaits(true)).max(ready_at))
    }

    /// Limits the bytes per second that frames take on the wire. `None` means no limit.
    pub(crate) fn set_budget(&mut self, bytes_per_second: Option<NonZero<u32>>) {
        self.protocol.set_budget(bytes_per_second);
    }

    /// Sets the interval between frames and the effort for each.
    pub(crate) fn set_rate(&mut self, Rate { frame_time, effort }: Rate) {
        self.pace.set_frame_time(frame_time.max(self.protocol.frame_time()));
        self.protocol.set_effort(effort);
    }

    /// Returns true once the session has ended. The driver may then send the output and close the connection.
    pub(crate) fn is_over(&self) -> bool {
        self.ending == Ending::Over
    }

    /// The time at which the driver should call [`draw`](Self::draw), with `room` as the latest snapshot. `None` if the
    /// picture has not changed or the terminal is not ready. In a room, changes are not looked for before that time.
    pub(crate) fn due_at(&self, room: Option<&RoomView>, now: Duration) -> Option<Duration> {
        let looks_at = self.looks_at(now)?;
        if looks_at > now && self.ui.stay.is_some() {
            return Some(looks_at);
        }
        let stale_from = self.stale_from(room);
        if stale_from.is_none() && self.protocol.is_settled() {
            return None;
        }
        let is_stale = stale_from == Some(Duration::ZERO);
        // A picture that is out of date soon is not refined meanwhile.
        let from = stale_from.unwrap_or_default();
        let is_prompt = is_stale && self.unanswered.awaits(self.shows_intents(room));
        Some(self.next_frame(is_prompt).max(from).max(looks_at))
    }

    /// The time from which the picture on the screen is out of date; `None` if it is up to date.
    fn stale_from(&self, room: Option<&RoomView>) -> Option<Duration> {
        let Self { ui, pace, .. } = self;
        if ui.is_stale(room) {
            return Some(Duration::ZERO);
        }
        let in_lobby = || ui.lobby.stale_from(room, ui.field_of_view, pace.frame_time());
        ui.stay.is_none().then(in_lobby).flatten()
    }

    /// The rooms that the lobby may show, the preferred one first; empty outside of the lobby.
    pub(crate) fn lively_rooms(&self) -> Vec<RoomId> {
        self.ui.lively_rooms()
    }

    /// The interval at which the driver looks for changes of the room that the lobby shows, if it shows one.
    pub(crate) fn picture_time(&self) -> Option<Duration> {
        let Self { ui, pace, .. } = self;
        let is_live = ui.stay.is_none() && ui.lobby.is_live();
        is_live.then(|| lobby::picture_time(pace.frame_time()))
    }

    /// The time of the next frame by the frame rate and the budget of bytes.
    fn next_frame(&self, answers_key: bool) -> Duration {
        self.pace.next(answers_key).max(self.protocol.budget_opens_at())
    }

    /// Handles the terminal's events.
    fn handle_events(&mut self, now: Duration) {
        self.ui.answered = self.protocol.frames_answered();
        self.ui.wants_compression = self.wants_compression();
        while let Some(event) = self.protocol.next_event() {
            match event {
                Event::Key(event) if !self.takes_key(event, now) => continue,
                Event::Resized | Event::ColorDepth(_) | Event::Identified => self.follow_terminal(),
                _ => {}
            }
            if let Event::Key(_) | Event::Mouse(_) = event {
                self.press(event, now);
            } else {
                self.ui.event(event, now);
            }
        }
        self.show_choices();
        self.finish(now);
    }

    /// Handles a key, and records whether it changes the screen or the visitor's intents.
    fn press(&mut self, key: Event, now: Duration) {
        self.ui.advance(now);
        let was_stale = std::mem::take(&mut self.ui.is_stale);
        let wanted = self.wanted();
        self.ui.event(key, now);
        let changed = self.wanted().filter(|_| self.wanted() != wanted);
        self.unanswered.press(self.ui.is_stale, changed, now);
        self.ui.is_stale |= was_stale;
    }

    /// The visitor's intents in the room.
    fn wanted(&self) -> Option<Intents> {
        self.ui.stay.as_ref().map(|stay| stay.intents.newest())
    }

    /// Returns true if a key counts. Releases always count, so that no key is held forever.
    fn takes_key(&mut self, event: KeyEvent, now: Duration) -> bool {
        event.phase == Phase::Release || self.keys.takes_one(now)
    }

    /// Returns true if compression would make pictures finer. Until pictures of a room have been measured,
    /// this is assumed for every link that is not local.
    fn wants_compression(&self) -> bool {
        let is_far = self.protocol.round_trip().is_some_and(|time| time >= MIN_REMOTE_ROUND_TRIP);
        !self.ui.host.compresses && self.is_limited.unwrap_or(is_far)
    }

    /// Applies the visitor's choices to the terminal.
    fn show_choices(&mut self) {
        let Self { protocol, ui, .. } = self;
        protocol.set_mouse(ui.pointer.is_on());
        protocol.set_ascii(ui.is_ascii());
    }

    /// Adopts the terminal's detected properties.
    fn follow_terminal(&mut self) {
        self.ui.follow_terminal(&self.protocol);
    }

    /// Ends the session if it should end, and restores the screen once the terminal has acknowledged all output.
    fn finish(&mut self, now: Duration) {
        if self.ending == Ending::Not
            && let Some(sentence) = self.ui.farewell.take()
        {
            self.protocol.end(now);
            self.ending = Ending::Asked(sentence);
        }
        if let Ending::Asked(sentence) = &self.ending
            && self.protocol.has_ended(now)
        {
            let sentence = format!("{sentence}\r\n");
            self.protocol.finish();
            self.protocol.output(now).extend_from_slice(sentence.as_bytes());
            self.ending = Ending::Over;
        }
    }
}
