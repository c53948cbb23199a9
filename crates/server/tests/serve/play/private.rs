//! Private rooms, which others enter with an invitation code.

use super::server::GameServer;
use crate::player::Player;

/// Takes a name, and presses each key once its text is shown.
fn press(player: &Player, name: &str, keys: &[(&str, &str)]) {
    player.wait_for("Enter saves it");
    player.send(format!("\x15{name}\r"));
    for (shown, key) in keys {
        player.wait_for(shown);
        player.send(key);
    }
}

#[test]
fn a_friend_enters_a_private_room_by_its_code() {
    let server = GameServer::open();
    let mara = server.player(&[]);
    let to_room = [
        ("Open a room", "3"),
        ("Hide and seek", "2"),
        ("The Museum", "1"),
        ("Open to", "2"),
        ("invited visitors", "1"),
        ("Mara comes in.", "\t"),
    ];
    press(&mara, "Mara", &to_room);
    mara.wait_for("invitation code ");
    let text = mara.text();
    let code = text.split("invitation code ").nth(1).map(|after| after[..6].to_lowercase());
    let jon = server.player(&[]);
    press(&jon, "Jon", &[("Enter a code", "7"), ("type the code", &code.expect("a code"))]);
    jon.send("\r");
    jon.wait_for("Jon comes in.");
    mara.wait_for("Jon comes in.");
}
