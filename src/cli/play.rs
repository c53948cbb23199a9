//! `cellcaster play`: the game on the terminal.

use std::env;
use std::fs;
use std::io;
use std::path::PathBuf;
use std::time::Duration;

use etcetera::{BaseStrategy, choose_base_strategy};

use super::arguments::Play;
use super::recording::RecordingFile;
use super::{Error, level};
use crate::terminal::locale_without_utf8;
use crate::tui::{self, Bindings, GlyphMode, Settings};

/// Plays until the player has had enough.
pub(super) fn run(options: Play) -> Result<(), Error> {
    let levels = level::load_or_dig(options.map.as_deref(), options.generated)?;
    let settings = Settings {
        bindings: bindings(options.config)?,
        frame_time: Duration::from_secs(1) / options.frames_per_second.get().get(),
        field_of_view: options.field_of_view,
        cell_aspect: options.cell_aspect,
        glyphs: options.glyphs.unwrap_or_else(glyphs_of_locale),
        depth: options.depth,
        method: options.method,
        filter: options.filter,
        fidelity: options.fidelity,
        mouse: false,
        shows_stats: options.shows_stats,
    };
    let file = options.record.as_deref().map(RecordingFile::create).transpose()?;
    let recording = file.as_ref().map(RecordingFile::recording).unwrap_or_default();
    tui::play(levels, settings, recording)?;
    file.map_or(Ok(()), RecordingFile::finish)
}

/// The glyphs that the locale can show.
fn glyphs_of_locale() -> GlyphMode {
    match locale_without_utf8(|name| env::var(name).ok()) {
        Some(_) => GlyphMode::Ascii,
        None => GlyphMode::default(),
    }
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
