//! Written bytes that the terminal has not accepted yet.

use std::io;

use super::Device;

/// Bytes for a terminal that does not accept more at present. They are few, since no frame is drawn
/// while there are any.
#[derive(Debug, Default)]
pub(crate) struct OutputQueue {
    bytes: Vec<u8>,
    /// The number of accepted bytes.
    taken: usize,
}

impl OutputQueue {
    /// Writes `bytes` after those that wait, as far as `device` accepts them at once. They are kept if the
    /// device does not accept all of them.
    pub(crate) fn send(&mut self, bytes: &[u8], device: &Device) -> io::Result<()> {
        if self.is_empty() {
            let accepted = device.write_some(bytes);
            if !accepted.as_ref().is_ok_and(|&count| count == bytes.len()) {
                self.bytes.extend_from_slice(bytes);
                self.taken = accepted?;
            }
            return Ok(());
        }
        self.bytes.extend_from_slice(bytes);
        self.write_to(device)
    }

    /// Writes those of the waiting bytes that `device` accepts at once.
    pub(crate) fn write_to(&mut self, device: &Device) -> io::Result<()> {
        self.taken += device.write_some(&self.bytes[self.taken..])?;
        if self.taken == self.bytes.len() {
            self.clear();
        }
        Ok(())
    }

    /// Whether `sequence` is among the bytes, and the device has not accepted all of it.
    pub(crate) fn withholds(&self, sequence: &str) -> bool {
        let mut places = self.bytes.windows(sequence.len());
        let last = places.rposition(|bytes| bytes == sequence.as_bytes());
        last.is_some_and(|place| place + sequence.len() > self.taken)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub(crate) fn clear(&mut self) {
        self.bytes.clear();
        self.taken = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sequence_is_withheld_until_all_of_it_is_accepted() {
        let mut queue = OutputQueue::default();
        assert!(!queue.withholds("flags"));
        queue.bytes.extend_from_slice(b"frame flags frame");
        for (taken, withheld) in [(0, true), (6, true), (10, true), (11, false), (17, false)] {
            queue.taken = taken;
            assert_eq!(queue.withholds("flags"), withheld, "{taken} bytes");
        }
        queue.bytes.extend_from_slice(b" flags");
        assert!(queue.withholds("flags"));
        assert!(!queue.withholds("other"));
    }
}
