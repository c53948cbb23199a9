//! The report as tables in Markdown.

use std::io::{self, Write};

use super::run::Run;
use super::text::{headings, rows};
use crate::accuracy::Table;

pub(crate) fn write(run: &Run, tables: &[Table], output: &mut impl Write) -> io::Result<()> {
    for table in tables {
        writeln!(output, "## {}\n\n{}.\n", table.name, table.title)?;
        write_table(table, output)?;
        writeln!(output)?;
    }
    writeln!(output, "{}", run.sentence())
}

/// Writes the headings and the rows.
pub(crate) fn write_table(table: &Table, output: &mut impl Write) -> io::Result<()> {
    let keys = table.keys.iter().filter(|key| !key.is_empty()).count();
    let headings = headings(table);
    let alignments = (0..headings.len()).map(|index| if index < keys { "---" } else { "---:" });
    writeln!(output, "| {} |", headings.join(" | "))?;
    writeln!(output, "|{}|", alignments.collect::<Vec<_>>().join("|"))?;
    rows(table).try_for_each(|cells| writeln!(output, "| {} |", cells.join(" | ")))
}
