//! What guards see.

use super::*;

/// A corridor of sixteen cells, with a warden at its west end.
fn corridor(heading: u32) -> Scene {
    let warden = format!("\"W\" = {{ guard = \"warden\", heading = {heading} }}");
    Scene::new("##################\n#W.......@.......#\n##################", &warden)
}

#[test]
fn a_player_behind_a_guard_is_not_seen() {
    let mut scene = corridor(180);
    scene.put(2.8, 1.5);
    // Guards who look around do not look back.
    let alarmed = scene.steps_until(600, |scene| scene.mood(0) != Mood::OnDuty);
    assert_eq!(alarmed, None);
}

#[test]
fn a_player_in_the_light_at_eight_cells_is_noticed_first_and_followed_later() {
    let mut scene = corridor(0);
    let noticed = scene.steps_until(600, |scene| scene.mood(0) == Mood::Wondering).unwrap();
    assert!(scene.has_sounded(SoundKind::Wonder));
    let more = scene.steps_until(600, Scene::is_alarmed).unwrap();
    assert!(scene.has_sounded(SoundKind::Shout));
    assert!((20..90).contains(&noticed), "{noticed}");
    assert!((30..240).contains(&more), "{more}");
    assert!(scene.acts.contains(&Act::Raised));
}

#[test]
fn nobody_is_followed_within_half_a_second_of_being_noticed() {
    for column in 2..11 {
        let mut scene = corridor(0);
        scene.put(f64::from(column) + 1.3, 1.5);
        let noticed = scene.steps_until(900, |scene| scene.mood(0) != Mood::OnDuty).unwrap();
        if !scene.is_alarmed() {
            let more = scene.steps_until(900, Scene::is_alarmed).unwrap();
            assert!(more >= 30, "{column}: {noticed} and {more}");
        }
    }
}

#[test]
fn face_to_face_there_is_no_hiding() {
    let mut scene = corridor(0);
    scene.put(2.5, 1.5);
    scene.target.visibility = 0;
    assert!(scene.steps_until(5, Scene::is_alarmed).is_some());
}

#[test]
fn a_player_in_the_dark_is_not_seen_from_afar() {
    let mut scene = corridor(0);
    scene.target.visibility = 20;
    assert_eq!(scene.steps_until(900, |scene| scene.mood(0) != Mood::OnDuty), None);
    scene.target.has_light = true;
    assert!(scene.steps_until(900, Scene::is_alarmed).is_some());
}

#[test]
fn the_nearer_and_the_brighter_the_sooner() {
    let steps = |x: f64, visibility| {
        let mut scene = corridor(0);
        scene.put(x, 1.5);
        scene.target.visibility = visibility;
        scene.steps_until(2000, |scene| scene.mood(0) == Mood::Wondering).unwrap_or(2000)
    };
    let by_distance: Vec<u32> = (4..11).map(|x| steps(f64::from(x), 255)).collect();
    assert!(by_distance.is_sorted(), "{by_distance:?}");
    let by_light = [255, 200, 120, 60, 20].map(|light| steps(6.5, light));
    assert!(by_light.is_sorted() && by_light[0] < by_light[3], "{by_light:?}");
}

#[test]
fn doors_and_smoke_hide_and_glass_and_masks_do_not() {
    let alarmed = |between: char, clouds: &[Cloud]| {
        let rows = format!("##########\n#W..{between}..@.#\n##########");
        let mut scene = Scene::new(&rows, r#""W" = { guard = "warden", heading = 0 }"#);
        scene.clouds = clouds.to_vec();
        scene.steps_until(600, Scene::is_alarmed).is_some()
    };
    for transparent in ['.', '%', '|'] {
        assert!(alarmed(transparent, &[]), "{transparent}");
    }
    assert!(!alarmed('+', &[]) && !alarmed('#', &[]));
    let smoke = Cloud { position: DVec2::new(4.5, 1.5), radius: 1.5 };
    assert!(!alarmed('.', &[smoke]));
    let elsewhere = Cloud { position: DVec2::new(4.5, 4.5), ..smoke };
    assert!(alarmed('.', &[elsewhere]));
}

#[test]
fn the_dead_are_let_be() {
    let mut scene = corridor(0);
    scene.steps_until(600, Scene::is_alarmed).unwrap();
    scene.target.is_alive = false;
    scene.steps_until(60, |scene| !scene.is_alarmed()).unwrap();
    assert_eq!(scene.steps_until(600, Scene::is_alarmed), None);
}

#[test]
fn a_guard_who_has_fallen_is_seen_and_woken() {
    let mut scene = Scene::new(
        "##########\n#W....L..#\n#.......@#\n##########",
        "\"W\" = { guard = \"warden\", heading = 0 }\n\"L\" = { guard = \"listener\", heading = 0 }",
    );
    scene.target.is_alive = false;
    scene.guards.stun(1, 1200);
    assert!(scene.guard(1).is_down);
    scene.steps_until(200, |scene| scene.mood(0) == Mood::Wondering).unwrap();
    scene.steps_until(600, |scene| !scene.guard(1).is_down).unwrap();
    assert_eq!([0, 1].map(|index| scene.mood(index)), [Mood::Searching; 2]);
}

#[test]
fn who_is_stunned_gets_up_alone() {
    let mut scene = corridor(0);
    scene.target.is_alive = false;
    scene.guards.stun(0, 100);
    scene.steps_until(5, |scene| scene.guards.quiet_steps() != Some(0)).unwrap();
    let quiet = scene.guards.quiet_steps().unwrap();
    assert!((90..100).contains(&quiet), "{quiet}");
    scene.guards.wait(quiet);
    assert!(scene.guard(0).is_down);
    scene.step(&[]);
    assert_eq!(scene.mood(0), Mood::Searching);
}
