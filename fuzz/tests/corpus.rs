//! Every input of the corpus, in every target, without libFuzzer.

use std::fs;
use std::path::Path;

/// Runs a target with the files of its corpus.
fn replay(name: &str, target: fn(&[u8])) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus").join(name);
    let mut files: Vec<_> = fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    assert!(!files.is_empty(), "the corpus of {name} is empty");
    for file in files {
        // A failed test shows it.
        println!("{}", file.display());
        target(&fs::read(&file).unwrap());
    }
}

#[cfg(fuzzing)]
#[test]
fn checkpoint() {
    replay("checkpoint", cellcaster_fuzz::checkpoint::run);
}

#[test]
fn decoder() {
    replay("decoder", cellcaster_fuzz::decoder::run);
}

#[test]
fn encoder() {
    replay("encoder", cellcaster_fuzz::encoder::run);
}

#[test]
fn maps() {
    replay("maps", cellcaster_fuzz::maps::run);
}

#[test]
fn png() {
    replay("png", cellcaster_fuzz::png::run);
}

#[cfg(fuzzing)]
#[test]
fn server() {
    replay("server", cellcaster_fuzz::server::run);
}

#[test]
fn texts() {
    replay("texts", cellcaster_fuzz::texts::run);
}
