//! Runs every input of the corpus in its target, without libFuzzer.

use std::fs;
use std::path::Path;

use cellcaster_fuzz::TARGETS;

#[test]
fn every_input_passes() {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    for target in TARGETS {
        let folder = corpus.join(target.name);
        let mut files: Vec<_> = fs::read_dir(&folder)
            .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
            .map(|entry| entry.unwrap().path())
            .collect();
        files.sort();
        assert!(!files.is_empty(), "the corpus of {} is empty", target.name);
        for file in files {
            // If the test fails, its output shows the file.
            println!("{}", file.display());
            (target.run)(&fs::read(&file).unwrap());
        }
    }
}
