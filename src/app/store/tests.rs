//! Properties of the store on a real disk, with two games at once, and on a disk that fails.

mod damage;
mod failing;
mod sharing;

use std::fs;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::*;
use crate::color::palette::ColorDepth;
use crate::game::{Rank, Rules, Share, Tally};
use crate::terminal::Key;
use crate::tui::{Correction, GlyphSet};
use crate::world::Difficulty::{Easy, Hard, Normal};

/// A folder that is removed at the end of a test.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("cellcaster-store-{}-{number}", std::process::id());
        Self(std::env::temp_dir().join(name))
    }

    fn progress(&self) -> PathBuf {
        self.0.join("progress.toml")
    }

    fn text(&self) -> String {
        fs::read_to_string(self.progress()).unwrap()
    }

    /// The names in the folder that contain `part`, in order.
    fn names(&self, part: &str) -> Vec<String> {
        let entries =
            fs::read_dir(&self.0).unwrap().chain(fs::read_dir(self.0.join("runs")).unwrap());
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.filter(|name| name.contains(part)).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        _ = fs::remove_dir_all(&self.0);
    }
}

fn sound(folder: &Path) -> Store {
    let (store, sentence) = Store::open(folder);
    assert_eq!(sentence, None);
    store
}

fn run(steps: u64, rank: Rank) -> Run {
    let tally = Tally {
        steps,
        treasure: Share { found: 2, total: 3 },
        secrets: Share { found: 0, total: 1 },
        alarms: 4,
        deaths: 5,
        stunned: 6,
        taken_back: 0,
    };
    Run { tally, rank, script: format!("{steps} steps forward\n") }
}

fn saved(script: &str) -> SavedGame {
    let level = "my \"maps\"/a\u{7}.toml".to_owned();
    let save = Save {
        level,
        file: None,
        rules: Rules { difficulty: Hard, seed: u64::MAX },
        descent: None,
        steps: 60,
        checksum: 0x0123_4567,
    };
    SavedGame { save, script: script.to_owned() }
}

/// A saved game in level number `level`.
fn saved_in(level: usize) -> SavedGame {
    let game = saved(&format!("{level} s forward\n"));
    SavedGame { save: Save { level: format!("level {level}"), ..game.save }, ..game }
}

/// `game` as a descent of this kind.
fn of_descent(kind: Descent, game: SavedGame) -> SavedGame {
    SavedGame { save: Save { descent: Some(kind), ..game.save }, ..game }
}

/// The saved games with their scripts, newest first.
fn all_saved(store: &Store) -> Vec<SavedGame> {
    store.saves().map(|save| store.saved(save.id()).unwrap()).collect()
}

fn fill(store: &mut Store) {
    store.record("cellar", Normal, run(300, Rank::Thief));
    store.record("museum", Hard, run(500, Rank::Ghost));
    store.record("a b\\\"ä\n", Easy, run(7, Rank::Burglar));
    store.save(&saved("1 s forward\n")).unwrap();
    store.save(&of_descent(Descent::Practice, saved("5 s forward\n"))).unwrap();
    store.set_preferences(Preferences {
        compass: true,
        ghost: false,
        glyphs: Some(GlyphSet::Ascii),
        colors: Some(ColorDepth::Indexed16),
        correction: Correction::RedGreen,
        frames_per_second: NonZeroU32::new(60),
        runs: true,
        field_of_view: ViewAngle::try_from(90).ok(),
        ..Preferences::default()
    });
    let own = [("forward", vec![Key::Char('z'), Key::Up]), ("strike", Vec::new())];
    store.set_keys(own.into());
    store.begin_daily(20_261_122);
    let script = || "4 s forward\n".to_owned();
    store.record_daily(20_261_122, Reached { floors: 3, treasure: 90, steps: 4000 }, script());
    store.record_descent(Reached { floors: 9, treasure: 1, steps: 9000 }, script());
}

/// Everything that a store returns, as text.
fn shown(store: &Store) -> String {
    let scripts = [("cellar", Normal), ("museum", Hard), ("a b\\\"ä\n", Easy)];
    let scripts =
        scripts.map(|(level, at)| (store.best(level, at).copied(), store.script(level, at)));
    let won: Vec<&str> = store.won(Normal).collect();
    let kept =
        (all_saved(store), store.preferences(), store.daily(20_261_122), store.best_descent());
    let kept = (kept, store.keys());
    format!("{scripts:?} {won:?} {kept:?}")
}

#[test]
fn stored_data_survives_a_restart() {
    let folder = Folder::new();
    let mut store = sound(&folder.0);
    fill(&mut store);
    assert_eq!(store.trouble(), None);
    let mut in_memory = Store::in_memory();
    fill(&mut in_memory);
    let kept = shown(&sound(&folder.0));
    assert_eq!(kept, shown(&store));
    assert_eq!(kept, shown(&in_memory));
    assert!(kept.contains("7 steps forward") && kept.contains("1 s forward"), "{kept}");
    insta::assert_snapshot!(folder.text());
}

