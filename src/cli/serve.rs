//! `cellcaster serve`: the SSH server.

use std::fs;
use std::io::{self, Write};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;

use tokio::runtime::Runtime;

use super::Error;
use super::arguments::Serve;
use super::config::configuration_file;
use super::data_folder::data_folder;
use crate::server::{Config, GameHost, HostKey, Metrics, Server, Visitors};
use crate::store::host::SqliteStore;

/// Serves until a signal ends it.
pub(super) fn run(options: Serve) -> Result<(), Error> {
    let mut config = load(options.config)?;
    config.listen = options.listen.unwrap_or(config.listen);
    let folder = options.data.or_else(data_folder).ok_or_else(|| {
        Error::mistake("there is no folder for data; name one, as in \"serve --data FOLDER\"")
    })?;
    config.recordings = options.record_room;
    let (store, damage) =
        SqliteStore::open(&folder).map_err(|failure| Error::mistake(failure.to_string()))?;
    if let Some(sentence) = damage {
        eprintln!("{sentence}");
    }
    let key = HostKey::open(&folder).map_err(|error| Error::mistake(error.to_string()))?;
    let runtime = Runtime::new().map_err(no_thread)?;
    runtime.block_on(serve(config, key, store))
}

async fn serve(config: Config, key: HostKey, store: SqliteStore) -> Result<(), Error> {
    let wanted = config.listen;
    let fingerprint = key.fingerprint();
    let cannot = |error: io::Error| Error::mistake(format!("{wanted} can't be used: {error}"));
    let stop =
        stop().map_err(|error| Error::machine(format!("no signal can be caught: {error}")))?;
    let server = Server::bind(config, key).await.map_err(cannot)?;
    let (metrics, visitors) = (Arc::new(Metrics::default()), Visitors::default());
    let host = GameHost::new(server.config(), metrics, visitors, Box::new(store));
    let host = host.map_err(no_thread)?;
    let text = invitation(server.address().map_err(cannot)?, &fingerprint);
    io::stdout().write_all(text.as_bytes()).map_err(|error| Error::of_output(&error))?;
    server.run(host, stop).await;
    Ok(())
}

fn no_thread(error: io::Error) -> Error {
    Error::machine(format!("no thread can be started: {error}"))
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
