//! `cellcaster play`: the game in the terminal.

use std::env;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use super::arguments::{FidelityChoice, Play, STANDARD_INPUT};
use super::data_folder::data_folder;
use super::recording::RecordingFile;
use super::today::today;
use super::{Error, config, level, own_maps};
use crate::app;
use crate::app::store::Store;
use crate::app::{Configuration, Farewell, Given, Levels, Offers, Opening, Origin, Settings};
use crate::game::{Header, LevelName, Rules};
use crate::render::DynCaster;
use crate::terminal::{self, locale_without_utf8, take_keys_from_terminal};
use crate::tui::GlyphSet;
use crate::world::Difficulty;

/// Plays until the player quits.
pub(crate) fn run(options: Play, caster: &DynCaster) -> Result<(), Error> {
    let opening = opening(&options)?;
    let level = match options.generated {
        None => level::name(options.map.as_deref()),
        Some(_) => None,
    };
    let configuration = config::load(options.config)?.configuration;
    let frames_per_second = match options.frames_per_second {
        Some(frames) => frames.get(),
        None => configuration.frames_per_second,
    };
    let usual = Configuration::default().frames_per_second;
    let given = Given {
        glyphs: origin(options.glyphs.is_some(), configuration.glyphs.is_some()),
        depth: origin(options.depth.is_some(), configuration.colors.is_some()),
        frame_time: origin(
            options.frames_per_second.is_some(),
            configuration.frames_per_second != usual,
        ),
    };
    let settings = Settings {
        bindings: configuration.bindings,
        frame_time: Duration::from_secs(1) / frames_per_second.get(),
        field_of_view: options.field_of_view.unwrap_or(configuration.field_of_view),
        cell_aspect: options.cell_aspect,
        glyphs: options.glyphs.or(configuration.glyphs).unwrap_or_else(glyphs_of_locale),
        depth: options.depth.or(configuration.colors),
        caster: caster.clone(),
        filter: options.filter.unwrap_or_default(),
        fidelity: options.fidelity.map_or(configuration.fidelity, FidelityChoice::fixed),
        shows_stats: options.shows_stats,
        difficulty: options.difficulty,
        minimap: configuration.minimap,
        mouse: configuration.mouse,
        given,
    };
    let file = options.record.as_deref();
    let file = file.map(|path| RecordingFile::create(path, options.overwrites)).transpose()?;
    let (store, damage) = match data_folder() {
        Some(folder) => Store::open(&folder),
        None => (Store::in_memory(), None),
    };
    let difficulty = options.difficulty.unwrap_or(store.preferences().difficulty);
    let header = header(&opening, level, difficulty);
    let recording = file.as_ref().map(|file| file.recording(header)).unwrap_or_default();
    let played = app::play(opening, settings, store, recording);
    let written = file.map_or(Ok(()), RecordingFile::finish);
    let farewell = played.map_err(about_the_terminal)?;
    say_farewell(&farewell, damage);
    written
}

/// The origin of a setting that a flag or the configuration file gives. The flag comes first.
fn origin(by_flag: bool, by_file: bool) -> Option<Origin> {
    match (by_flag, by_file) {
        (true, _) => Some(Origin::Flag),
        (false, true) => Some(Origin::File),
        (false, false) => None,
    }
}

/// The header of a script of what the program begins with. Levels that are not generated have the
/// seed 0.
fn header(opening: &Opening, level: Option<LevelName>, difficulty: Difficulty) -> Header {
    let first_floor = || Some(LevelName::of_floor(1));
    match opening {
        Opening::Daily(offers) => {
            let seed = offers.today.unwrap_or_default().into();
            Header::of(first_floor(), Rules { difficulty: Difficulty::default(), seed })
        }
        Opening::Endless(offers) => {
            Header::of(first_floor(), Rules { difficulty, seed: offers.seed })
        }
        Opening::Title(_) | Opening::Levels(_) => Header::of(level, Rules { difficulty, seed: 0 }),
    }
}

