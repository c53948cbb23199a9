//! What is written, with room behind it.
//!
//! What a cell takes is written where it stays, in parts of fixed sizes that reach beyond their ends: to
//! copy four bytes takes less than to copy as many as there are, and room is made once for a whole cell.
//! In a buffer of its own it would be copied a moment after it was written, for which processors wait.

use std::io;

/// Bytes, one after the other.
#[derive(Debug, Default)]
pub(crate) struct Bytes {
    /// What is written, and room.
    memory: Vec<u8>,
    length: usize,
}

/// A piece that is being written at the end of [`Bytes`]; what is not finished was never written.
pub(super) struct Piece<'a> {
    room: &'a mut [u8; ROOM],
    /// How much of it is written.
    end: usize,
    /// The length of all that was written before.
    length: &'a mut usize,
}

/// No piece is longer: a motion, a style with everything that there is, and a character.
const ROOM: usize = 96;

impl Bytes {
    /// What is written.
    pub(crate) fn as_slice(&self) -> &[u8] {
        &self.memory[..self.length]
    }

    pub(super) fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Forgets what is written, and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
    }

    /// Begins a piece.
    #[inline]
    pub(super) fn piece(&mut self) -> Piece<'_> {
        self.make_room(ROOM);
        let room = self.memory[self.length..].first_chunk_mut();
        let room = room.expect("there is as much behind what is written");
        Piece { room, end: 0, length: &mut self.length }
    }

    /// Adds `text`.
    pub(crate) fn push_text(&mut self, text: &[u8]) {
        self.make_room(text.len());
        self.memory[self.length..][..text.len()].copy_from_slice(text);
        self.length += text.len();
    }

    /// Makes room for so many, if there is not as much.
    #[inline]
    fn make_room(&mut self, count: usize) {
        let needed = self.length + count;
        if self.memory.len() < needed {
            self.grow(needed);
        }
    }

    #[cold]
    fn grow(&mut self, needed: usize) {
        self.memory.resize(needed.next_power_of_two(), 0);
    }
}

impl Piece<'_> {
    /// How much of it is written.
    #[inline]
    pub(super) fn end(&self) -> usize {
        self.end
    }

    /// Only so much of it counts as written.
    #[inline]
    pub(super) fn end_at(&mut self, end: usize) {
        self.end = end;
    }

    /// Writes a byte at a place.
    #[inline]
    pub(super) fn put(&mut self, place: usize, byte: u8) {
        self.room[place] = byte;
    }

    /// Writes all of `text`, of which so many bytes count.
    #[inline]
    pub(super) fn push<const LENGTH: usize>(&mut self, text: [u8; LENGTH], count: usize) {
        self.room[self.end..self.end + LENGTH].copy_from_slice(&text);
        self.end += count;
    }

    /// It has been written.
    #[inline]
    pub(super) fn finish(self) {
        *self.length += self.end;
    }
}

impl io::Write for Bytes {
    fn write(&mut self, text: &[u8]) -> io::Result<usize> {
        self.push_text(text);
        Ok(text.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
