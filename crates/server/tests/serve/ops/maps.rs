//! The host's own maps, and the standing rooms in its configuration.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use rustix::process::Signal;

use crate::play::enter_room;
use crate::player::Player;
use crate::running::{Running, user_key};
use crate::support::{game_program, server};
use crate::transport::{folder, wait_until};

/// A hall with the exit a few steps ahead of the start.
pub(crate) const HALL: &str = r##"title = "The moss hall"
grid = '''
#########
#@....>.#
#########
'''
[tiles]
"#" = { wall = "#507050" }
[things]
"@" = { start = 0 }
">" = { exit = true }
"##;

/// A folder with maps.
pub(crate) fn maps(files: &[(&str, &str)]) -> PathBuf {
    let maps = folder();
    for (name, text) in files {
        fs::write(maps.join(name), text).unwrap();
    }
    maps
}

fn serve(arguments: &[&str]) -> Output {
    let words = [&["--listen", "127.0.0.1:0"], arguments].concat();
    server(&words).env("CELLCASTER_DATA", folder()).output().unwrap()
}

/// Asserts exit status 2 and returns the error message.
fn complaint(arguments: &[&str]) -> String {
    let output = serve(arguments);
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{error}");
    error
}

pub(crate) fn scores(data: &Path, arguments: &[&str]) -> String {
    let words = [&["scores"], arguments].concat();
    let output = server(&words).env("CELLCASTER_DATA", data).output().unwrap();
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn replay(arguments: &[&Path]) -> Output {
    server(&["replay", "--verify"]).args(arguments).output().unwrap()
}

/// Takes a new name, and presses `entry` in the lobby.
pub(crate) fn choose(player: &Player, name: &str, entry: &str) {
    player.wait_for("Enter saves it");
    player.send(format!("\x15{name}"));
    player.wait_for(name);
    player.send("\r");
    player.wait_for("Alone, for the board");
    player.send(entry);
}

/// Takes a new name, and enters the [`HALL`] to play alone.
pub(crate) fn enter_hall(player: &Player, name: &str) {
    choose(player, name, "4");
    go_in(player);
}

/// Enters the [`HALL`] from the list of levels.
pub(crate) fn go_in(player: &Player) {
    player.wait_for("The moss hall");
    // The last level in the list.
    player.send("\x1b[F\r");
    player.wait_for("Go in");
    player.send("\r");
    player.wait_for("has joined.");
}

/// Walks to the exit until `sentence` appears, which states the outcome of the result.
pub(crate) fn win(player: &Player, sentence: &str) {
    wait_until(sentence, || {
        player.send("w");
        player.text().contains(sentence)
    });
}

#[test]
fn map_faults_read_as_in_check_and_prevent_the_start() {
    let ragged = HALL.replace("#@....>.#", "#@....>.##");
    let unknown = HALL.replace("#@....>.#", "#@..?.>.#");
    let maps = maps(&[("ragged.toml", &ragged), ("unknown.toml", &unknown), ("right.toml", HALL)]);
    let error = complaint(&["--maps", maps.to_str().unwrap()]);
    for name in ["ragged.toml", "unknown.toml"] {
        let file = maps.join(name);
        let check = Command::new(game_program()).arg("check").arg(&file).output().unwrap();
        let check = String::from_utf8(check.stderr).unwrap();
        let report = check.trim().trim_start_matches("cellcaster: ");
        assert!(!report.is_empty() && error.contains(report), "{report}\nis not in\n{error}");
    }
    assert!(!error.contains("right.toml"), "{error}");
}

#[test]
fn bad_map_names_and_folders_are_refused_with_a_sentence() {
    let taken = maps(&[("cellar.toml", HALL)]);
    let odd = maps(&[("Moss hall.toml", HALL)]);
    for (folder, said) in [
        (taken.to_str().unwrap(), "cellar is a built-in level"),
        (odd.to_str().unwrap(), "of the characters a to z"),
        ("/nowhere", "the maps in /nowhere can't be read"),
    ] {
        let error = complaint(&["--maps", folder]);
        assert!(error.contains(said) && error.lines().count() == 1, "{error}");
    }
}

#[test]
fn a_run_in_a_host_map_ranks_and_its_recording_replays() {
    let maps = maps(&[("moss.toml", HALL)]);
    let recordings = folder();
    let options = ["--maps", maps.to_str().unwrap(), "--record-room", recordings.to_str().unwrap()];
    let config = "room = []\n";
    let running = Running::start_with(config, "text", &options);
    let key = user_key(&running.folder);
    let player = running.player(Some(&key));
    enter_hall(&player, "Mara");
    wait_until("the room", || running.admin_says(&["rooms"]).contains("moss"));
    wait_until("the result", || {
        player.send("w");
        scores(&running.folder, &["--level", "moss"]).contains("Mara")
    });
    running.wait_for_log("results: verified");
    drop(player);
    wait_until("the empty room", || !running.admin_says(&["rooms"]).contains("moss"));

    let recording = recordings.join("private-1.log");
    let alone = replay(&[&recording]);
    let error = String::from_utf8(alone.stderr).unwrap();
    assert_eq!(alone.status.code(), Some(2), "{error}");
    assert!(error.contains("it was recorded in the map moss.toml"), "{error}");
    for given in [&maps, &maps.join("moss.toml")] {
        let replayed = replay(&[&recording, given]);
        let text = String::from_utf8(replayed.stdout).unwrap();
        assert!(text.starts_with("round 1: Alone, for the board in The moss hall, "), "{text}");
    }
    // A map with different text counts as another map.
    fs::write(maps.join("moss.toml"), HALL.replace("#@....>.#", "#@...>..#")).unwrap();
    assert_eq!(replay(&[&recording, &maps]).status.code(), Some(2));
    // Another version names the cast, which shows what happened.
    let cast = recording.with_extension("cast");
    assert!(fs::read_to_string(&cast).unwrap().contains("The moss hall"));
    let text = fs::read_to_string(&recording).unwrap();
    fs::write(&recording, text.replacen("cellcaster-room 3", "cellcaster-room 399", 1)).unwrap();
    let error = String::from_utf8(replay(&[&recording]).stderr).unwrap();
    assert!(error.contains(&format!("\"asciinema play {}\"", cast.display())), "{error}");
    fs::remove_file(&cast).unwrap();
    let error = String::from_utf8(replay(&[&recording]).stderr).unwrap();
    assert!(
        error.contains("replay it with that version") && !error.contains("asciinema"),
        "{error}"
    );
}

#[test]
fn standing_rooms_follow_the_configuration() {
    let maps = maps(&[("moss.toml", HALL)]);
    let text = |rooms: &str| {
        format!("name = \"Mara's\"\nmaps = \"{}\"\nempty-room-seconds = 0\n{rooms}", maps.display())
    };
    let race = "[[room]]\nmode = \"race\"\nlevel = \"moss\"\n";
    let hide = "[[room]]\nmode = \"hide\"\nlevel = \"cellar\"\ndifficulty = \"hard\"\n";
    let running = Running::start(&text(&format!("{race}{hide}")), "text");
    let rooms = || {
        let text = running.admin_says(&["rooms"]);
        let row =
            |line: &str| line.split_whitespace().skip(1).take(2).collect::<Vec<_>>().join(" ");
        text.lines().skip(1).map(row).collect::<Vec<_>>()
    };
    assert_eq!(rooms(), ["race moss", "hide cellar"]);
    // A player enters the race.
    let player = running.player(None);
    choose(&player, "Mara", "\r");
    player.wait_for("Mara's");
    player.wait_for("Go in");
    player.send("\r");
    player.wait_for("has joined.");

    let config = running.folder.join("serve.toml");
    let tag = "[[room]]\nmode = \"tag\"\n";
    fs::write(&config, text(&format!("{hide}{tag}"))).unwrap();
    running.signal(Signal::HUP);
    wait_until("the new room", || rooms().contains(&"tag museum".to_owned()));
    // The old room is no longer standing, but it still has a member.
    assert_eq!(rooms(), ["race moss", "hide cellar", "tag museum"]);
    drop(player);
    wait_until("the end of the old room", || rooms() == ["hide cellar", "tag museum"]);

    fs::write(&config, text("[[room]]\nlevel = \"mos\"\n")).unwrap();
    running.signal(Signal::HUP);
    running.wait_for_log("there is no level \\\"mos\\\"");
    assert_eq!(rooms(), ["hide cellar", "tag museum"]);
}

#[test]
fn a_standing_room_in_an_unknown_level_prevents_the_start() {
    let config = folder().join("serve.toml");
    fs::write(&config, "connections = 9\n[[room]]\nlevel = \"celar\"\n").unwrap();
    let error = complaint(&["--config", config.to_str().unwrap()]);
    for part in ["serve.toml:3:", "there is no level \"celar\"", "the nearest level is \"cellar\""]
    {
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn a_finish_is_announced_and_the_finisher_watches_the_others() {
    let maps = maps(&[("moss.toml", HALL)]);
    let room = "[[room]]\nmode = \"race\"\nlevel = \"moss\"\n";
    let running = Running::start(&format!("maps = \"{}\"\n{room}", maps.display()), "text");
    let [mara, jon] = ["Mara", "Jon"].map(|name| {
        let player = running.player(None);
        enter_room(&player, name);
        player
    });
    jon.wait_for("be first at the exit");
    wait_until("the finish", || {
        mara.send("w");
        mara.text().contains("watching Jon")
    });
    assert!(mara.text().contains("1st, 0:"), "{}", mara.text());
    jon.wait_for("1st: Mara 0:");
    jon.wait_for("the race ends in 0:");
}
