//! The main loop, which has a terminal and a clock.
//!
//! It sleeps until a key, a signal or the next frame is due. While nothing moves there is no next
//! frame, so that nothing is computed or written.
//!
//! The time comes from the machine's clock. For tests, a debug build has another one: if the environment
//! variable `CELLCASTER_CLOCK` is `focus`, time stands still until the terminal reports that the
//! window has the focus, and each such report is one step of the game. What happens is then a
//! function of the bytes that the program reads, on a machine under any load. Bytes, keys, screens
//! and the terminal are the same under both clocks.
//!
//! A report of the focus has no other effect, and every terminal can send it. Rejected: time as a private
//! sequence, which the decoder would have to know; and time from a file or a socket, which would have no
//! order with the keys.

use std::env;
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use crate::app::App;
use crate::app::draw::Rendered;
use crate::app::levels::Levels;
use crate::app::picture::TerminalLook;
use crate::app::recording::Recording;
use crate::app::settings::Settings;
use crate::app::stats::Meter;
use crate::app::store::Store;
use crate::app::title::Offers;
#[cfg(debug_assertions)]
use crate::terminal::Key;
use crate::terminal::{Detected, Error, Event, Options, Session, locale_without_utf8};
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

/// The way in which the program begins.
#[derive(Debug)]
pub enum Opening {
    /// The title screen, with these offers.
    Title(Offers),
    /// The daily run, and then the title.
    Daily(Offers),
    /// An endless descent, and then the title.
    Endless(Offers),
    /// A game, without a title to return to.
    Levels(Box<Levels>),
}

/// Begins with `opening` on the terminal, plays until the player leaves or the program is ended from outside, and
/// makes the recordings in `recording`.
///
/// # Errors
/// If there is no terminal, or if it fails.
pub fn play(
    opening: Opening,
    settings: Settings,
    store: Store,
    recording: Recording,
) -> Result<Farewell, Error> {
    let settings = settings.preferring(&store.preferences());
    let mut options = Options::from_environment(|name| env::var(name).ok());
    if let Some(depth) = settings.depth {
        options.color_depth = Detected::Certain(depth);
    }
    options.fidelity = settings.fidelity;
    let ascii_locale = ascii_locale(settings.glyphs);
    options.is_ascii = ascii_locale.is_some();
    let mut session = Session::enter_recorded(options, recording.terminal)?;
    let mut presenter = Presenter::new(settings.frame_time);
    let mut app = App::opened(opening, settings, store);
    app.script = recording.script;
    app.detection.ascii_locale = ascii_locale;
    app.detection.reports_releases = (!options.ask_for_key_releases).then_some(false);
    update_terminal(&mut app, &session);
    let time = Time::begin();
    app.machine_time = time.of_machine();
    while !app.has_left {
        app.advance(time.now());
        app.reload(time.now());
        session.set_mouse(app.pointer.is_on())?;
        if app.watch.take_ring() && app.store.preferences().bell {
            session.ring_bell();
        }
        if app.take_tmux_order() {
            session.tell_tmux();
        }
        presenter.frame_time = app.settings.frame_time;
        presenter.update(&mut app, &mut session, time.now())?;
        let wakes_at = presenter.wakes_at(&app, &session, time.now());
        let timeout = wakes_at.and_then(|wakes| time.until(wakes));
        match session.next_event(timeout)? {
            None | Some(Event::Ready) => {}
            Some(Event::FocusGained) => {
                #[cfg(debug_assertions)]
                time.focus_reported();
            }
            Some(Event::Key(event)) => {
                #[cfg(debug_assertions)]
                panic_on_demand(event.key);
                app.key(event, time.now());
            }
            Some(Event::Mouse(event)) => app.mouse(event, time.now()),
            Some(Event::FocusLost) => app.focus_lost(time.now()),
            Some(Event::Resized | Event::ColorDepth(_) | Event::Identified) => {
                update_terminal(&mut app, &session);
            }
            Some(Event::KeyReleases(reported)) => {
                app.controls.held.set_reports_releases(reported);
                app.detection.reports_releases = Some(reported);
            }
            Some(Event::TmuxTold(has_worked)) => app.tmux_told(has_worked),
            Some(Event::Suspend) => {
                session.suspend()?;
                app.resumed(time.now());
            }
            Some(Event::Quit(_)) => break,
        }
    }
    _ = app.leave_game();
    let trouble = app.store.trouble().map(str::to_owned);
    Ok(Farewell { done: app.left, trouble })
}

/// The lines that are printed after the terminal has been given back.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Farewell {
    /// A line about what was done; `None` if nothing was.
    pub done: Option<String>,
    /// A sentence about what is damaged or could not be kept.
    pub trouble: Option<String>,
}

/// Shows the newest state of the game, at most at the given frame rate and only when the terminal
/// is ready.
struct Presenter {
    frame_time: Duration,
    next_frame: Duration,
    /// Whether a frame is due and the terminal is not ready; it will report when it is.
    waits: bool,
    /// Whether a frame was possible at the last look, and there was nothing to show.
    is_idle: bool,
    meter: Meter,
}

