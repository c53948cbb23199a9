//! Running by default, and the field of view.

use super::missions::text;
use super::titles::titled;
use super::*;
use crate::app::Offers;

/// The number of cells that a player walks in two seconds with `key` held, after `prepare`.
fn walked(runs: bool, prepare: impl Fn(&mut Rig)) -> f64 {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    rig.app.prefer(|it| it.runs = runs);
    prepare(&mut rig);
    rig.press(W);
    rig.wait(1500);
    let start = rig.position();
    rig.wait(2000);
    rig.position().distance(start)
}

#[test]
fn whoever_runs_by_default_walks_after_the_key_to_run() {
    let toggle = |rig: &mut Rig| {
        rig.tap(Key::Char('r'), 30);
        rig.wait(100);
    };
    let (walk, run) = (walked(false, |_| ()), walked(false, toggle));
    assert!(run > walk + 1.0, "{run} {walk}");
    assert_eq!(walked(true, |_| ()), run);
    assert_eq!(walked(true, toggle), walk);
}

#[test]
fn the_key_that_runs_while_held_walks_for_whoever_runs_by_default() {
    let walked = |runs, is_shifted| {
        let mut rig = Rig::new(floor(), None);
        rig.app.prefer(|it| it.runs = runs);
        if is_shifted {
            rig.press(Key::Shift);
        }
        rig.press(W);
        rig.wait(2000);
        rig.position().distance(DVec2::new(30.5, 30.5))
    };
    assert!(walked(false, true) > walked(false, false) + 1.0);
    assert_eq!(walked(true, false), walked(false, true));
    assert_eq!(walked(true, true), walked(false, false));
}

#[test]
fn a_tap_never_runs_and_a_player_at_rest_stays_at_rest() {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    rig.app.prefer(|it| it.runs = true);
    rig.wait(500);
    assert!(rig.app.wanted().is_empty(), "{:?}", rig.app.wanted());
    rig.tap(W, 30);
    rig.wait(1000);
    let walked = rig.position().distance(DVec2::new(30.5, 30.5));
    assert!((walked - 0.25).abs() < 1e-3, "{walked}");
}

#[test]
fn the_status_line_names_the_mode_only_if_it_differs_from_the_default() {
    let mut rig = Rig::new(floor(), Some((500, 30)));
    let mut shown = |runs, key| {
        rig.app.prefer(|it| it.runs = runs);
        rig.tap(key, 30);
        rig.wait(700);
        let shown = text(&mut rig.app, 80, 24);
        ["running", "walking"].map(|mode| shown.contains(mode))
    };
    let other = Key::Char('5');
    assert_eq!(shown(false, other), [false, false]);
    assert_eq!(shown(true, other), [false, false]);
    assert_eq!(shown(true, Key::Char('r')), [false, true]);
    assert_eq!(shown(false, other), [true, false]);
}

#[test]
fn running_and_the_field_of_view_are_set_on_the_settings_page_and_kept() {
    let mut rig = titled(Offers::default(), Store::in_memory());
    rig.choose("Settings");
    rig.choose("Run by default");
    rig.choose("Field of view");
    assert_eq!(rig.app.settings.field_of_view.degrees(), 72.0);
    assert!(text(&mut rig.app, 80, 24).contains("72°"));
    rig.tap(Key::Left, 30);
    rig.wait(700);
    rig.tap(Key::Char('-'), 30);
    rig.wait(700);
    assert_eq!(rig.app.settings.field_of_view.degrees(), 60.0);
    let store = std::mem::take(&mut rig.app.store);
    let settings = Settings::default().preferring(&store.preferences());
    assert_eq!(settings.field_of_view.degrees(), 60.0);
    assert!(titled(Offers::default(), store).app.controls.toggles.runs_by_default);
}
