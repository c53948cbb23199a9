//! `cellcaster-lab accuracy`: errors of everything that has a truth, against what it costs.
//!
//! With `--update`, tables of a page are replaced that is written by hand for the rest. A table stands between two lines of
//! the page: `<!-- accuracy NAME -->`, and `<!-- end -->`. Below it stand the run that it comes from and the plot, which is
//! a file in the folder `docs` beside the page. Tables and plots of a page are therefore of one run.

mod formats;
mod plot;
mod run;

use std::ffi::OsString;
use std::fs;
use std::io::{self, BufWriter, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::slice;
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum, ValueHint};

use crate::accuracy::{Part, Plan, RaySource, Table, report, set_names};
use crate::casters::Method;
use cellcaster::cli::options::{seed, within};
use cellcaster::cli::output_file::OutputFile;
use cellcaster::cli::parse::Takes;
use cellcaster::cli::{Error, level};
use run::Run;

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
    map: Option<OsString>,
    /// Report on this part: rays, pictures, motion or features; may be repeated [default: all]
    #[arg(long = "part", value_name = "PART", value_parser = part)]
    parts: Vec<Part>,
    /// Cast the rays of one set, such as \"through corners\"
    #[arg(long, value_name = "NAME")]
    set: Option<String>,
    /// Report on this method; may be repeated: exact, dda, dda32, accumulate, fixed:BITS, table:ANGLES or march:STEP
    /// [default: all]
    #[arg(long = "caster", value_name = "METHOD")]
    methods: Vec<Method>,
    /// How many rays each scene has, from 1 to 1000000 [default: 2000]
    #[arg(long, value_name = "N", value_parser = rays)]
    rays: Option<usize>,
    /// Where chance begins [default: 1]
    #[arg(long, value_name = "N", value_parser = seed)]
    seed: Option<u64>,
    /// How often each candidate is timed; with 0 there are no times, and every run writes the same [default: 15]
    #[arg(long, value_name = "N", value_parser = rounds)]
    rounds: Option<usize>,
    /// The player's friction per second, for the motion [default: 12]
    #[arg(long, value_name = "RATE", value_parser = friction)]
    friction: Option<f64>,
    /// The steps of the game in a second, for the motion [default: 60]
    #[arg(long, value_name = "N", value_parser = steps_per_second)]
    steps_per_second: Option<f64>,
    /// How the report is written
    #[arg(long, value_enum, default_value_t)]
    format: Format,
    /// Replace the tables between the marks of this page, and the plots in docs/ beside it
    #[arg(long = "update", value_name = "FILE", value_hint = ValueHint::FilePath)]
    page: Option<PathBuf>,
}

/// The format of the report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Format {
    #[default]
    Table,
    Markdown,
    Json,
    Csv,
    Svg,
}

fn part(text: &str) -> Result<Part, Takes> {
    let mut parts = Part::ALL.into_iter();
    parts.find(|part| part.name() == text).ok_or(Takes("rays, pictures, motion or features"))
}

fn rays(text: &str) -> Result<usize, Takes> {
    within(text, |rays| (1..=1_000_000).contains(rays), "a whole number from 1 to 1000000")
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

/// Writes the report that `options` request.
pub(crate) fn run(options: &Accuracy) -> Result<(), Error> {
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
        return update(page, &run, &tables);
    }
    let output = BufWriter::new(io::stdout().lock());
    write(&run, &tables, options.format, output).map_err(|error| Error::of_output(&error))
}

fn write(run: &Run, tables: &[Table], format: Format, mut output: impl Write) -> io::Result<()> {
    match format {
        Format::Table => formats::write_text(run, tables, &mut output)?,
        Format::Markdown => formats::write_markdown(run, tables, &mut output)?,
        Format::Json => formats::write_object(run, tables, &mut output)?,
        Format::Csv => output.write_all(formats::csv(run, tables).as_bytes())?,
        Format::Svg => output.write_all(plot::svg(run, tables).as_bytes())?,
    }
    output.flush()
}

