//! A disk on which one operation fails, as on a full disk, or on which an operation and all later
//! ones fail, as in a power cut.

use std::ffi::OsString;
use std::fs::File;
use std::io;
use std::sync::Arc;
use std::sync::atomic::AtomicUsize;

use super::*;
use crate::app::store::home::{Disk, SystemFiles};

/// The real disk with a range of failing operations.
#[derive(Clone, Debug)]
struct Failing {
    /// The number of operations up to now.
    count: Arc<AtomicUsize>,
    /// The first operation that fails.
    from: usize,
    /// The first operation that succeeds again.
    to: usize,
}

impl Failing {
    fn check(&self) -> io::Result<()> {
        let number = self.count.fetch_add(1, Ordering::Relaxed);
        if (self.from..self.to).contains(&number) {
            return Err(io::ErrorKind::StorageFull.into());
        }
        Ok(())
    }
}

impl Disk for Failing {
    fn create_folder(&self, folder: &Path) -> io::Result<()> {
        self.check()?;
        SystemFiles.create_folder(folder)
    }

    fn read(&self, file: &Path, most: u64) -> io::Result<Vec<u8>> {
        self.check()?;
        SystemFiles.read(file, most)
    }

    fn write(&self, file: &Path, content: &[u8]) -> io::Result<()> {
        self.check().inspect_err(|_| _ = fs::write(file, &content[..content.len() / 2]))?;
        SystemFiles.write(file, content)
    }

    fn rename(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.check()?;
        SystemFiles.rename(from, to)
    }

    fn remove(&self, file: &Path) -> io::Result<()> {
        self.check()?;
        SystemFiles.remove(file)
    }

    fn names(&self, folder: &Path) -> io::Result<Vec<OsString>> {
        self.check()?;
        SystemFiles.names(folder)
    }

    fn lock(&self, file: &Path, attempts: u32) -> io::Result<Option<File>> {
        self.check()?;
        SystemFiles.lock(file, attempts)
    }
}

/// Opens a store on a disk where operations `from` to `to` fail.
fn failing(folder: &Folder, from: usize, to: usize) -> (Store, Arc<AtomicUsize>) {
    let count = Arc::new(AtomicUsize::new(0));
    let disk = Failing { count: count.clone(), from, to };
    (Store::at(Home::new(folder.0.clone(), Box::new(disk))).0, count)
}

/// Makes one change of each kind, and calls `observe` after each of them.
fn play(store: &mut Store, mut observe: impl FnMut(&Store)) {
    let changes: [fn(&mut Store); 6] = [
        |store| _ = store.record("cellar", Normal, run(200, Rank::Thief)),
        |store| store.save(&saved("3 s forward\n")).unwrap(),
        |store| _ = store.record("museum", Hard, run(400, Rank::Shadow)),
        |store| store.set_preferences(Preferences { bell: true, ..store.preferences() }),
        |store| store.remove_saved(saved("").save.id()),
        |store| {
            let reached = Reached { floors: 10, treasure: 1, steps: 9000 };
            store.record_descent(reached, String::new());
        },
    ];
    for change in changes {
        change(store);
        observe(store);
    }
}

/// The states before and after each change in [`play`], and the number of disk operations.
fn states() -> (Vec<String>, usize) {
    let folder = Folder::new();
    fill(&mut sound(&folder.0));
    let (mut store, _) = failing(&folder, 0, 0);
    let mut states = vec![shown(&store)];
    play(&mut store, |store| states.push(shown(store)));
    let folder = Folder::new();
    fill(&mut sound(&folder.0));
    let (mut store, count) = failing(&folder, 0, 0);
    play(&mut store, |_| ());
    (states, count.load(Ordering::Relaxed))
}

#[test]
fn a_power_cut_leaves_the_state_before_or_after_a_change() {
    let (states, operations) = states();
    let mut reached = vec![false; states.len()];
    for cut in 0..=operations {
        let folder = Folder::new();
        fill(&mut sound(&folder.0));
        play(&mut failing(&folder, cut, usize::MAX).0, |_| ());
        let kept = shown(&sound(&folder.0));
        let known = states.iter().position(|state| *state == kept);
        reached[known.unwrap_or_else(|| panic!("cut at {cut}: {kept}"))] = true;
    }
    assert!(reached.iter().all(|&is_reached| is_reached), "{reached:?}");
}

#[test]
fn the_next_change_makes_up_for_a_failed_one() {
    let (states, operations) = states();
    for failure in 0..operations {
        let folder = Folder::new();
        fill(&mut sound(&folder.0));
        let (mut store, _) = failing(&folder, failure, failure + 1);
        play(&mut store, |_| ());
        store.set_preferences(Preferences { crosshair: true, ..store.preferences() });
        store.set_preferences(Preferences { crosshair: false, ..store.preferences() });
        assert_eq!(store.trouble(), None, "{failure}");
        assert_eq!(shown(&sound(&folder.0)), *states.last().unwrap(), "{failure}");
    }
}

#[test]
fn a_power_cut_during_repair_loses_nothing() {
    let damaged = |folder: &Folder| {
        fill(&mut sound(&folder.0));
        let text = folder.text().replace("steps = 300", "steps = -3");
        fs::write(folder.progress(), &text).unwrap();
        text
    };
    let repaired = {
        let folder = Folder::new();
        damaged(&folder);
        shown(&Store::open(&folder.0).0)
    };
    for cut in 0..12 {
        let folder = Folder::new();
        let text = damaged(&folder);
        drop(failing(&folder, cut, usize::MAX));
        assert_eq!(shown(&Store::open(&folder.0).0), repaired, "cut at {cut}");
        let kept = folder.names("damaged").into_iter().map(|name| folder.0.join(name));
        assert!(kept.map(fs::read_to_string).any(|kept| kept.unwrap() == text), "cut at {cut}");
    }
}

#[test]
fn a_read_only_folder_does_not_stop_the_game() {
    let folder = Folder::new();
    fill(&mut sound(&folder.0));
    let (mut store, _) = failing(&folder, 1, usize::MAX);
    play(&mut store, |_| ());
    assert!(store.trouble().unwrap().contains("can't be written"));
    assert_eq!(store.best("cellar", Normal).unwrap().tally.steps, 200);
    assert_eq!(store.script("cellar", Normal).unwrap(), "200 steps forward\n");
    assert_eq!(sound(&folder.0).best("cellar", Normal).unwrap().tally.steps, 300);
}
