//! The offer to tell tmux about its terminal's colours, in a tmux with its own server.

use std::env;
use std::fs;
use std::process::Command;
use std::thread;
use std::time::Duration;

use super::game::PROGRAM;
use crate::emulator::{Emulator, Speaks};
use crate::player::Player;

const VERSION_QUERY: &str = "\x1b[>q";
const VERSION: &str = "\x1bP>|kitty(0.42.1)\x1b\\";
const DOWN: &str = "\x1b[B";
const DETACH: &str = "\x02d";
/// The pause after which a key may come from a client that has just attached.
const PAUSE: Duration = Duration::from_millis(1200);

/// A tmux server, identified by its socket, which ends with the test. The path of a socket must be
/// short.
pub(crate) struct Server(String);

impl Server {
    /// The server of the test `name`. `None` if tmux is not installed, which is a failure if all programs must be
    /// installed.
    pub(crate) fn new(name: &str) -> Option<Self> {
        let is_installed = Command::new("tmux").arg("-V").output().is_ok();
        assert!(
            is_installed || env::var_os("CELLCASTER_SYSTEM_TESTS").is_none(),
            "tmux is installed"
        );
        if !is_installed {
            eprintln!("tmux is not installed: not tested");
            return None;
        }
        let name = format!("cellcaster-{name}-{}", std::process::id());
        Some(Self(env::temp_dir().join(name).to_str().unwrap().to_owned()))
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new("tmux");
        command.args(["-S", &self.0, "-f", "/dev/null"]).args(arguments);
        command
    }

    /// A client whose terminal claims to be kitty. tmux repeats characters in such a terminal.
    pub(crate) fn client(&self, arguments: &[&str]) -> Player {
        let words = [&["-u", "-S", &self.0, "-f", "/dev/null"], arguments].concat();
        let path = env::var("PATH").unwrap_or_default();
        let environment =
            [("PATH", &*path), ("LC_ALL", "C.UTF-8"), ("HOME", env!("CARGO_TARGET_TMPDIR"))];
        let player = Player::start((80, 24), Speaks::Alacritty, "tmux", words, &environment);
        player.wait_until("asked for the version", |emulator| has(emulator, VERSION_QUERY));
        player.send(VERSION);
        player
    }

    fn features(&self) -> String {
        let shown = self.command(&["show", "-s", "terminal-features"]).output().unwrap();
        String::from_utf8(shown.stdout).unwrap()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // It has ended already, unless the test has failed.
        _ = self.command(&["kill-server"]).output();
        _ = fs::remove_file(&self.0);
    }
}

fn has(emulator: &Emulator, bytes: &str) -> bool {
    emulator.bytes().windows(bytes.len()).any(|window| window == bytes.as_bytes())
}

fn has_true_color(emulator: &Emulator) -> bool {
    has(emulator, "\x1b[38;2;") || has(emulator, "\x1b[48;2;")
}

#[test]
fn tmux_sends_all_colours_after_the_player_confirms() {
    const OFFER: &str = "24-bit colours in tmux";
    let Some(server) = Server::new("tmux") else { return };
    let mut player = server.client(&["new-session", PROGRAM]);
    player.wait_for("New game");
    thread::sleep(PAUSE);
    player.send(DOWN);
    player.wait_for(OFFER);
    for _ in 0..12 {
        if player.text().contains(&format!("> {OFFER}")) {
            break;
        }
        player.send(DOWN);
        thread::sleep(Duration::from_millis(300));
    }
    player.wait_for(&format!("> {OFFER}"));
    player.send("\r");
    player.wait_for("tmux set -as terminal-features ',xterm-256color:RGB'");
    player.wait_for("> Tell tmux");
    assert!(!server.features().contains("RGB"), "told unasked: {}", server.features());
    player.send("\r");
    player.wait_for("Done. Detach");
    player.wait_for("set -as terminal-features ',xterm-256color:RGB'");
    assert!(server.features().contains("xterm-256color:RGB"), "{}", server.features());
    player.send(DETACH);
    assert!(player.wait_for_end().status.success());
    assert!(!player.look(has_true_color), "tmux reads features when a terminal attaches");

    let mut player = server.client(&["attach"]);
    player.wait_for("Done. Detach");
    thread::sleep(PAUSE);
    player.send(DOWN);
    player.wait_until("sent 24-bit colours", has_true_color);
    player.wait_until("closed the panel", |emulator| {
        emulator.text().contains("New game") && !emulator.text().contains(OFFER)
    });
    player.send("q");
    assert!(player.wait_for_end().status.success());
}
