//! Damaged files, files of other versions, and unusable folders.

use proptest::prelude::*;

use super::*;

/// A folder with a filled store.
fn filled() -> Folder {
    let folder = Folder::new();
    fill(&mut sound(&folder.0));
    folder
}

#[test]
fn a_damaged_value_loses_only_its_result() {
    let folder = filled();
    let damaged = folder.text().replace("steps = 300", "steps = -3");
    fs::write(folder.progress(), &damaged).unwrap();
    let (store, sentence) = Store::open(&folder.0);
    let sentence = sentence.unwrap().replace(&folder.0.display().to_string(), "FOLDER");
    let expected = "FOLDER/progress.toml was damaged and is kept as progress.toml.damaged-1; \
                    everything readable in it is still used";
    assert_eq!(sentence, expected);
    assert!(store.best("cellar", Normal).is_none());
    assert!(store.best("museum", Hard).is_some());
    assert_eq!(all_saved(&store).len(), 2);
    assert_eq!(fs::read_to_string(folder.0.join("progress.toml.damaged-1")).unwrap(), damaged);
    // The script of the damaged result is not removed.
    assert_eq!(folder.names("cellar"), ["cellar.normal.300.script"]);
    assert_eq!(shown(&sound(&folder.0)), shown(&store));
}

#[test]
fn a_file_that_is_not_text_is_set_aside_and_replaced() {
    let folder = filled();
    fs::write(folder.progress(), b"\xff\xfe\0\0 version = 1").unwrap();
    let (mut store, sentence) = Store::open(&folder.0);
    assert!(sentence.unwrap().contains("damaged-1"));
    store.record("cellar", Normal, run(5, Rank::Thief));
    fs::write(folder.progress(), "}").unwrap();
    assert!(Store::open(&folder.0).1.unwrap().contains("damaged-2"));
    assert_eq!(folder.names("damaged").len(), 2);
}

#[test]
fn a_file_damaged_during_the_game_is_completed_from_memory() {
    let folder = filled();
    let mut store = sound(&folder.0);
    fs::write(folder.progress(), "version = 4\n[best.cellar\n").unwrap();
    store.record("citadel", Normal, run(5, Rank::Thief));
    assert!(store.trouble().unwrap().contains("damaged-1"));
    let next = sound(&folder.0);
    assert_eq!(shown(&next), shown(&store));
    assert_eq!(next.won(Normal).collect::<Vec<_>>(), ["cellar", "citadel"]);
    assert_eq!(all_saved(&next).len(), 2);
    assert!(!next.preferences().ghost);
}

#[test]
fn a_file_from_a_newer_version_is_left_alone() {
    let folder = filled();
    let newer = folder.text().replace("version = 4", "version = 5") + "[unknown]\n";
    fs::write(folder.progress(), &newer).unwrap();
    let (mut store, sentence) = Store::open(&folder.0);
    assert!(sentence.unwrap().contains("version 5"));
    assert!(store.record("cellar", Normal, run(5, Rank::Thief)).time);
    assert!(store.trouble().unwrap().contains("newer"));
    assert_eq!((folder.text(), folder.names("damaged").len()), (newer, 0));
}

#[test]
fn an_oversized_file_is_set_aside_unread() {
    let folder = filled();
    fs::File::create(folder.progress()).unwrap().set_len(1 << 40).unwrap();
    let (store, sentence) = Store::open(&folder.0);
    assert!(sentence.unwrap().contains("too large"));
    assert_eq!(store.won(Normal).count(), 0);
    assert_eq!(folder.names("damaged"), ["progress.toml.damaged-1"]);
    sound(&folder.0);
}

#[test]
fn a_damaged_script_is_ignored() {
    let folder = filled();
    let script = folder.0.join("runs/cellar.normal.300.script");
    fs::write(&script, b"\xff").unwrap();
    assert_eq!(sound(&folder.0).script("cellar", Normal), None);
    fs::File::create(&script).unwrap().set_len(1 << 40).unwrap();
    assert_eq!(sound(&folder.0).script("cellar", Normal), None);
    fs::remove_file(&script).unwrap();
    assert_eq!(sound(&folder.0).script("cellar", Normal), None);
    assert!(sound(&folder.0).best("cellar", Normal).is_some());
}

