//! `import` and `export`: maps of the editor Tiled on the command line.

use std::fs;
use std::path::{Path, PathBuf};

use cellcaster::map::{self, builtin};

use crate::support::{complaint_about, output_of};

/// An empty folder for the test `name`.
fn folder(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("tiled").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn name(path: &Path) -> &str {
    path.to_str().unwrap()
}

#[test]
fn an_exported_level_is_imported_as_the_same_level() {
    let folder = folder("same");
    let (tiled, back) = (folder.join("cellar.tmj"), folder.join("cellar.toml"));
    let said = output_of(&["export", "cellar", "--format", "tmj", "--output", name(&tiled)]);
    let files = ["cellar.tmj", "cellar.tiles.png", "cellar.types.json"];
    let files = files.map(|file| format!("{}\n", folder.join(file).display()));
    assert_eq!(String::from_utf8(said).unwrap(), files.concat());
    output_of(&["import", name(&tiled), "--output", name(&back)]);
    assert!(map::load(&back).unwrap() == builtin::LEVELS[0].world().unwrap());
    // Without an output, the text goes to standard output.
    assert_eq!(output_of(&["import", name(&tiled)]), fs::read(&back).unwrap());
    let checked = String::from_utf8(output_of(&["check", name(&tiled)])).unwrap();
    assert_eq!(checked, format!("{}: valid, 20×14 cells\n", tiled.display()));

    // What was drawn in Tiled is not overwritten.
    let complaint = complaint_about(&["export", "cellar", "--output", name(&tiled)]);
    assert!(complaint.contains("exists already"), "{complaint}");
    output_of(&["export", "cellar", "--force", "--output", name(&tiled)]);
}

#[test]
fn tiles_of_a_sheet_become_pictures_beside_the_map_file() {
    let folder = folder("pictures");
    let map = folder.join("yard.toml");
    output_of(&["import", "tests/tiled/yard.tmx", "--output", name(&map)]);
    assert!(folder.join("yard-16-0.png").is_file());
    let picture = |map: &str| output_of(&["snapshot", map, "--format", "json"]);
    assert_eq!(picture(name(&map)), picture("tests/tiled/yard.tmx"));

    fs::write(folder.join("yard-16-0.png"), "another").unwrap();
    let complaint = complaint_about(&["import", "tests/tiled/yard.tmx", "--output", name(&map)]);
    assert!(complaint.contains("differs from the map's picture yard-16-0.png"), "{complaint}");
}

#[test]
fn mistakes_say_what_to_do() {
    let complaint = complaint_about(&["import", "tests/bad_tiled/class_unknown.tmx"]);
    assert!(complaint.contains("class_unknown.tmx: object 4 on layer \"things\""), "{complaint}");
    let complaint = complaint_about(&["import", "maps/cellar.toml"]);
    assert!(complaint.contains("is not a Tiled map"), "{complaint}");
    let complaint = complaint_about(&["export", "maps/gallery/spheres.toml"]);
    assert!(complaint.contains("is a map of bodies"), "{complaint}");
}
