//! The stream between a socket and russh: limits on bytes, and the events that time limits depend on.
//!
//! russh reads and writes whenever it likes, so limits belong below it. Before authentication, a client has a
//! budget of bytes. After it, bytes are read at a limited rate. Whatever a client floods its connection with,
//! be it keys, empty packets or key exchanges, costs the server no more than that. Compressed input is
//! limited a second time, on its [way](super::inbound) to the session.
//!
//! russh reads the length of a packet and its rest one by one. A key is one packet, so a buffer of [`READ_AHEAD`] bytes
//! saves a system call for each key and each answer of a terminal.
//!
//! russh allocates memory for a packet, up to 256 KB, as soon as its length has arrived, and then reads the
//! packet at once. A read larger than any packet allowed on this server's channel ends the connection.

use std::ops::Range;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, ready};
use std::time::Duration;
use std::{io, mem};

use futures_util::task::AtomicWaker;
use russh::keys::ssh_encoding::Decode;
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::time::{Instant, Sleep, sleep_until};

use super::outbox::FrameProgress;
use crate::bucket::Bucket;
use crate::lock::locked;

/// The limits on a client's bytes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ByteLimits {
    /// The maximum number of bytes before authentication.
    pub(crate) before_login: u64,
    /// The maximum number of bytes per second after authentication. Bursts of up to four seconds' worth are allowed.
    pub(crate) per_second: u32,
}

impl ByteLimits {
    /// A bucket for the bytes after authentication, full at `now`.
    pub(crate) fn bucket(&self, now: Duration) -> Bucket {
        let rate = f64::from(self.per_second);
        Bucket::new(rate, rate * BURST, now)
    }
}

/// A rate-limited socket.
pub(crate) struct Wire<S> {
    socket: S,
    line: Arc<ConnectionState>,
    bucket: Bucket,
    pause: Pin<Box<Sleep>>,
    /// Bytes that were read from the socket but not yet by russh: the range `ahead` of `buffer`.
    buffer: [u8; READ_AHEAD],
    ahead: Range<usize>,
    /// Whether the last write found the socket full.
    is_full: bool,
}

/// The shared state of a connection.
pub(crate) struct ConnectionState {
    pub(crate) progress: Arc<FrameProgress>,
    pub(crate) limits: ByteLimits,
    pub(crate) begun: Instant,
    hello: Mutex<Hello>,
    is_logged_in: AtomicBool,
    read: AtomicU64,
    /// The time of [`ConnectionState::last_sign`], in milliseconds since `begun`.
    last_sign: AtomicU64,
    is_cut: AtomicBool,
    /// The wakers of the reader and the writer.
    wakers: [AtomicWaker; 2],
}

/// The maximum burst, in seconds at the full rate.
const BURST: f64 = 4.0;
/// The fewest bytes that are read after a pause. This keeps pauses rare.
pub(crate) const MIN_READ: f64 = 1024.0;
/// The largest allowed read, in bytes. Packets have 32 KB plus framing (RFC 4253, section 6.1).
const MAX_PACKET_BYTES: usize = 35_000;
/// The size of the buffer for reads, in bytes: several keys.
const READ_AHEAD: usize = 256;
const READER: usize = 0;
const WRITER: usize = 1;

impl<S> Wire<S> {
    pub(crate) fn new(socket: S, line: Arc<ConnectionState>) -> Self {
        let bucket = line.limits.bucket(line.begun.elapsed());
        let pause = Box::pin(sleep_until(Instant::now()));
        let buffer = [0; READ_AHEAD];
        Self { socket, line, bucket, pause, buffer, ahead: 0..0, is_full: false }
    }
}

impl ConnectionState {
    pub(crate) fn new(limits: ByteLimits, progress: Arc<FrameProgress>) -> Self {
        Self {
            progress,
            limits,
            begun: Instant::now(),
            hello: Mutex::default(),
            is_logged_in: AtomicBool::new(false),
            read: AtomicU64::new(0),
            last_sign: AtomicU64::new(0),
            is_cut: AtomicBool::new(false),
            wakers: Default::default(),
        }
    }

    /// The client's progress through its first packets.
    pub(crate) fn stage(&self) -> Stage {
        locked(&self.hello, |hello| hello.stage)
    }

    /// Returns true if output is compressed after authentication.
    pub(crate) fn compresses(&self) -> bool {
        locked(&self.hello, |hello| hello.compresses)
    }

    pub(crate) fn is_logged_in(&self) -> bool {
        self.is_logged_in.load(Ordering::Acquire)
    }

    /// Marks the client as authenticated.
    pub(crate) fn log_in(&self) {
        self.is_logged_in.store(true, Ordering::Release);
    }

    /// The time when the client last sent anything or made room in a full socket. The latter counts because
    /// russh reads nothing while a frame does not fit into the socket, which takes long on a slow link.
    pub(crate) fn last_sign(&self) -> Instant {
        self.begun + Duration::from_millis(self.last_sign.load(Ordering::Acquire))
    }

