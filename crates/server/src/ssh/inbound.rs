//! A visitor's input, on its way from the connection to the session.
//!
//! Bytes wait in one buffer of bounded size. While it is full, the connection is not read, so that a flood
//! waits in the client's own socket. Only the newest window size is kept. Rejected: a queue of messages. A
//! message of one byte costs a hundred.
//!
//! The rate limit of a client also applies after decompression. Without it, eight clients that compressed
//! their input kept two processors busy.
//!
//! Rejected: letting the repetitions of a held key wait for the next frame, with their times of arrival. A session then
//! takes 49 turns a second instead of 57, for 70 lines of code. Rejected: letting all bytes wait. New keys take effect
//! late.
//!
//! A session takes a flood in parts, and other tasks run between two of them. Rejected: whole buffers. Eight
//! visitors who typed a name all the time delayed a bystander's key by up to 0.3 s.

use std::mem;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::sync::Notify;
use tokio::task::yield_now;
use tokio::time::{Instant, timeout};

use super::wire::{ByteLimits, MIN_READ};
use crate::bucket::Bucket;
use crate::lock::locked;
use cellcaster::terminal::WindowSize;

/// An event from a visitor's connection.
#[derive(Clone, Debug, PartialEq)]
pub enum Arrival {
    /// Typed bytes, at most [`Inbound::MAX_AT_ONCE`].
    Bytes(Vec<u8>),
    /// The new size of the visitor's window.
    Resized(WindowSize),
    /// The server will shut down soon. The session must tell the visitor and end in time.
    Drains,
    /// The link has ended: nothing more arrives, and nothing can be sent.
    Ended,
}

/// The session's end of the buffer.
#[derive(Debug)]
pub struct Inbound {
    shared: Arc<InboundState>,
    /// Whether the last arrival was one part of several. The session yields to other tasks before the next part.
    yields: bool,
}

/// The connection's end of the buffer.
#[derive(Clone, Debug)]
pub(crate) struct InboundSender {
    shared: Arc<InboundState>,
}

#[derive(Debug)]
struct InboundState {
    begun: Instant,
    waiting: Mutex<PendingInput>,
    /// Tells the session that something has arrived.
    arrived: Notify,
    /// Tells the connection that there is room.
    taken: Notify,
}

#[derive(Debug)]
struct PendingInput {
    /// The number of bytes that the client may send now.
    bucket: Bucket,
    bytes: Vec<u8>,
    size: Option<WindowSize>,
    drains: bool,
    ended: bool,
    /// Whether the session is gone, so that nobody takes the input.
    is_abandoned: bool,
}

/// The result of appending bytes to the buffer.
enum Appended {
    /// This number of bytes was taken.
    Some(usize),
    /// The buffer is full.
    Full,
    /// More bytes may arrive after this time.
    TooFast(Duration),
}

/// Both ends of a buffer.
pub(crate) fn inbound(limits: ByteLimits) -> (InboundSender, Inbound) {
    let waiting = PendingInput::new(limits.bucket(Duration::ZERO));
    let [arrived, taken] = [(); 2].map(|()| Notify::new());
    let begun = Instant::now();
    let shared = Arc::new(InboundState { begun, waiting: Mutex::new(waiting), arrived, taken });
    (InboundSender { shared: shared.clone() }, Inbound { shared, yields: false })
}

impl Arrival {
    /// Returns true if more bytes may be waiting.
    fn is_full(&self) -> bool {
        matches!(self, Self::Bytes(bytes) if bytes.len() == Inbound::MAX_AT_ONCE)
    }
}

impl Inbound {
    /// The size of the buffer, in bytes.
    pub const MAX_BYTES: usize = 16 << 10;
    /// The maximum size of an arrival, in bytes. A session handles it in well under a millisecond.
    pub const MAX_AT_ONCE: usize = 256;

    /// Waits for the next arrival. [`Arrival::Ended`] comes after all bytes, and on every later call.
    ///
    /// Cancellation-safe: dropping the future before it is ready loses nothing.
    pub async fn next(&mut self) -> Arrival {
        if mem::take(&mut self.yields) {
            yield_now().await;
        }
        loop {
            if let Some(arrival) = locked(&self.shared.waiting, PendingInput::take) {
                self.yields = arrival.is_full();
                self.shared.taken.notify_one();
                return arrival;
            }
            self.shared.arrived.notified().await;
        }
    }
}

impl Drop for Inbound {
    fn drop(&mut self) {
        locked(&self.shared.waiting, |waiting| {
            *waiting = PendingInput { is_abandoned: true, ..PendingInput::new(waiting.bucket) };
        });
        self.shared.taken.notify_one();
    }
}

impl InboundSender {
    /// Passes bytes on. Waits while the buffer is full or the bytes come too fast.
    pub(crate) async fn bytes(&self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let now = self.shared.begun.elapsed();
            let appended = locked(&self.shared.waiting, |waiting| waiting.append(bytes, now));
            let taken = self.shared.taken.notified();
            match appended {
                Appended::Some(count) => {
                    self.shared.arrived.notify_one();
                    bytes = &bytes[count..];
                }
                Appended::Full => taken.await,
                // The session may end during the pause.
                Appended::TooFast(pause) => _ = timeout(pause, taken).await,
            }
        }
    }

    pub(crate) fn resize(&self, size: WindowSize) {
        self.change(|waiting| waiting.size = Some(size));
    }

    pub(crate) fn drain(&self) {
        self.change(|waiting| waiting.drains = true);
    }

    pub(crate) fn end(&self) {
        self.change(|waiting| waiting.ended = true);
        self.shared.taken.notify_one();
    }

    fn change(&self, change: impl FnOnce(&mut PendingInput)) {
        locked(&self.shared.waiting, change);
        self.shared.arrived.notify_one();
    }
}

