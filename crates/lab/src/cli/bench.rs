//! `cellcaster-lab bench`: the speed on this machine.

mod footprint;
mod json;
mod plot;
mod table;
mod tables;

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};
use std::time::Duration;

use ratatui::layout::Size;

use super::arguments::{Bench, BenchFormat};
use crate::speed::{DrawingRow, Growth, measure_drawing, measure_growth};
use crate::wire::{PipelineRow, measure_pipeline};
use cellcaster::app::{Replay, Settings};
use cellcaster::cli::output_file::OutputFile;
use cellcaster::cli::script::SHOWCASE;
use cellcaster::cli::{Error, level};
use footprint::Footprint;

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
        file.write(|output| plot::write(&report, output))?;
    }
    let output = BufWriter::new(io::stdout().lock());
    write(&report, options.format, output).map_err(|error| Error::of_output(&error))
}

fn write(report: &Report, format: BenchFormat, mut output: impl Write) -> io::Result<()> {
    match format {
        BenchFormat::Table => {
            tables::of(report).iter().try_for_each(|table| table.write_text(&mut output))
        }
        BenchFormat::Markdown => {
            tables::of(report).iter().try_for_each(|table| table.write_markdown(&mut output))
        }
        BenchFormat::Json => json::write(report, &mut output),
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
