//! The lobby as a place: its picture, the visitors and the board.

use super::private::in_lobby;
use super::*;
use crate::config::Config;
use crate::rooms::summary::RoomId;
use cellcaster::terminal::Fidelity;

/// The number of bytes that a visitor receives in this time, in milliseconds.
fn bytes_in(rig: &mut Rig, index: usize, milliseconds: u64) -> usize {
    let begun = rig.now();
    rig.pump(milliseconds);
    rig.clients[index].received(begun).iter().map(Vec::len).sum()
}

const WALK: &str = "\x1b[119;1:1u";
const STAND: &str = "\x1b[119;1:3u";

#[test]
fn the_lobby_shows_the_liveliest_room_and_its_changes() {
    let mut rig = Rig::new(Mode::Roam);
    let jon = in_lobby(&mut rig, "Jon", (80, 24));
    assert!(rig.text(jon).contains("nobody is walking"), "{}", rig.text(jon));
    let mara = rig.member("Mara", (80, 24), Speaks::Kitty);
    rig.pump(1_000);
    assert!(rig.text(jon).contains("Mara┘"), "{}", rig.text(jon));
    let before = rig.text(jon);
    rig.send(mara, WALK);
    rig.pump(1_000);
    assert_ne!(rig.text(jon), before);
    // A room with more members takes its place.
    for (name, keys) in [("Kim", &["2", "2", ENTER, ENTER][..]), ("Lee", &["2", ENTER])] {
        let other = in_lobby(&mut rig, name, (80, 24));
        for key in keys {
            rig.press(other, key);
        }
    }
    assert_eq!(rig.rooms().view(RoomId(2)).map(|room| room.members.len()), Some(2));
    rig.pump(1_000);
    assert!(rig.text(jon).contains("┌Tag in The Hall─"), "{}", rig.text(jon));
    assert!(rig.text(jon).contains("Kim, Lee┘"), "{}", rig.text(jon));
}

#[test]
fn a_lobby_at_rest_costs_no_bytes() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.member("Mara", (80, 24), Speaks::Kitty);
    let jon = in_lobby(&mut rig, "Jon", (80, 24));
    rig.pump(10_000);
    assert_eq!(bytes_in(&mut rig, jon, 60_000), 0);
    rig.send(mara, WALK);
    assert!(bytes_in(&mut rig, jon, 1_000) > 0);
    rig.send(mara, STAND);
    rig.pump(10_000);
    assert_eq!(bytes_in(&mut rig, jon, 60_000), 0);
    // A page without a picture costs nothing, even while the room changes.
    let kim = rig.visitor("Kim", (80, 24), Speaks::Kitty);
    rig.press(mara, "b");
    rig.send(mara, WALK);
    assert_eq!(bytes_in(&mut rig, kim, 1_000), 0);
}

#[test]
fn the_lobby_draws_few_pictures_a_second() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = rig.member("Mara", (80, 24), Speaks::Kitty);
    let jon = in_lobby(&mut rig, "Jon", (80, 24));
    rig.session(jon, |session, _| session.protocol.set_fidelity(Some(Fidelity::EXACT)));
    rig.pump(2_000);
    rig.send(mara, WALK);
    let begun = rig.now();
    rig.pump(2_000);
    let pictures = rig.clients[jon].received(begun).len();
    assert!((6..=9).contains(&pictures), "{pictures}");
    // If frames come rarely, pictures come more rarely still.
    rig.live.replace(Config { frames_per_second: 5, ..Config::default() });
    rig.press(mara, "b");
    rig.send(mara, WALK);
    let begun = rig.now();
    rig.pump(2_000);
    let pictures = rig.clients[jon].received(begun).len();
    assert!((1..=2).contains(&pictures), "{pictures}");
}

#[test]
fn talk_covers_neither_the_menu_nor_a_list() {
    for size in [(80, 24), (80, 50), (140, 40)] {
        let mut rig = Rig::new(Mode::Roam);
        let jon = in_lobby(&mut rig, "Jon", size);
        let others = ["Kim", "Lee"].map(|name| in_lobby(&mut rig, name, (80, 24)));
        let before = rig.text(jon);
        for (kim, number) in others.into_iter().cycle().zip(1..=4) {
            rig.press(
                kim,
                &format!("/{number}: {}\r", "who comes along to the museum now? ".repeat(2)),
            );
        }
        let text = rig.text(jon);
        assert!(text.contains("4: who comes along to the"), "{text}");
        let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
        let (before, after) = (lines(&before), lines(&text));
        // The left column, with the menu, and the panels below the picture are unchanged.
        let below = after.iter().position(|line| line.contains("nobody is walking")).unwrap();
        for (row, (one, other)) in before.iter().zip(&after).enumerate() {
            let columns = if row > below { usize::MAX } else { 34 };
            let part = |line: &str| line.chars().take(columns).collect::<String>();
            assert_eq!(part(one), part(other), "{text}");
        }
    }
}

#[test]
fn the_lobby_lists_who_is_here() {
    let mut rig = Rig::new(Mode::Roam);
    let jon = in_lobby(&mut rig, "Jon", (120, 40));
    let shows = |rig: &Rig, words: [&str; 2]| {
        let text = rig.text(jon);
        let is_listed = text.lines().any(|line| words.iter().all(|word| line.contains(word)));
        assert!(is_listed, "{words:?}: {text}");
    };
    shows(&rig, ["Jon", "lobby"]);
    rig.member("Mara", (80, 24), Speaks::Kitty);
    shows(&rig, ["Mara", "Roam in The Hall"]);
    let kim = in_lobby(&mut rig, "Kim", (80, 24));
    rig.press(kim, ENTER);
    rig.press(kim, "2");
    assert!(rig.text(kim).contains("watching Mara"), "{}", rig.text(kim));
    shows(&rig, ["Kim", "watches"]);
    for number in 0..40 {
        in_lobby(&mut rig, &format!("many{number}"), (40, 12));
    }
    let text = rig.text(jon);
    assert!(text.contains("and 3") && text.contains(" more"), "{text}");
    rig.press(kim, "\x03");
    rig.press(kim, "\x03");
    assert!(!rig.text(jon).contains("watches"), "{}", rig.text(jon));
}
