//! The main loop, which owns the terminal and the clock; the steps that the game takes as time
//! passes; and replays, which need neither.
//!
//! The loop sleeps until a key, a signal or the next frame is due. While nothing moves there is no
//! next frame, so nothing is computed or written.
//!
//! Time comes from the machine's clock. A debug build also has a clock for tests. If the
//! environment variable `CELLCASTER_CLOCK` is `focus`, time stands still until the terminal reports
//! that the window has the focus, and each such report is one step of the game. The game is then a
//! function of the bytes that the program reads, even on a machine under load. Bytes, keys, screens
//! and the terminal are the same under both clocks.
//!
//! A focus report has no other effect, and every terminal can send one. Rejected: time as a private
//! sequence, which the decoder would have to recognise. Also rejected: time from a file or a
//! socket, which would not be ordered with respect to the keys.
//!
//! Each step uses the keys held at its own time, even if several steps pass between two frames. A
//! tap therefore lasts the same number of steps on a slow machine as on a fast one.
//!
//! The loop does not catch up after slow steps. The game slows down instead, and the loop reads
//! keys between two steps, however long a step takes.

use std::num::NonZeroU32;
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use std::{env, fmt};

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use crate::app::App;
use crate::app::controls::{self, Clock};
use crate::app::detection::Detection;
use crate::app::draw::Rendered;
use crate::app::levels::Levels;
use crate::app::picture::TerminalLook;
use crate::app::playback::Playback;
use crate::app::recording::{Ghost, Recording};
use crate::app::screen::AppScreen;
use crate::app::settings::Settings;
use crate::app::status::Meter;
use crate::app::store::Store;
use crate::app::title::Offers;
use crate::game::{Game, Intents, PlayerId, STEPS_PER_SECOND, Script};
#[cfg(debug_assertions)]
use crate::terminal::Key;
use crate::terminal::{
    Detected, Error, Event, Recorder, Session, SessionOptions, locale_without_utf8,
};
use crate::tui::GlyphSet;
use crate::tui::canvas::Canvas;

/// The state in which the program starts.
#[derive(Debug)]
pub enum InitialState {
    /// The title screen with these entries.
    Title(Offers),
    /// The daily run, with the title behind it.
    Daily(Offers),
    /// An endless descent, with the title behind it.
    Endless(Offers),
    /// A game with no title to return to.
    Levels(Box<Levels>),
    /// A recorded run: its script, which has at most [`MAX_PLAYBACK_STEPS`], and its levels.
    ///
    /// [`MAX_PLAYBACK_STEPS`]: super::MAX_PLAYBACK_STEPS
    Playback {
        /// The levels.
        levels: Box<Levels>,
        /// The script.
        script: Script,
    },
}

/// Starts with `opening` on the terminal, plays until the player leaves or the program is ended
/// from outside, and makes the recordings in `recording`.
///
/// # Errors
/// If there is no terminal, or if it fails.
pub fn play(
    opening: InitialState,
    settings: Settings,
    store: Store,
    recording: Recording,
) -> Result<ClosingLines, Error> {
    let settings = settings.preferring(&store.preferences());
    let (mut session, detection) = enter(&settings, recording.terminal)?;
    let mut app = App { detection, ..App::opened(opening, settings, store) };
    app.script = recording.script;
    let ended = app.run(&mut session);
    // The disk may be slow, and the shell needs its terminal.
    drop(session);
    _ = app.leave_game();
    ended?;
    let trouble = app.store.trouble().map(str::to_owned);
    Ok(ClosingLines { done: app.left, trouble })
}

/// Takes the terminal, and returns what is known about it already.
pub(crate) fn enter(
    settings: &Settings,
    recorder: Option<Box<dyn Recorder>>,
) -> Result<(Session, Detection), Error> {
    let mut options = SessionOptions::from_environment(|name| env::var(name).ok());
    if let Some(depth) = settings.depth {
        options.color_depth = Detected::Certain(depth);
    }
    options.fidelity = settings.fidelity;
    let ascii_locale = ascii_locale(settings.glyphs);
    options.is_ascii = ascii_locale.is_some();
    let reports_releases = (!options.ask_for_key_releases).then_some(false);
    let session = Session::enter_recorded(options, recorder)?;
    Ok((session, Detection { reports_releases, ascii_locale, ..Detection::default() }))
}

