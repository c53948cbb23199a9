//! The scripts that win: their outcome, time and rank, and the exact state at their end.
//!
//! `CELLCASTER_UPDATE_SCRIPTS=1 cargo test --release --test campaign scripts` searches for new
//! scripts. `CELLCASTER_UPDATE_SCRIPTS=prison,clock.hard` does so only for some levels, or for
//! pairs of a level and a difficulty.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use cellcaster::game::{Game, Outcome, Rules, Script};
use cellcaster::map::builtin::{self, BuiltinLevel};
use cellcaster::world::Difficulty;

use crate::careful;
use crate::levels::{self, route};
use crate::pilot::Pilot;

/// The variable that requests new scripts.
const UPDATE: &str = "CELLCASTER_UPDATE_SCRIPTS";

fn path(level: &BuiltinLevel, difficulty: Difficulty) -> PathBuf {
    let name = format!("maps/scripts/{}.{}.script", level.name, difficulty.name());
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn runs() -> Vec<(&'static BuiltinLevel, Difficulty)> {
    let of_level = |level| Difficulty::ALL.map(|difficulty| (level, difficulty));
    builtin::LEVELS.iter().flat_map(of_level).collect()
}

/// The game after the script of a level.
fn replayed(level: &BuiltinLevel, difficulty: Difficulty) -> Result<Game, String> {
    let path = path(level, difficulty);
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let script = Script::parse(&text, level.name).unwrap_or_else(|faults| panic!("{faults}"));
    let mut game = Game::with_rules(levels::world(level), Rules { difficulty, seed: 0 });
    script.iter().for_each(|(_, intents)| game.step(intents));
    Ok(game)
}

/// Searches for a script that wins, and writes it.
fn update(level: &BuiltinLevel, difficulty: Difficulty) -> Result<String, String> {
    let name = format!("{}.{}", level.name, difficulty.name());
    let game = Game::with_rules(levels::world(level), Rules { difficulty, seed: 0 });
    let pilot = careful::search(&Pilot::new(game), &route(level))
        .map_err(|failure| format!("{name}: nothing found{failure}"))?;
    let header = format!("level {}\ndifficulty {}\nseed 0\n", level.name, difficulty.name());
    fs::write(path(level, difficulty), header + &pilot.script())
        .map_err(|error| format!("{name}: {error}"))?;
    Ok(format!("{name}: {} steps", pilot.steps()))
}

/// Searches for the scripts that [`UPDATE`] requests, in two threads.
fn update_all() {
    let Ok(wanted) = env::var(UPDATE) else { return };
    let is_wanted = |&(level, difficulty): &(&BuiltinLevel, Difficulty)| {
        let pair = format!("{}.{}", level.name, difficulty.name());
        wanted.split(',').any(|word| word == "1" || word == level.name || word == pair)
    };
    let runs: Vec<_> = runs().into_iter().filter(is_wanted).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        while let Some(&(level, difficulty)) = runs.get(next.fetch_add(1, Ordering::Relaxed)) {
            match update(level, difficulty) {
                Ok(line) | Err(line) => eprintln!("{line}"),
            }
        }
    };
    thread::scope(|scope| (0..2).for_each(|_| drop(scope.spawn(work))));
}

/// Describes the state at the end of a script in a line; `Err` if the script does not win.
fn line(level: &BuiltinLevel, difficulty: Difficulty) -> Result<String, String> {
    let name = format!("{} {}", level.name, difficulty.name());
    let game = replayed(level, difficulty)?;
    if game.outcome() != Outcome::Won {
        return Err(format!("{name}: {:?}", game.outcome()));
    }
    let tally = game.tally();
    let rank = tally.rank(game.world().par());
    let (treasure, health) = (game.treasure(), game.health().points);
    Ok(format!(
        "{name}: {:.1} s, {}, health {health}, alarms {}, treasure {}/{}, state {:016x}\n",
        game.elapsed(),
        rank.name(),
        tally.alarms,
        treasure.found,
        treasure.total,
        game.checksum()
    ))
}

/// A level's par time is about twice the time of its slowest script, which knows the way.
#[test]
fn par_times_fit_the_scripts() {
    for level in builtin::LEVELS {
        let times =
            Difficulty::ALL.map(|difficulty| replayed(level, difficulty).unwrap().elapsed());
        let slowest = times.into_iter().fold(0.0, f64::max);
        let par = f64::from(levels::world(level).par().unwrap());
        let range = 1.5 * slowest..=3.0 * slowest;
        assert!(range.contains(&par), "{}: par {par} s, slowest script {slowest:.1} s", level.name);
    }
}

#[test]
fn scripts_win_every_level_on_every_difficulty() {
    update_all();
    let (lines, faults): (Vec<_>, Vec<_>) = runs()
        .into_iter()
        .map(|(level, difficulty)| line(level, difficulty))
        .partition(Result::is_ok);
    let faults: Vec<String> = faults.into_iter().filter_map(Result::err).collect();
    assert!(faults.is_empty(), "{faults:#?}");
    insta::assert_snapshot!("scripts", lines.into_iter().flatten().collect::<String>());
}
