//! The arguments of the laboratory's commands.

use std::ffi::OsString;
use std::num::NonZeroU32;
use std::path::PathBuf;

use cellcaster::cli::parse::Takes;
use cellcaster::color::palette::ColorDepth;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use ratatui::layout::Size;

use crate::accuracy::Part;
use crate::casters::Method;
use crate::load::Load;

/// Measurements of Cellcaster
#[derive(Debug, Parser)]
#[command(name = "cellcaster-lab", version, max_term_width = 80)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Accuracy(Accuracy),
    Bench(Bench),
    Wire(Wire),
    #[cfg(target_os = "linux")]
    Load(Load),
    /// The game's command of this name, with a caster to compare
    #[command(disable_help_flag = true)]
    Cast(Forwarded),
    /// The game's command of this name, with a caster to compare
    #[command(disable_help_flag = true)]
    Snapshot(Forwarded),
    /// The game's command of this name, with a caster to compare
    #[command(disable_help_flag = true)]
    Play(Forwarded),
}

/// The arguments of a command that the game has, too.
#[derive(Args, Debug)]
pub(crate) struct Forwarded {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    pub(crate) words: Vec<OsString>,
}

/// Errors of everything that has a truth, against what it costs
///
/// Casts rays by every method, draws pictures with every filter and integrates motions, and compares each with an exact or
/// a finer calculation. Without MAP and --set it takes four scenes, and then every stiff and extreme set. All formats have
/// the same figures. Only times differ from run to run.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-lab accuracy --caster exact --caster dda --set \"through corners\"\n  cellcaster-lab accuracy --part pictures citadel\n  cellcaster-lab accuracy --part rays --format svg > rays.svg"
)]
pub(crate) struct Accuracy {
    /// A map file, \"-\" for standard input, or a built-in level
    pub(crate) map: Option<OsString>,
    /// Report on this part: rays, pictures, motion or features; may be repeated [default: all]
    #[arg(long = "part", value_name = "PART", value_parser = part)]
    pub(crate) parts: Vec<Part>,
    /// Cast the rays of one set, such as \"through corners\"
    #[arg(long, value_name = "NAME")]
    pub(crate) set: Option<String>,
    /// Report on this method; may be repeated: exact, dda, dda32, accumulate, fixed:BITS, table:ANGLES or march:STEP
    /// [default: all]
    #[arg(long = "caster", value_name = "METHOD")]
    pub(crate) methods: Vec<Method>,
    /// How many rays each scene has, from 1 to 1000000 [default: 2000]
    #[arg(long, value_name = "N", value_parser = rays)]
    pub(crate) rays: Option<usize>,
    /// Where chance begins [default: 1]
    #[arg(long, value_name = "N", value_parser = seed)]
    pub(crate) seed: Option<u64>,
    /// How often each candidate is timed; with 0 there are no times, and every run writes the same [default: 15]
    #[arg(long, value_name = "N", value_parser = rounds)]
    pub(crate) rounds: Option<usize>,
    /// The player's friction per second, for the motion [default: 12]
    #[arg(long, value_name = "RATE", value_parser = friction)]
    pub(crate) friction: Option<f64>,
    /// The steps of the game in a second, for the motion [default: 60]
    #[arg(long, value_name = "N", value_parser = steps_per_second)]
    pub(crate) steps_per_second: Option<f64>,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ReportFormat,
    /// Replace the tables between the marks of this page, and the plots in docs/ beside it
    #[arg(long = "update", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) page: Option<PathBuf>,
}

/// The format of a report about accuracy.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReportFormat {
    #[default]
    Table,
    Markdown,
    Json,
    Csv,
    Svg,
    Png,
}

/// How fast this machine draws, and a link shows it
#[derive(Args, Debug)]
pub(crate) struct Bench {
    /// How long to measure, from 1 to 60 seconds; preparing comes on top
    #[arg(long, value_name = "N", default_value = "10", value_parser = seconds)]
    pub(crate) seconds: u8,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: BenchFormat,
    /// Draw plots of it in FILE, too, as SVG
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) plot: Option<PathBuf>,
}

/// The format of the report about speed.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(crate) enum BenchFormat {
    #[default]
    Table,
    Markdown,
    Json,
}