/// Says what was done, and what the player should know about what is kept.
fn say_farewell(Farewell { done, trouble }: &Farewell, damage: Option<String>) {
    // The terminal may be gone; then nobody reads it.
    if let Some(done) = done {
        _ = writeln!(io::stdout(), "{done}");
    }
    if let Some(sentence) = trouble.clone().or(damage) {
        Error::machine(sentence).warn();
    }
}

/// The glyphs that the locale can show.
fn glyphs_of_locale() -> GlyphSet {
    match locale_without_utf8(|name| env::var(name).ok()) {
        Some(_) => GlyphSet::Ascii,
        None => GlyphSet::default(),
    }
}

/// The title, unless the options say what to play. A script is about one level, so that recording
/// one begins with the first level.
fn opening(options: &Play) -> Result<Opening, Error> {
    if options.is_daily || options.is_endless {
        return descent_of(options);
    }
    let records_script = options.record.as_deref().is_some_and(RecordingFile::is_script);
    let says_what = options.map.is_some() || options.generated.is_some() || options.watches;
    if says_what || records_script {
        return Ok(Opening::Levels(Box::new(levels(options)?)));
    }
    Ok(Opening::Title(offers()))
}

/// What the title offers.
fn offers() -> Offers {
    let own = data_folder().map(|folder| folder.join("maps"));
    let folders: Vec<PathBuf> = [PathBuf::from(".")].into_iter().chain(own).collect();
    let (today, seed) = today();
    Offers {
        maps: Some(Box::new(move || own_maps::find(&folders))),
        load: Some(Box::new(|path| own_maps::load(Path::new(path)))),
        today: Some(today),
        seed,
    }
}

/// The daily run or an endless game.
fn descent_of(options: &Play) -> Result<Opening, Error> {
    let name = if options.is_daily { "--daily" } else { "--endless" };
    let others = [
        (options.is_daily && options.is_endless, "--endless"),
        (options.map.is_some(), "MAP"),
        (options.generated.is_some(), "--generate"),
        (options.watches, "--watch"),
        (options.is_daily && options.difficulty.is_some(), "--difficulty"),
    ];
    if let Some((_, other)) = others.into_iter().find(|(is_given, _)| *is_given) {
        return Err(Error::mistake(format!("{name} goes without {other}: leave one of them out")));
    }
    Ok(if options.is_daily { Opening::Daily(offers()) } else { Opening::Endless(offers()) })
}

/// The levels to play. If the map is on standard input, keys then come from the terminal.
fn levels(options: &Play) -> Result<Levels, Error> {
    if options.watches {
        if options.record.as_deref().is_some_and(RecordingFile::is_script) {
            return Err(Error::mistake(
                "a script is about a map that stays as it is, and --watch loads it anew: leave one \
                 of them out, or record a .cast",
            ));
        }
        let (level, mut watch) = level::watch(options.map.as_deref(), options.generated)?;
        return Ok(Levels::changing(level, move || watch.change()));
    }
    let levels = level::load_or_generate(options.map.as_deref(), options.generated)?;
    if options.map.as_ref().is_some_and(|map| map == STANDARD_INPUT) && !io::stdin().is_terminal() {
        take_keys_from_terminal().map_err(|_| {
            Error::mistake(
                "standard input held the map, and there is no terminal to take keys from: name a \
                 file instead",
            )
        })?;
    }
    Ok(levels)
}

/// The fault of the terminal, with a hint for players who connect by SSH.
fn about_the_terminal(error: terminal::Error) -> Error {
    let came_by_ssh = env::var_os("SSH_CONNECTION").is_some();
    if error.is_mistake() && came_by_ssh && !io::stdin().is_terminal() {
        return Error::mistake(
            "playing needs a terminal, which ssh gives to a command only with -t: \
             ssh -t HOST cellcaster",
        );
    }
    error.into()
}
