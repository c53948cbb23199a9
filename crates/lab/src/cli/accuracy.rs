//! `cellcaster-lab accuracy`: errors of everything that has a reference, over their cost.

use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::PathBuf;

use clap::{Args, ValueEnum, ValueHint};

use crate::accuracy::{Plan, report, set_names};
use crate::report::{Format, Report, update_page};
use cellcaster::cli::{Error, level};

/// Measure errors against exact calculations, and the time that they cost
///
/// Casts rays by every method, draws pictures with every filter, integrates motions, and compares each with an exact or
/// finer calculation. Without MAP and --set, rays cross four scenes and then every stiff and extreme set. All formats
/// contain the same figures. Only times differ from run to run.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-lab accuracy --caster exact --caster dda --set \"through corners\"\n  cellcaster-lab accuracy --part pictures citadel\n  cellcaster-lab accuracy --part rays --format svg > rays.svg"
)]
pub(crate) struct Accuracy {
    /// A map file, "-" for standard input, or a built-in level
    map: Option<OsString>,
    #[command(flatten)]
    plan: Plan,
    /// The format of the report
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Replace the marked tables in this page, and the plots beside it
    #[arg(long = "update", value_name = "FILE", value_hint = ValueHint::FilePath)]
    page: Option<PathBuf>,
}

/// Writes the report that `options` request.
pub(crate) fn run(options: &Accuracy) -> Result<(), Error> {
    let map = options.map.as_ref().map(|map| level::load_grid(Some(map))).transpose()?;
    let tables = report(&options.plan, map.as_ref(), |part| {
        show_progress(part.to_possible_value().as_ref().map_or("", |value| value.get_name()));
    });
    show_progress("");
    let tables = tables.ok_or_else(|| {
        let name = options.plan.set.as_deref().unwrap_or_default();
        Error::mistake(format!(
            "there is no set \"{name}\"; the sets are {}",
            set_names().join(", ")
        ))
    })?;
    match &options.page {
        Some(page) => update_page(page, "accuracy", &tables),
        None => Report::print(&tables, options.format),
    }
}

/// Shows the part that is being measured, if standard error is a terminal.
fn show_progress(part: &str) {
    if io::stderr().is_terminal() {
        // A failure to draw the line is no reason to end the program.
        _ = write!(io::stderr(), "\r{part:<20}\r");
    }
}
