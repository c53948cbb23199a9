//! `cellcaster serve`: the SSH server.

use std::fs;
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

use tokio::runtime::Runtime;

use super::Error;
use super::arguments::Serve;
use super::config::configuration_file;
use super::data_folder::data_folder;
use crate::server::{Arrival, Config, Departure, Host, HostKey, Link, Server, Visitor};

/// Serves until a signal ends it.
pub(super) fn run(options: Serve) -> Result<(), Error> {
    let mut config = load(options.config)?;
    config.listen = options.listen.unwrap_or(config.listen);
    let folder = options.data.or_else(data_folder).ok_or_else(|| {
        Error::mistake("there is no folder for data; name one, as in \"serve --data FOLDER\"")
    })?;
    let key = HostKey::open(&folder).map_err(|error| Error::mistake(error.to_string()))?;
    let runtime = Runtime::new()
        .map_err(|error| Error::machine(format!("no thread can be started: {error}")))?;
    runtime.block_on(serve(config, key))
}

async fn serve(config: Config, key: HostKey) -> Result<(), Error> {
    let wanted = config.listen;
    let fingerprint = key.fingerprint();
    let cannot = |error: io::Error| Error::mistake(format!("{wanted} can't be used: {error}"));
    let stop =
        stop().map_err(|error| Error::machine(format!("no signal can be caught: {error}")))?;
    let server = Server::bind(config, key).await.map_err(cannot)?;
    let text = invitation(server.address().map_err(cannot)?, &fingerprint);
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))?;
    server.run(NoRooms, stop).await;
    Ok(())
}

/// The configuration of the named file, or of the default one if it exists.
fn load(named: Option<PathBuf>) -> Result<Config, Error> {
    let is_named = named.is_some();
    let Some(path) = named.or_else(|| configuration_file("serve.toml")) else {
        return Ok(Config::default());
    };
    let name = path.display().to_string();
    match fs::read_to_string(&path) {
        Ok(text) => Ok(Config::parse(&text, &name)?),
        Err(error) if error.kind() == io::ErrorKind::NotFound && !is_named => Ok(Config::default()),
        Err(error) => Err(Error::mistake(format!("{name} can't be read: {error}"))),
    }
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

/// Ready when a signal asks the server to end.
#[cfg(unix)]
fn stop() -> io::Result<impl Future<Output = ()> + Send> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
    })
}

/// Ready when Ctrl-C asks the server to end.
#[cfg(not(unix))]
fn stop() -> io::Result<impl Future<Output = ()> + Send> {
    Ok(async { _ = tokio::signal::ctrl_c().await })
}

/// Tells visitors that there is nothing to play yet.
struct NoRooms;

impl Host for NoRooms {
    async fn serve(&self, visitor: Visitor, link: Link) -> Departure {
        let Link { mut inbound, mut outbox } = link;
        let who = match &visitor.key {
            Some(key) => format!("with the key {}", key.fingerprint()),
            None => "a guest".to_owned(),
        };
        let notice = visitor.notice.map(|notice| format!("{notice}\r\n")).unwrap_or_default();
        let text = format!(
            "You are {}, {who}. No room is open on this server. Press any key.\r\n{notice}",
            visitor.user
        );
        _ = outbox.try_send(text.into_bytes());
        outbox.drained().await;
        while matches!(inbound.next().await, Arrival::Resized(_)) {}
        Departure::default()
    }
}
