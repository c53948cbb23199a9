//! The names, descriptions and values of settings.

use super::MapDisplay;
use crate::color::palette::ColorDepth;
use crate::tui::GlyphSet;

/// A setting in a file.
pub(crate) struct Setting {
    pub(crate) name: &'static str,
    /// Its description, in lines of a comment.
    pub(crate) meaning: &'static str,
    /// Its default value, as written in a file.
    pub(crate) default: &'static str,
}

pub(crate) const PRESET: Setting = Setting {
    name: "preset",
    meaning: "the keyboard that keys are for, as a start: \"qwerty\", \"azerty\" or \"hjkl\"",
    default: "qwerty",
};
pub const COLORS: Setting = Setting {
    name: "colors",
    meaning: "how many colours: \"true\", \"256\", \"16\", \"mono\", or \"auto\" for what the\nterminal has",
    default: "auto",
};
pub const GLYPHS: Setting = Setting {
    name: "glyphs",
    meaning: "characters for pixels: \"half\" (two a cell), \"quadrant\" (four), \"sextant\" (six),\n\
              \"octant\" (eight), \"ascii\", \"ramp\" (by brightness), or \"auto\" for what the\n\
              terminal can show",
    default: "auto",
};
pub(crate) const FOV: Setting = Setting {
    name: "fov",
    meaning: "the field of view in degrees, above 0 and below 180",
    default: "66",
};
pub(crate) const FPS: Setting =
    Setting { name: "fps", meaning: "the most frames a second, from 1 to 240", default: "30" };
pub(crate) const MOUSE: Setting = Setting {
    name: "mouse",
    meaning: "whether the mouse turns the player at first: true or false",
    default: "false",
};
pub(crate) const MINIMAP: Setting = Setting {
    name: "minimap",
    meaning: "the map in the corner: \"seen\" (what has been seen so far), \"all\" or \"off\"",
    default: "seen",
};
pub(crate) const FIDELITY: Setting = Setting {
    name: "fidelity",
    meaning: "how exact colours are while something moves: \"exact\", \"high\", \"low\", a\n\
              tolerance from 0 to 255, or \"auto\" for what the link allows",
    default: "auto",
};

/// The settings in the order of a file.
pub(crate) const SETTINGS: [&Setting; 8] =
    [&PRESET, &COLORS, &GLYPHS, &FOV, &FPS, &MOUSE, &MINIMAP, &FIDELITY];

/// The names of a setting's values.
pub(crate) type Names<T, const N: usize> = [(&'static str, T); N];

pub(crate) const DEPTHS: Names<Option<ColorDepth>, 5> = [
    ("auto", None),
    ("true", Some(ColorDepth::True)),
    ("256", Some(ColorDepth::Indexed256)),
    ("16", Some(ColorDepth::Indexed16)),
    ("mono", Some(ColorDepth::Mono)),
];
pub(crate) const GLYPH_SETS: Names<Option<GlyphSet>, 7> = [
    ("auto", None),
    ("half", Some(GlyphSet::Half)),
    ("quadrant", Some(GlyphSet::Quadrant)),
    ("sextant", Some(GlyphSet::Sextant)),
    ("octant", Some(GlyphSet::Octant)),
    ("ascii", Some(GlyphSet::Ascii)),
    ("ramp", Some(GlyphSet::Ramp)),
];
pub(crate) const DISPLAYS: Names<MapDisplay, 3> =
    [("seen", MapDisplay::Seen), ("all", MapDisplay::All), ("off", MapDisplay::Off)];
