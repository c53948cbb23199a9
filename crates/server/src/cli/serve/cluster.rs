//! The cluster of a host: what joining it needs, before anything runs.

use std::net::SocketAddr;

use super::{Database, Error, Serve};
use crate::accounts::{HostNotice, HostStore};
use crate::cluster::Cluster;
use crate::sessions::driver::HostParts;

/// A cluster that the host is going to join.
pub(crate) struct PendingCluster {
    address: String,
    /// Each on a connection of its own, so that they wait for nothing else.
    leases: HostStore,
    presence: HostStore,
}

/// The cluster that `options` name. The store is that of all hosts.
pub(crate) fn pending(options: &Serve, store: &Database) -> Result<Option<PendingCluster>, Error> {
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
    pub(crate) async fn join(
        self,
        host: HostParts,
        address: SocketAddr,
    ) -> Result<HostParts, Error> {
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
