//! `cellcaster play`: the game in the terminal.

use std::env;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::machine::{data_folder, open_store, today};
use super::options::{LevelOptions, STANDARD_INPUT, choice};
use super::recording::RecordingFile;
use super::screen::ScreenOptions;
use super::{Error, level};
use crate::app;
use crate::app::{ClosingLines, InitialState, Levels, Offers, Settings};
use crate::game::{Header, LevelName, Rules};
use crate::terminal::{self, accepts_output, take_keys_from_terminal};
use crate::world::Difficulty;

/// Play; without MAP, from the title screen
///
/// Plays in the terminal. "?" shows the keys, and Ctrl-C leaves. Your progress is saved in the folder for data files,
/// or in the folder in `CELLCASTER_DATA`. Over SSH, run "ssh -t HOST cellcaster".
#[derive(Args, Debug)]
#[command(after_long_help = EXAMPLES)]
#[expect(clippy::struct_excessive_bools, reason = "each is an option")]
pub(crate) struct Play {
    /// The difficulty of MAP or the endless game [default: as chosen in the game, or normal]
    #[arg(long, value_name = "LEVEL", value_parser = choice::<Difficulty>())]
    difficulty: Option<Difficulty>,
    /// Play the daily run: the same floors for everyone, at normal difficulty; only the first try counts
    #[arg(long, conflicts_with_all = ["endless", "map", "generate", "watch", "difficulty"])]
    daily: bool,
    /// Play floor after floor, each harder than the one before
    #[arg(long, conflicts_with_all = ["map", "generate", "watch"])]
    endless: bool,
    #[command(flatten)]
    pub(crate) screen: ScreenOptions,
    /// Reload the map when its file or a PNG that it uses changes
    #[arg(long)]
    watch: bool,
    /// Record the terminal's output as asciicast v3 (FILE.cast), or your actions for replay and wire (FILE.script)
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    record: Option<PathBuf>,
    /// Let --record overwrite a file
    #[arg(long)]
    force: bool,
    /// Play by commands in lines of text, for screen readers and pipes; time stands still while you type
    #[arg(long, conflicts_with = "watch")]
    text: bool,
    #[command(flatten)]
    place: LevelOptions,
}

/// The examples in the help.
pub(crate) const EXAMPLES: &str = "\
Examples:
  cellcaster
  cellcaster play --generate maze --seed 7
  cellcaster play --daily
  cellcaster my.toml --colors 256
  cellcaster play my.toml --watch
  ssh -t host cellcaster
  cellcaster --record walk.script && cellcaster replay walk.script";

/// Plays until the player leaves.
pub(crate) fn run(options: Play) -> Result<(), Error> {
    if options.text {
        check_text_mode(&options)?;
    }
    let opening = opening(&options)?;
    let level = match options.place.generate {
        None => level::name(options.place.map.as_deref()),
        Some(_) => None,
    };
    let settings = Settings { difficulty: options.difficulty, ..options.screen.settings()? };
    let file = options.record.as_deref();
    let file = file.map(|path| RecordingFile::create(path, options.force)).transpose()?;
    let (store, damage) = open_store();
    let difficulty = options.difficulty.unwrap_or(store.preferences().difficulty);
    let header = header(&opening, level, difficulty);
    let recording = file.as_ref().map(|file| file.recording(header)).unwrap_or_default();
    let played = if options.text {
        let (input, output) = (io::stdin().lock(), io::stdout().lock());
        let played = app::play_as_text(opening, settings, store, recording, input, output);
        played.map_err(|error| Error::of_output(&error))
    } else {
        app::play(opening, settings, store, recording).map_err(about_the_terminal)
    };
    let written = file.map_or(Ok(()), RecordingFile::finish);
    let farewell = played?;
    say_farewell(&farewell, damage);
    written
}

/// Returns an error if an option does not fit text mode.
fn check_text_mode(options: &Play) -> Result<(), Error> {
    let is_cast = options.record.as_deref().is_some_and(|path| !RecordingFile::is_script(path));
    if is_cast {
        return Err(Error::mistake(
            "--text shows no screen to record: name a FILE.script instead of a .cast",
        ));
    }
    if options.place.map.as_ref().is_some_and(|map| map == STANDARD_INPUT) {
        return Err(Error::mistake(
            "--text reads commands from standard input, so the map can't come from there: name a \
             map file",
        ));
    }
    Ok(())
}

