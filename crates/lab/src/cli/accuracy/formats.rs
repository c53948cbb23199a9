//! The formats of the report but for its plots: tables for people and in Markdown, CSV and JSON.

use std::io::{self, Write};

use serde_json::{Map, Value as Json, json};

use super::run::Run;
use crate::accuracy::{Column, Row, Table, Timing, Value};
use crate::cli::table::{self, write_json, write_line};

/// Writes tables for people.
pub(crate) fn write_text(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    tables.iter().try_for_each(|table| in_words(table).write_text(output))?;
    writeln!(output, "{}", run.sentence())
}

/// Writes tables in Markdown.
pub(crate) fn write_markdown(
    run: &Run,
    tables: &[Table],
    output: &mut impl Write,
) -> io::Result<()> {
    for table in tables {
        writeln!(output, "## {}\n\n{}.\n\n{}", table.name, table.title, markdown(table))?;
    }
    writeln!(output, "{}", run.sentence())
}

/// The headings and the rows in Markdown.
pub(crate) fn markdown(table: &Table) -> String {
    in_words(table).markdown()
}

/// Writes one JSON object: the run, and the tables.
pub(crate) fn write_object(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    let run: Map<String, Json> =
        run.parts().into_iter().map(|(name, value)| (name.to_owned(), value.into())).collect();
    let tables: Map<String, Json> =
        tables.iter().map(|table| (table.name.to_owned(), object(table))).collect();
    write_json(&json!({ "run": run, "tables": tables }), output)
}

/// All lines. The first ones say where the report comes from.
pub(crate) fn csv(run: &Run, tables: &[Table]) -> String {
    const HEADER: &str =
        "table,problem,method,parameter,figure,unit,value,lower_quartile,upper_quartile\n";
    let mut text = HEADER.as_bytes().to_vec();
    let mut add = |fields: [&str; 9]| {
        // Writing to memory cannot fail.
        _ = write_line(fields.map(str::to_owned), &mut text);
    };
    for (name, value) in run.parts() {
        add(["run", "", "", "", name, "", value, "", ""]);
    }
    for table in tables {
        for row in &table.rows {
            let [problem, method, parameter] = row.keys.each_ref().map(String::as_str);
            for (column, value) in table.columns.iter().zip(&row.values) {
                let [value, lower, upper] = csv_fields(*value);
                let (name, unit) = (column.name.as_str(), column.unit);
                let line =
                    [table.name, problem, method, parameter, name, unit, &value, &lower, &upper];
                add(line);
            }
        }
    }
    String::from_utf8(text).unwrap_or_default()
}

/// `table` with its figures in words and digits.
fn in_words(table: &Table) -> table::Table {
    let keys = || table.keys.iter().filter(|key| !key.is_empty());
    let row = |row: &Row| {
        let keys = table.keys.iter().zip(&row.keys).filter(|(heading, _)| !heading.is_empty());
        keys.map(|(_, key)| key.clone()).chain(row.values.iter().map(|&it| figure(it))).collect()
    };
    table::Table {
        title: table.name,
        about: format!("{}.", table.title),
        columns: keys()
            .map(|key| (*key).to_owned())
            .chain(table.columns.iter().map(heading))
            .collect(),
        labels: keys().count(),
        rows: table.rows.iter().map(row).collect(),
    }
}

/// The name of a column with its unit.
pub(crate) fn heading(column: &Column) -> String {
    match column.unit {
        "" => column.name.clone(),
        unit => format!("{}, {unit}", column.name),
    }
}

fn object(table: &Table) -> Json {
    let rows: Vec<Json> = table.rows.iter().map(|row| fields(table, row)).collect();
    json!({ "title": table.title, "rows": rows })
}

/// The keys and the figures of `row` by their headings.
fn fields(table: &Table, row: &Row) -> Json {
    let keys = table.keys.iter().zip(&row.keys).filter(|(heading, _)| !heading.is_empty());
    let keys = keys.map(|(heading, key)| ((*heading).to_owned(), Json::from(key.as_str())));
    let figures = table.columns.iter().zip(&row.values);
    let figures = figures.map(|(column, value)| (heading(column), json_figure(*value)));
    keys.chain(figures).collect::<Map<String, Json>>().into()
}

fn json_figure(value: Value) -> Json {
    match value {
        Value::None => Json::Null,
        Value::Count(count) => count.into(),
        // There is no infinity in JSON.
        Value::Share(number) | Value::Number(number) if !number.is_finite() => "inf".into(),
        Value::Share(number) | Value::Number(number) => number.into(),
        Value::Time(Timing { median, lower_quartile, upper_quartile }) => json!({
            "median": median,
            "lower_quartile": lower_quartile,
            "upper_quartile": upper_quartile,
        }),
    }
}

/// A value and its quartiles for CSV; empty where there are none.
fn csv_fields(value: Value) -> [String; 3] {
    let one = |text: String| [text, String::new(), String::new()];
    match value {
        Value::None => one(String::new()),
        Value::Count(count) => one(count.to_string()),
        Value::Share(number) | Value::Number(number) => one(number.to_string()),
        Value::Time(Timing { median, lower_quartile, upper_quartile }) => {
            [median, lower_quartile, upper_quartile].map(|time| format!("{time:.2}"))
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
        Value::Time(Timing { median, lower_quartile, upper_quartile }) => {
            format!("{median:.1} ({lower_quartile:.1}–{upper_quartile:.1})")
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
    } else if (1000.0..100_000.0).contains(&number) {
        format!("{number:.0}")
    } else if (0.01..1000.0).contains(&number) {
        let text = format!("{number:.3}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{number:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_zero_is_zero() {
        let figures = [
            Value::Count(0),
            Value::Share(0.0),
            Value::Share(1e-9),
            Value::Share(0.1719),
            Value::Number(0.0),
            Value::Number(4.7e-17),
            Value::Number(0.25),
            Value::Number(12.0),
            Value::Number(59_951.2),
            Value::Number(1e5),
            Value::Number(f64::INFINITY),
            Value::None,
        ];
        let texts = figures.map(figure).join(" | ");
        assert_eq!(
            texts,
            "0 | 0 | <0.01 % | 17.19 % | 0 | 4.7e-17 | 0.25 | 12 | 59951 | 1.0e5 | inf | –"
        );
    }
}
