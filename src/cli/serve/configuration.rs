//! The configuration file: read at the start, and again at each hang-up.

use std::fs;
use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use super::signals::Hangups;
use crate::cli::Error;
use crate::cli::config::configuration_file;
use crate::server::{Config, LiveConfig, Logging, events};

/// Where the configuration comes from.
pub(super) struct Configuration {
    /// `None` if the system has no folder for it.
    file: Option<PathBuf>,
    /// Whether the file was named, and so has to exist.
    is_named: bool,
    /// The address of the command line, which goes before that of the file.
    listen: Option<SocketAddr>,
}

impl Configuration {
    /// The named file, or else the default one.
    pub(super) fn new(named: Option<PathBuf>, listen: Option<SocketAddr>) -> Self {
        let is_named = named.is_some();
        Self { file: named.or_else(|| configuration_file("serve.toml")), is_named, listen }
    }

    /// The content of the file; the defaults if the default file does not exist.
    pub(super) fn read(&self) -> Result<Config, Error> {
        let mut config = self.content()?;
        config.listen = self.listen.unwrap_or(config.listen);
        Ok(config)
    }

    fn content(&self) -> Result<Config, Error> {
        let Some(file) = &self.file else { return Ok(Config::default()) };
        let name = file.display().to_string();
        match fs::read_to_string(file) {
            Ok(text) => Ok(Config::parse(&text, &name)?),
            Err(error) if error.kind() == io::ErrorKind::NotFound && !self.is_named => {
                Ok(Config::default())
            }
            Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
        }
    }

    /// Reads the file again at each hang-up. With a fault in it, the configuration stays as it is.
    pub(super) async fn follow(self, mut hangups: Hangups, live: LiveConfig, logging: Logging) {
        loop {
            hangups.next().await;
            match self.read() {
                Ok(config) => {
                    logging.set_filter(&config.log);
                    let fixed = live.replace(config);
                    events::reloaded(self.file.as_deref(), &fixed);
                }
                Err(error) => error.to_string().lines().for_each(events::configuration_fault),
            }
        }
    }
}
