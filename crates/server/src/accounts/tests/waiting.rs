//! Results that wait while the store is unavailable.

use super::*;

const WON: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/cellar.normal.script"));

fn waiting(folder: &Folder) -> WaitingResults {
    fs::create_dir_all(&folder.0).unwrap();
    let (waiting, sentence) = WaitingResults::open(&folder.0).unwrap();
    assert_eq!(sentence, None);
    waiting
}

fn result(number: u8, day: u64, script: &str) -> WaitingResult {
    WaitingResult { key: key(number), at: at(day), script: script.to_owned() }
}

fn cellar(store: &mut HostStore) -> Vec<LevelScore> {
    store.level_scores(&LevelBoard::new("cellar", Difficulty::Normal).unwrap(), 9).unwrap()
}

#[test]
fn results_survive_the_host_and_keep_their_own_time() {
    let (folder, mut store) = (Folder::new(), HostStore::in_memory());
    for (number, text) in [(1, "Ada"), (2, "Bob")] {
        store.create_account(None, &key(number), &name(text), at(0)).unwrap();
    }
    let mut before = waiting(&folder);
    before.add(result(2, 3, WON)).unwrap();
    before.add(result(1, 4, WON)).unwrap();
    before.save().unwrap();
    drop(before);

    let mut after = waiting(&folder);
    assert_eq!(after.len(), 2);
    let mut away = HostStore::failing(StoreFailure::Away("gone".into()));
    assert!(matches!(after.record(0, &mut away, |_| None, at(5)), Some(LateOutcome::NotNow)));
    assert_eq!(after.len(), 2);
    for text in ["Bob", "Ada"] {
        let late = after.record(0, &mut store, |_| None, at(5));
        assert!(
            matches!(late, Some(LateOutcome::Recorded(account, _)) if account.name == name(text))
        );
    }
    assert!(after.record(0, &mut store, |_| None, at(5)).is_none());
    let scores = cellar(&mut store);
    assert_eq!(scores.iter().map(|it| it.verified_at).collect::<Vec<_>>(), [at(3), at(4)]);

    // The host is killed before it saves. All results are recorded again, and nothing changes.
    let mut again = waiting(&folder);
    assert_eq!(again.len(), 2);
    while again.record(0, &mut store, |_| None, at(9)).is_some() {}
    assert_eq!(cellar(&mut store), scores);
    again.save().unwrap();
    assert!(waiting(&folder).is_empty());
    assert_eq!(fs::read_dir(&folder.0).unwrap().count(), 0);
}

#[test]
fn a_daily_result_that_waited_counts_for_the_day_on_which_it_was_won() {
    let corridor = "grid = '''\n#####\n#@.>#\n#####\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                    [things]\n\"@\" = { start = 0 }\n\">\" = { exit = true }\n";
    let world =
        |level: &str| cellcaster::map::parse(corridor, level, &cellcaster::map::NoFiles).ok();
    let (folder, mut store) = (Folder::new(), HostStore::in_memory());
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let level = Day::of(at(3)).level();
    let script = format!("level {level}\n4 s forward\n");
    let mut waiting = waiting(&folder);
    for day in [3, 5] {
        waiting.add(result(1, day, &script)).unwrap();
    }
    let counts = waiting.record(0, &mut store, world, at(6));
    assert!(matches!(counts, Some(LateOutcome::Recorded(..))), "{counts:?}");
    let late = waiting.record(0, &mut store, world, at(6));
    assert!(matches!(late, Some(LateOutcome::Refuted(_, Unverified::OtherDay))), "{late:?}");
    let board = LevelBoard::new(&level, Difficulty::Normal).unwrap();
    assert_eq!(store.level_scores(&board, 9).unwrap()[0].verified_at, at(3));
}

#[test]
fn refused_results_wait_a_week_and_invalid_ones_do_not_wait() {
    let (folder, mut store) = (Folder::new(), HostStore::in_memory());
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let mut waiting = waiting(&folder);
    waiting.add(result(7, 0, WON)).unwrap();
    waiting.add(result(1, 0, "level cellar\n2 s forward\n")).unwrap();
    waiting.add(result(1, 0, WON)).unwrap();
    let nobody = waiting.record(0, &mut store, |_| None, at(6));
    assert!(matches!(nobody, Some(LateOutcome::Refused(_))), "{nobody:?}");
    let refuted = waiting.record(1, &mut store, |_| None, at(6));
    assert!(matches!(refuted, Some(LateOutcome::Refuted(_, Unverified::NotWon))), "{refuted:?}");
    // It does not block the results behind it.
    let recorded = waiting.record(1, &mut store, |_| None, at(6));
    assert!(matches!(recorded, Some(LateOutcome::Recorded(..))), "{recorded:?}");
    let mut full = HostStore::failing(StoreFailure::new("the disk is full"));
    assert!(matches!(waiting.record(0, &mut full, |_| None, at(6)), Some(LateOutcome::Refused(_))));
    assert!(matches!(
        waiting.record(0, &mut store, |_| None, at(8)),
        Some(LateOutcome::GivenUp(..))
    ));
    assert!(waiting.is_empty());
}

#[test]
fn the_file_is_bounded_and_a_damaged_one_is_set_aside() {
    let folder = Folder::new();
    let mut waiting = waiting(&folder);
    let long = "#".repeat(6 << 20);
    waiting.add(result(1, 0, &long)).unwrap();
    waiting.add(result(1, 1, &long)).unwrap();
    assert!(waiting.add(result(1, 2, &long)).is_err());
    assert_eq!(waiting.len(), 2);
    waiting.save().unwrap();

    let file = folder.0.join("waiting_results");
    let mut content = fs::read(&file).unwrap();
    content.truncate(content.len() - 9);
    fs::write(&file, &content).unwrap();
    let (waiting, sentence) = WaitingResults::open(&folder.0).unwrap();
    assert!(sentence.unwrap().contains("waiting_results.damaged"));
    assert_eq!(waiting.len(), 1);
    assert_eq!(fs::read(folder.0.join("waiting_results.damaged")).unwrap(), content);
    assert_eq!(WaitingResults::open(&folder.0).unwrap().1, None);
}

#[cfg(unix)]
#[test]
fn only_its_owner_can_read_the_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let mut waiting = waiting(&folder);
    waiting.add(result(1, 0, WON)).unwrap();
    waiting.save().unwrap();
    let mode = fs::metadata(folder.0.join("waiting_results")).unwrap().permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
}

#[test]
fn unwritten_results_wait_in_memory() {
    let (folder, mut store) = (Folder::new(), HostStore::in_memory());
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let mut results = waiting(&folder);
    fs::remove_dir_all(&folder.0).unwrap();
    results.add(result(1, 1, WON)).unwrap();
    assert!(results.save().is_err());
    assert_eq!(results.len(), 1);
    // A full store takes nothing, however long it stays full.
    let mut full = HostStore::failing(StoreFailure::Full("no room".into()));
    assert!(matches!(results.record(0, &mut full, |_| None, at(99)), Some(LateOutcome::NotNow)));
    fs::create_dir_all(&folder.0).unwrap();
    results.save().unwrap();
    assert_eq!(waiting(&folder).len(), 1);
    assert!(matches!(
        results.record(0, &mut store, |_| None, at(99)),
        Some(LateOutcome::Recorded(..))
    ));
    assert_eq!(cellar(&mut store)[0].verified_at, at(1));
}
