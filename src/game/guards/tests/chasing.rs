//! Guards who follow and strike.

use super::*;

const WARDEN: &str = r#""W" = { guard = "warden", heading = 0 }"#;

/// The steps between the warning of a blow and the blow, for a guard next to the player.
fn warning(name: &str) -> u32 {
    let things = format!("\"W\" = {{ guard = \"{name}\", heading = 0 }}");
    let mut scene = Scene::new("######\n#W.@.#\n######", &things);
    scene.put(2.4, 1.5);
    let told =
        |scene: &Scene| scene.has_sounded(SoundKind::Windup) || scene.has_sounded(SoundKind::Draw);
    scene.steps_until(900, told).unwrap();
    let is_blow = |act: &Act| matches!(act, Act::Hurt { .. } | Act::Bolt { .. });
    let mut frames = Vec::new();
    let steps = scene.steps_until(200, |scene| {
        frames.push(scene.guards.list[0].frame());
        scene.acts.iter().any(is_blow)
    });
    assert!(frames[..23].iter().all(|&frame| frame == 4), "{name}: {frames:?}");
    steps.unwrap()
}

#[test]
fn blows_are_told_at_least_24_steps_before() {
    for name in ["warden", "lantern", "hound", "archer"] {
        assert!(warning(name) >= 24, "{name}");
    }
    assert!(warning("warden") >= 48);
}

#[test]
fn who_steps_aside_is_not_hit() {
    let mut scene = Scene::new("########\n#W.@...#\n#......#\n########", WARDEN);
    scene.put(2.4, 1.5);
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Attacking).unwrap();
    scene.put(4.9, 2.5);
    let hurt = |scene: &Scene| scene.acts.iter().any(|act| matches!(act, Act::Hurt { .. }));
    assert_eq!(scene.steps_until(70, hurt), None);
}

#[test]
fn a_guard_opens_doors_on_the_way_and_a_hound_does_not() {
    for (name, gets_there) in [("warden", true), ("hound", false)] {
        let things = format!("\"W\" = {{ guard = \"{name}\", heading = 0 }}");
        let mut scene = Scene::new("##########\n#W..+...@#\n##########", &things);
        scene.target.is_alive = false;
        let noise = Sound { by: Source::Object, ..scene.sound(SoundKind::Knock, 24) };
        scene.step(&[noise]);
        let is_there = |scene: &Scene| scene.guard(0).position.x > 7.0;
        assert_eq!(scene.steps_until(900, is_there).is_some(), gets_there, "{name}");
    }
}

#[test]
fn a_hound_gives_up_the_trail_of_a_player_who_has_left() {
    let hound = r#""H" = { guard = "hound", heading = 180 }"#;
    let mut scene = Scene::new("##########\n#@......H#\n##########", hound);
    let gone = Target { position: DVec2::new(6.5, 1.5), visibility: 0, ..scene.target };
    scene.target.is_alive = false;
    scene.guards.step(&scene.world, &[scene.target, gone], &[], &[]);
    scene.guards.list[0].state = State::Tracking { target: 1, mark: 0, lost: 0 };
    scene.guards.forget_player(1);
    scene.step(&[]);
    assert_eq!(scene.mood(0), Mood::Returning);
}

