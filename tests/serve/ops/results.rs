//! Results of runs that were played to the end over SSH.

use rustix::process::Signal;

use super::killed::user_key;
use super::maps::{HALL, choose, maps, scores};
use super::running::Running;
use crate::player::Player;
use crate::transport::wait_until;

/// Plays the map of the host alone until `sentence` says what became of the result.
fn win(player: &Player, name: &str, sentence: &str) {
    choose(player, name, "4");
    player.wait_for("The moss hall");
    // The last level of the list.
    player.send("\x1b[F\r");
    player.wait_for("Go in");
    player.send("\r");
    player.wait_for("comes in.");
    wait_until(sentence, || {
        player.send("w");
        player.text().contains(sentence)
    });
}

#[test]
fn results_of_accounts_rank_and_outlive_a_kill_and_those_of_guests_do_not_rank() {
    let maps = maps(&[("moss.toml", HALL)]);
    let config = format!("maps = \"{}\"\nroom = []\n", maps.display());
    let mut running = Running::start(&config, "text");
    let key = user_key(&running.folder);
    win(&running.visitor(), "Jon", "A guest's result does not rank");
    assert!(!scores(&running.folder, &[]).contains("Jon"));
    win(&running.player(Some(&key)), "Mara", "You are number 1.");
    running.signal(Signal::KILL);
    running.wait_for_end();
    let boards = scores(&running.folder, &["--level", "moss"]);
    assert!(boards.contains("Mara") && !boards.contains("Jon"), "{boards}");

    running.restart();
    let player = running.player(Some(&key));
    player.wait_for("> Mara");
    player.send("\r");
    player.wait_for("Alone, for the board");
    player.send("5");
    player.wait_for("The moss hall");
    player.send("\x1b[F\r");
    player.wait_for("Mara (you)");
    assert!(!player.text().contains("Jon"), "{}", player.text());
}
