//! `cellcaster edit`: the editor of map files.

use std::path::{Path, PathBuf};

use clap::{Args, ValueHint};

use super::Error;
use super::machine::open_store;
use super::options::STANDARD_INPUT;
use super::play::{about_the_terminal, say_farewell};
use super::screen::ScreenOptions;
use crate::app::ClosingLines;
use crate::app::edit::{Editor, edit};
use crate::fault::printable_path;
use crate::map::tiled;

/// Draw a map in the terminal
///
/// Shows a plan of the map and the view from the cursor side by side, and every fault beside its cell. "?" shows the keys.
/// A file that does not exist begins as a small level. Changes that are not written are kept in MAP.journal, and offered
/// at the next start.
#[derive(Args, Debug)]
#[command(after_long_help = "\
Examples:
  cellcaster edit my.toml
  cellcaster edit my.toml --colors 256")]
pub(crate) struct Edit {
    /// The map file
    #[arg(value_hint = ValueHint::FilePath)]
    map: PathBuf,
    #[command(flatten)]
    pub(crate) screen: ScreenOptions,
}

/// Edits the map until the user leaves.
pub(crate) fn run(options: Edit) -> Result<(), Error> {
    let (path, name) = (&options.map, printable_path(&options.map));
    if path.as_os_str() == STANDARD_INPUT {
        return Err(Error::mistake("the editor writes to a file: name one"));
    }
    if tiled::is_tiled(path) {
        return Err(Error::mistake(format!(
            "{name} is a map of Tiled: change it in Tiled, with \"cellcaster {name} --watch\" beside it"
        )));
    }
    if !path.exists() && path.extension().is_none_or(|ending| ending != "toml") {
        return Err(Error::mistake(format!(
            "there is no file {name}, and the name of a new map ends in .toml"
        )));
    }
    if let Some(folder) =
        path.parent().filter(|folder| *folder != Path::new("") && !folder.is_dir())
    {
        let folder = printable_path(folder);
        return Err(Error::mistake(format!(
            "there is no folder {folder} for {name}: create it first"
        )));
    }
    let editor = Editor::open(path)?;
    let settings = options.screen.settings()?;
    let (store, damage) = open_store();
    let done = edit(editor, settings, store).map_err(about_the_terminal)?;
    say_farewell(&ClosingLines { done, trouble: None }, damage);
    Ok(())
}
