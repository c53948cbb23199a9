//! Settings: how the game is shown and steered, and the file that says so.
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
//! A [`Configuration`] is what such a file says; the command line goes before it. All of a file's faults are named in
//! one run, each with its place. To read it by serde was refused, as the map is not read so either: it stops at the first fault.

mod keys;
mod read;
mod value;
mod write;

use std::num::NonZeroU32;
use std::time::Duration;

use super::bindings::Bindings;
use crate::color::palette::ColorDepth;
use crate::render::{DynCaster, Filter};
use crate::terminal::Fidelity;
use crate::tui::{CellAspect, GlyphMode};
use crate::world::FieldOfView;
use value::PRESET;

/// How the game is shown and steered.
#[derive(Clone, Debug, Default)]
pub struct Settings {
    /// Which key does what.
    pub bindings: Bindings,
    /// The time between two frames, while something moves.
    pub frame_time: Duration,
    /// How wide the view is at first.
    pub field_of_view: FieldOfView,
    /// The shape of a cell; `None` for what the terminal says.
    pub cell_aspect: Option<CellAspect>,
    /// Which characters stand for pixels.
    pub glyphs: GlyphMode,
    /// How many colours there are; `None` for what the terminal has.
    pub depth: Option<ColorDepth>,
    /// The caster that finds the walls.
    pub caster: DynCaster,
    /// How textures are looked up.
    pub filter: Filter,
    /// How exact frames are; `None` for as exact as the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
    /// Whether the status line tells of frames and the link at first.
    pub shows_stats: bool,
    /// What the minimap shows at first.
    pub minimap: MapDisplay,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
}

/// What the minimap shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum MapDisplay {
    /// What the player has seen so far.
    #[default]
    Seen,
    /// All of the map.
    All,
    /// Nothing, until the player asks for it; then what they have seen.
    Off,
}

/// What a configuration file says, and the default where it says nothing.
///
/// It is printed as a whole file with comments, from which the same is read again:
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
    /// The name of the preset that the keys are changed from.
    preset: &'static str,
    /// Which key does what.
    pub bindings: Bindings,
    /// How many colours there are; `None` for what the terminal has.
    pub colors: Option<ColorDepth>,
    /// Which characters stand for pixels; `None` for those that the terminal can show.
    pub glyphs: Option<GlyphMode>,
    /// How wide the view is at first.
    pub field_of_view: FieldOfView,
    /// The most frames a second, from 1 to 240.
    pub frames_per_second: NonZeroU32,
    /// Whether the mouse turns the player at first.
    pub mouse: bool,
    /// What the minimap shows at first.
    pub minimap: MapDisplay,
    /// How exact frames are; `None` for as exact as the link to the terminal allows.
    pub fidelity: Option<Fidelity>,
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
