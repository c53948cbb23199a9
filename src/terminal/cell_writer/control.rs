//! Writes control sequences with numeric parameters.

/// A control sequence in the making. It is written when it has got a parameter; without one, it is
/// as if it had never been begun.
pub(super) struct ControlSequence<'a> {
    /// What was written before, the sequence so far, and room for the rest of it.
    bytes: &'a mut Vec<u8>,
    start: usize,
    end: usize,
}

impl<'a> ControlSequence<'a> {
    /// Begins a sequence at the end of `bytes`.
    #[inline]
    pub(super) fn begin(bytes: &'a mut Vec<u8>) -> Self {
        let start = bytes.len();
        // Room is made once. In a buffer of its own, the sequence would be copied a moment after it
        // was written, for which processors wait.
        bytes.extend_from_slice(&[INTRODUCER[0]; LONGEST]);
        Self { bytes, start, end: start + 1 }
    }

    /// Adds the parameter `number`.
    #[inline]
    pub(super) fn parameter(&mut self, number: u8) {
        let Decimal { text, length } = DECIMALS[usize::from(number)];
        // All of it, as four bytes are copied faster than as many as there are.
        self.bytes[self.end..self.end + text.len()].copy_from_slice(&text);
        self.end += usize::from(length);
    }

    /// Adds several parameters.
    #[inline]
    pub(super) fn parameters(&mut self, numbers: impl IntoIterator<Item = u8>) {
        numbers.into_iter().for_each(|number| self.parameter(number));
    }

    /// Adds a parameter that is a place on the screen, or a distance on it.
    #[inline]
    pub(super) fn place(&mut self, number: u16) {
        match u8::try_from(number) {
            Ok(small) => self.parameter(small),
            Err(_) => self.large_place(number),
        }
    }

    fn large_place(&mut self, number: u16) {
        let text = format!(";{number}");
        self.bytes[self.end..self.end + text.len()].copy_from_slice(text.as_bytes());
        self.end += text.len();
    }

    /// Ends it with `last` as its final byte.
    #[inline]
    pub(super) fn end(self, last: u8) {
        if self.end > self.start + 1 {
            // Each parameter came with a separator before it.
            self.bytes[self.start + 1] = INTRODUCER[1];
            self.bytes[self.end] = last;
            self.bytes.truncate(self.end + 1);
        } else {
            self.bytes.truncate(self.start);
        }
    }
}

/// No sequence is longer: all that a style says, and more than any motion.
const LONGEST: usize = 64;
const INTRODUCER: &[u8; 2] = b"\x1b[";
const SEPARATOR: u8 = b';';

/// How many digits a number has.
#[inline]
pub(super) fn digits(number: u8) -> usize {
    usize::from(DECIMALS[usize::from(number)].length) - 1
}

/// A number in decimal, after a separator.
#[derive(Clone, Copy)]
struct Decimal {
    text: [u8; 4],
    /// How much of the text there is.
    length: u8,
}

/// Every number of a byte: to divide would cost more than all else that a cell does.
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
    use super::*;

    #[test]
    fn every_number_is_written_in_decimal() {
        for number in 0..=u16::MAX {
            let mut bytes = Vec::new();
            let mut sequence = ControlSequence::begin(&mut bytes);
            sequence.place(7);
            sequence.place(number);
            sequence.end(b'H');
            assert_eq!(bytes, format!("\x1b[7;{number}H").into_bytes());
        }
    }
}
