//! What the player chooses in the game: one table for the file, the settings page, and the merging of two
//! games' choices.

use std::num::NonZeroU32;

use crate::app::setting::{At, Setting};
use crate::color::palette::ColorDepth;
use crate::tui::{Correction, GlyphSet};
use crate::world::Difficulty;

/// What the player has chosen in the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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
    /// The colour depth; `None` for that of the terminal.
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

impl Preferences {
    /// Takes over what differs between `before` and `after`.
    pub(crate) fn choose(&mut self, before: Self, after: Self) {
        for setting in &PREFERENCES {
            if setting.value.differs(&before, &after) {
                setting.value.copy(&after, self);
            }
        }
    }
}

/// The preferences in the order of the file, with their labels on the settings page.
pub(crate) const PREFERENCES: [Setting<Preferences>; 9] =
    [CROSSHAIR, COMPASS, BELL, GHOST, DIFFICULTY, GLYPHS, COLORS, CORRECTION, FRAME_RATE];

pub(crate) const CROSSHAIR: Setting<Preferences> = Setting {
    key: "crosshair",
    about: "Crosshair",
    value: &At(|it: &mut Preferences| &mut it.crosshair),
};
pub(crate) const COMPASS: Setting<Preferences> = Setting {
    key: "compass",
    about: "Compass",
    value: &At(|it: &mut Preferences| &mut it.compass),
};
pub(crate) const BELL: Setting<Preferences> = Setting {
    key: "bell",
    about: "Bell when noticed or hurt",
    value: &At(|it: &mut Preferences| &mut it.bell),
};
pub(crate) const GHOST: Setting<Preferences> = Setting {
    key: "ghost",
    about: "Ghost of the best run",
    value: &At(|it: &mut Preferences| &mut it.ghost),
};
pub(crate) const DIFFICULTY: Setting<Preferences> = Setting {
    key: "difficulty",
    about: "Difficulty",
    value: &At(|it: &mut Preferences| &mut it.difficulty),
};
pub(crate) const GLYPHS: Setting<Preferences> = Setting {
    key: "glyphs",
    about: "Characters",
    value: &At(|it: &mut Preferences| &mut it.glyphs),
};
pub(crate) const COLORS: Setting<Preferences> =
    Setting { key: "colors", about: "Colours", value: &At(|it: &mut Preferences| &mut it.colors) };
pub(crate) const CORRECTION: Setting<Preferences> = Setting {
    key: "correction",
    about: "Picture",
    value: &At(|it: &mut Preferences| &mut it.correction),
};
pub(crate) const FRAME_RATE: Setting<Preferences> = Setting {
    key: "fps",
    about: "Frames a second",
    value: &At(|it: &mut Preferences| &mut it.frames_per_second),
};
