//! A session: the time from taking the terminal to giving it back.

mod extensions;
mod options;
mod receive;
mod show;

use std::collections::VecDeque;
use std::io;
use std::sync::Arc;
use std::time::{Duration, Instant};

use self::extensions::Extensions;
pub use self::options::Options;
use self::receive::Received;
use super::flow::{Flow, Request};
use super::guard::Guard;
use super::input::Decoder;
use super::mouse::MouseUnits;
use super::platform::{Device, Signals};
use super::{
    CellWriter, ColorSource, Detected, Error, Event, Fidelity, Recorder, WindowSize, sequence,
};
use crate::color::palette::ColorDepth;

/// A terminal in use by the program: it delivers keys and shows frames.
///
/// During a session, the terminal is in raw mode and shows its alternate screen without a cursor.
/// Its previous state is restored when the session is dropped, on a panic in any thread, and on the
/// signals that end a program. A process has one session at a time.
#[derive(Debug)]
pub struct Session {
    guard: Arc<Guard>,
    signals: Signals,
    /// The session sends the bytes that it writes.
    writer: CellWriter<Vec<u8>>,
    decoder: Decoder,
    received_at: Instant,
    events: VecDeque<Event>,
    size: WindowSize,
    color_depth: Detected,
    color_source: ColorSource,
    key_releases: KeyReleases,
    mouse: Mouse,
    begun_at: Instant,
    flow: Flow,
    /// `None` for the best fidelity that the link allows.
    fidelity: Option<Fidelity>,
    is_remote: bool,
    /// Whether to report when a frame may be sent.
    awaits_readiness: bool,
    extensions: Extensions,
}

/// The state of mouse reports.
#[derive(Clone, Copy, Debug, Default)]
struct Mouse {
    /// The unit of positions; `None` if the mouse is not reported.
    units: Option<MouseUnits>,
    /// Whether the terminal can report positions in pixels.
    has_pixels: bool,
    /// Whether reports may still be in the previous unit.
    is_changing: bool,
}

/// Whether the terminal reports when keys are released.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum KeyReleases {
    Unasked,
    Asked,
    Settled,
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

    fn take(guard: &Arc<Guard>, options: Options) -> Result<Self, Error> {
        let signals =
            Signals::listen(guard).map_err(Error::while_doing("listening for signals"))?;
        let size = guard.device().size();
        guard.recording().resized(size.cells());
        let mut session = Self {
            guard: Arc::clone(guard),
            signals,
            writer: CellWriter::new(Vec::new(), size.cells()),
            decoder: Decoder::default(),
            received_at: Instant::now(),
            events: VecDeque::new(),
            size,
            color_depth: options.color_depth,
            color_source: options.color_source,
            key_releases: KeyReleases::Unasked,
            mouse: Mouse::default(),
            begun_at: Instant::now(),
            flow: Flow::new(options.is_remote),
            fidelity: options.fidelity,
            is_remote: options.is_remote,
            awaits_readiness: false,
            extensions: Extensions::default(),
        };
        session.writer.set_ascii(options.is_ascii);
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
        if options.ask_for_mouse_pixels {
            queries.push_str(sequence::QUERY_MOUSE_PIXELS);
        }
        if matches!(options.color_depth, Detected::Guess(_)) && options.ask_for_version {
            queries.push_str(sequence::QUERY_VERSION);
        }
        if options.probe_extensions && !options.is_ascii && !self.guard.recording().is_on() {
            self.probe_extensions(&mut queries);
        }
        // A terminal that does not understand a query may print a part of it.
        queries.push_str(sequence::ERASE);
        // As after a frame: if the fence is answered first, no answer to this request will arrive.
        queries.push_str(sequence::QUERY_STATUS);
        self.flow.sent(self.now(), 0, Request::Status);
        self.send_queries(&queries)
    }

    /// Waits for an event, for `timeout` at most; without a timeout, for ever. Returns `None` if no
    /// event arrived.
    ///
    /// # Errors
    /// If the terminal cannot be read, or a panic in another thread has given it back.
    pub fn next_event(&mut self, timeout: Option<Duration>) -> Result<Option<Event>, Error> {
        let deadline = timeout.and_then(|timeout| Instant::now().checked_add(timeout));
        loop {
            if let Some(event) = self.events.pop_front() {
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
            let gives_up_at = self.decoder.patience().map(|patience| self.received_at + patience);
            let opens_at = if self.awaits_readiness { self.opens_at() } else { None };
            let wake_at = deadline.into_iter().chain(gives_up_at).chain(opens_at).min();
            let is_past = |time: Option<Instant>| time.is_some_and(|time| time <= Instant::now());
            match self.receive(wake_at).map_err(Error::while_doing("reading keys"))? {
                Received::Nothing if is_past(gives_up_at) => self.stop_waiting_for_more(),
                Received::Nothing if is_past(deadline) => return Ok(None),
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
        if self.mouse.units.is_some() == is_reported {
            return Ok(());
        }
        self.mouse.units = is_reported.then(|| self.mouse_units());
        self.mouse.is_changing = false;
        let changed = self.guard.set_mouse(self.mouse.units);
        changed.map_err(Error::while_doing("setting up the mouse"))
    }

    /// The finest unit in which the terminal reports positions.
    fn mouse_units(&self) -> MouseUnits {
        if self.mouse.has_pixels && self.size.pixels.is_some() {
            MouseUnits::Pixels
        } else {
            MouseUnits::Cells
        }
    }

    /// Gives the terminal back, stops the program until the shell continues it, and takes the
    /// terminal again. If there is no shell to continue the program, this only repaints the screen.
    ///
    /// # Errors
    /// If the terminal cannot be taken again.
    pub fn suspend(&mut self) -> Result<(), Error> {
        self.guard.give_back();
        self.flow.forget();
        self.decoder = Decoder::default();
        self.mouse.is_changing = false;
        self.signals.stop_until_continued().map_err(Error::while_doing("stopping the program"))?;
        self.take_again()
    }

    fn take_again(&mut self) -> Result<(), Error> {
        self.guard.take().map_err(Error::while_doing("taking the terminal again"))?;
        self.repaint();
        Ok(())
    }

    /// The size of the window in cells, and in pixels if it is known.
    pub fn size(&self) -> WindowSize {
        self.size
    }

    /// The number of colours that the terminal shows, as far as it is known.
    pub fn color_depth(&self) -> ColorDepth {
        self.color_depth.depth()
    }

    /// The source of [`Session::color_depth`].
    pub fn color_source(&self) -> ColorSource {
        self.color_source
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        self.guard.uninstall();
    }
}
