//! A recorded room in a terminal.

use std::path::Path;

use crate::emulator::Speaks;
use crate::player::Player;

const RECORDING: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../maps/together.log");

#[test]
fn a_recorded_room_is_watched_at_home() {
    let data = Path::new(env!("CARGO_TARGET_TMPDIR")).join("watching");
    let data = [("CELLCASTER_DATA", data.to_str().unwrap()), ("TERM", "xterm-256color")];
    let program = env!("CARGO_BIN_EXE_cellcaster-server");
    let mut player = Player::start((80, 24), Speaks::Plain, program, ["replay", RECORDING], &data);
    player.wait_for("1x      eyes");
    player.send(" ");
    player.wait_for("paused");
    player.send("\x1b[F");
    player.wait_for("0:13  end");
    player.send("v");
    player.wait_for("end     above");
    player.resize(100, 30);
    player.wait_for_rest();
    let screen = player.text();
    assert!(screen.trim_end().lines().last().unwrap().ends_with("end     above"), "{screen}");
    player.send("q");
    let ending = player.wait_for_end();
    ending.assert_given_back();
}
