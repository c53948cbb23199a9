//! Changing keys on the page of keys, in a terminal without key releases.

use super::missions::text;
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::app::controls::Action;
use crate::game::Intent;

const FORWARD: Action = Action::Want(Intent::Forward);
const STRIKE: Action = Action::Want(Intent::Strike);

/// A title on the page of keys.
fn on_page(store: Store) -> Rig {
    let mut rig = titled(Offers::default(), store);
    rig.choose("Settings");
    rig.choose("Keys");
    rig
}

fn page(rig: &mut Rig) -> String {
    text(&mut rig.app, 80, 24)
}

fn keys(rig: &Rig, action: Action) -> String {
    rig.app.settings.bindings.key_names(action)
}

fn press(rig: &mut Rig, key: Key) {
    rig.tap(key, 30);
    rig.wait(700);
}

#[test]
fn the_next_key_becomes_the_first_key_of_the_action_and_lasts() {
    let mut rig = on_page(Store::in_memory());
    rig.app.settings.glyphs = crate::tui::GlyphSet::Ascii;
    rig.app.terminal.depth = ColorDepth::Mono;
    insta::assert_snapshot!(page(&mut rig));
    rig.choose("Walk");
    insta::assert_snapshot!(page(&mut rig));
    press(&mut rig, Key::Char('z'));
    assert_eq!((rig.app.screen(), keys(&rig, FORWARD)), (AppScreen::Keys, "z up".to_owned()));
    assert!(page(&mut rig).contains("z now means \"walk\"."), "{}", page(&mut rig));
    press(&mut rig, Key::Escape);
    assert!(page(&mut rig).contains("1 changed"), "{}", page(&mut rig));

    let store = std::mem::take(&mut rig.app.store);
    let mut next = titled(Offers::default(), store);
    assert_eq!(keys(&next, FORWARD), "z up");
    next.choose("New game");
    next.choose("Normal");
    let start = next.position();
    press(&mut next, Key::Char('z'));
    assert!(next.position().distance(start) > 0.2);
}

#[test]
fn another_action_loses_the_key_and_the_page_says_so() {
    let mut rig = on_page(Store::in_memory());
    rig.choose("Walk");
    press(&mut rig, Key::Char('f'));
    assert_eq!((keys(&rig, FORWARD), keys(&rig, STRIKE)), ("f up".to_owned(), String::new()));
    let shown = page(&mut rig);
    assert!(shown.contains("f now means \"walk\" and no longer \"strike\"."), "{shown}");
    // The usual keys come back, and with them the other action's loss.
    for _ in 0..14 {
        press(&mut rig, Key::Down);
    }
    assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Strike"));
    assert!(page(&mut rig).contains("none"), "{}", page(&mut rig));
    press(&mut rig, Key::Delete);
    assert_eq!((keys(&rig, FORWARD), keys(&rig, STRIKE)), ("up".to_owned(), "f".to_owned()));
    let shown = page(&mut rig);
    assert!(shown.contains("\"strike\" has its usual keys again, and \"walk\" lost f."), "{shown}");
    press(&mut rig, Key::Home);
    press(&mut rig, Key::Backspace);
    assert_eq!((rig.app.screen(), keys(&rig, FORWARD)), (AppScreen::Keys, "w up".to_owned()));
    assert!(rig.app.store.keys().is_empty(), "{:?}", rig.app.store.keys());
}

#[test]
fn escape_cancels_and_unsuitable_keys_get_a_sentence() {
    let mut rig = on_page(Store::in_memory());
    rig.choose("Walk");
    press(&mut rig, Key::Enter);
    assert!(page(&mut rig).contains("enter cannot be bound"), "{}", page(&mut rig));
    press(&mut rig, Key::Escape);
    assert_eq!((rig.app.screen(), keys(&rig, FORWARD)), (AppScreen::Keys, "w up".to_owned()));
    rig.choose("Walk");
    press(&mut rig, Key::Char('w'));
    assert!(page(&mut rig).contains("w already means \"walk\"."), "{}", page(&mut rig));
}

#[test]
fn holding_enter_on_a_row_binds_nothing() {
    let mut rig = on_page(Store::in_memory());
    rig.press(Key::Char(' '));
    rig.wait(3000);
    rig.release(Key::Char(' '));
    rig.wait(700);
    assert!(matches!(rig.app.screen(), AppScreen::Binding(_)), "{:?}", rig.app.screen());
    assert_eq!(keys(&rig, FORWARD), "w up");
    press(&mut rig, Key::Char(' '));
    assert_eq!(keys(&rig, FORWARD), "space up");
}

#[test]
fn shift_is_bound_by_itself_and_not_with_the_key_that_it_modifies() {
    let mut rig = on_page(Store::in_memory());
    rig.app.controls.held.set_reports_releases(true);
    rig.keyboard = None;
    rig.choose("Walk");
    rig.press(Key::Shift);
    rig.press(Key::Char('!'));
    rig.release(Key::Char('!'));
    rig.release(Key::Shift);
    assert_eq!(keys(&rig, FORWARD), "! up");
    rig.choose("Walk");
    rig.tap(Key::Control, 30);
    assert!(page(&mut rig).contains("control cannot be bound"), "{}", page(&mut rig));
    rig.tap(Key::Shift, 30);
    assert_eq!(keys(&rig, FORWARD), "shift up");
}

#[test]
fn all_keys_follow_a_preset() {
    let mut rig = on_page(Store::in_memory());
    rig.choose("All keys");
    assert_eq!(keys(&rig, FORWARD), "z up");
    assert!(page(&mut rig).contains("those of azerty"), "{}", page(&mut rig));
    let store = std::mem::take(&mut rig.app.store);
    assert_eq!(keys(&titled(Offers::default(), store), FORWARD), "z up");
    rig = on_page(Store::in_memory());
    rig.choose("Walk");
    press(&mut rig, Key::Char('y'));
    assert!(page(&mut rig).contains("own"), "{}", page(&mut rig));
}
