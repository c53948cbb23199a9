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
//! All faults of a file are reported in one run, each with its place. Levels are the exception:
//! [`Config::check_levels`] checks whether they exist after the maps are read, because the file says where
//! the maps are.

use std::fmt;
use std::net::{Ipv4Addr, SocketAddr};
use std::ops::{Range, RangeInclusive};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use tokio::sync::watch;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::accounts::{AccountKey, AccountRate, AddressPrefix};
use crate::admission::Limits;
use crate::logging::LogFilter;
use crate::rooms::directory::{RecordingBounds, RoomLimits};
use crate::rooms::room::Mode;
use crate::rooms::summary::RoomRequest;
use cellcaster::app::parts::{Field, Setting, Value as _, reject_range, toml_string};
use cellcaster::fault::document::{self, Entry, FaultList};
use cellcaster::fault::{Fault, Faults, nearest, quoted};
use cellcaster::world::Difficulty;

/// The content of a configuration file, with defaults for missing settings.
///
/// Its `Display` output is a complete file with comments, which parses to the same configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Config {
    /// The address and port at which the server listens.
    pub listen: SocketAddr,
    /// The name of the host: one line, shown in the lobby.
    pub name: String,
    /// The message of the day: one line, shown in the lobby; may be empty.
    pub message: String,
    /// The events that are logged.
    pub log: LogFilter,
    /// The folder of the host's own maps, if there is one.
    pub maps: Option<PathBuf>,
    /// The address at which metrics are served over HTTP; `None` for none.
    pub metrics: Option<SocketAddr>,
    /// The address at which browsers watch rooms over HTTP; `None` for none.
    pub web: Option<SocketAddr>,
    /// The most browsers that watch a room at a time.
    pub web_watchers: u32,
    /// The most of them from one address.
    pub web_watchers_per_address: u32,
    /// The reverse proxies, whose `X-Forwarded-For` names the browser.
    pub web_proxies: Vec<AddressPrefix>,
    /// The proxies, whose connections begin with a header that names the visitor.
    pub proxies: Vec<AddressPrefix>,
    /// The keys of the moderators.
    pub moderators: Vec<AccountKey>,
    /// The limits on connections.
    pub admission: Limits,
    /// The number of accounts that a network may create.
    pub accounts: AccountRate,
    /// The time limit for the client's half of the key exchange. The client's version must arrive within
    /// three seconds.
    pub handshake: Duration,
    /// The time limit for the start of a session. The user may have to check the host key and type a
    /// passphrase.
    pub login: Duration,
    /// The most bytes that a client may send before authentication.
    pub login_bytes: u32,
    /// The most bytes that a client may send in a second after authentication.
    pub bytes_per_second: u32,
    /// A client that sends nothing for this time, not even an answer, counts as gone.
    pub silence: Duration,
    /// A client that accepts no bytes for this time is disconnected, even if it answers.
    pub stall: Duration,
    /// The most columns of a window. Further columns stay blank.
    pub columns: u16,
    /// The most rows of a window.
    pub rows: u16,
    /// How long sessions may take to end when the server ends.
    pub drain: Duration,
    /// The most rooms.
    pub rooms: u32,
    /// The most watchers of one room.
    pub watchers: u32,
    /// The time after which a room without members is closed.
    pub empty_room: Duration,
    /// How long a member of a room may press no key before returning to the lobby. A session keeps the limit that it
    /// begins with.
    pub idle_room: Duration,
    /// How long other visitors may press no key before the session ends.
    pub idle_lobby: Duration,
    /// The most frames that a session receives in a second.
    pub frames_per_second: u32,
    /// The most bytes that pictures for a session take on the wire in a second; 0 for no limit. A session keeps the
    /// limit that it begins with.
    pub player_bytes_per_second: u32,
    /// The rooms that always exist.
    pub standing: Vec<RoomRequest>,
    /// The most mebibytes of recordings.
    pub recordings_megabytes: u32,
    /// The days after which a finished recording is removed.
    pub recordings_days: u32,
    /// The folder for recordings of rooms; `None` if rooms are not recorded.
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
            idle_room: Duration::from_mins(5),
            idle_lobby: Duration::from_mins(15),
            frames_per_second: 30,
            player_bytes_per_second: 60_000,
            // One room to walk around in, and one to play in.
            standing: [Mode::Roam, Mode::Tag].map(in_mode).into(),
            recordings_megabytes: 256,
            recordings_days: 30,
            recordings: None,
        }
    }
}

