//! A visitor's input, on its way from the connection to the session.
//!
//! Bytes wait in one buffer of bounded size. While it is full, the connection is not read, so that a flood
//! waits in the client's own socket. Only the newest window size is kept. Rejected: a queue of messages. A
//! message of one byte costs a hundred.
//!
//! The rate limit of a client also applies after decompression. Without it, eight clients that compressed
//! their input kept two processors busy.
//!
//! A held key repeats thirty times a second, and a terminal answers each frame. A session that will wake soon anyway is
//! not woken by them: they wait, each with its time of arrival. Rejected: waking for each. With 400 players who held
//! keys, keys took a quarter of the processor.
//!
//! A session takes a flood in parts, and other tasks run between two of them. Rejected: whole buffers. Eight
//! visitors who typed a name all the time delayed a bystander's key by up to 0.3 s.

use std::collections::VecDeque;
use std::mem;
use std::sync::atomic::{AtomicBool, Ordering};
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
    /// The time since the beginning at which the last bytes arrived.
    arrived_at: Duration,
}

/// The connection's end of the buffer.
#[derive(Clone, Debug)]
pub(crate) struct Inlet {
    shared: Arc<InboundState>,
}

#[derive(Debug)]
struct InboundState {
    begun: Instant,
    waiting: Mutex<PendingInput>,
    /// Whether the session wakes soon by itself.
    wakes_soon: AtomicBool,
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
    /// The parts of `bytes`, each with the time of arrival.
    parts: VecDeque<Part>,
    /// The latest packets.
    latest: [Option<Packet>; 2],
    size: Option<WindowSize>,
    drains: bool,
    ended: bool,
    /// Whether the session is gone, so that nobody takes the input.
    is_abandoned: bool,
}

/// Bytes that arrived at one time.
#[derive(Clone, Copy, Debug)]
struct Part {
    length: usize,
    at: Duration,
    /// Whether the bytes are a repeated packet, for which a session need not wake.
    is_repeated: bool,
}

/// A short packet, and the number of times that it has come in quick succession.
#[derive(Clone, Copy, Debug, Default)]
struct Packet {
    bytes: [u8; Packet::MAX_BYTES],
    length: usize,
    at: Duration,
    count: u32,
}

/// The longest time between two repetitions of a packet. Keyboards repeat a key every 33 to 50 ms. Nobody taps a key
/// so fast.
const MAX_REPEAT_INTERVAL: Duration = Duration::from_millis(60);
/// The number of times that a packet must have come before it counts as repeated. The first repetitions of a key tell
/// the session that it is held.
const MIN_REPEATS: u32 = 3;
/// The maximum number of parts that wait without waking the session.
const MAX_PARTS: usize = 32;

/// The result of appending bytes to the buffer.
enum Appended {
    /// This number of bytes was taken. The flag tells whether the session need not wake for them.
    Some(usize, bool),
    /// The buffer is full.
    Full,
    /// More bytes may arrive after this time.
    TooFast(Duration),
}

/// Both ends of a buffer.
pub(crate) fn inbound(limits: ByteLimits) -> (Inlet, Inbound) {
    let waiting = PendingInput::new(limits.bucket(Duration::ZERO));
    let [arrived, taken] = [(); 2].map(|()| Notify::new());
    let (begun, wakes_soon) = (Instant::now(), AtomicBool::new(false));
    let waiting = Mutex::new(waiting);
    let shared = Arc::new(InboundState { begun, waiting, wakes_soon, arrived, taken });
    let inbound = Inbound { shared: shared.clone(), yields: false, arrived_at: Duration::ZERO };
    (Inlet { shared }, inbound)
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
            if let Some(arrival) = self.take() {
                return arrival;
            }
            self.shared.arrived.notified().await;
        }
    }
}

impl Inbound {
    /// The next arrival, if there is one.
    fn take(&mut self) -> Option<Arrival> {
        let (arrival, at) = locked(&self.shared.waiting, PendingInput::take)?;
        self.yields = arrival.is_full();
        self.arrived_at = at.unwrap_or(self.arrived_at);
        self.shared.taken.notify_one();
        Some(arrival)
    }

    /// The time at which the last bytes arrived.
    pub(crate) fn arrived_at(&self) -> Instant {
        self.shared.begun + self.arrived_at
    }

