//! Options that several commands share, and the parsers of their values.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use ratatui::layout::Size;

use super::Error;
use super::parse::ValidValues;
use crate::app::parts::Choice;
use crate::color::palette::ColorDepth;
use crate::generate::{Extent, Generator, Site};
use crate::map;
use crate::render::Filter;
use crate::terminal::Fidelity;
use crate::tui::{CellAspect, GlyphSet};
use crate::world::FieldOfView;

/// The name that stands for a map on standard input.
pub(crate) const STANDARD_INPUT: &str = "-";

/// The names of the commands.
pub(crate) const COMMANDS: [&str; 15] = [
    "play",
    "snapshot",
    "cast",
    "check",
    "compare",
    "import",
    "export",
    "edit",
    "levels",
    "config",
    "replay",
    "share",
    "completions",
    "man",
    "help",
];

/// The level of a command: a map, or a generated level.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct LevelOptions {
    /// A map file, a Tiled map, "-" for standard input, or a built-in level (see "cellcaster levels")
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) map: Option<OsString>,
    /// Generate a level in place of MAP
    #[arg(long, value_name = "KIND", value_parser = named(Generator::ALL.map(Generator::name), Generator::named))]
    #[arg(conflicts_with = "map")]
    pub(crate) generate: Option<Generator>,
    /// The seed of the generated level [default: 1]
    #[arg(long, value_name = "N", value_parser = seed, requires = "generate")]
    pub(crate) seed: Option<u64>,
    /// The size of a generated level with outer walls and an exit [default: endless]
    #[arg(long, value_name = "COLSxROWS", value_parser = extent, requires = "generate")]
    pub(crate) level_size: Option<Extent>,
    /// The cell to start at in the generated level [default: the first corner]
    #[arg(long, value_name = "COLUMN,ROW", value_parser = site, requires = "generate")]
    pub(crate) start: Option<Site>,
}

/// How a picture is seen and drawn; the command decides what is not given.
#[derive(Args, Debug)]
pub(crate) struct PictureOptions {
    /// The height of a cell divided by its width, from 0.1 to 10 [default: 2; when playing, as the terminal reports]
    #[arg(long, value_name = "RATIO", value_parser = cell_aspect)]
    pub(crate) cell_aspect: Option<CellAspect>,
    /// The characters that show pixels: each cell shows two (half), four (quadrant), six (sextant) or eight (octant) in
    /// two colours, or one as a character for its colour (ascii) or brightness (ramp) [default: half]
    #[arg(long, value_name = "SET", value_parser = choice::<GlyphSet>())]
    pub(crate) glyphs: Option<GlyphSet>,
    /// How pixels are sampled: from textures averaged in the distance (mip), as single texels (nearest), or as the mean
    /// of nine samples (area)
    #[arg(long, value_name = "FILTER", default_value = Filter::default().name(), value_parser = filter())]
    pub(crate) filter: Filter,
    /// Replace built-in pictures with the PNG files in this folder that have the same names, as in maps/art
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) art: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) view: ViewOptions,
}

/// The view and the colours of any picture.
#[derive(Args, Debug)]
pub(crate) struct ViewOptions {
    /// The field of view from left to right, above 0 and below 180 degrees [default: 66]
    #[arg(long = "fov", value_name = "DEG", value_parser = field_of_view)]
    pub(crate) field_of_view: Option<FieldOfView>,
    /// The number of colours [default: true; when playing, as many as the terminal has]
    #[arg(long = "colors", value_name = "DEPTH", value_parser = choice::<ColorDepth>())]
    pub(crate) depth: Option<ColorDepth>,
}

/// Replaces the built-in art by that in `folder`.
pub(crate) fn replace_art(folder: Option<&Path>) -> Result<(), Error> {
    let Some(folder) = folder else { return Ok(()) };
    map::replace_art(folder).map_err(|error| Error::mistake(error.to_string()))
}

