//! The session of a visitor: what they see, and what their keys do.
//!
//! A session has no connection, no clock and no room. The driver passes it what arrives and when,
//! takes bytes and [wishes](Ask) from it, brings it [news](News), and shows it the newest
//! [snapshot](RoomView) of the room. The order of calls:
//!
//! - after each [`receive`](Session::receive), [`resize`](Session::resize), [`tell`](Session::tell) and
//!   [`wake`](Session::wake): take [`asks`](Session::asks) and [`output`](Session::output);
//! - when the outbox is empty and [`is_due`](Session::is_due): [`draw`](Session::draw), and take the output;
//! - at [`wakes_at`](Session::wakes_at): [`wake`](Session::wake).
//!
//! A frame is drawn only while the terminal has answered the ones before and something on it has
//! changed. So a session of a client that does not read keeps one frame, and a visitor who does
//! nothing among others who do nothing costs no bytes.

mod news;

use std::time::Duration;

pub(crate) use self::news::{Ask, BoardRow, HostFacts, Identity, IdleLimits, News};
use super::room::RoomView;
use crate::terminal::{Options, Protocol, WindowSize};

/// The session of a visitor.
#[derive(Debug)]
pub(crate) struct Session {
    protocol: Protocol,
    identity: Identity,
    host: HostFacts,
    asks: Vec<Ask>,
    ending: Ending,
}

/// How far the session has ended.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Ending {
    /// It goes on.
    Not,
    /// The terminal is asked to answer all that was sent; then it shows this sentence.
    Asked(String),
    /// All is in the output.
    Over,
}

impl Session {
    /// A session with a terminal of which `options` are known.
    pub(crate) fn new(
        identity: Identity,
        options: Options,
        size: WindowSize,
        host: HostFacts,
        now: Duration,
    ) -> Self {
        let mut protocol = Protocol::new(options, size);
        protocol.begin(now);
        Self { protocol, identity, host, asks: Vec::new(), ending: Ending::Not }
    }

    /// Interprets bytes from the terminal. They may be cut at any place.
    pub(crate) fn receive(&mut self, bytes: &[u8], now: Duration) {
        self.protocol.receive(bytes, now);
        self.finish(now);
    }

    /// Records a new size of the window.
    pub(crate) fn resize(&mut self, size: WindowSize, now: Duration) {
        self.protocol.resize(size, now);
    }

    /// Records what the driver brings.
    pub(crate) fn tell(&mut self, news: News, now: Duration) {
        if let News::Ended(sentence) = news {
            self.end(sentence, now);
        }
    }

    /// Does what is due at `now` without bytes and news.
    pub(crate) fn wake(&mut self, now: Duration) {
        self.protocol.wake(now);
        self.finish(now);
    }

    /// What the session wants since the last call.
    pub(crate) fn asks(&mut self) -> Vec<Ask> {
        std::mem::take(&mut self.asks)
    }

    /// Whether to [`draw`](Self::draw) now, with `room` as the newest snapshot.
    pub(crate) fn is_due(&self, room: Option<&RoomView>, now: Duration) -> bool {
        self.due_at(room, now).is_some_and(|due| due <= now)
    }

    /// Adds a frame to the output.
    pub(crate) fn draw(&mut self, _room: Option<&RoomView>, now: Duration) {
        self.protocol.draw(|_| ());
        self.protocol.output(now);
    }

    /// The bytes to send. The driver takes all of them.
    pub(crate) fn output(&mut self, now: Duration) -> &mut Vec<u8> {
        self.protocol.output(now)
    }

    /// Records that all bytes so far have left.
    pub(crate) fn written(&mut self, now: Duration) {
        self.protocol.written(now);
    }

    /// The time at which to [`wake`](Self::wake) the session and to ask again whether a frame
    /// [is due](Self::is_due), if nothing happens before; `None` for never.
    pub(crate) fn wakes_at(&self, room: Option<&RoomView>, now: Duration) -> Option<Duration> {
        self.due_at(room, now).into_iter().chain(self.protocol.wakes_at()).min()
    }

    /// Sets the least time between two frames.
    pub(crate) fn set_frame_time(&mut self, frame_time: Duration) {
        self.host.frame_time = frame_time;
    }

    /// Whether the session has ended, and the connection may be closed after the output is sent.
    pub(crate) fn is_over(&self) -> bool {
        self.ending == Ending::Over
    }

    /// The time of the next frame; `None` if nothing has changed or the terminal is not ready.
    fn due_at(&self, _room: Option<&RoomView>, now: Duration) -> Option<Duration> {
        let is_changed = self.ending == Ending::Not && !self.protocol.is_settled();
        (is_changed && self.protocol.is_ready(now)).then_some(now)
    }

    /// Ends the session with a sentence.
    fn end(&mut self, sentence: String, now: Duration) {
        if self.ending == Ending::Not {
            self.protocol.end(now);
            self.ending = Ending::Asked(sentence);
        }
    }

    /// Gives the screen back once the terminal has answered all that it was asked.
    fn finish(&mut self, now: Duration) {
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