#[test]
fn the_better_result_is_kept() {
    let folder = Folder::new();
    let mut store = sound(&folder.0);
    let mut improved = |steps, rank| {
        let Improved { time, rank } = store.record("cellar", Normal, run(steps, rank));
        (time, rank)
    };
    assert_eq!(improved(300, Rank::Thief), (true, true));
    assert_eq!(improved(300, Rank::Thief), (false, false));
    assert_eq!(improved(400, Rank::Ghost), (false, true));
    assert_eq!(improved(200, Rank::Burglar), (true, false));
    assert_eq!(improved(201, Rank::Shadow), (false, false));
    let store = sound(&folder.0);
    let best = store.best("cellar", Normal).unwrap();
    assert_eq!((best.tally.steps, best.rank), (200, Rank::Ghost));
    assert_eq!(store.script("cellar", Normal).unwrap(), "200 steps forward\n");
    assert_eq!(folder.names(".script"), ["cellar.normal.200.script"]);
}

#[test]
fn only_the_first_try_of_a_day_counts() {
    let folder = Folder::new();
    let (mut one, mut other) = (sound(&folder.0), sound(&folder.0));
    assert!(one.begin_daily(20_261_122));
    assert!(!other.begin_daily(20_261_122));
    assert!(!one.begin_daily(20_261_122));
    assert!(!sound(&folder.0).begin_daily(20_261_122));
    assert!(folder.names(".script").is_empty());
    let mut reach = |floors, treasure, steps| {
        let reached = Reached { floors, treasure, steps };
        one.record_daily(20_261_122, reached, format!("{steps} steps forward\n"));
        one.record_descent(reached, format!("{steps} steps run\n"));
    };
    reach(1, 40, 500);
    reach(2, 10, 900);
    reach(1, 99, 500);
    assert_eq!(sound(&folder.0).daily(20_261_122).unwrap().floors, 2);
    let names = folder.names(".script");
    assert_eq!(names, ["daily.20261122.2-10-900.script", "descent.2-10-900.script"]);
    let text = |name: &str| fs::read_to_string(folder.0.join("runs").join(name)).unwrap();
    assert_eq!(text(&names[0]) + &text(&names[1]), "900 steps forward\n900 steps run\n");
    assert!(one.begin_daily(20_261_123));
}

#[test]
fn a_saved_game_replaces_only_its_own_earlier_version() {
    let folder = Folder::new();
    let mut store = sound(&folder.0);
    let game = saved("1 s forward\n");
    let with = |change: fn(&mut Save)| {
        let mut other = game.clone();
        change(&mut other.save);
        other
    };
    let all = [
        game.clone(),
        with(|save| save.level = "cellar".to_owned()),
        with(|save| save.rules.difficulty = Easy),
        with(|save| save.file = Some("/maps/a.toml".to_owned())),
        with(|save| save.file = Some("/maps/b.toml".to_owned())),
        with(|save| save.descent = Some(Descent::Daily)),
        with(|save| save.descent = Some(Descent::Practice)),
        with(|save| (save.descent, save.rules.seed) = (Some(Descent::Daily), 20_261_123)),
    ];
    for game in &all {
        store.save(game).unwrap();
    }
    let newest_first = |games: &[SavedGame]| games.iter().rev().cloned().collect::<Vec<_>>();
    assert_eq!(all_saved(&sound(&folder.0)), newest_first(&all));

    // A map file keeps its identity after a change of its text.
    let mut later = all[3].clone();
    (later.save.level, later.script) = ("changed".to_owned(), "2 s forward\n".to_owned());
    store.save(&later).unwrap();
    let mut expected = newest_first(&all);
    expected.remove(4);
    expected.insert(0, later.clone());
    assert_eq!(all_saved(&sound(&folder.0)), expected);

    for game in &expected {
        store.remove_saved(game.save.id());
    }
    assert_eq!(all_saved(&sound(&folder.0)), []);
    assert_eq!(folder.names(".script").len(), 0);
}

#[test]
fn a_full_store_refuses_a_game_and_loses_none() {
    let mut store = Store::in_memory();
    for level in 0..MAX_SAVES {
        assert!(store.has_room_for(saved_in(level).save.id()));
        store.save(&saved_in(level)).unwrap();
    }
    let before = all_saved(&store);
    let one_more = saved_in(MAX_SAVES);
    assert!(!store.has_room_for(one_more.save.id()));
    assert_eq!(store.save(&one_more), Err(NotSaved::Full));
    assert_eq!(all_saved(&store), before);
    // A saved game can always replace its own earlier version.
    let again = SavedGame { script: "again\n".to_owned(), ..saved_in(7) };
    store.save(&again).unwrap();
    assert_eq!(all_saved(&store)[0], again);
    let long = SavedGame { script: "x".repeat(5 << 20), ..saved_in(7) };
    assert_eq!(store.save(&long), Err(NotSaved::TooLong));
    assert_eq!(all_saved(&store)[0], again);
    store.remove_saved(saved_in(3).save.id());
    store.save(&one_more).unwrap();
}
