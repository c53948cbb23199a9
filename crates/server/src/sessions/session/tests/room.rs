//! Members of one room see each other, talk, and play rounds.

use super::*;
use crate::sessions::session::pages::Page;

/// A room with two members, Mara and then Jon.
fn two(mode: Mode) -> (Rig, usize, usize) {
    let mut rig = Rig::new(mode);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let other = rig.member("Jon", (80, 24), Speaks::Plain);
    (rig, one, other)
}

#[test]
fn members_see_each_other_walk_with_names() {
    let (mut rig, one, other) = two(Mode::Roam);
    for _ in 0..12 {
        rig.press(other, "w");
    }
    rig.press(other, "b");
    assert!(rig.text(one).contains("Jon"), "{}", rig.text(one));
    assert!(rig.text(other).contains("Mara"), "{}", rig.text(other));
    let column = |rig: &Rig| {
        let text = rig.text(one);
        text.lines().skip(1).find_map(|line| line.split(" Jon").next()?.len().into())
    };
    let before = (rig.text(one), column(&rig));
    for _ in 0..4 {
        rig.press(other, "d");
    }
    assert_ne!(rig.text(one), before.0, "the figure has moved");
}

#[test]
fn chat_reaches_the_others_as_plain_text() {
    let (mut rig, one, other) = two(Mode::Roam);
    rig.press(one, "\r");
    assert_eq!(rig.page(one), Page::Chat);
    let before = rig.position(one);
    rig.press(one, "wwww \x1b]0;evil\x07\x1b[2Jhi\u{9b}31m\u{20dd} \u{202e}there!");
    assert_eq!(rig.position(one), before, "keys are typed, and walk nowhere");
    rig.press(one, "\r");
    assert!(rig.text(other).contains("Mara wwww hi31m there!"), "{}", rig.text(other));
    assert_eq!(rig.clients[other].look(|emulator| emulator.title().to_owned()), "");
    rig.pump(8_500);
    assert!(!rig.text(other).contains("wwww"), "{}", rig.text(other));
    rig.press(other, ";");
    rig.press(one, "/still there?\r");
    assert!(!rig.text(other).contains("still there?"));
    assert!(rig.text(one).contains("still there?"));
}

#[test]
fn emotes_and_members_are_shown() {
    let (mut rig, one, other) = two(Mode::Roam);
    rig.press(one, "1");
    assert!(rig.text(one).contains("calls for help"), "{}", rig.text(one));
    rig.press(one, "4");
    assert!(rig.text(other).contains("Mara (laughs)"), "{}", rig.text(other));
    rig.press(other, "\t");
    let text = rig.text(other);
    assert!(
        text.contains("Roam 2/16") && text.contains("Mara") && text.contains("points"),
        "{text}"
    );
    rig.press(other, "\t");
    assert!(!rig.text(other).contains("Roam 2/16"));
}

#[test]
fn a_round_of_tag_is_announced_and_ends_with_standings() {
    let (mut rig, one, other) = two(Mode::Tag);
    rig.pump(2_000);
    rig.pump(4_000);
    let texts = [rig.text(one), rig.text(other)];
    let is_it = |text: &&String| text.contains("you are it");
    assert_eq!(texts.iter().filter(is_it).count(), 1, "{texts:?}");
    assert!(texts.iter().all(|text| text.contains("Tag 2:5")), "{texts:?}");
    rig.pump(180_000);
    let text = rig.text(one);
    assert!(text.contains("the round is over") && text.contains("+1"), "{text}");
    rig.pump(11_000);
    assert!(rig.text(one).contains("Tag 0:0") || rig.text(one).contains("Tag 2:5"));
}

#[test]
fn seekers_see_nothing_while_the_others_hide() {
    let (mut rig, one, other) = two(Mode::Hide);
    rig.pump(4_000);
    let texts = [rig.text(one), rig.text(other)];
    let sees_nothing = |text: &&String| text.contains("You can see again in 0:1");
    assert_eq!(texts.iter().filter(sees_nothing).count(), 1, "{texts:?}");
    let dark = texts.iter().find(sees_nothing).unwrap();
    assert!(!dark.contains("map") && !dark.contains('%'), "{dark}");
    rig.pump(18_000);
    assert!(
        !rig.text(one).contains("You can see again")
            && !rig.text(other).contains("You can see again")
    );
}

