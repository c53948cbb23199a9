//! The level of a command: built in, generated, read from standard input, or one of the player's
//! map files.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::{fs, io, iter};

use super::Error;
use super::options::{COMMANDS, LevelOptions, STANDARD_INPUT};
use super::watch::MapWatcher;
use crate::app::store::map_key;
use crate::app::{Levels, OwnLevel, OwnMap};
use crate::fault::{Faults, nearest};
use crate::game::{Game, Header, LevelName};
use crate::generate::{Generator, Site, Window, descent};
use crate::map::{self, Folder, Level, TextureFiles, builtin, tiled};
use crate::sort;
use crate::world::World;

/// As [`load`], for commands that need a grid.
pub fn load_grid(argument: Option<&OsStr>) -> Result<World, Error> {
    grid_of(load(argument)?, &argument.unwrap_or_default().to_string_lossy())
}

/// The world of `level`. Returns an error that mentions `name` if the level has no grid.
pub(crate) fn grid_of(level: Level, name: &str) -> Result<World, Error> {
    match level {
        Level::Grid(world) => Ok(*world),
        Level::Space(_) => {
            let message = "is a map of bodies, but this command needs a map with a grid";
            Err(Error::mistake(format!("{name} {message}")))
        }
    }
}

/// The level called `argument`, which is a built-in level or a map file. Without an argument, the
/// first built-in level.
pub(crate) fn load(argument: Option<&OsStr>) -> Result<Level, Error> {
    let of_grid = |level: &builtin::BuiltinLevel| Ok(Level::from(level.world()?));
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
        None => Ok(load_file(path, &Folder::of(path))?),
    }
}

/// The text and the name of the map file or built-in level called `argument`.
pub(crate) fn text(argument: &OsStr) -> Result<(String, String), Error> {
    if let Some(index) = builtin_level(argument) {
        let level = builtin::LEVELS[index];
        return Ok((level.text.to_owned(), level.name.to_owned()));
    }
    let path = Path::new(argument);
    if tiled::is_tiled(path) {
        return Err(Error::mistake(format!("{} is already a Tiled map", path.display())));
    }
    Ok((map::text_of_file(path)?, path.display().to_string()))
}

/// The level in the file at `path`, a map file or a Tiled map, with textures from `files`.
pub(crate) fn load_file(path: &Path, files: &dyn TextureFiles) -> Result<Level, Faults> {
    if tiled::is_tiled(path) {
        return tiled::load(path, files).map(|import| import.level);
    }
    map::load_level_with(path, files)
}

/// The level in the map file of `place`, and its [`MapWatcher`]. Only files can be watched.
pub(crate) fn watch(place: &LevelOptions) -> Result<(Level, MapWatcher), Error> {
    match place.map.as_deref() {
        Some(name) if name != STANDARD_INPUT && Path::new(name).is_file() => {
            let (level, watch) = MapWatcher::load(Path::new(name));
            Ok((level?, watch))
        }
        // For a name that looks like a map, the error says why the map cannot be loaded.
        Some(name) if name != STANDARD_INPUT && builtin_level(name).is_none() => {
            load(Some(name)).and_then(|_| Err(Error::mistake(NOTHING_TO_WATCH)))
        }
        _ => Err(Error::mistake(NOTHING_TO_WATCH)),
    }
}

const NOTHING_TO_WATCH: &str =
    "--watch needs a map file, as in \"cellcaster play my.toml --watch\": nothing else changes";

/// The level called `argument`. If it is built in, the later built-in levels follow.
pub fn load_series(argument: Option<&OsStr>) -> Result<Levels, Error> {
    if let Some(levels) = argument.map_or(Some(0), builtin_level).and_then(Levels::builtin) {
        return Ok(levels);
    }
    let level = load(argument)?;
    let path = argument.filter(|argument| *argument != STANDARD_INPUT).map(Path::new);
    // A pipe, or anything else that is not a file, cannot be found again.
    Ok(match path.and_then(|path| own_level(path, level.clone())) {
        Some(own) => Levels::own(own),
        None => Levels::new(level, iter::empty()),
    })
}

/// As [`load_series`]; or the generated level, followed by the levels with the next seeds.
pub(crate) fn load_or_generate(place: &LevelOptions) -> Result<Levels, Error> {
    let Some(generator) = place.generate else { return load_series(place.map.as_deref()) };
    let (seed, extent) = (place.seed.unwrap_or(FIRST_SEED), place.level_size.unwrap_or_default());
    let game = move |seed: u64, start: Option<Site>| {
        let level = generator.level(seed, extent)?;
        let start = start.or(level.start()).unwrap_or_default();
        Game::in_level(level, start).ok_or_else(|| Error::mistake(NO_START))
    };
    let first = game(seed, place.start)?;
    let later = (1..).map_while(move |by| game(seed.wrapping_add(by), None).ok());
    Ok(Levels::of_games(first, later))
}

