//! Taking time back: the state, the limits, and what scripts, saved games and results say about it.

use std::io::{self, Write};
use std::sync::{Arc, Mutex};

use super::missions::{danger, dead, text};
use super::titles::titled;
use super::*;
use crate::app::Offers;
use crate::app::recording::RunLog;
use crate::app::store::{Run, replayed};
use crate::game::{Header, Intents, Outcome, Script, ScriptWriter};
use crate::map::builtin;

const BACK: Key = Key::Backspace;
/// The number of steps that are taken back at once.
const STEPS: u64 = 600;

/// A game in the built-in level called `level`, played with keys that report releases, or with the
/// repetitions of a keyboard.
fn playing(level: &str, difficulty: Difficulty, rate: Option<Rate>) -> Rig {
    let index = builtin::LEVELS.iter().position(|it| it.name == level).unwrap();
    let mut app = App::opened(
        InitialState::Title(Offers::default()),
        Settings::default(),
        Store::in_memory(),
    );
    app.difficulty = difficulty;
    app.begin_builtin(index);
    let mut rig = Rig::of(app, rate);
    assert_eq!(rig.app.screen(), AppScreen::Playing);
    rig.wait(100);
    rig
}

/// Walks, turns, strikes and waits for some seconds.
fn roam(rig: &mut Rig, seconds: u64) {
    for turn in 0..seconds {
        rig.press(W);
        rig.wait(600);
        rig.release(W);
        rig.tap(if turn % 3 == 0 { Key::Left } else { Key::Char('f') }, 100);
        rig.wait(300);
    }
}

fn steps(rig: &Rig) -> u64 {
    rig.app.log.steps
}

/// Presses the key that takes time back, as a press that cannot be a repetition.
fn take_back(rig: &mut Rig) {
    rig.press(BACK);
    rig.release(BACK);
}

#[test]
fn taking_back_returns_the_state_of_ten_seconds_ago_and_the_same_intents_lead_on_from_it() {
    for (level, rate) in [("cellar", None), ("museum", Some((500, 30))), ("citadel", None)] {
        let mut rig = playing(level, Difficulty::Easy, rate);
        roam(&mut rig, 22);
        assert_eq!(rig.app.screen(), AppScreen::Playing, "{level}");
        for _ in 0..2 {
            let (now, after) = (steps(&rig), rig.game().clone());
            let lost: Vec<Intents> = rig.app.log.since(now - STEPS).collect();
            take_back(&mut rig);
            assert_eq!((steps(&rig), rig.app.screen()), (now - STEPS, AppScreen::Playing));
            let mut again = rig.game().clone();
            for &intents in &lost {
                again.step(intents);
            }
            assert_eq!(again.checksum(), after.checksum(), "{level}");
            // Until then, another press may be a repetition.
            rig.wait(3000);
        }
        // A game from the start agrees, too.
        let mut replayed = rig.app.levels.stage.begin(Difficulty::Easy).unwrap();
        rig.app.log.since(0).for_each(|intents| replayed.step(intents));
        assert_eq!(replayed.grid().unwrap().checksum(), rig.game().checksum());
    }
}

#[test]
fn the_difficulty_limits_how_often_time_is_taken_back() {
    for (difficulty, most) in
        [(Difficulty::Easy, 8), (Difficulty::Normal, 3), (Difficulty::Hard, 0)]
    {
        let mut rig = playing("cellar", difficulty, None);
        for count in 0..8 {
            rig.wait(2000);
            let before = steps(&rig);
            take_back(&mut rig);
            let is_back = steps(&rig) < before;
            assert_eq!(is_back, count < most, "{difficulty:?}: {count}");
            rig.wait(700);
        }
        assert_eq!(rig.app.log.taken_back, most);
        let said = match difficulty {
            Difficulty::Easy => "Ten seconds taken back",
            Difficulty::Normal => "Time was taken back three times, which is the maximum",
            Difficulty::Hard => "Time cannot be taken back on hard",
        };
        let shown = text(&mut rig.app, 140, 24);
        assert!(shown.contains(said), "{shown}");
        // A new run begins anew.
        rig.app.restart_level();
        assert_eq!(rig.app.log.taken_back, 0);
    }
}

#[test]
fn a_held_key_takes_time_back_once() {
    for rate in [None, Some((250, 40)), Some((500, 30)), Some((660, 15))] {
        let mut rig = playing("cellar", Difficulty::Easy, rate);
        rig.wait(30_000);
        rig.press(BACK);
        if rate.is_none() {
            (0..30).for_each(|_| rig.send(BACK, Phase::Repeat));
        }
        rig.wait(2000);
        rig.release(BACK);
        rig.wait(1000);
        assert_eq!(rig.app.log.taken_back, 1, "{rate:?}");
        take_back(&mut rig);
        rig.wait(300);
        take_back(&mut rig);
        rig.wait(300);
        assert_eq!(rig.app.log.taken_back, 3, "{rate:?}");
    }
}

