//! `cellcaster completions`: shell completions from the description of the arguments.

use std::io::{self, Write};

use clap_complete::{Shell, generate};

use super::{Error, arguments};

/// Writes the completions for `shell`.
pub(crate) fn run(shell: Shell) -> Result<(), Error> {
    let mut script = Vec::new();
    generate(shell, &mut arguments::description(), "cellcaster", &mut script);
    io::stdout().write_all(&script).map_err(|error| Error::of_output(&error))
}
