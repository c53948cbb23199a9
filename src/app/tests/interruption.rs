//! Slow pictures, and the keys that arrive while they are rendered. The tests count work instead of
//! measuring time.

use std::cell::Cell;
use std::iter;

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};

use super::*;
use crate::app::draw::Rendered;
use crate::app::picture::TerminalLook;
use crate::terminal::{Event, QuitReason};

/// The largest window.
const WINDOW: Size = Size { width: 1000, height: 200 };

/// As many spheres as a map allows, all in one place. The whole picture takes thousands of bands.
fn spheres() -> Rig {
    let sphere = "{ center = [9, 0, 0], radius = 8, color = '#fff000' },".repeat(141);
    let text = format!("start = {{ at = [0, 0, 0], heading = 0 }}\nsphere = [{sphere}]\n");
    let level = crate::map::parse_level(&text, "spheres", &crate::map::NoFiles).unwrap();
    Rig::of(App::new(Levels::new(level, iter::empty()), Settings::default()), Some((500, 30)))
}

fn press(key: Key) -> Event {
    let modifiers = Modifiers::default();
    Event::Key(KeyEvent { key, base: None, modifiers, phase: Phase::Press })
}

/// Renders while `event` arrives after `band` bands. Returns the result and the number of bands.
fn render(app: &mut App, event: Event, band: usize) -> (Rendered, usize) {
    let mut bands = 0;
    let rendered = app.render_unless(WINDOW, &mut |comes_first| {
        bands += 1;
        bands > band && comes_first(&event)
    });
    (rendered, bands)
}

fn text(app: &mut App) -> String {
    let mut buffer = Buffer::empty(Rect::from(WINDOW));
    app.paint(&mut buffer);
    buffer.content.iter().map(ratatui::buffer::Cell::symbol).collect()
}

#[test]
fn q_is_answered_between_two_bands() {
    let mut rig = spheres();
    let q = press(Key::Char('q'));
    assert_eq!(render(&mut rig.app, q, 3), (Rendered::Interrupted, 4));
    assert!(rig.app.is_stale());
    // Nothing is painted until the key is handled.
    assert_eq!(render(&mut rig.app, q, 0), (Rendered::Interrupted, 1));
    rig.tap(Key::Char('q'), 20);
    // The question is shown over the unfinished picture.
    assert_eq!(render(&mut rig.app, q, 1), (Rendered::Partial, 1));
    assert!(text(&mut rig.app).contains("any other key cancels"));
    // Then the picture is rendered again, and any key interrupts it.
    assert!(rig.app.is_stale());
    assert_eq!(render(&mut rig.app, press(Key::Enter), 3), (Rendered::Interrupted, 4));
    rig.tap(Key::Enter, 200);
    assert!(rig.app.has_left);
}

#[test]
fn only_quitting_suspending_and_resizing_interrupt_a_picture() {
    for event in [Event::Quit(QuitReason::Terminated), Event::Suspend, Event::Resized] {
        assert_eq!(render(&mut spheres().app, event, 1), (Rendered::Interrupted, 2));
    }
    for event in [press(W), press(Key::Char('+')), Event::FocusGained] {
        let mut rig = spheres();
        let mut bands = 0;
        let rendered = rig.app.render_unless(WINDOW, &mut |comes_first| {
            bands += 1;
            assert!(!comes_first(&event), "{event:?}");
            // This ends the test, not the picture.
            bands > 9
        });
        assert_eq!(rendered, Rendered::Interrupted);
    }
}

#[test]
fn after_a_resize_no_partial_picture_is_shown() {
    let mut rig = spheres();
    assert_eq!(render(&mut rig.app, Event::Resized, 1), (Rendered::Interrupted, 2));
    rig.app.terminal_changed(TerminalLook::default());
    assert_eq!(render(&mut rig.app, Event::Resized, 1), (Rendered::Interrupted, 2));
}

/// A clock on which every step takes 30 ms.
fn slow() -> Duration {
    thread_local!(static NOW: Cell<Duration> = const { Cell::new(Duration::ZERO) });
    NOW.set(NOW.get() + Duration::from_millis(30));
    NOW.get()
}

#[test]
fn slow_steps_slow_the_game_down_and_leave_time_for_keys() {
    let steps_in_a_second = |machine_time| {
        let mut rig = Rig::new(floor(), None);
        rig.app.machine_time = machine_time;
        rig.send(W, Phase::Press);
        let before = rig.game().steps();
        rig.now += Duration::from_secs(1);
        rig.app.advance(rig.now);
        let steps = rig.game().steps() - before;
        // A late key also waits for one step at most.
        rig.now += Duration::from_secs(1);
        rig.send(Key::Char('q'), Phase::Press);
        (steps, rig.game().steps() - before - steps)
    };
    assert_eq!(steps_in_a_second(None), (15, 15));
    assert_eq!(steps_in_a_second(Some(slow as fn() -> Duration)), (1, 1));
}
