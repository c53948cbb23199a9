//! A session: the time from taking the terminal to giving it back.
//!
//! It connects a [`Protocol`] with the terminal of the process, a clock and signals.

mod receive;
mod show;

use std::io;
use std::mem;
use std::sync::Arc;
use std::time::Duration;

use self::receive::Received;
use super::TmuxClient;
use super::guard::Guard;
use super::platform::{Device, Signals};
use super::tmux::{Reply, Request};
use super::{ColorSource, Error, Event, Options, Protocol, Recorder, WindowSize};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::tui::GlyphSet;

/// A terminal in use by the program: it delivers keys and shows frames.
///
/// During a session, the terminal is in raw mode and shows its alternate screen without a cursor.
/// Its previous state is restored when the session is dropped, on a panic in any thread, and on the
/// signals that end a program, except those that cannot be caught and those that report a fault of
/// the program. Such a signal has its own effect afterwards, also if the program handles it itself. A
/// process has one session at a time.
#[derive(Debug)]
pub struct Session {
    guard: Arc<Guard>,
    signals: Signals,
    protocol: Protocol,
    /// Whether to report when a frame may be sent.
    awaits_readiness: bool,
    /// Whether the program runs in tmux, and the requests to it without an answer.
    is_in_tmux: bool,
    tmux: Option<Request<TmuxClient>>,
    tmux_remedy: Option<Request<()>>,
    last_key_at: Duration,
}

impl Session {
    /// Takes the terminal and queries its capabilities. The answers arrive as events; this function
    /// does not wait for them.
    ///
    /// # Errors
    /// If standard input or output is not a terminal, if the terminal cannot move its cursor, if
    /// the process already has a session, if the platform has no Unix terminals, and if a write to
    /// the terminal fails.
    pub fn enter(options: Options) -> Result<Self, Error> {
        Self::enter_recorded(options, None)
    }

    /// Begins a session as [`Session::enter`] does; `recorder` receives all sent bytes.
    ///
    /// # Errors
    /// As [`Session::enter`].
    pub fn enter_recorded(
        options: Options,
        recorder: Option<Box<dyn Recorder>>,
    ) -> Result<Self, Error> {
        let device = Device::open()?;
        if let Some(term) = options.teletype {
            return Err(Error::teletype(term));
        }
        let guard = Guard::install(device, recorder)?;
        Self::take(&guard, options).inspect_err(|_| guard.uninstall())
    }

    fn take(guard: &Arc<Guard>, mut options: Options) -> Result<Self, Error> {
        let signals =
            Signals::listen(guard).map_err(Error::while_doing("listening for signals"))?;
        let size = guard.device().size();
        guard.recording().resized(size.cells());
        // A recording must play on any terminal.
        options.probe_extensions &= !guard.recording().is_on();
        let protocol = Protocol::new(options, size);
        let mut session = Self {
            guard: Arc::clone(guard),
            signals,
            protocol,
            awaits_readiness: false,
            is_in_tmux: options.ask_tmux,
            tmux: None,
            tmux_remedy: None,
            last_key_at: Duration::ZERO,
        };
        guard.take().map_err(Error::while_doing("taking the terminal"))?;
        session.protocol.begin(guard.now());
        session.send().map_err(Error::while_doing("asking the terminal what it can do"))?;
        session.ask_tmux();
        Ok(session)
    }

    /// Waits for an event, for `timeout` at most; without a timeout, for ever. Returns `None` if no
    /// event arrived.
    ///
    /// # Errors
    /// If the terminal cannot be read, or a panic in another thread has given it back.
    pub fn next_event(&mut self, timeout: Option<Duration>) -> Result<Option<Event>, Error> {
        let deadline = timeout.and_then(|timeout| self.guard.now().checked_add(timeout));
        loop {
            self.take_tmux_replies();
            if let Some(event) = self.protocol.next_event() {
                if self.may_have_another_client(event) {
                    self.ask_tmux();
                }
                return Ok(Some(event));
            }
            if self.awaits_readiness {
                self.probe().map_err(Error::while_doing("asking whether the terminal is there"))?;
                if self.is_ready() {
                    return Ok(Some(Event::Ready));
                }
            }
            if !self.guard.is_taken() {
                return Err(Error::given_back());
            }
            let gives_up_at = self.protocol.gives_up_at();
            let opens_at = if self.awaits_readiness { self.opens_at() } else { None };
            let wake_at = deadline.into_iter().chain(gives_up_at).chain(opens_at);
            let awaits_tmux = self.tmux.is_some() || self.tmux_remedy.is_some();
            let tmux_at = awaits_tmux.then(|| self.guard.now() + TMUX_POLL);
            let wake_at = wake_at.chain(tmux_at).min();
            let now = |session: &Self| session.guard.now();
            match self.receive(wake_at).map_err(Error::while_doing("reading keys"))? {
                Received::Nothing if is_past(gives_up_at, now(self)) => self.protocol.give_up(),
                Received::Nothing if is_past(deadline, now(self)) => return Ok(None),
                Received::Nothing | Received::Something => {}
            }
        }
    }

