//! This host among the others: its visits, and that it is there.

use tokio::time::interval;

use super::SharedRooms;
use crate::cluster::HostContext;
use crate::cluster::visits::{ANNOUNCED, Visits};

impl SharedRooms {
    pub(crate) fn context(&self) -> &HostContext {
        &self.0.context
    }

    /// The visits of this host, which are counted with those of all others.
    pub(crate) fn visits(&self) -> &Visits {
        &self.0.context.visits
    }

    /// Announces this host, again and again.
    pub(crate) async fn announce(self) {
        let mut periods = interval(ANNOUNCED);
        while !*self.0.context.ending.borrow() {
            periods.tick().await;
            self.visits().announce(self.0.context.visitors.count());
        }
    }
}
