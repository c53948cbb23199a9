//! Talk between visitors, and its moderation.

use std::fs;

use rustix::process::Signal;

use crate::play::enter_room;
use crate::player::Player;
use crate::running::{Running, user_key};

fn say(player: &Player, line: &str) {
    player.send("/");
    player.wait_for(" say: ");
    player.send(format!("{line}\r"));
}

/// Takes a name, and stays in the lobby.
fn enter_lobby(player: &Player, name: &str) {
    player.wait_for("Enter saves it");
    player.send(format!("\x15{name}\r"));
    player.wait_for("Open a room");
}

/// The fingerprint of a visitor's key, as the operator's list shows it.
fn fingerprint(running: &Running, name: &str) -> String {
    let who = running.admin_says(&["who"]);
    let row = who.lines().find(|line| line.contains(name)).unwrap_or_else(|| panic!("{who}"));
    row.split(' ').next_back().unwrap().to_owned()
}

#[test]
fn visitors_write_to_each_other_ignore_and_report_each_other() {
    let running = Running::start("", "text");
    let [mara, jon] = [0; 2].map(|_| running.visitor());
    enter_room(&mara, "Mara");
    enter_lobby(&jon, "Jon");
    say(&mara, "/tell jon come in");
    jon.wait_for("Mara (private) come in");
    say(&jon, "/reply a moment");
    mara.wait_for("Jon (private) a moment");
    say(&jon, "/report Mara impatient");
    jon.wait_for("You have reported Mara to this host.");
    running.wait_for_log("reported");
    let log = running.log();
    let report =
        log.lines().find(|line| line.ends_with("reported") || line.contains("reported ")).unwrap();
    for part in ["player=\"Mara\"", "reporter=\"Jon\"", "reason=\"impatient\"", "lines=\"come in\""]
    {
        assert!(report.contains(part), "{part}: {report}");
    }
    // Nothing else that visitors say is in the log.
    assert!(!log.contains("a moment"), "{log}");
    say(&jon, "/ignore Mara");
    jon.wait_for("You ignore Mara");
    say(&mara, "/tell jon where are you?");
    mara.wait_for("to jon (private) where are you?");
    say(&mara, "/ignore jon");
    mara.wait_for("You ignore jon");
    assert!(!jon.text().contains("where are you?"), "{}", jon.text());
}

#[test]
fn a_mute_by_the_operator_survives_a_restart() {
    let mut running = Running::start("", "text");
    let key = user_key(&running.folder);
    let jon = running.player(Some(&key));
    enter_room(&jon, "Jon");
    let mute = ["mute", "jon", "--for", "1h", "--reason", "insults"];
    let muted = running.admin_says(&mute);
    assert!(muted.starts_with("muted jon and SHA256:"), "{muted}");
    assert!(muted.ends_with(" for 1h\n"), "{muted}");
    let sentence = "The operator of this host has muted you for ";
    let says_nothing = |player: &Player| {
        player.wait_until("is muted", |emulator| {
            if !emulator.text().contains(" say: ") {
                player.send("/");
            }
            player.send("hello\r");
            std::thread::sleep(std::time::Duration::from_millis(1_500));
            emulator.text().contains("has muted you")
        });
        player.wait_for(sentence);
    };
    says_nothing(&jon);
    running.signal(Signal::TERM);
    assert_eq!(running.wait_for_end(), Some(0));
    assert!(running.admin_says(&["mutes"]).contains("insults"));
    assert_eq!(running.admin_says(&["bans"]), "nobody is banned\n");
    running.restart();
    let [jon, mara] = [running.player(Some(&key)), running.visitor()];
    enter_room(&jon, "Jon");
    enter_room(&mara, "Mara");
    say(&jon, "good evening");
    jon.wait_for(sentence);
    assert!(!mara.text().contains("good evening"), "{}", mara.text());
    let unmuted = running.admin_says(&["unmute", "jon"]);
    assert!(unmuted.ends_with(" may talk again\n"), "{unmuted}");
    assert_eq!(running.admin_says(&["mutes"]), "nobody is muted\n");
    mara.wait_until("hears Jon", |emulator| {
        say(&jon, "good evening");
        std::thread::sleep(std::time::Duration::from_millis(1_500));
        emulator.text().contains("Jon good evening")
    });
}

#[test]
fn guests_are_muted_by_address() {
    let running = Running::start("", "text");
    let jon = running.visitor();
    enter_lobby(&jon, "Jon");
    assert_eq!(running.admin_says(&["mute", "JON"]), "muted 127.0.0.1/32 forever\n");
    let mutes = running.admin_says(&["mutes"]);
    assert!(mutes.starts_with("muted ") && mutes.contains("127.0.0.1/32"), "{mutes}");
    // Each login reads the mutes.
    let kim = running.visitor();
    enter_lobby(&kim, "Kim");
    say(&jon, "hello");
    jon.wait_for("The operator of this host has muted you.");
    let who = running.admin_says(&["who"]);
    let session = who.lines().nth(1).unwrap().split(' ').next().unwrap();
    assert_eq!(running.admin_says(&["unmute", "kim"]), "127.0.0.1/32 may talk again\n");
    assert_eq!(
        running.admin_says(&["mute", "--session", session, "--for", "30m"]),
        "muted 127.0.0.1/32 for 30m\n"
    );
}

#[test]
fn moderators_named_in_the_configuration_mute_and_kick() {
    let running = Running::start("", "text");
    let key = user_key(&running.folder);
    let mara = running.player(Some(&key));
    enter_room(&mara, "Mara");
    let mut jon = running.visitor();
    enter_room(&jon, "Jon");
    say(&mara, "/mute jon 10m");
    mara.wait_for("Only moderators of this host can do that.");
    let configuration = format!("moderators = [\"{}\"]\n", fingerprint(&running, "Mara"));
    fs::write(running.folder.join("serve.toml"), configuration).unwrap();
    running.signal(Signal::HUP);
    running.wait_for_log("configuration reloaded");
    say(&mara, "/mute jon 10m shouting");
    mara.wait_for("jon is muted for 10m.");
    say(&jon, "HELLO");
    jon.wait_for("The moderator Mara has muted you for 10m: shouting");
    assert!(!mara.text().contains("HELLO"), "{}", mara.text());
    assert!(running.admin_says(&["mutes"]).contains("moderator Mara"));
    say(&mara, "/unmute jon");
    mara.wait_for("jon may talk again.");
    say(&mara, "/kick jon enough");
    jon.wait_for("The moderator Mara has ended your session: enough");
    jon.wait_for_end();
    for event in [
        "muted moderator=\"Mara\" player=\"jon\"",
        "unmuted moderator=\"Mara\"",
        "kicked moderator=\"Mara\"",
    ] {
        running.wait_for_log(event);
    }
}
