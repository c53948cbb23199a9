//! Low things and low shapes: tests which of them the player can jump onto or over, and which block
//! the way.

use crate::walker::{SKY, corridor, position, walk};
use cellcaster::game::{Game, Intent};
use cellcaster::map;

/// The final heights of a player who walks up to a thing, and then jumps.
fn jump_onto(thing: &str) -> [f64; 2] {
    let map = format!(
        "{SKY}\ngrid = '''\n#######\n#@..tt#\n#######\n'''\n[tiles]\n\
         \"#\" = {{ wall = \"brick\", height = 99 }}\n[things]\n\"@\" = {{ start = 0 }}\n\
         \"t\" = {{ {thing} }}\n"
    );
    let mut game = Game::new(map::parse_str(&map).unwrap_or_else(|faults| panic!("{faults}")));
    walk(&mut game, 120, &[Intent::Forward]);
    let after_walking = game.feet();
    walk(&mut game, 120, &[Intent::Forward, Intent::Jump]);
    [after_walking, game.feet()]
}

#[test]
fn a_low_thing_can_be_jumped_onto_but_not_walked_onto() {
    assert_eq!(jump_onto("sprite = \"table\""), [0.0, 0.42]);
    assert_eq!(jump_onto("sprite = \"barrel\""), [0.0, 0.58]);
    assert_eq!(jump_onto("sprite = \"bones\", blocks = true, height = 0.1"), [0.0, 0.1]);
    assert_eq!(jump_onto("sprite = \"statue\""), [0.0, 0.0]);
    assert_eq!(jump_onto("sprite = \"bones\""), [0.0, 0.0]);
}

#[test]
fn a_jumping_player_passes_over_a_thing_and_a_ducking_one_under_it() {
    let past = |thing: &str, wanted: &[Intent]| {
        let map = format!(
            "ceiling_height = 1.5\ngrid = '''\n########\n#@.t...#\n########\n'''\n[tiles]\n\
             \"#\" = {{ wall = \"brick\" }}\n[things]\n\"@\" = {{ start = 0 }}\n\
             \"t\" = {{ {thing} }}\n"
        );
        let mut game = Game::new(map::parse_str(&map).unwrap_or_else(|faults| panic!("{faults}")));
        walk(&mut game, 60, &[Intent::Forward]);
        walk(&mut game, 120, wanted);
        position(&game).x > 4.25
    };
    let hanging = "sprite = \"lamp\", anchor = \"ceiling\", blocks = true, height = 0.9";
    assert!(past("sprite = \"table\"", &[Intent::Forward, Intent::Jump]));
    assert!(!past("sprite = \"table\"", &[Intent::Forward]));
    assert!(past(hanging, &[Intent::Forward, Intent::Duck]));
    assert!(!past(hanging, &[Intent::Forward]));
}

#[test]
fn a_low_pillar_is_a_step_and_a_higher_one_is_jumped_onto() {
    let walk_and_jump = |height: f64| {
        let pillar = format!("pillar = \"marble\", radius = 0.5, height = {height}");
        let mut game = corridor(SKY, &[&pillar]);
        walk(&mut game, 120, &[Intent::Forward]);
        let after_walking = game.feet();
        walk(&mut game, 120, &[Intent::Forward, Intent::Jump]);
        [after_walking, game.feet()]
    };
    assert_eq!(walk_and_jump(0.35), [0.35, 0.35]);
    assert_eq!(walk_and_jump(0.6), [0.0, 0.6]);
    assert_eq!(walk_and_jump(0.7), [0.0, 0.0]);
}

#[test]
fn a_falling_player_lands_on_a_pillar() {
    let ledge = "floor_height = 3";
    let pillar = "pillar = \"marble\", radius = 0.5, height = 2";
    let map = format!(
        "{SKY}\ngrid = '''\n######\n#@o..#\n######\n'''\n[tiles]\n\
         \"#\" = {{ wall = \"brick\", height = 99 }}\n\"l\" = {{ {ledge} }}\n\
         \"o\" = {{ {pillar} }}\n[things]\n\"@\" = {{ start = 0, on = \"l\" }}\n"
    );
    let mut game = Game::new(map::parse_str(&map).unwrap());
    walk(&mut game, 20, &[Intent::Forward]);
    walk(&mut game, 60, &[]);
    assert_eq!(game.feet(), 2.0, "at {}", position(&game));
    walk(&mut game, 60, &[Intent::Forward]);
    assert_eq!(game.feet(), 0.0);
}

#[test]
fn a_player_at_the_height_of_a_key_takes_it() {
    let text = "ceiling = \"sky\"\ngrid = '''\n#######\n#@.k..#\n####+##\n####.##\n#######\n'''\n[tiles]\n\
                \"#\" = { wall = \"brick\", height = 99 }\n\"+\" = { door = \"oak\", key = \"brass\" }\n\
                \"=\" = { floor_height = -2, ceiling = \"wood\", ceiling_height = -0.5, roof_height = 0 }\n\
                [things]\n\"@\" = { start = 0 }\n";
    let keys_on_the_way = |key: &str| {
        let mut game = Game::new(map::parse_str(&format!("{text}{key}")).unwrap());
        walk(&mut game, 200, &[Intent::Forward]);
        game.keys().count()
    };
    assert_eq!(keys_on_the_way("k = { key = \"brass\" }"), 1);
    assert_eq!(keys_on_the_way("k = { key = \"brass\", on = \"=\" }"), 0, "it is under a roof");
}
