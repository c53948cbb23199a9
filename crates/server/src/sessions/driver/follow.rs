//! What the host allows of rooms, as the configuration is read again.

use std::sync::Arc;

use tokio::sync::watch;

use super::Shared;
use crate::ops::config::Config;
use crate::rooms::directory::RoomLimits;

impl Shared {
    /// Tells the rooms what the host allows.
    pub(crate) fn limited(&self) -> impl Fn(RoomLimits) + Send + use<> {
        let rooms = self.rooms.clone();
        let shared_rooms = self.cluster.clone();
        move |limits| {
            if let Some(shared) = &shared_rooms {
                return shared.set_limits(limits);
            }
            rooms.set_limits(limits);
        }
    }
}

/// Tells the rooms what the host allows, whenever the configuration is read again.
pub(crate) async fn follow(
    mut config: watch::Receiver<Arc<Config>>,
    set_limits: impl Fn(RoomLimits) + Send + 'static,
) {
    while config.changed().await.is_ok() {
        let limits = RoomLimits::of(&config.borrow_and_update());
        set_limits(limits);
    }
}