impl PendingInput {
    fn new(bucket: Bucket) -> Self {
        let bytes = Vec::new();
        Self { bucket, bytes, size: None, drains: false, ended: false, is_abandoned: false }
    }

    fn take(&mut self) -> Option<Arrival> {
        if mem::take(&mut self.drains) {
            return Some(Arrival::Drains);
        }
        if let Some(size) = self.size.take() {
            return Some(Arrival::Resized(size));
        }
        if !self.bytes.is_empty() {
            let rest = self.bytes.split_off(self.bytes.len().min(Inbound::MAX_AT_ONCE));
            return Some(Arrival::Bytes(mem::replace(&mut self.bytes, rest)));
        }
        self.ended.then_some(Arrival::Ended)
    }

    fn append(&mut self, bytes: &[u8], now: Duration) -> Appended {
        if self.is_abandoned || self.ended {
            return Appended::Some(bytes.len());
        }
        let room = bytes.len().min(Inbound::MAX_BYTES - self.bytes.len());
        if room == 0 {
            return Appended::Full;
        }
        let allowed = self.bucket.fill(now);
        let fewest = MIN_READ.min(room as f64);
        if allowed < fewest {
            return Appended::TooFast(self.bucket.time_until(fewest));
        }
        let count = room.min(allowed as usize);
        self.bucket.take(count as f64);
        self.bytes.extend_from_slice(&bytes[..count]);
        Appended::Some(count)
    }
}

#[cfg(test)]
mod tests {
    use std::future::Future;
    use std::pin::pin;
    use std::task::{Context, Poll, Waker};

    use super::*;

    const LIMITS: ByteLimits = ByteLimits { before_login: 0, per_second: 64 << 10 };

    fn poll<T>(future: impl Future<Output = T>) -> Option<T> {
        match pin!(future).poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(value) => Some(value),
            Poll::Pending => None,
        }
    }

    /// The next arrival, if any.
    fn next(inbound: &mut Inbound) -> Option<Arrival> {
        // The first poll may yield, between two parts of a flood.
        poll(inbound.next()).or_else(|| poll(inbound.next()))
    }

    #[test]
    fn a_flood_waits_and_takes_no_memory() {
        let (inlet, mut inbound) = inbound(LIMITS);
        let flood = vec![b'w'; 10 << 20];
        assert_eq!(poll(inlet.bytes(&flood)), None);
        let held = |inlet: &InboundSender| {
            locked(&inlet.shared.waiting, |waiting| waiting.bytes.capacity())
        };
        assert!(held(&inlet) <= 2 * Inbound::MAX_BYTES);
        let mut taken = 0;
        while let Some(Arrival::Bytes(bytes)) = next(&mut inbound) {
            assert!(bytes.len() <= Inbound::MAX_AT_ONCE);
            taken += bytes.len();
        }
        assert_eq!(taken, Inbound::MAX_BYTES);
        assert_eq!(poll(inlet.bytes(b"d")), Some(()));
        assert_eq!(next(&mut inbound), Some(Arrival::Bytes(b"d".to_vec())));
    }

    #[test]
    fn bytes_keep_their_order_across_waits() {
        let (inlet, mut inbound) = inbound(LIMITS);
        let sent: Vec<u8> = (0..100_000_u32).map(|number| number as u8).collect();
        let mut sending = pin!(inlet.bytes(&sent));
        let mut received = Vec::new();
        loop {
            let is_sent = poll(sending.as_mut()).is_some();
            while let Some(Arrival::Bytes(bytes)) = next(&mut inbound) {
                received.extend(bytes);
            }
            if is_sent {
                break;
            }
        }
        assert_eq!(received, sent);
    }

    #[tokio::test(start_paused = true)]
    async fn compressed_input_is_limited_to_the_same_rate() {
        let (inlet, mut inbound) = inbound(LIMITS);
        let sending = async {
            inlet.bytes(&vec![b'w'; 20 * (64 << 10)]).await;
            inlet.end();
        };
        let taking = async { while inbound.next().await != Arrival::Ended {} };
        let begun = Instant::now();
        tokio::join!(sending, taking);
        // The bytes of the first four seconds arrive at once.
        assert_eq!(begun.elapsed().as_millis().next_multiple_of(100), 16_000);
    }

    #[test]
    fn only_the_latest_window_size_arrives() {
        let (inlet, mut inbound) = inbound(LIMITS);
        for columns in 1..=500 {
            inlet.resize(WindowSize::of_cells(columns, 24));
        }
        assert_eq!(next(&mut inbound), Some(Arrival::Resized(WindowSize::of_cells(500, 24))));
        assert_eq!(next(&mut inbound), None);
    }

    #[test]
    fn the_end_comes_after_the_bytes_and_stays() {
        let (inlet, mut inbound) = inbound(LIMITS);
        assert_eq!(poll(inlet.bytes(b"q")), Some(()));
        inlet.end();
        assert_eq!(next(&mut inbound), Some(Arrival::Bytes(b"q".to_vec())));
        assert_eq!(next(&mut inbound), Some(Arrival::Ended));
        assert_eq!(next(&mut inbound), Some(Arrival::Ended));
    }

    #[test]
    fn a_connection_never_waits_for_an_ended_session() {
        let (inlet, inbound) = inbound(LIMITS);
        assert_eq!(poll(inlet.bytes(&vec![0; Inbound::MAX_BYTES + 1])), None);
        drop(inbound);
        assert_eq!(poll(inlet.bytes(&vec![0; 1 << 20])), Some(()));
    }
}
