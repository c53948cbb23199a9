//! Connections without sockets, for fuzz targets. The session sends back what the client sends.

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::sync::{Arc, LazyLock};

use tokio::io::{AsyncRead, AsyncWrite};
use tokio::sync::{oneshot, watch};

use super::connection::{self, Entry, Shared};
use super::{Arrival, Counters, Departure, Host, Link, Phase, Visitor};
use crate::ops::config::{Config, LiveConfig};
use crate::ssh::host_key::HostKey;
use cellcaster::rng::SplitMix64;

static KEY: LazyLock<HostKey> = LazyLock::new(|| HostKey::of_seed([7; 32]));

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

/// Serves the client at the other end of `stream` until the connection has ended, in the runtime of the caller.
///
/// # Panics
/// If the first connection is refused.
pub async fn serve(stream: impl AsyncRead + AsyncWrite + Unpin + Send + 'static) {
    let peer = IpAddr::from(Ipv4Addr::LOCALHOST);
    let (_phase, phases) = watch::channel(Phase::Open);
    let config = LiveConfig::new(Config::default());
    let shared = Arc::new(Shared::new(config, &KEY, Arc::<Counters>::default(), phases));
    let visit = shared.admission(|admission, now| {
        admission.arrive(peer, now, &mut SplitMix64::new(1)).expect("there is no other one").id
    });
    // Nothing displaces it while this end is kept.
    let (_displaces, displaced) = oneshot::channel();
    let entry = Entry { visit, displaced };
    connection::serve(shared, Arc::new(Echo), stream, SocketAddr::from((peer, 22)), entry).await;
}
