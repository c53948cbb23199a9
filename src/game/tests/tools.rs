//! Tools that are thrown or shot.

use super::*;
use crate::game::tools::Missile;
use crate::world::Supply;

#[test]
fn a_pebble_lands_six_cells_ahead_and_a_held_key_throws_once() {
    let mut stage = Stage::new(&["@.............."], "", "");
    stage.play(30, &[Intent::Throw]);
    assert_eq!(stage.game.supplies(Supply::Pebbles), 2);
    assert!(!stage.game.is_at_rest(intents(&[Intent::Throw])));
    let mut last = DVec2::ZERO;
    while !stage.game.missiles.is_empty() {
        last = stage.game.missiles.iter().next().unwrap().position;
        stage.play(1, &[]);
    }
    assert!((5.8..6.8).contains(&last.x), "{last}");
    for _ in 0..3 {
        stage.press(Intent::Throw);
    }
    assert_eq!((stage.game.supplies(Supply::Pebbles), stage.message()), (0, "No pebbles left."));
}

#[test]
fn a_strike_says_what_it_did() {
    for (thing, message) in [
        ("", "Nobody is within reach."),
        ("w = { guard = 'warden', heading = 180 }", "Only a blow from behind stuns a warden."),
        ("w = { guard = 'warden', heading = 0 }", "The warden goes down."),
    ] {
        let row = if thing.is_empty() { "@......" } else { "@w....." };
        let mut stage = Stage::new(&[row], "", thing);
        stage.play(3, &[Intent::Forward]);
        stage.press(Intent::Strike);
        assert_eq!(stage.message(), message);
    }
}

/// A corridor with a guard at its end, and a player with at least one of each tool.
fn armed(rows: &[&str], guard: &str) -> Stage {
    let mut stage = Stage::new(rows, "'+' = { door = 'oak' }", guard);
    for supply in Supply::ALL {
        stage.game.player.supplies.add(supply, 1);
    }
    stage
}

#[test]
fn a_dart_stuns_a_guard_at_the_other_end_of_a_corridor() {
    let kinds = [("warden", 300), ("hound", 1200), ("lantern", 1200)];
    for (name, steps) in kinds {
        let guard = format!("g = {{ guard = '{name}', heading = 0 }}");
        let mut stage = armed(&["@........g..#"], &guard);
        stage.press(Intent::Shoot);
        let flight = stage.steps_until(60, &[], |stage| stage.guard(0).is_down).unwrap();
        // Nine cells at 14 cells a second.
        assert!((34..=40).contains(&flight), "{name}: {flight}");
        let title = if name == "lantern" { "lantern-bearer" } else { name };
        assert_eq!(stage.message(), format!("The {title} goes down."));
        assert_eq!((stage.game.supplies(Supply::Darts), stage.game.tally().stunned), (0, 1));
        let down = stage.steps_until(1300, &[], |stage| !stage.guard(0).is_down).unwrap();
        assert!(down.abs_diff(steps) <= 2, "{name}: {down}");
        assert_eq!(stage.guard(0).mood, Mood::Searching);
        assert_eq!(stage.press(Intent::Shoot).message(), "No darts left.");
    }
}

#[test]
fn a_missed_dart_makes_a_noise_where_it_lands() {
    let rows = ["########", "#@.....#", "#####..#", "####..g#", "########"];
    let mut stage = armed(&rows, "g = { guard = 'warden', heading = 90 }");
    stage.press(Intent::Shoot);
    stage.steps_until(60, &[], |stage| stage.game.missiles.is_empty()).unwrap();
    let wonders = |stage: &Stage| stage.guard(0).mood == Mood::Wondering;
    stage.steps_until(3, &[], wonders).unwrap();
    assert_eq!(stage.game.tally().stunned, 0);
    let near = |stage: &Stage| stage.guard(0).position.distance(DVec2::new(6.5, 1.5)) < 0.6;
    stage.steps_until(300, &[], near).unwrap();
}

#[test]
fn a_dart_hits_no_guard_through_a_door_or_smoke() {
    let guard = "g = { guard = 'archer', heading = 0 }";
    let rows = ["##########", "#@..+..g.#", "##########"];
    let mut stage = armed(&rows, guard);
    stage.press(Intent::Shoot).play(60, &[]);
    assert!(!stage.guard(0).is_down && stage.game.missiles.is_empty());
    // Without a target, the dart flies straight ahead, past the guard.
    let rows = ["############", "#@.........#", "#........g.#", "############"];
    for (clouds, is_hit) in [(0, true), (1, false)] {
        let mut stage = armed(&rows, guard);
        (0..clouds).for_each(|_| stage.game.smoke.add(DVec2::new(4.5, 1.5), 0.0));
        stage.press(Intent::Shoot).play(60, &[]);
        assert_eq!(stage.guard(0).is_down, is_hit);
    }
}

