//! The parts of a host, before it runs.

use std::io;
use std::sync::Arc;

use super::store_worker::StoreWorker;
use crate::accounts::{HostStore, WaitingResults};
use crate::cluster::Cluster;
use crate::ops::config::LiveConfig;
use crate::ops::metrics::Metrics;
use crate::rooms::directory::Logs;
use crate::rooms::maps::HostMaps;
use crate::rooms::room::Catalog;
use crate::sessions::load::Load;
use crate::sessions::visitors::Visitors;

/// What a [`GameHost`](super::GameHost) is made of.
pub struct HostParts {
    pub(crate) live: LiveConfig,
    pub(crate) metrics: Arc<Metrics>,
    pub(crate) visitors: Visitors,
    pub(crate) catalog: Catalog,
    pub(crate) logs: Logs,
    pub(crate) load: Load,
    pub(crate) store: StoreWorker,
    pub(crate) waiting: Option<WaitingResults>,
    /// Of all chance in rooms.
    pub(crate) seed: u64,
    pub(crate) cluster: Option<Cluster>,
}

impl HostParts {
    /// The parts of a host that keeps accounts and results in `store`, with the built-in levels. It adds to
    /// `metrics`, and its sessions are among `visitors`.
    ///
    /// # Errors
    /// If no thread can be started.
    pub fn new(
        live: LiveConfig,
        metrics: Arc<Metrics>,
        visitors: Visitors,
        store: HostStore,
    ) -> io::Result<Self> {
        Ok(Self {
            visitors,
            catalog: Catalog::builtin(),
            logs: Logs::recorded(live.get().recordings.clone()),
            load: Load::new(Arc::clone(&metrics)),
            store: StoreWorker::start(store)?,
            waiting: None,
            // Without random numbers from the system there would be no keys, either.
            seed: getrandom::u64().unwrap_or_default(),
            metrics,
            live,
            cluster: None,
        })
    }

    /// Adds the maps of the host to the built-in levels.
    #[must_use]
    pub fn with_maps(self, maps: &HostMaps) -> Self {
        Self { catalog: Catalog::with(maps), ..self }
    }

    /// Adds the results that wait for the store. Those that come while it is away wait there, too.
    #[must_use]
    pub fn with_waiting(self, waiting: WaitingResults) -> Self {
        Self { waiting: Some(waiting), ..self }
    }

    /// Has the host share the rooms of a cluster.
    #[must_use]
    pub fn in_cluster(self, cluster: Cluster) -> Self {
        Self { cluster: Some(cluster), ..self }
    }
}