#[test]
fn taps_and_held_keys_walk_as_far_as_at_home() {
    // A tap walks a quarter of a cell. A key that repeats walks on until it stops.
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let start = rig.position(one).x;
    rig.press(one, "w");
    let tapped = rig.position(one).x - start;
    assert!((0.15..0.4).contains(&tapped), "{tapped}");
    rig.send(one, "w");
    rig.pump(400);
    for _ in 0..30 {
        rig.send(one, "w");
        rig.pump(33);
    }
    let held = rig.position(one).x;
    rig.pump(1_000);
    let after = rig.position(one).x;
    assert!(held > start + 2.5 && after - held < 1.0, "{held} {after}");
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Kitty);
    let start = rig.position(one).x;
    rig.send(one, "\x1b[119;1:1u");
    rig.pump(1_000);
    rig.send(one, "\x1b[119;1:3u");
    rig.pump(1_000);
    let walked = rig.position(one).x;
    assert!(walked > start + 2.0);
    rig.pump(2_000);
    assert_eq!(rig.position(one).x, walked);
}

#[test]
fn each_tap_of_an_action_counts_once() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let heading = |rig: &Rig| {
        let view = rig.view();
        let player = view.members[0].player.unwrap();
        view.game.seen_by(player).unwrap().camera(FieldOfView::default()).heading.degrees()
    };
    let before = heading(&rig);
    for _ in 0..3 {
        rig.send(one, "o");
        rig.pump(700);
    }
    let turned = (heading(&rig) - before).rem_euclid(360.0);
    assert!((turned - 15.0).abs() < 1e-6, "{turned}");
}

#[test]
fn a_removed_member_is_told_why() {
    let (mut rig, one, _) = two(Mode::Roam);
    rig.visitors.say("be quiet");
    rig.clients[one].drain();
    rig.pump(200);
    let text = rig.text(one);
    assert!(text.contains(": be quiet"), "{text}");
    assert!(text.contains("The server ends in 10 seconds."), "{text}");
    rig.rooms().close(ROOM, "The room is closed.");
    rig.pump(200);
    assert!(rig.text(one).contains("The room is closed."), "{}", rig.text(one));
    rig.pump(11_000);
    assert!(rig.text(one).contains("The server has ended."), "{}", rig.text(one));
    assert!(rig.is_over(one));
}

/// This holds in the lobby as well as in a room.
#[test]
fn the_seconds_until_shutdown_are_counted_down() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let other = rig.visitor("Jon", (80, 24), Speaks::Plain);
    rig.press(other, ENTER);
    for client in [one, other] {
        rig.clients[client].drain();
    }
    rig.pump(200);
    for seconds in (2..=10).rev() {
        for client in [one, other] {
            let text = rig.text(client);
            assert!(text.contains(&format!("The server ends in {seconds} seconds.")), "{text}");
        }
        rig.pump(1_000);
    }
    assert!(rig.text(one).contains("The server ends in 1 second."), "{}", rig.text(one));
    assert!(!rig.is_over(one));
    rig.pump(2_000);
    assert!(rig.is_over(one) && rig.is_over(other));
    assert!(rig.text(one).contains("The server has ended."), "{}", rig.text(one));
}

#[test]
fn dead_players_go_on_or_start_again() {
    let spikes = HALL
        .replace("@............", "@^^^^^^^^^^^^")
        .replace("[things]", "[things]\n\"^\" = { spikes = 1.0 }");
    for (mode, effect) in [(Mode::Together, "Enter goes on"), (Mode::Alone, "Enter begins again")] {
        let mut rig =
            Rig::with(RigOptions { catalog: catalog(&spikes), ..RigOptions::new(Mode::Together) });
        let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
        let way: &[&str] = match mode {
            // Single-player mode, in the first level.
            Mode::Alone => &[ENTER, "4", ENTER, ENTER],
            _ => &[ENTER, ENTER, ENTER],
        };
        for key in way {
            rig.press(one, key);
        }
        assert_eq!(rig.page(one), Page::Room, "{}", rig.text(one));
        for _ in 0..40 {
            if !rig.text(one).contains(effect) {
                rig.press(one, "w");
            }
        }
        assert!(rig.text(one).contains(effect), "{}", rig.text(one));
        // The key for walking may still count as held.
        rig.press(one, ENTER);
        assert!(rig.text(one).contains(effect), "{}", rig.text(one));
        rig.pump(1000);
        rig.press(one, ENTER);
        rig.pump(500);
        assert!(!rig.text(one).contains(effect), "{}", rig.text(one));
        assert!(rig.position(one).x < 2.5);
        assert_eq!(rig.page(one), Page::Room);
    }
}

