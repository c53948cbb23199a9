//! Pages whose tables a command writes, and whose other text is written by hand.
//!
//! A table stands between two lines of the page, such as `<!-- accuracy rays -->` and `<!-- end -->`. The run that
//! produced them is named below the last table. Its plot is a file beside the page, from the same run.

use std::fs;
use std::io::Write;
use std::path::Path;
use std::slice;

use super::{Format, Origin, Report, Table, markdown};
use cellcaster::cli::Error;
use cellcaster::cli::output_file::OutputFile;

/// Replaces the `tables` of `command` in the page at `path`, and writes their plots.
///
/// # Errors
/// If the page has no place for a table, or a file cannot be read or written.
pub(crate) fn update_page(path: &Path, command: &str, tables: &[Table]) -> Result<(), Error> {
    let origin = &Origin::this();
    let name = path.display();
    let mut page = fs::read_to_string(path)
        .map_err(|error| Error::mistake(format!("{name} can't be read: {error}")))?;
    for (index, table) in tables.iter().enumerate() {
        let origin_below = (index + 1 == tables.len()).then_some(origin);
        page = replaced(&page, command, origin_below, table).ok_or_else(|| {
            Error::mistake(format!(
                "{name} has no place for the table \"{}\": add a line \"{}\" and below it a line \"{END}\"",
                table.name,
                begin(command, table),
            ))
        })?;
        if !table.diagrams.is_empty() {
            let file = path.with_file_name(plot_of(command, table));
            let report = Report { origin, tables: slice::from_ref(table) };
            OutputFile::create(&file)?.write(|output| report.write(Format::Svg, output))?;
        }
    }
    OutputFile::create(path)?.write(|output| output.write_all(page.as_bytes()))
}

const END: &str = "<!-- end -->";

fn begin(command: &str, table: &Table) -> String {
    format!("<!-- {command} {} -->", table.name)
}

/// The file of the plot, beside the page.
fn plot_of(command: &str, table: &Table) -> String {
    format!("{command}-{}.svg", table.name)
}

/// Returns `page` with the new `table`; `None` if it has no place for it.
fn replaced(page: &str, command: &str, origin: Option<&Origin>, table: &Table) -> Option<String> {
    let begin = begin(command, table);
    let (before, after) = page.split_once(&begin)?;
    let (_, after) = after.split_once(END)?;
    let block = markdown(table);
    let plot = if table.diagrams.is_empty() {
        String::new()
    } else {
        format!("\n![{}]({})\n", table.title, plot_of(command, table))
    };
    let sentence = origin.map_or(String::new(), |origin| format!("{}\n\n", origin.sentence()));
    Some(format!("{before}{begin}\n{plot}\n{block}\n{sentence}{END}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Row, Value, headings};

    fn table() -> Table {
        Table {
            name: "few",
            title: "A few".to_owned(),
            keys: ["", "method", ""],
            columns: headings(["rays"]),
            rows: vec![Row::new(["", "dda", ""], vec![Value::Count(3)])],
            diagrams: Vec::new(),
        }
    }

    #[test]
    fn a_table_replaces_the_text_between_its_markers() {
        let run = Origin::this();
        let page = "Text.\n\n<!-- accuracy few -->\nold\n<!-- end -->\n\nMore.\n";
        let new = replaced(page, "accuracy", Some(&run), &table()).unwrap();
        assert!(new.starts_with("Text.\n\n<!-- accuracy few -->\n"), "{new}");
        assert!(new.ends_with("\n<!-- end -->\n\nMore.\n"), "{new}");
        assert!(new.contains("| method | rays |\n|---|---:|\n| dda | 3 |\n"), "{new}");
        assert_eq!(replaced(&new, "accuracy", Some(&run), &table()).unwrap(), new);
        assert!(replaced("Text.", "accuracy", Some(&run), &table()).is_none());
    }
}
