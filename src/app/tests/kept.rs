//! Data that is kept from one game to the next: the saved game, results, and the ghost of the best
//! run.

use std::fs;
use std::path::PathBuf;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use super::missions::{DANGER, offering, playing_own, text, won};
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::app::store::{Run, map_key};
use crate::game::{Intents, LevelName, Script};
use crate::map::builtin;

/// A folder that is removed at the end of a test.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("cellcaster-{name}-{}", std::process::id()));
        Self(folder)
    }

    fn store(&self) -> Store {
        let (store, trouble) = Store::open(&self.0);
        assert_eq!(trouble, None);
        store
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A test that failed before the first change has no folder.
        _ = fs::remove_dir_all(&self.0);
    }
}

fn playing_builtin(store: Store) -> Rig {
    let mut rig = titled(Offers::default(), store);
    rig.choose("New game");
    rig.choose("Normal");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    rig
}

/// Walks, turns, throws a pebble and uses the lamp, so the state also depends on chance and on the
/// guards.
fn play_about(rig: &mut Rig) {
    rig.press(W);
    rig.wait(1500);
    rig.press(Key::Right);
    rig.wait(700);
    rig.tap(Key::Char('t'), 30);
    rig.wait(900);
    rig.tap(Key::Char('l'), 30);
    rig.wait(400);
}

/// Leaves the game from the pause page, and continues it in a second program on the same folder.
/// Returns the original game and the continued one, after the same number of steps.
fn left_and_continued(rig: Rig, folder: &Folder, offers: Offers) -> (Game, Rig) {
    let mut rig = rig;
    rig.tap(Key::Char('p'), 30);
    rig.wait(300);
    let mut left = rig.game().clone();
    rig.choose("Leave to the title");
    drop(rig);
    let mut rig = titled(offers, folder.store());
    assert_eq!(rig.app.pages.menu.label().as_deref(), Some("Continue"));
    rig.tap(Key::Enter, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    while left.tally().steps < rig.game().tally().steps {
        left.step(Intents::new());
    }
    (left, rig)
}

#[test]
fn a_game_resumes_exactly_where_it_was_left() {
    let folder = Folder::new("left");
    let mut rig = playing_builtin(folder.store());
    play_about(&mut rig);
    let (left, rig) = left_and_continued(rig, &folder, Offers::default());
    assert!(left.tally().steps > 200, "{:?}", left.tally());
    assert_eq!(left.checksum(), rig.game().checksum());
    assert_eq!(left, *rig.game());
}

#[test]
fn a_game_in_the_players_own_map_resumes_unless_it_changed() {
    let folder = Folder::new("own");
    let mut rig = playing_own(DANGER, folder.store());
    rig.tap(W, 30);
    rig.wait(500);
    let offers = offering("danger.toml", DANGER);
    let mut title = titled(offering("danger.toml", DANGER), folder.store());
    let (left, rig) = left_and_continued(rig, &folder, offers);
    assert_eq!(left, *rig.game());
    drop(rig);

    title.app.store = folder.store();
    title.app.offers = Some(offering("danger.toml", PIT));
    title.app.show_title();
    let shown = text(&mut title.app, 80, 24);
    assert!(shown.contains("Continue  Danger"), "{shown}");
    title.choose("Continue");
    assert_eq!(title.app.screen(), AppScreen::Title);
    let shown = text(&mut title.app, 80, 24);
    assert!(shown.contains("The map of the saved game has changed."), "{shown}");
}

#[test]
fn results_in_the_players_own_map_are_kept_with_their_script() {
    let mut rig = won();
    let key = map_key("danger.toml", DANGER);
    let best = rig.app.store.best(&key, Difficulty::Normal).unwrap();
    assert_eq!(best.tally, rig.game().tally());
    let script = rig.app.store.script(&key, Difficulty::Normal).unwrap();
    let script = Script::parse(&script, "it").unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!(script.header().level, LevelName::new(&key));
    let mut again = Game::new(parse_str(DANGER).unwrap());
    script.iter().for_each(|(_, intents)| again.step(intents));
    assert!(again.is_finished());
    assert_eq!(again.tally(), rig.game().tally());
    rig.wait(700);
    rig.choose("Leave to the title");
    rig.choose("My maps");
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("my maps, normal") && shown.contains("0:0"), "{shown}");
}

