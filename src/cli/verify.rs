//! `cellcaster replay --verify`: plays a script off screen and says what it achieves.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::arguments::Replay;
use super::{Error, level};
use crate::game::{Game, Header, Outcome, Rules, STEPS_PER_SECOND, Script};
use crate::world::World;

/// Writes what `script` achieves in the level that `options` or its header name.
///
/// # Errors
/// With exit status 1 if it does not win.
pub(super) fn run(options: &Replay, script: &Script) -> Result<(), Error> {
    let (name, world) = level(options, script.header())?;
    let rules = script.header().rules();
    let mut game = Game::with_rules(world, rules);
    for (_section, intents) in script.iter() {
        if game.is_finished() {
            break;
        }
        game.step(intents);
    }
    let report = report(&name, rules, &game);
    io::stdout().write_all(report.as_bytes()).map_err(|error| Error::of_output(&error))?;
    if game.is_finished() { Ok(()) } else { Err(Error::failed()) }
}

/// A number of steps as minutes and seconds with one digit.
pub(super) fn clock(steps: u64) -> String {
    let tenths = steps * 10 / u64::from(STEPS_PER_SECOND);
    format!("{}:{:02}.{}", tenths / 600, tenths / 10 % 60, tenths % 10)
}

/// The level that the options name, or else the header; and its name.
fn level(options: &Replay, header: &Header) -> Result<(String, World), Error> {
    if options.generated.is_some() {
        return Err(Error::mistake(
            "--verify plays a script in the level of its header or in MAP: leave out --generate",
        ));
    }
    match (&options.map, &header.level) {
        (Some(map), _) => Ok((map.display().to_string(), level::load_grid(Some(map))?)),
        (None, Some(named)) => {
            let level = level::load_named(named, header.rules().seed)?;
            Ok((named.as_str().to_owned(), level::grid_of(level, named.as_str())?))
        }
        (None, None) => Err(Error::mistake(
            "the script does not name its level: name it after the script, as in \
             \"cellcaster replay walk.script cellar --verify\"",
        )),
    }
}

fn report(name: &str, rules: Rules, game: &Game) -> String {
    let tally = game.tally();
    let world = game.world();
    let mut text = String::new();
    let mut line = |name: &str, value: String| _ = writeln!(text, "{name:<10} {value}");
    line("level", name.replace(char::is_control, "?"));
    if !world.title().is_empty() {
        line("title", world.title().replace(char::is_control, "?"));
    }
    line("difficulty", rules.difficulty.name().to_owned());
    line("seed", rules.seed.to_string());
    let result = match game.outcome() {
        Outcome::Won => "won".to_owned(),
        Outcome::Dead { cause } => format!("dead: {cause}"),
        Outcome::Playing => "not won".to_owned(),
    };
    line("result", result);
    let par = world.par().map(|par| clock(u64::from(par) * u64::from(STEPS_PER_SECOND)));
    let par = par.map_or(String::new(), |par| format!(", par {par}"));
    line("time", format!("{} ({} steps{par})", clock(tally.steps), tally.steps));
    line("treasure", format!("{} of {}", tally.treasure.found, tally.treasure.total));
    line("secrets", format!("{} of {}", tally.secrets.found, tally.secrets.total));
    line("alarms", tally.alarms.to_string());
    line("deaths", tally.deaths.to_string());
    line("stunned", tally.stunned.to_string());
    if game.is_finished() {
        line("rank", tally.rank(world.par()).to_string());
    }
    text
}
