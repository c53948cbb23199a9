//! The version of the file, and the names in it that are read and written.

use crate::color::palette::ColorDepth;
use crate::tui::{Correction, GlyphSet};

/// The version of the format. Version 2 added the saved descent, the checksum of saved games, and the
/// preferences about the terminal. Version 3 has any number of saved games.
pub(crate) const VERSION: u64 = 3;
/// The oldest version that is read.
pub(crate) const OLDEST: u64 = 1;

/// The sections of saved games, which have numbers: the newest has the largest one.
pub(crate) const SAVES: &str = "saves";
/// The one saved level and the one saved descent of older versions.
pub(crate) const SAVED: &str = "saved";
pub(crate) const SAVED_DESCENT: &str = "saved-descent";

pub const GLYPHS: [(GlyphSet, &str); 6] = [
    (GlyphSet::Half, "half"),
    (GlyphSet::Quadrant, "quadrant"),
    (GlyphSet::Sextant, "sextant"),
    (GlyphSet::Octant, "octant"),
    (GlyphSet::Ascii, "ascii"),
    (GlyphSet::Ramp, "ramp"),
];
pub const COLORS: [(ColorDepth, &str); 4] = [
    (ColorDepth::True, "true"),
    (ColorDepth::Indexed256, "256"),
    (ColorDepth::Indexed16, "16"),
    (ColorDepth::Mono, "mono"),
];

pub const CORRECTIONS: [(Correction, &str); 3] = [
    (Correction::None, "none"),
    (Correction::Contrast, "contrast"),
    (Correction::RedGreen, "red-green"),
];

/// The name of `value`, which has one.
pub fn name_of<T: Copy + PartialEq>(names: &[(T, &'static str)], value: T) -> &'static str {
    names.iter().find(|(named, _)| *named == value).map_or("", |(_, name)| name)
}

/// The value called `name`.
pub fn named<T: Copy>(names: &[(T, &str)], name: &str) -> Option<T> {
    names.iter().find(|(_, known)| *known == name).map(|&(value, _)| value)
}
