//! The outbox: the one frame on its way to a visitor.
//!
//! A frame has drained when the socket has accepted its last byte. A session encodes a frame only after the
//! previous one has drained, so a client that does not read holds the memory of one frame. A frame goes to
//! russh in parts, each after the previous one was written, because russh keeps a buffer as large as the
//! largest part it has ever received. russh drops the bytes of a part once they are encrypted, and the next
//! flush of the stream then shows that they were written. Each part has its own memory, so a client that
//! stops reading within a frame holds only the rest of it. Rejected: counting encrypted bytes. Compression
//! changes their number.

use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::time::Duration;

use bytes::Bytes;
use futures_util::FutureExt as _;
use russh::ChannelId;
use russh::server::Handle;
use tokio::sync::Notify;
use tokio::task::{unconstrained, yield_now};
use tokio::time::Instant;

use crate::lock::locked;
use crate::metrics::Metrics;

/// The slot for one frame. It is free when the previous frame has drained.
pub struct Outbox {
    progress: Arc<FrameProgress>,
}

/// The state of the current frame, shared by the outbox, the frame and the stream.
pub(crate) struct FrameProgress {
    state: AtomicU8,
    /// Whether the link has ended, so that nothing can be sent.
    is_closed: AtomicBool,
    /// The number of parts sent.
    parts: AtomicU64,
    /// The number of bytes written to the socket.
    on_wire: AtomicU64,
    begun: Instant,
    /// The time since `begun` at which the last frame drained, in microseconds.
    drained_at: AtomicU64,
    /// The rest of the frame, not yet passed to russh.
    rest: Mutex<Option<Frame>>,
    changed: Notify,
    metrics: Arc<Metrics>,
    sink: OnceLock<Box<dyn Fn(Bytes) + Send + Sync>>,
}

/// The size of the largest part, in bytes. russh keeps a buffer of this size for each connection. At 16 KB, a
/// frame of 80×24 cells is usually a single part, but a thousand connections keep eight more megabytes.
const PART: usize = 8 << 10;

const EMPTY: u8 = 0;
/// A part of the frame waits for space in the client's window.
const QUEUED: u8 = 1;
/// A part of the frame is encrypted but not written yet.
const ENCRYPTED: u8 = 2;

impl Outbox {
    /// An outbox that sends frames to a channel.
    pub(crate) fn new(handle: Handle, channel: ChannelId, progress: Arc<FrameProgress>) -> Self {
        // The queue cannot be full: it holds at most one part, a few questions and the three closing messages.
        let send = move |part| _ = unconstrained(handle.data(channel, part)).now_or_never();
        Self::into(send, progress)
    }

    /// An outbox that passes frames to `sink`, part by part.
    pub(crate) fn into(
        sink: impl Fn(Bytes) + Send + Sync + 'static,
        progress: Arc<FrameProgress>,
    ) -> Self {
        // This cannot fail, because a connection has only one session channel.
        _ = progress.sink.set(Box::new(sink));
        Self { progress }
    }

    /// Returns true if a frame can be sent.
    pub fn is_empty(&self) -> bool {
        self.progress.is_empty()
    }

    /// Returns true if the last frame has drained or the link has ended.
    pub(crate) fn has_drained(&self) -> bool {
        self.is_empty() || self.progress.is_closed.load(Ordering::Acquire)
    }

    /// The time at which the last frame drained.
    pub(crate) fn drained_at(&self) -> Instant {
        let micros = self.progress.drained_at.load(Ordering::Acquire);
        self.progress.begun + Duration::from_micros(micros)
    }

    /// The number of bytes that the connection has written to its socket, after compression and encryption.
    pub fn on_wire(&self) -> u64 {
        self.progress.on_wire.load(Ordering::Acquire)
    }

    /// Sends a frame. After the link has ended, frames are accepted and discarded.
    ///
    /// # Errors
    /// Returns the frame if the previous one has not drained.
    pub fn try_send(&mut self, frame: Vec<u8>) -> Result<(), Vec<u8>> {
        if !self.is_empty() {
            return Err(frame);
        }
        if frame.is_empty() || self.progress.is_closed.load(Ordering::Acquire) {
            return Ok(());
        }
        let metrics = self.progress.metrics.clone();
        metrics.frames.inc();
        metrics.frame_bytes.inc_by(frame.len() as u64);
        self.progress.send_part(Frame::new(frame, metrics));
        Ok(())
    }

