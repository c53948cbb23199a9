//! The configuration of a server: where it listens, and every limit.
//!
//! ```toml
//! listen = "[::]:2222"
//! connections = 400
//! connections-per-address = 100
//! proxies = ["10.0.0.5"]
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
//! The first fault of a file is reported with its place. [`Config::check_levels`] checks whether levels exist after the
//! maps are read, because the file says where the maps are.
//!
//! Rejected: all faults in one run, as for maps. That took twice as much code, and a configuration is short.

use std::fmt;
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use serde::de::{Error, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use tokio::sync::watch;
use toml::Spanned;

use crate::accounts::{AccountKey, AccountRate, AddressPrefix};
use crate::admission::Limits;
use crate::logging::LogFilter;
use crate::rooms::directory::{RecordingBounds, RoomLimits};
use crate::rooms::room::Mode;
use crate::rooms::summary::RoomRequest;
use cellcaster::fault::{Fault, Faults, nearest, quoted};
use cellcaster::world::Difficulty;

/// The content of a configuration file, with defaults for missing settings.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Config {
    /// The address and port at which the server listens.
    #[serde(deserialize_with = "address")]
    pub listen: SocketAddr,
    /// The name of the host: one line, shown in the lobby.
    #[serde(deserialize_with = "host_name")]
    pub name: String,
    /// The message of the day: one line, shown in the lobby; may be empty.
    #[serde(deserialize_with = "line::<MAX_MESSAGE_LENGTH, _>")]
    pub message: String,
    /// The events that are logged.
    #[serde(deserialize_with = "log")]
    pub log: LogFilter,
    /// The folder of the host's own maps, if there is one.
    #[serde(deserialize_with = "folder")]
    pub maps: Option<PathBuf>,
    /// The address at which metrics are served over HTTP; `None` for none.
    #[serde(deserialize_with = "metrics")]
    pub metrics: Option<SocketAddr>,
    /// The address at which browsers watch rooms over HTTP; `None` for none.
    #[serde(deserialize_with = "some_address")]
    pub web: Option<SocketAddr>,
    /// The most browsers that watch a room at a time.
    #[serde(deserialize_with = "number::<1, 10_000, _>")]
    pub web_watchers: u32,
    /// The most of them from one address.
    #[serde(deserialize_with = "number::<1, 10_000, _>")]
    pub web_watchers_per_address: u32,
    /// The reverse proxies, whose `X-Forwarded-For` names the browser.
    #[serde(deserialize_with = "proxies")]
    pub web_proxies: Vec<AddressPrefix>,
    /// The proxies, whose connections begin with a header that names the visitor.
    #[serde(deserialize_with = "proxies")]
    pub proxies: Vec<AddressPrefix>,
    /// The keys of the moderators.
    #[serde(deserialize_with = "moderators")]
    pub moderators: Vec<AccountKey>,
    /// The most visitors who are logged in at a time.
    #[serde(deserialize_with = "number::<1, 100_000, _>")]
    pub connections: u32,
    /// The most connections from one address, or from one /64 of IPv6.
    #[serde(deserialize_with = "number::<1, 100_000, _>")]
    pub connections_per_address: u32,
    /// The most connections with one key.
    #[serde(deserialize_with = "number::<1, 1000, _>")]
    pub connections_per_key: u32,
    /// The most unauthenticated connections at a time, in addition to `connections`.
    #[serde(deserialize_with = "number::<1, 10_000, _>")]
    pub startups: u32,
    /// The number of failures after which the server refuses nearly all connections of a network.
    #[serde(deserialize_with = "number::<2, 1_000_000, _>")]
    pub failures: u32,
    /// The time after which one failure is forgotten.
    #[serde(rename = "forget-seconds", deserialize_with = "seconds::<1, 86_400, _>")]
    pub forget: Duration,
    /// The number of accounts that a network may create in an hour.
    #[serde(deserialize_with = "number::<1, 1_000_000, _>")]
    pub accounts_per_hour: u32,
    /// The number of accounts that it may create at once.
    #[serde(deserialize_with = "number::<1, 1_000_000, _>")]
    pub accounts_at_once: u32,
    /// The time limit for the client's half of the key exchange. The client's version must arrive within
    /// three seconds.
    #[serde(rename = "handshake-seconds", deserialize_with = "seconds::<1, 600, _>")]
    pub handshake: Duration,
    /// The time limit for the start of a session. The user may have to check the host key and type a
    /// passphrase.
    #[serde(rename = "login-seconds", deserialize_with = "seconds::<1, 3600, _>")]
    pub login: Duration,
    /// The most bytes that a client may send before authentication.
    #[serde(deserialize_with = "number::<8192, { 16 << 20 }, _>")]
    pub login_bytes: u32,
    /// The most bytes that a client may send in a second after authentication.
    #[serde(deserialize_with = "number::<1024, { 1 << 30 }, _>")]
    pub bytes_per_second: u32,
    /// A client that sends nothing for this time, not even an answer, counts as gone.
    #[serde(rename = "silence-seconds", deserialize_with = "seconds::<2, 3600, _>")]
    pub silence: Duration,
    /// A client that accepts no bytes for this time is disconnected, even if it answers.
    #[serde(rename = "stall-seconds", deserialize_with = "seconds::<2, 86_400, _>")]
    pub stall: Duration,
    /// The most columns of a window. Further columns stay blank.
    #[serde(deserialize_with = "cells::<20, 2048, _>")]
    pub columns: u16,
    /// The most rows of a window.
    #[serde(deserialize_with = "cells::<10, 1024, _>")]
    pub rows: u16,
    /// How long sessions may take to end when the server ends.
    #[serde(rename = "drain-seconds", deserialize_with = "seconds::<0, 3600, _>")]
    pub drain: Duration,
    /// The most rooms, or the number of standing rooms if that is higher.
    #[serde(deserialize_with = "number::<2, 10_000, _>")]
    pub rooms: u32,
    /// The most watchers of one room.
    #[serde(deserialize_with = "number::<0, 10_000, _>")]
    pub watchers: u32,
    /// The time after which a room without members is closed.
    #[serde(rename = "empty-room-seconds", deserialize_with = "seconds::<0, 86_400, _>")]
    pub empty_room: Duration,
    /// How long a member of a room may press no key before returning to the lobby. A session keeps the limit that it
    /// begins with.
    #[serde(rename = "idle-room-minutes", deserialize_with = "minutes::<2, 1440, _>")]
    pub idle_room: Duration,
    /// How long other visitors may press no key before the session ends.
    #[serde(rename = "idle-lobby-minutes", deserialize_with = "minutes::<2, 1440, _>")]
    pub idle_lobby: Duration,
    /// The most frames that a session receives in a second.
    #[serde(deserialize_with = "number::<5, 60, _>")]
    pub frames_per_second: u32,
    /// The most bytes that pictures for a session take on the wire in a second; 0 for no limit. A session keeps the
    /// limit that it begins with.
    #[serde(deserialize_with = "number::<0, { 1 << 30 }, _>")]
    pub player_bytes_per_second: u32,
    /// The rooms that always exist.
    #[serde(rename = "room", deserialize_with = "rooms")]
    pub standing: Vec<StandingRoom>,
    /// The most mebibytes of recordings.
    #[serde(deserialize_with = "number::<1, { 1 << 20 }, _>")]
    pub recordings_megabytes: u32,
    /// The days after which a finished recording is removed.
    #[serde(deserialize_with = "number::<1, 3650, _>")]
    pub recordings_days: u32,
    /// The folder for recordings of rooms; `None` if rooms are not recorded.
    #[serde(skip)]
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
            web: None,
            web_watchers: 200,
            web_watchers_per_address: 16,
            web_proxies: Vec::new(),
            proxies: Vec::new(),
            moderators: Vec::new(),
            connections: 1200,
            connections_per_address: 64,
            connections_per_key: 3,
            startups: 200,
            failures: 20,
            forget: Duration::from_secs(10),
            accounts_per_hour: 20,
            accounts_at_once: 20,
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
            idle_room: Duration::from_mins(5),
            idle_lobby: Duration::from_mins(15),
            frames_per_second: 30,
            player_bytes_per_second: 60_000,
            // One room to walk around in, and one to play in.
            standing: [Mode::Roam, Mode::Tag].map(StandingRoom::in_mode).into(),
            recordings_megabytes: 256,
            recordings_days: 30,
            recordings: None,
        }
    }
}

