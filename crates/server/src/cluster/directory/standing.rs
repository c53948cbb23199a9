//! Standing rooms of a cluster: each is made by the first host that has it in its configuration.
//!
//! A host lists those of its own configuration, and others while somebody is in them. Their records stay: another
//! host may have them in its configuration.

use std::collections::BTreeSet;

use super::SharedRooms;
use crate::cluster::bus::{BusFault, Key};
use crate::cluster::log_message::version;
use crate::cluster::record::Record;
use crate::lock::locked;
use crate::rooms::room::Header;
use crate::rooms::summary::RoomId;
use cellcaster::rng;

impl SharedRooms {
    /// Makes those that are missing, and lists those of the configuration.
    pub(crate) async fn make_standing(&self) {
        let standing = locked(&self.0.standing, |standing| standing.clone());
        let (mut own, mut is_known) = (BTreeSet::new(), true);
        for (index, wish) in standing.iter().enumerate() {
            let number = standing[..index].iter().filter(|other| *other == wish).count();
            match self.header(wish) {
                Some(header) => match self.make_standing_room(number, header).await {
                    Ok(id) => own.extend(id),
                    Err(_) => is_known = false,
                },
                None => {
                    tracing::error!(level = wish.level, "no standing room: there is no such level");
                }
            }
        }
        locked(&self.0.own_standing, |known| {
            if is_known {
                known.clear();
            }
            known.append(&mut own);
        });
        self.show();
    }

    /// Shows lobbies the rooms.
    pub(crate) fn show(&self) {
        // Under the lock, so that an older list never replaces a newer one.
        locked(&self.0.records, |records| {
            let own = locked(&self.0.own_standing, |own| own.clone());
            let summaries = records.iter().filter_map(|(id, known)| {
                let summary = known.record.summary(*id);
                let is_listed =
                    !known.record.stands || own.contains(id) || !summary.members.is_empty();
                is_listed.then_some(summary)
            });
            self.0.rooms.show_shared(summaries.collect());
        });
    }

    /// Makes a room, if it is missing; returns its number.
    async fn make_standing_room(
        &self,
        number: usize,
        header: Header,
    ) -> Result<Option<RoomId>, BusFault> {
        let bus = &self.0.context.bus;
        // Rooms of another version are none for this host.
        let Header { level, mode, difficulty, .. } = &header;
        let text = format!("{} {level} {} {}", version(), mode.name(), difficulty.name());
        let hash = rng::hash(number as u64, text.bytes().map(u64::from));
        let key = Key::Standing(format!("{hash:016x}"));
        if bus.get(key.clone()).await?.is_none() {
            let own = bus.next_number().await?;
            match bus.create(key.clone(), own.to_string().into_bytes()).await {
                // Another host was faster.
                Ok(()) | Err(BusFault::Refused) => {}
                Err(fault) => return Err(fault),
            }
        }
        let kept = bus.get(key).await?.unwrap_or_default();
        let kept = str::from_utf8(&kept).ok().and_then(|text| text.parse().ok());
        let Some(id) = kept.map(RoomId) else { return Ok(None) };
        if locked(&self.0.records, |records| records.contains_key(&id)) {
            return Ok(Some(id));
        }
        match bus.create(Key::Room(id), Record::new(header, true).to_bytes()).await {
            Ok(()) | Err(BusFault::Refused) => Ok(Some(id)),
            Err(fault) => Err(fault),
        }
    }
}
