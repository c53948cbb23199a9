//! Tables of figures: as aligned text, Markdown, CSV and JSON.

use std::io::{self, Write};

use serde_json::Value;

/// A table of results.
pub(crate) struct Table {
    /// The subject in a word or two.
    pub(crate) title: &'static str,
    /// A description of the figures, with lines that fit a terminal.
    pub(crate) about: String,
    /// The headings of the columns.
    pub(crate) columns: Vec<String>,
    /// The number of leading columns that label a row. The others are figures.
    pub(crate) labels: usize,
    /// The rows, each with one cell for every column. A row without cells separates groups.
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    /// Writes the table for a terminal, followed by an empty line.
    pub(crate) fn write_text(&self, output: &mut impl Write) -> io::Result<()> {
        writeln!(output, "{}: {}\n", self.title, self.about)?;
        for row in self.lines() {
            let padded = row.iter().enumerate().map(|(column, cell)| {
                let width = self.width(column);
                if column < self.labels {
                    format!("{cell:<width$}")
                } else {
                    format!("{cell:>width$}")
                }
            });
            writeln!(output, "{}", padded.collect::<Vec<_>>().join("  ").trim_end())?;
        }
        writeln!(output)
    }

    /// Writes the table as Markdown, followed by an empty line.
    pub(crate) fn write_markdown(&self, output: &mut impl Write) -> io::Result<()> {
        writeln!(output, "**{}:** {}\n\n{}", self.title, self.about, self.markdown())
    }

    /// The header and the rows in Markdown.
    pub(crate) fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rules =
            (0..self.columns.len()).map(|column| if column < self.labels { "---" } else { "---:" });
        let rule = format!("|{}|\n", rules.collect::<Vec<_>>().join("|"));
        let rows: String = self.rows.iter().map(|row| line(row)).collect();
        line(&self.columns) + &rule + &rows
    }

    /// The header, and then all rows.
    fn lines(&self) -> impl Iterator<Item = &[String]> {
        std::iter::once(self.columns.as_slice()).chain(self.rows.iter().map(Vec::as_slice))
    }

    fn width(&self, column: usize) -> usize {
        let cells = self.lines().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or_default()
    }
}

/// A figure of each row, with its name in CSV and JSON.
pub(crate) type Figure<R> = (&'static str, fn(&R) -> Value);

/// Writes a line for each row, and one with the names before them.
pub(crate) fn write_csv<R>(
    figures: &[Figure<R>],
    rows: &[R],
    output: &mut impl Write,
) -> io::Result<()> {
    write_line(figures.iter().map(|(name, _)| (*name).to_owned()), output)?;
    rows.iter().try_for_each(|row| {
        let fields = figures.iter().map(|(_, figure)| match figure(row) {
            Value::Null => String::new(),
            Value::String(text) => text,
            figure => figure.to_string(),
        });
        write_line(fields, output)
    })
}

/// Writes a line of CSV. Fields with commas are in quotation marks.
pub(crate) fn write_line(
    fields: impl IntoIterator<Item = String>,
    output: &mut impl Write,
) -> io::Result<()> {
    let quoted = |field: String| {
        if field.contains([',', '"']) {
            format!("\"{}\"", field.replace('"', "\"\""))
        } else {
            field
        }
    };
    writeln!(output, "{}", fields.into_iter().map(quoted).collect::<Vec<_>>().join(","))
}

/// An object for each row.
pub(crate) fn objects<R>(figures: &[Figure<R>], rows: &[R]) -> Value {
    let object = |row: &R| -> Value {
        figures.iter().map(|(name, figure)| ((*name).to_owned(), figure(row))).collect()
    };
    rows.iter().map(object).collect()
}

/// Writes `value` in lines for people.
pub(crate) fn write_json(value: &Value, output: &mut impl Write) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *output, value)?;
    writeln!(output)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(write: impl FnOnce(&Table, &mut Vec<u8>) -> io::Result<()>) -> String {
        let row = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        let table = Table {
            title: "Fruit",
            about: "kilograms.".to_owned(),
            columns: row(["kind", "kg"]),
            labels: 1,
            rows: vec![row(["apples", "7"]), row(["figs", "12.5"])],
        };
        let mut bytes = Vec::new();
        write(&table, &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn words_begin_and_figures_end_together() {
        let text = "Fruit: kilograms.\n\nkind      kg\napples     7\nfigs    12.5\n\n";
        assert_eq!(written(Table::write_text), text);
    }

    #[test]
    fn pages_align_by_themselves() {
        let text = "**Fruit:** kilograms.\n\n| kind | kg |\n|---|---:|\n| apples | 7 |\n| figs | 12.5 |\n\n";
        assert_eq!(written(Table::write_markdown), text);
    }
}
