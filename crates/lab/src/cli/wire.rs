//! `cellcaster-lab wire`: error against bytes.

use std::ffi::{OsStr, OsString};
use std::io::{self, BufWriter, Write};
use std::num::NonZeroU32;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum, ValueHint};
use ratatui::layout::Size;
use serde_json::{Value, json};

use super::plot::{Align, Axis, BLUE, Chart, GRAY, GREEN, ORANGE, Page};
use super::table::{Figure, Table, objects, write_csv, write_json};
use crate::wire::{
    self, EncoderReport, GlyphRow, PalettePlan, PaletteRow, Part, Plan, Report, report_glyphs,
    report_palettes,
};
use cellcaster::app::parts::Choice;
use cellcaster::app::{Replay, Settings};
use cellcaster::cli::options::{choice, fidelity, frames, window};
use cellcaster::cli::parse::Takes;
use cellcaster::cli::replay::{SHOWCASE, load};
use cellcaster::cli::{Error, level};
use cellcaster::color::palette::ColorDepth;
use cellcaster::map::builtin;
use cellcaster::terminal::Fidelity;
use cellcaster::tui::GlyphSet;

/// Bytes a frame against what the viewer sees
///
/// Plays a script off screen, and measures what its frames take on their way to a terminal.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-lab wire\n  cellcaster-lab wire --script walk.script cellar\n  cellcaster-lab wire --palette 256 --size 80x24\n  cellcaster-lab wire --glyphs all --format svg > glyphs.svg"
)]
pub(crate) struct Wire {
    /// A map file, \"-\" for standard input, or a built-in level
    map: Option<OsString>,
    /// What is played [default: a walk in citadel]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    script: Option<PathBuf>,
    /// The size of the window in cells, with sides up to 1000 and up to 200000 cells
    #[arg(long, value_name = "COLSxROWS", default_value = "120x40", value_parser = window)]
    size: Size,
    /// The frames in a second, from 1 to 240
    #[arg(long = "fps", value_name = "N", default_value = "30", value_parser = frames)]
    frames_per_second: NonZeroU32,
    /// The colours
    #[arg(long = "colors", value_name = "DEPTH", default_value = "true", value_parser = choice::<ColorDepth>())]
    depth: ColorDepth,
    /// What a cell shows: half, quadrant, sextant, octant, ascii or ramp; all compares half, quadrant, sextant and octant in
    /// all levels
    #[arg(long, value_name = "SET", default_value = "half", value_parser = glyphs)]
    glyphs: Glyphs,
    /// How far colours may be off: exact, high, low, or from 0 to 255; may be repeated [default: those that have a name]
    #[arg(long = "fidelity", value_name = "LEVEL", value_parser = fidelity)]
    fidelities: Vec<Fidelity>,
    /// Compare ways to choose among the 256 or 16 colours, in all levels, in place of encoders
    #[arg(long, value_name = "DEPTH", value_parser = palette)]
    palette: Option<ColorDepth>,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    format: Format,
}

/// The glyph sets of a report about bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Glyphs {
    One(GlyphSet),
    All,
}

/// The format of the report about bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    #[default]
    Table,
    Json,
    Csv,
    /// A plot, of glyph sets only.
    Svg,
}

fn palette(text: &str) -> Result<ColorDepth, Takes> {
    let depth = ColorDepth::named(text);
    let indexed = [ColorDepth::Indexed256, ColorDepth::Indexed16];
    depth.filter(|depth| indexed.contains(depth)).ok_or(Takes("256 or 16"))
}

fn glyphs(text: &str) -> Result<Glyphs, Takes> {
    match text {
        "all" => Ok(Glyphs::All),
        _ => GlyphSet::named(text)
            .map(Glyphs::One)
            .ok_or(Takes("half, quadrant, sextant, octant, ascii, ramp or all")),
    }
}

/// Writes the report that `options` request.
pub(crate) fn run(options: &Wire) -> Result<(), Error> {
    check(options)?;
    let mut output = BufWriter::new(io::stdout().lock());
    write_report(options, &mut output)?
        .and_then(|()| output.flush())
        .map_err(|error| Error::of_output(&error))
}

