//! The arguments of the server's commands.

use std::env;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::time::Duration;

use cellcaster::cli::animation::Excerpt;
use cellcaster::cli::parse::ValidValues;
use cellcaster::world::Difficulty;
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};

use super::host_store::{Secret, StoreLocation};
use crate::accounts::{AccountKey, AddressPrefix, BanTarget, Name};
use crate::admin::Target;
use crate::logging::LogFormat;
use crate::visitors::SessionId;

/// An SSH server on which people play Cellcaster together
///
/// Prints the command that people type to play. The data folder contains the host key, which is created at the first
/// start, and the server's data. SIGTERM and Ctrl-C give visitors some time and then end the server; a second one ends
/// it at once. SIGHUP reloads the configuration. The log goes to standard error.
#[derive(Debug, Parser)]
#[command(
    name = "cellcaster-server",
    version = cellcaster::VERSION,
    args_conflicts_with_subcommands = true,
    args_override_self = true,
    max_term_width = 80,
    after_help = "Examples:\n  cellcaster-server\n  cellcaster-server --listen 0.0.0.0:2222 --data /var/lib/cellcaster --maps maps\n  cellcaster-server admin who"
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Option<ServerCommand>,
    #[command(flatten)]
    pub(crate) serve: Serve,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ServerCommand {
    #[cfg(unix)]
    Admin(Admin),
    Scores(Scores),
    Replay(Replay),
}

/// The options of the server itself.
#[derive(Args, Debug)]
pub(crate) struct Serve {
    /// The address and port to listen on; port 0 chooses a free port [default: 127.0.0.1:2222]
    #[arg(long, value_name = "ADDRESS:PORT", value_parser = address)]
    pub(crate) listen: Option<SocketAddr>,
    /// The data folder [default: `$CELLCASTER_DATA`, or cellcaster in the user's data folder]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) data: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) store: Store,
    /// The NATS servers through which this host shares its rooms with other hosts; the store must be a PostgreSQL
    /// database [default: `$CELLCASTER_CLUSTER`, or none]
    #[arg(long, value_name = "URL", value_parser = cluster_address)]
    cluster: Option<Secret>,
    /// The configuration file [default: cellcaster/serve.toml in the user's configuration folder]
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) config: Option<PathBuf>,
    /// A folder of the host's own maps, in addition to the built-in levels [default: the setting `maps`]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) maps: Option<PathBuf>,
    /// The address and port at which browsers watch rooms, over HTTP for a reverse proxy [default: the setting `web`]
    #[arg(long, value_name = "ADDRESS:PORT", value_parser = address)]
    pub(crate) web: Option<SocketAddr>,
    /// The format of the log
    #[arg(long, value_name = "FORMAT", value_enum, default_value_t)]
    pub(crate) log: LogFormat,
    /// Record each room into this folder, within the settings `recordings-megabytes` and `recordings-days` [default:
    /// rooms are not recorded]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) record_room: Option<PathBuf>,
}

impl Serve {
    /// The address of the cluster, named by the option or the environment.
    pub(crate) fn cluster(&self) -> Option<String> {
        let named = self.cluster.as_ref().map(|address| address.0.clone());
        // The environment keeps a password out of the list of processes.
        named.or_else(|| env::var("CELLCASTER_CLUSTER").ok().filter(|text| !text.is_empty()))
    }
}

/// The option of all commands that need the store of a host.
#[derive(Args, Clone, Debug)]
pub(crate) struct Store {
    /// The store of accounts, bans and results: a folder, or a PostgreSQL database that several hosts can share
    /// [default: `$CELLCASTER_STORE`, or the data folder]
    #[arg(long, value_name = "URL|FOLDER", value_parser = StoreLocation::parse)]
    pub(crate) store: Option<StoreLocation>,
}

/// List, kick, mute and ban a host's visitors, or send them a message
///
/// The commands for bans and mutes also work while no server runs, because the store contains both. Name a player by
/// name, --key or --address; banning or muting a name also bans or mutes the key of its account. A running server
/// follows a mute within 2 seconds. In a cluster, who, say, kick, ban and mute apply to all hosts, hosts lists them, and
/// drain ends the host of the data folder.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-server admin who\n  cellcaster-server admin kick ada --reason \"let others play\"\n  cellcaster-server admin ban --address 203.0.113.0/24 --for 7d"
)]
pub(crate) struct Admin {
    /// The host's data folder [default: `$CELLCASTER_DATA`, or cellcaster in the user's data folder]
    #[arg(long, global = true, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) data: Option<PathBuf>,
    /// The host's store: a folder, or a PostgreSQL database [default: `$CELLCASTER_STORE`, or the data folder]
    #[arg(long, global = true, value_name = "URL|FOLDER", value_parser = StoreLocation::parse)]
    pub(crate) store: Option<StoreLocation>,
    #[command(subcommand)]
    pub(crate) action: AdminAction,
}