impl Config {
    /// Parses a configuration file. A fault refers to the file as `name`.
    ///
    /// # Errors
    /// The first fault of the file.
    pub fn parse(text: &str, name: &str) -> Result<Self, Faults> {
        toml::from_str(text).map_err(|error| Faults::new(name, text, vec![fault(&error)]))
    }

    /// The limits on connections.
    pub(crate) fn admission(&self) -> Limits {
        Limits {
            connections: self.connections,
            per_address: self.connections_per_address,
            per_key: self.connections_per_key,
            startups: self.startups,
            failures: self.failures,
            forget: self.forget,
        }
    }

    /// The number of accounts that a network may create.
    pub(crate) fn accounts(&self) -> AccountRate {
        AccountRate { per_hour: self.accounts_per_hour, at_once: self.accounts_at_once }
    }

    /// The limits of rooms, and the standing rooms.
    pub(crate) fn room_limits(&self) -> RoomLimits {
        RoomLimits {
            most: self.standing.len().max(self.rooms as usize),
            most_watchers: self.watchers as usize,
            closes_after: self.empty_room,
            standing: self.standing.iter().map(StandingRoom::request).collect(),
        }
    }

    /// The limits of recordings.
    pub(crate) fn recording_bounds(&self) -> RecordingBounds {
        let age = Duration::from_hours(24 * u64::from(self.recordings_days));
        RecordingBounds {
            bytes: u64::from(self.recordings_megabytes) << 20,
            age,
            ..RecordingBounds::default()
        }
    }

