//! `cellcaster config`: prints the current settings as a configuration file.

use std::io;
use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::Error;
use super::machine::configuration_file;
use super::output_file::print;
use crate::app::Configuration;
use crate::app::store::private;
use crate::fault::printable;

/// The size limit of a configuration file, in bytes.
pub const MAX_BYTES: u64 = 1 << 20;

/// Print the current settings as a file with comments
///
/// Shows the path of the file and the meaning of each setting. To change settings, save the output to that file and
/// edit it.
#[derive(Args, Debug)]
#[command(after_long_help = "Examples:\n  cellcaster config > config.toml")]
pub(crate) struct Config {
    /// The settings file [default: cellcaster/config.toml in the folder for configuration files]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    config: Option<PathBuf>,
}

/// The current configuration, and the path of its file.
pub(crate) struct CurrentConfiguration {
    pub(crate) configuration: Configuration,
    pub(crate) path: Option<PathBuf>,
    /// `true` if the file exists.
    is_there: bool,
}

/// Prints the configuration as a file that produces the same settings.
pub(crate) fn run(options: Config) -> Result<(), Error> {
    let CurrentConfiguration { configuration, path, is_there } = load(options.config)?;
    let place = match path {
        Some(path) if is_there => format!("# Settings of Cellcaster, from {}", path.display()),
        Some(path) => format!(
            "# Settings of Cellcaster: the defaults, because there is no file {}",
            path.display()
        ),
        None => "# Settings of Cellcaster: the defaults, because there is no folder for the file"
            .to_owned(),
    };
    let text = format!("{}\n\n{configuration}", printable(&place));
    print(text.as_bytes())
}

/// The configuration in the file `named`, or in the user's own file if it exists.
pub(crate) fn load(named: Option<PathBuf>) -> Result<CurrentConfiguration, Error> {
    let is_named = named.is_some();
    let Some(path) = named.or_else(|| configuration_file("config.toml")) else {
        return Ok(CurrentConfiguration {
            configuration: Configuration::default(),
            path: None,
            is_there: false,
        });
    };
    let name = path.display().to_string();
    let (configuration, is_there) = match private::read_text(&path, MAX_BYTES) {
        Ok(text) => (Configuration::parse(&text, &name)?, true),
        Err(error) if error.kind() == io::ErrorKind::NotFound && !is_named => {
            (Configuration::default(), false)
        }
        Err(error) => return Err(Error::mistake(format!("{name} can't be read: {error}"))),
    };
    Ok(CurrentConfiguration { configuration, path: Some(path), is_there })
}