#[test]
fn nothing_is_taken_back_in_a_descent_or_before_the_first_step() {
    let offers = Offers { today: Some(20_261_122), seed: 7, ..Offers::default() };
    let mut rig = titled(offers, Store::in_memory());
    rig.choose("Endless");
    rig.wait(1000);
    let before = steps(&rig);
    take_back(&mut rig);
    assert_eq!((steps(&rig), rig.app.log.taken_back), (before, 0));
    let shown = text(&mut rig.app, 120, 24);
    assert!(shown.contains("Time cannot be taken back here"), "{shown}");
    let mut rig = playing("cellar", Difficulty::Easy, None);
    rig.app.log = RunLog::default();
    take_back(&mut rig);
    assert_eq!(rig.app.log.taken_back, 0);
}

#[test]
fn a_dead_player_can_take_time_back() {
    let mut rig = dead();
    let (now, deaths) = (steps(&rig), rig.game().tally().deaths);
    rig.wait(1000);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("Take back 10 s  3 left"), "{shown}");
    rig.choose("Take back 10 s");
    assert_eq!((deaths, rig.game().tally().deaths), (1, 0));
    assert_eq!(rig.game().outcome(), Outcome::Playing);
    assert!(steps(&rig) < now);
    assert_eq!(rig.app.screen(), AppScreen::Playing);
}

/// The text that a recorder has written.
#[derive(Clone, Default)]
struct Written(Arc<Mutex<Vec<u8>>>);

impl Write for Written {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A player who has taken time back, and then won the map with the spikes.
fn won_after_taking_back(written: &Written) -> Rig {
    let mut rig = danger();
    let output: Box<dyn Write> = Box::new(written.clone());
    let header = Header { seed: Some(0), ..Header::default() };
    let mut script = ScriptWriter::with_header(output, header);
    for intents in rig.app.log.since(0) {
        script.record(intents, 1).unwrap();
    }
    rig.app.script = Some(script);
    rig.tap(Key::Right, 30);
    rig.wait(3000);
    take_back(&mut rig);
    rig.tap(Key::Char('r'), 30);
    rig.tap(Key::Char('g'), 30);
    while rig.app.screen() != AppScreen::LevelDone {
        assert!(rig.now < Duration::from_mins(1), "at {}", rig.position());
        if rig.app.screen() == AppScreen::Dead {
            rig.wait(700);
            rig.choose("Take back 10 s");
            rig.tap(Key::Char('g'), 30);
        }
        rig.wait(1);
    }
    rig
}

#[test]
fn the_script_of_a_run_with_time_taken_back_leads_to_its_result() {
    let written = Written::default();
    let mut rig = won_after_taking_back(&written);
    let count = rig.app.log.taken_back;
    assert!(count > 0);
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains(&format!("with {count} taken back")), "{shown}");
    let level = rig.app.levels.stage.name().unwrap().to_owned();
    let kept = rig.app.store.script(&level, Difficulty::Normal).unwrap();
    rig.app.script.take().unwrap().finish().unwrap();
    let recorded = String::from_utf8(written.0.lock().unwrap().clone()).unwrap();
    for text in [kept, recorded] {
        let script = Script::parse(&text, "it").unwrap_or_else(|faults| panic!("{faults}"));
        assert_eq!(script.header().taken_back, count, "{text}");
        let world = rig.app.levels.stage.begin(Difficulty::Normal).unwrap();
        let world = world.grid().unwrap().world().clone();
        let game = replayed(world, script.header().rules(), &script);
        assert_eq!((game.outcome(), game.checksum()), (Outcome::Won, rig.game().checksum()));
    }
    rig.app.leave();
    let left = rig.app.left.unwrap();
    assert!(left.ends_with(&format!("{count} taken back")), "{left}");
}

#[test]
fn a_saved_game_keeps_the_count() {
    let mut rig = playing("cellar", Difficulty::Normal, Some((500, 30)));
    roam(&mut rig, 3);
    take_back(&mut rig);
    roam(&mut rig, 12);
    take_back(&mut rig);
    rig.wait(500);
    let left = rig.game().checksum();
    rig.app.return_to_title();
    rig.choose("Continue");
    assert_eq!((rig.app.screen(), rig.app.log.taken_back), (AppScreen::Playing, 2));
    let since = steps(&rig);
    take_back(&mut rig);
    assert!(steps(&rig) < since, "the past of a saved game is known");
    rig.wait(1000);
    take_back(&mut rig);
    assert_eq!(rig.app.log.taken_back, 3);
    assert_ne!(left, rig.game().checksum());
}

#[test]
fn a_result_without_time_taken_back_replaces_results_with_it() {
    let tally =
        |seconds: u64, taken_back| Tally { steps: seconds * 60, taken_back, ..Tally::default() };
    let run = |tally, rank| Run { tally, rank, script: String::new() };
    let with = run(tally(60, 2), Rank::Ghost);
    let without = run(tally(90, 0), Rank::Thief);
    let level = builtin::LEVELS[0].name;
    for runs in [[&with, &without], [&without, &with]] {
        let mut store = Store::in_memory();
        for &run in &runs {
            store.record(level, Difficulty::Normal, run.clone());
        }
        let best = *store.best(level, Difficulty::Normal).unwrap();
        assert_eq!((best.tally, best.rank), (without.tally, Rank::Thief));
    }
    let mut store = Store::in_memory();
    store.record(level, Difficulty::Normal, with);
    let mut rig = titled(Offers::default(), store);
    rig.choose("Levels");
    let shown = text(&mut rig.app, 80, 24);
    assert!(shown.contains("2 taken back  1:00.0   Ghost"), "{shown}");
}