    /// Sets whether the mouse is reported, which it is not at first. Positions are in pixels if the
    /// terminal can report them.
    ///
    /// # Errors
    /// If a write to the terminal fails.
    pub fn set_mouse(&mut self, is_reported: bool) -> Result<(), Error> {
        self.protocol.set_mouse(is_reported);
        self.send().map_err(Error::while_doing("setting up the mouse"))
    }

    /// Gives the terminal back, stops the program until the shell continues it, and takes the
    /// terminal again. If there is no shell to continue the program, this only repaints the screen.
    ///
    /// # Errors
    /// If the terminal cannot be taken again.
    pub fn suspend(&mut self) -> Result<(), Error> {
        self.guard.give_back();
        self.protocol.interrupt();
        self.signals.stop_until_continued().map_err(Error::while_doing("stopping the program"))?;
        self.take_again().map_err(Error::while_doing("taking the terminal again"))
    }

    /// Asks tmux about the terminal around it, unless a question is open.
    fn ask_tmux(&mut self) {
        if self.is_in_tmux && self.tmux.is_none() {
            self.tmux = Some(Request::client());
        }
    }

    /// Runs [`TmuxClient::remedy`] in the tmux around the program. [`Event::TmuxTold`] follows.
    pub fn tell_tmux(&mut self) {
        self.tmux_remedy = self.tmux_client().and_then(Request::remedy);
        if self.tmux_remedy.is_none() {
            self.protocol.push_event(Event::TmuxTold(false));
        }
    }

    /// Whether `event` may come from a client of tmux that has just attached.
    fn may_have_another_client(&mut self, event: Event) -> bool {
        match event {
            Event::FocusGained | Event::Resized => true,
            Event::Key(_) => {
                let now = self.guard.now();
                let last = mem::replace(&mut self.last_key_at, now);
                now.saturating_sub(last) >= TIME_TO_ATTACH
            }
            _ => false,
        }
    }

    fn take_tmux_replies(&mut self) {
        match self.tmux.as_ref().map_or(Reply::Pending, Request::reply) {
            Reply::Pending => {}
            Reply::Answer(client) => {
                self.tmux = None;
                self.protocol.take_tmux_client(client);
            }
            Reply::Nothing => self.tmux = None,
        }
        let has_worked = match self.tmux_remedy.as_ref().map_or(Reply::Pending, Request::reply) {
            Reply::Pending => return,
            Reply::Answer(()) => true,
            Reply::Nothing => false,
        };
        self.tmux_remedy = None;
        self.protocol.push_event(Event::TmuxTold(has_worked));
    }

    fn take_again(&mut self) -> io::Result<()> {
        self.guard.take()?;
        let size = self.measured();
        self.protocol.begin_again(size);
        self.send()
    }

    /// The present size of the window, which the recorder learns, too.
    fn measured(&self) -> WindowSize {
        let size = self.guard.device().size();
        if size.cells() != self.protocol.size().cells() {
            self.guard.recording().resized(size.cells());
        }
        size
    }

    /// The size of the window in cells, and in pixels if it is known.
    pub fn size(&self) -> WindowSize {
        self.protocol.size()
    }

    /// The number of colours that the terminal shows, as far as it is known.
    pub fn color_depth(&self) -> ColorDepth {
        self.protocol.color_depth()
    }

    /// The source of [`Session::color_depth`].
    pub fn color_source(&self) -> ColorSource {
        self.protocol.color_source()
    }

    /// The finest block glyphs that the terminal is known to draw.
    pub fn glyph_support(&self) -> GlyphSet {
        // A recording must play on any terminal.
        if self.guard.recording().is_on() {
            return GlyphSet::Half;
        }
        self.protocol.glyph_support()
    }

    /// How the terminal draws shades, as far as it is known.
    pub fn shade_ink(&self) -> ShadeInk {
        self.protocol.shade_ink()
    }

    /// Whether the terminal has answered that it is tmux.
    pub fn is_tmux(&self) -> bool {
        self.protocol.is_tmux()
    }

    /// The client of the tmux in which the program runs, if that has answered.
    pub fn tmux_client(&self) -> Option<&TmuxClient> {
        self.protocol.tmux_client()
    }
}

/// The time between looks for an answer of tmux.
const TMUX_POLL: Duration = Duration::from_millis(10);
/// The least time without a key while somebody detaches and attaches again.
const TIME_TO_ATTACH: Duration = Duration::from_secs(1);

fn is_past(time: Option<Duration>, now: Duration) -> bool {
    time.is_some_and(|time| time <= now)
}

impl Drop for Session {
    fn drop(&mut self) {
        self.guard.uninstall();
    }
}
