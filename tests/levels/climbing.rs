//! Steps, ledges, low ceilings and deep falls: tests which of them the player can climb and pass,
//! and that the player is never inside anything.

use crate::open::is_in_the_open;
use crate::walker::{SKY, corridor, position, walk, want};
use cellcaster::game::{Game, Intent, Intents};
use cellcaster::map;
use cellcaster::world::{FieldOfView, World};
use proptest::prelude::*;

#[test]
fn a_step_is_climbed_up_to_the_limit() {
    let walk_to = |height: f64| {
        let mut game = corridor(SKY, &[&format!("floor_height = {height}")]);
        walk(&mut game, 240, &[Intent::Forward]);
        game.feet()
    };
    for low in [1e-9, 0.1, 0.35] {
        assert_eq!(walk_to(low), low);
    }
    for high in [0.35_f64.next_up(), 0.36, 1.0, 1e9] {
        assert_eq!(walk_to(high), 0.0);
    }
}

#[test]
fn stairs_are_climbed_at_a_run_and_walked_down_without_a_jump() {
    let heights = [0.3, 0.6, 0.9, 1.2, 1.5, 1.2, 0.9, 0.6, 0.3];
    let tiles = heights.map(|height| format!("floor_height = {height}"));
    let mut game = corridor(SKY, &tiles.each_ref().map(String::as_str));
    let mut highest: f64 = 0.0;
    let mut eye = game.camera(FieldOfView::default()).eye();
    for _ in 0..400 {
        walk(&mut game, 1, &[Intent::Forward, Intent::Run]);
        highest = highest.max(game.feet());
        // The eye moves smoothly, even if the feet do not.
        let next = game.camera(FieldOfView::default()).eye();
        assert!((next - eye).abs() < 0.1, "from {eye} to {next}");
        eye = next;
        let floor = game.feet();
        assert!(heights.contains(&floor) || floor == 0.0, "in the air at {floor}");
    }
    assert_eq!(highest, 1.5);
    assert_eq!(game.feet(), 0.3);
}

#[test]
fn a_jump_clears_a_ledge_of_six_tenths_but_not_of_seven() {
    let jump_onto = |height: f64| {
        let mut game = corridor(SKY, &[&format!("floor_height = {height}")]);
        walk(&mut game, 240, &[Intent::Forward]);
        walk(&mut game, 120, &[Intent::Forward, Intent::Jump]);
        game.feet()
    };
    assert_eq!(jump_onto(0.6), 0.6);
    assert_eq!(jump_onto(0.7), 0.0);
}

#[test]
fn each_press_of_jump_is_one_jump() {
    let mut game = corridor(SKY, &["light = 1"]);
    walk(&mut game, 120, &[Intent::Jump]);
    assert!(game.is_at_rest(want(&[Intent::Jump])));
    assert_eq!(game.feet(), 0.0);
    walk(&mut game, 1, &[]);
    walk(&mut game, 10, &[Intent::Jump]);
    assert!(game.feet() > 0.3);
}

#[test]
fn a_jump_under_a_low_ceiling_is_a_low_jump() {
    let mut game = corridor("ceiling_height = 0.75", &["light = 1"]);
    let mut highest: f64 = 0.0;
    let mut landed_after = 0;
    for step in 0..60 {
        walk(&mut game, 1, &[Intent::Jump]);
        highest = highest.max(game.feet());
        if game.feet() > 0.0 {
            landed_after = step;
        }
    }
    assert!((0.04..=0.05).contains(&highest), "{highest}");
    assert!(landed_after < 15, "it hangs below the ceiling until step {landed_after}");
}

#[test]
fn a_ducking_player_passes_under_a_beam_and_stands_up_behind_it() {
    let beam = "ceiling_height = 0.6";
    let mut game = corridor("ceiling_height = 2", &[beam, beam, "light = 1"]);
    walk(&mut game, 240, &[Intent::Forward]);
    assert_eq!(position(&game).x, 4.75);
    let standing = game.camera(FieldOfView::default()).eye();
    walk(&mut game, 30, &[Intent::Forward, Intent::Duck]);
    assert!((5.0..7.0).contains(&position(&game).x), "{}", position(&game));
    walk(&mut game, 60, &[]);
    let eye = game.camera(FieldOfView::default()).eye();
    assert!(eye < 0.55 && eye < standing, "the eye is at {eye}, in the beam");
    walk(&mut game, 60, &[Intent::Forward]);
    walk(&mut game, 60, &[]);
    assert_eq!(game.camera(FieldOfView::default()).eye(), standing);
    assert!(position(&game).x >= 7.25);
}

