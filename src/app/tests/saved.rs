//! Saved games: changed levels, descents, and the settings that the store keeps.

use super::missions::text;
use super::titles::titled;
use super::*;
use crate::app::recording::RunLog;
use crate::app::store::{Descent, MAX_SAVES, Run, Save, SaveId, SavedGame, map_key};
use crate::app::{InitialState, Offers, Origin, OwnLevel, SettingOrigins};
use crate::game::{Header, Intents, Script};
use crate::map::builtin;
use crate::tui::GlyphSet;

/// Leaves a game for the title, which keeps the same store.
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
    match rig.app.screen() {
        AppScreen::NewGame => rig.choose("Normal"),
        AppScreen::Daily => rig.choose("Begin the try that counts"),
        _ => {}
    }
    walk(&mut rig);
    rig
}

/// Walks for two seconds.
fn walk(rig: &mut Rig) {
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    rig.press(W);
    rig.wait(1500);
    rig.release(W);
    rig.wait(700);
}

/// The newest saved game.
fn newest(rig: &Rig) -> Option<SavedGame> {
    let id = rig.app.store.saves().next()?.id();
    rig.app.store.saved(id)
}

/// The level names and difficulties in the list of saved games.
fn saved_levels(rig: &Rig) -> Vec<(&str, Difficulty)> {
    let saves = rig.app.store.saves();
    saves.map(|save| (save.level.as_str(), save.rules.difficulty)).collect()
}

#[test]
fn a_game_in_a_changed_level_can_start_over() {
    let mut rig = playing("New game", Offers::default());
    leave(&mut rig);
    let saved = newest(&rig).unwrap();
    let id = saved.save.id();
    // Simulates a change of the level: the script now leads to a different state.
    let save = Save { checksum: saved.save.checksum ^ 1, ..saved.save.clone() };
    let changed = SavedGame { save, ..saved };
    rig.app.store.save(&changed).unwrap();
    rig.choose("Continue");
    assert_eq!(rig.app.screen(), AppScreen::Outdated(id));
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("The level has changed since you left it."), "{shown}");
    rig.tap(Key::Escape, 30);
    rig.wait(300);
    assert_eq!(rig.app.screen(), AppScreen::Title);
    assert_eq!(newest(&rig), Some(changed), "a look costs nothing");
    rig.choose("Continue");
    rig.choose("Start over");
    assert_eq!((rig.app.screen(), newest(&rig)), (AppScreen::Playing, None));
    assert!(rig.game().elapsed() < 1.0);
}

#[test]
fn a_saved_descent_resumes_only_once() {
    let offers = || Offers { today: Some(20_261_122), seed: 7, ..Offers::default() };
    for (label, name) in
        [("Endless", "Endless on normal"), ("Daily run", "Daily run of 2026-11-22")]
    {
        let mut rig = playing(label, offers());
        let course = rig.app.levels.descent;
        let mut left = leave(&mut rig);
        let shown = text(&mut rig.app, 80, 24);
        assert!(shown.contains(&format!("Continue  {name}")), "{shown}");
        rig.choose("Continue");
        assert_eq!((rig.app.screen(), rig.app.levels.descent), (AppScreen::Playing, course));
        while left.tally().steps < rig.game().tally().steps {
            left.step(Intents::new());
        }
        assert_eq!(left, *rig.game());
        assert_eq!(newest(&rig), None);
        // The descent can be saved again, with the script from its beginning.
        let steps = leave(&mut rig).tally().steps;
        let saved = newest(&rig).unwrap();
        assert_eq!(Script::parse(&saved.script, "it").unwrap().steps(), steps);
    }
}

#[test]
fn each_level_and_difficulty_has_a_save_and_the_newest_is_first() {
    let mut rig = playing("New game", Offers::default());
    leave(&mut rig);
    rig.choose("New game");
    rig.choose("Hard");
    walk(&mut rig);
    leave(&mut rig);
    rig.choose("Levels");
    rig.choose("Citadel");
    walk(&mut rig);
    leave(&mut rig);
    rig.choose("Endless");
    walk(&mut rig);
    let left = leave(&mut rig);
    let (hard, normal) = (Difficulty::Hard, Difficulty::Normal);
    let all = [("floor 1", hard), ("citadel", hard), ("cellar", hard), ("cellar", normal)];
    assert_eq!(saved_levels(&rig), all);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Continue  4 games"), "{shown}");
    rig.choose("Continue");
    let shown = text(&mut rig.app, 80, 24);
    let names = ["Endless on hard", "Citadel on hard", "Cellar on hard", "Cellar on normal"];
    let places: Vec<Option<usize>> = names.iter().map(|name| shown.find(name)).collect();
    assert!(places.is_sorted() && places.iter().all(Option::is_some), "{shown}");
    assert!(shown.contains("> Endless on hard") && shown.contains("0:02"), "{shown}");
    rig.choose("Endless on hard");
    let since = rig.game().tally().steps - left.tally().steps;
    assert!(since < 60, "it has gone on for the time of this test: {since} steps");
}

