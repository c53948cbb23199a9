//! The file of a store: its permissions, damage, and other versions.

use std::path::Path;

use rusqlite::Connection;

use super::*;

/// Makes a store with many accounts, and returns the path of its file.
fn filled(folder: &Path) -> PathBuf {
    let mut store = HostStore::open(folder).unwrap();
    for number in 0..=250_u8 {
        let text = format!("n-{number}-x");
        let account = store.create_account(None, &key(number), &name(&text), at(0)).unwrap();
        if number < 20 {
            store
                .record(account.id, &run("cellar", 100 + u64::from(number), Rank::Thief), at(1))
                .unwrap();
        }
    }
    folder.join("host.db")
}

fn accounts(store: &mut HostStore) -> usize {
    (0..=250).filter(|&number| store.account(&key(number)).unwrap().is_some()).count()
}

#[test]
fn stored_data_survives_a_restart() {
    let folder = Folder::new();
    filled(&folder.0);
    let mut store = HostStore::open(&folder.0).unwrap();
    assert_eq!(accounts(&mut store), 251);
    assert_eq!(store.level_scores(&board("cellar"), 99).unwrap().len(), 20);
}

#[cfg(unix)]
#[test]
fn only_its_owner_can_read_the_file() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let inner = folder.0.join("a/b");
    let mut store = HostStore::open(&inner).unwrap();
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!([mode(&folder.0), mode(&inner)], [0o700; 2]);
    for file in ["host.db", "host.db-wal", "host.db-shm"] {
        assert_eq!(mode(&inner.join(file)), 0o600, "{file}");
    }
    drop(store);
    fs::set_permissions(inner.join("host.db"), fs::Permissions::from_mode(0o644)).unwrap();
    HostStore::open(&inner).unwrap();
    assert_eq!(mode(&inner.join("host.db")), 0o600);
}

/// Copies the files of a store in the state that a killed process leaves.
fn killed(folder: &Folder) -> Folder {
    let copy = Folder::new();
    fs::create_dir_all(&copy.0).unwrap();
    for name in ["host.db", "host.db-wal"] {
        fs::copy(folder.0.join(name), copy.0.join(name)).unwrap();
    }
    copy
}

/// The number of accounts in `host.db` without its log.
fn accounts_in_the_file_alone(folder: &Folder) -> usize {
    let copy = Folder::new();
    fs::create_dir_all(&copy.0).unwrap();
    fs::copy(folder.0.join("host.db"), copy.0.join("host.db")).unwrap();
    accounts(&mut HostStore::open(&copy.0).unwrap())
}

#[test]
fn the_log_is_copied_into_the_file_at_each_start_and_end() {
    let folder = Folder::new();
    let mut store = HostStore::open(&folder.0).unwrap();
    for number in 0..99 {
        store.create_account(None, &key(number), &name(&format!("n-{number}-x")), at(0)).unwrap();
    }
    let killed = killed(&folder);
    assert_eq!(accounts_in_the_file_alone(&killed), 0);
    let length = || fs::metadata(killed.0.join("host.db-wal")).unwrap().len();
    assert!(length() > 0);
    let _next = HostStore::open(&killed.0).unwrap();
    assert_eq!((length(), accounts_in_the_file_alone(&killed)), (0, 99));

    store.checkpoint().unwrap();
    assert_eq!(fs::metadata(folder.0.join("host.db-wal")).unwrap().len(), 0);
    assert_eq!(accounts_in_the_file_alone(&folder), 99);
}

/// All files in a folder, with their content.
fn files(folder: &Folder) -> Vec<(PathBuf, Vec<u8>)> {
    let paths = fs::read_dir(&folder.0).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> = paths.map(|path| (path.clone(), fs::read(path).unwrap())).collect();
    files.sort();
    files
}

/// Asserts that opening a store fails because it is damaged, and that nothing in its folder changes.
fn assert_refused(folder: &Folder) {
    let before = files(folder);
    let sentence = HostStore::open(&folder.0).unwrap_err().to_string();
    let file = folder.0.join("host.db").display().to_string();
    assert!(sentence.starts_with(&format!("{file} is damaged: ")), "{sentence}");
    for part in ["a backup", "without accounts"] {
        assert!(sentence.contains(part) && sentence.lines().count() == 1, "{sentence}");
    }
    assert!(files(folder) == before, "a file has changed");
}

#[test]
fn a_damaged_file_is_refused_and_kept() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let mut content = fs::read(&file).unwrap();
    assert!(content.len() > 20 * 4096);
    // A page in the middle.
    content[10 * 4096..11 * 4096].fill(0x5a);
    fs::write(&file, &content).unwrap();
    assert_refused(&folder);
}

