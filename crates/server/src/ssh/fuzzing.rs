//! Connections without sockets, for fuzz targets. The session echoes the client's bytes.

use std::net::{Ipv4Addr, SocketAddr};
use std::sync::{Arc, LazyLock};

use tokio::io::{AsyncRead, AsyncWrite};

use super::connection::{self, ssh_config};
use super::gate::Gate;
use super::host_key::HostKey;
use super::{Arrival, Departure, Host, Link, Visitor};
use crate::config::{Config, LiveConfig};
use russh::keys::PrivateKey;
use russh::keys::ssh_key::private::Ed25519Keypair;

static KEY: LazyLock<HostKey> =
    LazyLock::new(|| HostKey { key: PrivateKey::from(Ed25519Keypair::from_seed(&[7; 32])) });

struct Echo;

impl Host for Echo {
    async fn serve(&self, _: Visitor, Link { mut inbound, mut outbox }: Link) -> Departure {
        loop {
            match inbound.next().await {
                Arrival::Bytes(bytes) => {
                    outbox.drained().await;
                    _ = outbox.try_send(bytes);
                }
                Arrival::Resized(_) | Arrival::Drains => {}
                Arrival::Ended => return Departure::default(),
            }
        }
    }
}

/// Serves the client at the other end of `stream` until the connection ends, on the caller's runtime.
///
/// # Panics
/// If the first connection is refused.
pub async fn serve(stream: impl AsyncRead + AsyncWrite + Unpin + Send + 'static) {
    let gate = Arc::new(Gate::new(LiveConfig::new(Config::default()), Arc::default()));
    let peer = SocketAddr::from((Ipv4Addr::LOCALHOST, 22));
    let entry = gate.admit(peer).unwrap_or_else(|_| panic!("there is no other one"));
    let ssh = Arc::new(ssh_config(&KEY));
    connection::serve(gate, ssh, Arc::new(Echo), stream, entry).await;
}
