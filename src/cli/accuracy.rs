//! `cellcaster accuracy`: error against run time.

mod csv;
mod json;
mod plot;
mod progress;
mod table;

use std::io::{self, BufWriter, IsTerminal, Write};

use super::arguments::{Accuracy, ReportFormat};
use super::{Error, level, snapshot};
use crate::lab::accuracy::{Plan, RaySource, Report, report, set_names};
use progress::Progress;

/// Writes the report that `options` request.
pub(super) fn run(options: &Accuracy) -> Result<(), Error> {
    if matches!(options.format, ReportFormat::Png) && io::stdout().is_terminal() {
        return Err(snapshot::no_png_here("accuracy"));
    }
    let world = match &options.map {
        Some(map) => level::load_grid(Some(map))?,
        // The built-in level with the most features.
        None => level::load_grid(Some("museum".as_ref()))?,
    };
    let rays = match (&options.set, &options.map) {
        (Some(name), _) => RaySource::Set(name.clone()),
        (None, Some(_)) => RaySource::World,
        (None, None) => RaySource::Scenes,
    };
    let plan = Plan {
        world: &world,
        rays,
        methods: options.methods.clone(),
        count: options.rays,
        seed: options.seed,
    };
    let mut progress = Progress::new();
    let report = report(&plan, |share| progress.show(share));
    progress.finish();
    let report = report.ok_or_else(|| {
        let name = options.set.as_deref().unwrap_or_default();
        Error::mistake(format!("there is no set \"{name}\"; there are {}", set_names().join(", ")))
    })?;
    let output = BufWriter::new(io::stdout().lock());
    write(&report, options.format, output).map_err(|error| Error::of_output(&error))
}

fn write(report: &Report, format: ReportFormat, mut output: impl Write) -> io::Result<()> {
    match format {
        ReportFormat::Table => table::write(report, &mut output)?,
        ReportFormat::Json => json::write(report, &mut output)?,
        ReportFormat::Csv => csv::write(report, &mut output)?,
        ReportFormat::Svg => plot::write_svg(report, &mut output)?,
        ReportFormat::Png => plot::write_png(report, &mut output)?,
    }
    output.flush()
}
