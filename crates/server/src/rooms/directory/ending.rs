//! The end of all rooms.

use std::sync::Arc;
use std::time::Duration;

use tokio::time::timeout;

use super::Rooms;
use crate::lock::locked;
use crate::rooms::sequencer::RoomInterface;

/// The time in which rooms end.
const ENDING: Duration = Duration::from_secs(1);

impl Rooms {
    /// Closes all rooms, and waits until their recordings are written, for [`ENDING`] at most.
    pub(crate) async fn end(&self) {
        let doorways: Vec<Arc<RoomInterface>> = locked(&self.0.open, |open| {
            open.rooms.values().map(|room| Arc::clone(&room.interface)).collect()
        });
        for interface in &doorways {
            interface.close("The server has ended.");
        }
        let mut summaries = self.summaries();
        let all_closed = async { _ = summaries.wait_for(|rooms| rooms.is_empty()).await };
        _ = timeout(ENDING, all_closed).await;
    }
}
