//! Replacing the tables of a page, which is written by hand for the rest.
//!
//! A table stands between two lines of the page: `<!-- accuracy NAME -->`, and `<!-- end -->`. Below
//! it stand the run that it comes from and the plot, which is a file in the folder `docs` beside the
//! page. Tables and plots of a page are therefore of one run.

use std::fs;
use std::io::Write as _;
use std::path::Path;

use super::run::Run;
use super::{markdown, plot};
use crate::accuracy::Table;
use cellcaster::cli::Error;
use cellcaster::cli::output_file::OutputFile;

/// Replaces `tables` in the page at `path`, and writes their plots.
pub(crate) fn update(path: &Path, run: &Run, tables: &[Table]) -> Result<(), Error> {
    let name = path.display();
    let mut page = fs::read_to_string(path)
        .map_err(|error| Error::mistake(format!("{name} can't be read: {error}")))?;
    for table in tables {
        page = replaced(&page, run, table).ok_or_else(|| {
            Error::mistake(format!(
                "{name} has no place for the table \"{}\", which is a line \"{}\" and later \"{END}\"",
                table.name,
                begin(table),
            ))
        })?;
        if !table.diagrams.is_empty() {
            let file = path.with_file_name(plot_of(table));
            OutputFile::create(&file)?
                .write(|output| plot::write_svg(run, std::slice::from_ref(table), output))?;
        }
    }
    OutputFile::create(path)?.write(|output| output.write_all(page.as_bytes()))
}

const END: &str = "<!-- end -->";

fn begin(table: &Table) -> String {
    format!("<!-- accuracy {} -->", table.name)
}

/// The file of the plot, relative to the page.
fn plot_of(table: &Table) -> String {
    format!("docs/accuracy-{}.svg", table.name)
}

/// `page` with another `table`; `None` if it has no place for it.
fn replaced(page: &str, run: &Run, table: &Table) -> Option<String> {
    let begin = begin(table);
    let (before, after) = page.split_once(&begin)?;
    let (_, after) = after.split_once(END)?;
    let mut block = Vec::new();
    // Writing to memory cannot fail.
    let _ = markdown::write_table(table, &mut block);
    let block = String::from_utf8_lossy(&block);
    let plot = if table.diagrams.is_empty() {
        String::new()
    } else {
        format!("\n![{}]({})\n", table.title, plot_of(table))
    };
    let sentence = run.sentence();
    Some(format!("{before}{begin}\n{plot}\n{block}\n{sentence}\n\n{END}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::accuracy::{Column, Row, Value};

    fn table() -> Table {
        let keys = ["", "method", ""];
        let row = Row { keys: ["", "dda", ""].map(str::to_owned), values: vec![Value::Count(3)] };
        Table {
            name: "few",
            title: "A few",
            keys,
            columns: vec![Column { name: "rays".to_owned(), unit: "" }],
            rows: vec![row],
            diagrams: Vec::new(),
        }
    }

    #[test]
    fn a_table_replaces_what_stands_in_its_place() {
        let run = Run::this();
        let page = "Text.\n\n<!-- accuracy few -->\nold\n<!-- end -->\n\nMore.\n";
        let new = replaced(page, &run, &table()).unwrap();
        assert!(new.starts_with("Text.\n\n<!-- accuracy few -->\n"), "{new}");
        assert!(new.ends_with("\n<!-- end -->\n\nMore.\n"), "{new}");
        assert!(new.contains("| method | rays |\n|---|---:|\n| dda | 3 |\n"), "{new}");
        assert_eq!(replaced(&new, &run, &table()).unwrap(), new);
        assert!(replaced("Text.", &run, &table()).is_none());
    }
}
