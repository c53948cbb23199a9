//! The settings that are numbers: names, meanings, ranges.

use std::time::Duration;

use super::Config;

/// A setting whose value is a whole number.
pub(crate) struct Setting {
    pub(crate) name: &'static str,
    /// Its description, in lines of a comment.
    pub(crate) meaning: &'static str,
    pub(crate) least: u32,
    pub(crate) most: u32,
    pub(crate) get: fn(&Config) -> u32,
    pub(crate) set: fn(&mut Config, u32),
}

/// The settings in the order of a file.
pub(crate) const SETTINGS: [Setting; 21] = [
    Setting {
        name: "connections",
        meaning: "the most visitors at a time who have logged in",
        least: 1,
        most: 100_000,
        get: |config| config.admission.connections,
        set: |config, value| config.admission.connections = value,
    },
    Setting {
        name: "connections-per-address",
        meaning: "the most connections of one address, or of one /64 of IPv6; behind a proxy, all\n\
                  visitors have the same",
        least: 1,
        most: 100_000,
        get: |config| config.admission.per_address,
        set: |config, value| config.admission.per_address = value,
    },
    Setting {
        name: "connections-per-key",
        meaning: "the most connections with one public key",
        least: 1,
        most: 1000,
        get: |config| config.admission.per_key,
        set: |config, value| config.admission.per_key = value,
    },
    Setting {
        name: "startups",
        meaning: "the most connections at a time that have not logged in, besides; one more displaces\n\
                  the oldest one of the busiest network",
        least: 1,
        most: 10_000,
        get: |config| config.admission.startups,
        set: |config, value| config.admission.startups = value,
    },
    Setting {
        name: "failures",
        meaning: "failed connections of one network after which nearly all of its new ones are\n\
                  refused for a while; successful ones make up for failed ones",
        least: 2,
        most: 1_000_000,
        get: |config| config.admission.failures,
        set: |config, value| config.admission.failures = value,
    },
    Setting {
        name: "forget-seconds",
        meaning: "the time after which one of them is forgotten",
        least: 1,
        most: 86_400,
        get: |config| seconds(config.admission.forget),
        set: |config, value| config.admission.forget = of_seconds(value),
    },
    Setting {
        name: "accounts-per-hour",
        meaning: "the new accounts that one network (/24, /64) may make in an hour",
        least: 1,
        most: 1_000_000,
        get: |config| config.accounts.per_hour,
        set: |config, value| config.accounts.per_hour = value,
    },
    Setting {
        name: "accounts-at-once",
        meaning: "how many of them at once",
        least: 1,
        most: 1_000_000,
        get: |config| config.accounts.at_once,
        set: |config, value| config.accounts.at_once = value,
    },
    Setting {
        name: "handshake-seconds",
        meaning: "the time in which a client exchanges keys; its version has to arrive within 3",
        least: 1,
        most: 600,
        get: |config| seconds(config.handshake),
        set: |config, value| config.handshake = of_seconds(value),
    },
    Setting {
        name: "login-seconds",
        meaning: "the time in which a session begins; people look at a host key, and type a passphrase",
        least: 1,
        most: 3600,
        get: |config| seconds(config.login),
        set: |config, value| config.login = of_seconds(value),
    },
    Setting {
        name: "login-bytes",
        meaning: "the most bytes of a client before it is authenticated",
        least: 8192,
        most: 16 << 20,
        get: |config| u32::try_from(config.login_bytes).unwrap_or(u32::MAX),
        set: |config, value| config.login_bytes = u64::from(value),
    },
    Setting {
        name: "bytes-per-second",
        meaning: "the most bytes that a client sends in a second after that; more have to wait",
        least: 1024,
        most: 1 << 30,
        get: |config| config.bytes_per_second,
        set: |config, value| config.bytes_per_second = value,
    },
    Setting {
        name: "silence-seconds",
        meaning: "the time after which a client that answers nothing has gone",
        least: 2,
        most: 3600,
        get: |config| seconds(config.silence),
        set: |config, value| config.silence = of_seconds(value),
    },
    Setting {
        name: "stall-seconds",
        meaning: "the time after which a client that takes nothing is disconnected",
        least: 2,
        most: 86_400,
        get: |config| seconds(config.stall),
        set: |config, value| config.stall = of_seconds(value),
    },
    Setting {
        name: "columns",
        meaning: "the largest window",
        least: 20,
        most: 2048,
        get: |config| u32::from(config.columns),
        set: |config, value| config.columns = value as u16,
    },
    Setting {
        name: "rows",
        meaning: "",
        least: 10,
        most: 1024,
        get: |config| u32::from(config.rows),
        set: |config, value| config.rows = value as u16,
    },
    Setting {
        name: "drain-seconds",
        meaning: "the time for which sessions go on when the server ends",
        least: 0,
        most: 3600,
        get: |config| seconds(config.drain),
        set: |config, value| config.drain = of_seconds(value),
    },
    Setting {
        name: "rooms",
        meaning: "the most rooms at a time",
        least: 2,
        most: 10_000,
        get: |config| config.rooms,
        set: |config, value| config.rooms = value,
    },
    Setting {
        name: "watchers",
        meaning: "the most visitors who watch one room",
        least: 0,
        most: 10_000,
        get: |config| config.watchers,
        set: |config, value| config.watchers = value,
    },
    Setting {
        name: "empty-room-seconds",
        meaning: "the time after which a room without members is closed",
        least: 0,
        most: 86_400,
        get: |config| seconds(config.empty_room),
        set: |config, value| config.empty_room = of_seconds(value),
    },
    Setting {
        name: "frames-per-second",
        meaning: "the most frames that a visitor gets in a second; fewer, if the processor is busy",
        least: 5,
        most: 60,
        get: |config| config.frames_per_second,
        set: |config, value| config.frames_per_second = value,
    },
];

fn seconds(time: Duration) -> u32 {
    u32::try_from(time.as_secs()).unwrap_or(u32::MAX)
}

fn of_seconds(seconds: u32) -> Duration {
    Duration::from_secs(u64::from(seconds))
}
