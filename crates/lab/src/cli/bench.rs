//! `cellcaster-lab bench`: the speed on this machine.

mod footprint;
mod plot;
mod tables;

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueEnum, ValueHint};
use ratatui::layout::Size;
use serde_json::{Map, Value, json};

use super::table::{Figure, objects, write_json};
use crate::speed::{CrowdRow, DrawingRow, Growth, MapRow, measure_drawing, measure_growth};
use crate::wire::{PipelineRow, measure_pipeline};
use cellcaster::app::{Replay, Settings};
use cellcaster::cli::options::within;
use cellcaster::cli::output_file::OutputFile;
use cellcaster::cli::parse::Takes;
use cellcaster::cli::replay::SHOWCASE;
use cellcaster::cli::{Error, level};
use footprint::Footprint;

/// How fast this machine draws, and a link shows it
#[derive(Args, Debug)]
pub(crate) struct Bench {
    /// How long to measure, from 1 to 60 seconds; preparing comes on top
    #[arg(long, value_name = "N", default_value = "10", value_parser = seconds)]
    seconds: u8,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Draw plots of it in FILE, too, as SVG
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    plot: Option<PathBuf>,
}

/// The format of the report.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
enum Format {
    #[default]
    Table,
    Markdown,
    Json,
}

fn seconds(text: &str) -> Result<u8, Takes> {
    within(text, |seconds| (1..=60).contains(seconds), "a whole number from 1 to 60")
}

/// The results.
struct Report {
    footprint: Footprint,
    drawing: Vec<DrawingRow>,
    growth: Growth,
    pipeline: Vec<PipelineRow>,
}

/// The windows in which the pipeline is measured.
const WINDOWS: [Size; 3] = [Size::new(80, 24), Size::new(120, 40), Size::new(200, 60)];

/// Writes the report that `options` request.
pub(crate) fn run(options: &Bench) -> Result<(), Error> {
    // A file that cannot be written is reported before the measurement.
    let plot = options.plot.as_deref().map(OutputFile::create).transpose()?;
    let report = Report::measure(Duration::from_secs(options.seconds.into()))?;
    if let Some(file) = plot {
        file.write(|output| output.write_all(plot::svg(&report).as_bytes()))?;
    }
    let output = BufWriter::new(io::stdout().lock());
    write(&report, options.format, output).map_err(|error| Error::of_output(&error))
}

fn write(report: &Report, format: Format, mut output: impl Write) -> io::Result<()> {
    match format {
        Format::Table => {
            tables::of(report).iter().try_for_each(|table| table.write_text(&mut output))
        }
        Format::Markdown => {
            tables::of(report).iter().try_for_each(|table| table.write_markdown(&mut output))
        }
        Format::Json => write_json(&report.json(), &mut output),
    }?;
    output.flush()
}

impl Report {
    /// Measures for about `time`.
    fn measure(time: Duration) -> Result<Self, Error> {
        Ok(Self {
            // First, because nothing has allocated memory yet.
            footprint: Footprint::measure()?,
            drawing: measure_drawing(time * 2 / 5),
            growth: measure_growth(time / 5),
            pipeline: pipeline(time * 2 / 5)?,
        })
    }

    /// An object with a list or an object for each table.
    fn json(&self) -> Value {
        let pipeline = |row: &PipelineRow| {
            let rate = |link: u32| (link.to_string(), Value::from(frames_per_second(row, link)));
            json!({
                "cols": row.size.width,
                "rows": row.size.height,
                "encoder": row.encoder,
                "frames": row.frames,
                "microseconds": row.time.as_secs_f64() * 1e6,
                "ratio": share_of_stock(self, row),
                "bytes": row.bytes,
                "frames_per_second_over_megabits": LINKS.into_iter().map(rate).collect::<Map<_, _>>(),
            })
        };
        json!({
            "drawing": objects(DRAWING, &self.drawing),
            "maps": objects(MAPS, &self.growth.maps),
            "things": objects(THINGS, &self.growth.crowds),
            "pipeline": self.pipeline.iter().map(pipeline).collect::<Vec<_>>(),
            "footprint": {
                "start_milliseconds": self.footprint.start_up.map(milliseconds),
                "program_bytes": self.footprint.program,
                "peak_memory_bytes": self.footprint.memory,
            },
        })
    }
}

const DRAWING: &[Figure<DrawingRow>] = &[
    ("scene", |row| row.scene.name().into()),
    ("width", |row| row.size.width.get().into()),
    ("height", |row| row.size.height.get().into()),
    ("threads", |row| row.threads.into()),
    ("nanoseconds_a_pixel", |row| {
        json!({
            "ours": row.ours,
            "by_threads": row.by_threads,
            "classic": row.classic,
            "fill": row.fill,
        })
    }),
    ("classic_over_ours", |row| (row.classic / row.ours).into()),
    ("ours_over_fill", |row| (row.ours / row.fill).into()),
];

const MAPS: &[Figure<MapRow>] = &[
    ("ground", |row| row.ground.name().into()),
    ("side", |row| row.side.into()),
    ("ray", |row| json!({ "nanoseconds": row.ray.seconds * 1e9, "ratio": row.ray.ratio })),
    ("frame", |row| json!({ "microseconds": row.frame.seconds * 1e6, "ratio": row.frame.ratio })),
    ("reading_milliseconds", |row| milliseconds(row.loading).into()),
    ("bytes_a_cell", |row| row.bytes_a_cell.into()),
];

const THINGS: &[Figure<CrowdRow>] = &[
    ("vista", |row| row.vista.name().into()),
    ("things", |row| row.count.into()),
    ("frame", |row| json!({ "microseconds": row.frame.seconds * 1e6, "ratio": row.frame.ratio })),
];

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

/// A game of the showcase's level.
fn begin(size: Size) -> Result<Replay, Error> {
    let levels = level::load_series(Some(OsStr::new(SHOWCASE.level)))?;
    Ok(Replay::new(levels, Settings::default(), size))
}

fn pipeline(time: Duration) -> Result<Vec<PipelineRow>, Error> {
    let script = SHOWCASE.script()?;
    let share = time / WINDOWS.len() as u32;
    let rows = WINDOWS.map(|size| measure_pipeline(&script, size, share, begin));
    let rows: Result<Vec<_>, Error> = rows.into_iter().collect();
    Ok(rows?.into_iter().flatten().collect())
}

/// The speeds of the links for which frame rates are reported, in megabits per second.
const LINKS: [u32; 3] = [1, 10, 100];

/// The number of frames of `row` per second on a link of this speed, limited by the time to draw
/// them.
fn frames_per_second(row: &PipelineRow, megabits: u32) -> f64 {
    let bits = row.bytes * 8.0;
    let sending = bits / (f64::from(megabits) * 1e6);
    1.0 / sending.max(row.time.as_secs_f64()).max(f64::MIN_POSITIVE)
}

/// The row of ratatui's own encoder in the same window as `row`.
fn stock<'a>(report: &'a Report, row: &PipelineRow) -> Option<&'a PipelineRow> {
    report.pipeline.iter().find(|other| other.size == row.size)
}

/// The ratio of a frame's time to that of ratatui's own encoder.
fn share_of_stock(report: &Report, row: &PipelineRow) -> f64 {
    let stock = stock(report, row).unwrap_or(row);
    row.time.as_secs_f64() / stock.time.as_secs_f64().max(f64::MIN_POSITIVE)
}