impl Config {
    /// Parses a configuration file. Faults refer to the file as `name`.
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
                self.standing = read_rooms(&entry).unwrap_or_default();
            } else {
                let keys = settings().map(|setting| setting.key);
                let known: Vec<&str> = keys.chain(["metrics", "room"]).collect();
                faults.push(entry.unknown_key("the configuration", &known));
            }
        }
        self.check_room_count(document, faults);
    }

    /// The limits of rooms, and the standing rooms.
    pub(crate) fn room_limits(&self) -> RoomLimits {
        RoomLimits {
            most: self.rooms as usize,
            most_watchers: self.watchers as usize,
            closes_after: self.empty_room,
            standing: self.standing.clone(),
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

    fn check_room_count(&self, document: &DeTable, faults: &FaultList) {
        let (standing, most) = (self.standing.len(), self.rooms as usize);
        if let Some((key, _)) = document.get_key_value("room").filter(|_| standing > most) {
            let message =
                format!("there are {standing} standing rooms, more than the limit of {most} rooms");
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
            writeln!(f, "{blank}# {}", about.replace('\n', "\n# "))?;
            match value.write(self) {
                value if value.is_empty() && *key == WEB.key => writeln!(f, "# {WEB_EXAMPLE}")?,
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
            writeln!(f, "\n# the rooms that always exist")?;
        }
        self.standing.iter().try_for_each(|RoomRequest { level, mode, difficulty }| {
            writeln!(f, "[[room]]\nmode = \"{}\"\nlevel = \"{level}\"", mode.name())?;
            writeln!(f, "difficulty = \"{}\"", difficulty.name())
        })
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
    /// and the limits of recordings. Returns the names of the settings that `wanted` would change but that stay until the next
    /// start.
    pub fn replace(&self, mut wanted: Config) -> Vec<&'static str> {
        let now = self.get();
        let fixed = [
            ("listen", LISTEN),
            ("metrics.listen", METRICS_LISTEN),
            ("maps", MAPS),
            ("web", WEB),
            (RECORDINGS_MEGABYTES.key, RECORDINGS_MEGABYTES),
            (RECORDINGS_DAYS.key, RECORDINGS_DAYS),
        ];
        let fixed = fixed.into_iter().filter_map(|(name, Setting { value, .. })| {
            let differs = value.differs(&wanted, &now);
            value.copy(&now, &mut wanted);
            differs.then_some(name)
        });
        let fixed = fixed.collect();
        // Only the command line sets this.
        wanted.recordings.clone_from(&now.recordings);
        self.0.send_replace(Arc::new(wanted));
        fixed
    }
}

/// The most standing rooms.
const MAX_ROOMS: usize = 32;

impl Config {
    /// Checks that the levels of the standing rooms in `text` exist. `text` is a configuration that parses
    /// without a fault. `levels` are the names of all levels.
    ///
    /// # Errors
    /// A fault for each unknown level.
    pub fn check_levels(text: &str, name: &str, levels: &[&str]) -> Result<(), Faults> {
        let faults = FaultList::default();
        let document = document::parse(text, &faults);
        for (level, place) in named_levels(&document) {
            if !levels.contains(&level) {
                let message = format!("there is no level {}", quoted(level));
                let help = match nearest(level, levels) {
                    Some(meant) => format!("the nearest level is {}", quoted(meant)),
                    None => format!("the levels are {}", levels.join(", ")),
                };
                faults.push(Fault::new(place, message).help(help));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(Faults::new(name, text, faults.take())) }
    }
}

/// The levels of the standing rooms, with their places in the text.
fn named_levels<'a>(document: &'a DeTable<'_>) -> Vec<(&'a str, Range<usize>)> {
    let Some(DeValue::Array(rooms)) = document.get("room").map(Spanned::get_ref) else {
        return Vec::new();
    };
    let tables = rooms.iter().filter_map(|room| match room.get_ref() {
        DeValue::Table(table) => Some(table),
        _ => None,
    });
    let levels = tables.filter_map(|table| {
        let value = table.get("level")?;
        let DeValue::String(level) = value.get_ref() else { return None };
        Some((level.as_ref(), value.span()))
    });
    levels.collect()
}

/// The standing rooms of an entry `room`; `None` if the list as a whole has a fault.
fn read_rooms(entry: &Entry<'_, '_>) -> Option<Vec<RoomRequest>> {
    const EXAMPLE: &str = "[[room]]";
    let Some(list) = entry.list() else {
        entry.faults.push(entry.wrong_type("a list of tables", EXAMPLE));
        return None;
    };
    if list.len() > MAX_ROOMS {
        let message =
            format!("there are {} standing rooms, and the limit is {MAX_ROOMS}", list.len());
        entry.faults.push(Fault::new(entry.key_place.clone(), message));
        return None;
    }
    let rooms = list.iter().filter_map(|room| Some(read_room(room, room.table(EXAMPLE)?)));
    Some(rooms.collect())
}

fn read_room(room: &Entry<'_, '_>, table: &DeTable<'_>) -> RoomRequest {
    let mut request = in_mode(Mode::Roam);
    for entry in room.entries(table) {
        match entry.key {
            "mode" => request.mode = mode(&entry).unwrap_or(request.mode),
            "level" => {
                if let Some(level) = entry.string("level = \"museum\"") {
                    level.clone_into(&mut request.level);
                }
            }
            "difficulty" => {
                request.difficulty = Difficulty::read(&entry).unwrap_or(request.difficulty);
            }
            _ => {
                let known = ["mode", "level", "difficulty"];
                entry.faults.push(entry.unknown_key("[[room]]", &known));
            }
        }
    }
    request
}

fn mode(entry: &Entry<'_, '_>) -> Option<Mode> {
    const ALONE: &str =
        "a standing room can't be in the mode \"alone\": such a room ends with its player";
    let text = entry.string("mode = \"roam\"")?;
    let is_possible = |mode: &Mode| *mode != Mode::Alone;
    Mode::named(text).filter(is_possible).or_else(|| {
        let is_alone = text == Mode::Alone.name();
        let unknown = || format!("there is no mode {}", quoted(text));
        let message = if is_alone { ALONE.to_owned() } else { unknown() };
        let names: Vec<&str> = Mode::ALL.into_iter().filter(is_possible).map(Mode::name).collect();
        entry.reject(message, "", format!("write one of {}", names.join(", ")))
    })
}

fn in_mode(mode: Mode) -> RoomRequest {
    RoomRequest { level: "museum".to_owned(), mode, difficulty: Difficulty::default() }
}

/// The most moderators.
const MAX_MODERATORS: usize = 64;
/// The longest message of the day, in characters.
const MAX_MESSAGE_LENGTH: usize = 200;
/// The longest name of a host, in characters.
const MAX_NAME_LENGTH: usize = 40;

/// The most ranges of addresses of proxies.
const MAX_PROXIES: usize = 64;

const LISTEN_EXAMPLE: &str = "listen = \"127.0.0.1:2222\"";
const LOG_EXAMPLE: &str = "log = \"info,connections=warn\"";
const MODERATORS_EXAMPLE: &str = "moderators = [\"SHA256:...\"]";
const MAPS_EXAMPLE: &str = "maps = \"/var/lib/cellcaster/maps\"";
const PROXIES_EXAMPLE: &str = "[\"10.0.0.5\", \"10.1.0.0/16\"]";
const WEB_EXAMPLE: &str = "web = \"127.0.0.1:8080\"";
const METRICS_EXAMPLE: &str = "listen = \"127.0.0.1:9464\"";

const LISTEN: Setting<Config> = Setting {
    key: "listen",
    about: "the address and port to listen on",
    value: &Text {
        at: |it| &mut it.listen,
        read: |entry| address(entry, LISTEN_EXAMPLE),
        write: |listen| format!("\"{listen}\""),
    },
};

/// Writes an empty string if there is no value.
const MAPS: Setting<Config> = Setting {
    key: "maps",
    about: "the folder of the host's own maps; without this line there are none",
    value: &Text {
        at: |it| &mut it.maps,
        read: |entry| folder(entry).map(Some),
        write: |maps| {
            maps.as_ref().map_or_else(String::new, |it| toml_string(&it.to_string_lossy()))
        },
    },
};

/// Writes an empty string if there is no value.
const WEB: Setting<Config> = Setting {
    key: "web",
    about: "the address at which browsers watch rooms over HTTP, for a reverse proxy; without this line there\n\
            is none",
    value: &Text {
        at: |it| &mut it.web,
        read: |entry| Some(address(entry, WEB_EXAMPLE)),
        write: |web| web.map_or_else(String::new, |address| format!("\"{address}\"")),
    },
};

const RECORDINGS_MEGABYTES: Setting<Config> = Setting {
    key: "recordings-megabytes",
    about: "the size and the age up to which recordings of rooms are kept, if rooms are recorded; the\n\
            oldest are removed first",
    value: &Number(1..=1 << 20, NumberField::U32(|it| &mut it.recordings_megabytes)),
};

const RECORDINGS_DAYS: Setting<Config> = Setting {
    key: "recordings-days",
    about: "",
    value: &Number(1..=3650, NumberField::U32(|it| &mut it.recordings_days)),
};

/// The only setting in the table `[metrics]`. Writes an empty string if there is no value.
const METRICS_LISTEN: Setting<Config> = Setting {
    key: "listen",
    about: "the address at which Prometheus reads metrics; without this line there is none",
    value: &Text {
        at: |it| &mut it.metrics,
        read: |entry| Some(address(entry, METRICS_EXAMPLE)),
        write: |metrics| metrics.map_or_else(String::new, |address| format!("\"{address}\"")),
    },
};

/// The text settings, in the order of a file.
const TEXTS: [Setting<Config>; 9] = [
    LISTEN,
    Setting {
        key: "name",
        about: "the name of the host, shown in the lobby",
        value: &Text { at: |it| &mut it.name, read: name, write: |name| toml_string(name) },
    },
    Setting {
        key: "message",
        about: "the message of the day, shown in the lobby",
        value: &Text { at: |it| &mut it.message, read: message, write: |text| toml_string(text) },
    },
    Setting {
        key: "log",
        about: "the log level, and levels for single topics; a level is off, error, warn, info, debug \
                or trace, and a topic is host, connections, rooms, results or admin",
        value: &Text { at: |it| &mut it.log, read: log, write: |log| format!("\"{log}\"") },
    },
    MAPS,
    WEB,
    Setting {
        key: "web-proxies",
        about: "the addresses of reverse proxies; the address that they name in X-Forwarded-For counts as the\n\
                browser's",
        value: &Text {
            at: |it| &mut it.web_proxies,
            read: proxies,
            write: |list| address_list(list),
        },
    },
    Setting {
        key: "proxies",
        about: "the addresses of proxies; each SSH connection from them must begin with a PROXY header, whose\n\
                address counts as the visitor's",
        value: &Text { at: |it| &mut it.proxies, read: proxies, write: |list| address_list(list) },
    },
    Setting {
        key: "moderators",
        about: "the keys of players who can mute and kick others, as \"cellcaster-server admin who\" lists them",
        value: &Text {
            at: |it| &mut it.moderators,
            read: moderators,
            write: |keys| list_of_keys(keys),
        },
    },
];

/// The number settings, in the order of a file. They follow the texts.
const NUMBERS: [Setting<Config>; 28] = [
    Setting {
        key: "connections",
        about: "the maximum number of visitors who have logged in",
        value: &Number(1..=100_000, NumberField::U32(|it| &mut it.admission.connections)),
    },
    Setting {
        key: "connections-per-address",
        about: "the maximum number of connections from one IPv4 address or IPv6 /64; behind a proxy that is not in\n\
                proxies, all visitors have the same address",
        value: &Number(1..=100_000, NumberField::U32(|it| &mut it.admission.per_address)),
    },
    Setting {
        key: "connections-per-key",
        about: "the maximum number of connections with one public key",
        value: &Number(1..=1000, NumberField::U32(|it| &mut it.admission.per_key)),
    },
    Setting {
        key: "startups",
        about: "the maximum number of further connections that have not logged in yet; one more\n\
                displaces the oldest of the busiest network",
        value: &Number(1..=10_000, NumberField::U32(|it| &mut it.admission.startups)),
    },
    Setting {
        key: "failures",
        about: "the number of failed connections from one network after which most of its new ones\n\
                are refused for a while; successful connections make up for failed ones",
        value: &Number(2..=1_000_000, NumberField::U32(|it| &mut it.admission.failures)),
    },
    Setting {
        key: "forget-seconds",
        about: "the time after which one failed connection is forgotten",
        value: &Number(1..=86_400, NumberField::Seconds(|it| &mut it.admission.forget)),
    },
    Setting {
        key: "accounts-per-hour",
        about: "the number of accounts that one network (/24, /64) may create in an hour",
        value: &Number(1..=1_000_000, NumberField::U32(|it| &mut it.accounts.per_hour)),
    },
    Setting {
        key: "accounts-at-once",
        about: "the number of accounts that it may create at once",
        value: &Number(1..=1_000_000, NumberField::U32(|it| &mut it.accounts.at_once)),
    },
    Setting {
        key: "handshake-seconds",
        about: "the time for the key exchange; the client must send its version within 3 seconds",
        value: &Number(1..=600, NumberField::Seconds(|it| &mut it.handshake)),
    },
    Setting {
        key: "login-seconds",
        about: "the time for the login, in which people check the host key and type a passphrase",
        value: &Number(1..=3600, NumberField::Seconds(|it| &mut it.login)),
    },
    Setting {
        key: "login-bytes",
        about: "the maximum number of bytes from a client before its login",
        value: &Number(8192..=16 << 20, NumberField::U32(|it| &mut it.login_bytes)),
    },
    Setting {
        key: "bytes-per-second",
        about: "the maximum number of bytes per second from a client after its login; further bytes wait",
        value: &Number(1024..=1 << 30, NumberField::U32(|it| &mut it.bytes_per_second)),
    },
    Setting {
        key: "silence-seconds",
        about: "the time after which a client that answers nothing is disconnected",
        value: &Number(2..=3600, NumberField::Seconds(|it| &mut it.silence)),
    },
    Setting {
        key: "stall-seconds",
        about: "the time after which a client that accepts no bytes is disconnected",
        value: &Number(2..=86_400, NumberField::Seconds(|it| &mut it.stall)),
    },
    Setting {
        key: "columns",
        about: "the largest window",
        value: &Number(20..=2048, NumberField::U16(|it| &mut it.columns)),
    },
    Setting {
        key: "rows",
        about: "",
        value: &Number(10..=1024, NumberField::U16(|it| &mut it.rows)),
    },
    Setting {
        key: "drain-seconds",
        about: "the time that sessions have when the server ends",
        value: &Number(0..=3600, NumberField::Seconds(|it| &mut it.drain)),
    },
    Setting {
        key: "rooms",
        about: "the maximum number of open rooms",
        value: &Number(2..=10_000, NumberField::U32(|it| &mut it.rooms)),
    },
    Setting {
        key: "watchers",
        about: "the maximum number of visitors who watch one room",
        value: &Number(0..=10_000, NumberField::U32(|it| &mut it.watchers)),
    },
    Setting {
        key: "web-watchers",
        about: "the maximum number of browsers that watch rooms, in total and from one IPv4 address or IPv6 /64",
        value: &Number(1..=10_000, NumberField::U32(|it| &mut it.web_watchers)),
    },
    Setting {
        key: "web-watchers-per-address",
        about: "",
        value: &Number(1..=10_000, NumberField::U32(|it| &mut it.web_watchers_per_address)),
    },
    Setting {
        key: "empty-room-seconds",
        about: "the time after which an empty room closes",
        value: &Number(0..=86_400, NumberField::Seconds(|it| &mut it.empty_room)),
    },
    Setting {
        key: "idle-room-minutes",
        about: "the time after which a player who presses no key returns to the lobby, after a warning\n\
                one minute before; for sessions that begin after a reload",
        value: &Number(2..=1440, NumberField::Minutes(|it| &mut it.idle_room)),
    },
    Setting {
        key: "idle-lobby-minutes",
        about: "the same for a visitor elsewhere, who is then disconnected",
        value: &Number(2..=1440, NumberField::Minutes(|it| &mut it.idle_lobby)),
    },
    Setting {
        key: "frames-per-second",
        about: "the maximum frame rate for each visitor; it falls if the processor is busy",
        value: &Number(5..=60, NumberField::U32(|it| &mut it.frames_per_second)),
    },
    Setting {
        key: "player-bytes-per-second",
        about: "the maximum number of bytes per second to each visitor, after compression; moving pictures are\n\
                coarser or fewer, and pictures at rest become exact; 0 for no limit",
        value: &Number(0..=1 << 30, NumberField::U32(|it| &mut it.player_bytes_per_second)),
    },
    RECORDINGS_MEGABYTES,
    RECORDINGS_DAYS,
];

/// A setting with functions of its own to read and write the value.
struct Text<T> {
    at: fn(&mut Config) -> &mut T,
    read: fn(&Entry<'_, '_>) -> Option<T>,
    write: fn(&T) -> String,
}

impl<T> Text<T> {
    fn get(&self, of: &Config) -> T
    where
        T: Clone,
    {
        (self.at)(&mut of.clone()).clone()
    }
}

impl<T: Clone + PartialEq> Field<Config> for Text<T> {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut Config) {
        if let Some(value) = (self.read)(entry) {
            *(self.at)(into) = value;
        }
    }

    fn write(&self, of: &Config) -> String {
        (self.write)(&self.get(of))
    }

    fn differs(&self, one: &Config, other: &Config) -> bool {
        self.get(one) != self.get(other)
    }

    fn copy(&self, from: &Config, into: &mut Config) {
        *(self.at)(into) = self.get(from);
    }
}

/// A whole number in a range.
struct Number(RangeInclusive<u32>, NumberField);

/// The field that stores a number.
enum NumberField {
    U16(fn(&mut Config) -> &mut u16),
    U32(fn(&mut Config) -> &mut u32),
    Seconds(fn(&mut Config) -> &mut Duration),
    Minutes(fn(&mut Config) -> &mut Duration),
}

impl Number {
    fn get(&self, of: &Config) -> u32 {
        let mut of = of.clone();
        match self.1 {
            NumberField::U16(at) => u32::from(*at(&mut of)),
            NumberField::U32(at) => *at(&mut of),
            NumberField::Seconds(at) => u32::try_from(at(&mut of).as_secs()).unwrap_or(u32::MAX),
            NumberField::Minutes(at) => {
                u32::try_from(at(&mut of).as_secs() / 60).unwrap_or(u32::MAX)
            }
        }
    }

    fn set(&self, of: &mut Config, value: u32) {
        match self.1 {
            NumberField::U16(at) => *at(of) = value as u16,
            NumberField::U32(at) => *at(of) = value,
            NumberField::Seconds(at) => *at(of) = Duration::from_secs(u64::from(value)),
            NumberField::Minutes(at) => *at(of) = Duration::from_mins(u64::from(value)),
        }
    }
}

impl Field<Config> for Number {
    fn read(&self, entry: &Entry<'_, '_>, into: &mut Config) {
        let example = format!("{} = {}", entry.key, self.get(&Config::default()));
        let DeValue::Integer(_) = entry.value else {
            return entry.faults.push(entry.wrong_type("a whole number", &example));
        };
        let (least, most) = (*self.0.start(), *self.0.end());
        let in_range = |number: &f64| (f64::from(least)..=f64::from(most)).contains(number);
        let wanted = format!("a whole number from {least} to {most}");
        match entry.number().filter(in_range) {
            Some(number) => self.set(into, number as u32),
            None => _ = reject_range::<()>(entry, &wanted, &example),
        }
    }

    fn write(&self, of: &Config) -> String {
        self.get(of).to_string()
    }

    fn differs(&self, one: &Config, other: &Config) -> bool {
        self.get(one) != self.get(other)
    }

    fn copy(&self, from: &Config, into: &mut Config) {
        self.set(into, self.get(from));
    }
}

fn address(entry: &Entry<'_, '_>, example: &str) -> Option<SocketAddr> {
    let text = entry.string(example)?;
    text.parse().ok().or_else(|| {
        let help = format!("write {example}; [::] stands for all addresses of this machine");
        entry.reject(format!("{} is not an address with a port", quoted(text)), "", help)
    })
}

/// The addresses of proxies. An element with a fault makes the whole list faulty.
fn proxies(entry: &Entry<'_, '_>) -> Option<Vec<AddressPrefix>> {
    let Some(list) = entry.list() else {
        let example = format!("{} = {PROXIES_EXAMPLE}", entry.key);
        entry.faults.push(entry.wrong_type("a list of addresses", &example));
        return None;
    };
    if list.len() > MAX_PROXIES {
        let message = format!("there are {} proxies, and the limit is {MAX_PROXIES}", list.len());
        return entry.reject(
            message,
            "",
            "write a range such as 10.1.0.0/16 for several addresses",
        );
    }
    let ranges: Vec<Option<AddressPrefix>> =
        list.iter().map(|range| address_range(range, entry.key)).collect();
    ranges.into_iter().collect()
}

/// An element of the setting `key`.
fn address_range(entry: &Entry<'_, '_>, key: &str) -> Option<AddressPrefix> {
    let text = match entry.value {
        DeValue::String(text) => text.as_ref(),
        _ => "",
    };
    AddressPrefix::parse(text).or_else(|| {
        let message = "this is neither an address nor a range of addresses";
        entry.reject(message, "", format!("write {key} = {PROXIES_EXAMPLE}"))
    })
}

fn address_list(ranges: &[AddressPrefix]) -> String {
    let ranges: Vec<String> = ranges.iter().map(|range| format!("\"{range}\"")).collect();
    format!("[{}]", ranges.join(", "))
}

fn message(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("message = \"Welcome\"")?;
    line(entry, text, "the message of the day", MAX_MESSAGE_LENGTH)
}

fn name(entry: &Entry<'_, '_>) -> Option<String> {
    let text = entry.string("name = \"Cellcaster\"")?;
    if text.trim().is_empty() {
        let help = "write a name, or leave the setting out for \"Cellcaster\"";
        return entry.reject("the name of the host is empty", "", help);
    }
    line(entry, text, "the name of the host", MAX_NAME_LENGTH)
}

/// Returns `text` if it is one line of at most `longest` characters. `what` names it in the fault.
fn line(entry: &Entry<'_, '_>, text: &str, what: &str, longest: usize) -> Option<String> {
    if text.chars().count() > longest || text.contains(char::is_control) {
        return entry.reject(
            format!("{what} must be one line of at most {longest} characters"),
            "",
            "",
        );
    }
    Some(text.to_owned())
}

fn folder(entry: &Entry<'_, '_>) -> Option<PathBuf> {
    let path = Path::new(entry.string(MAPS_EXAMPLE)?);
    // A relative path would depend on the folder in which a service starts.
    if !path.is_absolute() {
        let message = format!("{} is not an absolute path", quoted(&path.to_string_lossy()));
        return entry.reject(message, "", format!("write {MAPS_EXAMPLE}"));
    }
    Some(path.to_owned())
}

fn log(entry: &Entry<'_, '_>) -> Option<LogFilter> {
    entry.string(LOG_EXAMPLE)?.parse().map_or_else(
        |part: String| {
            let help = format!("write {LOG_EXAMPLE}; {}", LogFilter::GRAMMAR);
            entry.reject(format!("{} is not a level of the log", quoted(&part)), "", help)
        },
        Some,
    )
}

fn moderators(entry: &Entry<'_, '_>) -> Option<Vec<AccountKey>> {
    let Some(list) = entry.list() else {
        entry.faults.push(entry.wrong_type("a list of keys", MODERATORS_EXAMPLE));
        return None;
    };
    if list.len() > MAX_MODERATORS {
        let message =
            format!("there are {} moderators, and the limit is {MAX_MODERATORS}", list.len());
        return entry.reject(message, "", "");
    }
    // Reports a fault for each element that has one.
    let keys: Vec<Option<AccountKey>> = list.iter().map(moderator).collect();
    keys.into_iter().collect()
}

fn moderator(entry: &Entry<'_, '_>) -> Option<AccountKey> {
    let text = entry.string(MODERATORS_EXAMPLE)?;
    AccountKey::parse(text).or_else(|| {
        let help =
            "write SHA256: and 43 characters, as \"cellcaster-server admin who\" lists the key";
        entry.reject(format!("{} is not the fingerprint of a key", quoted(text)), "", help)
    })
}

fn list_of_keys(keys: &[AccountKey]) -> String {
    let keys: Vec<String> = keys.iter().map(|key| format!("\"{key}\"")).collect();
    format!("[{}]", keys.join(", "))
}

#[cfg(test)]
mod tests;
