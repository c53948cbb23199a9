//! From the title through a game and back, in a plain terminal, by bytes.

use std::fs;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use super::game::{ENVIRONMENT, PROGRAM, test_map};
use crate::emulator::Speaks;
use crate::player::Player;

/// The byte that rings a terminal's bell.
const BELL: u8 = 7;

/// Returns whether a terminal that receives `bytes` rings. A bell inside an operating system
/// command only ends the command.
fn rings(bytes: &[u8]) -> bool {
    let mut is_command = false;
    bytes.windows(2).any(|pair| match pair {
        [0x1b, b']'] => {
            is_command = true;
            false
        }
        [0x1b, b'\\'] => {
            is_command = false;
            false
        }
        [_, BELL] => !std::mem::take(&mut is_command),
        _ => false,
    })
}

/// An empty folder for the test with this name.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Starts the program without arguments, with `data` as its data folder.
fn start(data: &Path, size: (u16, u16)) -> Player {
    let data = data.to_str().unwrap();
    let environment = [&ENVIRONMENT[..], &[("CELLCASTER_DATA", data)]].concat();
    let arguments: [&str; 0] = [];
    let player = Player::start(size, Speaks::Plain, PROGRAM, arguments, &environment);
    player.wait_for("New game");
    player
}

/// Selects the entry `label` with the down arrow, and chooses it.
#[track_caller]
fn choose(player: &Player, label: &str) {
    let wanted = format!("> {label}");
    for _ in 0..12 {
        if player.text().contains(&wanted) {
            break;
        }
        player.send("\x1b[B");
        thread::sleep(Duration::from_millis(300));
    }
    player.wait_for(&wanted);
    player.send("\r");
}

#[test]
fn a_player_goes_from_the_title_to_a_death_a_retry_and_out() {
    for size in [(80, 24), (40, 12)] {
        let data = folder(&format!("title-{}", size.0));
        let maps = data.join("maps");
        fs::create_dir(&maps).unwrap();
        fs::copy(test_map("danger"), maps.join("danger.toml")).unwrap();
        let mut player = start(&data, size);
        let has_bell = size.0 == 80;
        if has_bell {
            choose(&player, "Settings");
            choose(&player, "Bell when noticed or hurt");
            player.send("\x1b");
            player.wait_for("New game");
        }
        choose(&player, "My maps");
        player.wait_for("danger.toml");
        for _ in 0..40 {
            if player.text().lines().any(|line| line.contains("> ") && line.contains("danger.toml"))
            {
                break;
            }
            player.send("\x1b[B");
            thread::sleep(Duration::from_millis(300));
        }
        player.send("\r");
        player.wait_for("♥♥♥");
        // Walk onto the spikes, and stop there.
        for _ in 0..8 {
            player.send("w");
            thread::sleep(Duration::from_millis(700));
        }
        player.wait_for("killed by spikes");
        assert_eq!(rings(&player.bytes()), has_bell);
        thread::sleep(Duration::from_millis(1100));
        player.send("\r");
        player.wait_until("went on", |emulator| !emulator.text().contains("killed by"));
        player.wait_for("?");
        player.send("p");
        choose(&player, "Leave to the title");
        player.wait_for("New game");
        choose(&player, "Leave");
        let ending = player.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success());
        player.wait_for("Danger on normal: ");
    }
}

#[test]
fn a_map_started_by_its_path_is_saved_and_asked_about() {
    let data = folder("by-path");
    let map = test_map("pit");
    let play = || {
        let environment =
            [&ENVIRONMENT[..], &[("CELLCASTER_DATA", data.to_str().unwrap())]].concat();
        let arguments = ["play", map.to_str().unwrap()];
        Player::start((80, 24), Speaks::Plain, PROGRAM, arguments, &environment)
    };
    let mut player = play();
    player.wait_for("? help");
    assert!(!player.text().contains("a saved game"), "{}", player.text());
    player.send("w");
    thread::sleep(Duration::from_millis(500));
    player.send("q");
    player.wait_for("the game is saved");
    player.send("\r");
    player.wait_for_end().assert_given_back();

    let mut player = play();
    player.wait_for("a saved game");
    player.wait_for("> Continue");
    player.send("\x1b");
    player.wait_for_end().assert_given_back();
    // The title continues it, although its folder is not in the list of own maps.
    let mut player = start(&data, (80, 24));
    choose(&player, "Continue");
    player.wait_for("? help");
    player.send("q\r");
    player.wait_for_end().assert_given_back();
}

#[test]
fn leaving_the_title_says_nothing_and_keeps_nothing() {
    let data = folder("title-only");
    for leave in ["\x1b", "q"] {
        let mut player = start(&data, (80, 24));
        player.send(leave);
        player.wait_for_end().assert_given_back();
        assert!(!player.text().contains(" on normal"), "{}", player.text());
    }
    assert_eq!(fs::read_dir(&data).unwrap().count(), 0);
}