#[test]
fn a_file_in_place_of_the_folder_does_not_stop_the_game() {
    let folder = Folder::new();
    fs::create_dir_all(&folder.0).unwrap();
    fs::write(folder.0.join("file"), "").unwrap();
    let (mut store, sentence) = Store::open(&folder.0.join("file"));
    assert!(sentence.is_some());
    fill(&mut store);
    assert!(store.trouble().is_some());
    assert!(store.script("cellar", Normal).is_some());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// A truncated number would look like a better result.
    #[test]
    fn a_truncated_file_invents_nothing(index: prop::sample::Index) {
        let mut store = Store::in_memory();
        fill(&mut store);
        let text = store.progress.to_string();
        let length = index.index(text.len());
        // A text from which only whole sections at the end are missing is sound.
        let (read, _) = text::read(&text.as_bytes()[..length]).unwrap();
        for (key, best) in &read.bests {
            prop_assert_eq!(Some(best), store.progress.bests.get(key));
        }
        for (date, daily) in &read.dailies {
            prop_assert_eq!(Some(daily), store.progress.dailies.get(date));
        }
        prop_assert!(store.progress.saves.starts_with(&read.saves));
        prop_assert!(read.descent.is_none() || read.descent == store.progress.descent);
    }

    #[test]
    fn reading_any_content_never_panics(content: Vec<u8>, flips in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 0..8)) {
        _ = text::read(&content);
        let mut store = Store::in_memory();
        fill(&mut store);
        let mut text = store.progress.to_string().into_bytes();
        for (index, byte) in flips {
            let place = index.index(text.len());
            text[place] = byte;
        }
        _ = text::read(&text);
    }

    #[test]
    fn written_progress_reads_back_unchanged(levels in prop::collection::vec(("(?s).{0,12}", any::<u32>()), 0..6)) {
        let mut store = Store::in_memory();
        fill(&mut store);
        for (level, steps) in &levels {
            store.record(level, Easy, run((*steps).into(), Rank::Shadow));
        }
        let text = store.progress.to_string();
        prop_assert_eq!(text::read(text.as_bytes()), Ok((store.progress, true)));
    }
}

#[test]
fn the_newest_three_damaged_files_are_kept() {
    let folder = filled();
    for number in 1..=7 {
        fs::write(folder.progress(), format!("{number}")).unwrap();
        assert!(Store::open(&folder.0).1.unwrap().contains(&format!("damaged-{number};")));
    }
    let kept = folder.names("damaged");
    assert_eq!(kept, [5, 6, 7].map(|number| format!("progress.toml.damaged-{number}")));
    let texts: Vec<_> =
        kept.iter().map(|name| fs::read_to_string(folder.0.join(name)).unwrap()).collect();
    assert_eq!(texts, ["5", "6", "7"]);
}

#[cfg(unix)]
#[test]
fn a_named_pipe_is_reported_and_never_waited_for() {
    let pipe = |path: &Path| {
        _ = fs::remove_file(path);
        assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    };
    for name in ["progress.toml", "progress.lock", "progress.toml.new"] {
        let folder = filled();
        pipe(&folder.0.join(name));
        let (mut store, sentence) = Store::open(&folder.0);
        store.record("citadel", Normal, run(5, Rank::Thief));
        let sentence = sentence.or(store.trouble().map(str::to_owned)).unwrap();
        assert!(sentence.contains("it is a named pipe, not a file: move it away"), "{sentence}");
    }
}

#[cfg(unix)]
#[test]
fn other_users_cannot_read_the_store() {
    use std::os::unix::fs::PermissionsExt;
    let folder = filled();
    let mode = |name: &str| fs::metadata(folder.0.join(name)).unwrap().permissions().mode() & 0o777;
    assert_eq!((mode(""), mode("runs")), (0o700, 0o700));
    assert_eq!((mode("progress.toml"), mode("progress.lock")), (0o600, 0o600));
    assert_eq!(mode("runs/cellar.normal.300.script"), 0o600);
}
