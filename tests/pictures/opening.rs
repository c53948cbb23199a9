//! Doors in a game: they open, wait, and close, but never on the player. Locked doors need their
//! key.

use crate::geometry::clearance;
use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map;
use cellcaster::world::{Cell, FieldOfView, Opening};
use glam::DVec2;
use proptest::prelude::*;

/// The player's radius.
const RADIUS: f64 = 0.25;
/// The number of steps in a second.
const SECOND: u64 = 60;

/// A game on a map with these rows: `+` is a door, `=` a locked door, `k` its key.
fn game(rows: &[&str], degrees: i32) -> Game {
    let text = format!(
        "grid = '''\n{}\n'''\n\
         tiles = {{ '#'.wall = 'brick', '+'.door = 'oak', '=' = {{ door = 'oak', key = 'brass' }} }}\n\
         things = {{ '@'.start = {degrees}, 'k'.key = 'brass' }}",
        rows.join("\n")
    );
    Game::new(map::parse_str(&text).unwrap())
}

fn corridor() -> Game {
    game(&["########", "#@.+...#", "########"], 0)
}

const DOOR: Cell = Cell { column: 3, row: 1 };

/// Rooms behind doors, one of them locked, and walls on all sides.
const ROOMS: [&str; 7] =
    ["#########", "#@..+...#", "#...#...#", "##+###+##", "#...=...#", "#.k.#...#", "#########"];

fn intents(list: &[Intent]) -> Intents {
    list.iter().copied().collect()
}

fn walk(game: &mut Game, steps: u64, list: &[Intent]) {
    (0..steps).for_each(|_| game.step(intents(list)));
}

fn position(game: &Game) -> DVec2 {
    game.camera(FieldOfView::default()).position()
}

fn wants() -> impl Strategy<Value = Vec<(Vec<Intent>, u64)>> {
    let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=4);
    prop::collection::vec((held, 1..90_u64), 1..30)
}

#[test]
fn a_door_opens_waits_and_closes() {
    let mut game = corridor();
    walk(&mut game, 2 * SECOND, &[]);
    assert!(game.is_at_rest(Intents::new()));
    assert_eq!(game.world().opening(DOOR), Opening::CLOSED);

    // From the start, the door is out of reach.
    walk(&mut game, 1, &[Intent::Open]);
    assert!(game.is_at_rest(intents(&[Intent::Open])));
    while position(&game).x < 2.1 {
        walk(&mut game, 1, &[Intent::Forward]);
    }
    walk(&mut game, SECOND, &[]);
    assert_eq!(game.world().opening(DOOR), Opening::CLOSED);

    walk(&mut game, 1, &[Intent::Open]);
    let mut openings = vec![];
    for _ in 0..SECOND * 6 / 10 {
        assert!(game.world().grid().is_solid(3, 1));
        walk(&mut game, 1, &[]);
        openings.push(game.world().opening(DOOR));
    }
    assert_eq!(openings.last(), Some(&Opening::OPEN));
    assert!(openings.is_sorted() && !game.world().grid().is_solid(3, 1));

    walk(&mut game, 4 * SECOND, &[]);
    assert_eq!(game.world().opening(DOOR), Opening::OPEN);
    walk(&mut game, SECOND / 10, &[]);
    assert!(game.world().opening(DOOR) < Opening::OPEN && game.world().grid().is_solid(3, 1));
    walk(&mut game, SECOND, &[]);
    assert_eq!(game.world().opening(DOOR), Opening::CLOSED);
    assert!(game.is_at_rest(Intents::new()));
}

#[test]
fn a_door_opens_and_reopens_for_a_player_who_walks_into_it() {
    let mut game = corridor();
    walk(&mut game, 3 * SECOND, &[Intent::Forward]);
    assert!(position(&game).x > 6.0, "{}", position(&game));

    let mut game = corridor();
    walk(&mut game, 40, &[Intent::Forward]);
    walk(&mut game, 36 + 4 * SECOND, &[]);
    let closing = game.world().opening(DOOR);
    assert!(Opening::CLOSED < closing && closing < Opening::OPEN);
    walk(&mut game, 5, &[Intent::Open]);
    assert!(game.world().opening(DOOR) > closing);
}

#[test]
fn a_door_does_not_close_on_a_player() {
    let mut game = corridor();
    while position(&game).x < 3.0 {
        walk(&mut game, 1, &[Intent::Forward]);
    }
    walk(&mut game, 60 * SECOND, &[]);
    assert_eq!(game.world().opening(DOOR), Opening::OPEN);
    walk(&mut game, 2 * SECOND, &[Intent::Back]);
    walk(&mut game, 6 * SECOND, &[]);
    assert_eq!(game.world().opening(DOOR), Opening::CLOSED);
}

#[test]
fn a_locked_door_asks_for_its_key() {
    let mut game = game(&["#######", "#k@.=.#", "#######"], 0);
    let door = Cell { column: 4, row: 1 };
    assert_eq!(game.message(), None);
    walk(&mut game, SECOND, &[Intent::Forward]);
    assert_eq!(game.message(), Some("This door needs the brass key."));
    assert_eq!((game.world().opening(door), game.keys().count()), (Opening::CLOSED, 0));
    walk(&mut game, 4 * SECOND, &[]);
    assert_eq!(game.message(), None);

    walk(&mut game, SECOND, &[Intent::Back]);
    assert_eq!(game.message(), Some("You have the brass key."));
    assert_eq!(game.keys().collect::<Vec<_>>(), ["brass"]);
    assert_eq!(game.world().things(), []);
    walk(&mut game, 3 * SECOND, &[Intent::Forward]);
    assert!(position(&game).x > 5.0);
}

#[test]
fn every_visible_change_makes_a_new_revision() {
    let mut game = corridor();
    walk(&mut game, 20, &[Intent::Forward]);
    for _ in 0..400 {
        let (before, opening) = (game.revision(), game.world().opening(DOOR));
        walk(&mut game, 1, &[]);
        assert_eq!(game.revision() > before, game.world().opening(DOOR) != opening);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn the_player_is_never_inside_a_door_or_a_wall(degrees in 0..360, wants in wants()) {
        let mut game = game(&ROOMS, degrees);
        for (held, steps) in wants {
            for _ in 0..steps {
                walk(&mut game, 1, &held);
                let clearance = clearance(game.world(), position(&game));
                prop_assert!(clearance >= RADIUS, "{} at {}", clearance, position(&game));
            }
        }
    }

    #[test]
    fn all_doors_close_while_the_player_stands_still(degrees in 0..360, wants in wants()) {
        let mut game = game(&ROOMS, degrees);
        for (held, steps) in wants {
            walk(&mut game, steps, &held);
        }
        walk(&mut game, 10 * SECOND, &[]);
        let rests = game.is_at_rest(Intents::new());
        let holds_one = clearance_of_doors(&game) < RADIUS;
        prop_assert_eq!(rests, !holds_one);
    }
}

/// The distance from the player to the nearest cell with a door, open or not.
fn clearance_of_doors(game: &Game) -> f64 {
    let point = position(game);
    let cells = (0..7).flat_map(|row| (0..9).map(move |column| Cell { column, row }));
    cells
        .filter(|&cell| game.world().door(cell).is_some())
        .map(|cell| point.distance(point.clamp(cell.center() - 0.5, cell.center() + 0.5)))
        .fold(f64::INFINITY, f64::min)
}
