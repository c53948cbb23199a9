//! Writes control sequences with numeric parameters.

use std::hint::select_unpredictable;

use super::bytes::Piece;

/// A control sequence in progress, with at least one parameter at its end.
pub(crate) struct ControlSequence<'a, 'b> {
    piece: &'a mut Piece<'b>,
    start: usize,
}

impl<'a, 'b> ControlSequence<'a, 'b> {
    /// Begins a sequence at the end of `piece`.
    #[inline]
    pub(crate) fn begin(piece: &'a mut Piece<'b>) -> Self {
        let start = piece.end();
        piece.push([INTRODUCER[0]], 1);
        Self { piece, start }
    }

    /// Adds the parameter `number`.
    #[inline]
    pub(crate) fn parameter(&mut self, number: u8) {
        let decimal = DECIMALS[usize::from(number)];
        self.piece.push(decimal.text(), decimal.length());
    }

    /// Adds parameters in decimal, each after a separator: the first `count` bytes of `text`.
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

    /// Calls `write` to add parameters, and removes them unless `needed`. Where the branch is badly
    /// predictable, this takes less time than a test first.
    #[inline]
    pub(crate) fn add_if(&mut self, needed: bool, write: impl FnOnce(&mut Self)) {
        let before = self.piece.end();
        write(self);
        let end = self.piece.end();
        self.piece.end_at(select_unpredictable(needed, end, before));
    }

    /// Ends the sequence with the final byte `last`.
    #[inline]
    pub(crate) fn end(self, last: u8) {
        // Replace the separator before the first parameter.
        self.piece.put(self.start + 1, INTRODUCER[1]);
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

/// A number in decimal, after a separator, in one word: four bytes of text, and the length of the text.
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

/// The decimal text of every byte: a division would take longer than the rest of a cell's encoding.
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

#[cfg(test)]
mod tests {
    use super::super::bytes::Bytes;
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
