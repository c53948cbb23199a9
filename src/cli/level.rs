//! The level of a command.

use std::ffi::OsStr;
use std::path::Path;
use std::{io, iter};

use super::arguments::{Generated, STANDARD_INPUT, subcommand_names};
use super::watch::Watch;
use super::{Error, own_maps};
use crate::app::Levels;
use crate::fault::nearest;
use crate::game::{Game, Header, LevelName};
use crate::generate::{Site, Window, descent, floors_below};
use crate::map::{self, Folder, Level, builtin};
use crate::world::World;

/// As [`load`], for a command that needs a grid.
pub fn load_grid(argument: Option<&OsStr>) -> Result<World, Error> {
    grid_of(load(argument)?, &argument.unwrap_or_default().to_string_lossy())
}

/// The world of the level `name`, for a command that needs a grid.
pub(crate) fn grid_of(level: Level, name: &str) -> Result<World, Error> {
    match level {
        Level::Grid(world) => Ok(*world),
        Level::Space(_) => {
            let message = "is a map of bodies, and this command needs one with a grid";
            Err(Error::mistake(format!("{name} {message}")))
        }
    }
}

/// The level that `argument` names: a built-in level or a map file; without it, the first built-in
/// level.
pub(crate) fn load(argument: Option<&OsStr>) -> Result<Level, Error> {
    let of_grid = |level: &builtin::Level| Ok(Level::from(level.world()?));
    let Some(argument) = argument else { return of_grid(&builtin::LEVELS[0]) };
    if let Some(index) = builtin_level(argument) {
        return of_grid(&builtin::LEVELS[index]);
    }
    if argument == STANDARD_INPUT {
        let input = io::stdin().lock();
        return Ok(map::read_level(input, "<standard input>", &Folder::of(Path::new("")))?);
    }
    let path = Path::new(argument);
    match similar_name(argument).filter(|_| !path.exists()) {
        Some(meant) => Err(Error::mistake(format!(
            "there is no map \"{}\"; did you mean {meant}?",
            argument.display()
        ))),
        None => Ok(map::load_level(path)?),
    }
}

/// The level in the file that `argument` names, and its [`Watch`]. Only files can change.
pub(crate) fn watch(
    argument: Option<&OsStr>,
    generated: Option<Generated>,
) -> Result<(Level, Watch), Error> {
    let is_file = |name: &OsStr| name != STANDARD_INPUT && Path::new(name).is_file();
    match argument {
        Some(name) if generated.is_none() && is_file(name) => {
            let (level, watch) = Watch::load(Path::new(name));
            Ok((level?, watch))
        }
        // A name that looks like a map reports why it cannot be loaded.
        Some(name) if name != STANDARD_INPUT && builtin_level(name).is_none() => {
            load(argument).and_then(|_| Err(Error::mistake(NOTHING_TO_WATCH)))
        }
        _ => Err(Error::mistake(NOTHING_TO_WATCH)),
    }
}

const NOTHING_TO_WATCH: &str =
    "--watch needs a map file, as in \"cellcaster play my.toml --watch\": nothing else changes";

/// The level that `argument` names; if it is built in, followed by the later ones.
pub fn load_series(argument: Option<&OsStr>) -> Result<Levels, Error> {
    if let Some(levels) = argument.map_or(Some(0), builtin_level).and_then(Levels::builtin) {
        return Ok(levels);
    }
    let level = load(argument)?;
    let path = argument.filter(|argument| *argument != STANDARD_INPUT).map(Path::new);
    // What is no file, such as a pipe, cannot be found again.
    Ok(match path.and_then(|path| own_maps::own_level(path, level.clone())) {
        Some(own) => Levels::own(own),
        None => Levels::new(level, iter::empty()),
    })
}

/// As [`load_series`], or the generated level followed by those of the next seeds.
pub(crate) fn load_or_generate(
    map: Option<&OsStr>,
    generated: Option<Generated>,
) -> Result<Levels, Error> {
    let Some(generated) = generated else { return load_series(map) };
    let Generated { generator, seed, extent, start } = generated;
    let game = move |seed: u64, start: Option<Site>| {
        let level = generator.level(seed, extent)?;
        let start = start.or(level.start()).unwrap_or_default();
        Game::in_level(level, start).ok_or_else(|| Error::mistake(NO_START))
    };
    let first = game(seed, start)?;
    let later = (1..).map_while(move |by| game(seed.wrapping_add(by), None).ok());
    Ok(Levels::of_games(first, later))
}

/// The levels of a script: those that the options name, or else that of its header.
pub(crate) fn of_script(
    map: Option<&OsStr>,
    generated: Option<Generated>,
    header: &Header,
) -> Result<Levels, Error> {
    let rules = header.rules();
    match &header.level {
        Some(name) if map.is_none() && generated.is_none() => {
            if let Some(first) = name.floor() {
                let game = move |world| Game::with_rules(world, rules);
                let later = floors_below(rules.seed, first);
                return Ok(Levels::of_games(game(descent(rules.seed, first)?), later.map(game)));
            }
            let world = match load_named(name, rules.seed)? {
                Level::Grid(world) => *world,
                level @ Level::Space(_) => return Ok(Levels::new(level, iter::empty())),
            };
            let index = builtin_level(OsStr::new(name.as_str()));
            let later = index.map_or(&[][..], |index| &builtin::LEVELS[index + 1..]);
            let later = later.iter().map_while(|level| level.world().ok());
            let game = move |world| Game::with_rules(world, rules);
            let levels = Levels::of_games(game(world), later.map(game));
            Ok(match index {
                Some(index) => levels.numbered(index + 1, builtin::LEVELS.len()),
                None => levels,
            })
        }
        _ => load_or_generate(map, generated),
    }
}

/// The level that a script's header names.
pub(crate) fn load_named(name: &LevelName, seed: u64) -> Result<Level, Error> {
    match name.floor() {
        Some(floor) => Ok(Level::from(descent(seed, floor)?)),
        None => load(Some(OsStr::new(name.as_str()))),
    }
}

/// The name of the level that `argument` names, for a script's header. Standard input has none.
pub(crate) fn name(argument: Option<&OsStr>) -> Option<LevelName> {
    match argument {
        None => LevelName::new(builtin::LEVELS[0].name),
        Some(name) if name == STANDARD_INPUT => None,
        Some(name) => LevelName::new(name.to_str()?),
    }
}

/// The part of a generated level around `site`, or around its start.
pub(crate) fn generate(generated: Generated, site: Option<Site>) -> Result<(Window, World), Error> {
    let level = generated.generator.level(generated.seed, generated.extent)?;
    let site = site.or(level.start()).unwrap_or_default();
    Window::open(level, site).ok_or_else(|| Error::mistake(NO_START))
}

const NO_START: &str =
    "there is nowhere to stand at --start or --camera: that is outside the level";

/// The index of the built-in level `name`. A file of this name takes precedence.
fn builtin_level(name: &OsStr) -> Option<usize> {
    let index = builtin::LEVELS.iter().position(|level| name == level.name)?;
    (!Path::new(name).exists()).then_some(index)
}

/// The command or built-in level with a name similar to `name`.
fn similar_name(name: &OsStr) -> Option<&'static str> {
    let levels = builtin::LEVELS.iter().map(|level| level.name);
    let known: Vec<&str> = subcommand_names().chain(levels).collect();
    nearest(name.to_str()?, &known)
}
