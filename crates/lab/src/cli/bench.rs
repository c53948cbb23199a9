//! `cellcaster-lab bench`: the speed on this machine.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, ValueHint};

use crate::report::{Format, Origin, Report};
use crate::speed::{measure_crowds, measure_drawing, measure_maps};
use cellcaster::cli::Error;
use cellcaster::cli::options::within;
use cellcaster::cli::output_file::OutputFile;
use cellcaster::cli::parse::ValidValues;

/// Measure how fast this machine draws
#[derive(Args, Debug)]
pub(crate) struct Bench {
    /// The time to measure, from 1 to 60 seconds, without the preparation
    #[arg(long, value_name = "N", default_value = "10", value_parser = seconds)]
    seconds: u8,
    /// The format of the report
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Also write plots of the report to FILE, as SVG
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    plot: Option<PathBuf>,
}

fn seconds(text: &str) -> Result<u8, ValidValues> {
    within(text, |seconds| (1..=60).contains(seconds), "a whole number from 1 to 60")
}

/// Writes the report that `options` request.
pub(crate) fn run(options: &Bench) -> Result<(), Error> {
    // A file that cannot be written is reported before the measurement starts.
    let plot = options.plot.as_deref().map(OutputFile::create).transpose()?;
    let time = Duration::from_secs(options.seconds.into());
    let tables =
        [measure_drawing(time * 2 / 3), measure_maps(time * 2 / 9), measure_crowds(time / 9)];
    if let Some(file) = plot {
        let report = Report { origin: &Origin::this(), tables: &tables };
        file.write(|output| report.write(Format::Svg, output))?;
    }
    Report::print(&tables, options.format)
}
