//! Falls, water, spikes, and blows.

use super::*;
use crate::game::health::Harm;
use crate::world::Difficulty;

#[test]
fn a_fall_hurts_by_its_height() {
    for (height, points) in [(-2.1, 6), (-3.0, 5), (-3.3, 4), (-6.0, 2), (-20.0, 0)] {
        let tiles = format!("v = {{ floor_height = {height} }}");
        let mut stage = Stage::new(&["@.vvvvvv"], &tiles, "");
        stage.walk_to(3).play(240, &[]);
        assert_eq!(stage.points(), points, "{height}");
    }
}

#[test]
fn water_is_slow_and_cold_and_puts_the_lamp_out() {
    let mut stage = Stage::new(&["@.~~~~~~~~"], "'~' = { water = true, floor = '#204060' }", "");
    stage.press(Intent::Lamp);
    assert!(stage.game.lamp_is_lit());
    stage.walk_to(2);
    assert!(!stage.game.lamp_is_lit());
    assert_eq!(stage.message(), "The water puts your lamp out.");
    stage.press(Intent::Lamp);
    assert_eq!(
        (stage.game.lamp_is_lit(), stage.message()),
        (false, "Your lamp does not burn in water.")
    );
    let before = stage.position().x;
    stage.play(60, &[Intent::Forward]);
    assert!((stage.position().x - before - 1.5).abs() < 0.1);
    stage.play(479 - 63, &[]);
    assert_eq!(stage.points(), 6);
    assert!(!stage.game.is_at_rest(Intents::new()));
    stage.play(2, &[]);
    assert_eq!((stage.points(), stage.message()), (5, "The water is cold."));
    stage.play(238, &[]);
    assert_eq!(stage.points(), 5);
    stage.play(1, &[]);
    assert_eq!(stage.points(), 4);
    stage.play(240 * 5, &[]);
    assert_eq!(stage.game.outcome(), Outcome::Dead { cause: "cold water" });
}

#[test]
fn spikes_hurt_once_for_each_thrust() {
    let mut stage = Stage::new(&["@s...."], "", "s = { spikes = 2, delay = 1 }");
    stage.walk_to(1);
    let points = |stage: &mut Stage, steps: usize| {
        (0..steps).map(|_| stage.play(1, &[]).points()).collect::<Vec<u8>>()
    };
    let first = points(&mut stage, 120);
    assert_eq!((first.first(), first.last()), (Some(&6), Some(&4)));
    assert_eq!(first.windows(2).filter(|pair| pair[0] != pair[1]).count(), 1);
    assert_eq!(points(&mut stage, 120).last(), Some(&2));
    assert_eq!(points(&mut stage, 120).last(), Some(&0));
    assert_eq!(stage.game.outcome(), Outcome::Dead { cause: "spikes" });
}

#[test]
fn the_nearest_spikes_are_heard_half_a_second_before_they_come_out() {
    let rows = ["#####", "#..s#", "#@..#", "#.s.#", "#s..#", "#####"];
    let mut stage = Stage::new(&rows, "", "s = { spikes = 2, delay = 1 }");
    let is_out = |stage: &Stage| stage.game.world().things()[0].frame == Some(2);
    let heard = stage.steps_until(60, &[], |stage| stage.hears(SoundKind::Spikes)).unwrap();
    let out = stage.steps_until(60, &[], is_out).unwrap();
    assert_eq!((heard, out), (31, 30));
    let heard: Vec<_> = stage.game.heard().iter().map(|it| it.bearing.degrees()).collect();
    assert!(matches!(heard[..], [bearing] if (bearing - 45.0).abs() < 1e-9), "{heard:?}");
    // Spikes are not heard behind a wall, and guards ignore them.
    let rows = ["########", "#@###s.#", "#####.g#", "########"];
    let things = "s = { spikes = 2 }\ng = { guard = 'listener', heading = 0 }";
    let mut stage = Stage::new(&rows, "", things);
    for _ in 0..480 {
        stage.play(1, &[]);
        assert!(!stage.hears(SoundKind::Spikes) && stage.guard(0).mood == Mood::OnDuty);
    }
}

#[test]
fn jumping_over_spikes_does_not_hurt() {
    let rows = ["@.s......"];
    let (things, difficulty) = ("s = { spikes = 1 }", Difficulty::Normal);
    let mut stage = Stage::with_header("par = 60\nceiling = 'sky'", &rows, "", things, difficulty);
    let is_out = |stage: &Stage| stage.game.world().things()[0].frame == Some(2);
    stage.play(50, &[]);
    let mut passes = false;
    for step in 0..40 {
        let runs = [Intent::Forward, Intent::Run, Intent::Jump];
        stage.play(1, if step < 8 { &runs[..2] } else { &runs });
        passes |= stage.cell().column == 2 && is_out(&stage);
    }
    assert!(passes && stage.cell().column > 2);
    assert_eq!(stage.points(), 6);
}