    /// Checks that the levels of the standing rooms exist. `text` is the file, and `levels` are the names of all levels.
    ///
    /// # Errors
    /// A fault for each unknown level.
    pub fn check_levels(&self, text: &str, name: &str, levels: &[&str]) -> Result<(), Faults> {
        let named = self.standing.iter().map(|room| &room.level);
        let unknown = named.filter(|level| !levels.contains(&level.get_ref().as_str()));
        let faults: Vec<Fault> = unknown
            .map(|level| {
                let message = format!("there is no level {}", quoted(level.get_ref()));
                let help = match nearest(level.get_ref(), levels) {
                    Some(meant) => format!("the nearest level is {}", quoted(meant)),
                    None => format!("the levels are {}", levels.join(", ")),
                };
                Fault::new(level.span(), message).help(help)
            })
            .collect();
        if faults.is_empty() { Ok(()) } else { Err(Faults::new(name, text, faults)) }
    }
}

/// A room that always exists.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(default, deny_unknown_fields, expecting = "a table [[room]]")]
pub struct StandingRoom {
    /// The mode, but not "alone".
    #[serde(deserialize_with = "mode")]
    pub mode: Mode,
    /// The name of the level, with its place in the file.
    pub level: Spanned<String>,
    /// The difficulty.
    #[serde(deserialize_with = "difficulty")]
    pub difficulty: Difficulty,
}

impl StandingRoom {
    fn in_mode(mode: Mode) -> Self {
        let level = Spanned::new(0..0, "museum".to_owned());
        Self { mode, level, difficulty: Difficulty::default() }
    }

    fn request(&self) -> RoomRequest {
        let Self { mode, level, difficulty } = self;
        RoomRequest { level: level.get_ref().clone(), mode: *mode, difficulty: *difficulty }
    }
}

impl Default for StandingRoom {
    fn default() -> Self {
        Self::in_mode(Mode::Roam)
    }
}

/// The configuration in force, which can change while the server runs. Clones share it.
#[derive(Clone, Debug)]
pub struct LiveConfig(Arc<watch::Sender<Arc<Config>>>);

impl LiveConfig {
    /// The configuration of a server at its start.
    pub fn new(config: Config) -> Self {
        Self(Arc::new(watch::Sender::new(Arc::new(config))))
    }

    /// The current configuration.
    pub fn get(&self) -> Arc<Config> {
        self.0.borrow().clone()
    }

    /// A receiver of changes.
    pub fn subscribe(&self) -> watch::Receiver<Arc<Config>> {
        self.0.subscribe()
    }

