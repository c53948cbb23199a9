//! The contents of a host's store after its process was killed.

use std::env;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Command, Stdio};

use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime, verify};

use crate::transport::folder;

pub(crate) const WON: &str =
    include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/scripts/cellar.normal.script"));

const NOW: UnixTime = UnixTime::new(1_795_300_000);
/// With this environment variable, the test acts as the process to be killed. It contains the folder and the
/// number of the first account.
const WRITER: &str = "CELLCASTER_TEST_WRITER";

fn key(number: u32) -> AccountKey {
    let mut bytes = [0; 32];
    bytes[..4].copy_from_slice(&number.to_le_bytes());
    AccountKey::new(bytes)
}

/// Creates accounts with results, one after the other, until the process is killed. Prints each number once
/// it is stored.
fn write(folder: &Path, first: u32) {
    let run = verify(WON, |_| None).unwrap();
    let mut store = HostStore::open(folder).unwrap();
    for number in first.. {
        let name = Name::new(&format!("n{number}")).unwrap();
        let account = store.create_account(None, &key(number), &name, NOW).unwrap();
        store.record(account.id, &run, NOW).unwrap();
        println!("kept {number}");
    }
}

/// How many times the test kills the process.
const KILLS: u32 = 12;

#[test]
fn acknowledged_changes_survive_a_killed_process() {
    if let Ok(writer) = env::var(WRITER) {
        let (folder, first) = writer.rsplit_once(':').unwrap();
        return write(Path::new(folder), first.parse().unwrap());
    }
    let folder = folder();
    let mut next = 0;
    for round in 0..KILLS {
        let mut process = Command::new(env::current_exe().unwrap())
            .args(["--exact", "--nocapture", "kept::acknowledged_changes_survive_a_killed_process"])
            .env(WRITER, format!("{}:{next}", folder.display()))
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
        let is_said = |line: &String| line.contains("kept ");
        // The process is killed while it is writing the next account.
        let said = lines.by_ref().map(Result::unwrap).filter(is_said).nth(1 + round as usize % 5);
        process.kill().unwrap();
        process.wait().unwrap();
        let later = lines.map(Result::unwrap).filter(is_said).last();
        let number = |line: &String| -> u32 { line.rsplit_once(' ').unwrap().1.parse().unwrap() };
        let last = later.as_ref().or(said.as_ref()).map(number).unwrap();

        let mut store = HostStore::open(&folder).unwrap();
        for number in next..=last {
            let account = store.account(&key(number)).unwrap().expect("it was kept");
            assert_eq!(store.bests(account.id).unwrap().len(), 1, "account {number}");
        }
        next = last + 1;
        while store.account(&key(next)).unwrap().is_some() {
            next += 1;
        }
    }
    assert!(next > KILLS);
}
