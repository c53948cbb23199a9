//! `cellcaster replay --verify`: plays a script off screen and says what it achieves.

use std::fmt::{self, Write as _};
use std::io::{self, Write};

use super::arguments::Replay;
use super::{Error, level};
use crate::app::store::{DescentRun, replayed};
use crate::app::time::{of_steps, tenths};
use crate::game::{Game, Header, LevelName, Outcome, Rules, Script};
use crate::world::World;

/// Writes what `script` achieves in the level that `options` or its header name.
///
/// # Errors
/// With exit status 1 if it does not reach an exit.
pub(crate) fn run(options: &Replay, script: &Script) -> Result<(), Error> {
    let (name, world) = level(options, script.header())?;
    let rules = script.header().rules();
    let floor = script.header().level.as_ref().and_then(LevelName::floor);
    let (report, wins) = match floor.filter(|_| options.map.is_none()) {
        Some(floor) => descend(&name, floor, world, rules, script),
        None => play(&name, world, rules, script),
    };
    io::stdout().write_all(report.as_bytes()).map_err(|error| Error::of_output(&error))?;
    if wins { Ok(()) } else { Err(Error::failed()) }
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

/// A report about the script in one level, and whether it reaches the exit.
fn play(name: &str, world: World, rules: Rules, script: &Script) -> (String, bool) {
    let game = replayed(world, rules, script);
    let mut report = Report::about(name, game.world().title(), rules);
    report.tell_outcome(&game);
    let tally = game.tally();
    let par = game.world().par();
    let par_time = par.map(|par| tenths(par.into()));
    let par_time = par_time.map_or(String::new(), |par| format!(", par {par}"));
    report.line("time", format!("{} ({} steps{par_time})", of_steps(tally.steps), tally.steps));
    report.line("treasure", format!("{} of {}", tally.treasure.found, tally.treasure.total));
    report.line("secrets", format!("{} of {}", tally.secrets.found, tally.secrets.total));
    report.line("alarms", tally.alarms);
    report.line("deaths", tally.deaths);
    report.line("stunned", tally.stunned);
    if game.is_finished() {
        report.line("rank", tally.rank(par));
    }
    (report.0, game.is_finished())
}

/// A report about the script in a descent from `floor` on, and whether it reaches an exit.
fn descend(name: &str, floor: u32, first: World, rules: Rules, script: &Script) -> (String, bool) {
    let DescentRun { game, reached } = DescentRun::replayed(floor, first, rules, script);
    let mut report = Report::about(name, "", rules);
    report.tell_outcome(&game);
    report.line("floors", reached.floors);
    report.line("time", format!("{} ({} steps)", of_steps(reached.steps), reached.steps));
    report.line("treasure", reached.treasure);
    (report.0, reached.floors > 0)
}

/// Lines of a name and a value.
struct Report(String);

impl Report {
    fn about(name: &str, title: &str, rules: Rules) -> Self {
        let mut report = Self(String::new());
        report.line("level", name.replace(char::is_control, "?"));
        if !title.is_empty() {
            report.line("title", title.replace(char::is_control, "?"));
        }
        report.line("difficulty", rules.difficulty.name());
        report.line("seed", rules.seed);
        report
    }

    fn tell_outcome(&mut self, game: &Game) {
        let result = match game.outcome() {
            Outcome::Won => "won".to_owned(),
            Outcome::Dead { cause } => format!("dead: {cause}"),
            Outcome::Playing => "not won".to_owned(),
        };
        self.line("result", result);
    }

    fn line(&mut self, name: &str, value: impl fmt::Display) {
        _ = writeln!(self.0, "{name:<10} {value}");
    }
}