/// A closed room with cells of eight kinds and random heights, and with shapes and things.
fn any_world() -> impl Strategy<Value = World> {
    let floor = prop::sample::select(vec![
        0.0_f64, 1e-9, 0.1, 0.3, 0.35, 0.36, 0.5, 0.6, 0.9, -0.3, -2.0, -1e9, 1e9, 3.0,
    ]);
    let headroom = prop::sample::select(vec![1e-9, 0.3, 0.5, 0.55, 0.7, 0.75, 1.0, 2.5]);
    let tile = (floor, prop::option::of(headroom));
    let cells = prop::collection::vec(prop::sample::select(&b"abcdefgh......#|%oO/-tTBH"[..]), 35);
    let height = prop::sample::select(vec![1e-9_f64, 0.1, 0.3, 0.36, 0.6, 0.9, 1.0, 2.0]);
    (prop::collection::vec(tile, 8), cells, height).prop_map(|(tiles, mut cells, height)| {
        cells[17] = b'@';
        let rows: Vec<String> =
            cells.chunks(7).map(|row| format!("#{}#\n", String::from_utf8_lossy(row))).collect();
        let rows = rows.concat();
        let legend: Vec<String> = tiles
            .iter()
            .zip('a'..)
            .map(|(&(floor, headroom), letter)| match headroom {
                Some(headroom) if floor + headroom > floor && floor.abs() < 1e8 => format!(
                    "\"{letter}\" = {{ floor_height = {floor:?}, ceiling_height = {:?} }}\n",
                    floor + headroom
                ),
                _ => format!("\"{letter}\" = {{ floor_height = {floor:?}, ceiling = \"sky\" }}\n"),
            })
            .collect();
        let legend = legend.concat();
        let text = format!(
            "ceiling_height = 1.5\ngrid = '''\n#########\n{rows}#########\n'''\n[tiles]\n\
             \"#\" = {{ wall = \"brick\" }}\n\"%\" = {{ wall = \"brick\", height = 0.5 }}\n\
             \"|\" = {{ glass = \"#ffffff\" }}\n{legend}\
             \"o\" = {{ pillar = \"brick\", height = {height:?} }}\n\
             \"O\" = {{ pillar = \"brick\", radius = 0.5, ceiling = \"sky\" }}\n\
             \"/\" = {{ diagonal = \"brick\", from = \"north-east\", height = {height:?} }}\n\
             \"-\" = {{ thin = \"brick\", at = \"north\", floor_height = 0.3, height = 0.3 }}\n\
             [things]\n\"@\" = {{ start = 0 }}\n\"t\" = {{ sprite = \"table\" }}\n\
             \"T\" = {{ sprite = \"table\", height = 0.2, on = \"a\" }}\n\
             \"B\" = {{ sprite = \"barrel\", height = {:?} }}\n\
             \"H\" = {{ sprite = \"lamp\", anchor = \"ceiling\", blocks = true, height = 0.8 }}\n",
            height.max(0.01)
        );
        map::parse_str(&text).unwrap_or_else(|faults| panic!("{text}\n{faults}"))
    })
}

/// Lists of intents, each held for a while.
fn script() -> impl Strategy<Value = Vec<(usize, Vec<Intent>)>> {
    let held = prop::sample::subsequence(Intent::ALL.to_vec(), 0..=6);
    prop::collection::vec((1..50_usize, held), 1..25)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn the_player_is_never_inside_anything(world in any_world(), script in script()) {
        let mut game = Game::new(world);
        for (steps, wanted) in &script {
            for _ in 0..*steps {
                game.step(want(wanted));
                let (place, feet) = (position(&game), game.feet());
                prop_assert!(is_in_the_open(game.world(), place, feet), "{place}, {feet}");
                let eye = game.camera(FieldOfView::default()).eye();
                prop_assert!(feet < eye || feet.abs() > 1e8, "an eye at {eye}, feet at {feet}");
            }
        }
    }

    #[test]
    fn a_player_at_rest_stays_at_rest(world in any_world(), script in script()) {
        let mut game = Game::new(world);
        for (steps, wanted) in &script {
            walk(&mut game, *steps, wanted);
        }
        walk(&mut game, 300, &[]);
        // A player who is still falling has fallen farther since.
        if game.feet() > -100.0 {
            prop_assert!(game.is_at_rest(Intents::new()));
        }
        let mut waiting = game.clone();
        let quiet = if game.is_at_rest(Intents::new()) { 100 } else { 0 };
        walk(&mut game, quiet as usize, &[]);
        waiting.wait(quiet);
        prop_assert!(game == waiting);
    }
}