/// The levels in the options; if there are none, the levels from the one in the script's header on.
/// The header's rules apply to levels from maps. The levels have no names, so a game in them does not
/// count.
pub(crate) fn of_script(place: &LevelOptions, header: &Header) -> Result<Levels, Error> {
    if place.generate.is_some() {
        return load_or_generate(place);
    }
    let rules = header.rules();
    let named = header.level.as_ref().filter(|_| place.map.is_none());
    if let Some(first) = named.and_then(LevelName::floor) {
        descent(rules.seed, first)?;
        return Ok(Levels::floors(rules.seed, first));
    }
    let name = place.map.as_deref().or(named.map(|name| OsStr::new(name.as_str())));
    let world = match load(name)? {
        Level::Grid(world) => *world,
        level @ Level::Space(_) => return Ok(Levels::new(level, iter::empty())),
    };
    let index = name.map_or(Some(0), builtin_level);
    let later = index.map_or(&[][..], |index| &builtin::LEVELS[index + 1..]);
    let later = later.iter().map_while(|level| level.world().ok());
    let game = move |world| Game::with_rules(world, rules);
    let levels = Levels::of_games(game(world), later.map(game));
    Ok(match index {
        Some(index) => levels.numbered(index + 1, builtin::LEVELS.len()),
        None => levels,
    })
}

/// The level in a script's header.
pub(crate) fn load_named(name: &LevelName, seed: u64) -> Result<Level, Error> {
    match name.floor() {
        Some(floor) => Ok(Level::from(descent(seed, floor)?)),
        None => load(Some(OsStr::new(name.as_str()))),
    }
}

/// The name of the level `argument` for a script's header; `None` for standard input.
pub(crate) fn name(argument: Option<&OsStr>) -> Option<LevelName> {
    match argument {
        None => LevelName::new(builtin::LEVELS[0].name),
        Some(name) if name == STANDARD_INPUT => None,
        Some(name) => LevelName::new(name.to_str()?),
    }
}

/// The part around `site` of a generated level. Without a site, the part around the start.
pub(crate) fn generate(
    generator: Generator,
    place: &LevelOptions,
    site: Option<Site>,
) -> Result<(Window, World), Error> {
    let seed = place.seed.unwrap_or(FIRST_SEED);
    let level = generator.level(seed, place.level_size.unwrap_or_default())?;
    let site = site.or(level.start()).unwrap_or_default();
    Window::open(level, site).ok_or_else(|| Error::mistake(NO_START))
}

/// The default seed of generated levels.
const FIRST_SEED: u64 = 1;

const NO_START: &str = "--start or --camera is outside the level";

/// The index of the built-in level `name`; `None` if there is a file with that name, which takes
/// precedence.
fn builtin_level(name: &OsStr) -> Option<usize> {
    let index = builtin::LEVELS.iter().position(|level| name == level.name)?;
    (!Path::new(name).exists()).then_some(index)
}

/// The command or built-in level whose name is similar to `name`.
fn similar_name(name: &OsStr) -> Option<&'static str> {
    let levels = builtin::LEVELS.iter().map(|level| level.name);
    let known: Vec<&str> = COMMANDS.into_iter().chain(levels).collect();
    nearest(name.to_str()?, &known)
}

/// The map files in `folders`, sorted by path. Unreadable folders are skipped.
pub(crate) fn find_maps(folders: &[PathBuf]) -> Vec<OwnMap> {
    let entries = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    sort::by(&mut paths, PathBuf::cmp);
    paths.into_iter().filter_map(own_map).collect()
}

/// The map in the file at `path`, if it is a TOML file with a grid or with bodies at the top level.
fn own_map(path: PathBuf) -> Option<OwnMap> {
    let is_toml = path.extension().is_some_and(|ending| ending == OsStr::new("toml"));
    let text = text_of(&path).filter(|text| is_toml && text.lines().any(begins_a_map))?;
    let name = path.file_name()?.to_string_lossy().into_owned();
    let key = key_of(&path, &text);
    let load = move || load_own(&path);
    Some(OwnMap { name, key, load: Box::new(load) })
}

/// Loads the map in the file at `path`.
///
/// # Errors
/// A sentence for the player.
pub(crate) fn load_own(path: &Path) -> Result<OwnLevel, String> {
    if !path.is_file() {
        return Err(format!("{} is no longer a file", path.display()));
    }
    let level = load_file(path, &Folder::of(path)).map_err(|faults| faults.summary())?;
    own_level(path, level).ok_or_else(|| format!("{} can't be read", path.display()))
}

/// `level`, which was loaded from `path`, with the key and the path that the store needs; `None` if
/// it is not a file that can be read again.
fn own_level(path: &Path, level: Level) -> Option<OwnLevel> {
    let text = text_of(path)?;
    let file = fs::canonicalize(path).ok()?.into_os_string().into_string().ok();
    Some(OwnLevel { level, key: key_of(path, &text), file })
}

fn key_of(path: &Path, text: &str) -> String {
    map_key(&path.file_name().unwrap_or_default().to_string_lossy(), text)
}

/// The text of a file, if the file is not too large for a map.
fn text_of(path: &Path) -> Option<String> {
    const MAX_BYTES: u64 = 1 << 20;
    let is_small = fs::metadata(path).is_ok_and(|file| file.is_file() && file.len() <= MAX_BYTES);
    if is_small { fs::read_to_string(path).ok() } else { None }
}

fn begins_a_map(line: &str) -> bool {
    line.split_once('=').is_some_and(|(name, _)| name.trim() == "grid")
        || matches!(line.trim(), "[[sphere]]" | "[[plane]]" | "[[box]]")
}
