//! `cellcaster compare`, and the grids that `cellcaster snapshot` writes for it.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::support::{cellcaster, complaint_about, output_of, run_with_input};

const MAP: &str = "tests/maps/museum.toml";

/// A folder for this test, which is empty.
fn folder(test: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Files with the picture as a grid and as JSON, and with the picture from two steps ahead.
fn files(folder: &Path) -> [String; 3] {
    let file = |name: &str, options: &[&str]| {
        let path = folder.join(name);
        fs::write(&path, output_of(&[&["snapshot", MAP, "--size", "60x20"], options].concat()))
            .unwrap();
        path.to_str().unwrap().to_owned()
    };
    [
        file("wanted.grid", &["--format", "grid"]),
        file("wanted.json", &["--format", "json"]),
        file("ahead.grid", &["--format", "grid", "--camera", "4.5,11.5,0"]),
    ]
}

fn compare(arguments: &[&str]) -> (Option<i32>, String) {
    let output = cellcaster(&[&["compare"], arguments].concat()).output().unwrap();
    assert_eq!(String::from_utf8_lossy(&output.stderr), "", "{arguments:?}");
    (output.status.code(), String::from_utf8(output.stdout).unwrap())
}

#[test]
fn a_grid_equals_the_json_of_the_same_picture() {
    let [grid, json, _] = files(&folder("equal"));
    assert_eq!(compare(&[&grid, &json]), (Some(0), "all 1200 cells match\n".to_owned()));
    let output = run_with_input(&["compare", &json, "-"], &fs::read(grid).unwrap());
    assert_eq!(output.status.code(), Some(0));
}

#[test]
fn a_difference_is_counted_located_and_drawn() {
    let folder = folder("different");
    let [grid, _, ahead] = files(&folder);
    let png = folder.join("difference.png");
    let (status, report) = compare(&[&grid, &ahead, "--png", png.to_str().unwrap()]);
    assert_eq!(status, Some(1));
    insta::assert_snapshot!(report, @r#"
    773 of 1200 cells differ, in columns 0-59 and rows 0-14
    the largest difference: column 0, row 9: "▀" #1b383c on #19353a in place of "▀" #4b432c on #51a340, ΔE 72.7
    "#);
    assert!(fs::read(png).unwrap().starts_with(b"\x89PNG"));
    let (status, with_tolerance) = compare(&[&grid, &ahead, "--tolerance", "20"]);
    assert_eq!(status, Some(1));
    assert_ne!(with_tolerance, report, "fewer cells differ by more");
    assert_eq!(compare(&[&grid, &ahead, "--tolerance", "150"]).0, Some(0));
}

#[test]
fn each_mistake_is_reported_in_one_sentence() {
    let folder = folder("mistakes");
    let [grid, ..] = files(&folder);
    let file = |name: &str, text: &[u8]| {
        let path = folder.join(name);
        fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let pipe = folder.join("pipe").to_str().unwrap().to_owned();
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    let text = fs::read_to_string(&grid).unwrap();
    let mistakes: [&[&str]; 11] = [
        &[&grid],
        &[&grid, "absent.grid"],
        &[&grid, folder.to_str().unwrap()],
        &[&grid, &pipe],
        &[&grid, MAP],
        &[&grid, &file("not_utf8.grid", b"\xff")],
        &[&grid, &file("newer.grid", text.replacen("grid 1", "grid 7", 1).as_bytes())],
        &[&grid, &file("cut.grid", &text.as_bytes()[..text.len() / 2])],
        &[&grid, &file("huge.grid", b"cellcaster grid 1: 65535x65535\n")],
        &["-", "-"],
        &[&grid, &grid, "--tolerance", "-1"],
    ];
    let complaints = mistakes.map(|mistake| {
        let complaint = complaint_about(&[&["compare"], mistake].concat());
        assert_eq!(complaint.lines().count(), 1, "{complaint}");
        complaint.replace(folder.to_str().unwrap(), "FOLDER")
    });
    insta::assert_snapshot!(complaints.concat());
    let complaint = complaint_about(&["snapshot", "--format", "grid", "--size", "4096x4096"]);
    assert!(complaint.contains("a grid has at most 262144 cells"), "{complaint}");
}