    /// Replaces the configuration, except for the addresses at which the server listens, the folder of maps
    /// and the limits of recordings. Returns the names of the settings that `wanted` would change but that stay
    /// until the next start.
    pub fn replace(&self, wanted: Config) -> Vec<&'static str> {
        let now = self.get();
        let fixed = [
            ("listen", wanted.listen != now.listen),
            ("metrics.listen", wanted.metrics != now.metrics),
            ("maps", wanted.maps != now.maps),
            ("web", wanted.web != now.web),
            ("recordings-megabytes", wanted.recordings_megabytes != now.recordings_megabytes),
            ("recordings-days", wanted.recordings_days != now.recordings_days),
        ];
        let Config { listen, metrics, web, recordings_megabytes, recordings_days, .. } = *now;
        // Only the command line sets the folder of recordings.
        let (maps, recordings) = (now.maps.clone(), now.recordings.clone());
        self.0.send_replace(Arc::new(Config {
            listen,
            maps,
            metrics,
            web,
            recordings_megabytes,
            recordings_days,
            recordings,
            ..wanted
        }));
        fixed.into_iter().filter_map(|(name, differs)| differs.then_some(name)).collect()
    }
}

/// The most standing rooms.
const MAX_ROOMS: usize = 32;
/// The most moderators.
const MAX_MODERATORS: usize = 64;
/// The most ranges of addresses of proxies.
const MAX_PROXIES: usize = 64;
/// The longest message of the day, in characters.
const MAX_MESSAGE_LENGTH: usize = 200;
/// The longest name of a host, in characters.
const MAX_NAME_LENGTH: usize = 40;

/// An error in a file. Of the names that replace an unknown one, it lists only the nearest.
fn fault(error: &toml::de::Error) -> Fault {
    let (place, message) = (error.span().unwrap_or_default(), error.message());
    let names: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match &names[..] {
        [unknown, known @ ..] if message.starts_with("unknown field") => {
            let fault = Fault::new(place, format!("there is no setting {}", quoted(unknown)));
            match nearest(unknown, known) {
                Some(meant) => fault.help(format!("the nearest setting is {}", quoted(meant))),
                None => fault.help(format!("the settings are {}", known.join(", "))),
            }
        }
        _ => Fault::new(place, message),
    }
}

/// A whole number from `LEAST` to `MOST`.
fn number<'de, const LEAST: u32, const MOST: u32, D: Deserializer<'de>>(
    from: D,
) -> Result<u32, D::Error> {
    struct Whole<const LEAST: u32, const MOST: u32>;
    impl<const LEAST: u32, const MOST: u32> Visitor<'_> for Whole<LEAST, MOST> {
        type Value = u32;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            write!(f, "a whole number from {LEAST} to {MOST}")
        }

        fn visit_i64<E: Error>(self, number: i64) -> Result<u32, E> {
            let in_range = u32::try_from(number).ok().filter(|it| (LEAST..=MOST).contains(it));
            in_range.ok_or_else(|| E::invalid_value(Unexpected::Signed(number), &self))
        }
    }
    from.deserialize_i64(Whole::<LEAST, MOST>)
}

fn cells<'de, const LEAST: u32, const MOST: u32, D: Deserializer<'de>>(
    from: D,
) -> Result<u16, D::Error> {
    number::<LEAST, MOST, D>(from).map(|cells| cells as u16)
}

fn seconds<'de, const LEAST: u32, const MOST: u32, D: Deserializer<'de>>(
    from: D,
) -> Result<Duration, D::Error> {
    number::<LEAST, MOST, D>(from).map(|seconds| Duration::from_secs(seconds.into()))
}

fn minutes<'de, const LEAST: u32, const MOST: u32, D: Deserializer<'de>>(
    from: D,
) -> Result<Duration, D::Error> {
    number::<LEAST, MOST, D>(from).map(|minutes| Duration::from_mins(minutes.into()))
}

/// A text that `parse` accepts. Otherwise the fault quotes it and says what it is not.
fn parsed<T, E: Error>(
    text: &str,
    parse: impl FnOnce(&str) -> Option<T>,
    what: &str,
) -> Result<T, E> {
    parse(text).ok_or_else(|| E::custom(format!("{} is not {what}", quoted(text))))
}

fn address<'de, D: Deserializer<'de>>(from: D) -> Result<SocketAddr, D::Error> {
    const WHAT: &str = "an address with a port, such as \"127.0.0.1:2222\"; [::] stands for all addresses of this \
                        machine";
    parsed(&String::deserialize(from)?, |text| text.parse().ok(), WHAT)
}

