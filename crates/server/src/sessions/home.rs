//! A record of a room in the terminal of this machine, with the pages and keys of a session.

use std::env;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::session::replayed::ui;
use crate::line::Line;
use crate::rooms::replayed::RoomRecord;
use crate::rooms::room::{Catalog, NAME_COLUMNS};
use cellcaster::app::Configuration;
use cellcaster::app::store::Preferences;
use cellcaster::terminal::{Detected, Error, Event, Session, SessionOptions, locale_without_utf8};
use cellcaster::tui::GlyphSet;

/// Shows a record until the player leaves.
///
/// # Errors
/// If there is no terminal, or if it fails.
pub(crate) fn watch(
    record: RoomRecord,
    catalog: Arc<Catalog>,
    settings: (Preferences, Configuration),
) -> Result<(), Error> {
    let variable = |name: &str| env::var(name).ok();
    let mut options = SessionOptions::from_environment(variable);
    if let Some(depth) = settings.0.colors {
        options.color_depth = Detected::Certain(depth);
    }
    options.fidelity = settings.1.fidelity;
    let has_blocks = settings.0.glyphs.is_some_and(GlyphSet::has_blocks);
    options.is_ascii = !has_blocks && locale_without_utf8(variable).is_some();
    let (is_ascii, asks) = (options.is_ascii, options.ask_for_key_releases);
    let frame_time = Duration::from_secs(1) / settings.1.frames_per_second.get();
    let mut terminal = Session::enter(options)?;
    let name = Line::of("Cellcaster", NAME_COLUMNS).expect("printable characters");
    let mut ui = ui(name, catalog, settings);
    ui.has_ascii_only = is_ascii;
    ui.detection.reports_releases = (!asks).then_some(false);
    ui.follow_terminal(terminal.protocol());
    ui.begin_playback(record, None);
    let begun = Instant::now();
    let mut next_frame = Duration::ZERO;
    terminal.set_mouse(true)?;
    while ui.farewell.is_none() {
        let now = begun.elapsed();
        ui.wake(now);
        ui.requests.clear();
        let is_unfinished = ui.is_stale(None) || !terminal.protocol().is_settled();
        let is_due = is_unfinished && now >= next_frame;
        let waits = is_due && !terminal.is_ready();
        if is_due && !waits {
            if ui.is_stale(None) {
                let view = ui.playback.as_ref().map(|playback| playback.view());
                if let Some(view) = &view {
                    ui.look_at(view, now);
                }
                terminal.draw(|screen| ui.draw(screen, view.as_ref()))?;
                ui.drawn();
            } else {
                terminal.refine()?;
            }
            next_frame = now + frame_time;
        }
        let frame = (is_unfinished && !waits).then_some(next_frame);
        let wakes_at = ui.wakes_at().into_iter().chain(frame).min();
        let timeout = wakes_at.map(|time| time.saturating_sub(begun.elapsed()));
        match terminal.next_event(timeout)? {
            None => {}
            Some(Event::Suspend) => {
                terminal.suspend()?;
                ui.resumed(begun.elapsed());
            }
            Some(Event::Quit(_)) => break,
            Some(event) => {
                let is_other =
                    matches!(event, Event::Resized | Event::ColorDepth(_) | Event::Identified);
                ui.event(event, begun.elapsed());
                if is_other {
                    ui.follow_terminal(terminal.protocol());
                }
            }
        }
    }
    Ok(())
}