impl App {
    /// Runs until the player leaves, or the program must end. Returns whether it must end.
    pub(crate) fn run(&mut self, session: &mut Session) -> Result<bool, Error> {
        let mut presenter = Presenter::default();
        let time = Time::begin();
        update_terminal(self, session);
        self.machine_time = time.of_machine();
        while !self.has_left {
            self.advance(time.now());
            self.reload(time.now());
            session.set_mouse(self.pointer.is_on() || self.playback.is_some())?;
            if self.watch.take_ring() && self.store.preferences().bell {
                session.ring_bell();
            }
            if self.take_tmux_order() {
                session.tell_tmux();
            }
            presenter.update(self, session, time.now())?;
            let wakes_at = presenter.wakes_at(self, session, time.now());
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
                    self.key(event, time.now());
                }
                Some(Event::Mouse(event)) => self.mouse(event, time.now()),
                Some(Event::FocusLost) => self.focus_lost(time.now()),
                Some(Event::Resized | Event::ColorDepth(_) | Event::Identified) => {
                    update_terminal(self, session);
                }
                Some(Event::KeyReleases(reported)) => self.releases_reported(reported),
                Some(Event::TmuxTold(has_worked)) => self.tmux_told(has_worked),
                Some(Event::Suspend) => {
                    session.suspend()?;
                    self.resumed(time.now());
                }
                Some(Event::Quit(_)) => return Ok(true),
            }
        }
        Ok(false)
    }

    /// Records whether the terminal reports key releases.
    pub(crate) fn releases_reported(&mut self, reported: bool) {
        self.controls.held.set_reports_releases(reported);
        self.detection.reports_releases = Some(reported);
    }
}

/// The lines to print after the terminal has been restored.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct ClosingLines {
    /// A line about the last game; `None` if no game was played.
    pub done: Option<String>,
    /// A sentence about damaged data or data that could not be saved.
    pub trouble: Option<String>,
}

/// Shows the latest state of the game, at no more than the given frame rate and only when the
/// terminal is ready.
#[derive(Default)]
struct Presenter {
    next_frame: Duration,
    /// `true` while a frame is due and the terminal is not ready. The terminal reports when it is.
    waits: bool,
    /// `true` if a frame was allowed at the last check, but there was nothing to show.
    is_idle: bool,
    meter: Meter,
}

impl Presenter {
    /// Draws or refines a frame if one is due, unless an event must be handled first.
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
                // The window may have been resized during the wait for the terminal.
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
        // Counted from the time at which this frame was due, so the time spent on drawing does not
        // lower the frame rate.
        self.next_frame = Some(self.next_frame + app.settings.frame_time)
            .filter(|&next| now < next)
            .unwrap_or(now + app.settings.frame_time);
        Ok(())
    }

    /// The time of the next change that happens without an event; `None` for never.
    fn wakes_at(&self, app: &App, session: &Session, now: Duration) -> Option<Duration> {
        if app.playback.as_ref().is_some_and(Playback::is_busy) {
            return Some(now);
        }
        let (frame, soonest) = if self.waits {
            // The game continues while the terminal is not ready.
            (None, now + app.settings.frame_time)
        } else {
            (is_unfinished(app, session).then_some(self.next_frame), self.next_frame)
        };
        // While only others move, and out of view, there is nothing to show at each step. One check
        // per frame is enough.
        let rests = self.is_idle && app.waits_for_others();
        let soonest = if rests { now + app.settings.frame_time } else { soonest };
        let change = app.next_change().map(|change| change.max(soonest));
        let expiry = app.controls.held.next_expiry();
        frame.into_iter().chain(change).chain(expiry).chain(app.next_reload()).min()
    }
}

/// Returns true if the terminal does not yet show the exact current state.
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

/// The locale setting that restricts output to ASCII; `None` if there is no such setting, or if the
/// chosen glyphs need more than ASCII.
fn ascii_locale(glyphs: GlyphSet) -> Option<String> {
    if glyphs.has_blocks() { None } else { locale_without_utf8(|name| env::var(name).ok()) }
}

