//! `cellcaster-lab accuracy`: errors of everything that has a truth, against what it costs.

mod csv;
mod json;
mod markdown;
mod page;
mod plot;
mod progress;
mod run;
mod table;
mod text;

use std::io::{self, BufWriter, IsTerminal, Write};

use super::arguments::{Accuracy, ReportFormat};
use crate::accuracy::{Plan, RaySource, Table, report, set_names};
use cellcaster::cli::{Error, level, snapshot};
use progress::Progress;
use run::Run;

/// Writes the report that `options` request.
pub(crate) fn run(options: &Accuracy) -> Result<(), Error> {
    if options.format == ReportFormat::Png && io::stdout().is_terminal() {
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
    let usual = Plan::new(&world);
    let plan = Plan {
        parts: options.parts.clone(),
        rays,
        methods: options.methods.clone(),
        count: options.rays.unwrap_or(usual.count),
        seed: options.seed.unwrap_or(usual.seed),
        rounds: options.rounds.unwrap_or(usual.rounds),
        friction: options.friction.unwrap_or(usual.friction),
        steps_per_second: options.steps_per_second.unwrap_or(usual.steps_per_second),
        ..usual
    };
    let mut progress = Progress::new();
    let tables = report(&plan, |share| progress.show(share));
    progress.finish();
    let tables = tables.ok_or_else(|| {
        let name = options.set.as_deref().unwrap_or_default();
        Error::mistake(format!("there is no set \"{name}\"; there are {}", set_names().join(", ")))
    })?;
    let run = Run::this();
    if let Some(page) = &options.page {
        return page::update(page, &run, &tables);
    }
    let output = BufWriter::new(io::stdout().lock());
    write(&run, &tables, options.format, output).map_err(|error| Error::of_output(&error))
}

fn write(
    run: &Run,
    tables: &[Table],
    format: ReportFormat,
    mut output: impl Write,
) -> io::Result<()> {
    match format {
        ReportFormat::Table => table::write(run, tables, &mut output)?,
        ReportFormat::Markdown => markdown::write(run, tables, &mut output)?,
        ReportFormat::Json => json::write(run, tables, &mut output)?,
        ReportFormat::Csv => csv::write(run, tables, &mut output)?,
        ReportFormat::Svg => plot::write_svg(run, tables, &mut output)?,
        ReportFormat::Png => plot::write_png(run, tables, &mut output)?,
    }
    output.flush()
}
