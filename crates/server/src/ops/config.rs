//! The configuration of a server: where it listens, and every limit.
//!
//! ```toml
//! listen = "[::]:2222"
//! connections = 400
//! connections-per-address = 100    # behind a proxy, all visitors have one address
//! message = "Races every Friday at 20:00"
//! log = "info,connections=warn"
//! maps = "/var/lib/cellcaster/maps"
//!
//! [metrics]
//! listen = "127.0.0.1:9464"
//!
//! [[room]]
//! mode = "race"
//! level = "cellar"
//! ```
//!
//! All faults of a file are reported in one run, each with its place. Only whether a level exists is
//! checked after the maps were read, by [`Config::check_levels`]: the file says where they are.

mod settings;
mod standing;

use std::fmt;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use toml::de::DeTable;

use self::settings::{LISTEN, MAPS, MAPS_EXAMPLE, METRICS_EXAMPLE, METRICS_LISTEN, NUMBERS, TEXTS};
pub use self::standing::StandingRoom;
use crate::accounts::AccountRate;
use crate::ops::logging::LogFilter;
use crate::ssh::admission::Limits;
use cellcaster::app::parts::Setting;
use cellcaster::fault::document::{self, Entry, FaultList};
use cellcaster::fault::{Fault, Faults};

/// The content of a configuration file, with defaults for missing settings.
///
/// Its `Display` output is a complete file with comments, which parses to the same configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The address and port to listen at.
    pub listen: SocketAddr,
    /// The name of the host: one line, which the lobby shows.
    pub name: String,
    /// The message of the day: one line, which the lobby shows; may be empty.
    pub message: String,
    /// What is logged.
    pub log: LogFilter,
    /// The folder of the host's own maps, if there is one.
    pub maps: Option<PathBuf>,
    /// Where metrics are read by HTTP; nowhere if `None`.
    pub metrics: Option<SocketAddr>,
    /// Which connections are admitted.
    pub admission: Limits,
    /// How many accounts a network may make.
    pub accounts: AccountRate,
    /// The time in which a client sends its half of the key exchange. Its version has to arrive within three
    /// seconds.
    pub handshake: Duration,
    /// The time in which a session begins. Its user may have to check the host key and to type a
    /// passphrase.
    pub login: Duration,
    /// The most bytes that a client sends before authentication.
    pub login_bytes: u32,
    /// The most bytes that a client sends in a second after it.
    pub bytes_per_second: u32,
    /// A client from which nothing comes for this time, not even an answer, has gone.
    pub silence: Duration,
    /// A client that takes no bytes for this time is disconnected, even if it answers.
    pub stall: Duration,
    /// The most columns of a window; further ones are left blank.
    pub columns: u16,
    /// The most rows of a window.
    pub rows: u16,
    /// The time that sessions have for their end when the server ends.
    pub drain: Duration,
    /// The most rooms.
    pub rooms: u32,
    /// The most who watch one room.
    pub watchers: u32,
    /// The time after which a room without members is closed.
    pub empty_room: Duration,
    /// The most frames that a session gets in a second.
    pub frames_per_second: u32,
    /// The rooms that are always there.
    pub standing: Vec<StandingRoom>,
    /// The folder in which rooms are recorded, if they are.
    pub recordings: Option<PathBuf>,
}

impl Default for Config {
    fn default() -> Self {
        Self {
            listen: SocketAddr::from((Ipv4Addr::LOCALHOST, 2222)),
            name: "Cellcaster".to_owned(),
            message: String::new(),
            log: LogFilter::default(),
            maps: None,
            metrics: None,
            admission: Limits::default(),
            accounts: AccountRate::default(),
            handshake: Duration::from_secs(20),
            login: Duration::from_mins(2),
            login_bytes: 64 << 10,
            bytes_per_second: 64 << 10,
            silence: Duration::from_secs(12),
            stall: Duration::from_mins(1),
            columns: 500,
            rows: 200,
            drain: Duration::from_secs(10),
            rooms: 200,
            watchers: 32,
            empty_room: Duration::from_mins(1),
            frames_per_second: 30,
            standing: StandingRoom::usual(),
            recordings: None,
        }
    }
}

