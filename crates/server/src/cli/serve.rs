//! `cellcaster-server`: the SSH server.

use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use tokio::runtime::Runtime;
use tokio::sync::{Notify, watch};
use tokio::task::JoinSet;

use super::arguments::Serve;
use super::host_store::{self, Secret, StoreLocation, failed};
use crate::accounts::{HostNotice, HostStore, KnownPlayers, WaitingResults};
use crate::cluster::Cluster;
use crate::config::{Config, LiveConfig};
use crate::logging::{self, Logging};
use crate::metrics::respond;
#[cfg(unix)]
use crate::operator::socket::AdminSocket;
use crate::rooms::maps::HostMaps;
use crate::rooms::room::Catalog;
use crate::service::http;
use crate::sessions::driver::{GameHost, HostParts};
use crate::ssh::Server;
use crate::ssh::host_key::HostKey;
use crate::visitors::Visitors;
use crate::web::{self, Web};
use cellcaster::app::store::private;
use cellcaster::cli::Error;
use cellcaster::cli::config::MAX_BYTES;
use cellcaster::cli::machine::configuration_file;

/// Serves until a signal ends it.
pub(crate) fn run(options: Serve) -> Result<(), Error> {
    let (configuration, config) = Configuration::begin(options)?;
    let options = &configuration.options;
    let folder = host_store::folder(options.data.clone())?;
    let key = HostKey::open(&folder).map_err(Error::mistake)?;
    let database = StoreLocation::named(options.store.store.clone(), Some(folder.clone()))?;
    let (cluster, format) = (cluster(options, &database)?, options.log);
    let store = database.open().map_err(|failure| Error::mistake(failure.to_string()))?;
    let waiting = WaitingResults::open(&folder).map(warned).map_err(failed)?;
    let known = store.database().map(|database| warned(KnownPlayers::open(&folder, database)));
    let runtime = Runtime::new().map_err(|error| no_thread(&error))?;
    let ended = runtime.block_on(async {
        let (ends, hangups) = catch_signals()
            .map_err(|error| Error::machine(format!("signals can't be caught: {error}")))?;
        let (wanted, fingerprint, filter) = (config.listen, key.fingerprint(), config.log.clone());
        let cannot = |error| cannot_listen(wanted, &error);
        let listen_to = |address| {
            http::listen(address).map_err(|error: io::Error| cannot_listen(address, &error))
        };
        let metrics_listener = config.metrics.map(listen_to).transpose()?;
        let web_listener = config.web.map(listen_to).transpose()?;
        #[cfg(unix)]
        let admin = bind_admin(&folder)?;
        let server = Server::bind(config, key).await.map_err(cannot)?;
        let address = server.address().map_err(cannot)?;
        let logging = Logging::begin(format, &filter);
        logging::listening(address, &fingerprint);

        let host = HostParts::new(server.config(), server.metrics(), Visitors::default(), store);
        let mut host = host.map_err(|error| no_thread(&error))?;
        host.catalog = Catalog::with(&configuration.maps);
        host.waiting = Some(waiting);
        host.known = known;
        if let Some((cluster, [leases, presence])) = cluster {
            let cluster = Cluster::join(&cluster, leases, presence, notice(address)).await;
            host.cluster = Some(cluster.map_err(Error::mistake)?);
        }
        let host = GameHost::start(host);
        // Creating the rooms takes a moment. Visitors and operators are answered at once.
        let text = invitation(address, &fingerprint);
        io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))?;
        let mut services = JoinSet::new();
        if let Some(listener) = metrics_listener {
            logging::metrics_listening(listener.local_addr().map_err(cannot)?);
            services.spawn(respond(listener, server.metrics()));
        }
        if let Some(listener) = web_listener {
            logging::web_listening(listener.local_addr().map_err(cannot)?);
            let (rooms, load) = host.rooms();
            let boards = Box::new(host.store_calls(web::read_boards));
            services.spawn(Web::new(server.config(), rooms, load, boards).serve(listener));
        }
        let operator = host.operator(ends.clone());
        services.spawn(operator.clone().answer_others());
        #[cfg(unix)]
        if let Some(admin) = admin {
            services.spawn(admin.serve(operator));
        }
        services.spawn(configuration.follow(hangups, server.config(), logging));
        let ending = host.ending();
        tokio::select! {
            () = server.run(host, asked(&ends, 1)) => ending.await,
            () = asked(&ends, 2) => {}
        }
        // Otherwise the process might end before the socket is removed.
        services.shutdown().await;
        logging::ended();
        Ok(())
    });
    // After a second signal, wait for nothing.
    runtime.shutdown_background();
    ended
}

