//! Levels that hurt: death, continuation, results, ghosts, and stored data.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::Rect;

use super::titles::titled;
use super::*;
use crate::app::recording::RunLog;
use crate::app::store::{Descent, Run, map_key};
use crate::app::{Offers, OwnLevel, OwnMap};
use crate::map::{NoFiles, builtin, parse_level};
use crate::tui::GlyphSet;

/// Spikes that come out immediately, with a note before them, and a treasure and the exit behind
/// them.
pub(crate) const DANGER: &str = r##"
title = "Danger"
par = 30
grid = '''
##########
#@n.^..tX#
##########
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"n" = { note = "Mind the floor." }
"^" = { spikes = 1.0 }
"t" = { treasure = 50 }
"X" = { exit = true }
"##;

/// A map called `name` with this text.
pub(crate) fn own_map(name: &str, text: &'static str) -> OwnMap {
    let key = map_key(name, text);
    let read = || parse_level(text, "it", &NoFiles).map_err(|faults| faults.summary());
    let load = {
        let key = key.clone();
        move || Ok(OwnLevel { level: read()?, key: key.clone(), file: None })
    };
    OwnMap { name: name.to_owned(), key, load: Box::new(load) }
}

/// The offers of a title, with this map among the player's own.
pub(crate) fn offering(name: &'static str, text: &'static str) -> Offers {
    let maps = move || vec![own_map(name, text)];
    Offers { maps: Some(Box::new(maps)), ..Offers::default() }
}

/// A game in the map `text`, chosen on the title screen.
pub(crate) fn playing_own(text: &'static str, store: Store) -> Rig {
    let mut rig = titled(offering("danger.toml", text), store);
    rig.choose("My maps");
    rig.choose("danger.toml");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    rig
}

/// A game in the map with the spikes.
pub(crate) fn danger() -> Rig {
    playing_own(DANGER, Store::in_memory())
}

/// A player who stood on the spikes until they died.
pub(crate) fn dead() -> Rig {
    let mut rig = danger();
    rig.tap(Key::Char('g'), 30);
    while rig.position().x < 4.3 {
        rig.wait(1);
    }
    rig.tap(Key::Char('g'), 30);
    for _ in 0..9000 {
        if rig.app.screen() == AppScreen::Dead {
            return rig;
        }
        rig.wait(1);
    }
    panic!("alive at {} with {:?}", rig.position(), rig.game().health());
}

pub(crate) fn text(app: &mut App, columns: u16, rows: u16) -> String {
    let mut buffer = Buffer::empty(Rect::new(0, 0, columns, rows));
    app.draw(&mut buffer);
    let lines = buffer.content().chunks(columns.into());
    lines.flat_map(|line| line.iter().map(Cell::symbol).chain(["\n"])).collect()
}

#[test]
fn the_death_screen_names_the_cause_and_offers_a_retry() {
    let mut rig = dead();
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("killed by spikes") && shown.contains("> Try again"), "{shown}");
    rig.tap(Key::Enter, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen(), AppScreen::Dead, "nothing counts in the first half second");
    rig.wait(700);
    rig.tap(Key::Enter, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    assert_eq!((rig.position().x, rig.game().tally().deaths), (1.5, 1));
}

#[test]
fn a_dead_player_can_restart_or_leave_to_the_title() {
    let mut rig = dead();
    rig.wait(1000);
    rig.choose("Restart the level");
    assert_eq!((rig.app.screen(), rig.game().tally().deaths), (AppScreen::Playing, 0));
    assert!(rig.game().elapsed() < 1.0);
    let mut rig = dead();
    rig.wait(1000);
    rig.choose("Leave to the title");
    assert_eq!(rig.app.screen(), AppScreen::Title);
    let left = rig.app.left.as_ref().unwrap();
    assert!(left.starts_with("Danger on normal: 0:") && left.ends_with(", 0 of 50 gold"), "{left}");
}

/// A player who has run to the exit of the map with the spikes.
pub(crate) fn won() -> Rig {
    let mut rig = danger();
    // The player runs, to pass before the spikes come out.
    rig.tap(Key::Char('r'), 30);
    rig.tap(Key::Char('g'), 30);
    for _ in 0..9000 {
        rig.wait(1);
        if rig.app.screen() == AppScreen::Dead {
            rig.wait(700);
            rig.tap(Key::Enter, 30);
            rig.wait(300);
            rig.tap(Key::Char('g'), 30);
        }
        if rig.app.screen() == AppScreen::LevelDone {
            return rig;
        }
    }
    panic!("at {}", rig.position());
}

#[test]
fn the_end_of_a_level_shows_the_rank() {
    let mut rig = won();
    let shown = text(&mut rig.app, 80, 24);
    for wanted in ["you found the way out", "rank: ", "the par time of 0:30", "gold: 50 of 50"] {
        assert!(shown.contains(wanted), "{wanted}:\n{shown}");
    }
}

#[test]
fn the_status_line_shows_the_gold_found_and_needed() {
    const GOLD: &str = r##"
title = "Vault"
treasure_needed = 50
grid = '''
#########
#@.t.u.X#
#########
'''
[tiles]
"#" = { wall = "brick" }
[things]
"@" = { start = 0 }
"t" = { treasure = 50 }
"u" = { treasure = 80 }
"X" = { exit = true }
"##;
    let mut rig = playing_own(GOLD, Store::in_memory());
    let shown = |rig: &mut Rig, words: [&str; 2]| {
        for (columns, words) in [(120, words[0]), (72, words[1])] {
            let shown = text(&mut rig.app, columns, 24);
            let status = shown.lines().last().unwrap();
            assert!(status.contains(words), "{words}: {status}");
        }
    };
    shown(&mut rig, ["0 of 130 gold, 50 needed", "0/130 need 50"]);
    rig.tap(Key::Char('g'), 30);
    while rig.game().treasure().found == 0 {
        rig.wait(1);
    }
    shown(&mut rig, ["50 of 130 gold, enough", "50/130 gold"]);
    while rig.game().treasure().found == 50 {
        rig.wait(1);
    }
    shown(&mut rig, ["130 of 130 gold, enough", "130/130 gold"]);
}

#[test]
fn a_note_is_read_where_it_hangs() {
    let mut rig = danger();
    assert!(!text(&mut rig.app, 80, 24).contains("Mind the floor."));
    for _ in 0..4 {
        rig.tap(W, 30);
        rig.wait(300);
    }
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Mind the floor."), "at {}:\n{shown}", rig.position());
    assert!(shown.contains("♥♥♥♥♥♥"), "{shown}");
}

#[test]
fn the_level_list_shows_best_times_by_difficulty() {
    let mut store = Store::in_memory();
    let level = builtin::LEVELS[0].name;
    let tally = Tally { steps: 65 * 60, ..Tally::default() };
    store.record(level, Difficulty::Hard, Run { tally, rank: Rank::Shadow, script: String::new() });
    let mut rig = titled(Offers::default(), store);
    rig.choose("Levels");
    assert!(!text(&mut rig.app, 80, 24).contains("1:05.0"));
    rig.tap(Key::Right, 30);
    rig.wait(300);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("levels, hard") && shown.contains("1:05.0  Shadow"), "{shown}");
}

#[test]
fn enter_and_arrows_change_settings_and_they_are_kept() {
    let mut rig = titled(Offers::default(), Store::in_memory());
    rig.choose("Settings");
    rig.choose("Compass");
    assert!(rig.app.store.preferences().compass);
    rig.tap(Key::Down, 30);
    rig.wait(300);
    rig.tap(Key::Left, 30);
    rig.wait(300);
    assert!(!rig.app.store.preferences().ghost);
    for (label, depth) in [("Colours", ColorDepth::True), ("Colours", ColorDepth::Indexed256)] {
        rig.choose(label);
        assert_eq!(rig.app.depth(), depth);
    }
    rig.choose("Frames a second");
    assert_eq!(rig.app.settings.frame_time, Duration::from_secs(1) / 60);
    rig.choose("Characters");
    assert_eq!(rig.app.settings.glyphs, GlyphSet::Quadrant);
}

#[test]
fn the_daily_run_counts_once_and_a_descent_has_no_second_try() {
    let offers = Offers { today: Some(20_261_122), seed: 7, ..Offers::default() };
    let mut rig = titled(offers, Store::in_memory());
    rig.choose("Daily run");
    rig.choose("Begin the try that counts");
    assert_eq!(rig.app.levels.descent, Some(Descent::Daily));
    assert_eq!(rig.app.game.title(), "Floor 1");
    assert!(text(&mut rig.app, 120, 24).contains("Daily run: this try counts"));
    let floor = rig.game().world().clone();
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    assert!(!text(&mut rig.app, 80, 24).contains("Restart"));
    // The try is over, as after a death.
    rig.app.log = RunLog::default();
    rig.choose("Leave to the title");
    rig.choose("Daily run");
    rig.choose("Practise");
    assert_eq!(rig.app.levels.descent, Some(Descent::Practice));
    assert!(text(&mut rig.app, 120, 24).contains("Practice: only the day"));
    assert_eq!(rig.game().world().grid(), floor.grid(), "it is the same for all");
    let practice = "Practice: only the day's first try counts";
    assert!(rig.app.descent_lines().eq(["0 floors", practice]));
    rig.app.record_floor();
    assert_eq!(rig.app.store.daily(20_261_122).unwrap().floors, 0);
    rig.app.return_to_title();
    rig.choose("Endless");
    rig.app.record_floor();
    assert_eq!(rig.app.store.best_descent().unwrap().floors, 1);
    rig.app.next_level();
    assert_eq!(rig.app.game.title(), "Floor 2");
}

#[test]
fn the_bell_rings_once_when_the_player_is_hurt() {
    let mut rig = dead();
    assert!(rig.app.watch.take_ring());
    assert!(!rig.app.watch.take_ring());
}
