//! Options that several commands share.

use std::num::NonZeroU32;

use super::option::{Flag, Parser, ValueOption};
use crate::color::palette::ColorDepth;
use crate::render::Filter;
use crate::terminal::{Fidelity, UnknownFidelity};
use crate::tui::{CellAspect, GlyphSet};
use crate::world::FieldOfView;

/// The largest number of frames per second, from 1 to 240.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FramesPerSecond(NonZeroU32);

impl FramesPerSecond {
    pub(crate) fn get(self) -> NonZeroU32 {
        self.0
    }
}

impl Default for FramesPerSecond {
    fn default() -> Self {
        Self(const { NonZeroU32::new(30).unwrap() })
    }
}

/// Columns and rows of a picture, each from 1 to 4096.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Size {
    pub(crate) columns: u16,
    pub(crate) rows: u16,
}

impl Size {
    pub(crate) fn cells(self) -> ratatui::layout::Size {
        ratatui::layout::Size::new(self.columns, self.rows)
    }

    /// Whether a window may have this size.
    fn is_window(self) -> bool {
        const LONGEST_SIDE: u16 = 1000;
        const MOST_CELLS: u32 = 200_000;
        self.columns.max(self.rows) <= LONGEST_SIDE
            && u32::from(self.columns) * u32::from(self.rows) <= MOST_CELLS
    }
}

impl Default for Size {
    fn default() -> Self {
        Self { columns: 80, rows: 24 }
    }
}

pub(crate) const FRAMES_PER_SECOND: ValueOption<FramesPerSecond> = ValueOption {
    name: "fps",
    value: "N",
    takes: "a whole number from 1 to 240",
    help: "At most N frames a second, from 1 to 240",
    default: "30",
    choices: &[],
    read: Parser::Optional(|text| {
        let frames = text.parse::<NonZeroU32>().ok().filter(|frames| frames.get() <= 240);
        frames.map(FramesPerSecond)
    }),
};

pub(crate) const FIELD_OF_VIEW: ValueOption<FieldOfView> = ValueOption {
    name: "fov",
    value: "DEG",
    takes: "degrees above 0 and below 180",
    help: "The field of view from left to right, above 0 and below 180 degrees",
    default: "66",
    choices: &[],
    read: Parser::Optional(|text| FieldOfView::from_degrees(text.parse().ok()?)),
};

pub(crate) const CELL_ASPECT: ValueOption<CellAspect> = ValueOption {
    name: "cell-aspect",
    value: "RATIO",
    takes: "the height of a cell over its width, from 0.1 to 10",
    help: "The height of a cell over its width, from 0.1 to 10",
    default: "2",
    choices: &[],
    read: Parser::Optional(|text| CellAspect::new(text.parse().ok()?)),
};

pub(crate) const GLYPHS: ValueOption<GlyphSet> = ValueOption {
    name: "glyphs",
    value: "SET",
    takes: "half, quadrant, sextant, octant, ascii or ramp",
    help: "What a cell shows: two pixels (half), four (quadrant), six (sextant) or eight (octant) in two \
           colours, one as a character (ascii), or one as a character for its brightness (ramp)",
    default: "half",
    choices: &["half", "quadrant", "sextant", "octant", "ascii", "ramp"],
    read: Parser::Optional(|text| match text {
        "half" => Some(GlyphSet::Half),
        "quadrant" => Some(GlyphSet::Quadrant),
        "sextant" => Some(GlyphSet::Sextant),
        "octant" => Some(GlyphSet::Octant),
        "ascii" => Some(GlyphSet::Ascii),
        "ramp" => Some(GlyphSet::Ramp),
        _ => None,
    }),
};

pub(crate) const FILTER: ValueOption<Filter> = ValueOption {
    name: "filter",
    value: "FILTER",
    takes: "mip, nearest or area",
    help: "How pixels are computed: from textures averaged where they are far (mip), from raw texels \
           (nearest), or from all that they cover, with smooth edges (area)",
    default: "mip",
    choices: &["mip", "nearest", "area"],
    read: Parser::Optional(|text| Filter::ALL.into_iter().find(|filter| filter.name() == text)),
};

pub(crate) const COLORS: ValueOption<ColorDepth> = ValueOption {
    name: "colors",
    value: "DEPTH",
    takes: "true, 256, 16 or mono",
    help: "How many colours there are",
    default: "true",
    choices: &["true", "256", "16", "mono"],
    read: Parser::Optional(|text| match text {
        "true" => Some(ColorDepth::True),
        "256" => Some(ColorDepth::Indexed256),
        "16" => Some(ColorDepth::Indexed16),
        "mono" => Some(ColorDepth::Mono),
        _ => None,
    }),
};

pub(crate) const SIZE: ValueOption<Size> = ValueOption {
    name: "size",
    value: "COLSxROWS",
    takes: "COLSxROWS from 1x1 to 4096x4096, such as 80x24",
    help: "The size of the picture in cells, from 1x1 to 4096x4096",
    default: "80x24",
    choices: &[],
    read: Parser::Optional(size),
};

/// As [`SIZE`], but for a window: it is drawn for each frame of a game, and several buffers of it are
/// in memory. The limit is that of a window of 800×250 cells.
pub(crate) const WINDOW_SIZE: ValueOption<Size> = ValueOption {
    takes: "COLSxROWS with sides up to 1000 and up to 200000 cells, such as 120x40",
    help: "The size of the window in cells, with sides up to 1000 and up to 200000 cells",
    read: Parser::Optional(|text| size(text).filter(|size| size.is_window())),
    ..SIZE
};

fn size(text: &str) -> Option<Size> {
    let (columns, rows) = text.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|side| (1..=4096).contains(side));
    Some(Size { columns: side(columns)?, rows: side(rows)? })
}

/// Other methods than the exact one are those of `cellcaster-lab`, which [`super::parse`] runs for them.
pub(crate) const CASTER: ValueOption<()> = ValueOption {
    name: "caster",
    value: "METHOD",
    takes: "the name of a method",
    help: "How walls are found: exact, or with cellcaster-lab dda, dda32, accumulate, fixed:BITS, \
           table:ANGLES or march:STEP",
    default: "exact",
    choices: &[],
    read: Parser::Optional(|text| (text == "exact").then_some(())),
};

pub(crate) const FIDELITY: ValueOption<Fidelity> = ValueOption {
    name: "fidelity",
    value: "LEVEL",
    takes: "exact, high, low or a number up to 255",
    help: "How exact colours are while something moves: exact, high, low, or how far they may be off, \
           from 0 to 255",
    default: "exact",
    choices: &[],
    read: Parser::Fallible(|text| {
        text.parse().map_err(|error: UnknownFidelity| format!("--fidelity: {error}"))
    }),
};

pub(crate) const WATCH: Flag = Flag {
    name: "watch",
    help: "Load the map anew whenever its file, or a PNG that it uses, changes",
};
