//! What a session has as a game at home does: the mouse, the bell, presets of keys.

use super::*;
use crate::game::Outcome;
use crate::server::session::page::Page;
use crate::terminal::Fidelity;
use crate::world::FieldOfView;

fn heading(rig: &Rig) -> f64 {
    let view = rig.room.view();
    let player = view.members[0].player.unwrap();
    view.game.seen_by(player).unwrap().camera(FieldOfView::default()).heading.degrees()
}

/// Moves the pointer to a column of the tenth row.
fn point(rig: &mut Rig, index: usize, column: u16) {
    rig.send(index, &format!("\x1b[<35;{column};10M"));
    rig.pump(100);
}

#[test]
fn the_mouse_turns_by_two_degrees_a_cell() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let before = heading(&rig);
    point(&mut rig, one, 30);
    point(&mut rig, one, 40);
    assert_eq!(heading(&rig), before, "the mouse is off");
    rig.press(one, "v");
    assert_ne!(rig.visitors[one].emulator.modes().mouse.0, vt100::MouseProtocolMode::None);
    assert!(rig.text(one).contains("mouse"), "{}", rig.text(one));
    for column in [30, 40, 50] {
        point(&mut rig, one, column);
    }
    let turned = (heading(&rig) - before).rem_euclid(360.0);
    assert!((turned - 40.0).abs() < 1e-6, "{turned}");
    rig.pump(2_000);
    assert!((heading(&rig) - before - turned).abs() < 1e-6, "a hand that rests turns nobody");
    rig.press(one, "p");
    point(&mut rig, one, 20);
    rig.press(one, ESCAPE);
    assert!((heading(&rig) - before - turned).abs() < 1e-6, "in a menu it turns nobody");
    rig.press(one, "v");
    assert_eq!(rig.visitors[one].emulator.modes().mouse.0, vt100::MouseProtocolMode::None);
}

#[test]
fn at_the_edge_of_the_window_the_mouse_turns_once_around() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    rig.press(one, "v");
    point(&mut rig, one, 70);
    let before = heading(&rig);
    point(&mut rig, one, 80);
    rig.pump(1_000);
    let second = (heading(&rig) - before).rem_euclid(360.0);
    assert!((90.0..150.0).contains(&second), "{second}");
    rig.pump(6_000);
    let after = heading(&rig);
    rig.pump(1_000);
    assert_eq!(heading(&rig), after);
    let pictures = rig.visitors[one].pictures;
    rig.pump(1_000);
    assert_eq!(rig.visitors[one].pictures, pictures);
}

#[test]
fn a_run_that_the_mouse_has_steered_is_recorded_with_its_turns() {
    let mut rig = Rig::new(Mode::Alone);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.press(one, ENTER);
    let (news, now) = (rig.join(one), rig.now);
    rig.visitors[one].session.tell(news, now);
    rig.press(one, "v");
    point(&mut rig, one, 30);
    rig.send(one, "\x1b[<35;40;10M");
    let mut turned = 0;
    for _ in 0..20 {
        rig.pump(16);
        let (_, _, intents) = rig.room.first_member().unwrap();
        turned += i32::from(intents.look().turn);
    }
    assert_eq!(turned, 2_000);
}

#[test]
fn the_bell_rings_for_those_who_want_it_when_they_are_hurt() {
    let spikes = HALL
        .replace("@............", "@^^^^^^^^^^^^")
        .replace("[things]", "[things]\n\"^\" = { spikes = 1.0 }");
    let rings = [false, true].map(|bell| {
        let mut rig = Rig::new(Mode::Together);
        let mut catalog = Catalog::default();
        catalog.add("hall", map::parse(&spikes, "hall", &map::NoFiles).unwrap());
        rig.catalog = Arc::new(catalog);
        let header = Header::new("hall", Mode::Together, Difficulty::Normal, 7);
        rig.room = Room::new(&rig.catalog, header).unwrap();
        let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
        rig.visitors[one].session.visit.identity.preferences.bell = bell;
        rig.press(one, ENTER);
        let (news, now) = (rig.join(one), rig.now);
        rig.visitors[one].session.tell(news, now);
        rig.pump(500);
        let before = rig.visitors[one].bells;
        assert_eq!(before, 0);
        (0..40).for_each(|_| rig.press(one, "w"));
        let view = rig.room.view();
        let player = view.game.seen_by(view.members[0].player.unwrap()).unwrap();
        assert!(matches!(player.outcome(), Outcome::Dead { .. }));
        rig.visitors[one].bells
    });
    assert_eq!(rings[0], 0);
    assert!((1..=3).contains(&rings[1]), "{rings:?}");
}

