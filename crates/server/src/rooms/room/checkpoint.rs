//! Checkpoints: the whole state of a room between two steps as bytes, and back.
//!
//! A host that has a checkpoint and the entries of the log from its step on has the room, bit for bit,
//! and needs nothing of the log before. The level comes from the host's own catalog.
//!
//! The first line says who can read the rest, as in a [stored game](cellcaster::game::stored). The header of
//! the round follows as its text, then the room, and the game. What was true of a room may be restored;
//! whether it ever was is not checked: hosts believe each other, but no byte makes one of them fail.

use std::sync::Arc;

use super::entry::{CHAT_COLUMNS, MemberId, NAME_COLUMNS};
use super::member::Member;
use super::presence::KeptPlace;
use super::replayed::no_level;
use super::talk::SAID;
use super::{Catalog, Header, Room, Said};
use cellcaster::game::stored::{Reader, Stored, StoredPart, Unrestorable, Writer, after_first_line, check, first_line};
use cellcaster::rng;
use crate::sessions::line::Line;
use crate::accounts::printable;

/// What the first line calls a room.
const KIND: &str = "room-checkpoint";
/// The widest line of what is said, in columns: a name and what its owner does.
const SAID_COLUMNS: usize = CHAT_COLUMNS + NAME_COLUMNS;

impl Room {
    /// The whole state.
    pub(crate) fn checkpoint(&self) -> Vec<u8> {
        let mut out = Writer::default();
        out.raw(first_line(KIND).as_bytes());
        self.header.to_string().write(&mut out);
        self.write_talk(&mut out);
        self.write_play(&mut out);
        out.into_bytes()
    }

    /// The room of which `bytes` are a checkpoint.
    ///
    /// # Errors
    /// A sentence: the bytes are of no room, of one of another version, or of one in a level that the
    /// catalog does not have; or they are damaged.
    pub(crate) fn restore(catalog: &Arc<Catalog>, bytes: &[u8]) -> Result<Self, String> {
        let sentence = |error: Unrestorable| error.to_string();
        let bytes = after_first_line(KIND, bytes).map_err(sentence)?;
        let mut input = Reader::new(bytes, (0, 0));
        let header = read_header(&mut input).map_err(sentence)?;
        let room = Self::without_members(catalog, header.clone());
        let mut room = room.ok_or_else(|| no_level(&printable(&header.level, CHAT_COLUMNS)))?;
        room.read(&mut input).map_err(sentence)?;
        Ok(room)
    }

    /// A number that differs, almost certainly, between rooms in different states. What was said is no
    /// part of it: it goes on from round to round, and changes nothing.
    pub(crate) fn checksum(&self) -> u64 {
        let mut out = Writer::default();
        self.write_play(&mut out);
        let words = out.into_bytes();
        let words = words.chunks(8).map(|chunk| {
            let mut word = [0; 8];
            word[..chunk.len()].copy_from_slice(chunk);
            u64::from_le_bytes(word)
        });
        rng::hash(self.step, words)
    }

    fn write_talk(&self, out: &mut Writer) {
        self.said.write(out);
        self.said_count.write(out);
    }

    /// Appends all but the header and what was said.
    fn write_play(&self, out: &mut Writer) {
        let Self {
            catalog: _,
            header: _,
            game,
            round,
            members,
            next_member,
            step,
            again,
            emotes,
            said: _,
            said_count: _,
            // Filled in each step.
            inputs: _,
            // Those of the round.
            standings: _,
        } = self;
        step.write(out);
        next_member.write(out);
        round.write(out);
        members.write(out);
        again.write(out);
        emotes.write(out);
        // A catalog has levels of maps, which all can be stored.
        out.raw(&game.stored().unwrap_or_default());
    }

    fn read(&mut self, input: &mut Reader) -> Result<(), Unrestorable> {
        self.said = Stored::read(input)?;
        self.said_count = Stored::read(input)?;
        self.step = Stored::read(input)?;
        self.next_member = input.number_to(u64::from(MemberId::MOST.0) + 1)? as u32;
        self.round.read_over(input)?;
        self.members = input.list(self.header.mode.most())?;
        self.again = Stored::read(input)?;
        self.emotes = Stored::read(input)?;
        self.standings = self.round.standings().into();
        let start = self.game.as_ref().clone();
        self.game = Arc::new(start.restored(input.rest())?);
        self.check()
    }

    /// Refuses a state in which a step could fail, or that shows what nobody can type.
    fn check(&self) -> Result<(), Unrestorable> {
        self.round.check(self.step)?;
        check(self.are_members_possible(), "a member")?;
        let is_possible = |said: &Said| {
            said.number <= self.said_count && printable(&said.text, SAID_COLUMNS) == said.text
        };
        let is_said = self.said.len() <= SAID && self.said.iter().all(is_possible);
        check(is_said, "what was said")
    }

    /// Whether each member has a number and a player of their own.
    fn are_members_possible(&self) -> bool {
        let color = |member: &Member| {
            let player = member.player?;
            self.game.seen_by(player)?.color()
        };
        self.members.iter().enumerate().all(|(index, member)| {
            let is_other = |other: &Member| {
                other.id != member.id && (other.player.is_none() || other.player != member.player)
            };
            let name = Line::of(member.name.as_str(), NAME_COLUMNS);
            self.members[..index].iter().all(is_other)
                && name.as_ref() == Some(&member.name)
                && member.id < self.next_member()
                && member.kept.is_none_or(KeptPlace::is_possible)
                && (member.player.is_none() || color(member) == Some(member.color))
        })
    }
}

fn read_header(input: &mut Reader) -> Result<Header, Unrestorable> {
    let text = String::read(input)?;
    let header = Header::parse(text.lines()).filter(|header| header.to_string() == text);
    header.ok_or(Unrestorable::Damaged("the header"))
}

impl Stored for Line {
    fn write(&self, out: &mut Writer) {
        self.as_str().to_owned().write(out);
    }

    fn read(input: &mut Reader) -> Result<Self, Unrestorable> {
        let text = String::read(input)?;
        let line = Self::of(&text, CHAT_COLUMNS).filter(|line| line.as_str() == text);
        line.ok_or(Unrestorable::Damaged("a line"))
    }
}

#[cfg(test)]
mod tests;
