//! A table, as aligned text or as Markdown.

use std::io::{self, Write};

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
    /// The rows, each with one cell for every column.
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
        let mut lines = self.lines();
        let header = lines.next().unwrap_or_default();
        let rules =
            (0..header.len()).map(|column| if column < self.labels { "---" } else { "--:" });
        let rule = rules.collect::<Vec<_>>().join("|");
        writeln!(
            output,
            "**{}:** {}\n\n| {} |\n|{rule}|",
            self.title,
            self.about,
            header.join(" | ")
        )?;
        lines.try_for_each(|row| writeln!(output, "| {} |", row.join(" | ")))?;
        writeln!(output)
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
        let text = "**Fruit:** kilograms.\n\n| kind | kg |\n|---|--:|\n| apples | 7 |\n| figs | 12.5 |\n\n";
        assert_eq!(written(Table::write_markdown), text);
    }
}
