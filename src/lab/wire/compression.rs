//! What `ssh -C` makes of bytes: zlib, one stream, flushed after each frame. OpenSSH's level is 6; 1 is what a
//! server of one's own could choose.

use flate2::{Compress, Compression, FlushCompress, Status};

/// The levels that are reported: the fastest one, and the one that OpenSSH uses.
pub(super) const LEVELS: [u32; 2] = [1, 6];
/// More than zlib adds to what it can't make smaller.
const OVERHEAD: usize = 256;

/// A compressed stream.
#[derive(Debug)]
pub(super) struct Stream {
    compress: Compress,
    output: Vec<u8>,
}

impl Stream {
    pub(super) fn new(level: u32) -> Self {
        Self { compress: Compress::new(Compression::new(level), true), output: Vec::new() }
    }

    /// How many bytes are sent for `frame`; none for an empty one.
    pub(super) fn size_of(&mut self, frame: &[u8]) -> usize {
        if frame.is_empty() {
            return 0;
        }
        let (read, written) = (self.compress.total_in(), self.compress.total_out());
        loop {
            let rest = &frame[(self.compress.total_in() - read) as usize..];
            self.output.clear();
            self.output.reserve(rest.len() + OVERHEAD);
            let status = self.compress.compress_vec(rest, &mut self.output, FlushCompress::Sync);
            let is_full = self.output.len() == self.output.capacity();
            if !is_full || !matches!(status, Ok(Status::Ok)) {
                return (self.compress.total_out() - written) as usize;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_sent_before_costs_little_again() {
        let mut stream = Stream::new(6);
        let noise: Vec<u8> =
            (0..5000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 11) as u8).collect();
        let (first, again) = (stream.size_of(&noise), stream.size_of(&noise));
        assert!(first > 500 && again < first / 5, "{first} {again}");
        assert_eq!(stream.size_of(&[]), 0);
        assert!(stream.size_of(b"x") < 20);
    }
}
