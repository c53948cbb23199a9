//! Reports as Markdown, CSV and JSON, with the machine, the program and the command that
//! produced them.

use std::env;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::thread::available_parallelism;

use clap::ValueEnum;
use serde_json::{Map, Value as Json, json};

use super::plot::svg;
use super::{Row, Spread, Table, Value};
use cellcaster::cli::Error;
use cellcaster::cli::machine::today;

/// The format of a report.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    #[default]
    Markdown,
    Json,
    Csv,
    Svg,
}

/// Tables of one run.
pub(crate) struct Report<'a> {
    pub(crate) origin: &'a Origin,
    pub(crate) tables: &'a [Table],
}

impl Report<'_> {
    /// Writes the report of this process to standard output.
    pub(crate) fn print(tables: &[Table], format: Format) -> Result<(), Error> {
        let report = Report { origin: &Origin::this(), tables };
        let mut output = BufWriter::new(io::stdout().lock());
        let written = report.write(format, &mut output).and_then(|()| output.flush());
        written.map_err(|error| Error::of_output(&error))
    }

    pub(crate) fn write(&self, format: Format, output: &mut impl Write) -> io::Result<()> {
        match format {
            Format::Markdown => self.write_markdown(output),
            Format::Json => self.write_json(output),
            Format::Csv => output.write_all(self.csv().as_bytes()),
            Format::Svg => output.write_all(svg(self).as_bytes()),
        }
    }

    fn write_markdown(&self, output: &mut impl Write) -> io::Result<()> {
        for table in self.tables {
            writeln!(output, "### {}\n\n{}.\n\n{}", table.name, table.title, markdown(table))?;
        }
        writeln!(output, "{}", self.origin.sentence())
    }

    /// One object: the run, and the tables by their names.
    fn write_json(&self, output: &mut impl Write) -> io::Result<()> {
        let run = self.origin.parts().map(|(name, value)| (name.to_owned(), value.into()));
        let run: Map<String, Json> = run.into_iter().collect();
        let tables: Map<String, Json> =
            self.tables.iter().map(|table| (table.name.to_owned(), object(table))).collect();
        serde_json::to_writer_pretty(&mut *output, &json!({ "run": run, "tables": tables }))?;
        writeln!(output)
    }

    /// A line for each figure. The first lines describe the origin of the report.
    pub(crate) fn csv(&self) -> String {
        let mut text =
            "table,problem,method,parameter,figure,value,lower_quartile,upper_quartile\n"
                .to_owned();
        for (name, value) in self.origin.parts() {
            text += &csv_line(["run", "", "", "", name, value, "", ""]);
        }
        for table in self.tables {
            for row in &table.rows {
                let keys =
                    || std::iter::once(table.name).chain(row.keys.iter().map(String::as_str));
                for (column, value) in table.columns.iter().zip(&row.values) {
                    let [value, lower, upper] = csv_fields(*value);
                    text += &csv_line(keys().chain([column.as_str(), &value, &lower, &upper]));
                }
            }
        }
        text
    }
}

/// The headings and the rows in Markdown.
pub fn markdown(table: &Table) -> String {
    let (labels, mut lines) = cells(table);
    let rule = (0..lines[0].len()).map(|column| if column < labels { "---" } else { "---:" });
    let rule = format!("|{}|\n", rule.collect::<Vec<_>>().join("|"));
    let rows = lines.split_off(1);
    let line = |cells: &Vec<String>| format!("| {} |\n", cells.join(" | "));
    line(&lines[0]) + &rule + &rows.iter().map(line).collect::<String>()
}

/// The number of key columns, and the headings and all rows as text.
fn cells(table: &Table) -> (usize, Vec<Vec<String>>) {
    let keys: Vec<usize> = (0..3).filter(|&key| !table.keys[key].is_empty()).collect();
    let headings = keys.iter().map(|&key| table.keys[key].to_owned());
    let row = |row: &Row| {
        let keys = keys.iter().map(|&key| row.keys[key].clone());
        keys.chain(row.values.iter().map(|&value| figure(value))).collect()
    };
    let first = headings.chain(table.columns.iter().cloned()).collect();
    (keys.len(), std::iter::once(first).chain(table.rows.iter().map(row)).collect())
}

fn object(table: &Table) -> Json {
    let row = |row: &Row| -> Json {
        let keys = table.keys.iter().zip(&row.keys).filter(|(heading, _)| !heading.is_empty());
        let keys = keys.map(|(heading, key)| ((*heading).to_owned(), Json::from(key.as_str())));
        let figures = table.columns.iter().zip(&row.values);
        let figures = figures.map(|(column, value)| (column.clone(), json_figure(*value)));
        keys.chain(figures).collect::<Map<String, Json>>().into()
    };
    json!({ "title": table.title, "rows": table.rows.iter().map(row).collect::<Vec<_>>() })
}

fn json_figure(value: Value) -> Json {
    match value {
        Value::None => Json::Null,
        Value::Count(count) => count.into(),
        // JSON has no infinity.
        Value::Share(number) | Value::Number(number) if !number.is_finite() => "inf".into(),
        Value::Share(number) | Value::Number(number) => number.into(),
        Value::Spread(Spread { median, lower_quartile, upper_quartile }) => json!({
            "median": median,
            "lower_quartile": lower_quartile,
            "upper_quartile": upper_quartile,
        }),
    }
}

/// A line of CSV. Fields with commas are in quotation marks.
fn csv_line<'a>(fields: impl IntoIterator<Item = &'a str>) -> String {
    let quoted = fields.into_iter().map(|field| {
        if field.contains([',', '"']) {
            format!("\"{}\"", field.replace('"', "\"\""))
        } else {
            field.to_owned()
        }
    });
    quoted.collect::<Vec<_>>().join(",") + "\n"
}

