//! The compression of `ssh -C`: one zlib stream that is flushed after each frame. OpenSSH uses
//! level 6; another server could choose level 1.

use flate2::{Compress, Compression, FlushCompress, Status};

/// The reported levels: the fastest one, and that of OpenSSH.
pub(crate) const LEVELS: [u32; 2] = [1, 6];
/// More bytes than zlib adds to incompressible data.
const OVERHEAD: usize = 256;

/// A compressed stream.
#[derive(Debug)]
pub(crate) struct Stream {
    compress: Compress,
    output: Vec<u8>,
}

impl Stream {
    pub(crate) fn new(level: u32) -> Self {
        Self { compress: Compress::new(Compression::new(level), true), output: Vec::new() }
    }

    /// The number of bytes sent for `frame`; 0 for an empty one.
    pub(crate) fn size_of(&mut self, frame: &[u8]) -> usize {
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
    fn repeated_bytes_compress_well() {
        let mut stream = Stream::new(6);
        let noise: Vec<u8> =
            (0..5000_u32).map(|at| (at.wrapping_mul(2_654_435_761) >> 11) as u8).collect();
        let (first, again) = (stream.size_of(&noise), stream.size_of(&noise));
        assert!(first > 500 && again < first / 5, "{first} {again}");
        assert_eq!(stream.size_of(&[]), 0);
        assert!(stream.size_of(b"x") < 20);
    }
}
