//! Several games in one folder.

use std::thread;
use std::time::Duration;

use super::*;

#[test]
fn concurrent_games_lose_nothing() {
    const GAMES: u64 = 4;
    const RUNS: u64 = 12;
    let folder = Folder::new();
    thread::scope(|scope| {
        for game in 0..GAMES {
            let folder = &folder.0;
            scope.spawn(move || {
                let mut store = sound(folder);
                for number in 0..RUNS {
                    store.record(&format!("level {game} {number}"), Normal, run(9, Rank::Thief));
                    let steps = 1000 - (number * GAMES + game);
                    store.record("same", Normal, run(steps, Rank::Thief));
                    // Locks are not fair. Without a pause, one game could starve the others.
                    thread::sleep(Duration::from_millis(4));
                }
                assert_eq!(store.trouble(), None);
            });
        }
    });
    let store = sound(&folder.0);
    assert_eq!(store.won(Normal).count() as u64, GAMES * RUNS + 1);
    let least = 1000 - (GAMES * RUNS - 1);
    assert_eq!(store.best("same", Normal).unwrap().tally.steps, least);
    assert_eq!(store.script("same", Normal).unwrap(), format!("{least} steps forward\n"));
    assert_eq!(folder.names("same").len(), 1);
    assert!(folder.names(".new").is_empty());
}

#[test]
fn a_game_sees_changes_by_another() {
    let folder = Folder::new();
    let (mut one, mut other) = (sound(&folder.0), sound(&folder.0));
    one.record("cellar", Normal, run(300, Rank::Thief));
    one.set_preferences(Preferences { bell: true, ..one.preferences() });
    other.set_preferences(Preferences { compass: true, ..other.preferences() });
    assert!(other.preferences().bell && other.preferences().compass);
    assert_eq!(other.best("cellar", Normal).unwrap().tally.steps, 300);
    // The next record removes the script that `other` knows.
    one.record("cellar", Normal, run(200, Rank::Thief));
    assert_eq!(other.script("cellar", Normal).unwrap(), "200 steps forward\n");
}

#[test]
fn a_game_continues_while_another_holds_the_lock() {
    let folder = Folder::new();
    let mut store = sound(&folder.0);
    store.record("cellar", Normal, run(300, Rank::Thief));
    let lock = fs::File::open(folder.0.join("progress.lock")).unwrap();
    lock.lock().unwrap();
    assert!(store.record("museum", Normal, run(200, Rank::Thief)).time);
    assert!(store.trouble().unwrap().contains("can't be written"));
    assert!(sound(&folder.0).best("museum", Normal).is_none());
    assert_eq!(store.script("museum", Normal).unwrap(), "200 steps forward\n");
    lock.unlock().unwrap();
    store.set_preferences(Preferences { bell: true, ..store.preferences() });
    assert_eq!(store.trouble(), None);
    assert_eq!(shown(&sound(&folder.0)), shown(&store));
    assert!(sound(&folder.0).script("museum", Normal).is_some());
}
