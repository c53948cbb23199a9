//! The modules of the game and of the server depend only on modules above them in the tables of
//! ARCHITECTURE.md.

use std::fs;
use std::path::{Path, PathBuf};

/// The parts of a package that are only for tests.
const FOR_TESTS: [&str; 4] = ["tests", "simulation", "simulated", "fuzzing"];

/// The modules in the order of the table under `heading`.
fn table(heading: &str) -> Vec<String> {
    let text = fs::read_to_string("ARCHITECTURE.md").unwrap();
    let section = text.split(heading).nth(1).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
    let names = rows.flat_map(|row| row.split(" | ").next().unwrap().split(", "));
    names.map(|name| name.trim_matches('`').to_owned()).collect()
}

fn is_for_tests(path: &Path) -> bool {
    FOR_TESTS.iter().any(|name| path.file_stem().is_some_and(|stem| stem == *name))
}

/// The files of a module, without the files of its tests.
fn files(path: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    if path.with_extension("rs").is_file() {
        files.push(path.with_extension("rs"));
    }
    for entry in fs::read_dir(path).into_iter().flatten() {
        let path = entry.unwrap().path();
        if is_for_tests(&path) {
            continue;
        }
        if path.is_dir() {
            files.extend(
                self::files(&path).into_iter().filter(|file| *file != path.with_extension("rs")),
            );
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            files.push(path);
        }
    }
    files
}

/// The modules that the product code of a file names.
fn named(text: &str) -> Vec<&str> {
    let product = text.split("\n#[cfg(test)]\nmod tests {").next().unwrap();
    let lines = product.lines().filter(|line| !line.trim_start().starts_with("//"));
    let parts = lines.flat_map(|line| line.split("crate::").skip(1));
    parts
        .map(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap())
        .collect()
}

#[test]
fn modules_depend_only_on_modules_above_them() {
    check("## Modules of the game", Path::new("src"));
    check("## Modules of the server", Path::new("crates/server/src"));
}

fn check(heading: &str, folder: &Path) {
    let table = table(heading);
    let mut entries: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| !is_for_tests(path))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .filter(|name| !["lib", "main"].contains(&name.as_str()))
        .collect();
    entries.sort();
    entries.dedup();
    let mut listed = table.clone();
    listed.sort();
    assert_eq!(listed, entries, "the table of {} has each module once", folder.display());
    for (place, module) in table.iter().enumerate() {
        for file in files(&folder.join(module)) {
            let text = fs::read_to_string(&file).unwrap();
            assert!(!text.contains("use crate::{"), "{}: one path for each module", file.display());
            for name in named(&text) {
                let below = table.iter().skip(place + 1).any(|other| other == name);
                assert!(!below, "{} uses {name}, which stands below {module}", file.display());
            }
        }
    }
}
