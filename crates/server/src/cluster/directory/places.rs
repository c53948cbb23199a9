//! Where players with keys are, so that any host finds them again.
//!
//! The bus has the room and the member of each. It is put when somebody joins, and removed when they leave; what
//! else ends a member, ends it in the room alone. So an entry may be out of date, and the room decides.

use super::SharedRooms;
use crate::accounts::AccountKey;
use crate::cluster::bus::{BusFault, Key};
use crate::cluster::replica::Wish;
use crate::rooms::directory::{Place, RoomRefusal};
use crate::rooms::room::MemberId;
use crate::rooms::summary::RoomId;
use crate::sessions::line::Line;

/// Who joins a room.
#[derive(Clone, Debug)]
pub(crate) struct Entrant {
    pub(crate) name: Line,
    /// The key of their account, with which they may return; `None` for a guest.
    pub(crate) key: Option<AccountKey>,
}

impl SharedRooms {
    pub(crate) async fn join(&self, id: RoomId, entrant: &Entrant) -> Result<Place, RoomRefusal> {
        let Entrant { name, key } = entrant;
        let wish = Wish::Join { name: name.clone(), is_kept: key.is_some() };
        let place = self.be_member(id, wish).await?;
        if let Some((key, member)) = key.zip(place.member_id()) {
            self.note_place(key, id, member).await;
        }
        Ok(place)
    }

    /// The room and the member in which a player's last host may have left them.
    pub(crate) async fn place_of(&self, key: AccountKey) -> Option<(RoomId, MemberId)> {
        let bytes = self.0.context.bus.get(Key::Place(key)).await.ok()??;
        let (id, member) = str::from_utf8(&bytes).ok()?.split_once(' ')?;
        Some((RoomId(id.parse().ok()?), MemberId::parse(member)?))
    }

    /// Takes a player back to the room and the member.
    pub(crate) async fn resume(
        &self,
        key: AccountKey,
        (id, member): (RoomId, MemberId),
    ) -> Result<Place, RoomRefusal> {
        let place = self.be_member(id, Wish::Return(member)).await;
        if matches!(place, Err(RoomRefusal::Gone | RoomRefusal::NoLevel)) {
            self.forget_place(key).await;
        }
        place
    }

    /// Forgets where a player was, who has left.
    pub(crate) async fn forget_place(&self, key: AccountKey) {
        // Else the room says later that they have left.
        _ = self.0.context.bus.remove(Key::Place(key)).await;
    }

    async fn note_place(&self, key: AccountKey, id: RoomId, member: MemberId) {
        let bus = &self.0.context.bus;
        let text = format!("{id} {member}");
        // The first one is refused if another host has put one last. Without one, they cannot return.
        for _ in 0..2 {
            if bus.put(Key::Place(key), text.clone().into_bytes()).await != Err(BusFault::Refused) {
                return;
            }
        }
    }
}