proptest! {
    #[test]
    fn the_first_blow_from_outside_the_view_never_kills(
        degrees in 0.0..360.0,
        from in (-3.0..3.0, -3.0..3.0).prop_map(DVec2::from),
        points in 1..=20_u8,
        health in 1..=6_u8,
    ) {
        let mut stage = Stage::new(&["@"], "", "");
        stage.game.step(Intents::new().with_look(Look { turn: (degrees * 50.0) as i16, tilt: 0 }));
        stage.game.player.health.points = health;
        let position = stage.position();
        let ahead = stage.game.player.motion.heading().direction();
        let off = ahead.angle_to(from).to_degrees().abs();
        prop_assume!((off - 33.0).abs() > 0.001);
        stage.game.hurt_by_bolt(0, position + from, points);
        let expected = health.saturating_sub(points).max(u8::from(off > 33.0));
        prop_assert_eq!(stage.points(), expected);
        prop_assert_eq!(stage.is_dead(), expected == 0);
    }

    /// Several guards strike from any direction at any time. A blow from inside the view kills. A
    /// blow from outside the view kills only three seconds after the first such blow by the same
    /// guard.
    #[test]
    fn no_blow_from_outside_the_view_kills_without_a_warning(
        blows in prop::collection::vec((0..3_usize, 0.0..360.0, 20..200_usize), 1..20),
    ) {
        let mut stage = Stage::new(&["@"], "", "");
        stage.game.player.health.points = 1;
        let mut first = [None; 3];
        for (guard, degrees, wait) in blows {
            stage.play(wait, &[]);
            let now = stage.game.steps;
            let from = Heading::from_degrees(degrees).unwrap().direction();
            stage.game.hurt_by_bolt(guard, stage.position() + from, 2);
            if stage.is_dead() {
                let is_seen = !(33.0..=327.0).contains(&degrees);
                prop_assert!(is_seen || first[guard].is_some_and(|first| now >= first + 180));
                break;
            }
            prop_assert!((33.0..=327.0).contains(&degrees));
            first[guard] = first[guard].or(Some(now));
        }
    }
}

/// A player with one point who looks at a wall, with a guard behind them.
#[test]
fn a_player_who_looks_away_is_warned_and_then_killed() {
    let rows = ["##########", "#......@##", "##########"];
    for (name, place) in [("warden", "g"), ("hound", "g"), ("archer", "g")] {
        let rows = rows.map(|row| row.replacen("#.", &format!("#{place}"), 1));
        let rows: Vec<&str> = rows.iter().map(String::as_str).collect();
        let guard = format!("g = {{ guard = '{name}', heading = 0 }}");
        let mut stage = Stage::played(&rows, "", &guard, Difficulty::Easy);
        stage.game.player.health.points = 1;
        let is_warned = |stage: &Stage| stage.message().starts_with("A blow from outside");
        stage.steps_until(1800, &[], is_warned).unwrap_or_else(|| panic!("{name}"));
        assert_eq!((stage.points(), stage.game.flash().unwrap().left), (1, 180), "{name}");
        let mut turned = Stage { game: stage.game.clone() };
        let killed = stage.steps_until(1200, &[], Stage::is_dead).unwrap();
        assert!((180..600).contains(&killed), "{name}: {killed}");
        // Three seconds are enough to turn around.
        turned.play(79, &[Intent::TurnRight]);
        let heading = turned.game.player.motion.heading().degrees();
        assert!((147.0..213.0).contains(&heading) && turned.points() == 1, "{name}: {heading}");
    }
}

#[test]
fn a_blow_says_where_it_comes_from() {
    let mut stage = Stage::new(&["@"], "", "");
    let position = stage.position();
    stage.game.hurt_by_bolt(0, position + DVec2::new(0.0, 2.0), 1);
    let flash = stage.game.flash().unwrap();
    let FlashKind::Hurt { bearing: Some(bearing) } = flash.kind else { panic!("{flash:?}") };
    assert!((bearing.degrees() - 90.0).abs() < 1e-9);
    let harm = Harm { points: 9, bearing: None, spares: false, cause: health::Cause::Fall };
    assert!(Health::default().after(&harm).is_gone());
}
