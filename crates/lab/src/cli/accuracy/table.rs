//! The report as tables for people.

use std::io::{self, Write};

use super::run::Run;
use super::text::{headings, rows};
use crate::accuracy::Table;

pub(crate) fn write(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    for table in tables {
        write_table(table, output)?;
        writeln!(output)?;
    }
    writeln!(output, "{}", run.sentence())
}

fn write_table(table: &Table, output: &mut impl Write) -> io::Result<()> {
    writeln!(output, "{}: {}.\n", table.name, table.title)?;
    let keys = table.keys.iter().filter(|key| !key.is_empty()).count();
    let lines: Vec<Vec<String>> = std::iter::once(headings(table)).chain(rows(table)).collect();
    let widths: Vec<usize> = (0..lines[0].len())
        .map(|column| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0))
        .collect();
    for line in &lines {
        let cells = line.iter().zip(&widths).enumerate().map(|(index, (cell, &width))| {
            if index < keys { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        writeln!(output, "  {}", cells.collect::<Vec<_>>().join("  ").trim_end())?;
    }
    Ok(())
}