#[test]
fn capitals_and_symbols_can_be_typed_in_both_protocols() {
    for (speaks, typed) in [
        (Speaks::Plain, "Hi! \u{e9}\u{e4}"),
        (Speaks::Kitty, "\x1b[104:72;2u\x1b[105u\x1b[49:33;2u\x1b[32u\x1b[233u\x1b[228u"),
    ] {
        let mut rig = Rig::new(Mode::Roam);
        let one = rig.member("Mara", (80, 24), speaks);
        let (enter, slash) = match speaks {
            Speaks::Kitty => ("\x1b[13u", "\x1b[47u"),
            _ => ("\r", "/"),
        };
        rig.press(one, slash);
        rig.press(one, typed);
        rig.press(one, enter);
        let said = rig.view().said.last().unwrap().text.clone();
        assert_eq!(said, "Hi! \u{e9}\u{e4}", "{speaks:?}");
    }
}

#[test]
fn a_finisher_sees_place_and_time_and_watches_the_others() {
    let map = HALL
        .replace("............>#", ".............#")
        .replace("@............#", "@.......>....#");
    let mut rig = Rig::with(RigOptions { catalog: catalog(&map), ..RigOptions::new(Mode::Race) });
    let names = ["Mara", "Jon", "Kim"];
    let [one, other, third] = names.map(|name| rig.member(name, (100, 24), Speaks::Kitty));
    let watcher = rig.visitor("Ada", (100, 24), Speaks::Kitty);
    for key in [ENTER, ENTER, "2"] {
        rig.press(watcher, key);
    }
    rig.pump(3_000);
    assert!(rig.text(other).contains("of 3 . be first at the exit"), "{}", rig.text(other));
    rig.send(one, "\x1b[119;1:1u");
    rig.pump(4_000);
    rig.send(one, "\x1b[119;1:3u");
    for index in [one, other, watcher] {
        let text = rig.text(index);
        assert!(text.contains("1st: Mara 0:0"), "{text}");
    }
    let text = rig.text(one);
    assert!(text.contains("1st, 0:0") && text.contains("watching Jon"), "{text}");
    let text = rig.text(other);
    assert!(text.contains("the race ends in 0:5"), "{text}");
    assert!(rig.text(watcher).contains("Race 0:5"), "{}", rig.text(watcher));
    rig.press(one, "\x1b[9u");
    assert!(rig.text(one).contains("watching Kim"), "{}", rig.text(one));
    // A member who has finished cannot be watched.
    rig.press(one, "\x1b[9u");
    assert!(rig.text(one).contains("watching Jon"), "{}", rig.text(one));
    rig.send(other, "\x1b[119;1:1u");
    rig.pump(4_000);
    let text = rig.text(one);
    assert!(text.contains("2nd: Jon 0:") && text.contains("watching Kim"), "{text}");
    rig.pump(54_000);
    for index in [one, other, third, watcher] {
        let text = rig.text(index);
        assert_eq!(text.matches("no time").count(), 1, "{text}");
        assert!(!text.contains("0:00.0"), "{text}");
    }
}

#[test]
fn racers_are_told_their_places() {
    let mut rig = Rig::new(Mode::Race);
    let [one, other] = ["Mara", "Jon"].map(|name| rig.member(name, (80, 24), Speaks::Kitty));
    rig.pump(3_000);
    assert!(rig.text(one).contains("2nd of 2"), "Jon begins ahead: {}", rig.text(one));
    // The exit is far ahead on the right.
    rig.send(one, "\x1b[100;1:1u");
    rig.pump(1_200);
    assert!(rig.text(one).contains("1st of 2"), "{}", rig.text(one));
    assert!(rig.text(other).contains("2nd of 2"), "{}", rig.text(other));
}

#[test]
fn members_see_each_other_on_arrival() {
    let (rig, one, other) = two(Mode::Roam);
    assert!(rig.position(one).distance(rig.position(other)) >= 1.0);
    // Once in the chat line that announces him, and once above his head.
    assert_eq!(rig.text(one).matches("Jon").count(), 2, "{}", rig.text(one));
}

#[test]
fn the_map_covers_at_most_a_fifth_of_a_narrow_window() {
    let catalog = crate::rooms::room::Catalog::builtin();
    let mut rig = Rig::with(RigOptions { catalog, level: "museum", ..RigOptions::new(Mode::Roam) });
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let text = rig.text(one);
    let (_, frame) = text.lines().next().and_then(|row| row.split_once("+map")).expect(&text);
    assert!((13..=16).contains(&(frame.len() + 4)), "{text}");
}
