//! Properties of the game in small levels.

mod encounters;
mod finds;
mod hazards;
mod mechanisms;
pub(crate) mod missions;
mod stage;
mod tools;

use glam::DVec2;
use proptest::prelude::*;
pub(crate) use stage::Stage;

use super::*;
use crate::color::Rgb;
use crate::world::sprite::builtin;
use crate::world::{
    Ceiling, Cell, Covering, FieldOfView, Grid, Heading, Heights, Paint, Parts, Sky, SpriteId,
    Start, Thing, ThingKind, Tile, TileKind,
};

/// A world drawn in characters: `#` is solid, `@` is the player's start, `E` is an exit.
fn world(rows: &[&str], degrees: f64) -> World {
    let cells_that_hold = |wanted: char| {
        rows.iter().zip(0..).flat_map(move |(line, row)| {
            let columns = line.chars().zip(0..).filter(move |&(found, _)| found == wanted);
            columns.map(move |(_, column)| Cell { column, row })
        })
    };
    let floors: Vec<String> = rows.iter().map(|row| row.replace(['@', 'E'], ".")).collect();
    let floors: Vec<&str> = floors.iter().map(String::as_str).collect();
    let gray = Paint::Color(Rgb::new(128, 128, 128));
    let (floor, ceiling) = (Covering::from(gray), Ceiling::Covered(gray.into()));
    let tile = |character, kind, heights| Tile {
        character,
        kind,
        floor,
        ceiling,
        light: None,
        heights,
        riser: gray,
        lintel: gray,
        effect: None,
    };
    World::from_parts(Parts {
        goal: None,
        title: String::new(),
        grid: Grid::sketch(&floors).unwrap(),
        tiles: vec![
            tile('.', TileKind::Open, Heights::LEVEL),
            tile('#', TileKind::Wall(gray), Heights::LEVEL_WALL),
        ],
        textures: vec![],
        floor,
        ceiling,
        sky: Sky::default(),
        fog: None,
        start: Start {
            cell: cells_that_hold('@').next().unwrap(),
            heading: Heading::from_degrees(degrees).unwrap(),
        },
        sprites: vec![builtin::named(builtin::EXIT).unwrap()],
        things: cells_that_hold('E')
            .map(|cell| Thing { kind: ThingKind::Exit, cell, sprite: SpriteId(0), frame: None })
            .collect(),
        keys: vec![],
        mission: crate::world::Mission::default(),
    })
}

const CELLAR: [&str; 7] = [
    "##########",
    "#@...#...#",
    "#....#.#.#",
    "#.##...#.#",
    "#....#.#.#",
    "#..#.....#",
    "##########",
];

fn intents(list: &[Intent]) -> Intents {
    list.iter().copied().collect()
}

fn walk(game: &mut Game, steps: usize, list: &[Intent]) {
    for _ in 0..steps {
        game.step(intents(list));
    }
}

fn position(game: &Game) -> DVec2 {
    game.camera(FieldOfView::default()).position()
}

fn to_nearest_wall(grid: &Grid, point: DVec2) -> f64 {
    let cells = (0..grid.height()).flat_map(|row| (0..grid.width()).map(move |c| (c, row)));
    cells
        .filter(|&(column, row)| grid.is_solid(column.into(), row.into()))
        .map(|(column, row)| Cell { column, row }.center())
        .map(|middle| point.distance(point.clamp(middle - 0.5, middle + 0.5)))
        .fold(f64::INFINITY, f64::min)
}

/// Lists of intents, each with the number of steps for which it is held.
pub(crate) fn script() -> impl Strategy<Value = Vec<(usize, Vec<Intent>)>> {
    let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=Intent::ALL.len());
    prop::collection::vec((1..60_usize, held), 0..30)
}

proptest! {
    #[test]
    fn the_player_never_enters_a_wall_or_exceeds_running_speed(script in script(), degrees in 0.0..360.0) {
        let mut game = Game::new(world(&CELLAR, degrees));
        for held in script.iter().flat_map(|(steps, held)| vec![held; *steps]) {
            let before = position(&game);
            walk(&mut game, 1, held);
            let after = position(&game);
            prop_assert!(before.distance(after) <= 5.5 * STEP * (1.0 + 1e-12));
            prop_assert!(to_nearest_wall(game.world().grid(), after) >= 0.25 - 1e-12);
        }
    }

    #[test]
    fn a_player_without_intents_comes_to_rest(script in script(), degrees in 0.0..360.0) {
        let mut game = Game::new(world(&CELLAR, degrees));
        for (steps, held) in &script {
            walk(&mut game, *steps, held);
        }
        walk(&mut game, 120, &[]);
        prop_assert!(game.is_at_rest(Intents::new()));
        prop_assert!(game.is_at_rest(intents(&[Intent::Run])));

        let mut waiting = game.clone();
        walk(&mut game, 1000, &[]);
        waiting.wait(1000);
        prop_assert_eq!(game, waiting);
    }

    #[test]
    fn a_player_pushing_into_a_corner_comes_to_rest(degrees in 1.0..89.0) {
        let mut game = Game::new(world(&["####", "#@.#", "#..#", "####"], degrees));
        walk(&mut game, 60 * 60, &[Intent::Forward]);
        prop_assert!(game.is_at_rest(intents(&[Intent::Forward])));
        prop_assert!(!game.is_at_rest(intents(&[Intent::Back])));
        prop_assert_eq!(position(&game), DVec2::new(2.75, 2.75));
    }
}

