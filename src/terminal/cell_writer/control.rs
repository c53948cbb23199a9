//! Writes control sequences with numeric parameters.

use std::hint::select_unpredictable;

use super::bytes::Piece;

/// A control sequence in progress. It becomes part of the piece at the end, if it has a parameter
/// by then; otherwise nothing is written.
pub(super) struct ControlSequence<'a, 'b> {
    piece: &'a mut Piece<'b>,
    start: usize,
}

impl<'a, 'b> ControlSequence<'a, 'b> {
    /// Begins a sequence at the end of `piece`.
    #[inline]
    pub(super) fn begin(piece: &'a mut Piece<'b>) -> Self {
        let start = piece.end();
        piece.push([INTRODUCER[0]], 1);
        Self { piece, start }
    }

    /// Adds the parameter `number`.
    #[inline]
    pub(super) fn parameter(&mut self, number: u8) {
        let Decimal { text, length } = DECIMALS[usize::from(number)];
        self.piece.push(text, length.into());
    }

    /// Adds parameters in decimal, each after a separator.
    #[inline]
    pub(super) fn literal<const LENGTH: usize>(&mut self, text: [u8; LENGTH]) {
        self.piece.push(text, LENGTH);
    }

    /// Adds several parameters.
    #[inline]
    pub(super) fn parameters(&mut self, numbers: impl IntoIterator<Item = u8>) {
        numbers.into_iter().for_each(|number| self.parameter(number));
    }

    /// Adds a position or a distance on the screen as a parameter.
    #[inline]
    pub(super) fn place(&mut self, number: u16) {
        match u8::try_from(number) {
            Ok(small) => self.parameter(small),
            Err(_) => self.large_place(number),
        }
    }

    #[cold]
    fn large_place(&mut self, number: u16) {
        self.literal([SEPARATOR]);
        for unit in [10_000, 1_000, 100, 10, 1].into_iter().filter(|&unit| unit <= number) {
            self.literal([b'0' + (number / unit % 10) as u8]);
        }
    }

    /// Calls `write` to add parameters, and removes them unless `needed`. Where the branch is badly
    /// predictable, this takes less time than a test first.
    #[inline]
    pub(super) fn add_if(&mut self, needed: bool, write: impl FnOnce(&mut Self)) {
        let before = self.piece.end();
        write(self);
        let end = self.piece.end();
        self.piece.end_at(select_unpredictable(needed, end, before));
    }

    /// Ends the sequence with the final byte `last`.
    #[inline]
    pub(super) fn end(self, last: u8) {
        let is_empty = self.piece.end() == self.start + 1;
        // Replace the separator before the first parameter.
        self.piece.put(self.start + 1, INTRODUCER[1]);
        self.piece.push([last], 1);
        let end = self.piece.end();
        self.piece.end_at(select_unpredictable(is_empty, self.start, end));
    }
}

const INTRODUCER: &[u8; 2] = b"\x1b[";
const SEPARATOR: u8 = b';';

/// The number of digits of `number`.
#[inline]
pub(super) fn digits(number: u8) -> usize {
    usize::from(DECIMALS[usize::from(number)].length) - 1
}

/// A number in decimal, after a separator.
#[derive(Clone, Copy)]
struct Decimal {
    text: [u8; 4],
    /// The length of the text.
    length: u8,
}

/// The decimal text of every byte: a division would take longer than the rest of a cell's encoding.
static DECIMALS: [Decimal; 256] = {
    let mut table = [Decimal { text: [SEPARATOR; 4], length: 0 }; 256];
    let mut number = 0;
    while number < table.len() {
        let [hundreds, tens, ones] = [
            b'0' + (number / 100) as u8,
            b'0' + (number / 10 % 10) as u8,
            b'0' + (number % 10) as u8,
        ];
        table[number] = match number {
            0..10 => Decimal { text: [SEPARATOR, ones, 0, 0], length: 2 },
            10..100 => Decimal { text: [SEPARATOR, tens, ones, 0], length: 3 },
            _ => Decimal { text: [SEPARATOR, hundreds, tens, ones], length: 4 },
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
