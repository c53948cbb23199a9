//! The time for which a key counts as held, with and without key releases.

use std::cell::Cell;
use std::fs;
use std::path::Path;
use std::thread;
use std::time::{Duration, Instant};

use cellcaster::game::{self, Intent, Intents, Script};
use cellcaster::map;
use cellcaster::world::FieldOfView;
use glam::DVec2;

use super::clock::{CLOCK, Typist};
use super::game::{Arrow, ENVIRONMENT, Game, Key, PROGRAM, test_map};
use crate::emulator::Speaks;

const LARGE: (u16, u16) = (120, 40);

fn in_a_corridor(speaks: Speaks, environment: &[(&str, &str)]) -> Game {
    Game::with(speaks, LARGE, Some("corridor"), &[], environment)
}

/// A distance in columns that taps do not reach.
const FAR: u16 = 4;

#[test]
fn a_key_is_held_without_repetition_until_its_release() {
    let game = in_a_corridor(Speaks::Kitty, &[]);
    let before = game.arrow();
    game.press(Key::Char('w'));
    game.wait_for_arrow("walked far", |arrow| arrow.column > before.column + FAR);
    game.release(Key::Char('w'));
    game.wait_for_rest();
    assert!(game.arrow().column < before.column + 32, "it walked to the end");
}

/// In a plain terminal without releases, and in a multiplexer that claims to report them.
#[test]
fn without_releases_a_tap_walks_a_little_and_stops() {
    let multiplexers: [&[_]; 4] = [
        &[],
        &[("TMUX", "/tmp/socket,1,0")],
        &[("STY", "1.pts-0.host")],
        &[("TERM", "screen-256color")],
    ];
    let games = multiplexers.map(|environment| {
        let speaks = if environment.is_empty() { Speaks::Plain } else { Speaks::Kitty };
        let game = in_a_corridor(speaks, environment);
        let before = game.arrow();
        // Three taps are three quarters of a cell.
        game.send("www");
        (environment, game, before)
    });
    for (environment, game, before) in games {
        game.wait_for_arrow("walked", |arrow| arrow.column > before.column);
        game.wait_for_rest();
        assert_eq!(game.arrow().column, before.column + 1, "it walked on by itself");
        if !environment.is_empty() {
            assert!(!speaks_kitty(&game.bytes()), "the protocol was asked for in {environment:?}");
        }
    }
}

fn speaks_kitty(bytes: &[u8]) -> bool {
    [&b"\x1b[?u"[..], b"\x1b[>15u"]
        .iter()
        .any(|query| bytes.windows(query.len()).any(|w| w == *query))
}

#[test]
fn without_releases_repetition_walks_and_an_opposing_key_reverses() {
    const REPETITION: Duration = Duration::from_millis(30);
    let game = in_a_corridor(Speaks::Plain, &[]);
    let before = game.arrow();
    let hold_until = |key: &str, condition: &dyn Fn(Arrow) -> bool| {
        for _ in 0..600 {
            if condition(game.arrow()) {
                return;
            }
            game.send(key);
            thread::sleep(REPETITION);
        }
        panic!("holding {key} did not help");
    };
    hold_until("w", &|arrow| arrow.column > before.column + FAR);
    hold_until("s", &|arrow| arrow.column <= before.column + 1);
}

/// The delay and the interval of a keyboard's repetition.
const DELAY: Duration = Duration::from_millis(500);
const INTERVAL: Duration = Duration::from_millis(33);

/// Holds a key at a terminal without releases until `condition` is true. Returns the longest time
/// between two of its repetitions.
fn hold(game: &Game, bytes: &str, condition: impl Fn() -> bool) -> Duration {
    game.send(bytes);
    thread::sleep(DELAY);
    let (mut last, mut longest) = (Instant::now(), Duration::ZERO);
    for _ in 0..600 {
        longest = longest.max(last.elapsed());
        if condition() {
            return longest;
        }
        last = Instant::now();
        game.send(bytes);
        thread::sleep(INTERVAL);
    }
    panic!("holding {bytes:?} did not help; the screen:\n{}", game.text());
}

/// The player's intents in each step of a game to which `plays` has sent bytes.
fn wanted(name: &str, map: &str, plays: impl Fn(&Game)) -> Vec<Intents> {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // An earlier run may have left this file.
    _ = fs::remove_file(&path);
    let options = ["--record", path.to_str().unwrap()];
    let mut game = Game::with(Speaks::Plain, LARGE, Some(map), &options, &[]);
    plays(&game);
    game.send("q\r");
    game.wait_for_end();
    let script = Script::parse(&fs::read_to_string(path).unwrap(), name);
    script.unwrap_or_else(|faults| panic!("{faults}")).iter().map(|(_, intents)| intents).collect()
}

/// Five steps of walking are a quarter of a cell, and ten steps of aiming are 5 degrees.
#[test]
fn two_taps_move_twice_as_far_as_one() {
    let names =
        |steps: &[Intents], intent| steps.iter().filter(|step| step.contains(intent)).count();
    for taps in 1..=3 {
        let steps = wanted(&format!("taps_{taps}.script"), "floor", |game| {
            game.send("w".repeat(taps));
            game.wait_for_rest();
            game.send("\x1b[C".repeat(taps));
            game.wait_for_rest();
        });
        assert_eq!(names(&steps, Intent::Forward), 5 * taps);
        assert_eq!(names(&steps, Intent::TurnRight), 10 * taps);
        assert_eq!(names(&steps, Intent::Aim), 10 * taps);
    }
}

