//! Private rooms, which others enter with an invitation code.

use crate::player::Player;
use crate::running::Running;

/// Takes a name, and presses each key once its text is shown.
fn press(player: &Player, name: &str, keys: &[(&str, &str)]) {
    player.wait_for("Enter saves it");
    player.send(format!("\x15{name}\r"));
    for (shown, key) in keys {
        player.wait_for(shown);
        player.send(key);
    }
}

/// Opens a private room; returns its code.
pub(crate) fn open_private(player: &Player, name: &str) -> String {
    let comes_in = format!("{name} has joined.");
    let to_room = [
        ("Open a room", "3"),
        ("Hide and seek", "2"),
        ("The Museum", "1"),
        ("Open to", "2"),
        ("invited visitors", "1"),
        (comes_in.as_str(), "\t"),
    ];
    press(player, name, &to_room);
    player.wait_for("invitation code ");
    let text = player.text();
    let (_, after) = text.split_once("invitation code ").unwrap();
    after[..6].to_owned()
}

/// Enters a private room by its code, in lower case.
pub(crate) fn enter_by_code(player: &Player, name: &str, code: &str) {
    press(player, name, &[("Enter a code", "7"), ("type the code", &code.to_lowercase())]);
    player.send("\r");
    player.wait_for(&format!("{name} has joined."));
}

#[test]
fn a_friend_enters_a_private_room_by_its_code() {
    let server = Running::start("", "text");
    let [mara, jon] = [(); 2].map(|()| server.visitor());
    let code = open_private(&mara, "Mara");
    enter_by_code(&jon, "Jon", &code);
    mara.wait_for("Jon has joined.");
}