#[derive(Debug, Subcommand)]
pub(crate) enum AdminAction {
    /// List the visitors
    Who(ListOptions),
    /// List the open rooms
    Rooms(ListOptions),
    /// List the hosts of the cluster
    Hosts(ListOptions),
    /// End the sessions of a player, or one session
    Kick {
        #[command(flatten)]
        player: SessionSelector,
        /// The reason, which the player sees
        #[arg(long, value_name = "TEXT", default_value = "")]
        reason: String,
    },
    /// Ban a player
    Ban {
        #[command(flatten)]
        player: PlayerSelector,
        #[command(flatten)]
        terms: BanTerms,
    },
    /// End a ban
    Unban {
        #[command(flatten)]
        player: PlayerSelector,
    },
    /// List the bans in force
    Bans(ListOptions),
    /// Mute a player, who can still play; an online guest is muted by address
    Mute {
        #[command(flatten)]
        player: SessionSelector,
        #[command(flatten)]
        terms: BanTerms,
    },
    /// End a mute
    Unmute {
        #[command(flatten)]
        player: PlayerSelector,
    },
    /// List the mutes in force
    Mutes(ListOptions),
    /// Send a message to all visitors
    Say {
        /// The message
        text: String,
    },
    /// End the server, as SIGTERM does
    Drain,
}

#[derive(Args, Debug)]
pub(crate) struct ListOptions {
    /// The format of the list
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ListFormat,
}

/// The player that an action affects, named in one of three ways.
#[derive(Args, Debug)]
#[group(id = "target", required = true, multiple = false)]
pub(crate) struct PlayerSelector {
    /// The player's name
    #[arg(value_parser = name)]
    name: Option<Name>,
    /// The player's public key, as ssh-keygen -l prints its fingerprint
    #[arg(long, value_name = "FINGERPRINT", value_parser = key)]
    key: Option<AccountKey>,
    /// All players with this address, or with an address in this range
    #[arg(long, value_name = "RANGE", value_parser = range)]
    address: Option<AddressPrefix>,
}

impl PlayerSelector {
    pub(crate) fn target(self) -> BanTarget {
        let Self { name, key, address } = self;
        let others = key.map(BanTarget::Key).or(address.map(BanTarget::Addresses));
        // The name is missing only if there is another one.
        others.unwrap_or_else(|| BanTarget::Name(name.unwrap_or(Name::kept(""))))
    }
}

/// A player, or one session.
#[derive(Args, Debug)]
pub(crate) struct SessionSelector {
    #[command(flatten)]
    player: PlayerSelector,
    /// The id of one session, from "cellcaster-server admin who"
    #[arg(long, value_name = "ID", value_parser = session, group = "target")]
    session: Option<SessionId>,
}

impl SessionSelector {
    pub(crate) fn target(self) -> Target {
        let player = || Target::Visitors(self.player.target());
        self.session.map_or_else(player, Target::Session)
    }
}

/// The time and the reason of a ban or a mute.
#[derive(Args, Debug)]
pub(crate) struct BanTerms {
    /// The duration, such as 30m or 7d [default: forever]
    #[arg(long = "for", value_name = "TIME", value_parser = time)]
    pub(crate) time: Option<Duration>,
    /// The reason, which the player sees
    #[arg(long, value_name = "TEXT", default_value = "")]
    pub(crate) reason: String,
}

/// List the leaderboards of a host
///
/// For each level and difficulty, and for each daily level of the last seven days, lists each account's fastest run
/// and highest rank. Reads the store, even while the server runs.
#[derive(Args, Debug)]
#[command(
    after_help = "Examples:\n  cellcaster-server scores --level cellar --difficulty hard\n  cellcaster-server scores --format json"
)]
pub(crate) struct Scores {
    /// The host's data folder [default: `$CELLCASTER_DATA`, or cellcaster in the user's data folder]
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) data: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) store: Store,
    /// List this level only: a built-in one, a map of the host, or a daily level such as daily-2026-11-28
    #[arg(long, value_name = "NAME", value_parser = level)]
    pub(crate) level: Option<String>,
    /// List this difficulty only: easy, normal or hard
    #[arg(long, value_name = "LEVEL", value_parser = difficulty)]
    pub(crate) difficulty: Option<Difficulty>,
    /// The format of the boards
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ListFormat,
}

/// The format of a list.
#[derive(Clone, Copy, Debug, Default, ValueEnum)]
pub(crate) enum ListFormat {
    #[default]
    Table,
    Json,
}

