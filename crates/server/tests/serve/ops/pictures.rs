//! `replay --png`: what a member of a recorded room saw.

use std::fs;

use crate::support::server;
use crate::transport::folder;

const RECORDING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/together.log");

/// The width, the height and the number of frames of an animated PNG.
fn facts(file: &[u8]) -> [u32; 3] {
    let number = |at: usize| u32::from_be_bytes(file[at..at + 4].try_into().unwrap());
    let control = file.windows(4).position(|bytes| bytes == b"acTL").unwrap();
    [number(16), number(20), number(control + 4)]
}

#[test]
fn a_recording_is_drawn_as_a_member_saw_it() {
    let folder = folder();
    let draw = |member: &str| {
        let path = folder.join("picture.png");
        let picture = ["--size", "40x12", "--fps", "4", "--part", "8-10"];
        let output = server(&["replay", RECORDING, "--member", member, "--png"])
            .arg(&path)
            .args(picture)
            .output()
            .unwrap();
        if output.status.success() {
            assert!(output.stdout.starts_with(b"round 1: Roam in The Museum of Walls"));
            Ok(fs::read(&path).unwrap())
        } else {
            assert_eq!(output.status.code(), Some(2));
            Err(String::from_utf8(output.stderr).unwrap())
        }
    };
    let mara = draw("Mara").unwrap();
    assert_eq!(facts(&mara), [320, 192, 8]);
    assert_eq!(draw("Mara").unwrap(), mara);
    assert_ne!(draw("Jon").unwrap(), mara);
    insta::assert_snapshot!(draw("Kim").unwrap_err(), @"");
}