impl Config {
    /// Parses a configuration file, which faults refer to as `name`.
    ///
    /// # Errors
    /// All faults of the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        let mut config = Self::default();
        if faults.is_empty() {
            config.read(&document, &faults);
        }
        if faults.is_empty() { Ok(config) } else { Err(Faults::new(name, text, faults.take())) }
    }

    fn read(&mut self, document: &DeTable, faults: &FaultList) {
        let settings = || TEXTS.iter().chain(&NUMBERS);
        for entry in document::entries(document, faults) {
            if let Some(setting) = settings().find(|setting| setting.key == entry.key) {
                setting.value.read(&entry, self);
            } else if entry.key == "metrics" {
                self.read_metrics(&entry);
            } else if entry.key == "room" {
                self.standing = standing::read(&entry).unwrap_or_default();
            } else {
                let keys = settings().map(|setting| setting.key);
                let known: Vec<&str> = keys.chain(["metrics", "room"]).collect();
                faults.push(entry.unknown_key("the configuration", &known));
            }
        }
        self.check_room_count(document, faults);
    }

    fn check_room_count(&self, document: &DeTable, faults: &FaultList) {
        let (standing, most) = (self.standing.len(), self.rooms as usize);
        if let Some((key, _)) = document.get_key_value("room").filter(|_| standing > most) {
            let message = format!("{standing} standing rooms are more than the limit of rooms");
            let help = format!("write rooms = {standing} or more");
            faults.push(Fault::new(key.span(), message).help(help));
        }
    }

    fn read_metrics(&mut self, metrics: &Entry<'_, '_>) {
        let Some(table) = metrics.table("[metrics]") else { return };
        for entry in metrics.entries(table) {
            if entry.key == METRICS_LISTEN.key {
                METRICS_LISTEN.value.read(&entry, self);
            } else {
                entry.faults.push(entry.unknown_key("[metrics]", &[METRICS_LISTEN.key]));
            }
        }
    }
}

impl fmt::Display for Config {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, Setting { key, about, value }) in TEXTS.iter().enumerate() {
            let blank = if index > 0 { "\n" } else { "" };
            writeln!(f, "{blank}# {about}")?;
            match value.write(self) {
                value if value.is_empty() => writeln!(f, "# {MAPS_EXAMPLE}")?,
                value => writeln!(f, "{key} = {value}")?,
            }
        }
        if self.standing.is_empty() {
            writeln!(f, "\n# no standing rooms\nroom = []")?;
        }
        for Setting { key, about, value } in &NUMBERS {
            if !about.is_empty() {
                writeln!(f, "\n# {}", about.replace('\n', "\n# "))?;
            }
            writeln!(f, "{key} = {}", value.write(self))?;
        }
        writeln!(f, "\n# {}\n[metrics]", METRICS_LISTEN.about)?;
        match METRICS_LISTEN.value.write(self) {
            value if value.is_empty() => writeln!(f, "# {METRICS_EXAMPLE}")?,
            value => writeln!(f, "{} = {value}", METRICS_LISTEN.key)?,
        }
        if !self.standing.is_empty() {
            writeln!(f, "\n# the rooms that are always there")?;
        }
        self.standing.iter().try_for_each(|room| write!(f, "{room}"))
    }
}

/// The configuration in force, which can change while the server runs. Clones share it.
#[derive(Clone, Debug)]
pub struct LiveConfig(Arc<watch::Sender<Arc<Config>>>);

impl LiveConfig {
    /// The configuration of a server that starts.
    pub fn new(config: Config) -> Self {
        Self(Arc::new(watch::Sender::new(Arc::new(config))))
    }

    /// The configuration now.
    pub fn get(&self) -> Arc<Config> {
        self.0.borrow().clone()
    }

    /// Tells changes.
    pub fn subscribe(&self) -> watch::Receiver<Arc<Config>> {
        self.0.subscribe()
    }

    /// Replaces the configuration, except for addresses that the server listens at and the folder of
    /// maps. Returns the names of settings that `wanted` would change and that stay until the next
    /// start.
    pub fn replace(&self, mut wanted: Config) -> Vec<&'static str> {
        let now = self.get();
        let fixed = [("listen", LISTEN), ("metrics.listen", METRICS_LISTEN), ("maps", MAPS)];
        let fixed = fixed.into_iter().filter_map(|(name, Setting { value, .. })| {
            let differs = value.differs(&wanted, &now);
            value.copy(&now, &mut wanted);
            differs.then_some(name)
        });
        let fixed = fixed.collect();
        // Of the command line alone.
        wanted.recordings.clone_from(&now.recordings);
        self.0.send_replace(Arc::new(wanted));
        fixed
    }
}

#[cfg(test)]
mod tests;
