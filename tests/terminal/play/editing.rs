//! The editor of map files: drawing, testing, writing, and ends of every kind.

use std::fs;
use std::path::{Path, PathBuf};

use cellcaster::game::is_exit_out_of_reach;
use cellcaster::map;
use rustix::process::Signal;

use super::game::{ENVIRONMENT, PROGRAM};
use super::tmux::Server;
use crate::emulator::{Modes, Speaks};
use crate::player::Player;
use crate::support::complaint_about;

const ESCAPE: &str = "\x1b";
const KEYS: &str = "hjkl move";

/// The path of a map that does not exist, in a new folder of the test `name`.
fn new_map(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("editing").join(name);
    _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder.join("yard.toml")
}

fn start(speaks: Speaks, path: &Path) -> Player {
    let words = ["edit", path.to_str().unwrap()];
    let player = Player::start((80, 24), speaks, PROGRAM, words, &ENVIRONMENT);
    player.wait_for(KEYS);
    player
}

/// The rows of the grid in the file.
fn rows(path: &Path) -> Vec<String> {
    let text = fs::read_to_string(path).unwrap();
    text.split("'''").nth(1).unwrap().trim().lines().map(str::to_owned).collect()
}

/// The characters of a column of the grid in the file.
fn column(path: &Path, index: usize) -> String {
    rows(path).iter().map(|row| row.chars().nth(index).unwrap()).collect()
}

#[test]
fn a_new_level_is_drawn_tested_and_written() {
    for (speaks, name) in [(Speaks::Plain, "plain"), (Speaks::Kitty, "kitty")] {
        let path = new_map(name);
        let mut player = start(speaks, &path);
        player.wait_for("no faults");
        player.send("llr+");
        player.wait_for("before the faults");
        player.send("u");
        player.wait_for("no faults");
        player.send("r#");
        player.wait_for("yard.toml *");
        player.send("ht");
        player.wait_for("Esc returns to the editor");
        player.send(ESCAPE);
        player.wait_for(KEYS);
        player.send(":wq\r");
        let ending = player.wait_for_end();
        ending.assert_given_back();
        assert!(ending.status.success());
        assert_eq!(rows(&path)[2], "#.@.#................#");
        assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
    }
}

#[test]
fn the_mouse_draws() {
    let path = new_map("mouse");
    let mut player = start(Speaks::Plain, &path);
    player.wait_until("took the mouse", |it| it.modes().mouse != Modes::default().mouse);
    // The north-western corner of the grid, which is two columns a cell.
    let corner = player.look(|emulator| {
        let text = emulator.text();
        let rows = text.lines().map(|row| row.chars().position(|it| it == '#')).enumerate();
        rows.skip(1).find_map(|(row, column)| Some([column?, row]))
    });
    let [left, top] = corner.unwrap();
    let report = |button: u8, [column, row]: [usize; 2], end: char| {
        format!("\x1b[<{button};{};{}{end}", left + 1 + 2 * column, top + 1 + row)
    };
    player.send(report(0, [4, 4], 'M') + &report(32, [4, 6], 'M') + &report(0, [4, 6], 'm'));
    player.wait_for("4,6");
    player.send(":wq\r");
    player.wait_for_end().assert_given_back();
    assert_eq!(column(&path, 4), "#...###...#");
}

#[test]
fn a_killed_editor_loses_nothing() {
    let path = new_map("killed");
    let mut player = start(Speaks::Plain, &path);
    player.send("jr#");
    player.wait_for("yard.toml *");
    player.signal(Signal::KILL);
    player.wait_for_end();
    assert!(!path.exists());

    let mut player = start(Speaks::Plain, &path);
    player.wait_for("> Restore the changes");
    player.send("\r");
    player.wait_for("restored");
    player.wait_for("yard.toml *");
    player.send(":wq\r");
    player.wait_for_end().assert_given_back();
    assert_eq!(rows(&path)[3], "#.#..................#");
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1);
}

