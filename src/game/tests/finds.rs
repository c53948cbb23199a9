//! Pickups, checkpoints, death and the exit.

use super::*;
use crate::world::{Difficulty, Supply};

#[test]
fn treasure_reports_its_worth_and_opens_the_exit() {
    let things =
        "a = { treasure = 10 }\nb = { treasure = 50 }\nc = { treasure = 100 }\nX = { exit = true }";
    let rows = ["@aX.b.c"];
    let mut stage =
        Stage::with_header("treasure_needed = 60", &rows, "", things, Difficulty::Normal);
    assert_eq!(stage.game.treasure(), Share { found: 0, total: 160 });
    assert_eq!(stage.walk_to(1).message(), "Coins: 10.");
    assert_eq!(stage.walk_to(2).message(), "The exit is closed: 50 gold missing.");
    assert_eq!(stage.walk_to(4).message(), "A golden cup: 50.");
    assert_eq!(stage.game.flash().map(|flash| flash.kind), Some(FlashKind::Gain));
    assert_eq!(stage.walk_to(6).message(), "A golden crown: 100.");
    assert_eq!(stage.game.treasure(), Share { found: 160, total: 160 });
    stage.press(Intent::AboutFace).play(40, &[]).walk_to(2);
    assert_eq!(stage.game.outcome(), Outcome::Won);
    assert_eq!(stage.game.tally().rank(None), Rank::Ghost);
}

#[test]
fn supplies_are_carried_up_to_nine_and_healing_only_helps_the_hurt() {
    let things = "p = { pebbles = 5 }\nd = { darts = 1 }\nf = { flasks = 2 }\nh = { healing = 2 }\nn = { note = \"Beware.\\nIt bites.\" }";
    let mut stage = Stage::new(&["@pphdfn."], "", things);
    assert_eq!(stage.game.supplies(Supply::Pebbles), 3);
    assert_eq!(stage.walk_to(1).message(), "5 pebbles.");
    stage.walk_to(2);
    assert_eq!(stage.game.supplies(Supply::Pebbles), 9);
    stage.walk_to(3);
    assert_eq!(stage.game.world().things().len(), 4);
    assert_eq!(stage.walk_to(4).message(), "A dart.");
    assert_eq!(stage.walk_to(5).message(), "2 flasks of smoke.");
    assert_eq!(stage.game.note(), None);
    stage.walk_to(6);
    assert_eq!(stage.game.note(), Some("Beware.\nIt bites."));
    stage.game.player.health.points = 3;
    stage.press(Intent::AboutFace).play(40, &[]).walk_to(3);
    assert_eq!((stage.points(), stage.message()), (5, "You feel better: 2 more health."));
}

/// A deadly pit behind a checkpoint and some treasure.
fn pit(difficulty: Difficulty) -> Stage {
    let tiles = "v = { floor_height = -12 }\n',' = { floor_height = -0.2 }";
    let things = "a = { treasure = 30, on = ',' }\nb = { treasure = 5 }\nc = { checkpoint = true }";
    Stage::played(&["@.b.c.a.v."], tiles, things, difficulty)
}

#[test]
fn a_dead_player_resumes_from_the_checkpoint() {
    for (difficulty, treasure, column) in [(Difficulty::Normal, 5, 4), (Difficulty::Hard, 0, 0)] {
        let mut stage = pit(difficulty);
        stage.walk_to(8).play(10, &[Intent::Forward]).play(180, &[]);
        assert_eq!(stage.game.outcome(), Outcome::Dead { cause: "a fall" });
        assert_eq!(stage.message(), "Killed by a fall.");
        let dead = stage.game.clone();
        stage.play(10, &[Intent::Forward]);
        assert_eq!(stage.game, dead);
        assert!(stage.game.is_at_rest(Intents::new()));
        stage.press(Intent::Retry);
        assert_eq!(stage.game.outcome(), Outcome::Playing);
        assert_eq!((stage.cell().column, stage.game.treasure().found), (column, treasure));
        assert_eq!(stage.points(), 6);
        assert_eq!(stage.game.tally().deaths, 1);
        assert!(stage.game.tally().steps >= dead.tally().steps);
        assert!(stage.game.revision() > dead.revision());
    }
}