/// The program, started with a built-in level.
fn started(level: &str, store: Store) -> Rig {
    let index = builtin::LEVELS.iter().position(|it| it.name == level).unwrap();
    let levels = InitialState::Levels(Box::new(Levels::builtin(index).unwrap()));
    Rig::of(App::opened(levels, Settings::default(), store), Some((500, 30)))
}

/// Ends the program, and returns its store.
fn quit(mut rig: Rig) -> Store {
    rig.app.leave();
    std::mem::replace(&mut rig.app.store, Store::in_memory())
}

#[test]
fn a_level_with_a_saved_game_asks_before_replacing_it() {
    let mut rig = started("cellar", Store::in_memory());
    assert_eq!(rig.app.screen(), AppScreen::Playing, "nothing is saved, and nothing is asked");
    walk(&mut rig);
    let left = rig.game().clone();
    let store = quit(rig);
    // The other level has no saved game, so nothing is asked and nothing is replaced.
    let mut rig = started("citadel", store);
    walk(&mut rig);
    let rig = started("cellar", quit(rig));
    assert_eq!(rig.app.screen(), AppScreen::HasSaved);
    let saved = |rig: &Rig| {
        let id = rig.app.store.saves().find(|save| save.level == "cellar").map(Save::id)?;
        rig.app.store.saved(id)
    };
    let first = saved(&rig).unwrap();
    assert_eq!(first.save.checksum, left.checksum());

    // Nothing is lost by leaving at the question, or before the first step.
    let mut rig = started("cellar", quit(rig));
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Cellar on normal: 0:02 played"), "{shown}");
    rig.tap(Key::Escape, 30);
    assert!(rig.app.has_left);
    let mut rig = started("cellar", quit(rig));
    assert_eq!(saved(&rig), Some(first.clone()));

    rig.choose("Continue");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    assert!(rig.game().tally().steps >= left.tally().steps);
    let mut rig = started("cellar", quit(rig));
    assert!(saved(&rig).unwrap().script.len() >= first.script.len());

    rig.choose("Start over");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    assert!(rig.game().elapsed() < 1.0);
    assert!(saved(&rig).is_some(), "it is kept while the new game is played");
    let rig = started("cellar", quit(rig));
    assert!(saved(&rig).unwrap().save.steps < first.save.steps);
}

#[test]
fn a_resumed_game_is_recorded_from_the_start_of_its_level() {
    let mut rig = started("cellar", Store::in_memory());
    walk(&mut rig);
    let mut rig = started("cellar", quit(rig));
    let script =
        std::env::temp_dir().join(format!("cellcaster-record-{}.script", std::process::id()));
    let file = std::fs::File::create(&script).unwrap();
    rig.app.script =
        Some(crate::game::ScriptWriter::with_header(Box::new(file), Header::default()));
    rig.choose("Continue");
    walk(&mut rig);
    rig.app.script = None;
    let recorded = std::fs::read_to_string(&script).unwrap();
    std::fs::remove_file(&script).unwrap();
    let recorded = Script::parse(&recorded, "it").unwrap_or_else(|faults| panic!("{faults}"));
    let saved = Script::parse(&rig.app.log.script(), "it").unwrap();
    assert!(recorded.iter().eq(saved.iter()));
    assert_eq!(recorded.steps(), rig.game().tally().steps);
}

#[test]
fn the_next_campaign_level_asks_too_and_is_listed_with_saved_games() {
    let mut store = Store::in_memory();
    let tally = Tally { steps: 3600, ..Tally::default() };
    let run = Run { tally, rank: Rank::Thief, script: String::new() };
    store.record("cellar", Difficulty::Normal, run);
    let mut rig = started("museum", store);
    walk(&mut rig);
    let mut rig = titled(Offers::default(), quit(rig));
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Continue  Museum on normal"), "the saved game is in it: {shown}");
    rig.choose("Endless");
    walk(&mut rig);
    leave(&mut rig);
    assert!(text(&mut rig.app, 80, 24).contains("Continue  2 games"));
    rig.app.begin(Levels::builtin(0).unwrap());
    rig.app.next_level();
    assert_eq!(
        (rig.app.game.title(), rig.app.screen()),
        ("The Museum of Walls", AppScreen::HasSaved)
    );
}