/// Watch the recording of a room in the terminal, or print how its rounds ended
///
/// Space pauses, the arrows move through the recording, Tab shows the next player, v changes the view, and "?" shows
/// the other keys.
#[derive(Args, Debug)]
pub(crate) struct Replay {
    /// A recording that --record-room wrote
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// The map file or the folder of maps, if rounds used the host's own maps
    #[arg(value_hint = ValueHint::AnyPath)]
    pub(crate) maps: Option<PathBuf>,
    /// Print each round with its standings instead; the exit status is 0 if the recording can be replayed
    #[arg(long)]
    pub(crate) verify: bool,
    /// Print the rounds, and write what a member saw as an animated PNG in half blocks and 24-bit colours
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) png: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) excerpt: Excerpt,
    /// Draw what the member with this name saw [default: the first member]
    #[arg(long, value_name = "NAME", requires = "png")]
    pub(crate) member: Option<String>,
}

/// Parses the address of a cluster.
fn cluster_address(text: &str) -> Result<Secret, ValidValues> {
    let is_address = |text: &str| {
        let rest = ["nats://", "tls://"].iter().find_map(|kind| text.strip_prefix(kind));
        rest.is_some_and(|rest| !rest.is_empty())
    };
    let takes = "a NATS address such as nats://host:4222, or several separated by commas";
    text.split(',').all(is_address).then(|| Secret(text.to_owned())).ok_or(ValidValues(takes))
}

fn address(text: &str) -> Result<SocketAddr, ValidValues> {
    text.parse()
        .map_err(|_| ValidValues("an address and a port, such as 0.0.0.0:2222 or [::]:2222"))
}

fn name(text: &str) -> Result<Name, ValidValues> {
    let name = Name::kept(text);
    let has_text = !name.as_str().is_empty();
    has_text.then_some(name).ok_or(ValidValues("a name with a printable character"))
}

fn key(text: &str) -> Result<AccountKey, ValidValues> {
    AccountKey::parse(text)
        .ok_or(ValidValues("a fingerprint as ssh-keygen -l prints it, such as SHA256:..."))
}

fn range(text: &str) -> Result<AddressPrefix, ValidValues> {
    AddressPrefix::parse(text)
        .ok_or(ValidValues("an address, or a range such as 203.0.113.0/24 or 2001:db8::/64"))
}

fn session(text: &str) -> Result<SessionId, ValidValues> {
    SessionId::parse(text)
        .ok_or(ValidValues("a session id from \"cellcaster-server admin who\", such as 3f9a-7"))
}

fn level(text: &str) -> Result<String, ValidValues> {
    let is_plain =
        |byte: u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"-_".contains(&byte);
    let is_name = !text.is_empty() && text.bytes().all(is_plain);
    is_name.then(|| text.to_owned()).ok_or(ValidValues(
        "the name of a built-in level, or of one of the host's maps without .toml",
    ))
}

fn difficulty(text: &str) -> Result<Difficulty, ValidValues> {
    Difficulty::named(text).ok_or(ValidValues("easy, normal or hard"))
}

/// Parses a time such as `7d`, up to a hundred years.
fn time(text: &str) -> Result<Duration, ValidValues> {
    const MAX_LENGTH: u64 = 100 * 365 * 24 * 60 * 60;
    let seconds = || {
        let unit = text.chars().last()?;
        let seconds = match unit {
            'm' => 60,
            'h' => 60 * 60,
            'd' => 24 * 60 * 60,
            'w' => 7 * 24 * 60 * 60,
            _ => return None,
        };
        let number = text.strip_suffix(unit)?;
        let is_number = number.bytes().all(|byte| byte.is_ascii_digit());
        let seconds = number.parse::<u64>().ok().filter(|_| is_number)?.checked_mul(seconds)?;
        (1..=MAX_LENGTH).contains(&seconds).then(|| Duration::from_secs(seconds))
    };
    seconds().ok_or(ValidValues("a number with m, h, d or w, such as 30m or 7d"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_is_a_number_with_a_unit() {
        for (text, minutes) in
            [("30m", 30), ("1h", 60), ("7d", 7 * 24 * 60), ("2w", 2 * 7 * 24 * 60)]
        {
            assert_eq!(time(text).ok(), Some(Duration::from_secs(minutes * 60)), "{text}");
        }
        for text in [
            "",
            "7",
            "d",
            "0d",
            "-1d",
            "+1d",
            "1.5h",
            "7 d",
            "7ä",
            "99999999999999999999d",
            "36501d",
        ] {
            assert!(time(text).is_err(), "{text}");
        }
    }
}
