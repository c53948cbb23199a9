//! What guards hear, and what they tell each other.

use super::*;

const GUARDS: &str = r#"
"W" = { guard = "warden", heading = 180 }
"A" = { guard = "archer", heading = 180 }
"L" = { guard = "listener", heading = 180 }
"S" = { guard = "warden", heading = 180, asleep = true }
"#;

/// A guard behind a wall with a doorway, or a door.
fn rooms(guard: char, doorway: char) -> Scene {
    let rows = [
        "###########".to_owned(),
        format!("#.@..#..{guard}.#"),
        format!("#....{doorway}....#"),
        "#....#....#".to_owned(),
        "###########".to_owned(),
    ];
    Scene::new(&rows.join("\n"), &used(&rows))
}

/// The definitions of the guards that are drawn.
fn used(rows: &[String]) -> String {
    let is_used = |line: &&str| {
        let name = line.chars().nth(1);
        name.is_some_and(|name| rows.iter().any(|row| row.contains(name)))
    };
    GUARDS.lines().filter(is_used).collect::<Vec<_>>().join("\n")
}

#[test]
fn a_noise_is_heard_through_a_doorway_and_not_through_a_wall() {
    for (doorway, is_heard) in [('.', true), ('#', false), ('+', false)] {
        let mut scene = rooms('W', doorway);
        let knock = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 8) };
        scene.step(&[knock]);
        assert_eq!(scene.mood(0) == Mood::Wondering, is_heard, "{doorway}");
        assert_eq!(scene.has_sounded(SoundKind::Wonder), is_heard);
    }
}

#[test]
fn a_guard_turns_to_a_noise_first_and_then_goes_there_and_comes_back() {
    let mut scene = rooms('W', '.');
    scene.target.is_alive = false;
    let at_first = scene.guard(0).position;
    let noise = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 8) };
    scene.step(&[noise]);
    let has_left = |scene: &Scene| scene.guard(0).position.distance(at_first) > 0.2;
    let turning = scene.steps_until(200, has_left).unwrap();
    assert!(turning >= 40, "{turning}");
    let place = noise.cell.center();
    scene.steps_until(600, |scene| scene.guard(0).position.distance(place) < 0.5).unwrap();
    scene.steps_until(900, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert_eq!(scene.mood(0), Mood::Returning);
    scene.steps_until(900, |scene| scene.guard(0).position.distance(at_first) < 0.35).unwrap();
    let heading = |scene: &Scene| (degrees(scene.guard(0).heading) - 180.0).abs() < 1.0;
    scene.steps_until(900, heading).unwrap();
    assert_eq!(scene.guards.alarm(), Alarm::Calm);
}

#[test]
fn sleepers_are_woken_by_noise_nearby_only_and_rest_until_then() {
    let mut scene = rooms('S', '.');
    scene.target.is_alive = false;
    scene.steps_until(5, |scene| scene.guards.quiet_steps().is_none()).unwrap();
    scene.step(&[scene.sound(SoundKind::Running, 7)]);
    assert_eq!(scene.mood(0), Mood::Asleep);
    scene.put(7.5, 3.5);
    scene.step(&[scene.sound(SoundKind::Running, 7)]);
    assert_eq!(scene.mood(0), Mood::Wondering);
}

#[test]
fn a_listener_follows_steps_and_not_silence() {
    let mut scene = rooms('L', '.');
    scene.put(4.5, 2.5);
    for _ in 0..300 {
        scene.step(&[]);
    }
    assert_eq!(scene.mood(0), Mood::OnDuty);
    let mut steps = 0;
    while !scene.is_alarmed() {
        let sounds = [scene.sound(SoundKind::Running, 7)];
        scene.step(if steps % 14 == 0 { &sounds } else { &[] });
        steps += 1;
        assert!(steps < 120);
    }
    let place = scene.target.position;
    scene.put(1.5, 1.5);
    scene.steps_until(300, |scene| scene.guard(0).position.distance(place) < 0.5).unwrap();
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
}

#[test]
fn a_shout_brings_those_who_hear_it_but_not_on_easy() {
    for (difficulty, comes) in [(Difficulty::Easy, false), (Difficulty::Normal, true)] {
        let mut scene = Scene::with_rules(
            "#############\n#@...A.#...W#\n#......#....#\n#...........#\n#############",
            "\"A\" = { guard = \"archer\", heading = 180 }\n\"W\" = { guard = \"warden\", heading = 0 }",
            on(difficulty),
        );
        scene.steps_until(300, Scene::is_alarmed).unwrap();
        scene.step(&[]);
        assert_eq!(scene.mood(1) == Mood::Wondering, comes, "{difficulty:?}");
        if comes {
            let place = scene.target.position;
            scene.steps_until(600, |scene| scene.guard(1).position.distance(place) < 5.0).unwrap();
        }
    }
}

#[test]
fn what_a_player_hears_of_guards_is_weaker_behind_doors() {
    use crate::game::sound::Hearing;
    for (doorway, strength) in [('.', Some(1)), ('+', None), ('#', None)] {
        let scene = rooms('W', doorway);
        let mut hearing = Hearing::default();
        let sound =
            Sound { kind: SoundKind::Shout, cell: cell(8, 1), reach: 9, by: Source::Guard(0) };
        let changed = hearing.step(&scene.world, 0, scene.target.position, &[sound]);
        assert_eq!(changed, strength.is_some());
        assert_eq!(hearing.heard().first().map(|heard| heard.strength), strength);
        if let Some(heard) = hearing.heard().first() {
            assert_eq!(heard.bearing.degrees(), 0.0);
            let quiet = hearing.quiet_steps().unwrap();
            hearing.wait(quiet);
            assert_eq!(hearing.heard().len(), 1);
            assert!(hearing.step(&scene.world, 0, scene.target.position, &[]));
            assert!(hearing.heard().is_empty() && hearing.quiet_steps().is_none());
        }
    }
}
