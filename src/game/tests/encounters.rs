//! Encounters between guards and the player: bodies, blows, bolts, doors and floors that move.

use super::*;
use crate::game::tools::{Missile, MissileKind};
use crate::world::Difficulty;

const KINDS: [&str; 5] = ["warden", "listener", "lantern", "hound", "archer"];

fn has_bolt(stage: &Stage) -> bool {
    stage.game.missiles.iter().any(|it| matches!(it.kind, MissileKind::Bolt { .. }))
}

/// An archer has seen the player, eight cells away, and draws the bow.
fn under_aim() -> Stage {
    let rows = ["############", "#..........#", "#@.......a.#", "#..........#", "############"];
    let mut stage = Stage::new(&rows, "", "a = { guard = 'archer', heading = 180 }");
    stage.steps_until(600, &[], |stage| stage.hears(SoundKind::Draw)).unwrap();
    stage
}

#[test]
fn a_bolt_is_announced_and_hits_a_player_who_stays() {
    let mut stage = under_aim();
    let told = stage.steps_until(200, &[], has_bolt).unwrap();
    assert!(told >= 18, "{told}");
    let flight = stage.steps_until(120, &[], |stage| stage.points() < 6).unwrap();
    assert!(flight >= 18, "{flight}");
    assert_eq!(stage.points(), 4);
    let flash = stage.game.flash().unwrap();
    let FlashKind::Hurt { bearing: Some(bearing) } = flash.kind else { panic!("{flash:?}") };
    assert!(bearing.degrees().min(360.0 - bearing.degrees()) < 10.0, "{bearing:?}");
}

#[test]
fn a_bolt_misses_a_player_who_leaves_its_line() {
    let mut stage = under_aim();
    stage.steps_until(200, &[], has_bolt).unwrap();
    let flies_by = |stage: &Stage| !has_bolt(stage);
    stage.steps_until(120, &[Intent::StrafeLeft], flies_by).unwrap();
    assert_eq!((stage.points(), stage.hears(SoundKind::Knock)), (6, true));
}

#[test]
fn bolts_end_at_walls_and_closed_doors() {
    for (between, points) in [('.', 4), ('#', 6), ('+', 6), ('%', 6)] {
        let middle = format!("#@.{between}....#");
        let rows = ["#########", &middle, "#########"];
        let mut stage =
            Stage::new(&rows, "'+' = { door = 'oak' }\n'%' = { glass = '#80c0ff' }", "");
        let from = (DVec2::new(7.5, 1.5), 0.5);
        stage.game.missiles.launch(Missile::bolt(from, -DVec2::X, 0.0, (0, 2)));
        stage.play(60, &[]);
        assert!(stage.game.missiles.is_empty());
        assert_eq!(stage.points(), points, "{between}");
    }
}