    /// Sets whether the session wakes soon by itself, so that repeated packets need not wake it.
    pub(crate) fn set_wakes_soon(&self, wakes_soon: bool) {
        self.shared.wakes_soon.store(wakes_soon, Ordering::Release);
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

impl Inlet {
    /// Passes bytes on. Waits while the buffer is full or the bytes come too fast.
    pub(crate) async fn bytes(&self, mut bytes: &[u8]) {
        while !bytes.is_empty() {
            let now = self.shared.begun.elapsed();
            let appended = locked(&self.shared.waiting, |waiting| waiting.append(bytes, now));
            let taken = self.shared.taken.notified();
            match appended {
                Appended::Some(count, is_repeated) => {
                    if !(is_repeated && self.shared.wakes_soon.load(Ordering::Acquire)) {
                        self.shared.arrived.notify_one();
                    }
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
        Self {
            bucket,
            bytes: Vec::new(),
            parts: VecDeque::new(),
            latest: [None; 2],
            size: None,
            drains: false,
            ended: false,
            is_abandoned: false,
        }
    }

    /// Takes the next arrival, with its time if it is bytes.
    fn take(&mut self) -> Option<(Arrival, Option<Duration>)> {
        if mem::take(&mut self.drains) {
            return Some((Arrival::Drains, None));
        }
        if let Some(size) = self.size.take() {
            return Some((Arrival::Resized(size), None));
        }
        if let Some(part) = self.parts.front_mut() {
            let (count, at) = (part.length.min(Inbound::MAX_AT_ONCE), part.at);
            part.length -= count;
            if part.length == 0 {
                self.parts.pop_front();
            }
            let rest = self.bytes.split_off(count);
            let bytes = mem::replace(&mut self.bytes, rest);
            return Some((Arrival::Bytes(bytes), Some(at)));
        }
        self.ended.then_some((Arrival::Ended, None))
    }

    fn append(&mut self, bytes: &[u8], now: Duration) -> Appended {
        if self.is_abandoned || self.ended {
            return Appended::Some(bytes.len(), false);
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
        let is_repeated = self.is_repeated(bytes, now) && self.parts.len() < MAX_PARTS;
        match self.parts.back_mut() {
            Some(part) if !part.is_repeated && !is_repeated => part.length += count,
            _ => self.parts.push_back(Part { length: count, at: now, is_repeated }),
        }
        Appended::Some(count, is_repeated)
    }

    /// Records a packet. Returns true if the same packet has come several times in quick succession. Between two
    /// repetitions of a key, the terminal may answer a frame.
    fn is_repeated(&mut self, bytes: &[u8], now: Duration) -> bool {
        let Some(packet) = Packet::of(bytes, now) else { return false };
        let mut known = self.latest.iter_mut().flatten();
        if let Some(known) = known.find(|known| known.is(&packet)) {
            let is_quick = now.saturating_sub(known.at) <= MAX_REPEAT_INTERVAL;
            let count = if is_quick { known.count.saturating_add(1) } else { 1 };
            *known = Packet { count, ..packet };
            return count > MIN_REPEATS;
        }
        if let Some(oldest) = self.latest.iter_mut().min_by_key(|known| known.map(|it| it.at)) {
            *oldest = Some(packet);
        }
        false
    }
}

impl Packet {
    /// The longest packet that counts: a key with modifiers.
    const MAX_BYTES: usize = 16;

    fn of(bytes: &[u8], at: Duration) -> Option<Self> {
        let mut packet = Self { length: bytes.len(), at, count: 1, ..Self::default() };
        packet.bytes.get_mut(..bytes.len())?.copy_from_slice(bytes);
        Some(packet)
    }

    fn is(&self, other: &Self) -> bool {
        (self.bytes, self.length) == (other.bytes, other.length)
    }
}

#[cfg(test)]
mod tests {
    use std::future::Future;
    use std::pin::pin;
    use std::task::{Context, Poll, Waker};

    use tokio::time::sleep_until;

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
        let held =
            |inlet: &Inlet| locked(&inlet.shared.waiting, |waiting| waiting.bytes.capacity());
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

    /// Sends packets of one byte at these times, in milliseconds. Returns the times at which a session took them.
    async fn taken_at(packets: &[(u64, u8)], wakes_soon: bool) -> Vec<u64> {
        let (inlet, mut inbound) = inbound(LIMITS);
        inbound.set_wakes_soon(wakes_soon);
        let begun = Instant::now();
        let at = |milliseconds| begun + Duration::from_millis(milliseconds);
        let sending = async {
            for &(time, byte) in packets {
                sleep_until(at(time)).await;
                inlet.bytes(&[byte]).await;
            }
            inlet.end();
        };
        let taking = async {
            let mut times = Vec::new();
            while let Arrival::Bytes(bytes) = inbound.next().await {
                let (time, byte) = packets[times.len()];
                assert_eq!((inbound.arrived_at(), bytes), (at(time), vec![byte]));
                times.push(begun.elapsed().as_millis() as u64);
            }
            times
        };
        tokio::join!(sending, taking).1
    }

    #[tokio::test(start_paused = true)]
    async fn a_held_key_does_not_wake_a_session_that_wakes_soon() {
        let held = (0..6).map(|count| (33 * count, b'w'));
        let packets: Vec<(u64, u8)> = held.chain([(180, b'd')]).collect();
        assert_eq!(taken_at(&packets, false).await, [0, 33, 66, 99, 132, 165, 180]);
        assert_eq!(taken_at(&packets, true).await, [0, 33, 66, 180, 180, 180, 180]);
    }

    #[tokio::test(start_paused = true)]
    async fn answers_between_repetitions_do_not_wake_it_either() {
        let mut packets: Vec<(u64, u8)> = (0..6).map(|count| (33 * count, b'w')).collect();
        packets.extend((0..4).map(|count| (50 * count + 7, b'n')));
        packets.sort_unstable();
        packets.push((180, b'd'));
        let times = taken_at(&packets, true).await;
        assert_eq!(times, [0, 7, 33, 57, 66, 107, 107, 180, 180, 180, 180]);
    }

    #[tokio::test(start_paused = true)]
    async fn few_repetitions_wait_without_waking_the_session() {
        let packets: Vec<(u64, u8)> = (0..60).map(|count| (33 * count, b'w')).collect();
        let times = taken_at(&packets, true).await;
        let longest = times.iter().zip(&packets).map(|(taken, packet)| taken - packet.0).max();
        assert!(longest <= Some(33 * MAX_PARTS as u64), "{longest:?}");
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
