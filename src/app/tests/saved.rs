//! Saved games: levels that have changed, descents, and the settings that are kept.

use super::missions::text;
use super::titles::titled;
use super::*;
use crate::app::{Given, Offers, Opening, Origin};
use crate::game::{Intents, Script};
use crate::store::{SavedGame, Slot};
use crate::tui::GlyphMode;

/// Leaves a game to the title, which keeps its store.
fn leave(rig: &mut Rig) -> Game {
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    let left = rig.game().clone();
    rig.choose("Leave to the title");
    left
}

fn playing(label: &str, offers: Offers) -> Rig {
    let mut rig = titled(offers, Store::in_memory());
    rig.choose(label);
    if rig.app.screen == Screen::NewGame {
        rig.choose("Normal");
    }
    assert_eq!(rig.app.screen, Screen::Playing);
    rig.press(W);
    rig.wait(1500);
    rig.release(W);
    rig.wait(700);
    rig
}

#[test]
fn a_game_in_a_level_that_has_changed_can_begin_anew() {
    let mut rig = playing("New game", Offers::default());
    leave(&mut rig);
    let saved = rig.app.store.saved(Slot::Level).unwrap();
    // In the level as it was, the script led to another state.
    let changed = SavedGame { checksum: saved.checksum.map(|sum| sum ^ 1), ..saved.clone() };
    rig.app.store.save(&changed);
    rig.choose("Continue");
    assert_eq!(rig.app.screen, Screen::Outdated(Slot::Level));
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("The level has changed since you left it."), "{shown}");
    rig.tap(Key::Escape, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen, Screen::Title);
    assert_eq!(rig.app.store.saved(Slot::Level), Some(changed), "a look costs nothing");
    rig.choose("Continue");
    rig.choose("Begin anew");
    assert_eq!((rig.app.screen, rig.app.store.saved(Slot::Level)), (Screen::Playing, None));
    assert!(rig.game().elapsed() < 1.0);

    // A file of the first version has no checksum.
    rig.app.store.save(&SavedGame { checksum: None, ..saved });
    rig.app.show_title();
    rig.choose("Continue");
    assert_eq!(rig.app.screen, Screen::Playing);
    assert!(rig.game().elapsed() > 2.0);
}

#[test]
fn a_descent_that_is_left_goes_on_once() {
    let offers = || Offers { today: Some(20_261_122), seed: 7, ..Offers::default() };
    for (label, kind) in [("Endless", "endless"), ("Daily run", "daily run")] {
        let mut rig = playing(label, offers());
        let course = rig.app.course;
        let mut left = leave(&mut rig);
        let shown = text(&mut rig.app, 80, 24);
        assert!(shown.contains(&format!("Continue descent  {kind}")), "{shown}");
        rig.choose("Continue descent");
        assert_eq!((rig.app.screen, rig.app.course), (Screen::Playing, course));
        while left.tally().steps < rig.game().tally().steps {
            left.step(Intents::new());
        }
        assert_eq!(left, *rig.game());
        assert_eq!(rig.app.store.saved(Slot::Descent), None);
        // It can be left again, with the script from its beginning on.
        let steps = leave(&mut rig).tally().steps;
        let saved = rig.app.store.saved(Slot::Descent).unwrap();
        assert_eq!(Script::parse(&saved.script, "it").unwrap().steps(), steps);
    }
}

#[test]
fn a_descent_does_not_replace_the_saved_level() {
    let mut rig = playing("New game", Offers::default());
    leave(&mut rig);
    let level = rig.app.store.saved(Slot::Level);
    rig.choose("Endless");
    rig.press(W);
    rig.wait(500);
    rig.release(W);
    leave(&mut rig);
    assert!(level.is_some() && rig.app.store.saved(Slot::Descent).is_some());
    assert_eq!(rig.app.store.saved(Slot::Level), level);
}

#[test]
fn settings_are_kept_unless_a_flag_or_a_file_gives_them() {
    let thirty = Duration::from_secs(1) / 30;
    let mut rig = titled(Offers::default(), Store::in_memory());
    rig.choose("Settings");
    for label in ["Characters", "Colours", "Frames a second"] {
        rig.choose(label);
    }
    let kept = rig.app.store.preferences();
    assert_eq!(kept.glyphs, Some(GlyphMode::Ascii));
    assert_eq!(kept.colors, Some(ColorDepth::True));
    assert_eq!(kept.frames_per_second.map(u32::from), Some(60));

    let plain = Settings { frame_time: thirty, ..Settings::default() };
    let next = plain.clone().preferring(&kept);
    assert_eq!((next.glyphs, next.depth), (GlyphMode::Ascii, Some(ColorDepth::True)));
    assert_eq!(next.frame_time, Duration::from_secs(1) / 60);

    let given = Given { glyphs: Some(Origin::Flag), depth: None, frame_time: Some(Origin::File) };
    let next = Settings { given, ..plain }.preferring(&kept);
    assert_eq!((next.glyphs, next.frame_time), (GlyphMode::Half, thirty));
    assert_eq!(next.depth, Some(ColorDepth::True));
    let app = App::opened(Opening::Title(Offers::default()), next, Store::in_memory());
    let mut rig = Rig::of(app, Some((500, 30)));
    rig.choose("Settings");
    let shown = text(&mut rig.app, 80, 24);
    for line in ["half blocks (flag)", "30 (file)", "holds again at the next start"] {
        assert!(shown.contains(line), "{line}: {shown}");
    }
    rig.choose("Characters");
    assert!(!text(&mut rig.app, 80, 24).contains("(flag)"), "the player has chosen another");
}
