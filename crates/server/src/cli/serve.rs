//! `cellcaster-server`: the SSH server.

mod configuration;
mod signals;

use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;

use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::task::JoinSet;

use super::arguments::Serve;
use super::host_store::{Database, failed};
use crate::accounts::{HostNotice, HostStore, StoreFailure, WaitingResults};
use crate::cluster::Cluster;
use crate::config::Config;
use crate::logging::{self, LogFormat, Logging};
use crate::metrics::respond;
#[cfg(unix)]
use crate::operator::socket::AdminSocket;
use crate::sessions::driver::{GameHost, HostParts};
use crate::ssh::Server;
use crate::ssh::host_key::HostKey;
use crate::visitors::Visitors;
use cellcaster::cli::Error;
use cellcaster::cli::machine::data_folder;
use configuration::Configuration;
use signals::{Hangups, Signals};

/// Serves until a signal ends it.
pub(crate) fn run(mut options: Serve) -> Result<(), Error> {
    let (configuration, config) = Configuration::begin(&options)?;
    let folder = options.data.take().or_else(data_folder).ok_or_else(|| {
        Error::mistake(
            "there is no folder for data; name one, as in \"cellcaster-server --data FOLDER\"",
        )
    })?;
    let key = HostKey::open(&folder).map_err(|error| Error::mistake(error.to_string()))?;
    let database = Database::named(options.store.store.take());
    let database = database.unwrap_or_else(|| Database::Folder(folder.clone()));
    let cluster = pending_cluster(&options, &database)?;
    let store = open_store(&database, options.accept_empty)?;
    let waiting = waiting(&folder)?;
    let runtime = Runtime::new().map_err(|error| no_thread(&error))?;
    let parts =
        Parts { config, key, folder: &folder, format: options.log, store, waiting, cluster };
    let ended = runtime.block_on(serve(configuration, parts));
    // After a second signal, nothing is waited for.
    runtime.shutdown_background();
    ended
}

/// What a server is made of.
struct Parts<'a> {
    config: Config,
    key: HostKey,
    /// For data.
    folder: &'a Path,
    format: LogFormat,
    store: HostStore,
    waiting: WaitingResults,
    /// In a cluster.
    cluster: Option<PendingCluster>,
}

async fn serve(configuration: Configuration, parts: Parts<'_>) -> Result<(), Error> {
    let Parts { config, key, folder, format, store, waiting, cluster } = parts;
    let no_signals = |error| Error::machine(format!("no signal can be caught: {error}"));
    let signals = Signals::catch().map_err(no_signals)?;
    let hangups = Hangups::catch().map_err(no_signals)?;
    let (wanted, fingerprint, filter) = (config.listen, key.fingerprint(), config.log.clone());
    let cannot = |error| cannot_listen(wanted, &error);
    let metrics_listener = match config.metrics {
        Some(address) => {
            Some(TcpListener::bind(address).await.map_err(|error| cannot_listen(address, &error))?)
        }
        None => None,
    };
    #[cfg(unix)]
    let admin = bind_admin(folder)?;
    let server = Server::bind(config, key).await.map_err(cannot)?;
    let address = server.address().map_err(cannot)?;
    let logging = Logging::begin(format, &filter);
    logging::listening(address, &fingerprint);

    let host = HostParts::new(server.config(), server.metrics(), Visitors::default(), store);
    let host = host.map_err(|error| no_thread(&error))?;
    let mut host = host.with_maps(configuration.maps()).with_waiting(waiting);
    if let Some(cluster) = cluster {
        host = cluster.join(host, address).await?;
    }
    let host = GameHost::start(host);
    // The rooms take a moment to make. Those who are invited, and operators, are answered at once.
    let text = invitation(address, &fingerprint);
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))?;
    let mut services = JoinSet::new();
    if let Some(listener) = metrics_listener {
        logging::metrics_listening(listener.local_addr().map_err(cannot)?);
        services.spawn(respond(listener, server.metrics()));
    }
    let operator = host.operator(signals.drain());
    services.spawn(operator.clone().answer_others());
    #[cfg(unix)]
    if let Some(admin) = admin {
        services.spawn(admin.serve(operator));
    }
    services.spawn(configuration.follow(hangups, server.config(), logging));
    let ending = host.ending();
    tokio::select! {
        () = server.run(host, signals.first()) => ending.await,
        () = signals.second() => {}
    }
    // Else the process might end before the socket is removed.
    services.shutdown().await;
    logging::ended();
    Ok(())
}

