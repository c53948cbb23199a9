//! Results of runs that were finished over SSH.

#[cfg(feature = "system-tests")]
use std::fs::{self, File};
#[cfg(feature = "system-tests")]
use std::io::Write;
#[cfg(feature = "system-tests")]
use std::path::PathBuf;
#[cfg(feature = "system-tests")]
use std::process::Command;

use rustix::process::Signal;

use super::maps::{HALL, enter_hall, maps, scores, win};
use crate::player::Player;
use crate::running::{Running, user_key};

/// Plays the host's own map in single-player mode until `sentence` appears, which states the outcome of the result.
fn play(player: &Player, name: &str, sentence: &str) {
    enter_hall(player, name);
    win(player, sentence);
}

#[test]
fn account_results_rank_and_survive_a_kill_but_guests_do_not_rank() {
    let maps = maps(&[("moss.toml", HALL)]);
    let config = format!("maps = \"{}\"\nroom = []\n", maps.display());
    let mut running = Running::start(&config, "text");
    let key = user_key(&running.folder);
    play(&running.visitor(), "Jon", "A guest's result does not count");
    assert!(!scores(&running.folder, &[]).contains("Jon"));
    play(&running.player(Some(&key)), "Mara", "You are number 1.");
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

/// A file system of one megabyte, unmounted on drop.
#[cfg(feature = "system-tests")]
struct SmallDisk(PathBuf);

#[cfg(feature = "system-tests")]
impl SmallDisk {
    fn mount() -> Self {
        let folder = crate::transport::folder();
        let mut mount = Command::new("mount");
        mount.args(["-t", "tmpfs", "-o", "size=1m,mode=700", "tmpfs"]).arg(&folder);
        assert!(mount.status().unwrap().success(), "root can mount");
        Self(folder)
    }

    fn fill(&self) {
        let mut file = File::create(self.0.join("filler")).unwrap();
        while file.write_all(&[0; 4096]).is_ok() {}
    }

    fn make_room(&self) {
        fs::remove_file(self.0.join("filler")).unwrap();
    }
}

#[cfg(feature = "system-tests")]
impl Drop for SmallDisk {
    fn drop(&mut self) {
        _ = Command::new("umount").arg("--lazy").arg(&self.0).status();
    }
}

#[cfg(feature = "system-tests")]
#[test]
fn a_result_waits_until_a_full_disk_has_room() {
    let disk = SmallDisk::mount();
    let maps = maps(&[("moss.toml", HALL)]);
    let config = format!("maps = \"{}\"\nroom = []\n", maps.display());
    let data = ["--data", disk.0.to_str().unwrap()];
    let mut running = Running::start_with(&config, "text", &data);
    let key = user_key(&running.folder);
    let player = running.player(Some(&key));
    enter_hall(&player, "Mara");
    disk.fill();
    win(&player, "The host's disk is full; your result waits until there is space.");
    assert!(!scores(&disk.0, &[]).contains("Mara"));
    assert!(!disk.0.join("waiting_results.new").exists());
    disk.make_room();
    player.wait_for("has been recorded.");
    assert!(scores(&disk.0, &["--level", "moss"]).contains("Mara"));
    running.signal(Signal::KILL);
    running.wait_for_end();
}
