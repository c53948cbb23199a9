//! The file `waiting_results` of a host.
//!
//! Every line is a result or is put aside. The remaining results can be recorded, stored and read
//! again. The number of bytes allocated for the file is bounded by its length.

use allocation_counter::measure;
use cellcaster::map::builtin;
use cellcaster_server::accounts::{AccountKey, HostStore, Name, UnixTime, WaitingResults};

use crate::folder::Folder;

/// The largest size of a file whose scripts are played, if they contain no number of four digits.
/// Playing a longer file takes seconds.
const MAX_PLAYED: usize = 400;
/// The number of bytes allocated for a byte, which may be a line.
const BYTES_OF_A_BYTE: u64 = 512;

/// Opens the file, records its results, and opens it again.
pub fn run(data: &[u8]) {
    let folder = Folder::new();
    folder.write("waiting_results", data);
    let mut opened = None;
    let used = measure(|| opened = WaitingResults::open(folder.path()).ok());
    let most = 64 * 1024 + BYTES_OF_A_BYTE * data.len() as u64;
    assert!(used.bytes_total <= most, "{} bytes for {}", used.bytes_total, data.len());
    let (mut waiting, sentence) = opened.expect("the file can be read");
    let lines = String::from_utf8_lossy(data).lines().count();
    assert!(
        waiting.len() <= lines && sentence.is_some() == (waiting.len() < lines),
        "{sentence:?}"
    );
    assert_eq!(length_of_a_new(&folder), waiting.len());
    let digits = data.split(|byte| !byte.is_ascii_digit()).map(<[u8]>::len).max();
    if data.len() <= MAX_PLAYED && digits < Some(4) {
        record(&mut waiting);
        waiting.save().expect("there is room");
        assert_eq!(length_of_a_new(&folder), waiting.len());
    }
}

/// The number of results in the file, which must be undamaged by now.
fn length_of_a_new(folder: &Folder) -> usize {
    let (waiting, sentence) = WaitingResults::open(folder.path()).expect("it can be read");
    assert_eq!(sentence, None);
    waiting.len()
}

fn record(waiting: &mut WaitingResults) {
    let mut store = HostStore::in_memory();
    let (name, now) = (Name::new("Ada").expect("it is a name"), UnixTime::new(1_795_300_000));
    store.create_account(None, &AccountKey::new([0; 32]), &name, now).expect("it is the first one");
    let world = |name: &str| builtin::LEVELS.iter().find(|it| it.name == name)?.world().ok();
    for index in (0..waiting.len()).rev() {
        assert!(waiting.record(index, &mut store, world, now).is_some());
    }
}