/// The store. A damaged one is an error unless the operator accepts that it may be empty.
fn open_store(database: &Database, accepts_empty: bool) -> Result<HostStore, Error> {
    let refused = |failure: StoreFailure| Error::mistake(failure.to_string());
    if !accepts_empty {
        return database.open().map_err(refused);
    }
    let (store, damage) = database.open_or_salvage().map_err(refused)?;
    if let Some(sentence) = damage {
        Error::machine(sentence).warn();
    }
    Ok(store)
}

/// A cluster that the host is going to join.
struct PendingCluster {
    address: String,
    /// Each on a connection of its own, so that they wait for nothing else.
    leases: HostStore,
    presence: HostStore,
}

/// The cluster that `options` name. The store is that of all hosts.
fn pending_cluster(options: &Serve, store: &Database) -> Result<Option<PendingCluster>, Error> {
    let Some(address) = options.cluster() else { return Ok(None) };
    let Database::Address(store) = store else {
        return Err(Error::mistake(
            "a cluster needs a database that all hosts share: name it, as in \
             \"--store postgres://USER@HOST/DATABASE\"",
        ));
    };
    if options.record_room.is_some() {
        return Err(Error::mistake("rooms of a cluster are not recorded: leave out --record-room"));
    }
    let open = || HostStore::connect(store).map_err(|failure| Error::mistake(failure.to_string()));
    Ok(Some(PendingCluster { address, leases: open()?, presence: open()? }))
}

impl PendingCluster {
    /// Joins the cluster under a name that no other host has, with a host that listens at `address`.
    async fn join(self, host: HostParts, address: SocketAddr) -> Result<HostParts, Error> {
        let notice = HostNotice {
            name: unique_name(address),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            address: address.to_string(),
            load: 0,
        };
        let cluster = Cluster::join(&self.address, self.leases, self.presence, notice).await;
        Ok(host.in_cluster(cluster.map_err(Error::mistake)?))
    }
}

/// The name of this machine with the port, which operators know, and a number that no other start of a host has.
fn unique_name(address: SocketAddr) -> String {
    #[cfg(unix)]
    let machine =
        rustix::system::uname().nodename().to_string_lossy().replace(char::is_whitespace, "-");
    #[cfg(not(unix))]
    let machine = address.ip();
    format!("{machine}:{} {:08x}", address.port(), getrandom::u32().unwrap_or_default())
}

/// The results that wait in the folder for data.
fn waiting(folder: &Path) -> Result<WaitingResults, Error> {
    let (waiting, damage) = WaitingResults::open(folder).map_err(failed)?;
    if let Some(sentence) = damage {
        Error::machine(sentence).warn();
    }
    Ok(waiting)
}

/// The socket for `cellcaster-server admin`. Without one the server runs, too, as in a folder with a name
/// that is too long for a socket.
#[cfg(unix)]
fn bind_admin(folder: &Path) -> Result<Option<AdminSocket>, Error> {
    match AdminSocket::bind(folder) {
        Ok(socket) => Ok(Some(socket)),
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
            let folder = folder.display().to_string().replace(char::is_control, "?");
            Err(Error::mistake(format!("another server runs with the data in {folder}")))
        }
        Err(error) => {
            Error::machine(format!("\"cellcaster-server admin\" can't reach this server: {error}"))
                .warn();
            Ok(None)
        }
    }
}

fn no_thread(error: &io::Error) -> Error {
    Error::machine(format!("no thread can be started: {error}"))
}

fn cannot_listen(address: SocketAddr, error: &io::Error) -> Error {
    Error::mistake(format!("{address} can't be used: {error}"))
}

/// What people type to play.
fn invitation(address: SocketAddr, fingerprint: &str) -> String {
    let host = match address.ip() {
        ip if ip.is_unspecified() => "HOST".to_owned(),
        IpAddr::V4(ip) => ip.to_string(),
        IpAddr::V6(ip) => ip.to_string(),
    };
    let port = match address.port() {
        22 => String::new(),
        port => format!("-p {port} "),
    };
    format!(
        "Listening at {address}; the host key is {fingerprint}.\n\
         To play, type:         ssh {port}{host}\n\
         Over a slow link:      ssh -C {port}{host}\n\
         As a guest with a key: ssh {port}guest@{host}\n"
    )
}