fn some_address<'de, D: Deserializer<'de>>(from: D) -> Result<Option<SocketAddr>, D::Error> {
    address(from).map(Some)
}

fn metrics<'de, D: Deserializer<'de>>(from: D) -> Result<Option<SocketAddr>, D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields, expecting = "a table [metrics]")]
    struct Metrics {
        #[serde(default, deserialize_with = "some_address")]
        listen: Option<SocketAddr>,
    }
    Ok(Metrics::deserialize(from)?.listen)
}

/// A list of at most `most` texts that `parse` accepts.
fn list<'de, T, D: Deserializer<'de>>(
    from: D,
    (most, parse): (usize, fn(&str) -> Option<T>),
    what: &str,
) -> Result<Vec<T>, D::Error> {
    let texts = Vec::<String>::deserialize(from)?;
    if texts.len() > most {
        let count = texts.len();
        return Err(D::Error::custom(format!(
            "the list has {count} entries, and the limit is {most}"
        )));
    }
    texts.iter().map(|text| parsed(text, parse, what)).collect()
}

fn proxies<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<AddressPrefix>, D::Error> {
    const WHAT: &str = "an address or a range of addresses, such as 10.0.0.5 or 10.1.0.0/16";
    list(from, (MAX_PROXIES, AddressPrefix::parse), WHAT)
}

fn moderators<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<AccountKey>, D::Error> {
    const WHAT: &str = "the fingerprint of a key: write SHA256: and 43 characters, as \"cellcaster-server admin who\" \
                        lists the key";
    list(from, (MAX_MODERATORS, AccountKey::parse), WHAT)
}

fn host_name<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let name = line::<MAX_NAME_LENGTH, D>(from)?;
    let is_empty = name.trim().is_empty();
    if is_empty { Err(D::Error::custom("the name of the host is empty")) } else { Ok(name) }
}

/// One line of at most `LONGEST` characters.
fn line<'de, const LONGEST: usize, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let text = String::deserialize(from)?;
    if text.chars().count() > LONGEST || text.contains(char::is_control) {
        let sentence = format!("this must be one line of at most {LONGEST} characters");
        return Err(D::Error::custom(sentence));
    }
    Ok(text)
}

/// An absolute path. A relative one would depend on the folder in which a service starts.
fn folder<'de, D: Deserializer<'de>>(from: D) -> Result<Option<PathBuf>, D::Error> {
    const WHAT: &str = "an absolute path, such as \"/var/lib/cellcaster/maps\"";
    let absolute = |text: &str| Some(PathBuf::from(text)).filter(|path| path.is_absolute());
    parsed(&String::deserialize(from)?, absolute, WHAT).map(Some)
}

fn log<'de, D: Deserializer<'de>>(from: D) -> Result<LogFilter, D::Error> {
    String::deserialize(from)?.parse().map_err(|part: String| {
        let grammar = LogFilter::GRAMMAR;
        D::Error::custom(format!("{} is not a level of the log; {grammar}", quoted(&part)))
    })
}

fn rooms<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<StandingRoom>, D::Error> {
    let rooms = Vec::<StandingRoom>::deserialize(from)?;
    if rooms.len() > MAX_ROOMS {
        let sentence =
            format!("there are {} standing rooms, and the limit is {MAX_ROOMS}", rooms.len());
        return Err(D::Error::custom(sentence));
    }
    Ok(rooms)
}

/// The mode of a standing room. A room in the mode "alone" ends with its player.
fn mode<'de, D: Deserializer<'de>>(from: D) -> Result<Mode, D::Error> {
    const WHAT: &str = "a mode of standing rooms: write roam, tag, hide, race or together";
    let standing = |text: &str| Mode::named(text).filter(|mode| *mode != Mode::Alone);
    parsed(&String::deserialize(from)?, standing, WHAT)
}

fn difficulty<'de, D: Deserializer<'de>>(from: D) -> Result<Difficulty, D::Error> {
    const WHAT: &str = "a difficulty: write easy, normal or hard";
    parsed(&String::deserialize(from)?, Difficulty::named, WHAT)
}

#[cfg(test)]
mod tests;
