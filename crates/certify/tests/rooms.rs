//! `cellcaster-certify` with the recording of a room.

use std::path::Path;
use std::process::{Command, Output};

fn certify(log: &str) -> Output {
    let log = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../maps").join(log);
    let program = env!("CARGO_BIN_EXE_cellcaster-certify");
    Command::new(program).args(["--every", "200"]).arg(log).output().unwrap()
}

#[test]
fn no_pixel_that_members_of_a_room_saw_is_wrong() {
    let output = certify("together.log");
    assert!(output.status.success(), "{output:?}");
    let printed = String::from_utf8(output.stdout).unwrap();
    // Two members, and a frame of each in the steps 0, 200, 400 and 600.
    assert!(printed.contains("together.log: 8 frames, 30720 pixels, 0 wrong"), "{printed}");
}

#[test]
fn a_log_that_is_missing_is_a_mistake() {
    let output = certify("alone.log");
    assert_eq!(output.status.code(), Some(2), "{output:?}");
    assert!(String::from_utf8(output.stderr).unwrap().contains("alone.log cannot be replayed: "));
}
