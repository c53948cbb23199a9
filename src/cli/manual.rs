//! `cellcaster man`: the manual page, from the description of the arguments.
//!
//! There is one page for everything, because separate pages for commands would all have to be
//! installed.

use std::io::{self, Write};

use clap_mangen::Man;

use super::{Error, arguments};

/// Writes the page in roff.
pub(crate) fn run() -> Result<(), Error> {
    let page = page().map_err(|error| Error::machine(format!("no manual page: {error}")))?;
    io::stdout().write_all(&page).map_err(|error| Error::of_output(&error))
}

fn page() -> io::Result<Vec<u8>> {
    // The text after the options repeats the other sections of the page.
    let mut program = arguments::description().after_help(None).after_long_help(None);
    program.build();
    let subcommands: Vec<_> = program.get_subcommands().cloned().collect();
    let man = Man::new(program);
    let mut page = Vec::new();
    man.render_title(&mut page)?;
    man.render_name_section(&mut page)?;
    man.render_synopsis_section(&mut page)?;
    man.render_description_section(&mut page)?;
    man.render_options_section(&mut page)?;
    for subcommand in subcommands {
        render_subcommand(subcommand, &mut page)?;
    }
    Ok(page)
}

/// A section for a command, instead of the several sections of a separate page.
fn render_subcommand(command: clap::Command, page: &mut Vec<u8>) -> io::Result<()> {
    let name = command.get_name().to_uppercase();
    let man = Man::new(command);
    let mut sections = Vec::new();
    man.render_synopsis_section(&mut sections)?;
    man.render_description_section(&mut sections)?;
    man.render_options_section(&mut sections)?;
    man.render_extra_section(&mut sections)?;
    writeln!(page, ".SH {name}")?;
    page.append(&mut sections);
    Ok(())
}
