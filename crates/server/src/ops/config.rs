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

mod live;
mod read;
mod settings;
mod standing;
mod write;

use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::time::Duration;

use crate::accounts::AccountRate;
use crate::ops::logging::LogFilter;
use crate::ssh::admission::Limits;
pub use live::LiveConfig;
pub use standing::StandingRoom;

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
    pub login_bytes: u64,
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

#[cfg(test)]
mod tests;
