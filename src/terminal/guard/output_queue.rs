//! Written bytes that the terminal has not accepted yet.

use std::io;

use super::Device;

/// Bytes for a terminal that does not accept more at present. They are few, since no frame is drawn
/// while there are any.
#[derive(Debug, Default)]
pub(super) struct OutputQueue {
    bytes: Vec<u8>,
    /// The number of accepted bytes.
    taken: usize,
}

impl OutputQueue {
    pub(super) fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Writes the bytes that `device` accepts at once.
    pub(super) fn write_to(&mut self, device: &Device) -> io::Result<()> {
        self.taken += device.write_some(&self.bytes[self.taken..])?;
        if self.taken == self.bytes.len() {
            self.clear();
        }
        Ok(())
    }

    pub(super) fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    pub(super) fn clear(&mut self) {
        self.bytes.clear();
        self.taken = 0;
    }
}