/// A value and its quartiles for CSV; empty if there are none.
fn csv_fields(value: Value) -> [String; 3] {
    let one = |text: String| [text, String::new(), String::new()];
    match value {
        Value::None => one(String::new()),
        Value::Count(count) => one(count.to_string()),
        Value::Share(number) | Value::Number(number) => one(number.to_string()),
        Value::Spread(Spread { median, lower_quartile, upper_quartile }) => {
            [median, lower_quartile, upper_quartile].map(|value| value.to_string())
        }
    }
}

/// A figure; a dash if there is none.
fn figure(value: Value) -> String {
    match value {
        Value::None => "–".to_owned(),
        Value::Count(count) => count.to_string(),
        Value::Share(number) => share(number),
        Value::Number(value) => number(value),
        Value::Spread(Spread { median, lower_quartile, upper_quartile }) => {
            format!("{median:.2} ({lower_quartile:.2}–{upper_quartile:.2})")
        }
    }
}

/// A fraction as a percentage; zero is distinguished from a small number.
fn share(share: f64) -> String {
    if share == 0.0 {
        "0".to_owned()
    } else if share < 1e-4 {
        "<0.01 %".to_owned()
    } else {
        format!("{:.2} %", 100.0 * share)
    }
}

/// A number with at least two digits; zero only if it is zero.
fn number(number: f64) -> String {
    if number == 0.0 {
        "0".to_owned()
    } else if number >= f64::MAX {
        "inf".to_owned()
    } else if (1000.0..100_000.0).contains(&number.abs()) {
        format!("{number:.0}")
    } else if (0.01..1000.0).contains(&number.abs()) {
        let text = format!("{number:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{number:.1e}")
    }
}

// The origin of a report.

/// The origin of a report.
pub(crate) struct Origin {
    machine: String,
    /// The version and the commit, and the compiler.
    program: String,
    command: String,
    /// The date in UTC, such as 2026-11-22.
    date: String,
}

impl Origin {
    /// The origin of a report of this process.
    pub(crate) fn this() -> Self {
        let (date, _) = today();
        let (year, month, day) = (date / 10_000, date / 100 % 100, date % 100);
        Self {
            machine: machine(),
            program: format!("{} by {}", cellcaster::VERSION, cellcaster::BUILD),
            command: command(env::args().skip(1)),
            date: format!("{year}-{month:02}-{day:02}"),
        }
    }

    /// The names and the values of all parts.
    pub(crate) fn parts(&self) -> [(&'static str, &str); 4] {
        let Self { machine, program, command, date } = self;
        [("machine", machine), ("program", program), ("command", command), ("date", date)]
    }

    /// The date, the version and the machine in a sentence.
    pub(crate) fn sentence(&self) -> String {
        let Self { machine, program, date, .. } = self;
        format!("Measured on {date}, version {program}, on {machine}.")
    }
}

/// The processor, if the system reports it, the number of its cores, the load of the last minute, and the system.
fn machine() -> String {
    let cores = available_parallelism().map_or(1, Into::into);
    let information = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        information.lines().find_map(|line| line.strip_prefix("model name")?.split(": ").nth(1));
    let processor = model.unwrap_or("unknown processor").trim();
    let cores = if cores == 1 { "1 core".to_owned() } else { format!("{cores} cores") };
    let load = fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let load = load.split(' ').next().filter(|it| !it.is_empty()).unwrap_or("unknown");
    format!("{processor}, {cores}, load {load}, {}", env::consts::OS)
}

/// The command line with these arguments.
fn command(arguments: impl Iterator<Item = String>) -> String {
    let quoted = |argument: String| {
        if argument.contains(' ') { format!("\"{argument}\"") } else { argument }
    };
    let words = std::iter::once("cellcaster-lab".to_owned()).chain(arguments.map(quoted));
    words.collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::super::headings;
    use super::*;

    fn fruit() -> Table {
        Table {
            name: "fruit",
            title: "Fruit in kilograms".to_owned(),
            keys: ["kind", "", ""],
            columns: headings(["kg"]),
            rows: vec![
                Row::new(["apples", "", ""], vec![Value::Count(7)]),
                Row::new(["figs", "", ""], vec![Value::Number(12.5)]),
            ],
            diagrams: Vec::new(),
        }
    }

    #[test]
    fn markdown_tables_are_not_padded() {
        let text = "| kind | kg |\n|---|---:|\n| apples | 7 |\n| figs | 12.5 |\n";
        assert_eq!(markdown(&fruit()), text);
    }

    #[test]
    fn only_zero_prints_as_zero() {
        let figures = [
            Value::Count(0),
            Value::Share(0.0),
            Value::Share(1e-9),
            Value::Share(0.1719),
            Value::Number(0.0),
            Value::Number(4.7e-17),
            Value::Number(-0.25),
            Value::Number(12.0),
            Value::Number(59_951.2),
            Value::Number(1e5),
            Value::Number(f64::INFINITY),
            Value::None,
        ];
        let texts = figures.map(figure).join(" | ");
        assert_eq!(
            texts,
            "0 | 0 | <0.01 % | 17.19 % | 0 | 4.7e-17 | -0.25 | 12 | 59951 | 1.0e5 | inf | –"
        );
    }

    #[test]
    fn a_printed_command_can_be_pasted() {
        let arguments = ["accuracy", "--set", "through corners"].map(str::to_owned);
        let repeated = "cellcaster-lab accuracy --set \"through corners\"";
        assert_eq!(command(arguments.into_iter()), repeated);
    }

    #[test]
    fn the_machine_description_names_its_cores() {
        assert!(machine().contains(" core"));
    }
}
