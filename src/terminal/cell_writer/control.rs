//! Writes control sequences with numeric parameters.

use super::super::sequence;

/// A control sequence in the making. It is written when it has got a parameter; without one, it is
/// as if it had never been begun.
pub(super) struct ControlSequence<'a> {
    bytes: &'a mut Vec<u8>,
    begun: bool,
}

impl<'a> ControlSequence<'a> {
    /// Begins a sequence at the end of `bytes`.
    pub(super) fn begin(bytes: &'a mut Vec<u8>) -> Self {
        Self { bytes, begun: false }
    }

    /// Adds the parameter `number`.
    pub(super) fn parameter(&mut self, number: u16) {
        let separator = if self.begun { sequence::SEPARATOR } else { sequence::INTRODUCER };
        self.bytes.extend_from_slice(separator.as_bytes());
        self.begun = true;
        push_decimal(self.bytes, number);
    }

    /// Adds several parameters.
    pub(super) fn parameters(&mut self, numbers: impl IntoIterator<Item = u16>) {
        numbers.into_iter().for_each(|number| self.parameter(number));
    }

    /// Ends the sequence with `last`, its final byte.
    pub(super) fn end(self, last: u8) {
        if self.begun {
            self.bytes.push(last);
        }
    }
}

/// By hand, as the formatting machinery would cost more than all else that a cell does.
fn push_decimal(bytes: &mut Vec<u8>, number: u16) {
    let digit = |unit: u16| b'0' + (number / unit % 10) as u8;
    match number {
        0..10 => bytes.push(digit(1)),
        10..100 => bytes.extend_from_slice(&[digit(10), digit(1)]),
        100..1000 => bytes.extend_from_slice(&[digit(100), digit(10), digit(1)]),
        _ => {
            push_decimal(bytes, number / 10);
            bytes.push(digit(1));
        }
    }
}
