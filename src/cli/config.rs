//! `cellcaster config`: the settings in force, as a file.

use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

use etcetera::{BaseStrategy, choose_base_strategy};

use super::Error;
use super::arguments::Config;
use crate::app::Configuration;

/// The configuration in force, and where its file lies.
pub(super) struct InForce {
    pub(super) configuration: Configuration,
    path: Option<PathBuf>,
    /// Whether there is a file at all.
    is_there: bool,
}

/// Prints the configuration as a file that says the same.
pub(super) fn run(options: Config) -> Result<(), Error> {
    let InForce { configuration, path, is_there } = load(options.config)?;
    let place = match path {
        Some(path) if is_there => format!("# Settings of Cellcaster, from {}", path.display()),
        Some(path) => format!(
            "# Settings of Cellcaster: the defaults, as there is no file {}",
            path.display()
        ),
        None => {
            "# Settings of Cellcaster: the defaults, as there is no folder for a file".to_owned()
        }
    };
    let text = format!("{}\n\n{configuration}", place.replace(char::is_control, "?"));
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))
}

/// What the file says that was named, or the user's own if there is one.
pub(super) fn load(named: Option<PathBuf>) -> Result<InForce, Error> {
    let is_named = named.is_some();
    let Some(path) = named.or_else(default_path) else {
        return Ok(InForce {
            configuration: Configuration::default(),
            path: None,
            is_there: false,
        });
    };
    let name = path.display().to_string();
    let (configuration, is_there) = match fs::read_to_string(&path) {
        Ok(text) => (Configuration::parse(&text, &name)?, true),
        Err(error) if error.kind() == io::ErrorKind::NotFound && !is_named => {
            (Configuration::default(), false)
        }
        Err(error) => return Err(Error::mistake(format!("{name} can't be read: {error}"))),
    };
    Ok(InForce { configuration, path: Some(path), is_there })
}

/// `cellcaster/config.toml` where the platform keeps configuration.
fn default_path() -> Option<PathBuf> {
    let folder = choose_base_strategy().ok()?.config_dir();
    Some(folder.join("cellcaster").join("config.toml"))
}
