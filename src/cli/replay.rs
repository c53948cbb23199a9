//! `cellcaster replay`: shows the run of a script in the terminal, or reports its result.

use std::fmt::{self, Write as _};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::external::External;
use super::machine::open_store;
use super::options::LevelOptions;
use super::output_file::print;
use super::play::{about_the_terminal, say_farewell, take_keys_after_map};
use super::screen::ScreenOptions;
use super::{Error, level};
use crate::app;
use crate::app::status::{of_steps, tenths};
use crate::app::store::{DescentRun, replayed};
use crate::app::{InitialState, MAX_PLAYBACK_STEPS, Recording, Settings};
use crate::game::{Game, Header, LevelName, Outcome, Rules, STEPS_PER_SECOND, Script};
use crate::world::World;

/// Watch a script in the terminal, or check its result
///
/// Space pauses, the arrows move through the run, and "?" shows the other keys. Enter leaves the replay and plays on
/// from there; that game does not count.
///
/// A script has lines such as "2.5 s forward run" or "12 steps turn-left open". "stand" does nothing, a name in square
/// brackets begins a section, and # begins a comment. Lines at the top may name the game: "level cellar", "difficulty
/// hard" and "seed 7"; a level may also be a map file, or "floor 1" of an endless game, which continues with the next
/// floors. MAP takes precedence. play --record writes such a script, and share makes an animation of it.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster replay walk.script
  cellcaster replay walk.script my.toml
  cellcaster replay walk.script --verify")]
pub(crate) struct ReplayCommand {
    /// The script to play
    #[arg(value_hint = ValueHint::FilePath)]
    script: PathBuf,
    /// Print level, time, treasure and rank instead; the exit status is 0 if the script reaches an exit, else 1
    #[arg(long, conflicts_with = "generate")]
    verify: bool,
    #[command(flatten)]
    pub(crate) screen: ScreenOptions,
    #[command(flatten)]
    place: LevelOptions,
}

/// A walk through the built-in level with the most features, for commands that run without a
/// script.
pub const SHOWCASE: Showcase =
    Showcase { level: "citadel", script: include_str!("../../maps/showcase.script") };

/// A compiled-in script and its built-in level.
pub struct Showcase {
    /// The built-in level of the script.
    pub level: &'static str,
    script: &'static str,
}

impl Showcase {
    /// The parsed script.
    pub fn script(&self) -> Result<Script, Error> {
        Ok(Script::parse(self.script, "showcase.script")?)
    }
}

/// The first bytes in the recording of a server's room. The version follows them.
pub const ROOM_RECORDING: &str = "cellcaster-room ";

/// Shows the run, or writes the report that `options` select.
pub(crate) fn run(options: ReplayCommand) -> Result<(), Error> {
    if is_room_recording(&options.script) {
        let verify = options.verify.then(|| "--verify".into());
        let words = [verify, Some(options.script.into_os_string()), options.place.map];
        return External::room_replay(words.into_iter().flatten()).run();
    }
    let script = load(&options.script)?;
    if options.verify {
        return verify(&options.place, &script);
    }
    if script.steps() > MAX_PLAYBACK_STEPS {
        let hours = MAX_PLAYBACK_STEPS / (60 * 60 * u64::from(STEPS_PER_SECOND));
        return Err(Error::mistake(format!(
            "{} lasts longer than {hours} hours, the maximum for watching: \"share\" \
             shows a part of it",
            options.script.display()
        )));
    }
    let levels = Box::new(level::of_script(&options.place, script.header())?);
    take_keys_after_map(&options.place)?;
    let difficulty = Some(script.header().rules().difficulty);
    let settings = Settings { difficulty, ..options.screen.settings()? };
    let (store, damage) = open_store();
    let opening = InitialState::Playback { levels, script };
    let farewell = app::play(opening, settings, store, Recording::default());
    say_farewell(&farewell.map_err(about_the_terminal)?, damage);
    Ok(())
}

/// The size limit of a script in bytes: more than a week of play. A larger file is not read to its
/// end.
const MAX_LENGTH: u64 = 1 << 26;

/// Reads the script in a file.
pub fn load(path: &Path) -> Result<Script, Error> {
    let name = path.display().to_string();
    let mut content = Vec::new();
    let read = File::open(path).and_then(|file| file.take(MAX_LENGTH).read_to_end(&mut content));
    match read {
        Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
        Ok(length) if length as u64 == MAX_LENGTH => {
            Err(Error::mistake(format!("{name} is too long for a script")))
        }
        Ok(_) => Ok(Script::from_bytes(content, &name)?),
    }
}

/// Returns true if the file is the recording of a server's room. Only the server can replay it.
pub(crate) fn is_room_recording(path: &Path) -> bool {
    let mut beginning = [0; ROOM_RECORDING.len()];
    // An unreadable file is reported later, when the script is read.
    path.is_file()
        && File::open(path).is_ok_and(|mut file| file.read_exact(&mut beginning).is_ok())
        && beginning == ROOM_RECORDING.as_bytes()
}

/// Reports the result of `script` in the level from `place` or from the script's header.
///
/// # Errors
/// With exit status 1 if the script does not reach an exit.
fn verify(place: &LevelOptions, script: &Script) -> Result<(), Error> {
    let (name, world) = verified_level(place, script.header())?;
    let rules = script.header().rules();
    let floor = script.header().level.as_ref().and_then(LevelName::floor);
    let (report, wins) = match floor.filter(|_| place.map.is_none()) {
        Some(floor) => descend(&name, floor, world, rules, script),
        None => play(&name, world, rules, script),
    };
    print(report.as_bytes())?;
    if wins { Ok(()) } else { Err(Error::failed()) }
}

/// The name and the world of the level in the options or, if there is none, in the header.
fn verified_level(place: &LevelOptions, header: &Header) -> Result<(String, World), Error> {
    match (&place.map, &header.level) {
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

/// A report about the script in one level, and whether the script reaches the exit.
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
    if script.header().taken_back > 0 {
        report.line("taken back", script.header().taken_back);
    }
    if game.is_finished() {
        report.line("rank", tally.rank(par));
    }
    (report.0, game.is_finished())
}

/// A report about the script in a descent from `floor` on, and whether the script reaches an exit.
fn descend(name: &str, floor: u32, first: World, rules: Rules, script: &Script) -> (String, bool) {
    let DescentRun { game, reached } = DescentRun::replayed(floor, first, rules, script);
    let mut report = Report::about(name, "", rules);
    report.tell_outcome(&game);
    report.line("floors", reached.floors);
    report.line("time", format!("{} ({} steps)", of_steps(reached.steps), reached.steps));
    report.line("treasure", reached.treasure);
    (report.0, reached.floors > 0)
}

/// A report: lines with a name and a value.
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