#[test]
fn the_ghost_walks_the_best_run_and_can_be_switched_off() {
    let mut store = Store::in_memory();
    let level = builtin::LEVELS[0].name;
    let tally = Tally { steps: 3600, ..Tally::default() };
    let script = format!("level {level}\n10 s turn-right\n2 s forward\n");
    store.record(level, Difficulty::Normal, Run { tally, rank: Rank::Thief, script });
    let mut rig = playing_builtin(store);
    let figures = |rig: &mut Rig| {
        text(&mut rig.app, 40, 12);
        let see_through = |figure: &&Figure| figure.opacity == 96;
        let ghosts = rig.game().world().figures().iter().filter(see_through).copied();
        ghosts.collect::<Vec<_>>()
    };
    rig.wait(200);
    let first = figures(&mut rig);
    rig.wait(500);
    let second = figures(&mut rig);
    assert_eq!((first.len(), second.len()), (1, 1));
    assert_ne!(first[0].heading, second[0].heading, "it does what its script says");
    assert!(rig.app.is_stale() || rig.app.next_change().is_some());
    rig.tap(Key::Char('0'), 30);
    assert_eq!(figures(&mut rig), []);
    assert!(!rig.app.store.preferences().ghost);
}

#[test]
fn switching_the_ghost_is_announced_and_shown_on_the_map() {
    let mut rig = playing_own(DANGER, Store::in_memory());
    let status = |rig: &mut Rig| text(&mut rig.app, 120, 24).lines().last().unwrap().to_owned();
    for said in ["The ghost is off", "The ghost is on: you have no best run here yet"] {
        rig.tap(Key::Char('0'), 30);
        rig.wait(300);
        let shown = status(&mut rig);
        assert!(shown.contains(said), "{shown}");
    }

    let mut store = Store::in_memory();
    let key = map_key("danger.toml", DANGER);
    let tally = Tally { steps: 3600, ..Tally::default() };
    let script = "1 s forward\n50 s stand\n".to_owned();
    store.record(&key, Difficulty::Normal, Run { tally, rank: Rank::Thief, script });
    let mut rig = playing_own(DANGER, store);
    rig.wait(1500);
    assert!(text(&mut rig.app, 120, 24).contains('▹'), "{}", text(&mut rig.app, 120, 24));
    rig.tap(Key::Char('0'), 30);
    rig.wait(300);
    let shown = text(&mut rig.app, 120, 24);
    assert!(!shown.contains('▹') && shown.contains("The ghost is off"), "{shown}");
    rig.tap(Key::Char('0'), 30);
    rig.wait(300);
    let shown = text(&mut rig.app, 120, 24);
    assert!(shown.contains('▹') && shown.contains("The ghost of your best run is on"), "{shown}");
    // Like a goal, the notice disappears after some time of play.
    rig.tap(Key::Char('g'), 30);
    rig.wait(800);
    rig.app.notice.as_mut().unwrap().moved(4 * 60);
    assert!(!status(&mut rig).contains("The ghost"));
}

#[test]
fn the_ghost_changes_only_the_pixels_where_it_stands() {
    const MEETING: &str = r##"
grid = '''
##########
#@.......#
##########
'''
[tiles]
"#" = { wall = "#808080" }
[things]
"@" = { start = 0 }
"##;
    let key = map_key("danger.toml", MEETING);
    let mut store = Store::in_memory();
    let script = "1 s forward\n60 s stand\n".to_owned();
    let tally = Tally { steps: 3660, ..Tally::default() };
    store.record(&key, Difficulty::Normal, Run { tally, rank: Rank::Thief, script });
    let mut rig = playing_own(MEETING, store);
    rig.app.terminal.depth = ColorDepth::True;
    rig.app.map.is_shown = false;
    rig.wait(3000);
    let picture = |rig: &mut Rig| {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 80, 24));
        rig.app.draw(&mut buffer);
        buffer
    };
    let with = picture(&mut rig);
    rig.tap(Key::Char('0'), 30);
    rig.wait(300);
    let without = picture(&mut rig);
    let changed: Vec<(u16, u16)> = (0..23)
        .flat_map(|y| (0..80).map(move |x| (x, y)))
        .filter(|&place| with[place] != without[place])
        .collect();
    assert!((8..400).contains(&changed.len()), "{}", changed.len());
    // The ghost stands three cells ahead, in the middle of the picture.
    assert!(changed.iter().all(|&(x, _)| (30..50).contains(&x)), "{changed:?}");
}
