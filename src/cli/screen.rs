//! The options of commands that show the game in the terminal, and the settings they lead to.

use std::env;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::{Args, ValueHint};

use super::config::CurrentConfiguration;
use super::options::{PictureOptions, fidelity, frames, replace_art};
use super::parse::ValidValues;
use super::{Error, config};
use crate::app::{Configuration, Origin, SettingOrigins, Settings};
use crate::terminal::{Fidelity, locale_without_utf8};
use crate::tui::GlyphSet;

/// How the game is shown in the terminal; the configuration file decides what is not given.
#[derive(Args, Debug)]
pub(crate) struct ScreenOptions {
    /// The settings file [default: cellcaster/config.toml in the folder for configuration files]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    config: Option<PathBuf>,
    /// At most N frames a second, from 1 to 240 [default: 30]
    #[arg(long = "fps", value_name = "N", value_parser = frames)]
    frames_per_second: Option<NonZeroU32>,
    #[command(flatten)]
    pub(crate) look: PictureOptions,
    /// The fidelity of colours while something moves: as the link allows (auto), exact, high, low, or the largest
    /// colour error, from 0 to 255 [default: auto]
    #[arg(long, value_name = "LEVEL", value_parser = fidelity_or_auto)]
    fidelity: Option<AutoFidelity>,
    /// Show frames and bytes a second, round trip and fidelity
    #[arg(long)]
    stats: bool,
}

/// A fidelity; `None` lets the link to the terminal decide.
type AutoFidelity = Option<Fidelity>;

fn fidelity_or_auto(text: &str) -> Result<AutoFidelity, ValidValues> {
    match text {
        "auto" => Ok(None),
        _ => fidelity(text)
            .map(Some)
            .map_err(|_| ValidValues("auto, exact, high, low or a number up to 255")),
    }
}

impl ScreenOptions {
    /// The settings in these options and in the configuration file. Replaces the built-in art if they
    /// say so.
    ///
    /// # Errors
    /// If the configuration file or the art has faults.
    pub(crate) fn settings(self) -> Result<Settings, Error> {
        let PictureOptions { cell_aspect, glyphs, filter, art, view, .. } = self.look;
        let CurrentConfiguration { configuration, path, .. } = config::load(self.config)?;
        // The folder in a configuration file is relative to the file.
        let beside = path.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        let configured = configuration.art.as_ref().map(|folder| beside.join(folder));
        replace_art(art.or(configured).as_deref())?;
        let frames_per_second = self.frames_per_second.unwrap_or(configuration.frames_per_second);
        let usual = Configuration::default();
        let given = SettingOrigins {
            glyphs: origin(glyphs.is_some(), configuration.glyphs.is_some()),
            depth: origin(view.depth.is_some(), configuration.colors.is_some()),
            frame_time: origin(
                self.frames_per_second.is_some(),
                configuration.frames_per_second != usual.frames_per_second,
            ),
            field_of_view: origin(
                view.field_of_view.is_some(),
                configuration.field_of_view != usual.field_of_view,
            ),
        };
        Ok(Settings {
            bindings: configuration.bindings,
            frame_time: Duration::from_secs(1) / frames_per_second.get(),
            field_of_view: view.field_of_view.unwrap_or(configuration.field_of_view),
            cell_aspect,
            glyphs: glyphs.or(configuration.glyphs).unwrap_or_else(glyphs_of_locale),
            depth: view.depth.or(configuration.colors),
            filter,
            fidelity: self.fidelity.unwrap_or(configuration.fidelity),
            shows_stats: self.stats,
            difficulty: None,
            minimap: configuration.minimap,
            mouse: configuration.mouse,
            given,
        })
    }
}

/// The origin of a setting. A flag takes precedence over the configuration file.
fn origin(by_flag: bool, by_file: bool) -> Option<Origin> {
    match (by_flag, by_file) {
        (true, _) => Some(Origin::Flag),
        (false, true) => Some(Origin::File),
        (false, false) => None,
    }
}

/// The glyph set that the locale can show.
fn glyphs_of_locale() -> GlyphSet {
    match locale_without_utf8(|name| env::var(name).ok()) {
        Some(_) => GlyphSet::Ascii,
        None => GlyphSet::default(),
    }
}