/// Bytes a frame against what the viewer sees
///
/// Plays a script off screen, and measures what its frames take on their way to a terminal.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-lab wire\n  cellcaster-lab wire --script walk.script cellar\n  cellcaster-lab wire --palette 256 --size 80x24\n  cellcaster-lab wire --glyphs all --format svg > glyphs.svg"
)]
pub(crate) struct Wire {
    /// A map file, \"-\" for standard input, or a built-in level
    pub(crate) map: Option<OsString>,
    /// What is played [default: a walk in citadel]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) script: Option<PathBuf>,
    /// The size of the window in cells, with sides up to 1000 and up to 200000 cells
    #[arg(long, value_name = "COLSxROWS", default_value = "120x40", value_parser = window)]
    pub(crate) size: Size,
    /// The frames in a second, from 1 to 240
    #[arg(long = "fps", value_name = "N", default_value = "30", value_parser = frames)]
    pub(crate) frames_per_second: NonZeroU32,
    /// The colours: true, 256, 16 or mono
    #[arg(long = "colors", value_name = "DEPTH", default_value = "true", value_parser = depth)]
    pub(crate) depth: ColorDepth,
    /// What a cell shows: half, quadrant, sextant, octant, ascii or ramp; all compares half, quadrant, sextant and octant in
    /// all levels
    #[arg(long, value_name = "SET", default_value = "half", value_parser = glyphs)]
    pub(crate) glyphs: Glyphs,
    /// How far colours may be off: exact, high, low, or from 0 to 255; may be repeated [default: those that have a name]
    #[arg(long = "fidelity", value_name = "LEVEL")]
    pub(crate) fidelities: Vec<Fidelity>,
    /// Compare ways to choose among the 256 or 16 colours, in all levels, in place of encoders
    #[arg(long, value_name = "DEPTH", value_parser = palette)]
    pub(crate) palette: Option<ColorDepth>,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: WireFormat,
}

/// The glyph sets of a report about bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Glyphs {
    One(GlyphSet),
    All,
}

/// The format of the report about bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum WireFormat {
    #[default]
    Table,
    Json,
    Csv,
    /// A plot, of glyph sets only.
    Svg,
}

fn part(text: &str) -> Result<Part, Takes> {
    let mut parts = Part::ALL.into_iter();
    parts.find(|part| part.name() == text).ok_or(Takes("rays, pictures, motion or features"))
}

fn within<T: std::str::FromStr>(
    text: &str,
    fits: impl Fn(&T) -> bool,
    takes: &'static str,
) -> Result<T, Takes> {
    text.parse().ok().filter(fits).ok_or(Takes(takes))
}

fn rays(text: &str) -> Result<usize, Takes> {
    within(text, |rays| (1..=1_000_000).contains(rays), "a whole number from 1 to 1000000")
}

fn seed(text: &str) -> Result<u64, Takes> {
    within(text, |_| true, "a whole number")
}

fn rounds(text: &str) -> Result<usize, Takes> {
    within(text, |&rounds| rounds <= 1000, "a whole number from 0 to 1000")
}

fn friction(text: &str) -> Result<f64, Takes> {
    within(text, |rate| (1e-3..=1e9).contains(rate), "a number from 0.001 to 1000000000")
}

fn steps_per_second(text: &str) -> Result<f64, Takes> {
    within(text, |steps| (0.1..=1e4).contains(steps), "a number from 0.1 to 10000")
}

fn seconds(text: &str) -> Result<u8, Takes> {
    within(text, |seconds| (1..=60).contains(seconds), "a whole number from 1 to 60")
}

fn frames(text: &str) -> Result<NonZeroU32, Takes> {
    within(text, |frames: &NonZeroU32| frames.get() <= 240, "a whole number from 1 to 240")
}

fn window(text: &str) -> Result<Size, Takes> {
    let size = || {
        let (columns, rows) = text.split_once('x')?;
        let side = |text: &str| text.parse::<u16>().ok().filter(|side| (1..=1000).contains(side));
        let (columns, rows) = (side(columns)?, side(rows)?);
        (u32::from(columns) * u32::from(rows) <= 200_000).then(|| Size::new(columns, rows))
    };
    size().ok_or(Takes("COLSxROWS with sides up to 1000 and up to 200000 cells, such as 120x40"))
}

fn depth(text: &str) -> Result<ColorDepth, Takes> {
    match text {
        "true" => Ok(ColorDepth::True),
        "mono" => Ok(ColorDepth::Mono),
        _ => palette(text).map_err(|_| Takes("true, 256, 16 or mono")),
    }
}

fn palette(text: &str) -> Result<ColorDepth, Takes> {
    match text {
        "256" => Ok(ColorDepth::Indexed256),
        "16" => Ok(ColorDepth::Indexed16),
        _ => Err(Takes("256 or 16")),
    }
}

fn glyphs(text: &str) -> Result<Glyphs, Takes> {
    let set = match text {
        "half" => GlyphSet::Half,
        "quadrant" => GlyphSet::Quadrant,
        "sextant" => GlyphSet::Sextant,
        "octant" => GlyphSet::Octant,
        "ascii" => GlyphSet::Ascii,
        "ramp" => GlyphSet::Ramp,
        "all" => return Ok(Glyphs::All),
        _ => return Err(Takes("half, quadrant, sextant, octant, ascii, ramp or all")),
    };
    Ok(Glyphs::One(set))
}
