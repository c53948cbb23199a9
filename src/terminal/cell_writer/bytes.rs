//! A buffer of bytes with spare memory at its end.
//!
//! The bytes of a cell are written in their final place, in parts of fixed sizes that may exceed
//! their lengths: a copy of four bytes is faster than a copy of a variable number, and the capacity
//! is checked once for a whole cell. With a buffer of its own, a cell would be copied right after
//! it was written, and processors stall on that.

use std::io;

/// A growing sequence of bytes.
#[derive(Debug, Default)]
pub(crate) struct Bytes {
    /// The written bytes, then spare memory.
    memory: Vec<u8>,
    length: usize,
}

/// A piece in progress at the end of [`Bytes`]. It counts as written only after [`Piece::finish`].
pub(crate) struct Piece<'a> {
    room: &'a mut [u8; ROOM],
    /// The number of bytes in this piece, at most [`LONGEST`].
    end: usize,
    /// The length of all bytes before it.
    length: &'a mut usize,
}

/// The maximum length of a piece, which a motion, a style with all its parameters and a character do not
/// reach. All of its bits are set: masking an offset takes less time than checking it.
const LONGEST: usize = 127;
/// The bytes behind a piece that its last part may exceed it by.
const EXCESS: usize = 8;
const ROOM: usize = LONGEST + 1 + EXCESS;

impl Bytes {
    /// The written bytes.
    pub(crate) fn as_slice(&self) -> &[u8] {
        &self.memory[..self.length]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.length == 0
    }

    /// Removes all bytes and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.length = 0;
    }

    /// Begins a piece.
    #[inline]
    pub(crate) fn piece(&mut self) -> Piece<'_> {
        self.make_room(ROOM);
        let room = &mut self.memory[self.length..][..ROOM];
        let room = room.try_into().expect("there is as much behind what is written");
        Piece { room, end: 0, length: &mut self.length }
    }

    /// Adds `text`.
    pub(crate) fn push_text(&mut self, text: &[u8]) {
        self.make_room(text.len());
        self.memory[self.length..][..text.len()].copy_from_slice(text);
        self.length += text.len();
    }

    /// Makes room for `count` bytes if there is less.
    #[inline]
    fn make_room(&mut self, count: usize) {
        if self.memory.len() - self.length < count {
            self.grow(self.length + count);
        }
    }

    #[cold]
    fn grow(&mut self, needed: usize) {
        self.memory.resize(needed.next_power_of_two(), 0);
    }
}

impl Piece<'_> {
    /// The number of bytes in this piece.
    #[inline]
    pub(crate) fn end(&self) -> usize {
        self.end
    }

    /// Sets the number of bytes in this piece.
    #[inline]
    pub(crate) fn end_at(&mut self, end: usize) {
        self.end = end;
    }

    /// Writes a byte at a place in this piece.
    #[inline]
    pub(crate) fn put(&mut self, place: usize, byte: u8) {
        self.room[place & LONGEST] = byte;
    }

    /// Writes all of `text`, of which the first `count` bytes are part of the piece.
    #[inline]
    pub(crate) fn push<const LENGTH: usize>(&mut self, text: [u8; LENGTH], count: usize) {
        const { assert!(LENGTH <= EXCESS) };
        debug_assert!(self.end <= LONGEST, "a piece is too long");
        let start = self.end & LONGEST;
        self.room[start..start + LENGTH].copy_from_slice(&text);
        self.end = start + count;
    }

    /// Adds the piece to the written bytes.
    #[inline]
    pub(crate) fn finish(self) {
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
