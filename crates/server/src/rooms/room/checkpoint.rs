//! Checkpoints: the whole state of a room between two steps, as bytes.
//!
//! A checkpoint and the entries of the log since its step determine the room, bit for bit. The earlier log is
//! not needed. The level comes from the host's own catalog.
//!
//! The first line states the versions that can read the rest, as in a
//! [stored game](cellcaster::game::stored). Then come the header of the round, the room, and the game.
//! Reading checks that the state is possible, not that a room ever was in it. Hosts trust each other, but no
//! input may make a host fail.

use std::sync::Arc;

use super::catalog::no_level;
use super::member::Member;
use super::{
    CHAT_COLUMNS, Catalog, ChatLine, Header, KeptPlace, MemberId, NAME_COLUMNS, Room, SAID,
};
use crate::accounts::printable;
use crate::line::Line;
use cellcaster::game::PlayerColor;
use cellcaster::game::stored::{Reader, RestoreError, check, checksum, written};
use cellcaster::rng;

/// The name of the format, in the first line.
const KIND: &str = "room-checkpoint";
/// The widest chat line, in columns: a name and the text of an emote or remark.
const SAID_COLUMNS: usize = CHAT_COLUMNS + NAME_COLUMNS;

impl Room {
    /// The whole state as bytes.
    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let talk = (&*self.header, &*self.said, self.said_count);
        let mut bytes = written(KIND, &(talk, self));
        // This cannot fail: all levels of a catalog come from maps, and those can be stored.
        bytes.extend(self.game.stored().unwrap_or_default());
        bytes
    }

    /// Restores a room from a checkpoint.
    ///
    /// # Errors
    /// A sentence, if the bytes are damaged, have another version, or need a level that is not in the catalog.
    pub(crate) fn restore(catalog: &Arc<Catalog>, bytes: &[u8]) -> Result<Self, String> {
        let sentence = |error: RestoreError| error.to_string();
        let mut input = Reader::new(KIND, bytes, (0, 0)).map_err(sentence)?;
        let header: Header = input.read().map_err(sentence)?;
        check(header.is_possible(), "the header").map_err(sentence)?;
        let level = printable(&header.level, CHAT_COLUMNS);
        let room = Self::without_members(catalog, header);
        let mut room = room.ok_or_else(|| no_level(&level))?;
        room.read(&mut input).map_err(sentence)?;
        Ok(room)
    }

    /// A hash of the room's state. Rooms in different states almost certainly have different checksums. It
    /// excludes the chat, which continues across rounds and has no effect on the game.
    pub(crate) fn checksum(&self) -> u64 {
        rng::hash(self.step, [checksum(self), self.game.checksum()])
    }

    fn read(&mut self, input: &mut Reader) -> Result<(), RestoreError> {
        let (said, said_count): (Vec<ChatLine>, _) = input.read()?;
        (self.said, self.said_count) = (said.into(), said_count);
        (self.step, self.next_member, self.round) = input.read()?;
        (self.members, self.again, self.today, self.emotes) = input.read()?;
        self.standings = self.round.standings.as_slice().into();
        let start = self.game.as_ref().clone();
        self.game = Arc::new(start.restored(input.rest())?);
        self.check()
    }

    /// Rejects a state in which a step could fail, or that contains text that no member can type.
    fn check(&self) -> Result<(), RestoreError> {
        self.round.check(self.header.mode, self.step)?;
        check(self.next_member <= MemberId::MAX.0 + 1, "the number of the next member")?;
        check(self.members.len() <= self.header.mode.most(), "the number of members")?;
        check(self.are_members_possible(), "a member")?;
        let is_possible = |said: &ChatLine| {
            let is_name = |(name, _): &(Line, PlayerColor)| name.fits(NAME_COLUMNS);
            said.number <= self.said_count
                && said.by.as_ref().is_none_or(is_name)
                && printable(&said.text, SAID_COLUMNS) == said.text
        };
        let is_said = self.said.len() <= SAID && self.said.iter().all(is_possible);
        check(is_said, "a line of chat")
    }

    /// Returns true if each member has a number and a player of their own.
    fn are_members_possible(&self) -> bool {
        let color = |member: &Member| {
            let player = member.player?;
            self.game.seen_by(player)?.color()
        };
        self.members.iter().enumerate().all(|(index, member)| {
            let is_other = |other: &Member| {
                other.id != member.id && (other.player.is_none() || other.player != member.player)
            };
            self.members[..index].iter().all(is_other)
                && member.id < self.next_member()
                && member.kept.is_none_or(KeptPlace::is_possible)
                && (member.player.is_none() || color(member) == Some(member.color))
        })
    }
}

#[cfg(test)]
mod tests;
