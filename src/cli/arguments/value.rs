//! Options that several commands take, and how the value of one is read.

use std::num::NonZeroU32;

use std::ffi::OsStr;

use lexopt::Parser;

use super::{Error, word};
use crate::cast::{Method, NotAMethod};
use crate::palette::ColorDepth;
use crate::render::Filter;
use crate::terminal::{Fidelity, UnknownFidelity};
use crate::tui::{CellAspect, GlyphMode};
use crate::world::FieldOfView;

/// The most frames a second, from 1 to 240.
#[derive(Clone, Copy, Debug)]
pub(in crate::cli) struct FramesPerSecond(NonZeroU32);

impl FramesPerSecond {
    pub(in crate::cli) fn get(self) -> NonZeroU32 {
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
pub(in crate::cli) struct Size {
    pub(in crate::cli) columns: u16,
    pub(in crate::cli) rows: u16,
}

impl Size {
    pub(in crate::cli) fn cells(self) -> ratatui::layout::Size {
        ratatui::layout::Size::new(self.columns, self.rows)
    }
}

impl Default for Size {
    fn default() -> Self {
        Self { columns: 80, rows: 24 }
    }
}

/// An option that takes a value.
pub(super) struct Valued<T> {
    pub(super) name: &'static str,
    /// What it takes, to say so where it gets something else.
    pub(super) takes: &'static str,
    pub(super) read: fn(&str) -> Option<T>,
}

impl<T> Valued<T> {
    pub(super) fn value(&self, parser: &mut Parser) -> Result<T, Error> {
        let text = word(parser, self.name, self.takes)?;
        let text = text.to_string_lossy();
        (self.read)(&text).ok_or_else(|| {
            Error::mistake(format!("{} takes {}, not \"{text}\"", self.name, self.takes))
        })
    }
}

pub(super) const FRAMES_PER_SECOND: Valued<FramesPerSecond> = Valued {
    name: "--fps",
    takes: "a whole number from 1 to 240",
    read: |text| {
        let frames = text.parse::<NonZeroU32>().ok().filter(|frames| frames.get() <= 240);
        frames.map(FramesPerSecond)
    },
};

pub(super) const FIELD_OF_VIEW: Valued<FieldOfView> = Valued {
    name: "--fov",
    takes: "degrees above 0 and below 180",
    read: |text| FieldOfView::from_degrees(text.parse().ok()?),
};

pub(super) const CELL_ASPECT: Valued<CellAspect> = Valued {
    name: "--cell-aspect",
    takes: "the height of a cell over its width, from 0.1 to 10",
    read: |text| CellAspect::new(text.parse().ok()?),
};

pub(super) const GLYPHS: Valued<GlyphMode> = Valued {
    name: "--glyphs",
    takes: "half, ascii or ramp",
    read: |text| match text {
        "half" => Some(GlyphMode::Half),
        "ascii" => Some(GlyphMode::Ascii),
        "ramp" => Some(GlyphMode::Ramp),
        _ => None,
    },
};

pub(super) const FILTER: Valued<Filter> = Valued {
    name: "--filter",
    takes: "mip or nearest",
    read: |text| match text {
        "mip" => Some(Filter::Mip),
        "nearest" => Some(Filter::Nearest),
        _ => None,
    },
};

pub(super) const COLORS: Valued<ColorDepth> = Valued {
    name: "--colors",
    takes: "true, 256, 16 or mono",
    read: |text| match text {
        "true" => Some(ColorDepth::True),
        "256" => Some(ColorDepth::Indexed256),
        "16" => Some(ColorDepth::Indexed16),
        "mono" => Some(ColorDepth::Mono),
        _ => None,
    },
};

pub(super) const SIZE: Valued<Size> = Valued {
    name: "--size",
    takes: "COLSxROWS from 1x1 to 4096x4096, such as 80x24",
    read: |text| {
        let (columns, rows) = text.split_once('x')?;
        let side = |text: &str| text.parse().ok().filter(|side| (1..=4096).contains(side));
        Some(Size { columns: side(columns)?, rows: side(rows)? })
    },
};

/// As [`SIZE`], of a window that somebody may have, several of which are kept at once.
pub(super) const WINDOW_SIZE: Valued<Size> = Valued {
    name: "--size",
    takes: "COLSxROWS from 1x1 to 1000x1000, such as 120x40",
    read: |text| (SIZE.read)(text).filter(|size| size.columns.max(size.rows) <= 1000),
};

/// The value of `--caster`, which knows best what is wrong with it.
pub(super) fn method(parser: &mut Parser) -> Result<Method, Error> {
    let text = word(parser, "--caster", "the name of a method")?;
    let text = text.to_string_lossy();
    text.parse().map_err(|error: NotAMethod| Error::mistake(format!("--caster {text}: {error}")))
}

/// The value of `--fidelity`, likewise.
pub(super) fn fidelity(parser: &mut Parser) -> Result<Fidelity, Error> {
    let text = word(parser, "--fidelity", "exact, high, low or a number up to 255")?;
    parse_fidelity(&text).map_err(|error| Error::mistake(format!("--fidelity: {error}")))
}

/// As [`fidelity`], and `None` for "auto".
pub(super) fn fidelity_or_auto(parser: &mut Parser) -> Result<Option<Fidelity>, Error> {
    let text = word(parser, "--fidelity", "auto, exact, high, low or a number up to 255")?;
    if text == "auto" {
        return Ok(None);
    }
    let fidelity = parse_fidelity(&text);
    fidelity.map(Some).map_err(|error| Error::mistake(format!("--fidelity: {error}, or auto")))
}

fn parse_fidelity(text: &OsStr) -> Result<Fidelity, UnknownFidelity> {
    text.to_string_lossy().parse()
}
