//! Records of rooms, watched from the lobby.

use std::fs;
use std::path::{Path, PathBuf};

use super::private::in_lobby;
use super::*;
use crate::rooms::directory::{RecordingBounds, Recordings};
use crate::rooms::room::Catalog;

const TOGETHER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/together.log");

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("cellcaster-{name}-{}", std::process::id()));
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A host with the recordings in a folder.
fn host(folder: &Path) -> Rig {
    let recordings = Recordings::in_folder(Some(folder.to_owned()), RecordingBounds::default());
    let catalog = Catalog::builtin();
    let wish = RigOptions { catalog, recordings: Some(recordings), ..RigOptions::new(Mode::Roam) };
    Rig::with(RigOptions { level: "museum", ..wish })
}

/// Lets the threads that read files finish.
fn wait_for(rig: &mut Rig, index: usize, text: &str) {
    for _ in 0..100 {
        if rig.text(index).contains(text) {
            return;
        }
        std::thread::sleep(Duration::from_millis(20));
        rig.pump(100);
    }
    panic!("no {text:?} in\n{}", rig.text(index));
}

#[test]
fn a_recording_is_watched_from_the_lobby_from_all_sides() {
    let folder = folder("watched");
    let text = fs::read_to_string(TOGETHER).unwrap();
    fs::write(folder.join("room-1.log"), &text).unwrap();
    fs::write(folder.join("private-2.log"), &text).unwrap();
    fs::write(folder.join("room-3.log"), text.replace("Roam", "Alone")).unwrap();
    fs::write(folder.join("room-4.log"), text.replace("room 3", "room 2")).unwrap();
    let mut rig = host(&folder);
    let mara = in_lobby(&mut rig, "Lee", (80, 24));
    rig.press(mara, "r");
    wait_for(&mut rig, mara, "Roam in The Museum");
    let listed = rig.text(mara).matches(" ago").count();
    assert_eq!(listed, 1, "{}", rig.text(mara));
    rig.press(mara, ENTER);
    wait_for(&mut rig, mara, "1x      eyes");
    rig.press(mara, " ");
    rig.press(mara, "\x1b[F");
    wait_for(&mut rig, mara, "0:13  end");
    rig.press(mara, "\x1b[H");
    wait_for(&mut rig, mara, " 0:00 ");
    let of_mara = rig.text(mara);
    rig.press(mara, "\t");
    assert_ne!(rig.text(mara), of_mara, "Tab shows the next player");
    rig.press(mara, "v");
    assert!(rig.text(mara).contains("paused  above"), "{}", rig.text(mara));
    rig.press(mara, "v");
    assert!(rig.text(mara).contains("paused  free"), "{}", rig.text(mara));
    let before = rig.text(mara);
    rig.press(mara, "wwww");
    rig.pump(1_000);
    assert_ne!(rig.text(mara), before, "the camera flies");
    rig.press(mara, "?");
    assert!(rig.text(mara).contains("the next player; q leaves"), "{}", rig.text(mara));
    rig.press(mara, ESCAPE);
    rig.press(mara, "q");
    assert_eq!(rig.page(mara), super::super::pages::Page::Recordings);
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_recording_that_is_gone_is_reported() {
    let folder = folder("gone");
    let path = folder.join("room-1.log");
    fs::copy(TOGETHER, &path).unwrap();
    let mut rig = host(&folder);
    let mara = in_lobby(&mut rig, "Mara", (80, 24));
    rig.press(mara, "r");
    wait_for(&mut rig, mara, "Roam in The Museum");
    fs::remove_file(&path).unwrap();
    rig.press(mara, ENTER);
    wait_for(&mut rig, mara, "The recording cannot be shown:");
    fs::remove_dir_all(&folder).unwrap();
}

#[test]
fn a_host_without_recordings_offers_none() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = in_lobby(&mut rig, "Mara", (80, 24));
    rig.press(mara, "r");
    assert!(!rig.text(mara).contains("ecordings"), "{}", rig.text(mara));
}