    /// Makes all further reads and writes fail.
    pub(crate) fn cut(&self) {
        self.is_cut.store(true, Ordering::Release);
        self.wakers.iter().for_each(AtomicWaker::wake);
    }

    fn check(&self, side: usize, cx: &Context<'_>) -> io::Result<()> {
        self.wakers[side].register(cx.waker());
        let is_cut = self.is_cut.load(Ordering::Acquire);
        if is_cut { Err(io::ErrorKind::ConnectionAborted.into()) } else { Ok(()) }
    }

    fn note_sign(&self) {
        self.last_sign.store(self.begun.elapsed().as_millis() as u64, Ordering::Release);
    }
}

impl<S> Wire<S> {
    /// The number of bytes that may be read now.
    fn allowance(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<usize>> {
        let ConnectionState { limits, read, .. } = &*self.line;
        if !self.line.is_logged_in() {
            let left = limits.before_login.saturating_sub(read.load(Ordering::Relaxed));
            return Poll::Ready(match left {
                0 => Err(io::ErrorKind::QuotaExceeded.into()),
                left => Ok(left as usize),
            });
        }
        let fewest = MIN_READ.min(f64::from(limits.per_second));
        loop {
            let now = Instant::now();
            let bytes = self.bucket.fill(now.saturating_duration_since(self.line.begun));
            if bytes >= fewest {
                return Poll::Ready(Ok(bytes as usize));
            }
            self.pause.as_mut().reset(now + self.bucket.time_until(fewest));
            ready!(self.pause.as_mut().poll(cx));
        }
    }
}

impl<S: AsyncRead + Unpin> Wire<S> {
    /// Reads at most `most` bytes from the socket to `buffer`. Returns the number of bytes.
    fn read(
        &mut self,
        cx: &mut Context<'_>,
        buffer: &mut [u8],
        most: usize,
    ) -> Poll<io::Result<usize>> {
        let most = most.min(buffer.len());
        let mut part = ReadBuf::new(&mut buffer[..most]);
        ready!(Pin::new(&mut self.socket).poll_read(cx, &mut part))?;
        let bytes = part.filled();
        if !bytes.is_empty() {
            self.line.read.fetch_add(bytes.len() as u64, Ordering::Relaxed);
            self.line.note_sign();
            self.bucket.take(bytes.len() as f64);
            locked(&self.line.hello, |hello| hello.receive(bytes));
        }
        Poll::Ready(Ok(bytes.len()))
    }
}

impl<S: AsyncRead + Unpin> AsyncRead for Wire<S> {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buffer: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.line.check(READER, cx)?;
        if buffer.remaining() > MAX_PACKET_BYTES {
            return Poll::Ready(Err(io::ErrorKind::FileTooLarge.into()));
        }
        if self.ahead.is_empty() {
            let most = ready!(self.allowance(cx))?;
            if buffer.remaining() >= READ_AHEAD {
                let count = ready!(self.read(cx, buffer.initialize_unfilled(), most))?;
                buffer.advance(count);
                return Poll::Ready(Ok(()));
            }
            let mut ahead = [0; READ_AHEAD];
            self.ahead = 0..ready!(self.read(cx, &mut ahead, most))?;
            self.buffer = ahead;
        }
        let count = self.ahead.len().min(buffer.remaining());
        let first = self.ahead.start;
        buffer.put_slice(&self.buffer[first..first + count]);
        self.ahead.start += count;
        Poll::Ready(Ok(()))
    }
}

impl<S: AsyncWrite + Unpin> AsyncWrite for Wire<S> {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.line.check(WRITER, cx)?;
        let written = Pin::new(&mut self.socket).poll_write(cx, bytes);
        if mem::replace(&mut self.is_full, written.is_pending()) && written.is_ready() {
            self.line.note_sign();
        }
        if let Poll::Ready(Ok(count)) = written {
            self.line.progress.wrote(count);
        }
        written
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        ready!(Pin::new(&mut self.socket).poll_flush(cx))?;
        self.line.progress.flushed();
        Poll::Ready(Ok(()))
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.socket).poll_shutdown(cx)
    }
}

impl<S> Drop for Wire<S> {
    fn drop(&mut self) {
        self.line.progress.close();
    }
}

