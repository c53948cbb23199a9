//! The report as one JSON object: the run, and the tables.

use std::io::{self, Write};

use serde_json::{Map, Value as Json, json};

use super::run::Run;
use super::text::heading;
use crate::accuracy::{Row, Table, Timing, Value};

pub(crate) fn write(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    let run: Map<String, Json> =
        run.parts().into_iter().map(|(name, value)| (name.to_owned(), value.into())).collect();
    let tables: Map<String, Json> =
        tables.iter().map(|table| (table.name.to_owned(), object(table))).collect();
    serde_json::to_writer_pretty(&mut *output, &json!({ "run": run, "tables": tables }))?;
    output.write_all(b"\n")
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
    let figures = figures.map(|(column, value)| (heading(column), figure(*value)));
    keys.chain(figures).collect::<Map<String, Json>>().into()
}

fn figure(value: Value) -> Json {
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