#[test]
fn only_a_guard_who_is_awake_pushes_a_player_away() {
    let rows = ["#######", "#.....#", "#..@..#", "#.....#", "#######"];
    for (name, degrees) in
        KINDS.into_iter().flat_map(|name| [0.0, 90.0, 200.0].map(|it| (name, it)))
    {
        for duty in ["", ", asleep = true"] {
            if name == "listener" && !duty.is_empty() {
                // The player's footsteps wake the guard.
                continue;
            }
            let rows = rows.map(|row| row.replace("@..", "@g."));
            let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
            let guard = format!("g = {{ guard = '{name}', heading = {degrees}{duty} }}");
            let mut stage = Stage::new(&rows, "", &guard);
            let distance = |stage: &Stage| stage.guard(0).position.distance(stage.position());
            stage.play(25, &[Intent::Forward]);
            assert!(distance(&stage) < 0.5, "{name}: {}", distance(&stage));
            let parts = |stage: &Stage| distance(stage) > 0.49;
            let has_parted = stage.steps_until(60, &[], parts).is_some();
            assert_eq!(has_parted, duty.is_empty(), "{name} {degrees} {duty}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// From any position in a corridor with guards, a walking player gets past them in either
    /// direction.
    #[test]
    fn no_guard_traps_a_player(
        kinds in prop::collection::vec(prop::sample::select(&KINDS[..]), 2),
        column in 1..12_usize,
        ducks in any::<bool>(),
        turns in any::<bool>(),
    ) {
        let mut row: Vec<char> = "#...g....h...#".chars().collect();
        prop_assume!(row[column] == '.');
        row[column] = '@';
        let row: String = row.into_iter().collect();
        let rows = ["##############", &row, "##############"];
        let things = format!("g.guard = '{}'\ng.heading = 180\nh.guard = '{}'\nh.heading = 0", kinds[0], kinds[1]);
        let mut stage = Stage::played(&rows, "", &things, Difficulty::Easy);
        if turns {
            stage.press(Intent::AboutFace).play(40, &[]);
        }
        let end = if turns { 1.3 } else { 12.7 };
        for _ in 0..1500 {
            // This test ignores blows.
            stage.game.player.health = Health::default();
            stage.play(1, if ducks { &[Intent::Forward, Intent::Duck] } else { &[Intent::Forward] });
            if (stage.position().x - end).abs() < 0.1 {
                return Ok(());
            }
        }
        prop_assert!(false, "{row} {kinds:?}: {}", stage.position());
    }
}

#[test]
fn a_guard_met_in_a_corridor_passes_then_turns_and_strikes() {
    let rows = ["###############", "#@......g.....#", "###############"];
    for (name, walk) in KINDS.into_iter().flat_map(|name| {
        [&[Intent::Forward][..], &[Intent::Forward, Intent::Run]].map(|walk| (name, walk))
    }) {
        let guard = format!("g = {{ guard = '{name}', heading = 180 }}");
        let mut stage = Stage::played(&rows, "", &guard, Difficulty::Easy);
        // The player and the guard pass each other.
        let has_passed = |stage: &Stage| stage.position().x > stage.guard(0).position.x + 0.5;
        stage.steps_until(400, walk, has_passed).unwrap_or_else(|| panic!("{name} {walk:?}"));
        if name == "listener" {
            // A player who stands at the wall is not heard.
            continue;
        }
        // The player stands at the end wall. The guard is behind them and strikes.
        let is_hurt = |stage: &Stage| stage.points() < 6;
        stage.steps_until(900, walk, is_hurt).unwrap_or_else(|| panic!("{name} {walk:?}"));
        // The player gets away.
        let before = stage.position().x;
        stage.play(60, &[Intent::Back]);
        assert!(before - stage.position().x > 2.0, "{name} {walk:?}");
    }
}

#[test]
fn a_door_stays_open_around_a_guard_who_lies_in_it() {
    let tiles = "'+' = { door = 'oak' }";
    let guard = "g = { guard = 'archer', heading = 0 }";
    let mut stage =
        Stage::new(&["##############", "#@....+g.....#", "##############"], tiles, guard);
    let door = Cell { column: 6, row: 1 };
    let opening = |stage: &Stage| stage.game.world().opening(door).part();
    stage.press(Intent::Throw);
    let is_in_the_door = |stage: &Stage| (stage.guard(0).position.x - 6.5).abs() < 0.1;
    stage.steps_until(600, &[], is_in_the_door).unwrap();
    assert_eq!(opening(&stage), 1.0);
    stage.game.guards.stun(0, 900);
    for _ in 0..899 {
        assert_eq!(opening(stage.play(1, &[])), 1.0);
    }
    stage.steps_until(1200, &[], |stage| opening(stage) == 0.0).unwrap();
    assert!(!stage.game.guards.touches(door));
}

/// A guard in the middle of tiles `f`, behind a wall.
fn on_a_floor(tile: &str, duty: &str, things: &str) -> Stage {
    let rows = ["############", "#@#.ffgff.l#", "############"];
    let things = format!("g = {{ guard = 'warden', heading = 0, on = 'f'{duty} }}\n{things}");
    Stage::new(&rows, &format!("f = {{ {tile} }}"), &things)
}

const DUTIES: [&str; 2] = ["", ", asleep = true"];
const UNDER: Cell = Cell { column: 6, row: 1 };

#[test]
fn a_lift_carries_a_guard_both_ways() {
    let tile = "floor_height = 0, ceiling = 'sky', moves_to = 2, switch = 'lift'";
    for duty in DUTIES {
        let mut stage = on_a_floor(tile, duty, "l = { lever = 'lift' }");
        for goal in [2.0, 0.0] {
            stage.game.mechanisms.turn(crate::world::SwitchId(0));
            for _ in 0..130 {
                stage.play(1, &[]);
                let above = stage.guard(0).feet - stage.game.world().floor_at(UNDER);
                assert!((0.0..0.05).contains(&above), "{duty}: {above}");
            }
            assert_eq!(stage.guard(0).feet, goal, "{duty}");
        }
    }
}

#[test]
fn a_guard_falls_with_a_crumbling_floor() {
    for duty in DUTIES {
        let mut stage = on_a_floor("floor = 'wood', crumbles = -3", duty, "l = { pebbles = 1 }");
        stage.play(150, &[]);
        assert_eq!(stage.game.world().floor_at(UNDER), -3.0);
        assert_eq!(stage.guard(0).feet, -3.0, "{duty}");
    }
}
