//! The state that all rooms of a host share.

use std::sync::{Arc, Mutex};

use tokio::sync::watch;

use super::bus::{Bus, Key};
use super::leases::Leases;
use super::message::Record;
use super::room_state::RoomState;
use super::visits::Visits;
use crate::accounts::HostNotice;
use crate::load::Load;
use crate::lock::locked;
use crate::rooms::directory::Rooms;
use crate::rooms::summary::{RoomId, RoomRefusal};
use crate::visitors::Visitors;
use cellcaster::rng::SplitMix64;

/// The state that all rooms of a host share.
pub(crate) struct HostContext {
    pub(crate) bus: Box<dyn Bus>,
    pub(crate) leases: Leases,
    pub(crate) visits: Visits,
    pub(crate) notice: HostNotice,
    /// The directory of rooms that lobbies show.
    pub(crate) rooms: Rooms,
    pub(crate) load: Arc<Load>,
    pub(crate) visitors: Visitors,
    pub(crate) chance: Mutex<SplitMix64>,
    /// `true` once the host ends.
    pub(crate) ending: watch::Sender<bool>,
}

impl HostContext {
    /// A random number.
    pub(crate) fn chance(&self) -> u64 {
        locked(&self.chance, SplitMix64::bits)
    }

    /// Loads a room's record, and its state from the newest checkpoint. If this host records rooms, it records this one
    /// from now on, beginning with a whole round.
    pub(crate) async fn load_state(&self, id: RoomId) -> Result<(RoomState, Record), RoomRefusal> {
        let record = self.bus.get(Key::Room(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let record =
            record.and_then(|bytes| Record::parse(&bytes).ok()).ok_or(RoomRefusal::Gone)?;
        let bytes = self.bus.get(Key::Checkpoint(id)).await.map_err(|_| RoomRefusal::NotNow)?;
        let catalog = self.rooms.catalog();
        let state = match bytes {
            None => RoomState::new(catalog, record.header.clone()),
            Some(bytes) => match RoomState::restore(catalog, &bytes) {
                Ok(state) => Some(state),
                Err(sentence) => {
                    tracing::error!(room = %id, "a room's checkpoint can't be restored: {sentence}");
                    None
                }
            },
        };
        let mut state = state.ok_or(RoomRefusal::NoLevel)?;
        state.record(self.rooms.recordings().open(id, record.code.is_some()));
        Ok((state, record))
    }
}

/// The name of a host as operators see it, without the number of its start.
pub(crate) fn shown_name(name: &str) -> &str {
    name.split_once(' ').map_or(name, |(shown, _)| shown)
}