#[test]
fn an_unreadable_file_is_refused_and_kept() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    for content in [&b"SQLite format 3\0nonsense"[..], &[7; 5000], &[0; 4096], &[]] {
        fs::write(&file, content).unwrap();
        assert_refused(&folder);
    }
}

#[test]
fn a_truncated_file_is_refused_and_kept() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let content = fs::read(&file).unwrap();
    fs::write(&file, &content[..content.len() * 2 / 3]).unwrap();
    assert_refused(&folder);
}

/// SQLite itself would create a new file, and delete the log.
#[test]
fn a_log_without_its_file_is_refused_and_kept() {
    let folder = Folder::new();
    let mut store = HostStore::open(&folder.0).unwrap();
    store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let killed = killed(&folder);
    fs::remove_file(killed.0.join("host.db")).unwrap();
    assert_refused(&killed);
}

/// SQLite itself reports that there is no room.
#[test]
fn a_full_disk_is_distinguished_from_other_failures() {
    let folder = Folder::new();
    let mut store = HostStore::open(&folder.0).unwrap();
    let account = store.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    let pages: i64 =
        store.connection().query_row("PRAGMA page_count", [], |row| row.get(0)).unwrap();
    let set = |store: &HostStore, most: i64| {
        store.connection().pragma_update(None, "max_page_count", most).unwrap();
    };
    set(&store, pages);
    let script = "#".repeat(AccountSettings::MAX_BYTES);
    let settings = AccountSettings { configuration: script, ..AccountSettings::default() };
    let failure = store.set_settings(account.id, &settings).unwrap_err();
    assert!(matches!(failure, StoreFailure::Full(_)), "{failure}");
    set(&store, 1_000_000);
    store.set_settings(account.id, &settings).unwrap();
}

#[test]
fn other_files_are_left_alone() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let alter = |sql: &str| Connection::open(&file).unwrap().execute_batch(sql).unwrap();
    let refused = || {
        let before = fs::read(&file).unwrap();
        let sentence = HostStore::open(&folder.0).unwrap_err().to_string();
        assert_eq!(HostStore::open_to_read(&folder.0).unwrap_err().to_string(), sentence);
        assert!(sentence.lines().count() == 1 && fs::read(&file).unwrap() == before);
        sentence
    };
    alter("PRAGMA user_version = 99");
    assert!(refused().contains("has version 99, which a newer Cellcaster wrote"));
    for version in [-5, 3] {
        alter(&format!("PRAGMA user_version = {version}"));
        let said = format!("has version {version}, which this Cellcaster can't read");
        assert!(refused().contains(&said));
    }
    alter("PRAGMA user_version = 1; PRAGMA application_id = 7");
    assert!(refused().contains("belongs to another program"));
    let blocked = folder.0.join("blocked");
    fs::write(&blocked, "").unwrap();
    let sentence = HostStore::open(&blocked).unwrap_err().to_string();
    assert!(sentence.contains("can't be used"), "{sentence}");
}

#[cfg(unix)]
#[test]
fn a_named_pipe_is_refused_without_waiting() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    fs::remove_file(&file).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(&file).status().unwrap().success());
    let sentences = [
        HostStore::open(&folder.0).unwrap_err().to_string(),
        HostStore::open_to_read(&folder.0).unwrap_err().to_string(),
    ];
    for sentence in sentences {
        assert!(sentence.contains("it is a named pipe, not a file"), "{sentence}");
    }
}

#[test]
fn a_reader_sees_the_changes_of_a_host() {
    let folder = Folder::new();
    assert!(HostStore::open_to_read(&folder.0).unwrap().is_none());
    assert!(!folder.0.exists());
    let mut host = HostStore::open(&folder.0).unwrap();
    let mut reader = HostStore::open_to_read(&folder.0).unwrap().unwrap();
    let ada = host.create_account(None, &key(1), &name("Ada"), at(0)).unwrap();
    host.record(ada.id, &run("cellar", 9, Rank::Ghost), at(0)).unwrap();
    assert_eq!(reader.level_scores(&board("cellar"), 9).unwrap()[0].name, ada.name);
    let refused = reader.create_account(None, &key(2), &name("Bob"), at(0));
    assert!(matches!(refused, Err(AccountRefusal::Failed(_))), "{refused:?}");
    drop((host, reader));
    let mut reader = HostStore::open_to_read(&folder.0).unwrap().unwrap();
    assert_eq!(reader.account(&key(1)).unwrap(), Some(ada));
}