#[test]
fn an_easy_game_has_harmless_falls_and_keeps_finds() {
    let mut stage = pit(Difficulty::Easy);
    stage.walk_to(8).play(10, &[Intent::Forward]).play(180, &[]);
    assert_eq!((stage.points(), stage.game.outcome()), (6, Outcome::Playing));
    // Simulates a death there.
    stage.game.player.killed_by = Some(health::Cause::Water);
    stage.press(Intent::Retry);
    assert_eq!((stage.cell().column, stage.game.treasure()), (4, Share { found: 35, total: 35 }));
}

#[test]
fn a_checkpoint_is_lit_once_it_is_reached() {
    let things = "a = { checkpoint = true }\nb = { checkpoint = true }";
    let mut stage = Stage::new(&["@a.b."], "", things);
    let frames = |stage: &Stage| -> Vec<Option<u8>> {
        stage
            .game
            .world()
            .things()
            .iter()
            .map(|thing| thing.frame.filter(|&frame| frame > 0))
            .collect()
    };
    assert_eq!(frames(&stage), [None, None]);
    assert_eq!(stage.walk_to(1).message(), "Checkpoint.");
    assert_eq!(frames(&stage), [Some(1), None]);
    stage.walk_to(3);
    assert_eq!(frames(&stage), [None, Some(1)]);
}

#[test]
fn a_retry_restores_the_checkpoint_but_not_clock_alarms_or_deaths() {
    let rows = ["@.c.a....vv", "###########", "..g........"];
    let things = "a = { treasure = 30 }\nc = { checkpoint = true }\ng = { guard = 'warden', heading = 0, wander = 4 }";
    let mut stage = Stage::new(&rows, "v = { floor_height = -12 }", things);
    stage.game.player.health.points = 1;
    stage.walk_to(2);
    let saved = stage.game.clone();
    stage.press(Intent::Throw).walk_to(9).play(10, &[Intent::Forward]).play(240, &[]);
    assert!(stage.is_dead() && stage.guard(0) != saved.guards().next().unwrap());
    stage.game.player.counts.alarms += 2;
    let dead = stage.game.tally();
    stage.play(1, &[Intent::Retry]);
    assert_eq!((stage.game.outcome(), stage.position()), (Outcome::Playing, position(&saved)));
    assert_eq!(stage.game.guards().next(), saved.guards().next());
    assert_eq!(stage.game.world().things(), saved.world().things());
    assert_eq!((stage.game.supplies(Supply::Pebbles), stage.game.treasure().found), (3, 0));
    assert_eq!(stage.points(), 3);
    let tally = stage.game.tally();
    assert_eq!((tally.steps, tally.alarms, tally.deaths), (dead.steps, 2, 1));
}

#[test]
fn no_checkpoint_is_reached_during_an_alarm() {
    let things = "c = { checkpoint = true }\nw = { guard = 'warden', heading = 180 }";
    let mut stage = Stage::new(&["@..c....w."], "", things);
    stage.steps_until(600, &[], |stage| stage.game.alarm() == Alarm::Raised).unwrap();
    assert_ne!(stage.walk_to(3).message(), "Checkpoint.");
    let checkpoint = stage.game.world().things_in(Cell { column: 3, row: 0 });
    assert_eq!(checkpoint.first().and_then(|thing| thing.frame).filter(|&it| it > 0), None);
}

#[test]
fn an_alarm_closes_the_exit_in_a_hard_game() {
    let rows = ["##########", "#@.X...w.#", "##########"];
    let things = "X = { exit = true }\nw = { guard = 'warden', heading = 180 }";
    for difficulty in Difficulty::ALL {
        let mut stage = Stage::played(&rows, "", things, difficulty);
        stage.steps_until(600, &[], |stage| stage.game.alarm() == Alarm::Raised).unwrap();
        stage.walk_to(3);
        let is_hard = difficulty == Difficulty::Hard;
        assert_eq!(stage.game.is_finished(), !is_hard, "{difficulty:?}");
        if is_hard {
            assert_eq!(stage.message(), "The exit is closed while the alarm is raised.");
            stage.game.guards.stun(0, 900);
            stage.play(1, &[]);
            assert_eq!(stage.game.outcome(), Outcome::Won);
        }
    }
}