/// Replaces `tables` in the page at `path`, and writes their plots.
fn update(path: &Path, run: &Run, tables: &[Table]) -> Result<(), Error> {
    let name = path.display();
    let mut page = fs::read_to_string(path)
        .map_err(|error| Error::mistake(format!("{name} can't be read: {error}")))?;
    for table in tables {
        page = replaced(&page, run, table).ok_or_else(|| {
            Error::mistake(format!(
                "{name} has no place for the table \"{}\", which is a line \"{}\" and later \"{END}\"",
                table.name,
                begin(table),
            ))
        })?;
        if !table.diagrams.is_empty() {
            let file = path.with_file_name(plot_of(table));
            OutputFile::create(&file)?.write(|output| {
                output.write_all(plot::svg(run, slice::from_ref(table)).as_bytes())
            })?;
        }
    }
    OutputFile::create(path)?.write(|output| output.write_all(page.as_bytes()))
}

const END: &str = "<!-- end -->";

fn begin(table: &Table) -> String {
    format!("<!-- accuracy {} -->", table.name)
}

/// The file of the plot, relative to the page.
fn plot_of(table: &Table) -> String {
    format!("docs/accuracy-{}.svg", table.name)
}

/// `page` with another `table`; `None` if it has no place for it.
fn replaced(page: &str, run: &Run, table: &Table) -> Option<String> {
    let begin = begin(table);
    let (before, after) = page.split_once(&begin)?;
    let (_, after) = after.split_once(END)?;
    let block = formats::markdown(table);
    let plot = if table.diagrams.is_empty() {
        String::new()
    } else {
        format!("\n![{}]({})\n", table.title, plot_of(table))
    };
    let sentence = run.sentence();
    Some(format!("{before}{begin}\n{plot}\n{block}\n{sentence}\n\n{END}{after}"))
}

/// The time before the bar appears.
const DELAY: Duration = Duration::from_secs(1);
/// The width of the bar in columns.
const WIDTH: usize = 40;

/// A progress bar on standard error, if that is a terminal.
struct Progress {
    start: Instant,
    is_watched: bool,
    shown: Option<usize>,
}

impl Progress {
    fn new() -> Self {
        Self { start: Instant::now(), is_watched: io::stderr().is_terminal(), shown: None }
    }

    /// Shows the completed fraction, from 0 to 1, if it is time to draw.
    fn show(&mut self, share: f64) {
        let filled = (share * WIDTH as f64) as usize;
        if self.is_watched && self.start.elapsed() > DELAY && self.shown != Some(filled) {
            let (done, to_do) = ("#".repeat(filled), ".".repeat(WIDTH.saturating_sub(filled)));
            // A bar that cannot be drawn is no reason to end the program.
            let _ = write!(io::stderr(), "\r[{done}{to_do}]");
            self.shown = Some(filled);
        }
    }

    /// Removes the bar.
    fn finish(self) {
        if self.shown.is_some() {
            let _ = write!(io::stderr(), "\r{}\r", " ".repeat(WIDTH + 2));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::{Column, Row, Value};

    fn table() -> Table {
        let keys = ["", "method", ""];
        let row = Row { keys: ["", "dda", ""].map(str::to_owned), values: vec![Value::Count(3)] };
        Table {
            name: "few",
            title: "A few",
            keys,
            columns: vec![Column { name: "rays".to_owned(), unit: "" }],
            rows: vec![row],
            diagrams: Vec::new(),
        }
    }

    #[test]
    fn a_table_replaces_what_stands_in_its_place() {
        let run = Run::this();
        let page = "Text.\n\n<!-- accuracy few -->\nold\n<!-- end -->\n\nMore.\n";
        let new = replaced(page, &run, &table()).unwrap();
        assert!(new.starts_with("Text.\n\n<!-- accuracy few -->\n"), "{new}");
        assert!(new.ends_with("\n<!-- end -->\n\nMore.\n"), "{new}");
        assert!(new.contains("| method | rays |\n|---|---:|\n| dda | 3 |\n"), "{new}");
        assert_eq!(replaced(&new, &run, &table()).unwrap(), new);
        assert!(replaced("Text.", &run, &table()).is_none());
    }
}
