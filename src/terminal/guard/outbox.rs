//! What was written, and what of it the terminal has not taken yet.

use std::io;

use super::Device;

/// Bytes for a terminal that takes no more at present. There are not many: no frame is drawn while
/// there are any.
#[derive(Debug, Default)]
pub(super) struct Outbox {
    bytes: Vec<u8>,
    /// How many of them have been taken.
    taken: usize,
}

impl Outbox {
    pub(super) fn push(&mut self, bytes: &[u8]) {
        self.bytes.extend_from_slice(bytes);
    }

    /// Writes as much as `device` takes at once.
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