#[test]
fn removing_a_saved_game_from_the_list_asks_first() {
    let mut rig = playing("New game", Offers::default());
    leave(&mut rig);
    rig.choose("Endless");
    walk(&mut rig);
    leave(&mut rig);
    let remove = |rig: &mut Rig, answer: &str| {
        rig.tap(Key::Char('x'), 30);
        rig.wait(300);
        assert!(matches!(rig.app.screen(), AppScreen::Remove(_)));
        rig.choose(answer);
    };
    rig.choose("Continue");
    remove(&mut rig, "Keep it");
    assert_eq!((rig.app.screen(), saved_levels(&rig).len()), (AppScreen::Saves, 2));
    remove(&mut rig, "Remove it");
    assert_eq!(saved_levels(&rig), [("cellar", Difficulty::Normal)]);
    remove(&mut rig, "Remove it");
    assert_eq!((rig.app.screen(), saved_levels(&rig).len()), (AppScreen::Title, 0));
    assert!(!text(&mut rig.app, 80, 24).contains("Continue"));
}

/// A store without room for another game.
fn full() -> Store {
    let mut store = Store::in_memory();
    let rules = crate::game::Rules::default();
    for number in 0..MAX_SAVES {
        let level = format!("level {number}-0123456789abcdef");
        let save = Save { level, file: None, rules, descent: None, steps: 60, checksum: 0 };
        store.save(&SavedGame { save, script: "1 s forward\n".to_owned() }).unwrap();
    }
    store
}

#[test]
fn a_full_store_asks_first_and_the_game_says_it_is_not_saved() {
    let ids = |rig: &Rig| rig.app.store.saves().map(Save::id).collect::<Vec<SaveId>>();
    let mut rig = started("cellar", full());
    let before = ids(&rig);
    assert_eq!(rig.app.screen(), AppScreen::NoRoom);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Remove the oldest") && shown.contains("Level 0 on normal"), "{shown}");
    rig.choose("Play without saving");
    walk(&mut rig);
    rig.tap(Key::Char('q'), 30);
    assert!(text(&mut rig.app, 80, 24).contains("no room to save the game"));
    rig.app.leave();
    assert_eq!(ids(&rig), before);
    let left = rig.app.left.clone().unwrap();
    let sentence = "The game is not saved: 100 other games are saved, which is the maximum.";
    assert!(left.ends_with(sentence), "{left}");

    let mut rig = started("cellar", quit(rig));
    rig.choose("Remove the oldest");
    assert_eq!((rig.app.screen(), ids(&rig).len()), (AppScreen::Playing, MAX_SAVES - 1));
    walk(&mut rig);
    rig.tap(Key::Char('q'), 30);
    assert!(text(&mut rig.app, 80, 24).contains("the game is saved"));
    let store = quit(rig);
    assert_eq!(store.saves().next().unwrap().level, "cellar");

    // The daily try does not begin if it could not be saved.
    let offers = Offers { today: Some(20_261_122), ..Offers::default() };
    let mut rig = titled(offers, store);
    rig.choose("Daily run");
    assert!(!text(&mut rig.app, 80, 24).contains("Begin the try"));
    rig.choose("Remove the oldest");
    rig.choose("Begin the try that counts");
    assert_eq!(rig.app.screen(), AppScreen::Playing);
}

#[test]
fn the_daily_run_asks_first_and_resumes_as_the_same_try() {
    let offers = || Offers { today: Some(20_261_122), seed: 7, ..Offers::default() };
    // A start from the shell asks the same question as the title does.
    let opening = InitialState::Daily(offers());
    let mut rig = Rig::of(App::opened(opening, Settings::default(), Store::in_memory()), None);
    assert_eq!(rig.app.screen(), AppScreen::Daily);
    let shown = text(&mut rig.app, 80, 24);
    for words in ["The descent of 2026-11-22", "Only one try counts", "it is saved"] {
        assert!(shown.contains(words), "{words}: {shown}");
    }
    rig.tap(Key::Escape, 30);
    rig.wait(300);
    assert_eq!((rig.app.screen(), rig.app.store.daily(20_261_122)), (AppScreen::Title, None));

    rig.choose("Daily run");
    rig.choose("Begin the try that counts");
    let counts = Some(Descent::Daily);
    assert_eq!((rig.app.levels.descent, rig.app.screen()), (counts, AppScreen::Playing));
    walk(&mut rig);
    rig.tap(Key::Char('q'), 30);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("q or Enter leaves the program"), "{shown}");
    assert!(shown.contains("the game is saved"), "{shown}");
    rig.tap(Key::Enter, 30);
    assert!(rig.app.has_left);

    let mut rig = titled(offers(), quit(rig));
    rig.choose("Daily run");
    let shown = text(&mut rig.app, 80, 24);
    assert!(
        !shown.contains("Practise"),
        "the floors are not shown before the try is over: {shown}"
    );
    rig.choose("Continue the try that counts");
    assert_eq!((rig.app.levels.descent, rig.app.screen()), (counts, AppScreen::Playing));
    assert!(rig.game().elapsed() > 1.5);
    assert_eq!(newest(&rig), None);
    // The program is killed, so the try is over.
    rig.app.log = RunLog::default();
    rig.app.return_to_title();
    rig.choose("Daily run");
    assert!(text(&mut rig.app, 80, 24).contains("The try that counts reached 0 floors."));
    rig.choose("Practise");
    assert_eq!(rig.app.levels.descent, Some(Descent::Practice));
    walk(&mut rig);
    leave(&mut rig);
    // Practice has its own saved game.
    rig.choose("Daily run");
    rig.choose("Practise");
    assert_eq!(rig.app.screen(), AppScreen::HasSaved);
    rig.choose("Continue");
    assert!(rig.game().elapsed() > 1.5);
}

