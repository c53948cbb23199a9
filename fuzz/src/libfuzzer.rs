//! All targets in one libFuzzer program, which runs the target after which it is named.

#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use cellcaster_fuzz::{TARGETS, Target, maps};
use libfuzzer_sys::{fuzz_mutator, fuzz_target, fuzzer_mutate};

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let path = PathBuf::from(std::env::args_os().next().unwrap_or_default());
    let name = path.file_name().unwrap_or_default();
    let target = TARGETS.iter().find(|target| target.name == name);
    *target.unwrap_or_else(|| panic!("{} is the name of no target", path.display()))
});

fuzz_target!(|data: &[u8]| (TARGET.run)(data));

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    let mutated =
        if TARGET.name == "maps" { maps::mutate(data, size, max_size, seed) } else { None };
    mutated.unwrap_or_else(|| fuzzer_mutate(data, size, max_size))
});
