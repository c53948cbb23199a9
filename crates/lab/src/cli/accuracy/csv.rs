//! The report as CSV, with a line for each figure of each row.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::run::Run;
use crate::accuracy::{Table, Timing, Value};

pub(crate) fn write(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    output.write_all(text(run, tables).as_bytes())
}

/// All lines. The first ones say where the report comes from.
pub(crate) fn text(run: &Run, tables: &[Table]) -> String {
    let mut text =
        "table,problem,method,parameter,figure,unit,value,lower_quartile,upper_quartile\n"
            .to_owned();
    for (name, value) in run.parts() {
        add(&mut text, ["run", "", "", "", name, "", value, "", ""]);
    }
    for table in tables {
        for row in &table.rows {
            let [problem, method, parameter] = row.keys.each_ref().map(String::as_str);
            for (column, value) in table.columns.iter().zip(&row.values) {
                let [value, lower, upper] = fields(*value);
                let (name, unit) = (column.name.as_str(), column.unit);
                let line =
                    [table.name, problem, method, parameter, name, unit, &value, &lower, &upper];
                add(&mut text, line);
            }
        }
    }
    text
}

fn add(text: &mut String, fields: [&str; 9]) {
    for (index, field) in fields.into_iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        if field.contains([',', '"']) {
            // Writing to a string cannot fail.
            let _ = write!(text, "\"{}\"", field.replace('"', "\"\""));
        } else {
            text.push_str(field);
        }
    }
    text.push('\n');
}

/// A value and its quartiles; empty where there are none.
fn fields(value: Value) -> [String; 3] {
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
