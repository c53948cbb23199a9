//! A stay in the terminal, from taking it to giving it back.

mod options;

use std::collections::VecDeque;
use std::io::{self, Write};
use std::sync::Arc;
use std::time::{Duration, Instant};

use ratatui::{Frame, Terminal};

pub use self::options::Options;
use super::guard::Guard;
use super::input::{Answer, Decoder, Input};
use super::platform::{Device, Signal, Signals};
use super::{
    CellWriter, Detected, Error, Event, Key, KeyEvent, Phase, QuitReason, Recorder, WindowSize,
    sequence,
};
use crate::palette::ColorDepth;

/// The terminal, taken over: keys come in, frames go out.
///
/// While there is one, the terminal is in raw mode and shows its alternate screen without a cursor.
/// It is given back as it was found when the session is dropped, on a panic in any thread, and on
/// the signals that end a program. A process has one session at a time.
#[derive(Debug)]
pub struct Session {
    guard: Arc<Guard>,
    signals: Signals,
    terminal: Terminal<CellWriter<Output>>,
    decoder: Decoder,
    heard_at: Instant,
    events: VecDeque<Event>,
    size: WindowSize,
    color_depth: Detected,
    key_releases: KeyReleases,
}

/// Whether the terminal reports when keys are released.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum KeyReleases {
    Unasked,
    Asked,
    Settled,
}

impl Session {
    /// Takes the terminal, and asks it what it can do. The answers arrive as events; nothing waits
    /// for them.
    ///
    /// # Errors
    /// Where standard input or output is not a terminal, where the process has a session already,
    /// where the platform has no Unix terminals, and where the terminal cannot be written to.
    pub fn enter(options: Options) -> Result<Self, Error> {
        Self::enter_recorded(options, None)
    }

    /// As [`Session::enter`], and `recorder` takes note of everything that is sent.
    ///
    /// # Errors
    /// As [`Session::enter`].
    pub fn enter_recorded(
        options: Options,
        recorder: Option<Box<dyn Recorder>>,
    ) -> Result<Self, Error> {
        let guard = Guard::install(Device::open()?, recorder)?;
        Self::take(&guard, options).inspect_err(|_| guard.uninstall())
    }

    fn take(guard: &Arc<Guard>, options: Options) -> Result<Self, Error> {
        let signals =
            Signals::listen(guard).map_err(Error::while_doing("listening for signals"))?;
        let size = guard.device().size();
        guard.recording().resized(size.cells());
        let output = Output { guard: Arc::clone(guard) };
        let mut session = Self {
            guard: Arc::clone(guard),
            signals,
            terminal: Terminal::new(CellWriter::new(output, size.cells()))
                .map_err(Error::while_doing("preparing the first frame"))?,
            decoder: Decoder::default(),
            heard_at: Instant::now(),
            events: VecDeque::new(),
            size,
            color_depth: options.color_depth,
            key_releases: KeyReleases::Unasked,
        };
        guard.take().map_err(Error::while_doing("taking the terminal"))?;
        session.ask(options).map_err(Error::while_doing("asking the terminal what it can do"))?;
        Ok(session)
    }

    fn ask(&mut self, options: Options) -> io::Result<()> {
        let mut queries = String::new();
        if options.ask_for_key_releases {
            queries.push_str(sequence::QUERY_KEY_FLAGS);
            self.key_releases = KeyReleases::Asked;
        }
        if let Detected::Guess(_) = options.color_depth {
            queries.push_str(sequence::QUERY_TRUE_COLOR);
        }
        if queries.is_empty() { Ok(()) } else { self.guard.ask(&queries) }
    }

    /// Waits for an event, at most for `timeout`, or for ever; `None` where there was none.
    ///
    /// # Errors
    /// Where the terminal cannot be read, or a panic in another thread has given it back.
    pub fn next_event(&mut self, timeout: Option<Duration>) -> Result<Option<Event>, Error> {
        let deadline = timeout.and_then(|timeout| Instant::now().checked_add(timeout));
        loop {
            if let Some(event) = self.events.pop_front() {
                return Ok(Some(event));
            }
            if !self.guard.is_taken() {
                return Err(Error::given_back());
            }
            let gives_up_at = self.decoder.patience().map(|patience| self.heard_at + patience);
            let wake_at = deadline.into_iter().chain(gives_up_at).min();
            let is_past = |time: Option<Instant>| time.is_some_and(|time| time <= Instant::now());
            match self.receive(wake_at).map_err(Error::while_doing("reading keys"))? {
                Received::Nothing if is_past(gives_up_at) => self.stop_waiting_for_more(),
                Received::Nothing if is_past(deadline) => return Ok(None),
                Received::Nothing | Received::Something => {}
            }
        }
    }

    /// Draws a frame, and writes what has changed since the last one. A terminal that takes no bytes
    /// is waited for, unless a signal wants the program to end: then the frame is dropped, and the
    /// event that says so comes next.
    ///
    /// # Errors
    /// Where the terminal cannot be written to, or a panic in another thread has given it back.
    pub fn draw(&mut self, render: impl FnOnce(&mut Frame)) -> Result<(), Error> {
        match self.terminal.draw(render) {
            Ok(_) => Ok(()),
            // To report this on standard error could take for ever: it leads to the same terminal.
            Err(_) if self.guard.is_hurried() => Ok(()),
            Err(error) => Err(Error::while_doing("drawing a frame")(error)),
        }
    }