impl Presenter {
    fn new(frame_time: Duration) -> Self {
        let meter = Meter::default();
        Self { frame_time, next_frame: Duration::ZERO, waits: false, is_idle: false, meter }
    }

    /// Draws or refines a frame, if one is due, and unless an event comes first.
    fn update(&mut self, app: &mut App, session: &mut Session, now: Duration) -> Result<(), Error> {
        let may_be_due = now >= self.next_frame;
        let is_due = may_be_due && is_unfinished(app, session);
        self.is_idle = may_be_due && !is_due;
        self.waits = is_due && !session.is_ready();
        if !is_due || self.waits {
            return Ok(());
        }
        if app.is_stale() {
            let window = session.protocol().size().cells();
            let rendered =
                app.render_unless(window, &mut |comes_first| session.has_event(comes_first));
            if rendered == Rendered::Interrupted {
                return Ok(());
            }
            session.draw(|screen| {
                // The window may have changed during a wait for the terminal.
                if screen.bounds().as_size() != window {
                    app.render(screen.bounds().as_size(), &mut |_, _| false);
                }
                app.paint(screen);
            })?;
            if rendered == Rendered::Complete {
                app.drawn();
                app.stats = self.meter.measure(session.protocol(), now).or(app.stats);
            }
        } else {
            session.refine()?;
        }
        // Counted from the time at which this frame was due: the time for drawing must not slow
        // frames down.
        self.next_frame = Some(self.next_frame + self.frame_time)
            .filter(|&next| now < next)
            .unwrap_or(now + self.frame_time);
        Ok(())
    }

    /// The time of the next change without an event; `None` for never.
    fn wakes_at(&self, app: &App, session: &Session, now: Duration) -> Option<Duration> {
        let (frame, soonest) = if self.waits {
            // The game continues while the terminal is not ready.
            (None, now + self.frame_time)
        } else {
            (is_unfinished(app, session).then_some(self.next_frame), self.next_frame)
        };
        // While others move out of view and the player does not, a look at each step is in vain.
        let rests = self.is_idle && app.waits_for_others();
        let soonest = if rests { now + self.frame_time } else { soonest };
        let change = app.next_change().map(|change| change.max(soonest));
        let expiry = app.controls.held.next_expiry();
        frame.into_iter().chain(change).chain(expiry).chain(app.next_reload()).min()
    }
}

/// Whether the terminal does not show the current state, or not exactly.
fn is_unfinished(app: &App, session: &Session) -> bool {
    app.is_stale() || !session.protocol().is_settled()
}

/// Passes the properties of the terminal to `app`.
fn update_terminal(app: &mut App, session: &Session) {
    let offered = app.tmux_remedy();
    let (protocol, glyphs) = (session.protocol(), session.glyph_support());
    app.terminal_changed(TerminalLook { glyphs, ..TerminalLook::of(protocol) });
    app.pointer.set_columns(protocol.size().columns);
    app.detection.follow(protocol, app.depth(), app.settings.depth.is_some());
    app.renew_tmux_offer(offered.as_deref());
}

/// The locale setting that restricts output to ASCII; `None` if there is none, or if the chosen
/// glyphs need more than ASCII.
fn ascii_locale(glyphs: GlyphSet) -> Option<String> {
    if glyphs.has_blocks() { None } else { locale_without_utf8(|name| env::var(name).ok()) }
}

/// Panics in the middle of a game, for tests of how it ends.
#[cfg(debug_assertions)]
fn panic_on_demand(key: Key) {
    let demanded = key == Key::Function(12) && env::var_os("CELLCASTER_PANIC").is_some();
    assert!(!demanded, "CELLCASTER_PANIC is set, and F12 was pressed");
}

/// The time since the main loop began.
#[derive(Debug)]
pub(crate) struct Time {
    start: Instant,
    /// The time, if the terminal gives it.
    #[cfg(debug_assertions)]
    told: Option<std::cell::Cell<Duration>>,
}

impl Time {
    /// Begins at zero.
    pub(crate) fn begin() -> Self {
        Self {
            start: Instant::now(),
            #[cfg(debug_assertions)]
            told: env::var_os("CELLCASTER_CLOCK")
                .is_some_and(|clock| clock == "focus")
                .then(std::cell::Cell::default),
        }
    }

    pub(crate) fn now(&self) -> Duration {
        #[cfg(debug_assertions)]
        if let Some(told) = &self.told {
            return told.get();
        }
        self.start.elapsed()
    }

    /// The machine's clock, by which steps that take long are noticed; `None` if the terminal gives
    /// the time.
    pub(crate) fn of_machine(&self) -> Option<fn() -> Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(|| {
            static BEGUN: OnceLock<Instant> = OnceLock::new();
            BEGUN.get_or_init(Instant::now).elapsed()
        })
    }

    /// How long it is until `time`; `None` if time stands still until the terminal reports
    /// something.
    pub(crate) fn until(&self, time: Duration) -> Option<Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(time.saturating_sub(self.now()))
    }

    /// Handles a report that the window has the focus.
    #[cfg(debug_assertions)]
    pub(crate) fn focus_reported(&self) {
        if let Some(told) = &self.told {
            told.set(told.get() + super::controls::step());
        }
    }
}
