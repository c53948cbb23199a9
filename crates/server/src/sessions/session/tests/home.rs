//! Features that a session shares with a game at home: the mouse, the bell and key presets.

use std::sync::Arc;
use std::time::Duration;

use super::*;
use crate::accounts::AccountKey;
use crate::line::Line;
use crate::rooms::room::{Room, parse_log};
use crate::rooms::summary::RoomId;
use crate::sessions::session::pages::Page;
use crate::simulation::guest;
use crate::ssh::Visitor;
use cellcaster::color::palette::ColorDepth;
use cellcaster::game::Outcome;
use cellcaster::terminal::Fidelity;

/// The public key of an account.
fn key() -> AccountKey {
    AccountKey::new([7; 32])
}

/// The keys that lead from the name page to the first level in single-player mode.
const ALONE: [&str; 4] = [ENTER, "4", ENTER, ENTER];

fn heading(rig: &Rig) -> f64 {
    let view = rig.view();
    let player = view.members[0].player.unwrap();
    view.game.seen_by(player).unwrap().camera(FieldOfView::default()).heading.degrees()
}

/// The mouse mode of the visitor's terminal.
fn mouse(rig: &Rig, index: usize) -> vt100::MouseProtocolMode {
    rig.clients[index].look(|emulator| emulator.modes().mouse.0)
}

/// The number of times that the bell has rung.
fn bells(rig: &Rig, index: usize) -> usize {
    rig.clients[index].look(|emulator| emulator.bytes().split(|&it| it == 0x07).count() - 1)
}

/// Moves the pointer to a column in the tenth row.
fn point(rig: &mut Rig, index: usize, column: u16) {
    rig.send(index, format!("\x1b[<35;{column};10M"));
    rig.pump(100);
}

#[test]
fn the_mouse_turns_the_view_two_degrees_per_cell() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.member("Mara", (80, 24), Speaks::Plain);
    let before = heading(&rig);
    point(&mut rig, one, 30);
    point(&mut rig, one, 40);
    assert_eq!(heading(&rig), before, "the mouse is off");
    rig.press(one, "v");
    assert_ne!(mouse(&rig, one), vt100::MouseProtocolMode::None);
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
    assert_eq!(mouse(&rig, one), vt100::MouseProtocolMode::None);
}

#[test]
fn at_the_window_edge_the_mouse_makes_one_turn() {
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
    let pictures = rig.clients[one].frames();
    rig.pump(1_000);
    assert_eq!(rig.clients[one].frames(), pictures);
}

#[test]
fn a_run_steered_by_mouse_is_recorded_with_its_turns() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    for key in ALONE {
        rig.press(one, key);
    }
    rig.press(one, "v");
    point(&mut rig, one, 30);
    point(&mut rig, one, 40);
    rig.pump(300);
    let text = rig.logs.text(RoomId(ROOM.0 + 1));
    let rounds = parse_log(&text).unwrap();
    let (header, entries) = &rounds[0];
    let mut room = Room::new(&Arc::new(catalog(HALL)), header.clone()).unwrap();
    let mut turned = 0;
    for step in 0..=entries[entries.len() - 1].step {
        entries.iter().filter(|entry| entry.step == step).for_each(|entry| room.apply(entry));
        room.advance();
        turned += room.first_member().map_or(0, |(.., intents)| i32::from(intents.look().turn));
    }
    assert_eq!(turned, 2_000, "{text}");
}

#[test]
fn the_bell_rings_for_hurt_players_who_enabled_it() {
    let spikes = HALL
        .replace("@............", "@^^^^^^^^^^^^")
        .replace("[things]", "[things]\n\"^\" = { spikes = 1.0 }");
    let rings = [false, true].map(|bell| {
        let mut rig =
            Rig::with(RigOptions { catalog: catalog(&spikes), ..RigOptions::new(Mode::Together) });
        let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
        rig.session(one, move |session, _| session.ui.identity.preferences.bell = bell);
        for _ in 0..3 {
            rig.press(one, ENTER);
        }
        assert_eq!(bells(&rig, one), 0);
        (0..40).for_each(|_| rig.press(one, "w"));
        let view = rig.view();
        let player = view.game.seen_by(view.members[0].player.unwrap()).unwrap();
        assert!(matches!(player.outcome(), Outcome::Dead { .. }));
        bells(&rig, one)
    });
    assert_eq!(rings[0], 0);
    assert!((1..=3).contains(&rings[1]), "{rings:?}");
}