#[test]
fn an_editor_that_must_end_keeps_the_changes() {
    for signal in [None, Some(Signal::TERM), Some(Signal::HUP)] {
        let path = new_map("ended");
        let mut player = start(Speaks::Kitty, &path);
        player.send("jr#");
        player.wait_for("yard.toml *");
        match signal {
            Some(signal) => player.signal(signal),
            None => player.send("\x03"),
        }
        player.wait_for_end().assert_given_back();
        assert!(path.with_file_name("yard.toml.journal").exists());
        if signal.is_none() {
            assert!(player.text().contains("has unsaved changes"), "{}", player.text());
        }
    }
}

#[test]
fn the_editor_works_in_tmux() {
    let Some(server) = Server::new("edit") else { return };
    let path = new_map("tmux");
    let mut player = server.client(&["new-session", PROGRAM, "edit", path.to_str().unwrap()]);
    player.wait_for(KEYS);
    player.send("lllr#");
    player.wait_for("yard.toml *");
    player.send("v");
    player.wait_for("Space fills the selection");
    player.send("jj ");
    player.wait_for("5,4  #  wall = \"brick\"");
    player.send(ESCAPE);
    player.send("ht");
    player.wait_for("Esc returns to the editor");
    player.send(ESCAPE);
    player.wait_for(KEYS);
    player.send(":wq\r");
    assert!(player.wait_for_end().status.success());
    assert_eq!(column(&path, 5), "#.###.....#");
}

#[test]
fn files_that_cannot_be_edited_are_mistakes() {
    let broken = new_map("broken");
    fs::write(&broken, "grid = '#'\nfloor = \n").unwrap();
    for (file, sentence) in [
        (
            "tests/tiled/yard.tmx",
            "change it in Tiled, with \"cellcaster tests/tiled/yard.tmx --watch\"",
        ),
        ("maps/gallery/spheres.toml", "no grid to edit"),
        ("cellar", "ends in .toml"),
        ("-", "name one"),
        ("maps", "is a folder"),
        ("nowhere/level.toml", "no folder nowhere"),
        (broken.to_str().unwrap(), "yard.toml:2:9"),
    ] {
        let complaint = complaint_about(&["edit", file]);
        assert!(complaint.contains(sentence), "{file}: {complaint}");
    }
}

/// The steps of docs/editor.md.
#[test]
fn the_page_leads_from_nothing_to_a_level_with_two_guards() {
    const UP: &str = "\x1b[A";
    const DOWN: &str = "\x1b[B";
    const RIGHT: &str = "\x1b[C";
    const LEFT: &str = "\x1b[D";
    let path = new_map("guards");
    let mut player = start(Speaks::Plain, &path);
    player.send(RIGHT.repeat(8) + &UP.repeat(2) + "bv" + &DOWN.repeat(10) + " ");
    player.send(UP.repeat(5) + "r+" + &RIGHT.repeat(3) + "rg>");
    player.send(format!("{UP}:thing 1 waypoint = true\r {}", RIGHT.repeat(5)));
    player.send(format!(":thing 2 waypoint = true\r {}", LEFT.repeat(2)));
    player.send(":thing h guard = \"hound\", patrol = \"12\"\r ");
    player.wait_for("no faults");
    player.send(LEFT.repeat(14) + &UP.repeat(2) + "t");
    player.wait_for("Esc returns to the editor");
    player.send(ESCAPE);
    player.wait_for(KEYS);
    player.send(":set title = \"My level\"\r:wq\r");
    player.wait_for_end().assert_given_back();
    let world = map::load(&path).unwrap();
    assert_eq!((world.title(), world.guards().len()), ("My level", 2));
    assert!(!is_exit_out_of_reach(&world));
    let lines = rows(&path);
    assert_eq!(lines[4..6], ["#.........#..1..h.2..#", "#.........+..g.......#"]);
}