#[test]
fn smoke_hides_a_player_from_a_guard_who_looks_at_them() {
    let rows = ["###########", "#@......w.#", "###########"];
    let guard = "w = { guard = 'warden', heading = 180 }";
    let alarm = |stage: &Stage| stage.game.alarm() == Alarm::Raised;
    let without = armed(&rows, guard).steps_until(480, &[], alarm);
    assert!(without.is_some());
    let mut stage = armed(&rows, guard);
    stage.press(Intent::Smoke);
    assert!(stage.steps_until(60, &[], |stage| !stage.game.smoke.is_empty()).is_some());
    assert!(stage.hears(SoundKind::Crash));
    // The noise draws the guard into the smoke, in which they see nobody.
    let in_smoke = |stage: &Stage| {
        let cloud = stage.game.smoke.clouds[0];
        cloud.position.distance(stage.guard(0).position) < cloud.radius
    };
    stage.steps_until(300, &[], in_smoke).unwrap();
    assert_eq!(stage.game.tally().alarms, 0);
    let clears = |stage: &Stage| stage.game.smoke.is_empty();
    stage.steps_until(480, &[], clears).unwrap();
    assert_eq!((stage.game.tally().alarms, stage.points()), (0, 6));
}

#[test]
fn a_guard_loses_a_player_in_smoke() {
    let rows = [
        "################",
        "#..............#",
        "#.####.#######.#",
        "#.####@......w.#",
        "################",
    ];
    let guard = "w = { guard = 'warden', heading = 180 }";
    let mut stage = armed(&rows, guard);
    stage.steps_until(600, &[], |stage| stage.guard(0).mood == Mood::Chasing).unwrap();
    stage.press(Intent::Smoke);
    stage.steps_until(60, &[], |stage| !stage.game.smoke.is_empty()).unwrap();
    // The player goes behind the smoke, out of the corridor and around two corners.
    stage.play(50, &[Intent::StrafeLeft]).play(115, &[Intent::Back]);
    let searches = |stage: &Stage| stage.guard(0).mood == Mood::Searching;
    stage.steps_until(480, &[Intent::StrafeRight], searches).unwrap();
    assert_eq!((stage.points(), stage.game.tally().alarms), (6, 1));
}

#[test]
fn a_pebble_lures_a_guard_through_a_shut_door_but_not_a_hound() {
    // The player stands in a niche that is not visible from behind the door.
    let rows = ["##############", "#.....+g.....#", "#@############", "##############"];
    for (name, comes) in [("warden", true), ("archer", true), ("hound", false)] {
        let mut stage = armed(&rows, &format!("g = {{ guard = '{name}', heading = 0 }}"));
        stage.game.missiles.launch(Missile::pebble((DVec2::new(1.5, 1.5), 0.5), DVec2::X));
        stage.steps_until(60, &[], |stage| stage.game.missiles.is_empty()).unwrap();
        let wonders = |stage: &Stage| stage.guard(0).mood == Mood::Wondering;
        stage.steps_until(3, &[], wonders).unwrap_or_else(|| panic!("{name}"));
        let passes = |stage: &Stage| stage.guard(0).position.x < 6.0;
        assert_eq!(stage.steps_until(500, &[], passes).is_some(), comes, "{name}");
    }
}

#[test]
fn a_push_makes_a_guard_stagger_back_and_lose_the_blow() {
    for (name, behind) in [("warden", '.'), ("lantern", '.'), ("warden", 'v')] {
        let row = format!("#@.g{behind}....#");
        let rows = ["##########", &row, "##########"];
        let guard = format!("g = {{ guard = '{name}', heading = 180 }}");
        let mut stage = Stage::new(&rows, "v = { floor_height = -3 }", &guard);
        stage.steps_until(900, &[], |stage| stage.hears(SoundKind::Windup)).unwrap();
        stage.play(6, &[Intent::Forward]);
        assert_eq!(stage.guard(0).mood, Mood::Attacking, "{name}");
        let before = stage.guard(0).position.x;
        stage.press(Intent::Strike);
        assert_eq!(stage.guard(0).mood, Mood::Chasing, "{name}: {}", stage.message());
        stage.play(28, &[]);
        let moved = stage.guard(0).position.x - before;
        if behind == '.' {
            assert!((0.5..2.5).contains(&moved), "{name}: {moved}");
        }
        // No guard is pushed over an edge.
        assert_eq!((stage.guard(0).feet, stage.points()), (0.0, 6), "{name}");
        assert_eq!(stage.game.tally().stunned, 0);
    }
}

#[test]
fn a_push_wakes_a_sleeping_guard_unless_it_stuns() {
    for (name, degrees, is_down) in
        [("warden", 180, false), ("warden", 0, true), ("archer", 180, true)]
    {
        let guard = format!("g = {{ guard = '{name}', heading = {degrees}, asleep = true }}");
        let mut stage = Stage::new(&["####", "#@g#", "####"], "", &guard);
        stage.play(4, &[Intent::Forward]).press(Intent::Strike);
        assert_eq!(stage.guard(0).is_down, is_down, "{name} {degrees}");
        if !is_down {
            assert_eq!(stage.guard(0).mood, Mood::Wondering, "{name}");
        }
    }
}
