//! The campaign in a plain terminal of 80 by 24 cells, without key releases: the first level from
//! the title to its summary, by bytes.
//!
//! The player taps, as a tap has an exact effect: a quarter of a cell, or 5 degrees. They look east,
//! and walk in all directions without turning, until a door in the north needs it. Walls take what a
//! tap has too much, so that each stretch along a wall begins at a known place.

use std::fs;
use std::path::Path;
use std::thread;
use std::time::Duration;

use super::game::PROGRAM;
use super::titles::folder;
use crate::emulator::Speaks;
use crate::player::Player;

/// The time between two taps: no keyboard repeats as slowly, and no player taps much faster.
const BETWEEN_TAPS: Duration = Duration::from_millis(115);
/// The taps for a cell.
const CELL: usize = 4;

/// Taps `key` so often that the player walks `cells`.
fn walk(player: &Player, key: &str, cells: usize) {
    tap(player, key, cells * CELL);
}

fn tap(player: &Player, key: &str, times: usize) {
    for _ in 0..times {
        player.send(key);
        thread::sleep(BETWEEN_TAPS);
    }
}

/// Waits for gold in one of the forms that the status line has for it.
#[track_caller]
fn wait_for_gold(player: &Player, forms: [&str; 2]) {
    player.wait_until(&format!("showed {forms:?}"), |screen| {
        forms.iter().any(|form| screen.text().contains(&format!("{form} gold")))
    });
}

/// The program, which keeps what was won in `data`.
fn start(data: &Path) -> Player {
    let environment =
        [("HOME", env!("CARGO_TARGET_TMPDIR")), ("CELLCASTER_DATA", data.to_str().unwrap())];
    let arguments: [&str; 0] = [];
    Player::start((80, 24), Speaks::Plain, PROGRAM, arguments, &environment)
}

/// The first level of the easiest game, begun from the title.
fn begin(data: &Path) -> Player {
    let player = start(data);
    player.wait_for("> New game");
    player.send("\r");
    player.wait_for("> Normal");
    player.send("\x1b[A");
    player.wait_for("> Easy");
    player.send("\r");
    player.wait_for("0/100 gold");
    player
}

#[test]
fn the_first_level_is_won_by_taps_in_a_plain_terminal() {
    let data = folder("campaign");
    let mut player = begin(&data);
    player.wait_for("♥♥♥♥♥♥");
    player.wait_for("Two cups, and wake nobody");
    walk(&player, "d", 2);
    player.wait_for("To you, from R.");
    // The warden comes along the corridor, turns, and goes back: behind him, nobody is seen.
    walk(&player, "w", 2);
    thread::sleep(Duration::from_secs(9));
    walk(&player, "d", 2);
    walk(&player, "s", 2);
    tap(&player, "d", 4 * CELL + 1);
    player.send("e");
    thread::sleep(Duration::from_millis(500));
    tap(&player, "w", 4 * CELL + 1);
    walk(&player, "d", 3);
    wait_for_gold(&player, ["50/100", "50 of 100"]);
    player.wait_for("brass key");
    walk(&player, "w", 3);
    player.wait_until("showed five pebbles", |screen| {
        ["5p", "5 pebbles"].iter().any(|form| screen.text().contains(form))
    });
    // Two doors in the north: an oak one, and the brass one.
    tap(&player, "u", 90 / 5);
    player.send("e");
    thread::sleep(Duration::from_millis(500));
    walk(&player, "w", 2);
    walk(&player, "d", 1);
    player.send("e");
    thread::sleep(Duration::from_millis(500));
    walk(&player, "w", 2);
    wait_for_gold(&player, ["100/130", "100 of 130"]);
    walk(&player, "s", 2);
    walk(&player, "d", 8);
    wait_for_gold(&player, ["115/130", "115 of 130"]);
    walk(&player, "s", 2);
    walk(&player, "d", 1);
    player.wait_for("you found the way out");
    for shown in [
        "Cellar",
        "level 1 of 12",
        "in 0:",
        "rank: ",
        "gold: 115 of 130",
        "alarms: ",
        "secrets: 0 of 1",
    ] {
        assert!(player.text().contains(shown), "{shown}:\n{}", player.text());
    }
    let progress = fs::read_to_string(data.join("progress.toml")).unwrap();
    for kept in ["[best.\"cellar\".easy]", "treasure = [115, 130]", "deaths = 0"] {
        assert!(progress.contains(kept), "{kept}:\n{progress}");
    }
    // A panel that has just appeared takes no key.
    thread::sleep(Duration::from_millis(700));
    player.send("\r");
    player.wait_for("The Museum of Walls");
    player.wait_for("♥♥♥♥♥♥");
    player.send("q");
    player.wait_for("q or Enter leaves");
    player.send("\r");
    let ending = player.wait_for_end();
    ending.assert_given_back();
    assert!(ending.status.success());
}

#[test]
fn the_second_level_is_offered_at_the_next_start() {
    let data = folder("campaign-goes-on");
    let best = "version = 1\n[preferences]\ncrosshair = false\ncompass = false\nbell = false\n\
                ghost = true\ndifficulty = \"easy\"\n[best.\"cellar\".easy]\nsteps = 1800\n\
                treasure = [115, 130]\nsecrets = [0, 1]\nalarms = 0\ndeaths = 0\nstunned = 0\n\
                rank = \"Shadow\"\n";
    fs::write(data.join("progress.toml"), best).unwrap();
    let player = start(&data);
    player.wait_for("> Continue  Museum");
    player.send("\r");
    player.wait_for("Take the crown of plaster");
}
