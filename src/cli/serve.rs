//! `cellcaster serve`: the SSH server.

mod configuration;
mod signals;

use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::Path;
use std::sync::Arc;

use tokio::net::TcpListener;
use tokio::runtime::Runtime;
use tokio::task::JoinSet;

use super::Error;
use super::arguments::Serve;
use super::data_folder::data_folder;
#[cfg(unix)]
use crate::server::{AdminSocket, Operator};
use crate::server::{
    Arrival, Config, Departure, Host, HostKey, Inbound, Link, LogFormat, Logging, Metrics, Notice,
    Outbox, Presence, Server, Visitor, Visitors, events, respond,
};
use crate::store::host::AccountKey;
use configuration::Configuration;
use signals::{Hangups, Signals};

/// Serves until a signal ends it.
pub(super) fn run(options: Serve) -> Result<(), Error> {
    let configuration = Configuration::new(options.config, options.listen);
    let config = configuration.read()?;
    let folder = options.data.or_else(data_folder).ok_or_else(|| {
        Error::mistake("there is no folder for data; name one, as in \"serve --data FOLDER\"")
    })?;
    let key = HostKey::open(&folder).map_err(|error| Error::mistake(error.to_string()))?;
    let runtime = Runtime::new()
        .map_err(|error| Error::machine(format!("no thread can be started: {error}")))?;
    let ended = runtime.block_on(serve(configuration, config, key, &folder, options.log));
    // After a second signal, nothing is waited for.
    runtime.shutdown_background();
    ended
}

async fn serve(
    configuration: Configuration,
    config: Config,
    key: HostKey,
    folder: &Path,
    format: LogFormat,
) -> Result<(), Error> {
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
    let text = invitation(address, &fingerprint);
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))?;
    let logging = Logging::begin(format, &filter);
    events::listening(address, &fingerprint);

    let visitors = Visitors::default();
    let mut services = JoinSet::new();
    if let Some(listener) = metrics_listener {
        events::metrics_listening(listener.local_addr().map_err(cannot)?);
        let (metrics, counters) = (Arc::new(Metrics::default()), server.counters());
        services.spawn(respond(listener, move || metrics.text(&counters)));
    }
    #[cfg(unix)]
    if let Some(admin) = admin {
        let (visitors, drain) = (visitors.clone(), signals.drain());
        services.spawn(admin.serve(Operator { visitors, rooms: Box::new(Vec::new), drain }));
    }
    services.spawn(configuration.follow(hangups, server.config(), logging));
    tokio::select! {
        () = server.run(NoRooms { visitors }, signals.first()) => {}
        () = signals.second() => {}
    }
    events::ended();
    Ok(())
}

/// The socket for `cellcaster admin`. Without one the server runs, too, as in a folder with a name
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
            Error::machine(format!("\"cellcaster admin\" can't reach this server: {error}")).warn();
            Ok(None)
        }
    }
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

/// Tells visitors that there is nothing to play yet.
struct NoRooms {
    visitors: Visitors,
}

impl Host for NoRooms {
    async fn serve(&self, visitor: Visitor, link: Link) -> Departure {
        let Link { mut inbound, mut outbox } = link;
        let key = visitor.key.as_ref().and_then(|key| AccountKey::parse(key.fingerprint()));
        let mut presence = self.visitors.arrive(visitor.peer.ip(), key);
        presence.set_name(&visitor.user);
        let who = match &visitor.key {
            Some(key) => format!("with the key {}", key.fingerprint()),
            None => "a guest".to_owned(),
        };
        let text = format!(
            "You are {}, {who}. No room is open on this server. Press any key.\r\n",
            visitor.user
        );
        tell(&mut outbox, &text).await;
        wait(&mut inbound, &mut outbox, &mut presence).await;
        Departure::default()
    }
}

/// Waits for a key, the end of the link, or an operator who ends the session.
async fn wait(inbound: &mut Inbound, outbox: &mut Outbox, presence: &mut Presence) {
    loop {
        tokio::select! {
            arrival = inbound.next() => {
                if !matches!(arrival, Arrival::Resized(_)) {
                    return;
                }
            }
            notice = presence.notice() => match notice {
                Notice::Said(line) => tell(outbox, &format!("{line}\r\n")).await,
                Notice::Removed(sentence) => {
                    return tell(outbox, &format!("{sentence}\r\n")).await;
                }
            },
        }
    }
}

async fn tell(outbox: &mut Outbox, text: &str) {
    outbox.drained().await;
    _ = outbox.try_send(text.as_bytes().to_vec());
    outbox.drained().await;
}
