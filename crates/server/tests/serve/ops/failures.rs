//! Each system call that a host makes in its data folder fails once: while the host starts and stops, and
//! while a visitor takes a name and wins.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::thread;

use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime, verify};
use rustix::process::{Pid, Signal, kill_process};

use super::maps::{maps, scores};
use crate::kept::WON;
use crate::player::Player;
use crate::running::{Running, user_key};
use crate::strace::{Failure, Traced, failures};
use crate::transport::{folder, wait_until};

/// If a system call occurs often, only every nth failure is tested after the first n.
const SAMPLED: u32 = 5;

/// A tiny room with the exit in front of the start.
const CLOSET: &str = r##"title = "The moss closet"
grid = '''
#####
#@.>#
#####
'''
[tiles]
"#" = { wall = "#507050" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;

/// The key of an account that was stored earlier.
const KEY: AccountKey = AccountKey::new([7; 32]);

/// All paths in the data folder that a host opens.
fn paths(folder: &Path) -> Vec<PathBuf> {
    let database = ["host.db", "host.db-wal", "host.db-shm", "host.db-journal"];
    let others =
        ["host_key", "host_key.new", "waiting_results", "waiting_results.new", "admin.sock"];
    let names = database.into_iter().chain(others);
    names.map(|name| folder.join(name)).chain([folder.to_owned()]).collect()
}

fn sample(failures: Vec<Failure>) -> Vec<Failure> {
    let is_taken = |it: &Failure| it.number <= SAMPLED || it.number.is_multiple_of(SAMPLED);
    failures.into_iter().filter(is_taken).collect()
}

/// Runs `test` for each failure, on four threads.
fn for_each(failures: Vec<Failure>, test: impl Fn(&Failure) + Sync) {
    let waiting = Mutex::new(failures.into_iter());
    thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                while let Some(failure) = { waiting.lock().unwrap().next() } {
                    test(&failure);
                }
            });
        }
    });
}

/// The data folder of a host that has run before, with an account that has a result.
fn host_that_has_run() -> PathBuf {
    let data = folder();
    let run = verify(WON, |_| None).unwrap();
    let mut store = HostStore::open(&data).unwrap();
    let now = UnixTime::new(1_795_300_000);
    let account = store.create_account(None, &KEY, &Name::new("Mara").unwrap(), now).unwrap();
    store.record(account.id, &run, now).unwrap();
    drop(store);
    start_and_end(&data, None);
    data
}

fn copied(data: &Path) -> PathBuf {
    let copy = folder();
    for entry in fs::read_dir(data).unwrap().map(Result::unwrap) {
        if entry.file_type().unwrap().is_file() {
            fs::copy(entry.path(), copy.join(entry.file_name())).unwrap();
        }
    }
    copy
}

/// Starts a host and stops it, unless it exits by itself. Returns its process id. A host that fails must
/// state the reason in one sentence.
#[track_caller]
fn start_and_end(data: &Path, traced: Option<&Traced>) -> u32 {
    let log = data.join("log");
    let mut words = traced.map_or_else(Vec::new, Traced::words);
    words.push(env!("CARGO_BIN_EXE_cellcaster-server"));
    let mut host = Command::new(words[0])
        .args(&words[1..])
        .args(["--listen", "127.0.0.1:0"])
        .env_clear()
        .env("PATH", "/usr/bin:/bin")
        .env("CELLCASTER_DATA", data)
        .stdout(Stdio::piped())
        .stderr(File::create(&log).unwrap())
        .spawn()
        .unwrap();
    let lines = BufReader::new(host.stdout.take().unwrap()).lines();
    if lines.map(Result::unwrap).any(|line| line.contains("ssh -p ")) {
        _ = kill_process(Pid::from_child(&host), Signal::TERM);
    }
    let (process, status) = (host.id(), host.wait().unwrap());
    let log = fs::read_to_string(&log).unwrap();
    let sentences = log.lines().filter(|line| line.starts_with("cellcaster: ")).count();
    assert!(sentences <= 1 && (status.success() || sentences == 1), "{status}: {log}");
    assert!(!log.contains("panicked"), "{log}");
    process
}

#[test]
fn a_failed_system_call_loses_no_data_at_start_or_end() {
    let before = host_that_has_run();
    // While this store is open, its last change is only in the write-ahead log, as after a crash. The host
    // gets a copy.
    let mut open = HostStore::open(&before).unwrap();
    let other = AccountKey::new([8; 32]);
    open.create_account(None, &other, &Name::new("Jon").unwrap(), UnixTime::new(1_795_300_001))
        .unwrap();
    let start = |failure: Option<&Failure>| {
        let data = copied(&before);
        let traced = Traced::new(&data, &paths(&data), failure);
        let process = start_and_end(&data, Some(&traced));
        let mut store = HostStore::open(&data).unwrap();
        let account = store.account(&KEY).unwrap();
        let account = account.unwrap_or_else(|| panic!("{failure:?} lost the account"));
        assert_eq!(store.bests(account.id).unwrap().len(), 1, "{failure:?}");
        assert!(store.account(&other).unwrap().is_some(), "{failure:?} lost the other account");
        let key = |folder: &Path| fs::read(folder.join("host_key")).unwrap();
        assert!(key(&data) == key(&before), "{failure:?} changed the key of the host");
        (traced, process)
    };
    let (traced, process) = start(None);
    let counts = traced.counts(process);
    assert!(["openat", "pwrite64", "fsync"].iter().all(|call| counts.contains_key(*call)));
    for_each(sample(failures(&counts)), |failure| {
        let (traced, process) = start(Some(failure));
        assert!(traced.has_failed(process), "{failure:?} of {counts:?}");
    });
}