/// Panics in the middle of a game. Tests use it to check that the terminal is restored.
#[cfg(debug_assertions)]
fn panic_on_demand(key: Key) {
    let demanded = key == Key::Function(12) && env::var_os("CELLCASTER_PANIC").is_some();
    assert!(!demanded, "CELLCASTER_PANIC is set, and F12 was pressed");
}

/// The time since the start of the main loop.
#[derive(Debug)]
pub(crate) struct Time {
    start: Instant,
    /// The time counted from focus reports, if they are the clock.
    #[cfg(debug_assertions)]
    told: Option<std::cell::Cell<Duration>>,
}

impl Time {
    /// A time that starts at zero now.
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

    /// The machine's clock, used to notice steps that take too long; `None` if focus reports are
    /// the clock.
    fn of_machine(&self) -> Option<fn() -> Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(|| {
            static BEGUN: OnceLock<Instant> = OnceLock::new();
            BEGUN.get_or_init(Instant::now).elapsed()
        })
    }

    /// The duration from now until `time`; `None` if time stands still until the next focus report.
    pub(crate) fn until(&self, time: Duration) -> Option<Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(time.saturating_sub(self.now()))
    }

    /// Handles a focus report.
    #[cfg(debug_assertions)]
    fn focus_reported(&self) {
        if let Some(told) = &self.told {
            told.set(told.get() + controls::step());
        }
    }
}

/// The time after which no more steps begin before keys are read.
const MAX_TIME: Duration = Duration::from_millis(25);

impl App {
    /// Advances the game towards `now` for as long as a short time limit allows. The remaining time
    /// is dropped.
    pub(crate) fn advance(&mut self, now: Duration) {
        self.now = now;
        let begun = self.machine_time.map(|time| time());
        let is_late = |time: Option<fn() -> Duration>| {
            let passed = time.zip(begun).map(|(time, begun)| time().saturating_sub(begun));
            passed.is_some_and(|passed| passed > MAX_TIME)
        };
        if self.playback.is_some() {
            let time = self.machine_time;
            self.advance_playback(now, &|| is_late(time));
            self.controls.advance(now, self.key_context());
            return self.settle(now);
        }
        let mut step = self.clock.step_after(0);
        let mut steps = self.clock.steps_until(now);
        let mut moves = 0;
        if self.demo.is_some() {
            for _ in 0..steps.min(Clock::MAX_STEPS) {
                self.step_demo();
                if is_late(self.machine_time) {
                    break;
                }
            }
        }
        while steps > 0 && moves < Clock::MAX_STEPS && self.screen() == AppScreen::Playing {
            let passed = self.pass(step, steps, &mut moves);
            step = controls::after(step, passed);
            steps -= passed;
            if is_late(self.machine_time) {
                break;
            }
        }
        self.controls.advance(now, self.key_context());
        self.settle(now);
    }

    /// Advances by one step that ends at `now`, or by up to `most` steps while the game is at rest.
    /// Returns the number of steps.
    fn pass(&mut self, now: Duration, most: u64, moves: &mut u64) -> u64 {
        let context = self.key_context();
        self.controls.advance(now, context);
        let intents = self.wanted();
        let rests = self.is_at_rest(intents);
        let steps = if rests && !self.pointer.has_input() {
            self.controls.steady_steps(now, context, most)
        } else {
            1
        };
        if rests {
            self.game.wait(steps);
        } else {
            self.game.step(intents);
            *moves += 1;
        }
        self.controls.held.step();
        self.pointer.passed(steps);
        self.stepped(intents, steps);
        steps
    }

    /// Follows the game after `steps` steps with these intents: everything that does not depend on keys.
    pub(crate) fn stepped(&mut self, intents: Intents, steps: u64) {
        if let Some(ghost) = &mut self.ghost {
            (0..steps).for_each(|_| ghost.step());
        }
        if let Some(game) = self.game.grid() {
            self.watch.look_at(game, PlayerId::FIRST);
        }
        let acted = if intents.is_empty() { 0 } else { steps };
        self.goal.moved(acted);
        self.notice.iter_mut().for_each(|notice| notice.moved(acted));
        self.record(intents, steps);
        self.remember();
        self.follow_outcome();
    }