    /// Waits until the frame has drained or the link has ended. Returns at once if there is no frame in
    /// flight. Cancellation-safe.
    ///
    /// Do not use [`Outbox::is_empty`] to decide whether to await this. The frame can drain at any time, so
    /// the caller may miss that it has drained and then wait forever for another event.
    pub async fn drained(&mut self) {
        while !self.has_drained() {
            self.progress.changed.notified().await;
        }
        if self.progress.is_closed.load(Ordering::Acquire) {
            // Without this yield, a session that sends frame after frame would never let its task notice the end.
            yield_now().await;
        }
    }
}

impl FrameProgress {
    pub(crate) fn new(metrics: Arc<Metrics>) -> Self {
        Self {
            state: AtomicU8::new(EMPTY),
            is_closed: AtomicBool::new(false),
            parts: AtomicU64::new(0),
            on_wire: AtomicU64::new(0),
            begun: Instant::now(),
            drained_at: AtomicU64::new(0),
            rest: Mutex::default(),
            changed: Notify::new(),
            metrics,
            sink: OnceLock::new(),
        }
    }

    /// Called when the stream has written bytes to its socket.
    pub(crate) fn wrote(&self, bytes: usize) {
        self.on_wire.fetch_add(bytes as u64, Ordering::AcqRel);
    }

    /// Called when the stream has written all bytes passed to it.
    pub(crate) fn flushed(self: &Arc<Self>) {
        if self.state.load(Ordering::Acquire) != ENCRYPTED {
            return;
        }
        if let Some(rest) = locked(&self.rest, Option::take) {
            self.send_part(rest);
        } else {
            let micros = self.begun.elapsed().as_micros() as u64;
            self.drained_at.store(micros, Ordering::Release);
            self.state.store(EMPTY, Ordering::Release);
            self.changed.notify_one();
        }
    }

    /// Discards the rest of the frame; nothing can be sent from now on.
    pub(crate) fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
        locked(&self.rest, Option::take);
        self.changed.notify_one();
    }

    /// The number of parts sent.
    pub(crate) fn parts(&self) -> u64 {
        self.parts.load(Ordering::Acquire)
    }

    /// Returns true if a part of a frame waits for space in the client's window.
    pub(crate) fn is_waiting(&self) -> bool {
        self.state.load(Ordering::Acquire) == QUEUED
    }

    fn is_empty(&self) -> bool {
        self.state.load(Ordering::Acquire) == EMPTY
    }

    /// Sends the first part of a frame and keeps the rest.
    fn send_part(self: &Arc<Self>, mut frame: Frame) {
        let Some(sink) = self.sink.get() else { return };
        let rest = frame.split_off(PART);
        locked(&self.rest, |kept| *kept = rest);
        self.state.store(QUEUED, Ordering::Release);
        self.parts.fetch_add(1, Ordering::AcqRel);
        sink(Bytes::from_owner(Part { frame, progress: self.clone() }));
    }
}

/// The bytes of a frame or a part of it. They are counted in the metrics while they exist.
struct Frame {
    bytes: Vec<u8>,
    metrics: Arc<Metrics>,
}

impl Frame {
    fn new(bytes: Vec<u8>, metrics: Arc<Metrics>) -> Self {
        metrics.held.inc_by(bytes.capacity() as i64);
        Self { bytes, metrics }
    }

    /// Splits off the bytes after the first `count`, if there are any. Each half has its own memory, so a
    /// part that was sent uses none.
    fn split_off(&mut self, count: usize) -> Option<Self> {
        if self.bytes.len() <= count {
            return None;
        }
        let rest = Self::new(self.bytes.split_off(count), self.metrics.clone());
        let capacity = self.bytes.capacity();
        self.bytes.shrink_to_fit();
        self.metrics.held.dec_by((capacity - self.bytes.capacity()) as i64);
        Some(rest)
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        self.metrics.held.dec_by(self.bytes.capacity() as i64);
    }
}

/// A part of a frame. russh drops it after encrypting it.
struct Part {
    frame: Frame,
    progress: Arc<FrameProgress>,
}

impl AsRef<[u8]> for Part {
    fn as_ref(&self) -> &[u8] {
        &self.frame.bytes
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        self.progress.state.store(ENCRYPTED, Ordering::Release);
    }
}
