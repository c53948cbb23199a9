//! `cellcaster play`: the game on the terminal.

use std::fs;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

use etcetera::{BaseStrategy, choose_base_strategy};

use super::arguments::Play;
use super::{Error, level};
use crate::map::{Level, builtin};
use crate::tui::{self, Bindings, Levels, Settings};

/// Plays until the player has had enough.
pub(super) fn run(options: Play) -> Result<(), Error> {
    let levels = levels(&options)?;
    let settings = Settings {
        bindings: bindings(options.config)?,
        frame_time: Duration::from_secs(1) / options.frames_per_second.0,
        field_of_view: options.field_of_view,
        cell_aspect: options.cell_aspect,
        glyphs: options.glyphs,
        depth: options.depth,
        method: options.method,
        filter: options.filter,
    };
    tui::play(levels, settings).map_err(Error::from)
}

/// The level that was asked for, and the built-in ones that follow it if it is one.
fn levels(options: &Play) -> Result<Levels, Error> {
    let map = options.map.as_deref();
    let first = level::load(map)?;
    let index = map.map_or(Some(0), level::builtin_level);
    let following = index.map_or(&[][..], |index| &builtin::LEVELS[index + 1..]);
    let following = following.iter().map_while(|level| level.world().ok());
    Ok(Levels::new(first, following.map(|world| Level::Grid(Box::new(world)))))
}

/// The bindings in the file that was named, or in the user's own if there is one.
fn bindings(named: Option<PathBuf>) -> Result<Bindings, Error> {
    let is_named = named.is_some();
    let Some(path) = named.or_else(default_path) else { return Ok(Bindings::default()) };
    let name = path.display().to_string();
    match fs::read_to_string(&path) {
        Ok(text) => Ok(Bindings::parse(&text, &name)?),
        Err(error) if error.kind() == io::ErrorKind::NotFound && !is_named => {
            Ok(Bindings::default())
        }
        Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
    }
}

/// `cellcaster/config.toml` where the platform keeps configuration.
fn default_path() -> Option<PathBuf> {
    let folder = choose_base_strategy().ok()?.config_dir();
    Some(folder.join("cellcaster").join("config.toml"))
}