#[test]
fn a_game_in_a_map_file_resumes_from_any_folder() {
    let file = "/somewhere/else/pit.toml";
    let own = |text: &str| {
        let level = Level::from(parse_str(text).unwrap());
        OwnLevel { level, key: map_key("pit.toml", text), file: Some(file.to_owned()) }
    };
    let opening = InitialState::Levels(Box::new(Levels::own(own(PIT))));
    let app = App::opened(opening, Settings::default(), Store::in_memory());
    let mut rig = Rig::of(app, Some((500, 30)));
    walk(&mut rig);
    let left = rig.game().clone();
    let store = quit(rig);

    let offering = |text: &'static str| {
        let load = move |path: &str| {
            assert_eq!(path, file);
            if text.is_empty() { Err(format!("{path} is no longer a file")) } else { Ok(own(text)) }
        };
        Offers { load: Some(Box::new(load)), ..Offers::default() }
    };
    let mut rig = titled(offering(""), store);
    assert!(text(&mut rig.app, 80, 24).contains("Continue  Pit on normal"));
    rig.choose("Continue");
    assert_eq!(rig.app.screen(), AppScreen::Title);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("/somewhere/else/pit.toml is no longer a file"), "{shown}");
    rig.app.offers = Some(offering(PIT));
    rig.choose("Continue");
    assert!(rig.game().tally().steps >= left.tally().steps);
    leave(&mut rig);
    // A change of the map that makes the script lead elsewhere.
    let text = PIT.replace("start = 0", "start = 180").leak();
    rig.app.offers = Some(offering(text));
    rig.choose("Continue");
    assert!(matches!(rig.app.screen(), AppScreen::Outdated(_)), "{:?}", rig.app.screen());
}

#[test]
fn settings_are_kept_unless_a_flag_or_a_file_sets_them() {
    let thirty = Duration::from_secs(1) / 30;
    let mut rig = titled(Offers::default(), Store::in_memory());
    rig.choose("Settings");
    for label in ["Characters", "Colours", "Frames a second"] {
        rig.choose(label);
    }
    let kept = rig.app.store.preferences();
    assert_eq!(kept.glyphs, Some(GlyphSet::Quadrant));
    assert_eq!(kept.colors, Some(ColorDepth::True));
    assert_eq!(kept.frames_per_second.map(u32::from), Some(60));

    let plain = Settings { frame_time: thirty, ..Settings::default() };
    let next = plain.clone().preferring(&kept);
    assert_eq!((next.glyphs, next.depth), (GlyphSet::Quadrant, Some(ColorDepth::True)));
    assert_eq!(next.frame_time, Duration::from_secs(1) / 60);

    let given = SettingOrigins { frame_time: Some(Origin::File), ..SettingOrigins::default() };
    let given = SettingOrigins { glyphs: Some(Origin::Flag), ..given };
    let next = Settings { given, ..plain }.preferring(&kept);
    assert_eq!((next.glyphs, next.frame_time), (GlyphSet::Half, thirty));
    assert_eq!(next.depth, Some(ColorDepth::True));
    let app = App::opened(InitialState::Title(Offers::default()), next, Store::in_memory());
    let mut rig = Rig::of(app, Some((500, 30)));
    rig.choose("Settings");
    let shown = text(&mut rig.app, 80, 24);
    for line in ["half blocks (flag)", "30 (file)", "holds again at the next start"] {
        assert!(shown.contains(line), "{line}: {shown}");
    }
    rig.choose("Characters");
    assert!(!text(&mut rig.app, 80, 24).contains("(flag)"), "the player has chosen another");
}
