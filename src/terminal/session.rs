//! A session: the time from taking the terminal to giving it back.
//!
//! It connects a [`Protocol`] with the terminal of the process, a clock and signals.

use std::sync::Arc;
use std::task::Poll;
use std::time::Duration;
use std::{io, mem};

use super::error::TerminalErrorKind;
use super::guard::TerminalGuard;
use super::signals::{Signal, Signals};
use super::tmux::TmuxCommand;
use super::unix::Device;
use super::{
    Error, Event, Protocol, QuitReason, Recorder, Screen, SessionOptions, TmuxClient, WindowSize,
};
use crate::tui::GlyphSet;

/// A terminal in use by the program: it delivers keys and shows frames.
///
/// During a session, the terminal is in raw mode and shows its alternate screen without a cursor. Its
/// previous state is restored when the session is dropped, on a panic in any thread, and on the signals that
/// end a program. Exceptions are signals that cannot be caught, and signals that report a fault of the
/// program. After the restoration, the signal has its own effect, even if the program handles it itself. A
/// process has one session at a time.
#[derive(Debug)]
pub struct Session {
    guard: Arc<TerminalGuard>,
    signals: Signals,
    protocol: Protocol,
    /// Whether to report when a frame may be sent.
    awaits_readiness: bool,
    /// Whether the program runs in tmux. The next two fields are unanswered requests to tmux.
    is_in_tmux: bool,
    tmux: Option<TmuxCommand<TmuxClient>>,
    tmux_remedy: Option<TmuxCommand<()>>,
    last_key_at: Duration,
}

impl Session {
    /// Takes the terminal and queries its capabilities. The answers arrive as events; this function
    /// does not wait for them.
    ///
    /// # Errors
    /// If standard input or output is not a terminal, if the terminal cannot move its cursor, if the process
    /// already has a session, if the platform has no Unix terminals, or if a write to the terminal fails.
    pub fn enter(options: SessionOptions) -> Result<Self, Error> {
        Self::enter_recorded(options, None)
    }

    /// Begins a session like [`Session::enter`]. `recorder` receives all sent bytes.
    ///
    /// # Errors
    /// As [`Session::enter`].
    pub fn enter_recorded(
        options: SessionOptions,
        recorder: Option<Box<dyn Recorder>>,
    ) -> Result<Self, Error> {
        let device = Device::open()?;
        if let Some(term) = options.teletype {
            return Err(TerminalErrorKind::Teletype { term }.into());
        }
        let guard = TerminalGuard::install(device, recorder)?;
        Self::take(&guard, options).inspect_err(|_| guard.uninstall())
    }

