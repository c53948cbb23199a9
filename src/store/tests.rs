//! Properties of the store: on a real disk, with two games, and with a disk that fails.

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
use crate::tui::GlyphMode;
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
    };
    Run { tally, rank, script: format!("{steps} steps forward\n") }
}

fn saved(script: &str) -> SavedGame {
    let level = "my \"maps\"/a\u{7}.toml".to_owned();
    SavedGame {
        level,
        rules: Rules { difficulty: Hard, seed: u64::MAX },
        script: script.to_owned(),
        checksum: Some(0x0123_4567),
        descent: None,
    }
}

fn fill(store: &mut Store) {
    store.record("cellar", Normal, run(300, Rank::Thief));
    store.record("museum", Hard, run(500, Rank::Ghost));
    store.record("a b\\\"ä\n", Easy, run(7, Rank::Burglar));
    store.save(&saved("1 s forward\n"));
    store.save(&SavedGame { descent: Some(Descent::Practice), ..saved("5 s forward\n") });
    store.set_preferences(Preferences {
        compass: true,
        ghost: false,
        glyphs: Some(GlyphMode::Ascii),
        colors: Some(ColorDepth::Indexed16),
        frames_per_second: NonZeroU32::new(60),
        ..Preferences::default()
    });
    store.begin_daily(20_261_122);
    let script = || "4 s forward\n".to_owned();
    store.record_daily(20_261_122, Reached { floors: 3, treasure: 90, steps: 4000 }, script());
    store.record_descent(Reached { floors: 9, treasure: 1, steps: 9000 }, script());
}

/// Everything that a store shows.
fn shown(store: &Store) -> String {
    let scripts = [("cellar", Normal), ("museum", Hard), ("a b\\\"ä\n", Easy)];
    let scripts =
        scripts.map(|(level, at)| (store.best(level, at).copied(), store.script(level, at)));
    let won: Vec<&str> = store.won(Normal).collect();
    let saved = [Slot::Level, Slot::Descent].map(|slot| store.saved(slot));
    let kept = (saved, store.preferences(), store.daily(20_261_122), store.best_descent());
    format!("{scripts:?} {won:?} {kept:?}")
}

#[test]
fn what_is_kept_is_there_in_the_next_game() {
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
fn a_file_of_the_first_version_is_read() {
    let folder = Folder::new();
    fs::create_dir_all(folder.0.join("runs")).unwrap();
    fs::write(folder.0.join("runs/saved.1.script"), "1 s forward\n").unwrap();
    let text = "version = 1\n[preferences]\ncrosshair = true\ncompass = false\nbell = false\n\
                ghost = true\ndifficulty = \"hard\"\n[saved]\nlevel = \"cellar\"\n\
                difficulty = \"easy\"\nseed = \"0\"\nscript = \"saved.1.script\"\n";
    fs::write(folder.progress(), text).unwrap();
    let mut store = sound(&folder.0);
    let preferences = Preferences { crosshair: true, difficulty: Hard, ..Preferences::default() };
    assert_eq!(store.preferences(), preferences);
    let game = store.saved(Slot::Level).unwrap();
    assert_eq!((game.level.as_str(), game.checksum, game.descent), ("cellar", None, None));
    store.set_preferences(Preferences { bell: true, ..preferences });
    assert!(folder.text().contains("version = 2"), "{}", folder.text());
    assert_eq!(sound(&folder.0).saved(Slot::Level), Some(game));
}

#[test]
fn the_better_result_stays() {
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
    assert_eq!(sound(&folder.0).daily(20_261_122).unwrap().reached.floors, 2);
    let names = folder.names(".script");
    assert_eq!(names, ["daily.20261122.2-10-900.script", "descent.2-10-900.script"]);
    let text = |name: &str| fs::read_to_string(folder.0.join("runs").join(name)).unwrap();
    assert_eq!(text(&names[0]) + &text(&names[1]), "900 steps forward\n900 steps run\n");
    assert!(one.begin_daily(20_261_123));
}

#[test]
fn a_saved_game_replaces_the_one_before() {
    let folder = Folder::new();
    let mut store = sound(&folder.0);
    store.save(&saved("1 s forward\n"));
    store.save(&saved("2 s forward\n"));
    assert_eq!(sound(&folder.0).saved(Slot::Level), Some(saved("2 s forward\n")));
    assert_eq!(folder.names(".script").len(), 1);
    let descent = SavedGame { descent: Some(Descent::Daily), ..saved("3 s forward\n") };
    store.save(&descent);
    store.clear_saved(Slot::Level);
    assert_eq!(sound(&folder.0).saved(Slot::Level), None);
    assert_eq!(sound(&folder.0).saved(Slot::Descent), Some(descent));
    store.clear_saved(Slot::Descent);
    assert_eq!((sound(&folder.0).saved(Slot::Descent), folder.names(".script").len()), (None, 0));
}
