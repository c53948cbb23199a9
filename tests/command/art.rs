//! `--art`: a player's own pictures in place of the built-in ones.

use std::fs;
use std::path::PathBuf;

use crate::support::cellcaster;

/// A folder for the test `name` with copies of built-in sheets.
fn folder(name: &str, copies: &[(&str, &str)]) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("art").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for (sheet, copy) in copies {
        fs::copy(format!("maps/art/{sheet}.png"), folder.join(copy)).unwrap();
    }
    folder
}

/// The picture of a corridor of bricks, with the art in `folder`.
fn picture(art: Option<&PathBuf>) -> Vec<u8> {
    let map = "tests/maps/corridor.toml";
    let mut command = cellcaster(&["snapshot", map, "--size", "40x12", "--format", "json"]);
    if let Some(art) = art {
        command.arg("--art").arg(art);
    }
    let output = command.output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    output.stdout
}

/// Asserts that the program refuses the art in `folder` with this sentence, after the path of the folder.
#[track_caller]
fn assert_refused(folder: &PathBuf, sentence: &str) {
    let output = cellcaster(&["snapshot", "--art"]).arg(folder).output().unwrap();
    let said =
        String::from_utf8_lossy(&output.stderr).replace(&folder.display().to_string(), "DIR");
    assert_eq!(said, format!("cellcaster: {sentence}\n"));
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn a_players_picture_replaces_the_built_in_one() {
    let built_in = picture(None);
    let same = folder("same", &[("brick", "brick.png")]);
    assert_eq!(picture(Some(&same)), built_in);
    let other = folder("other", &[("hedge", "brick.png")]);
    assert_ne!(picture(Some(&other)), built_in);
    let unseen = folder("unseen", &[("hedge", "moss.png")]);
    assert_eq!(picture(Some(&unseen)), built_in);
}

#[test]
fn a_folder_that_replaces_nothing_is_a_mistake() {
    let empty = folder("empty", &[]);
    assert_refused(
        &empty,
        "the folder DIR has no PNG file: copy a sheet from maps/art into it, and edit the copy",
    );
    assert_refused(&empty.join("none"), "the folder DIR cannot be read: entity not found");
}

#[test]
fn a_file_that_cannot_replace_its_picture_is_a_mistake() {
    let misspelt = folder("misspelt", &[("brick", "brik.png")]);
    assert_refused(
        &misspelt,
        "DIR/brik.png is not named after a built-in picture, and the nearest is \"brick.png\": \
         rename or remove it",
    );
    let wrong_shape = folder("wrong_shape", &[("warden", "brick.png")]);
    assert_refused(
        &wrong_shape,
        "DIR/brick.png is 304×272 texels: make it 64×64, or a multiple of that",
    );
    let broken = folder("broken", &[]);
    fs::write(broken.join("brick.png"), "no picture").unwrap();
    assert_refused(
        &broken,
        "DIR/brick.png is not a complete PNG image: Invalid PNG signature: save the picture again, \
         as PNG",
    );
}