/// A parser of a client's first packets, which are not encrypted: its version, its offer of algorithms and
/// its half of the key exchange (RFC 4253, sections 4.2, 6 and 7.1).
///
/// russh does not expose the chosen algorithms, and a session must know whether its bytes are compressed.
/// After the key exchange, a client may wait for its user, who checks the host key for the first time or
/// types a passphrase. Before it, a client has no reason to wait.
#[derive(Debug, Default)]
struct Hello {
    stage: Stage,
    /// Bytes that are not parsed yet.
    bytes: Vec<u8>,
    compresses: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Stage {
    /// The version is missing.
    #[default]
    Version,
    /// The offer of algorithms is missing.
    Offer,
    /// The client's half of the key exchange is missing.
    Exchange,
    /// The client has sent all of these. It may wait for its user now.
    Done,
}

const KEXINIT: u8 = 20;
/// The packet length, the padding length, the message type and the cookie.
const OFFER_START: usize = 4 + 1 + 1 + 16;
/// The index, in an offer, of the name list for compression from server to client.
const COMPRESSION: usize = 7;

impl Hello {
    /// Parses received bytes.
    fn receive(&mut self, bytes: &[u8]) {
        if self.stage == Stage::Done {
            return;
        }
        self.bytes.extend_from_slice(bytes);
        while self.step().is_some() {}
        if self.stage == Stage::Done || self.bytes.len() > MAX_PACKET_BYTES {
            self.bytes = Vec::new();
        }
    }

    /// Parses one line or packet, if it is complete.
    fn step(&mut self) -> Option<()> {
        let length = match self.stage {
            Stage::Version => self.bytes.iter().position(|&byte| byte == b'\n')? + 1,
            Stage::Offer | Stage::Exchange => packet_length(&self.bytes)?,
            Stage::Done => return None,
        };
        let unit = self.bytes.get(..length)?;
        self.stage = match self.stage {
            Stage::Offer if unit.get(5) == Some(&KEXINIT) => {
                self.compresses = compresses(unit.get(OFFER_START..)?);
                Stage::Exchange
            }
            Stage::Version | Stage::Offer => Stage::Offer,
            Stage::Exchange | Stage::Done => Stage::Done,
        };
        self.bytes.drain(..length);
        Some(())
    }
}

fn packet_length(bytes: &[u8]) -> Option<usize> {
    let length = u32::from_be_bytes(*bytes.first_chunk()?) as usize;
    (length <= MAX_PACKET_BYTES).then_some(4 + length)
}

fn compresses(mut lists: &[u8]) -> bool {
    let mut lists = (0..=COMPRESSION).map_while(|_| String::decode(&mut lists).ok());
    let methods = lists.nth(COMPRESSION).unwrap_or_default();
    let known = methods.split(',').find(|method| ["none", "zlib@openssh.com"].contains(method));
    known == Some("zlib@openssh.com")
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn packet(payload: &[u8]) -> Vec<u8> {
        let mut packet = (payload.len() as u32 + 5).to_be_bytes().to_vec();
        packet.push(4);
        packet.extend(payload);
        packet.extend([0; 4]);
        packet
    }

    /// The first bytes of a client.
    fn hello(compression: &str) -> Vec<u8> {
        let mut offer = vec![KEXINIT];
        offer.extend([7; 16]);
        let names = ["kex", "key", "cipher", "cipher", "mac", "mac", "zlib", compression, "", ""];
        for list in names {
            offer.extend((list.len() as u32).to_be_bytes());
            offer.extend(list.as_bytes());
        }
        offer.extend([0; 5]);
        let exchange = [30; 33];
        [b"SSH-2.0-OpenSSH_9.2p1\r\n".to_vec(), packet(&offer), packet(&exchange)].concat()
    }

    #[test]
    fn the_first_known_compression_method_is_chosen() {
        for (methods, compresses) in [
            ("none,zlib@openssh.com,zlib", false),
            ("zlib@openssh.com,zlib,none", true),
            ("zlib,zlib@openssh.com,none", true),
            ("zlib,none", false),
            ("", false),
        ] {
            let mut hello_of = Hello::default();
            hello_of.receive(&hello(methods));
            assert_eq!(hello_of.stage, Stage::Done, "{methods}");
            assert_eq!(hello_of.compresses, compresses, "{methods}");
        }
    }

    proptest! {
        #[test]
        fn the_size_of_pieces_makes_no_difference(cuts in prop::collection::vec(1_usize..60, 1..40)) {
            let bytes = hello("zlib@openssh.com,none");
            let mut parser = Hello::default();
            let (mut rest, mut cuts) = (bytes.as_slice(), cuts.iter().cycle());
            while !rest.is_empty() {
                let (piece, after) = rest.split_at(rest.len().min(*cuts.next().unwrap()));
                parser.receive(piece);
                prop_assert_eq!(parser.stage == Stage::Done, after.is_empty());
                rest = after;
            }
            prop_assert!(parser.compresses);
        }

        #[test]
        fn no_bytes_panic_and_few_are_kept(pieces in prop::collection::vec(any::<Vec<u8>>(), 0..80)) {
            let mut parser = Hello::default();
            for piece in pieces {
                parser.receive(&piece);
                prop_assert!(parser.bytes.len() <= MAX_PACKET_BYTES);
            }
        }
    }
}