    /// Gives the terminal back, stops the program until the shell continues it, and takes the
    /// terminal again. Where no shell would continue it, only the screen is painted afresh.
    ///
    /// # Errors
    /// Where the terminal cannot be taken again.
    pub fn suspend(&mut self) -> Result<(), Error> {
        self.guard.give_back();
        self.decoder = Decoder::default();
        self.signals.stop_until_continued().map_err(Error::while_doing("stopping the program"))?;
        self.take_again()
    }

    fn take_again(&mut self) -> Result<(), Error> {
        self.guard.take().map_err(Error::while_doing("taking the terminal again"))?;
        self.repaint();
        Ok(())
    }

    /// The size of the window, and the shape of its cells.
    pub fn size(&self) -> WindowSize {
        self.size
    }

    /// How many colours the terminal shows, as far as is known by now.
    pub fn color_depth(&self) -> ColorDepth {
        self.color_depth.depth()
    }

    /// How many bytes all frames together have taken.
    pub fn bytes_written(&self) -> u64 {
        self.terminal.backend().bytes_written()
    }
}

/// Whether something arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Received {
    Something,
    Nothing,
}

/// What arrives, and what is made of it.
impl Session {
    fn receive(&mut self, wake_at: Option<Instant>) -> io::Result<Received> {
        let timeout = wake_at.map(|time| time.saturating_duration_since(Instant::now()));
        let ready = self.guard.device().wait(&self.signals, timeout)?;
        if ready.signals {
            self.receive_signals()?;
        }
        if ready.input {
            self.receive_input()?;
        }
        let something = ready.input || ready.signals;
        Ok(if something { Received::Something } else { Received::Nothing })
    }

    fn receive_signals(&mut self) -> io::Result<()> {
        for signal in self.signals.take() {
            match signal {
                Signal::Resized => self.repaint(),
                Signal::Suspend => self.events.push_back(Event::Suspend),
                Signal::Continued => {
                    // Stopped from outside, without a chance to give the terminal back.
                    self.guard.device().make_raw()?;
                    self.repaint();
                }
                Signal::Quit(reason) => self.events.push_back(Event::Quit(reason)),
            }
        }
        Ok(())
    }

    fn receive_input(&mut self) -> io::Result<()> {
        let mut buffer = [0; 1024];
        let Some(count) = self.guard.device().read(&mut buffer)? else { return Ok(()) };
        if count == 0 {
            self.events.push_back(Event::Quit(QuitReason::InputClosed));
            return Ok(());
        }
        self.heard_at = Instant::now();
        let mut inputs = Vec::new();
        self.decoder.feed(&buffer[..count], |input| inputs.push(input));
        inputs.into_iter().try_for_each(|input| self.take_input(input))
    }

    fn stop_waiting_for_more(&mut self) {
        let events = &mut self.events;
        self.decoder.give_up(|input| {
            // An answer is a whole unit, and never what is left of one.
            if let Input::Key(event) = input {
                events.push_back(meaning(event));
            }
        });
    }

    fn take_input(&mut self, input: Input) -> io::Result<()> {
        match input {
            Input::Key(event) => self.events.push_back(meaning(event)),
            Input::Answer(Answer::KeyFlags) => self.settle_key_releases(true)?,
            Input::Answer(Answer::TrueColor) => self.raise_color_depth(),
            Input::Answer(Answer::Fence) => {
                self.guard.fence_answered();
                self.settle_key_releases(false)?;
            }
        }
        Ok(())
    }

    fn settle_key_releases(&mut self, agreed: bool) -> io::Result<()> {
        if self.key_releases == KeyReleases::Asked {
            self.key_releases = KeyReleases::Settled;
            if agreed {
                self.guard.push_key_flags()?;
            }
            self.events.push_back(Event::KeyReleases(agreed));
        }
        Ok(())
    }

    fn raise_color_depth(&mut self) {
        if let Detected::Guess(_) = self.color_depth {
            self.color_depth = Detected::Certain(ColorDepth::True);
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
        }
    }

    /// The next frame is drawn from nothing, in the size that the window has now.
    fn repaint(&mut self) {
        let size = self.guard.device().size();
        if size.cells() != self.size.cells() {
            self.guard.recording().resized(size.cells());
        }
        self.size = size;
        let writer = self.terminal.backend_mut();
        writer.forget();
        writer.set_size(self.size.cells());
        // Nothing is written before the next frame, so nothing can fail yet.
        _ = self.terminal.clear();
        if self.events.back() != Some(&Event::Resized) {
            self.events.push_back(Event::Resized);
        }
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.guard.uninstall();
    }
}

/// What a key means to every program: raw mode leaves to us what the terminal would have done.
fn meaning(event: KeyEvent) -> Event {
    let pressed = event.phase == Phase::Press && event.modifiers.control && !event.modifiers.alt;
    match event.key {
        Key::Char('c') if pressed => Event::Quit(QuitReason::Interrupted),
        Key::Char('z') if pressed => Event::Suspend,
        _ => Event::Key(event),
    }
}

/// Where frames go: to the terminal, for as long as it is taken.
#[derive(Debug)]
struct Output {
    guard: Arc<Guard>,
}

impl Write for Output {
    /// Writes everything.
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.guard.write(bytes).map(|()| bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
