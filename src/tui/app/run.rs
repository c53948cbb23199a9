//! The loop around the game: it has a terminal and a clock.
//!
//! It sleeps until a key, a signal or the next frame is due; while nothing moves there is no next
//! frame, so nothing is computed and nothing written.

use std::env;
use std::time::Instant;

use super::{App, Levels, Recording, Settings};
#[cfg(debug_assertions)]
use crate::terminal::Key;
use crate::terminal::{Detected, Error, Event, Options, Session};
use crate::tui::CellAspect;

/// Plays `levels` on the terminal until the player leaves or somebody else ends the program, and
/// notes down what `recording` asks for.
///
/// # Errors
/// Where there is no terminal, or it fails.
pub fn play(levels: Levels, settings: Settings, recording: Recording) -> Result<(), Error> {
    let mut options = Options::from_environment(|name| env::var(name).ok());
    if let Some(depth) = settings.depth {
        options.color_depth = Detected::Certain(depth);
    }
    let mut session = Session::enter_recorded(options, recording.terminal)?;
    let mut app = App::new(levels, settings);
    app.script = recording.script;
    tell_terminal(&mut app, &session);
    let start = Instant::now();
    while !app.has_left {
        app.advance(start.elapsed());
        if app.is_due(start.elapsed()) {
            session.draw(|frame| app.draw(frame))?;
            app.drawn(start.elapsed());
        }
        let timeout = app.wakes_at().map(|wakes| wakes.saturating_sub(start.elapsed()));
        match session.next_event(timeout)? {
            None => {}
            Some(Event::Key(event)) => {
                #[cfg(debug_assertions)]
                panic_on_demand(event.key);
                app.key(event, start.elapsed());
            }
            Some(Event::Resized | Event::ColorDepth(_)) => tell_terminal(&mut app, &session),
            Some(Event::KeyReleases(reported)) => app.held.set_reports_releases(reported),
            Some(Event::Suspend) => {
                session.suspend()?;
                app.resumed(start.elapsed());
            }
            Some(Event::Quit(_)) => break,
        }
    }
    Ok(())
}

/// Tells `app` what the terminal is like.
fn tell_terminal(app: &mut App, session: &Session) {
    let aspect = session.size().cell_aspect.and_then(CellAspect::new);
    app.terminal_changed(aspect, session.color_depth());
}

/// A fault in the middle of a game, for the tests that look at how it ends.
#[cfg(debug_assertions)]
fn panic_on_demand(key: Key) {
    let demanded = key == Key::Function(12) && env::var_os("CELLCASTER_PANIC").is_some();
    assert!(!demanded, "CELLCASTER_PANIC is set, and F12 was pressed");
}
