//! The options of `config`.

use std::path::PathBuf;

use super::play::CONFIG;
use super::{Command, Subcommand};

/// Options of `config`.
#[derive(Debug, Default)]
pub(crate) struct Config {
    pub(crate) config: Option<PathBuf>,
}

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "config",
    about: "Print the settings in force, as a file with comments",
    details: "Says where the file lies and what each setting means. What it prints may be written to that \
              file, and changed there.",
    examples: "cellcaster config > config.toml",
    positionals: &[],
    options: &[&CONFIG],
    surplus: "takes no map",
    missing: "",
    read: |mut matches| Ok(Command::Config(Config { config: CONFIG.of(&mut matches) })),
};
