//! The options of `serve`.

use std::env;
use std::fmt;
use std::net::SocketAddr;
use std::path::PathBuf;

use clap::ArgMatches;

use crate::cli::arguments::database::{Database, STORE};
use cellcaster::cli::arguments::option::{FileOption, Flag, Parser, ValueOption};
use cellcaster::cli::arguments::{Command, Subcommand};
use crate::ops::logging::LogFormat;

/// Options of `serve`.
#[derive(Debug)]
pub(crate) struct Serve {
    pub(crate) listen: Option<SocketAddr>,
    pub(crate) data: Option<PathBuf>,
    pub(crate) store: Option<Database>,
    pub(crate) accept_empty: bool,
    pub(crate) cluster: Option<ClusterAddress>,
    pub(crate) config: Option<PathBuf>,
    pub(crate) maps: Option<PathBuf>,
    pub(crate) record_room: Option<PathBuf>,
    pub(crate) log: LogFormat,
}

/// The address of a cluster, which may have a password.
#[derive(Clone)]
pub(crate) struct ClusterAddress(
    pub(crate)  String,
);

pub(crate) const SUBCOMMAND: Subcommand = Subcommand {
    name: "serve",
    about: "An SSH server in which people play together",
    details: "Prints the line that people type to play. The host key and what the server keeps are in the \
              folder for data; the key is made at the first start. SIGTERM and Ctrl-C end the server, after \
              its visitors had time for their end; a second one ends it at once. SIGHUP reads the \
              configuration again. The log goes to standard error. cellcaster replay FILE [MAP] plays the \
              recording of a room again.",
    examples: "cellcaster serve\n\
               cellcaster serve --listen 0.0.0.0:2222 --data /var/lib/cellcaster --maps maps",
    positionals: &[],
    options: &[&LISTEN, &DATA, &STORE, &ACCEPT_EMPTY, &CLUSTER, &CONFIG, &MAPS, &LOG, &RECORD_ROOM],
    surplus: "takes no map",
    missing: "",
    read: |matches| Ok(Command::Serve(read(matches))),
};

fn read(mut matches: ArgMatches) -> Serve {
    Serve {
        listen: LISTEN.of(&mut matches),
        data: DATA.of(&mut matches),
        store: STORE.of(&mut matches),
        accept_empty: ACCEPT_EMPTY.of(&matches),
        cluster: CLUSTER.of(&mut matches).or_else(ClusterAddress::of_environment),
        config: CONFIG.of(&mut matches),
        maps: MAPS.of(&mut matches),
        record_room: RECORD_ROOM.of(&mut matches),
        log: LOG.of(&mut matches).unwrap_or_default(),
    }
}

impl ClusterAddress {
    fn parse(text: &str) -> Option<Self> {
        let is_address = |text: &str| {
            let rest = ["nats://", "tls://"].iter().find_map(|kind| text.strip_prefix(kind));
            rest.is_some_and(|rest| !rest.is_empty())
        };
        text.split(',').all(is_address).then(|| Self(text.to_owned()))
    }

    /// What the environment names, which keeps a password out of the list of processes.
    fn of_environment() -> Option<Self> {
        let text = env::var("CELLCASTER_CLUSTER").ok()?;
        (!text.is_empty()).then_some(Self(text))
    }
}

impl fmt::Debug for ClusterAddress {
    /// Without what may be secret.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ClusterAddress").finish_non_exhaustive()
    }
}

const LISTEN: ValueOption<SocketAddr> = ValueOption {
    name: "listen",
    value: "ADDRESS:PORT",
    takes: "an address and a port, such as 0.0.0.0:2222 or [::]:2222",
    help: "Where to listen; port 0 for a free one",
    default: "127.0.0.1:2222",
    choices: &[],
    read: Parser::Optional(|text| text.parse().ok()),
    repeats: false,
};

const DATA: FileOption = FileOption {
    name: "data",
    help: "The folder for data [default: cellcaster in the folder for data, or $CELLCASTER_DATA]",
};

const ACCEPT_EMPTY: Flag = Flag {
    name: "accept-empty",
    help: "Start although host.db is damaged: keep the file aside, and go on with what can be read of it, \
           which may be nothing",
};

const CLUSTER: ValueOption<ClusterAddress> = ValueOption {
    name: "cluster",
    value: "URL",
    takes: "an address of NATS such as nats://host:4222, or several with commas between them",
    help: "The NATS servers over which this host shares its rooms with others; the store must be a \
           PostgreSQL database [default: $CELLCASTER_CLUSTER, or none]",
    default: "",
    choices: &[],
    read: Parser::Optional(ClusterAddress::parse),
    repeats: false,
};

const CONFIG: FileOption = FileOption {
    name: "config",
    help: "The configuration [default: cellcaster/serve.toml in the folder for configuration files]",
};

const MAPS: FileOption = FileOption {
    name: "maps",
    help: "A folder of own maps, beside the built-in levels [default: that of the configuration]",
};

const LOG: ValueOption<LogFormat> = ValueOption {
    name: "log",
    value: "FORMAT",
    takes: "text or json",
    help: "How the log is written",
    default: "text",
    choices: &["text", "json"],
    read: Parser::Optional(|text| match text {
        "text" => Some(LogFormat::Text),
        "json" => Some(LogFormat::Json),
        _ => None,
    }),
    repeats: false,
};

const RECORD_ROOM: FileOption = FileOption {
    name: "record-room",
    help: "A folder in which the log of each room is written. It keeps 256 MiB and 30 days at most: the oldest \
           recordings are removed first [default: nothing is recorded]",
};
