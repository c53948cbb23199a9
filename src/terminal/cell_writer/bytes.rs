//! A buffer of bytes with spare memory at its end, and the control sequences that are written to it.
//!
//! The bytes of a cell are written directly to their final place, in parts of fixed sizes. A part may be
//! longer than its text, because a copy of four bytes is faster than a copy of a variable number. The
//! capacity is checked once for a whole cell. Rejected: a buffer for each cell. It would be copied right
//! after it was written, and processors stall on that.

use std::hint::select_unpredictable;
use std::io::{self, Write as _};

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
    /// The number of bytes in this piece, at most [`MAX_LENGTH`].
    end: usize,
    /// The length of all bytes before the piece.
    length: &'a mut usize,
}

/// The maximum length of a piece. A motion, a style with all its parameters and a character together
/// stay below it. All of its bits are set, because masking an offset takes less time than checking it.
const MAX_LENGTH: usize = 127;
/// The number of bytes by which the last part of a piece may exceed it.
const EXCESS: usize = 8;
const ROOM: usize = MAX_LENGTH + 1 + EXCESS;

impl Bytes {
    /// No bytes, and no memory.
    pub(crate) const NONE: Self = Self { memory: Vec::new(), length: 0 };

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
    /// Writes all of `text`. Only its first `count` bytes are part of the piece.
    #[inline]
    pub(crate) fn push<const LENGTH: usize>(&mut self, text: [u8; LENGTH], count: usize) {
        const { assert!(LENGTH <= EXCESS) };
        debug_assert!(self.end <= MAX_LENGTH, "a piece is too long");
        let start = self.end & MAX_LENGTH;
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

/// A control sequence in progress. It must have at least one parameter when it ends.
pub(crate) struct ControlSequence<'a, 'b> {
    piece: &'a mut Piece<'b>,
    start: usize,
}

impl<'a, 'b> ControlSequence<'a, 'b> {
    /// Begins a sequence at the end of `piece`.
    #[inline]
    pub(crate) fn begin(piece: &'a mut Piece<'b>) -> Self {
        let start = piece.end;
        piece.push([INTRODUCER[0]], 1);
        Self { piece, start }
    }

    /// Adds the parameter `number`.
    #[inline]
    pub(crate) fn parameter(&mut self, number: u8) {
        let decimal = DECIMALS[usize::from(number)];
        self.piece.push(decimal.text(), decimal.length());
    }

    /// Adds the first `count` bytes of `text`: parameters in decimal, each after a separator.
    #[inline]
    pub(crate) fn literal<const LENGTH: usize>(&mut self, text: [u8; LENGTH], count: usize) {
        self.piece.push(text, count);
    }

    /// Adds several parameters.
    #[inline]
    pub(crate) fn parameters(&mut self, numbers: impl IntoIterator<Item = u8>) {
        numbers.into_iter().for_each(|number| self.parameter(number));
    }

    /// Adds a position or a distance on the screen as a parameter.
    #[inline]
    pub(crate) fn place(&mut self, number: u16) {
        match u8::try_from(number) {
            Ok(small) => self.parameter(small),
            Err(_) => self.large_place(number),
        }
    }

    #[cold]
    fn large_place(&mut self, number: u16) {
        self.literal([SEPARATOR], 1);
        for unit in [10_000, 1_000, 100, 10, 1].into_iter().filter(|&unit| unit <= number) {
            self.literal([b'0' + (number / unit % 10) as u8], 1);
        }
    }

    /// Calls `write` to add parameters, and removes them unless `needed`. If the branch is hard to
    /// predict, this takes less time than testing first.
    #[inline]
    pub(crate) fn add_if(&mut self, needed: bool, write: impl FnOnce(&mut Self)) {
        let before = self.piece.end;
        write(self);
        self.piece.end = select_unpredictable(needed, self.piece.end, before);
    }

    /// Ends the sequence with the final byte `last`.
    #[inline]
    pub(crate) fn end(self, last: u8) {
        // Replace the separator before the first parameter.
        self.piece.room[(self.start + 1) & MAX_LENGTH] = INTRODUCER[1];
        self.piece.push([last], 1);
    }
}

const INTRODUCER: &[u8; 2] = b"\x1b[";
const SEPARATOR: u8 = b';';

/// The number of digits of `number`.
#[inline]
pub(crate) fn digits(number: u8) -> usize {
    DECIMALS[usize::from(number)].length() - 1
}

/// A separator and a number in decimal, in one word: four bytes of text, and the length of the text.
#[derive(Clone, Copy)]
struct Decimal(u64);

impl Decimal {
    const fn new(text: [u8; 4], length: u64) -> Self {
        Self(length << u32::BITS | u32::from_le_bytes(text) as u64)
    }

    #[inline]
    fn text(self) -> [u8; 4] {
        (self.0 as u32).to_le_bytes()
    }

    #[inline]
    fn length(self) -> usize {
        (self.0 >> u32::BITS) as usize
    }
}

/// The decimal text of every byte. A division would take longer than the rest of a cell's encoding.
static DECIMALS: [Decimal; 256] = {
    let mut table = [Decimal(0); 256];
    let mut number = 0;
    while number < table.len() {
        let [hundreds, tens, ones] = [
            b'0' + (number / 100) as u8,
            b'0' + (number / 10 % 10) as u8,
            b'0' + (number % 10) as u8,
        ];
        table[number] = match number {
            0..10 => Decimal::new([SEPARATOR, ones, 0, 0], 2),
            10..100 => Decimal::new([SEPARATOR, tens, ones, 0], 3),
            _ => Decimal::new([SEPARATOR, hundreds, tens, ones], 4),
        };
        number += 1;
    }
    table
};

/// Writes definitions of entries of the terminal's palette (OSC 4), several in each sequence.
pub(crate) struct PaletteWriter<'a> {
    bytes: &'a mut Bytes,
    count: usize,
}

/// The maximum number of definitions in one sequence. Some terminals accept at most sixteen parameters.
const AT_ONCE: usize = 7;

impl<'a> PaletteWriter<'a> {
    pub(crate) fn begin(bytes: &'a mut Bytes) -> Self {
        Self { bytes, count: 0 }
    }

    /// Adds `;n;#rrggbb`.
    pub(crate) fn push(&mut self, entry: u8, [red, green, blue]: [u8; 3]) {
        if self.count.is_multiple_of(AT_ONCE) {
            self.end_sequence();
            self.bytes.push_text(b"\x1b]4");
        }
        self.count += 1;
        // A write to memory cannot fail.
        _ = write!(self.bytes, ";{entry};#{red:02x}{green:02x}{blue:02x}");
    }

    pub(crate) fn end(mut self) {
        self.end_sequence();
    }

    fn end_sequence(&mut self) {
        if self.count > 0 {
            self.bytes.push_text(b"\x07");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_written_in_decimal() {
        for number in 0..=u16::MAX {
            let mut bytes = Bytes::default();
            let mut piece = bytes.piece();
            let mut sequence = ControlSequence::begin(&mut piece);
            sequence.place(7);
            sequence.place(number);
            sequence.end(b'H');
            piece.finish();
            assert_eq!(bytes.as_slice(), format!("\x1b[7;{number}H").as_bytes());
        }
    }
}