/// Returns the opened value, and warns first if it was damaged.
fn warned<T>((opened, damage): (T, Option<String>)) -> T {
    if let Some(sentence) = damage {
        Error::machine(sentence).warn();
    }
    opened
}

/// The address of the cluster's bus that `options` name, and two connections to the database of all hosts: one for
/// leases and one for visits, so that neither waits for other calls.
fn cluster(
    options: &Serve,
    store: &StoreLocation,
) -> Result<Option<(String, [HostStore; 2])>, Error> {
    let Some(address) = options.cluster() else { return Ok(None) };
    let StoreLocation::Address(Secret(store)) = store else {
        return Err(Error::mistake(
            "a cluster needs a database that all hosts share: name it, as in \
             \"--store postgres://USER@HOST/DATABASE\"",
        ));
    };
    let open = || HostStore::connect(store).map_err(|failure| Error::mistake(failure.to_string()));
    Ok(Some((address, [open()?, open()?])))
}

/// The information about this host for the others. The name consists of the machine's name with the port, which
/// operators know, and a number that is unique to this start.
fn notice(address: SocketAddr) -> HostNotice {
    #[cfg(unix)]
    let machine =
        rustix::system::uname().nodename().to_string_lossy().replace(char::is_whitespace, "-");
    #[cfg(not(unix))]
    let machine = address.ip();
    let number = getrandom::u32().unwrap_or_default();
    HostNotice {
        name: format!("{machine}:{} {number:08x}", address.port()),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        address: address.to_string(),
        load: 0,
    }
}

/// The socket for `cellcaster-server admin`. The server also runs without one, for example if the name of the folder is
/// too long for a socket.
#[cfg(unix)]
fn bind_admin(folder: &Path) -> Result<Option<AdminSocket>, Error> {
    match AdminSocket::bind(folder) {
        Ok(socket) => Ok(Some(socket)),
        Err(error) if error.kind() == io::ErrorKind::AddrInUse => {
            let folder = folder.display().to_string().replace(char::is_control, "?");
            Err(Error::mistake(format!("another server already uses the data folder {folder}")))
        }
        Err(error) => {
            Error::machine(format!("\"cellcaster-server admin\" can't reach this server: {error}"))
                .warn();
            Ok(None)
        }
    }
}

fn no_thread(error: &io::Error) -> Error {
    Error::machine(format!("a thread can't be started: {error}"))
}

fn cannot_listen(address: SocketAddr, error: &io::Error) -> Error {
    Error::mistake(format!("the server can't listen on {address}: {error}"))
}

/// The lines that tell people how to play.
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

/// The sources of the configuration. The file and the maps that it names are read at the start, and the file again at
/// each hang-up. The command line takes precedence over the file.
struct Configuration {
    options: Serve,
    /// The maps, which are read once.
    maps: HostMaps,
}

impl Configuration {
    /// Reads the file that `options` name, or otherwise the default file, and the maps.
    fn begin(options: Serve) -> Result<(Self, Config), Error> {
        let mut configuration = Self { options, maps: HostMaps::default() };
        let text = configuration.text()?;
        let config = configuration.parse(&text)?;
        if let Some(folder) = &config.maps {
            let maps = HostMaps::read(folder);
            configuration.maps = maps.map_err(|faults| Error::report_of(&faults))?;
        }
        configuration.check_levels(&config, &text)?;
        Ok((configuration, config))
    }

    /// `None` if the system has no folder for it.
    fn file(&self) -> Option<PathBuf> {
        self.options.config.clone().or_else(|| configuration_file("serve.toml"))
    }