    /// Returns true if steps with these intents change only clocks.
    pub(crate) fn is_at_rest(&self, intents: Intents) -> bool {
        self.game.is_at_rest(intents) && self.ghost.as_ref().is_none_or(Ghost::is_at_rest)
    }

    /// Shows the result if the player has won the level or died.
    pub(crate) fn follow_outcome(&mut self) {
        if self.game.is_finished() {
            self.improved = self.record_result();
            self.show(AppScreen::LevelDone);
        } else if self.game.grid().is_some_and(Game::is_dead) {
            self.look_back();
            self.show(AppScreen::Dead);
        }
    }
}

/// A game without a terminal, advanced one step at a time. It draws the same picture, minimap and
/// status line that a player with the same intents would see.
///
/// After the player reaches a level's exit, the next step is the first step of the next level.
pub struct Replay {
    app: App,
    picture: Buffer,
}

impl Replay {
    /// Starts `levels` in a window of `size`.
    pub fn new(levels: Levels, settings: Settings, size: Size) -> Self {
        let area = Rect::from(size);
        Self { app: App::new(levels, settings), picture: Buffer::empty(area) }
    }

    /// Advances by one step with `intents`.
    pub fn step(&mut self, intents: Intents) {
        if self.app.screen() == AppScreen::LevelDone {
            self.app.next_level();
        }
        if self.app.screen() == AppScreen::Playing {
            self.app.game.step(intents);
            self.app.goal.moved(u64::from(!intents.is_empty()));
            if self.app.game.is_finished() {
                self.app.show(AppScreen::LevelDone);
            }
        }
    }

    /// Plays `script`, and calls `show` with `frames_per_second` frames for each second. The first
    /// frame shows the state before the first step. The arguments of `show` are the number of the
    /// frame, the section of the script that led to it, and the cells.
    ///
    /// # Errors
    /// The first error that `show` returns.
    pub fn play<E>(
        &mut self,
        script: &Script,
        frames_per_second: NonZeroU32,
        show: impl FnMut(u64, usize, &Buffer) -> Result<(), E>,
    ) -> Result<(), E> {
        self.play_from(script, frames_per_second, 0, show)
    }

    /// As [`Replay::play`], but does not draw the frames before the one with the number `first`.
    ///
    /// # Errors
    /// The first error that `show` returns.
    pub fn play_from<E>(
        &mut self,
        script: &Script,
        frames_per_second: NonZeroU32,
        first: u64,
        mut show: impl FnMut(u64, usize, &Buffer) -> Result<(), E>,
    ) -> Result<(), E> {
        let mut show = |replay: &mut Self, frame, section| {
            if frame < first {
                replay.look_around();
                return Ok(());
            }
            show(frame, section, replay.picture())
        };
        let mut frame = 0;
        show(self, frame, 0)?;
        for (steps, (section, intents)) in (1..).zip(script.iter()) {
            self.step(intents);
            let frames = steps * u64::from(frames_per_second.get()) / u64::from(STEPS_PER_SECOND);
            while frame < frames {
                frame += 1;
                show(self, frame, section)?;
            }
        }
        Ok(())
    }

    /// Adds what the player sees to the map, as drawing does.
    fn look_around(&mut self) {
        let ([picture, _], _) = self.app.areas(self.picture.area);
        let field_of_view = self.app.settings.field_of_view;
        if let Some(game) = self.app.game.grid() {
            self.app.map.explore(game, &game.camera(field_of_view), picture.width);
        }
    }

    /// Draws the current state.
    pub fn draw(&mut self, canvas: &mut impl Canvas) {
        self.app.draw(canvas);
    }

    /// The current picture. As during play, it is redrawn only after a change.
    pub fn picture(&mut self) -> &Buffer {
        if self.app.is_stale() {
            self.picture.reset();
            self.app.draw(&mut self.picture);
            self.app.drawn();
        }
        &self.picture
    }
}

impl fmt::Debug for Replay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Replay").field("game", &self.app.game).finish_non_exhaustive()
    }
}