/// The header for a script of the first game in the program. The seed is 0 unless the level is a
/// descent.
fn header(opening: &InitialState, level: Option<LevelName>, difficulty: Difficulty) -> Header {
    let first_floor = || Some(LevelName::of_floor(1));
    match opening {
        InitialState::Daily(offers) => {
            let seed = offers.today.unwrap_or_default().into();
            Header::of(first_floor(), Rules { difficulty: Difficulty::default(), seed })
        }
        InitialState::Endless(offers) => {
            Header::of(first_floor(), Rules { difficulty, seed: offers.seed })
        }
        InitialState::Title(_) | InitialState::Levels(_) | InitialState::Playback { .. } => {
            Header::of(level, Rules { difficulty, seed: 0 })
        }
    }
}

/// Prints a line about the game, and a sentence about any problem with the stored data.
pub(crate) fn say_farewell(ClosingLines { done, trouble }: &ClosingLines, damage: Option<String>) {
    // The terminal may be gone, and then nobody reads the output.
    if let Some(done) = done
        && accepts_output(&io::stdout())
    {
        _ = writeln!(io::stdout(), "{done}");
    }
    if let Some(sentence) = trouble.clone().or(damage)
        && accepts_output(&io::stderr())
    {
        Error::machine(sentence).warn();
    }
}

/// The title, unless the options say what to play. A script covers one level, so recording a script
/// starts with the first level.
fn opening(options: &Play) -> Result<InitialState, Error> {
    if options.daily {
        return Ok(InitialState::Daily(offers()));
    }
    if options.endless {
        return Ok(InitialState::Endless(offers()));
    }
    let records_script = options.record.as_deref().is_some_and(RecordingFile::is_script);
    let says_what =
        options.place.map.is_some() || options.place.generate.is_some() || options.watch;
    if says_what || records_script {
        return Ok(InitialState::Levels(Box::new(levels(options)?)));
    }
    Ok(InitialState::Title(offers()))
}

/// The data for the title's entries.
fn offers() -> Offers {
    let own = data_folder().map(|folder| folder.join("maps"));
    let folders: Vec<PathBuf> = [PathBuf::from(".")].into_iter().chain(own).collect();
    let (today, seed) = today();
    Offers {
        maps: Some(Box::new(move || level::find_maps(&folders))),
        load: Some(Box::new(|path| level::load_own(Path::new(path)))),
        today: Some(today),
        seed,
    }
}

/// The levels to play. If the map comes from standard input, keys are read from the terminal.
fn levels(options: &Play) -> Result<Levels, Error> {
    if options.watch {
        if options.record.as_deref().is_some_and(RecordingFile::is_script) {
            return Err(Error::mistake(
                "a script needs a map that does not change, but --watch reloads it: leave one of \
                 them out, or record a .cast",
            ));
        }
        let (level, mut watch) = level::watch(&options.place)?;
        return Ok(Levels::changing(level, move || watch.change()));
    }
    let levels = level::load_or_generate(&options.place)?;
    take_keys_after_map(&options.place)?;
    Ok(levels)
}

/// Reads keys from the terminal if the map came from standard input.
pub(crate) fn take_keys_after_map(place: &LevelOptions) -> Result<(), Error> {
    if place.map.as_ref().is_some_and(|map| map == STANDARD_INPUT) && !io::stdin().is_terminal() {
        take_keys_from_terminal().map_err(|_| {
            Error::mistake(
                "the map came from standard input, and there is no other terminal to read keys \
                 from: name a map file instead",
            )
        })?;
    }
    Ok(())
}

/// The terminal's error, with a hint for players who connect by SSH.
pub(crate) fn about_the_terminal(error: terminal::Error) -> Error {
    let came_by_ssh = env::var_os("SSH_CONNECTION").is_some();
    if error.is_mistake() && came_by_ssh && !io::stdin().is_terminal() {
        return Error::mistake(
            "playing needs a terminal, which ssh provides only with -t: \
             ssh -t HOST cellcaster",
        );
    }
    error.into()
}