    /// Reads the file again at each hang-up. If the file has a fault, the configuration stays unchanged.
    async fn follow(self, hangups: Arc<Notify>, live: LiveConfig, logging: Logging) {
        loop {
            hangups.notified().await;
            match self.read_again() {
                Ok(config) => {
                    logging.set_filter(&config.log);
                    let fixed = live.replace(config);
                    logging::reloaded(self.file().as_deref(), &fixed);
                }
                Err(error) => error.to_string().lines().for_each(logging::configuration_fault),
            }
        }
    }

    fn read_again(&self) -> Result<Config, Error> {
        let text = self.text()?;
        let config = self.parse(&text)?;
        // A change of the maps has no effect until the next start.
        self.check_levels(&config, &text)?;
        Ok(config)
    }

    fn parse(&self, text: &str) -> Result<Config, Error> {
        let mut config = Config::parse(text, &self.file_name())?;
        let Serve { listen, maps, web, record_room, .. } = &self.options;
        config.listen = listen.unwrap_or(config.listen);
        config.maps = maps.clone().or(config.maps);
        config.web = web.or(config.web);
        config.recordings.clone_from(record_room);
        Ok(config)
    }

    fn check_levels(&self, config: &Config, text: &str) -> Result<(), Error> {
        Ok(config.check_levels(text, &self.file_name(), &self.maps.level_names())?)
    }

    /// The content of the file; empty if the default file does not exist.
    fn text(&self) -> Result<String, Error> {
        let Some(file) = self.file() else { return Ok(String::new()) };
        let is_named = self.options.config.is_some();
        match private::read_text(&file, MAX_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound && !is_named => Ok(String::new()),
            text => text.map_err(|error| {
                Error::mistake(format!("{} can't be read: {error}", self.file_name()))
            }),
        }
    }

    fn file_name(&self) -> String {
        self.file().map_or_else(String::new, |file| file.display().to_string())
    }
}

/// Catches signals. Returns how many times they asked the server to end, and the hang-ups, which only Unix has. Call
/// this within a runtime.
#[cfg(unix)]
fn catch_signals() -> io::Result<(watch::Sender<u32>, Arc<Notify>)> {
    use tokio::signal::unix::{SignalKind, signal};
    let (ends, hangups) = (watch::Sender::default(), Arc::<Notify>::default());
    for kind in [SignalKind::terminate(), SignalKind::interrupt(), SignalKind::hangup()] {
        let (mut signal, ends, hangups) = (signal(kind)?, ends.clone(), Arc::clone(&hangups));
        tokio::spawn(async move {
            while signal.recv().await.is_some() {
                if kind == SignalKind::hangup() {
                    hangups.notify_one();
                } else {
                    ends.send_modify(|count| *count += 1);
                }
            }
        });
    }
    Ok((ends, hangups))
}

/// Catches only Ctrl-C.
#[cfg(not(unix))]
fn catch_signals() -> io::Result<(watch::Sender<u32>, Arc<Notify>)> {
    let ends = watch::Sender::default();
    let count = ends.clone();
    tokio::spawn(async move {
        while tokio::signal::ctrl_c().await.is_ok() {
            count.send_modify(|count| *count += 1);
        }
    });
    Ok((ends, Arc::default()))
}

/// Ready when the server was asked to end `times` times.
fn asked(ends: &watch::Sender<u32>, times: u32) -> impl Future<Output = ()> + Send + use<> {
    let mut count = ends.subscribe();
    async move { _ = count.wait_for(|count| *count >= times).await }
}

#[cfg(test)]
mod tests {
    use std::pin::pin;
    use std::task::{Context, Waker};

    use super::*;

    fn is_ready(future: impl Future<Output = ()>) -> bool {
        pin!(future).poll(&mut Context::from_waker(Waker::noop())).is_ready()
    }

    #[test]
    fn the_second_signal_is_distinguished_from_the_first() {
        let ends = watch::Sender::default();
        assert!(!is_ready(asked(&ends, 1)));
        ends.send_modify(|count| *count += 1);
        assert!(is_ready(asked(&ends, 1)) && !is_ready(asked(&ends, 2)));
        ends.send_modify(|count| *count += 1);
        assert!(is_ready(asked(&ends, 2)));
    }
}
