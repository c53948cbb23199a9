//! The configuration in force, which can change while the server runs.

use std::sync::Arc;

use tokio::sync::watch;

use super::Config;

/// The configuration in force. Clones share it.
#[derive(Clone, Debug)]
pub struct LiveConfig(Arc<watch::Sender<Arc<Config>>>);

impl LiveConfig {
    /// The configuration of a server that starts.
    pub fn new(config: Config) -> Self {
        Self(Arc::new(watch::Sender::new(Arc::new(config))))
    }

    /// The configuration now.
    pub fn get(&self) -> Arc<Config> {
        self.0.borrow().clone()
    }

    /// Tells changes.
    pub fn subscribe(&self) -> watch::Receiver<Arc<Config>> {
        self.0.subscribe()
    }

    /// Replaces the configuration, except for addresses that the server listens at and the folder of
    /// maps. Returns the names of settings that `wanted` would change and that stay until the next
    /// start.
    pub fn replace(&self, mut wanted: Config) -> Vec<&'static str> {
        let now = self.get();
        let mut fixed = Vec::new();
        if wanted.listen != now.listen {
            wanted.listen = now.listen;
            fixed.push("listen");
        }
        if wanted.metrics != now.metrics {
            wanted.metrics = now.metrics;
            fixed.push("metrics.listen");
        }
        if wanted.maps != now.maps {
            wanted.maps.clone_from(&now.maps);
            fixed.push("maps");
        }
        // Of the command line alone.
        wanted.recordings.clone_from(&now.recordings);
        self.0.send_replace(Arc::new(wanted));
        fixed
    }
}