#[test]
fn a_preset_of_keys_is_chosen_and_kept() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let start = rig.position(one);
    rig.press(one, "z");
    assert_eq!(rig.position(one), start);
    rig.press(one, "p");
    rig.press(one, "3");
    assert_eq!(rig.page(one), Page::Settings);
    assert!(rig.text(one).contains("qwerty"), "{}", rig.text(one));
    rig.press(one, "2");
    assert!(rig.text(one).contains("azerty"), "{}", rig.text(one));
    let saved = rig.visitors[one].saved.clone().unwrap();
    let kept = Configuration::parse(&saved.configuration, "it").unwrap();
    assert_eq!(kept.preset(), "azerty");
    rig.press(one, "3");
    let saved = rig.visitors[one].saved.clone().unwrap();
    assert!(Configuration::parse(&saved.configuration, "it").unwrap().mouse);
    rig.press(one, ESCAPE);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::Room);
    rig.press(one, "z");
    assert!(rig.position(one).x > start.x + 0.1);
}

#[test]
fn a_notice_about_the_key_stands_in_the_lobby() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.visitors[one].session.visit.host.notice = Line::of("An RSA key is not an account.", 60);
    rig.press(one, ENTER);
    let text = rig.text(one);
    assert!(text.contains("An RSA key is not an account.") && text.contains("Be kind."), "{text}");
}

#[test]
fn compression_is_advised_only_where_it_would_help() {
    for (compresses, is_limited, advises) in [
        (false, None, true),
        (false, Some(false), false),
        (false, Some(true), true),
        (true, None, false),
        (true, Some(true), false),
    ] {
        let mut rig = Rig::new(Mode::Roam);
        let one = rig.visitor_with("Mara", (80, 24), Speaks::Kitty, ColorDepth::True);
        rig.visitors[one].latency = Duration::from_millis(60);
        rig.visitors[one].session.visit.host.compresses = compresses;
        rig.visitors[one].session.is_limited = is_limited;
        rig.press(one, "x");
        rig.press(one, ENTER);
        let text = rig.text(one);
        assert_eq!(text.contains("ssh -C"), advises, "{compresses} {is_limited:?}: {text}");
    }
}

#[test]
fn only_ascii_is_sent_until_half_blocks_are_chosen() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor_with("Mara", (80, 24), Speaks::Plain, ColorDepth::Mono);
    for _ in 0..3 {
        rig.press(one, ENTER);
    }
    assert!(rig.text(one).is_ascii(), "{}", rig.text(one));
    rig.press(one, "p");
    rig.press(one, "3");
    rig.press(one, "8");
    rig.press(one, "8");
    rig.press(one, ESCAPE);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::Room);
    assert!(rig.text(one).contains(['▀', '▄', '█']), "{}", rig.text(one));
}

#[test]
fn frames_begin_exact_where_the_connection_compresses() {
    let first = |fidelity| {
        let options = Options {
            fidelity,
            is_remote: true,
            ..Options::from_environment(|name| (name == "TERM").then(|| "xterm".to_owned()))
        };
        Protocol::new(options, WindowSize::of_cells(80, 24)).fidelity()
    };
    assert_eq!(first(Some(Fidelity::EXACT)), Fidelity::EXACT);
    assert_eq!(first(None), Fidelity::LOW);
}