fn write_report(options: &Wire, output: &mut impl Write) -> Result<io::Result<()>, Error> {
    if let Some(depth) = options.palette {
        return Ok(write_palettes(depth, options, output));
    }
    let Glyphs::One(glyphs) = options.glyphs else {
        return Ok(write_glyph_sets(options, output));
    };
    let (script, map) = match &options.script {
        Some(path) => (load(path)?, options.map.as_deref()),
        None => (SHOWCASE.script()?, options.map.as_deref().or(Some(OsStr::new(SHOWCASE.level)))),
    };
    let plan = Plan {
        script: &script,
        size: options.size,
        depth: options.depth,
        frames_per_second: options.frames_per_second,
        fidelities: match options.fidelities.as_slice() {
            [] => vec![Fidelity::EXACT, Fidelity::HIGH, Fidelity::LOW],
            named => named.to_vec(),
        },
    };
    let settings = Settings { depth: Some(options.depth), glyphs, ..Settings::default() };
    let mut replay = Replay::new(level::load_series(map)?, settings, plan.size);
    let report = wire::report(&plan, &mut replay);
    Ok(write_encoders(&plan, &report, options.format, output))
}

/// Finds options that do not go together.
fn check(options: &Wire) -> Result<(), Error> {
    let is_played =
        options.map.is_some() || options.script.is_some() || !options.fidelities.is_empty();
    let compares_glyphs = options.glyphs == Glyphs::All;
    let mistake = if options.palette.is_some() && is_played {
        "--palette compares in all levels: leave out the map, --script and --fidelity"
    } else if compares_glyphs && (is_played || options.palette.is_some()) {
        "--glyphs all compares in all levels: leave out the map, --script, --fidelity and --palette"
    } else if options.format == Format::Svg && !compares_glyphs {
        "--format svg needs --glyphs all"
    } else {
        return Ok(());
    };
    Err(Error::mistake(mistake))
}

/// The name of an encoder, and its results in a section.
type Section = (String, Part);

const ENCODERS: &[Figure<Section>] = &[
    ("section", |(_, part)| part.name.as_str().into()),
    ("encoder", |(encoder, _)| encoder.as_str().into()),
    ("frames", |(_, part)| part.frames.into()),
    ("mean_bytes", |(_, part)| part.bytes.mean.into()),
    ("ratio", |(_, part)| part.ratio.into()),
    ("median_bytes", |(_, part)| part.bytes.median.into()),
    ("percentile_95_bytes", |(_, part)| part.bytes.percentile_95.into()),
    ("largest_bytes", |(_, part)| part.bytes.largest.into()),
    ("mean_compressed_bytes", |(_, part)| part.compressed[1].bytes.into()),
    ("mean_nanoseconds", |(_, part)| nanoseconds(part.time)),
    ("psnr", |(_, part)| part.seen.signal_to_noise.into()),
    ("mean_delta_e", |(_, part)| part.seen.mean_distance.into()),
    ("largest_delta_e", |(_, part)| part.seen.largest_distance.into()),
    ("compression_nanoseconds", |(_, part)| nanoseconds(part.compressed[1].time)),
    ("mean_level_1_bytes", |(_, part)| part.compressed[0].bytes.into()),
    ("level_1_nanoseconds", |(_, part)| nanoseconds(part.compressed[0].time)),
];

fn nanoseconds(time: Duration) -> Value {
    (time.as_nanos() as u64).into()
}

fn write_encoders(
    plan: &Plan,
    report: &Report,
    format: Format,
    output: &mut impl Write,
) -> io::Result<()> {
    match format {
        Format::Table => {
            encoder_table(plan, report).write_text(output)?;
            let firsts = report.encoders.iter().map(|it| format!("{} {}", it.name, it.first_frame));
            let firsts = firsts.collect::<Vec<_>>().join(", ");
            writeln!(output, "The first frame, which is in none of these: {firsts}.")
        }
        Format::Json => write_json(&encoder_object(plan, report), output),
        // A plot is of glyph sets only, as the arguments are.
        Format::Csv | Format::Svg => {
            let sections = report.encoders.iter().flat_map(|encoder| {
                let parts = encoder.sections.iter().chain([&encoder.all]);
                parts.map(|part| (encoder.name.clone(), part.clone()))
            });
            write_csv(ENCODERS, &sections.collect::<Vec<_>>(), output)
        }
    }
}

