//! Reading runs, and moving through them.

use std::iter;

use proptest::prelude::*;

use super::*;
use crate::app::Levels;
use crate::app::playback::script::ScriptRecord;
use crate::app::played::Played;
use crate::game::{Game, Script};
use crate::generate::{Extent, Generator};
use crate::map::{Level, builtin, parse_str};
use crate::space::Scene;
use crate::world::{Difficulty, FieldOfView};

const WINS: &str = include_str!("../../../../maps/scripts/cellar.normal.script");

fn script(text: &str) -> Script {
    Script::parse(text, "it").unwrap_or_else(|faults| panic!("{faults}"))
}

/// A run that was read to its end, and its first state.
fn read(levels: Levels, script: &Script) -> (Reader<ScriptRecord>, Played) {
    let record = ScriptRecord::new(levels, script, Difficulty::default());
    let (mut run, start) = Reader::new(record).unwrap();
    while !run.is_read() {
        run.read(&|| false);
    }
    (run, start)
}

/// The properties by which two states differ.
fn state(played: &Played) -> (Option<u64>, String) {
    let place = format!("{:?}", played.viewpoint(FieldOfView::default()));
    (played.grid().map(Game::checksum), place)
}

/// Compares seeking to each of these steps with playing there.
fn check(levels: Levels, script: &Script, steps: &[u64]) {
    let (mut run, start) = read(levels, script);
    let (mut played, mut game) = (Cursor::default(), start.clone());
    let mut states = vec![state(&game)];
    while played.step < run.steps() {
        run.step(&mut played, &mut game);
        states.push(state(&game));
    }
    let (mut cursor, mut game) = (Cursor::default(), start);
    for step in steps {
        let step = step % states.len() as u64;
        // A jump that takes too long is interrupted, and goes on.
        while !run.seek(step, (&mut cursor, &mut game), &|| true) {}
        assert_eq!(cursor.step, step);
        assert!(state(&game) == states[step as usize], "step {step} of {}", run.steps());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8))]

    #[test]
    fn seeking_leads_to_the_state_that_playing_leads_to(
        steps in prop::collection::vec(any::<u64>(), 1..12),
    ) {
        let both = format!("{WINS}\n4 s forward run\n2 s turn-left\n9 s forward open\n");
        check(Levels::builtin(0).unwrap(), &script(&both), &steps);
    }
}

#[test]
fn every_kind_of_level_can_be_sought() {
    let script = script("20 s forward run\n3 s turn-left\n30 s forward\n1 s jump\n9 s back\n");
    let steps = [3000, 10, 1200, 1199, 1201, 600, 3600, 0, 3779];
    check(Levels::new(Level::Space(Scene::default()), iter::empty()), &script, &steps);
    let level = Generator::ALL[0].level(7, Extent::default()).unwrap();
    let start = level.start().unwrap_or_default();
    let game = Game::in_level(level, start).unwrap();
    check(Levels::of_games(game, iter::empty()), &script, &steps);
    check(Levels::floors(7, 3), &script, &steps);
}

#[test]
fn a_run_ends_with_its_last_level() {
    let script = script(&format!("{WINS}\n60 s stand\n"));
    let level = builtin::LEVELS[0].world().unwrap();
    let (run, _) = read(Levels::new(level.into(), iter::empty()), &script);
    assert!(run.steps() + 3600 <= script.steps());
    let last = run.marks.last().unwrap();
    assert_eq!((last.kind, last.step), (MarkKind::End, run.steps()));
    let finds = run.marks.iter().filter(|mark| mark.kind == MarkKind::Find).count();
    assert!(finds > 1, "{:?}", run.marks);
}

#[test]
fn the_states_of_a_long_run_lead_to_every_step() {
    let text = "grid = '''\n#######\n#@....#\n#######\n'''\n[tiles]\n\"#\" = { wall = \"brick\" }\n\
                [things]\n\"@\" = { start = 0 }\n";
    let world = parse_str(text).unwrap_or_else(|faults| panic!("{faults}"));
    let script = script(&"70 s turn-left\n50 s forward turn-right\n".repeat(90));
    let (mut run, start) = read(Levels::new(Level::Grid(Box::new(world)), iter::empty()), &script);
    assert_eq!(run.steps(), 3 * 60 * 60 * 60);
    let (mut cursor, mut sought) = (Cursor::default(), start.clone());
    let (mut played, mut game) = (Cursor::default(), start);
    assert!(run.seek(500_000, (&mut cursor, &mut sought), &|| false));
    while played.step < 500_000 {
        run.step(&mut played, &mut game);
    }
    assert!(state(&sought) == state(&game));
}