/// A turn key is tapped, and a walking key is held 80 to 140 ms later.
#[test]
fn a_turn_tapped_before_walking_is_one_tap() {
    let map = test_map("floor");
    for steps_apart in 5..=8 {
        let name = format!("adjust_{steps_apart}.script");
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(&name);
        // An earlier run may have left this file.
        _ = fs::remove_file(&path);
        let arguments = ["play", "--record", path.to_str().unwrap(), map.to_str().unwrap()];
        let environment = [&ENVIRONMENT[..], &[CLOCK]].concat();
        let mut typist = Typist::start(PROGRAM, &arguments, &environment);
        typist.wait_to_see("? help");
        typist.tap("\x1b[C", steps_apart);
        typist.hold("w", 90);
        typist.pass(60);
        typist.send("q\r");
        typist.wait_for_end().assert_given_back();
        let script = Script::parse(&fs::read_to_string(&path).unwrap(), &name).unwrap();
        let count = |intent| script.iter().filter(|(_, it)| it.contains(intent)).count();
        assert_eq!(count(Intent::TurnRight), 10, "{steps_apart} steps apart");
        assert!(count(Intent::Forward) > 60, "{steps_apart} steps apart");
    }
}

#[test]
fn exact_turn_keys_turn_exactly() {
    let game = Game::with(Speaks::Plain, LARGE, Some("floor"), &[], &[]);
    game.send("oo");
    game.wait_for_picture(&["--camera", "7.5,7.5,10"]);
    game.send("uuu");
    game.wait_for_picture(&["--camera", "7.5,7.5,355"]);
    game.send("b");
    game.wait_for_picture(&["--camera", "7.5,7.5,175"]);
}

#[test]
fn without_releases_the_player_can_walk_in_a_circle() {
    // A machine that is too busy types too late, which counts as a release of the key.
    let places = (0..5).map(|_| circle()).find(|places| places.len() > 30 + HALF_TURN);
    let places = places.expect("this machine is too busy to type");
    // After half a second, the path is a circle with a radius of 3 cells at 2.4 radians per second.
    for (one, other) in places[30..].iter().zip(&places[30 + HALF_TURN..]) {
        assert!((one.distance(*other) - 2.5).abs() < 0.05, "{one} {other}");
    }
}

/// The number of steps of half a turn at 2.4 radians per second.
const HALF_TURN: usize = 79;

/// The positions of a player who walks and turns, for as long as both intents last.
fn circle() -> Vec<DVec2> {
    let steps = wanted("circle.script", "floor", |game| {
        let start = game.arrow();
        _ = hold(game, "w", || game.arrow().column > start.column);
        // The second key ends the repetition of the first.
        let turns = Cell::new(0);
        _ = hold(game, "\x1b[C", || turns.replace(turns.get() + 1) > 90);
    });
    let mut game = game::Game::new(map::load(&test_map("floor")).unwrap());
    let (mut places, mut longest) = (Vec::new(), Vec::new());
    for intents in steps {
        let both = [Intent::Forward, Intent::TurnRight].iter().all(|&one| intents.contains(one));
        game.step(intents);
        if both && !intents.contains(Intent::Aim) {
            places.push(game.camera(FieldOfView::default()).position());
        } else {
            places.clear();
        }
        if places.len() > longest.len() {
            longest.clone_from(&places);
        }
    }
    longest
}

/// The space key ends the repetition of W, which stays held until the player lands.
#[test]
fn without_releases_all_six_running_jumps_succeed() {
    // A cell has three columns on the map, and the pit begins at 6, so the jumps begin between 5
    // and 5.7 cells.
    for columns in [11, 11, 12, 12, 13, 13] {
        let jumped = (0..10).any(|_| running_jump(columns));
        assert!(jumped, "this machine is too busy to type");
    }
}

/// Jumps when the player is `columns` columns from the start, and checks that the player lands
/// behind the pit. Returns `false` without a jump if this machine was too slow to act as a
/// keyboard.
fn running_jump(columns: u16) -> bool {
    let longest = Cell::new(Duration::ZERO);
    let steps = wanted(&format!("jump_{columns}.script"), "pit", |game| {
        let start = game.arrow();
        longest.set(hold(game, "w", || game.arrow().column >= start.column + columns));
        game.send(" ");
        game.wait_for_rest();
    });
    let mut game = game::Game::new(map::load(&test_map("pit")).unwrap());
    let place = |game: &game::Game| game.camera(FieldOfView::default()).position().x;
    let mut takes_off = None;
    for intents in steps {
        if intents.contains(Intent::Jump) && takes_off.is_none() {
            takes_off = Some(place(&game));
        }
        game.step(intents);
    }
    let takes_off = takes_off.expect("Space jumps");
    if longest.get() > 2 * INTERVAL || takes_off > 6.2 {
        return false;
    }
    assert!(place(&game) > 7.0 && game.feet() == 0.0, "{takes_off} led to {}", place(&game));
    true
}