fn encoder_table(plan: &Plan, report: &Report) -> Table {
    let columns = [
        "section",
        "encoder",
        "mean",
        "ratio",
        "median",
        "95th %",
        "largest",
        "µs",
        "zlib 1",
        "µs",
        "zlib 6",
        "µs",
        "PSNR",
        "mean ΔE",
        "largest ΔE",
    ];
    let micros = |time: Duration| format!("{:.0}", time.as_secs_f64() * 1e6);
    let finite = |number: f64, digits, otherwise: &str| {
        if number.is_finite() { format!("{number:.digits$}") } else { otherwise.to_owned() }
    };
    let row = |encoder: &EncoderReport, part: &Part| {
        let [fast, usual] = part.compressed;
        vec![
            part.name.clone(),
            encoder.name.clone(),
            format!("{:.0}", part.bytes.mean),
            finite(part.ratio, 3, "-"),
            part.bytes.median.to_string(),
            part.bytes.percentile_95.to_string(),
            part.bytes.largest.to_string(),
            micros(part.time),
            format!("{:.0}", fast.bytes),
            micros(fast.time),
            format!("{:.0}", usual.bytes),
            micros(usual.time),
            finite(part.seen.signal_to_noise, 1, "exact"),
            format!("{:.2}", part.seen.mean_distance),
            format!("{:.1}", part.seen.largest_distance),
        ]
    };
    let mut rows = Vec::new();
    let sections = report.encoders.first().map_or(0, |encoder| encoder.sections.len());
    for index in 0..sections {
        rows.extend(report.encoders.iter().map(|encoder| row(encoder, &encoder.sections[index])));
        rows.push(Vec::new());
    }
    rows.extend(report.encoders.iter().map(|encoder| row(encoder, &encoder.all)));
    let Size { width, height } = plan.size;
    Table {
        title: "Encoders",
        about: format!(
            "{} frames of {width}×{height} cells, {} a second; bytes a frame.",
            report.frames, plan.frames_per_second
        ),
        columns: columns.map(str::to_owned).to_vec(),
        labels: 2,
        rows,
    }
}

/// One JSON object: the script, and the encoders with their sections.
fn encoder_object(plan: &Plan, report: &Report) -> Value {
    let part = |part: &Part| {
        let [fast, usual] = part.compressed;
        json!({
            "section": part.name,
            "frames": part.frames,
            "bytes": {
                "mean": part.bytes.mean,
                "median": part.bytes.median,
                "percentile_95": part.bytes.percentile_95,
                "largest": part.bytes.largest,
            },
            "ratio": part.ratio,
            "compressed": usual.bytes,
            "compression_nanoseconds": nanoseconds(usual.time),
            "level_1": { "bytes": fast.bytes, "nanoseconds": nanoseconds(fast.time) },
            "nanoseconds": nanoseconds(part.time),
            "psnr": part.seen.signal_to_noise,
            "delta_e": {
                "mean": part.seen.mean_distance,
                "largest": part.seen.largest_distance,
            },
        })
    };
    let encoder = |encoder: &EncoderReport| {
        json!({
            "encoder": encoder.name,
            "first_frame": encoder.first_frame,
            "sections": encoder.sections.iter().map(part).collect::<Vec<_>>(),
            "all": part(&encoder.all),
        })
    };
    json!({
        "cols": plan.size.width,
        "rows": plan.size.height,
        "frames_per_second": plan.frames_per_second,
        "frames": report.frames,
        "encoders": report.encoders.iter().map(encoder).collect::<Vec<_>>(),
    })
}

const PALETTES: &[Figure<PaletteRow>] = &[
    ("level", |row| row.level.as_str().into()),
    ("method", |row| row.method.into()),
    ("start_error", |row| row.start_error.into()),
    ("start_chroma_error", |row| row.start_chroma_error.into()),
    ("start_lightness", |row| row.start_lightness.into()),
    ("error", |row| row.error.into()),
    ("changes", |row| row.changes.into()),
    ("mean_bytes", |row| row.bytes.into()),
];

fn write_palettes(depth: ColorDepth, options: &Wire, output: &mut impl Write) -> io::Result<()> {
    let plan =
        PalettePlan { depth, size: options.size, frames_per_second: options.frames_per_second };
    let levels = builtin::LEVELS.iter().filter_map(|level| Some((level.name, level.world().ok()?)));
    let rows = report_palettes(&plan, levels);
    match options.format {
        Format::Table => palette_table(&plan, &rows).write_text(output),
        Format::Json => {
            let report = json!({
                "size": { "columns": plan.size.width, "rows": plan.size.height },
                "frames_per_second": plan.frames_per_second,
                "rows": objects(PALETTES, &rows),
            });
            write_json(&report, output)
        }
        Format::Csv | Format::Svg => write_csv(PALETTES, &rows, output),
    }
}