    /// Waits for an event, for at most `timeout`, or forever without one. Returns `None` if no event has
    /// arrived.
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
                self.probe().map_err(Error::while_doing("checking the terminal"))?;
                if self.is_ready() {
                    return Ok(Some(Event::Ready));
                }
            }
            if !self.guard.is_taken() {
                return Err(TerminalErrorKind::GivenBack.into());
            }
            let gives_up_at = self.protocol.gives_up_at();
            let opens_at = if self.awaits_readiness { self.opens_at() } else { None };
            let wake_at = deadline.into_iter().chain(gives_up_at).chain(opens_at);
            let awaits_tmux = self.tmux.is_some() || self.tmux_remedy.is_some();
            let tmux_at = awaits_tmux.then(|| self.guard.now() + TMUX_POLL_INTERVAL);
            let wake_at = wake_at.chain(tmux_at).min();
            if self.receive(wake_at).map_err(Error::while_doing("reading keys"))? {
                continue;
            }
            let now = self.guard.now();
            if is_past(gives_up_at, now) {
                self.protocol.give_up();
            } else if is_past(deadline, now) {
                return Ok(None);
            }
        }
    }

    /// Turns reports of the mouse on or off. They are off at first. Positions are in pixels if the terminal
    /// can report them.
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

    /// The protocol of the session, with the known properties of the terminal and of the link, and counts of
    /// frames.
    pub fn protocol(&self) -> &Protocol {
        &self.protocol
    }

    /// Runs [`TmuxClient::remedy`] in the tmux around the program. [`Event::TmuxTold`] reports the outcome.
    pub fn tell_tmux(&mut self) {
        self.tmux_remedy = self.protocol.tmux_client().and_then(TmuxCommand::remedy);
        if self.tmux_remedy.is_none() {
            self.protocol.push_event(Event::TmuxTold(false));
        }
    }

    /// The finest block glyphs that the terminal is known to draw.
    pub fn glyph_support(&self) -> GlyphSet {
        // A recording must play on any terminal.
        if self.guard.is_recorded() {
            return GlyphSet::Half;
        }
        self.protocol.glyph_support()
    }

    /// Draws a frame on a blank screen and sends the changes since the last one. Waits until the terminal is
    /// [ready](Self::is_ready) for it. If the program must end during the wait, the frame is dropped and the
    /// next event reports the end.
    ///
    /// # Errors
    /// If a write to the terminal fails, or a panic in another thread has given the terminal back.
    pub fn draw(&mut self, render: impl FnOnce(&mut Screen)) -> Result<(), Error> {
        self.send_frame(|protocol| protocol.draw(render))
    }

    /// Shows the last frame more exactly, unless it is exact. Waits as [`Session::draw`] does.
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn refine(&mut self) -> Result<(), Error> {
        self.send_frame(Protocol::refine)
    }

    /// Rings the terminal's bell with the next frame.
    pub fn ring_bell(&mut self) {
        self.protocol.ring_bell();
    }

    /// Returns true if a frame would be shown at once, not behind other frames in flight. If not,
    /// [`Event::Ready`](crate::terminal::Event::Ready) follows.
    pub fn is_ready(&mut self) -> bool {
        let is_ready = self.may_send();
        self.awaits_readiness = !is_ready;
        is_ready
    }

    /// Returns true if an event for which `is_such` holds has arrived and has not been returned yet. Does
    /// not wait. Also returns true after an error, which [`Session::next_event`] then returns.
    pub fn has_event(&mut self, is_such: impl Fn(&Event) -> bool) -> bool {
        self.receive(Some(Duration::ZERO)).is_err() || self.protocol.has_event(is_such)
    }

    fn take(guard: &Arc<TerminalGuard>, mut options: SessionOptions) -> Result<Self, Error> {
        let signals =
            Signals::listen(guard).map_err(Error::while_doing("listening for signals"))?;
        let size = guard.device.size();
        guard.record(|recorder| recorder.resized(size.cells()));
        // A recording must play on any terminal.
        options.probe_extensions &= !guard.is_recorded();
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
        session.send().map_err(Error::while_doing("querying the terminal"))?;
        session.ask_tmux();
        Ok(session)
    }

    /// Asks tmux about the terminal around it, unless a request is open.
    fn ask_tmux(&mut self) {
        if self.is_in_tmux && self.tmux.is_none() {
            self.tmux = Some(TmuxCommand::client());
        }
    }

    /// Returns true if `event` may come from a client of tmux that has just attached.
    fn may_have_another_client(&mut self, event: Event) -> bool {
        match event {
            Event::FocusGained | Event::Resized => true,
            Event::Key(_) => {
                let now = self.guard.now();
                let last = mem::replace(&mut self.last_key_at, now);
                now.saturating_sub(last) >= MIN_ATTACH_PAUSE
            }
            _ => false,
        }
    }

    fn take_tmux_replies(&mut self) {
        if let Some(Poll::Ready(client)) = self.tmux.as_ref().map(TmuxCommand::reply) {
            self.tmux = None;
            if let Some(client) = client {
                self.protocol.take_tmux_client(client);
            }
        }
        if let Some(Poll::Ready(done)) = self.tmux_remedy.as_ref().map(TmuxCommand::reply) {
            self.tmux_remedy = None;
            self.protocol.push_event(Event::TmuxTold(done.is_some()));
        }
    }

    fn take_again(&mut self) -> io::Result<()> {
        self.guard.take()?;
        let size = self.measured();
        self.protocol.begin_again(size);
        self.send()
    }

    /// The current size of the window. If it has changed, the recorder receives it, too.
    fn measured(&self) -> WindowSize {
        let size = self.guard.device.size();
        if size.cells() != self.protocol.size().cells() {
            self.guard.record(|recorder| recorder.resized(size.cells()));
        }
        size
    }

    /// Sends the frame that `draw` draws, once the terminal is ready for it.
    fn send_frame(&mut self, draw: impl FnOnce(&mut Protocol)) -> Result<(), Error> {
        let sent = self.wait_until_ready().and_then(|is_ready| {
            if !is_ready {
                return Ok(());
            }
            draw(&mut self.protocol);
            self.send()
        });
        match sent {
            // Standard error leads to the same terminal, which may never accept a message.
            Err(_) if self.guard.is_shutting_down() => Ok(()),
            sent => sent.map_err(Error::while_doing("drawing a frame")),
        }
    }

    /// Waits until a frame may be sent. Returns `false` if the program must end instead.
    fn wait_until_ready(&mut self) -> io::Result<bool> {
        while !self.may_send() {
            if self.is_ending() {
                return Ok(false);
            }
            self.probe()?;
            self.receive(self.opens_at())?;
        }
        Ok(true)
    }

    /// Returns true if the program has been asked to end.
    fn is_ending(&self) -> bool {
        self.guard.is_shutting_down() || self.protocol.is_asked_to_quit()
    }

    fn may_send(&self) -> bool {
        self.guard.has_written_all() && self.protocol.is_ready(self.guard.now())
    }

    /// The time at which to check again whether a frame may be sent, even without an event before. `None`
    /// means never.
    fn opens_at(&self) -> Option<Duration> {
        let ready_at = self.protocol.ready_at(self.guard.now());
        let times = self.protocol.opens_at().into_iter().chain(ready_at);
        if self.guard.has_written_all() { times.min() } else { None }
    }

    /// Sends a fence alone after a timeout, to find out whether the terminal is still there.
    fn probe(&mut self) -> io::Result<()> {
        if self.guard.has_written_all() {
            self.protocol.probe(self.guard.now());
            self.send()?;
        }
        Ok(())
    }

    /// Sends the output of the protocol, as far as the terminal accepts it at once.
    fn send(&mut self) -> io::Result<()> {
        let now = self.guard.now();
        self.protocol.queue_frame(now);
        let changes = self.protocol.changes();
        let output = self.protocol.output(now);
        if output.is_empty() {
            self.guard.set_changes(changes);
            return Ok(());
        }
        let written = self.guard.write(output, changes);
        output.clear();
        written?;
        self.update_written();
        Ok(())
    }

    fn update_written(&mut self) {
        if self.guard.has_written_all() {
            self.protocol.written(self.guard.now());
        }
    }

    /// Waits until `wake_at` for input, signals, or room for bytes. Returns true if any of them arrived.
    fn receive(&mut self, wake_at: Option<Duration>) -> io::Result<bool> {
        let timeout = wake_at.map(|time| time.saturating_sub(self.guard.now()));
        let has_queued = !self.guard.has_written_all();
        let ready = self.guard.device.wait(&self.signals, has_queued, timeout)?;
        if ready.signals {
            self.receive_signals()?;
        }
        if ready.input {
            self.receive_input()?;
        }
        if ready.output && !self.is_ending() {
            self.guard.write_queued()?;
            self.update_written();
        }
        Ok(ready.input || ready.signals || ready.output)
    }

    fn receive_signals(&mut self) -> io::Result<()> {
        for signal in self.signals.take() {
            match signal {
                Signal::Resized => {
                    let size = self.measured();
                    self.protocol.resize(size, self.guard.now());
                }
                Signal::Suspend => self.protocol.push_event(Event::Suspend),
                Signal::Continued => {
                    // SIGSTOP cannot be caught, so the terminal was not given back.
                    self.guard.device.make_raw()?;
                    let size = self.measured();
                    self.protocol.repaint(size);
                }
                Signal::Quit(reason) => self.protocol.push_event(Event::Quit(reason)),
            }
        }
        self.send()
    }

    fn receive_input(&mut self) -> io::Result<()> {
        let mut buffer = [0; 1024];
        let Some(count) = self.guard.read(&mut buffer)? else { return Ok(()) };
        if count == 0 {
            self.protocol.push_event(Event::Quit(QuitReason::InputClosed));
            return Ok(());
        }
        self.protocol.receive(&buffer[..count], self.guard.now());
        self.send()
    }
}

/// The time between two checks for an answer from tmux.
const TMUX_POLL_INTERVAL: Duration = Duration::from_millis(10);
/// The minimum time without a key while somebody detaches from tmux and attaches again.
const MIN_ATTACH_PAUSE: Duration = Duration::from_secs(1);

fn is_past(time: Option<Duration>, now: Duration) -> bool {
    time.is_some_and(|time| time <= now)
}

impl Drop for Session {
    fn drop(&mut self) {
        self.guard.uninstall();
    }
}
