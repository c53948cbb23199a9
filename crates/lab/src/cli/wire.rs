//! `cellcaster-lab wire`: error against bytes.

mod csv;
mod glyph_sets;
mod json;
mod palettes;
mod table;

use std::ffi::OsStr;
use std::io::{self, BufWriter, Write};

use super::arguments::{Glyphs, Wire, WireFormat};
use crate::wire::{self, Plan, Report};
use cellcaster::app::{Replay, Settings};
use cellcaster::cli::script::{self, SHOWCASE};
use cellcaster::cli::{Error, level};
use cellcaster::terminal::Fidelity;

/// Writes the report that `options` request.
pub(crate) fn run(options: &Wire) -> Result<(), Error> {
    check(options)?;
    if let Some(depth) = options.palette {
        return palettes::run(depth, options).map_err(|error| Error::of_output(&error));
    }
    let Glyphs::One(glyphs) = options.glyphs else {
        return glyph_sets::run(options).map_err(|error| Error::of_output(&error));
    };
    let (script, map) = match &options.script {
        Some(path) => (script::load(path)?, options.map.as_deref()),
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
    let output = BufWriter::new(io::stdout().lock());
    write(&plan, &report, options.format, output).map_err(|error| Error::of_output(&error))
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
    } else if options.format == WireFormat::Svg && !compares_glyphs {
        "--format svg needs --glyphs all"
    } else {
        return Ok(());
    };
    Err(Error::mistake(mistake))
}

fn write(
    plan: &Plan,
    report: &Report,
    format: WireFormat,
    mut output: impl Write,
) -> io::Result<()> {
    match format {
        WireFormat::Table => table::write(plan, report, &mut output)?,
        WireFormat::Json => json::write(plan, report, &mut output)?,
        // A plot is of glyph sets only, as the arguments are.
        WireFormat::Csv | WireFormat::Svg => csv::write(report, &mut output)?,
    }
    output.flush()
}

/// `number`, if it is finite.
fn finite(number: f64) -> Option<f64> {
    number.is_finite().then_some(number)
}
