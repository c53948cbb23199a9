//! The player's choices: one table for the file, the settings page, and the merging of two games' choices.

use std::num::NonZeroU32;

use serde::{Deserialize, Serialize};

use crate::app::setting::{At, Setting};
use crate::color::palette::ColorDepth;
use crate::tui::{Correction, GlyphSet};
use crate::world::Difficulty;

/// The player's choices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
#[expect(clippy::struct_excessive_bools, reason = "each is a choice of its own")]
pub struct Preferences {
    /// Whether a dot marks the middle of the picture.
    pub crosshair: bool,
    /// Whether a strip shows the directions.
    pub compass: bool,
    /// Whether the terminal's bell rings at sounds.
    pub bell: bool,
    /// Whether the best run walks along.
    pub ghost: bool,
    /// The difficulty of new games.
    pub difficulty: Difficulty,
    /// The glyph set; `None` for the best that the terminal can show.
    pub glyphs: Option<GlyphSet>,
    /// The colour depth; `None` for the terminal's.
    pub colors: Option<ColorDepth>,
    /// How pictures are changed for the player's eyes.
    pub correction: Correction,
    /// The most frames per second; `None` for the default.
    pub frames_per_second: Option<NonZeroU32>,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            crosshair: false,
            compass: false,
            bell: false,
            ghost: true,
            difficulty: Difficulty::Normal,
            glyphs: None,
            colors: None,
            correction: Correction::None,
            frames_per_second: None,
        }
    }
}

impl AsMut<Self> for Preferences {
    fn as_mut(&mut self) -> &mut Self {
        self
    }
}

impl Preferences {
    /// Takes over what differs between `before` and `after`.
    pub fn choose(&mut self, before: Self, after: Self) {
        for setting in &PREFERENCES {
            if setting.value.differs(&before, &after) {
                setting.value.copy(&after, self);
            }
        }
    }
}

/// The preferences in the order of the file.
pub(crate) const PREFERENCES: [Setting<Preferences>; 9] = [
    Setting::CROSSHAIR,
    Setting::COMPASS,
    Setting::BELL,
    Setting::GHOST,
    Setting::DIFFICULTY,
    Setting::GLYPHS,
    Setting::COLORS,
    Setting::CORRECTION,
    Setting::FRAME_RATE,
];

/// The preferences in all that contains them, with their labels on a settings page.
impl<C: AsMut<Preferences> + Clone> Setting<C> {
    /// Whether a dot marks the middle of the picture.
    pub const CROSSHAIR: Self =
        Self::new("crosshair", "Crosshair", &At(|it: &mut C| &mut it.as_mut().crosshair));
    /// Whether a strip shows the directions.
    pub const COMPASS: Self =
        Self::new("compass", "Compass", &At(|it: &mut C| &mut it.as_mut().compass));
    /// Whether the terminal's bell rings at sounds.
    pub const BELL: Self =
        Self::new("bell", "Bell when noticed or hurt", &At(|it: &mut C| &mut it.as_mut().bell));
    /// Whether the best run walks along.
    pub const GHOST: Self =
        Self::new("ghost", "Ghost of the best run", &At(|it: &mut C| &mut it.as_mut().ghost));
    /// The difficulty of new games.
    pub const DIFFICULTY: Self =
        Self::new("difficulty", "Difficulty", &At(|it: &mut C| &mut it.as_mut().difficulty));
    /// The glyph set.
    pub const GLYPHS: Self =
        Self::new("glyphs", "Characters", &At(|it: &mut C| &mut it.as_mut().glyphs));
    /// The colour depth.
    pub const COLORS: Self =
        Self::new("colors", "Colours", &At(|it: &mut C| &mut it.as_mut().colors));
    /// How pictures are changed for the player's eyes.
    pub const CORRECTION: Self =
        Self::new("correction", "Picture", &At(|it: &mut C| &mut it.as_mut().correction));
    /// The most frames per second.
    pub const FRAME_RATE: Self =
        Self::new("fps", "Frames a second", &At(|it: &mut C| &mut it.as_mut().frames_per_second));
}