fn palette_table(plan: &PalettePlan, rows: &[PaletteRow]) -> Table {
    let row = |row: &PaletteRow| {
        vec![
            row.level.clone(),
            row.method.to_owned(),
            format!("{:.4}", row.start_error),
            format!("{:.4}", row.start_chroma_error),
            format!("{:.4}", row.start_lightness),
            format!("{:.4}", row.error),
            format!("{:.1}", 100.0 * row.changes),
            format!("{:.0}", row.bytes),
        ]
    };
    let levels: Vec<Vec<Vec<String>>> = rows
        .chunk_by(|one, other| one.level == other.level)
        .map(|rows| rows.iter().map(row).collect())
        .collect();
    let columns = [
        "level",
        "method",
        "first error",
        "chroma",
        "lightness",
        "error",
        "changes",
        "bytes a frame",
    ];
    Table {
        title: "Palettes",
        about: format!(
            "{}×{} cells, {} frames a second. Errors in Oklab after a blur, of the first picture\n\
             and of all; lightness: how much lighter than true colour; changes: percent of cells between\n\
             block and shade, from frame to frame.",
            plan.size.width, plan.size.height, plan.frames_per_second
        ),
        columns: columns.map(str::to_owned).to_vec(),
        labels: 2,
        rows: levels.join(&Vec::new()),
    }
}

const GLYPHS: &[Figure<GlyphRow>] = &[
    ("glyphs", |row| row.glyphs.name().into()),
    ("fidelity", |row| row.fidelity.to_string().into()),
    ("mean_bytes", |row| row.bytes.into()),
    ("error", |row| row.error.into()),
];

fn write_glyph_sets(options: &Wire, output: &mut impl Write) -> io::Result<()> {
    let levels = builtin::LEVELS.iter().filter_map(|level| level.world().ok());
    let rows = report_glyphs(options.size, options.frames_per_second, levels);
    match options.format {
        Format::Table => glyph_table(&rows).write_text(output),
        Format::Json => write_json(&objects(GLYPHS, &rows), output),
        Format::Csv => write_csv(GLYPHS, &rows, output),
        Format::Svg => output.write_all(glyph_plot(&rows).as_bytes()),
    }
}

fn glyph_table(rows: &[GlyphRow]) -> Table {
    let row = |row: &GlyphRow| {
        let (bytes, error) = (format!("{:.0}", row.bytes), format!("{:.2}", 1000.0 * row.error));
        vec![row.glyphs.name().to_owned(), row.fidelity.to_string(), bytes, error]
    };
    Table {
        title: "Glyph sets",
        about: "all built-in levels; errors in thousandths in Oklab after a blur of half a cell."
            .to_owned(),
        columns: ["glyphs", "fidelity", "bytes a frame", "error"].map(str::to_owned).to_vec(),
        labels: 2,
        rows: rows.iter().map(row).collect(),
    }
}

/// Errors against bytes, with a line for each glyph set, as an SVG file.
fn glyph_plot(rows: &[GlyphRow]) -> String {
    /// The width and the height of the plot, and its margins.
    const PLOT: (f64, f64) = (640.0, 400.0);
    const LEFT: f64 = 60.0;
    const RIGHT: f64 = 90.0;
    const TOP: f64 = 40.0;
    const BOTTOM: f64 = 60.0;
    /// The distance between lines of text.
    const LINE: f64 = 14.0;
    const BYTES: [f64; 5] = [2_000.0, 5_000.0, 10_000.0, 20_000.0, 50_000.0];
    const ERRORS: [f64; 6] = [0.004, 0.006, 0.008, 0.012, 0.016, 0.024];
    let chart = Chart {
        left: LEFT,
        right: PLOT.0 - RIGHT,
        top: TOP,
        bottom: PLOT.1 - BOTTOM,
        across: Axis::between(rows.iter().map(|row| row.bytes)),
        up: Axis::between(rows.iter().map(|row| row.error)),
    };
    let mut page = Page::default();
    let title = "Error after a blur, in thousandths in Oklab";
    page.text((LEFT, TOP - LINE), Align::Start, title);
    let below = (f64::midpoint(LEFT, chart.right), chart.bottom + 3.0 * LINE);
    page.text(below, Align::Middle, "bytes a frame");
    for bytes in chart.across.within(&BYTES) {
        chart.tick_across(bytes, &bytes.to_string(), 1.5 * LINE, &mut page);
    }
    for error in chart.up.within(&ERRORS) {
        chart.tick_up(error, &format!("{:.0}", 1000.0 * error), &mut page);
    }
    let sets = rows.chunk_by(|one, other| one.glyphs == other.glyphs);
    for (set, color) in sets.zip([GRAY, GREEN, BLUE, ORANGE]) {
        let points: Vec<(f64, f64)> = set.iter().map(|row| (row.bytes, row.error)).collect();
        chart.series(&points, color, &mut page);
        let (x, y) = chart.at(points[0]);
        page.text((x + 12.0, y + 4.0), Align::Start, set[0].glyphs.name());
    }
    let description = "Mean bytes a frame and error of each glyph set, from right to left at exact, high and low fidelity";
    page.svg(PLOT, description)
}
