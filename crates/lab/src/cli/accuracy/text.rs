//! Figures in words and digits.

use crate::accuracy::{Column, Table, Timing, Value};

/// The headings of all columns that `table` shows: of the keys, and of the figures with their units.
pub(crate) fn headings(table: &Table) -> Vec<String> {
    let keys = table.keys.iter().filter(|key| !key.is_empty()).map(|key| (*key).to_owned());
    keys.chain(table.columns.iter().map(heading)).collect()
}

/// The name of a column with its unit.
pub(crate) fn heading(column: &Column) -> String {
    match column.unit {
        "" => column.name.clone(),
        unit => format!("{}, {unit}", column.name),
    }
}

/// The cells of each row: the keys that `table` shows, and the figures.
pub(crate) fn rows(table: &Table) -> impl Iterator<Item = Vec<String>> {
    table.rows.iter().map(|row| {
        let keys = table.keys.iter().zip(&row.keys).filter(|(heading, _)| !heading.is_empty());
        let values = row.values.iter().map(|&value| figure(value));
        keys.map(|(_, key)| key.clone()).chain(values).collect()
    })
}

/// A figure; a dash if there is none.
pub(crate) fn figure(value: Value) -> String {
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
