//! Settings: how the game is shown and controlled, and the file for them.
//!
//! ```toml
//! preset = "azerty"            # or "qwerty", or "hjkl"
//! colors = "256"
//! minimap = "all"
//!
//! [keys]                       # the keys of an action, in place of the preset's
//! forward = ["z", "up"]
//! toggle-run = "c"
//! ```
//!
//! A [`Configuration`] is the content of such a file; the command line takes precedence. All faults
//! of a file are reported in one run, each with its place. Reading it by serde was refused, as for
//! maps: serde stops at the first fault.

mod keys;
mod read;
mod value;
mod write;

use std::num::NonZeroU32;
use std::time::Duration;

use super::bindings::Bindings;
use super::bindings::PRESETS;
use super::settings_screen::after;
use crate::app::store::Preferences;
use crate::color::palette::ColorDepth;
use crate::render::{DynCaster, Filter};
use crate::terminal::Fidelity;
use crate::tui::{CellAspect, GlyphSet};
use crate::world::{Difficulty, FieldOfView};
use value::PRESET;

/// How the game is shown and controlled.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// The actions of keys.
    pub bindings: Bindings,
    /// The time between two frames while something moves.
    pub frame_time: Duration,
    /// The field of view at first.
    pub field_of_view: FieldOfView,
    /// The shape of a cell; `None` for that of the terminal.
    pub cell_aspect: Option<CellAspect>,
    /// The glyph set.
    pub glyphs: GlyphSet,
    /// The colour depth; `None` for that of the terminal.
    pub depth: Option<ColorDepth>,
    /// The caster that finds the walls.
    pub caster: DynCaster,
    /// The texture filter.
    pub filter: Filter,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
    /// Whether the status line shows the figures of frames and the link at first.
    pub shows_stats: bool,
    /// The difficulty of levels that are played without the title; `None` for the one that the player
    /// has chosen before.
    pub difficulty: Option<Difficulty>,
    /// The content of the minimap at first.
    pub minimap: MapDisplay,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
    /// The origin of the settings that the game keeps.
    pub given: Given,
}

/// The origin of the settings that the game keeps. What is given holds in place of what the player has
/// chosen in an earlier game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Given {
    /// Of the glyph set.
    pub glyphs: Option<Origin>,
    /// Of the colour depth.
    pub depth: Option<Origin>,
    /// Of the frame time.
    pub frame_time: Option<Origin>,
}

/// Where a setting is given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// By a flag of the command line.
    Flag,
    /// By the configuration file.
    File,
}

impl Settings {
    /// These settings, with what the player has chosen in earlier games where nothing is given.
    #[must_use]
    pub fn preferring(mut self, preferences: &Preferences) -> Self {
        if let (None, Some(glyphs)) = (self.given.glyphs, preferences.glyphs) {
            self.glyphs = glyphs;
        }
        if let (None, Some(depth)) = (self.given.depth, preferences.colors) {
            self.depth = Some(depth);
        }
        if let (None, Some(frames)) = (self.given.frame_time, preferences.frames_per_second) {
            self.frame_time = Duration::from_secs(1) / frames.get();
        }
        self
    }
}

/// The content of the minimap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum MapDisplay {
    /// The cells that the player has seen so far.
    #[default]
    Seen,
    /// The whole map.
    All,
    /// Nothing, until the player switches it on; then the seen cells.
    Off,
}

/// The content of a configuration file, with defaults for missing settings.
///
/// Its `Display` output is a complete file with comments, which parses to the same configuration:
///
/// ```
/// use cellcaster::app::Configuration;
///
/// let configuration = Configuration::parse("minimap = \"all\"\n[keys]\nleave = \"f10\"", "config.toml")?;
/// let file = configuration.to_string();
/// assert!(file.contains("minimap = \"all\""));
/// assert_eq!(Configuration::parse(&file, "config.toml")?, configuration);
/// # Ok::<(), cellcaster::fault::Faults>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Configuration {
    /// The name of the preset that the bindings are based on.
    preset: &'static str,
    /// The actions of keys.
    pub bindings: Bindings,
    /// The colour depth; `None` for that of the terminal.
    pub colors: Option<ColorDepth>,
    /// The glyph set; `None` for the best that the terminal can show.
    pub glyphs: Option<GlyphSet>,
    /// The field of view at first.
    pub field_of_view: FieldOfView,
    /// The most frames per second, from 1 to 240.
    pub frames_per_second: NonZeroU32,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
    /// The content of the minimap at first.
    pub minimap: MapDisplay,
    /// The fidelity of frames; `None` for the highest that the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
}

impl Configuration {
    /// The name of the preset that the bindings are based on.
    pub fn preset(&self) -> &'static str {
        self.preset
    }

    /// Takes the bindings of the next preset, or of the one before if `forward` is false.
    pub fn change_preset(&mut self, forward: bool) {
        let (name, bindings) = after(&PRESETS, |preset| preset.0 == self.preset, forward);
        (self.preset, self.bindings) = (name, bindings());
    }
}

impl Default for Configuration {
    fn default() -> Self {
        Self {
            preset: PRESET.default,
            bindings: Bindings::default(),
            colors: None,
            glyphs: None,
            field_of_view: FieldOfView::default(),
            frames_per_second: const { NonZeroU32::new(30).unwrap() },
            mouse: false,
            minimap: MapDisplay::default(),
            fidelity: None,
        }
    }
}

#[cfg(test)]
mod tests;