/// A parser for a value with one of these names. Shell completions offer the names.
pub(crate) fn named<T: Clone + Send + Sync + 'static>(
    names: impl IntoIterator<Item = &'static str>,
    named: fn(&str) -> Option<T>,
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(names)
        .try_map(move |name| named(&name).ok_or(ValidValues("one of the values in the help")))
}

/// A parser for a value of a setting with a few named values.
pub fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    named(T::ALL.iter().map(|&(_, name, _)| name), T::named)
}

pub(crate) fn filter() -> impl TypedValueParser<Value = Filter> {
    named(Filter::ALL.map(Filter::name), |name| {
        Filter::ALL.into_iter().find(|filter| filter.name() == name)
    })
}

/// Parses `text`. Returns an error that says `takes` if that fails, or if the value does not
/// satisfy `fits`.
pub fn within<T: FromStr>(
    text: &str,
    fits: impl Fn(&T) -> bool,
    takes: &'static str,
) -> Result<T, ValidValues> {
    text.parse().ok().filter(fits).ok_or(ValidValues(takes))
}

/// Parses a frame rate.
pub fn frames(text: &str) -> Result<NonZeroU32, ValidValues> {
    within(text, |frames: &NonZeroU32| frames.get() <= 240, "a whole number from 1 to 240")
}

/// Parses a seed.
pub fn seed(text: &str) -> Result<u64, ValidValues> {
    within(text, |_| true, "a whole number from 0 to 18446744073709551615")
}

/// Parses the size of a picture.
pub(crate) fn size(text: &str) -> Result<Size, ValidValues> {
    let size = pair(text, 'x')
        .filter(|&(columns, rows)| (1..=4096).contains(&columns) && (1..=4096).contains(&rows));
    let size = size.map(|(columns, rows)| Size::new(columns, rows));
    size.ok_or(ValidValues("COLSxROWS from 1x1 to 4096x4096, such as 80x24"))
}

/// As [`size`], but for a window. A window is drawn for each frame of a game, and several buffers
/// of its size are in memory, so the limit is the area of 800×250 cells.
pub fn window(text: &str) -> Result<Size, ValidValues> {
    let is_window = |it: &Size| {
        it.width.max(it.height) <= 1000 && u32::from(it.width) * u32::from(it.height) <= 200_000
    };
    let size = size(text).ok().filter(is_window);
    size.ok_or(ValidValues(
        "COLSxROWS with sides up to 1000 and up to 200000 cells, such as 120x40",
    ))
}

/// Parses a fidelity: exact, high, low, or a tolerance.
pub fn fidelity(text: &str) -> Result<Fidelity, ValidValues> {
    within(text, |_| true, "exact, high, low or a number up to 255")
}

fn field_of_view(text: &str) -> Result<FieldOfView, ValidValues> {
    let view = text.parse().ok().and_then(FieldOfView::from_degrees);
    view.ok_or(ValidValues("degrees above 0 and below 180"))
}

fn cell_aspect(text: &str) -> Result<CellAspect, ValidValues> {
    let aspect = text.parse().ok().and_then(CellAspect::new);
    aspect.ok_or(ValidValues("the height of a cell divided by its width, from 0.1 to 10"))
}

fn extent(text: &str) -> Result<Extent, ValidValues> {
    let extent = pair(text, 'x').and_then(|(columns, rows)| Extent::new(columns, rows));
    extent.ok_or(ValidValues("COLSxROWS from 8x8 to 1000000000x1000000000, such as 64x64"))
}

fn site(text: &str) -> Result<Site, ValidValues> {
    let site = pair(text, ',').map(|(column, row)| Site { column, row });
    site.ok_or(ValidValues("COLUMN,ROW, the cell to start at, such as 1000000,-1000000"))
}

/// Parses two numbers with `between` between them.
pub(crate) fn pair<T: FromStr>(text: &str, between: char) -> Option<(T, T)> {
    let (first, second) = text.split_once(between)?;
    Some((first.trim().parse().ok()?, second.trim().parse().ok()?))
}
