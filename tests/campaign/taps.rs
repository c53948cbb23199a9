//! The scripts of taps: ways through the first levels that can be typed in a terminal without key
//! releases. `tests/terminal/play/campaign.rs` types them.
//!
//! `CELLCASTER_UPDATE_TAPS=1 cargo test --release --test campaign taps` searches for new scripts.

use std::path::PathBuf;
use std::{env, fs};

use cellcaster::game::{Game, Intents, Look, Outcome, Rules, Script};
use cellcaster::map::builtin::{self, BuiltinLevel};
use cellcaster::world::Difficulty;

use crate::careful;
use crate::levels::{self, route};
use crate::pilot::Pilot;

/// The number of levels with a script, and the rules of the scripts.
const LEVELS: usize = 3;
const RULES: Rules = Rules { difficulty: Difficulty::Easy, seed: 0 };
/// The steps for which the player looks around first.
const LOOK: u32 = 60;

fn path(level: &BuiltinLevel) -> PathBuf {
    let name = format!("tests/terminal/taps/{}.script", level.name);
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Searches for a script, and writes it.
fn update(level: &BuiltinLevel) {
    let mut pilot = Pilot::tapping(Game::with_rules(levels::world(level), RULES));
    pilot.wait(LOOK);
    let pilot = careful::search(&pilot, &route(level))
        .unwrap_or_else(|failure| panic!("{}: nothing found{failure}", level.name));
    let header = format!("level {}\ndifficulty {}\nseed 0\n", level.name, RULES.difficulty.name());
    fs::write(path(level), header + &pilot.script()).unwrap();
}

#[test]
fn taps_win_the_first_levels() {
    for level in &builtin::LEVELS[..LEVELS] {
        if env::var_os("CELLCASTER_UPDATE_TAPS").is_some() {
            update(level);
        }
        let text = fs::read_to_string(path(level)).unwrap();
        let script = Script::parse(&text, level.name).unwrap_or_else(|faults| panic!("{faults}"));
        let mut game = Game::with_rules(levels::world(level), RULES);
        script.iter().for_each(|(_, intents)| game.step(intents));
        assert_eq!(game.outcome(), Outcome::Won, "{}", level.name);
        let is_typed =
            |intents: Intents| intents.iter().count() <= 1 && intents.look() == Look::NONE;
        assert!(script.iter().all(|(_, intents)| is_typed(intents)), "{}", level.name);
    }
}