#[test]
fn walking_running_and_turning_reach_their_speeds() {
    let row = format!("@{}", ".".repeat(20));
    for (gait, speed) in [(&[][..], 3.0), (&[Intent::Run], 5.5)] {
        let mut game = Game::new(world(&[&row], 0.0));
        walk(&mut game, 60, &[&[Intent::Forward], gait].concat());
        let before = position(&game);
        walk(&mut game, 60, &[&[Intent::Forward], gait].concat());
        assert!((position(&game) - before - DVec2::new(speed, 0.0)).length() < 1e-4);
    }
    let mut game = Game::new(world(&["@"], 0.0));
    walk(&mut game, 60, &[Intent::TurnRight]);
    let heading = game.camera(FieldOfView::default()).heading.degrees();
    assert!((heading - (2.4_f64 - 2.4 / 20.0).to_degrees()).abs() < 1e-6, "{heading}");
    assert!(!game.is_at_rest(Intents::new()));
    assert!((game.elapsed() - 1.0).abs() < 1e-12);
}

#[test]
fn a_wall_takes_all_speed() {
    let mut game = Game::new(world(&["@....#"], 0.0));
    walk(&mut game, 600, &[Intent::Forward, Intent::Run]);
    assert_eq!(position(&game), DVec2::new(4.75, 0.5));
    assert!(game.is_at_rest(Intents::new()));
    assert!(game.is_at_rest(intents(&[Intent::Forward])));
}

#[test]
fn the_exit_ends_the_game() {
    let mut game = Game::new(world(&["@..E..."], 0.0));
    let forward = [Intent::Forward];
    while !game.is_finished() {
        assert!(position(&game).x < 3.0 && !game.is_at_rest(intents(&forward)));
        walk(&mut game, 1, &forward);
    }
    assert!((3.0..3.1).contains(&position(&game).x));

    let end = game.clone();
    assert!(game.is_at_rest(intents(&forward)));
    walk(&mut game, 60, &forward);
    game.wait(60);
    assert_eq!(game, end);
}

#[test]
fn a_player_keeps_their_place_in_a_changed_world_if_it_is_free() {
    let rows = ["#######", "#@....#", "#....E#", "#######"];
    let mut game = Game::new(world(&rows, 0.0));
    let wants = [Intent::Forward, Intent::TurnRight].into_iter().collect();
    (0..20).for_each(|_| game.step(wants));
    let view = FieldOfView::default();
    let before = game.camera(view);
    let again = game.begun_again_in(world(&["########", "#@.....#", "#......#", "########"], 0.0));
    assert_eq!(again.camera(view), before);
    assert_eq!(again.elapsed(), 0.0);

    // At the player's position: a wall, an exit, and no map at all.
    for rows in [
        ["#######", "#@#####", "#....E#"],
        ["#######", "#@EEE##", "#....E#"],
        ["###", "#@#", "###"],
    ] {
        let changed = world(&rows, 0.0);
        assert_eq!(game.begun_again_in(changed.clone()), Game::new(changed), "{rows:?}");
    }
}

#[test]
fn a_look_turns_and_tilts_at_once_by_its_exact_angle() {
    let mut game = Game::new(world(&["#####", "#.@.#", "#####"], 0.0));
    let start = game.camera(FieldOfView::default());
    let looking = |turn, tilt| Intents::new().with_look(Look { turn, tilt });
    let headings: Vec<f64> = (0..4)
        .map(|_| {
            game.step(looking(9000, 0));
            game.camera(FieldOfView::default()).heading.degrees()
        })
        .collect();
    assert_eq!(headings, [90.0, 180.0, 270.0, 0.0]);
    assert_eq!(game.camera(FieldOfView::default()), start);

    game.step(looking(0, 500));
    let tilted = game.camera(FieldOfView::default());
    assert!((tilted.pitch.slope() - 5_f64.to_radians()).abs() < 1e-12);
    game.step(looking(0, i16::MAX));
    assert_eq!(game.camera(FieldOfView::default()).pitch.degrees().round(), 30.0);
    // The pitch is at its limit, so nothing happens.
    assert!(game.is_at_rest(looking(0, 1)) && !game.is_at_rest(looking(0, -1)));
    assert!(!game.is_at_rest(looking(1, 0)) && game.is_at_rest(Intents::new()));
}