#[test]
fn a_key_preset_can_be_chosen_and_is_stored() {
    let mut rig = Rig::new(Mode::Roam);
    let mara = Visitor { key: Some(key()), ..guest("Mara", (80, 24)) };
    let one = rig.connect(mara.clone(), Speaks::Plain, ColorDepth::Mono);
    rig.pump(300);
    for _ in 0..3 {
        rig.press(one, ENTER);
    }
    let start = rig.position(one);
    rig.press(one, "z");
    assert_eq!(rig.position(one), start);
    rig.press(one, "p");
    rig.press(one, "3");
    assert_eq!(rig.page(one), Page::Settings);
    assert!(rig.text(one).contains("qwerty"), "{}", rig.text(one));
    rig.press(one, "2");
    assert!(rig.text(one).contains("azerty"), "{}", rig.text(one));
    rig.press(one, "3");
    rig.press(one, ESCAPE);
    rig.press(one, ESCAPE);
    assert_eq!(rig.page(one), Page::Room);
    rig.press(one, "z");
    assert!(rig.position(one).x > start.x + 0.1);
    let again = rig.connect(mara, Speaks::Plain, ColorDepth::Mono);
    rig.pump(300);
    let kept = rig.session(again, |session, _| session.ui.identity.configuration.clone());
    assert!(kept.to_string().contains("preset = \"azerty\"") && kept.mouse, "{kept}");
}

#[test]
fn a_notice_about_the_key_appears_in_the_lobby() {
    let mut rig = Rig::new(Mode::Roam);
    let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
    rig.session(one, |session, _| {
        session.ui.host.notice = Line::of("An RSA key is not an account.", 60);
    });
    rig.press(one, ENTER);
    let text = rig.text(one);
    assert!(text.contains("An RSA key is not an account.") && text.contains("Be kind."), "{text}");
}

#[test]
fn compression_is_advised_only_if_it_would_help() {
    for (compresses, is_limited, advises) in [
        (false, None, true),
        (false, Some(false), false),
        (false, Some(true), true),
        (true, None, false),
        (true, Some(true), false),
    ] {
        let mut rig = Rig::new(Mode::Roam);
        let one = rig.visitor_with("Mara", (80, 24), Speaks::Kitty, ColorDepth::True);
        rig.clients[one].set(|link| link.latency = Duration::from_millis(60));
        rig.session(one, move |session, _| {
            session.ui.host.compresses = compresses;
            session.is_limited = is_limited;
        });
        rig.press(one, "Xenia");
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
fn frames_start_exact_on_compressed_connections() {
    let first = |fidelity| {
        let options = SessionOptions {
            fidelity,
            is_remote: true,
            ..SessionOptions::from_environment(|name| (name == "TERM").then(|| "xterm".to_owned()))
        };
        Protocol::new(options, WindowSize::of_cells(80, 24)).fidelity()
    };
    assert_eq!(first(Some(Fidelity::EXACT)), Fidelity::EXACT);
    assert_eq!(first(None), Fidelity::LOW);
}

#[test]
fn the_bell_rings_when_a_race_begins() {
    let rings = [false, true].map(|bell| {
        let mut rig = Rig::new(Mode::Race);
        let one = rig.visitor("Mara", (80, 24), Speaks::Plain);
        rig.session(one, move |session, _| session.ui.identity.preferences.bell = bell);
        for _ in 0..3 {
            rig.press(one, ENTER);
        }
        assert_eq!(bells(&rig, one), 0);
        rig.pump(5_000);
        bells(&rig, one)
    });
    assert_eq!(rings, [0, 1]);
}
