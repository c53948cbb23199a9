//! The configuration: the file and the maps that it names, read at the start; the file again at each
//! hang-up.

use std::io;
use std::net::SocketAddr;
use std::path::PathBuf;

use super::signals::Hangups;
use crate::cli::arguments::Serve;
use crate::config::{Config, LiveConfig};
use crate::logging::{self, Logging};
use crate::rooms::maps::{HostMaps, MapsError};
use cellcaster::app::store::private;
use cellcaster::cli::Error;
use cellcaster::cli::config::LARGEST;
use cellcaster::cli::machine::configuration_file;

/// Where the configuration comes from.
pub(crate) struct Configuration {
    /// `None` if the system has no folder for it.
    file: Option<PathBuf>,
    /// Whether the file was named, and so has to exist.
    is_named: bool,
    /// What the command line says, which goes before the file.
    listen: Option<SocketAddr>,
    maps_folder: Option<PathBuf>,
    recordings: Option<PathBuf>,
    maps: HostMaps,
}

impl Configuration {
    /// Reads the file that `options` name, or else the default one, and the maps.
    pub(crate) fn begin(options: &Serve) -> Result<(Self, Config), Error> {
        let mut configuration = Self {
            file: options.config.clone().or_else(|| configuration_file("serve.toml")),
            is_named: options.config.is_some(),
            listen: options.listen,
            maps_folder: options.maps.clone(),
            recordings: options.record_room.clone(),
            maps: HostMaps::default(),
        };
        let text = configuration.text()?;
        let config = configuration.parse(&text)?;
        if let Some(folder) = &config.maps {
            let maps = HostMaps::read(folder);
            configuration.maps = maps.map_err(refused)?;
        }
        configuration.check_levels(&text)?;
        Ok((configuration, config))
    }

    /// The maps, which are read once.
    pub(crate) fn maps(&self) -> &HostMaps {
        &self.maps
    }

    /// Reads the file again at each hang-up. With a fault in it, the configuration stays as it is.
    pub(crate) async fn follow(self, mut hangups: Hangups, live: LiveConfig, logging: Logging) {
        loop {
            hangups.next().await;
            match self.read_again() {
                Ok(config) => {
                    logging.set_filter(&config.log);
                    let fixed = live.replace(config);
                    logging::reloaded(self.file.as_deref(), &fixed);
                }
                Err(error) => error.to_string().lines().for_each(logging::configuration_fault),
            }
        }
    }

    fn read_again(&self) -> Result<Config, Error> {
        let text = self.text()?;
        let config = self.parse(&text)?;
        // Other maps than those that were read have no effect until the next start.
        self.check_levels(&text)?;
        Ok(config)
    }

    fn parse(&self, text: &str) -> Result<Config, Error> {
        let mut config = Config::parse(text, &self.file_name())?;
        config.listen = self.listen.unwrap_or(config.listen);
        config.maps = self.maps_folder.clone().or(config.maps);
        config.recordings.clone_from(&self.recordings);
        Ok(config)
    }

    fn check_levels(&self, text: &str) -> Result<(), Error> {
        Ok(Config::check_levels(text, &self.file_name(), &self.maps.level_names())?)
    }

    /// The content of the file; an empty one if the default file does not exist.
    fn text(&self) -> Result<String, Error> {
        let Some(file) = &self.file else { return Ok(String::new()) };
        match private::read_text(file, LARGEST) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && !self.is_named => {
                Ok(String::new())
            }
            text => text.map_err(|error| {
                Error::mistake(format!("{} can't be read: {error}", self.file_name()))
            }),
        }
    }

    fn file_name(&self) -> String {
        self.file.as_ref().map_or_else(String::new, |file| file.display().to_string())
    }
}

fn refused(error: MapsError) -> Error {
    match error {
        MapsError::Sentence(sentence) => Error::mistake(sentence),
        MapsError::Report(text) => Error::report_of(text),
    }
}
