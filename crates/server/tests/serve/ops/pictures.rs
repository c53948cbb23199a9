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
    let path = folder().join("picture.png");
    let draw = |member: &str| {
        let words = ["--size", "40x12", "--fps", "4", "--from", "8", "--to", "10", "--png"];
        server(&["replay", RECORDING, "--member", member]).args(words).arg(&path).output().unwrap()
    };
    let drawn = |member: &str| {
        let output = draw(member);
        assert!(output.status.success(), "{output:?}");
        assert!(output.stdout.starts_with(b"round 1: Roam in The Museum of Walls"), "{output:?}");
        fs::read(&path).unwrap()
    };
    let mara = drawn("Mara");
    assert_eq!(facts(&mara), [320, 192, 8]);
    assert!(drawn("Mara") == mara, "another run draws another file");
    assert!(drawn("Jon") != mara, "both members see the same");
    let output = draw("Kim");
    assert_eq!(output.status.code(), Some(2));
    assert!(
        String::from_utf8_lossy(&output.stderr).contains("no member called \"Kim\""),
        "{output:?}"
    );
}