/// The promises that a visitor was given.
#[derive(Debug, Default)]
struct Told {
    name: bool,
    result: bool,
    /// The result is to be recorded later.
    waits: bool,
}

fn wait_for_one(player: &Player, texts: &[&str]) {
    player.wait_until(&format!("showed one of {texts:?}"), |emulator| {
        texts.iter().any(|text| emulator.text().contains(text))
    });
}

/// Takes the name Jon and wins in the host's own map.
fn win(player: &Player) -> Told {
    let mut told = Told::default();
    wait_for_one(player, &["Enter saves it", "can't look you up"]);
    if player.text().contains("can't look you up") {
        return told;
    }
    player.send("\x15Jon");
    player.wait_for("Jon");
    let lobby = "Alone, for the board";
    player.send("\r");
    wait_for_one(player, &[lobby, "now; try again later"]);
    if !player.text().contains(lobby) {
        player.send("\r");
        player.wait_for(lobby);
    }
    told.name = true;
    player.send("4");
    player.wait_for("The moss closet");
    player.send("\x1b[F\r");
    player.wait_for("Go in");
    player.send("\r");
    player.wait_for("has joined.");
    let sentences =
        ["You are number 1.", "will be recorded", "waits until", "can't save your", "your best."];
    wait_until("the result", || {
        player.send("w");
        sentences.iter().any(|sentence| player.text().contains(sentence))
    });
    told.waits = ["will be recorded", "waits until"].iter().any(|it| player.text().contains(it));
    told.result = told.waits || player.text().contains("your best.");
    told
}

#[test]
fn confirmed_changes_are_kept_if_any_system_call_fails() {
    let maps = maps(&[("moss.toml", CLOSET)]);
    let config = format!("maps = \"{}\"\nroom = []\n", maps.display());
    let serve = |failure: Option<&Failure>| {
        let mut running = Running::start(&config, "text");
        let key = user_key(&running.folder);
        let traced = Traced::new(&running.folder, &paths(&running.folder), failure);
        let attached = traced.attach(running.process());
        let player = running.player(Some(&key));
        let told = win(&player);
        running.admin_says(&["who"]);
        let process = running.process();
        running.signal(Signal::KILL);
        running.wait_for_end();
        let result = (traced.has_failed(process), traced.counts(process));
        drop(attached);
        assert!(!running.log().contains("panicked"), "{failure:?}: {}", running.log());
        let has_result = || scores(&running.folder, &["--level", "moss"]).contains("Jon");
        if told.result && !told.waits {
            assert!(has_result(), "{failure:?} lost a result");
        }
        running.restart();
        if told.waits {
            wait_until("the result that waits", || {
                scores(&running.folder, &["--level", "moss"]).contains("Jon")
            });
        }
        let player = running.player(Some(&key));
        if told.name {
            player.wait_for("> Jon");
        }
        result
    };
    let (_, counts) = serve(None);
    assert!(["fcntl", "fsync", "pwrite64"].iter().all(|call| counts.contains_key(*call)));
    let happened = Mutex::new(Vec::new());
    for_each(sample(failures(&counts)), |failure| {
        let (has_happened, _) = serve(Some(failure));
        happened.lock().unwrap().push(has_happened);
    });
    let happened = happened.into_inner().unwrap();
    // Background work of the host may shift the last failures beyond the end of the run.
    assert!(happened.iter().filter(|it| **it).count() * 2 > happened.len(), "{happened:?}");
}

/// While the system cannot hand over a connection, it waits in the queue.
#[test]
fn a_visitor_gets_in_after_a_failed_accept() {
    let running = Running::start("", "text");
    for error in ["EMFILE", "ENFILE", "ECONNABORTED", "ENOBUFS", "EINTR"] {
        let failure = Failure { call: "accept4".to_owned(), error, number: 1 };
        let log = running.folder.join(error);
        let traced = Traced::new(&log, &[], Some(&failure));
        let attached = traced.attach(running.process());
        running.visitor().wait_for("Enter saves it");
        drop(attached);
        let calls = fs::read_to_string(log.with_extension("calls")).unwrap();
        assert!(calls.contains(error), "{error} did not happen");
    }
}