#[test]
fn a_hound_follows_the_trail_around_a_corner_and_stops_at_a_door() {
    let mut scene = Scene::new(
        "##########\n#@...H...#\n#.########\n#...+....#\n##########",
        r#""H" = { guard = "hound", heading = 0 }"#,
    );
    // The player walks past behind the hound, around the corner and through the door.
    let way = [(4.5, 1.5), (1.5, 1.5), (1.5, 3.5), (3.5, 3.5)];
    let mut position = DVec2::new(4.5, 1.5);
    for place in way.map(DVec2::from) {
        while position.distance(place) > 0.1 {
            position += (place - position).normalize() * 0.09;
            scene.put(position.x, position.y);
            scene.step(&[]);
        }
    }
    scene.put(7.5, 3.5);
    let is_at_the_door =
        |scene: &Scene| scene.guard(0).position.distance(cell(3, 3).center()) < 0.7;
    scene.steps_until(900, is_at_the_door).unwrap();
    // The trail lasts for twenty seconds.
    scene.steps_until(2400, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert!(scene.guard(0).position.x < 4.0 || scene.guard(0).position.y < 2.0);
}

#[test]
fn an_archer_keeps_away_and_shoots_along_the_line() {
    let mut scene = Scene::new(
        "##############\n#....A..@....#\n#............#\n##############",
        r#""A" = { guard = "archer", heading = 0 }"#,
    );
    scene.put(7.0, 1.5);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    let mut shots = 0;
    for _ in 0..1200 {
        scene.step(&[]);
        for act in &scene.acts {
            if let &Act::Bolt { from, height, direction, slope, .. } = act {
                let distance = (scene.target.position - from).dot(direction);
                let meets = from + direction * distance;
                assert!(meets.distance(scene.target.position) < 0.05);
                let middle = scene.target.middle();
                assert!((height + slope * distance - middle).abs() < 0.05);
                shots += 1;
            }
        }
    }
    assert!(shots >= 3, "{shots}");
    assert!(scene.guard(0).position.distance(scene.target.position) >= 3.5);
}

#[test]
fn a_bearer_of_a_lantern_rings_before_anything_else() {
    let mut scene = Scene::new(
        "###########\n#N..@.....#\n#.........#\n#######.###\n#.........#\n#.......A.#\n###########",
        "\"N\" = { guard = \"lantern\", heading = 0 }\n\"A\" = { guard = \"archer\", heading = 90 }",
    );
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    assert!(scene.has_sounded(SoundKind::Bell));
    scene.steps_until(600, |scene| scene.mood(1) >= Mood::Chasing).unwrap();
    assert_eq!(scene.guards.lamps().count(), 1);
    scene.guards.stun(0, 60);
    assert_eq!(scene.guards.lamps().count(), 0);
}

#[test]
fn a_guard_who_loses_a_player_searches_and_gives_up() {
    let mut scene =
        Scene::new("############\n#W...@.....#\n####.#######\n#..........#\n############", WARDEN);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.guards.list[0].quarry.as_mut().unwrap().unseen = 100;
    scene.put(10.5, 3.5);
    scene.target.visibility = 0;
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
    let steps = scene.steps_until(2000, |scene| scene.has_sounded(SoundKind::GiveUp)).unwrap();
    assert!((540..=960).contains(&steps), "{steps}");
}

#[test]
fn guards_give_up_who_cannot_reach_a_player() {
    let mut scene = Scene::new("##########\n#W..p..@.#\n#...p....#\n##########", WARDEN);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.steps_until(900, |scene| scene.mood(0) == Mood::Searching).unwrap();
    assert!(scene.guard(0).feet == 0.0 && scene.is_sound());
}

#[test]
fn a_push_stops_a_blow() {
    let mut scene = Scene::new("########\n#..W@..#\n########", WARDEN);
    scene.steps_until(600, |scene| scene.mood(0) == Mood::Attacking).unwrap();
    let before = scene.guard(0).position;
    scene.guards.push(0, -DVec2::X);
    let hurt = |scene: &Scene| scene.acts.iter().any(|act| matches!(act, Act::Hurt { .. }));
    assert_eq!(scene.steps_until(30, hurt), None);
    assert!(scene.guard(0).position.x < before.x - 0.3);
}

#[test]
fn tools_find_the_guards_before_the_player() {
    let scene = Scene::new("########\n#@.W...#\n########", WARDEN);
    let near = |direction, reach| {
        scene.guards.guard_near(&scene.world, scene.target.position, direction, reach, 0.5)
    };
    assert_eq!(near(DVec2::X, 2.5), Some(0));
    assert_eq!([near(DVec2::X, 1.0), near(-DVec2::X, 2.5)], [None; 2]);
    let eye = (scene.target.position, 0.5);
    let aimed = scene.guards.aim(&scene.world, &[], eye, DVec2::X, 0.9).unwrap();
    assert_eq!(aimed.0, DVec2::new(3.5, 1.5));
    assert_eq!(scene.guards.hit_between(eye, (DVec2::new(6.0, 1.5), 0.5)), Some(0));
    assert_eq!(scene.guards.hit_between(eye, (DVec2::new(6.0, 1.5), 3.5)), None);
    assert!(scene.guards.is_behind(0, scene.target.position) && scene.guards.is_unaware(0));
}
