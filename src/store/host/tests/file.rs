//! The file of a store: who may read it, damage, and other versions.

use std::path::Path;

use rusqlite::Connection;

use super::*;

/// Makes a store with many accounts, and returns the path of its file.
fn filled(folder: &Path) -> PathBuf {
    let (mut store, _) = SqliteStore::open(folder).unwrap();
    for number in 0..=250_u8 {
        let text = format!("n-{number}-x");
        let account = store.create_account(&key(number), &name(&text), at(0)).unwrap();
        if number < 20 {
            store
                .record(account.id, &run("cellar", 100 + u64::from(number), Rank::Thief), at(1))
                .unwrap();
        }
    }
    folder.join("host.db")
}

fn accounts(store: &mut SqliteStore) -> usize {
    (0..=250).filter(|&number| store.account(&key(number)).unwrap().is_some()).count()
}

#[test]
fn what_is_kept_is_there_after_a_restart() {
    let folder = Folder::new();
    filled(&folder.0);
    let (mut store, sentence) = SqliteStore::open(&folder.0).unwrap();
    assert_eq!((accounts(&mut store), sentence), (251, None));
    assert_eq!(store.level_scores(&board("cellar"), 99).unwrap().len(), 20);
}

#[cfg(unix)]
#[test]
fn nobody_else_reads_it() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let inner = folder.0.join("a/b");
    let (mut store, _) = SqliteStore::open(&inner).unwrap();
    store.create_account(&key(1), &name("Ada"), at(0)).unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    assert_eq!([mode(&folder.0), mode(&inner)], [0o700; 2]);
    for file in ["host.db", "host.db-wal", "host.db-shm"] {
        assert_eq!(mode(&inner.join(file)), 0o600, "{file}");
    }
    drop(store);
    fs::set_permissions(inner.join("host.db"), fs::Permissions::from_mode(0o644)).unwrap();
    SqliteStore::open(&inner).unwrap();
    assert_eq!(mode(&inner.join("host.db")), 0o600);
}

#[test]
fn a_damaged_file_is_kept_and_what_can_be_read_stays() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let mut content = fs::read(&file).unwrap();
    assert!(content.len() > 20 * 4096);
    // A page in the middle.
    content[10 * 4096..11 * 4096].fill(0x5a);
    fs::write(&file, &content).unwrap();
    let (mut store, sentence) = SqliteStore::open(&folder.0).unwrap();
    let sentence = sentence.unwrap();
    assert!(sentence.contains("host.db.damaged-1") && sentence.lines().count() == 1, "{sentence}");
    assert_eq!(fs::read(folder.0.join("host.db.damaged-1")).unwrap(), content);
    let left = accounts(&mut store);
    assert!((100..=251).contains(&left), "{left}");
    drop(store);
    let (mut store, sentence) = SqliteStore::open(&folder.0).unwrap();
    assert_eq!((accounts(&mut store), sentence), (left, None));
}

#[test]
fn a_file_without_anything_readable_is_kept() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    for (number, content) in (1..).zip([&b"SQLite format 3\0nonsense"[..], &[7; 5000], &[0; 4096]])
    {
        fs::write(&file, content).unwrap();
        let (mut store, sentence) = SqliteStore::open(&folder.0).unwrap();
        assert!(sentence.is_some_and(|it| it.contains("0 rows")));
        assert_eq!(accounts(&mut store), 0);
        let kept = folder.0.join(format!("host.db.damaged-{number}"));
        assert_eq!(fs::read(kept).unwrap(), content);
    }
}

#[test]
fn a_file_cut_short_is_kept() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let content = fs::read(&file).unwrap();
    fs::write(&file, &content[..content.len() * 2 / 3]).unwrap();
    let (mut store, sentence) = SqliteStore::open(&folder.0).unwrap();
    assert!(sentence.is_some_and(|it| it.contains("host.db.damaged-1")));
    store.create_account(&key(251), &name("Later"), at(0)).unwrap();
}

#[test]
fn other_files_are_left_alone() {
    let folder = Folder::new();
    let file = filled(&folder.0);
    let alter = |sql: &str| Connection::open(&file).unwrap().execute_batch(sql).unwrap();
    let refused = || {
        let before = fs::read(&file).unwrap();
        let sentence = SqliteStore::open(&folder.0).unwrap_err().to_string();
        assert_eq!(SqliteStore::open_to_read(&folder.0).unwrap_err().to_string(), sentence);
        assert!(sentence.lines().count() == 1 && fs::read(&file).unwrap() == before);
        sentence
    };
    alter("PRAGMA user_version = 99");
    assert!(refused().contains("has version 99, which a newer Cellcaster wrote"));
    alter("PRAGMA user_version = 1; PRAGMA application_id = 7");
    assert!(refused().contains("belongs to another program"));
    let blocked = folder.0.join("blocked");
    fs::write(&blocked, "").unwrap();
    let sentence = SqliteStore::open(&blocked).unwrap_err().to_string();
    assert!(sentence.contains("can't be used"), "{sentence}");
}

#[test]
fn a_reader_sees_what_a_host_writes() {
    let folder = Folder::new();
    assert!(SqliteStore::open_to_read(&folder.0).unwrap().is_none());
    assert!(!folder.0.exists());
    let (mut host, _) = SqliteStore::open(&folder.0).unwrap();
    let mut reader = SqliteStore::open_to_read(&folder.0).unwrap().unwrap();
    let ada = host.create_account(&key(1), &name("Ada"), at(0)).unwrap();
    host.record(ada.id, &run("cellar", 9, Rank::Ghost), at(0)).unwrap();
    assert_eq!(reader.level_scores(&board("cellar"), 9).unwrap()[0].name, ada.name);
    let refused = reader.create_account(&key(2), &name("Bob"), at(0));
    assert!(matches!(refused, Err(Refusal::Failed(_))), "{refused:?}");
    drop((host, reader));
    let mut reader = SqliteStore::open_to_read(&folder.0).unwrap().unwrap();
    assert_eq!(reader.account(&key(1)).unwrap(), Some(ada));
}
