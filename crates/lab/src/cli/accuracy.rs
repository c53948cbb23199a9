//! `cellcaster-lab accuracy`: errors of everything that has a reference, over their cost.
//!
//! With `--update`, the command replaces tables in a page whose other text is written by hand. A
//! table stands between two lines of the page: `<!-- accuracy NAME -->` and `<!-- end -->`. The run
//! that produced it is named below the table. Its plot is a file beside the page, from the same run.

use std::ffi::OsString;
use std::fs;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::slice;

use clap::{Args, ValueEnum, ValueHint};

use crate::accuracy::{Plan, report, set_names};
use crate::report::{Format, Origin, Report, Table, markdown};
use cellcaster::cli::output_file::OutputFile;
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
        Some(page) => update(page, &Origin::this(), &tables),
        None => Report::print(&tables, options.format),
    }
}

/// Replaces `tables` in the page at `path`, and writes their plots.
fn update(path: &Path, origin: &Origin, tables: &[Table]) -> Result<(), Error> {
    let name = path.display();
    let mut page = fs::read_to_string(path)
        .map_err(|error| Error::mistake(format!("{name} can't be read: {error}")))?;
    for table in tables {
        page = replaced(&page, origin, table).ok_or_else(|| {
            Error::mistake(format!(
                "{name} has no place for the table \"{}\": add a line \"{}\" and below it a line \"{END}\"",
                table.name,
                begin(table),
            ))
        })?;
        if !table.diagrams.is_empty() {
            let file = path.with_file_name(plot_of(table));
            let report = Report { origin, tables: slice::from_ref(table) };
            OutputFile::create(&file)?.write(|output| report.write(Format::Svg, output))?;
        }
    }
    OutputFile::create(path)?.write(|output| output.write_all(page.as_bytes()))
}

const END: &str = "<!-- end -->";

fn begin(table: &Table) -> String {
    format!("<!-- accuracy {} -->", table.name)
}

/// The file of the plot, beside the page.
fn plot_of(table: &Table) -> String {
    format!("accuracy-{}.svg", table.name)
}

/// Returns `page` with the new `table`; `None` if it has no place for it.
fn replaced(page: &str, origin: &Origin, table: &Table) -> Option<String> {
    let begin = begin(table);
    let (before, after) = page.split_once(&begin)?;
    let (_, after) = after.split_once(END)?;
    let block = markdown(table);
    let plot = if table.diagrams.is_empty() {
        String::new()
    } else {
        format!("\n![{}]({})\n", table.title, plot_of(table))
    };
    let sentence = origin.sentence();
    Some(format!("{before}{begin}\n{plot}\n{block}\n{sentence}\n\n{END}{after}"))
}

/// Shows the part that is being measured, if standard error is a terminal.
fn show_progress(part: &str) {
    if io::stderr().is_terminal() {
        // A failure to draw the line is no reason to end the program.
        _ = write!(io::stderr(), "\r{part:<20}\r");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Row, Value, headings};

    fn table() -> Table {
        Table {
            name: "few",
            title: "A few".to_owned(),
            keys: ["", "method", ""],
            columns: headings(["rays"]),
            rows: vec![Row::new(["", "dda", ""], vec![Value::Count(3)])],
            diagrams: Vec::new(),
        }
    }

    #[test]
    fn a_table_replaces_the_text_between_its_markers() {
        let run = Origin::this();
        let page = "Text.\n\n<!-- accuracy few -->\nold\n<!-- end -->\n\nMore.\n";
        let new = replaced(page, &run, &table()).unwrap();
        assert!(new.starts_with("Text.\n\n<!-- accuracy few -->\n"), "{new}");
        assert!(new.ends_with("\n<!-- end -->\n\nMore.\n"), "{new}");
        assert!(new.contains("| method | rays |\n|---|---:|\n| dda | 3 |\n"), "{new}");
        assert_eq!(replaced(&new, &run, &table()).unwrap(), new);
        assert!(replaced("Text.", &run, &table()).is_none());
    }
}
