//! The one frame on its way to a visitor.
//!
//! A frame has drained when the socket has accepted its last byte, so a session encodes a frame only
//! when the last one has left, and a client that does not read holds the memory of one frame. A frame
//! goes to russh in parts, each when the last was written: russh keeps a buffer as large as the most
//! that it was ever given at once. It drops the bytes of a part once they are encrypted, and the next
//! flush of the stream then says that they were written. Each part has memory of its own, so that a
//! client that stops reading within a frame holds only its rest. Counting encrypted bytes was refused:
//! compression changes their number.

use std::future::Future;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock};
use std::task::{Context, Poll, Waker};

use bytes::Bytes;
use russh::ChannelId;
use russh::server::Handle;
use tokio::sync::Notify;
use tokio::task::{unconstrained, yield_now};

use crate::lock::locked;
use crate::metrics::Metrics;

/// The place for one frame. The next one has room when the last has drained.
pub struct Outbox {
    passage: Arc<Passage>,
}

/// The state of the frame, which the outbox, the frame and the stream share.
pub(crate) struct Passage {
    state: AtomicU8,
    /// Nothing can be sent any more.
    is_closed: AtomicBool,
    /// The number of parts so far.
    parts: AtomicU64,
    /// What russh was not given yet.
    rest: Mutex<Option<Frame>>,
    changed: Notify,
    metrics: Arc<Metrics>,
    sink: OnceLock<Box<dyn Fn(Bytes) + Send + Sync>>,
}

/// The most bytes that russh is given at once, and keeps for each connection from then on. With 16 KB, a
/// frame of 80×24 cells is one part as a rule, and a thousand connections keep eight megabytes more.
const PART: usize = 8 << 10;

const EMPTY: u8 = 0;
/// A part of the frame waits for the client's window.
const QUEUED: u8 = 1;
/// A part of the frame is encrypted, and not yet written.
const ENCRYPTED: u8 = 2;

impl Outbox {
    /// Frames leave by a channel.
    pub(crate) fn new(handle: Handle, channel: ChannelId, passage: Arc<Passage>) -> Self {
        // The queue has room: one part, a few questions and the three messages of the end are in it.
        Self::into(move |part| _ = at_once(handle.data(channel, part)), passage)
    }

    /// Frames leave by `sink`, part by part.
    pub(crate) fn into(
        sink: impl Fn(Bytes) + Send + Sync + 'static,
        passage: Arc<Passage>,
    ) -> Self {
        // There is one session channel.
        _ = passage.sink.set(Box::new(sink));
        Self { passage }
    }

    /// Whether there is room for a frame.
    pub fn is_empty(&self) -> bool {
        self.passage.is_empty()
    }

    /// Sends a frame. After the link has ended, frames are accepted and dropped.
    ///
    /// # Errors
    /// The frame, if the last one has not drained.
    pub fn try_send(&mut self, frame: Vec<u8>) -> Result<(), Vec<u8>> {
        if !self.is_empty() {
            return Err(frame);
        }
        if frame.is_empty() || self.passage.is_closed.load(Ordering::Acquire) {
            return Ok(());
        }
        let metrics = self.passage.metrics.clone();
        metrics.frames.inc();
        metrics.frame_bytes.inc_by(frame.len() as u64);
        self.passage.send_part(Frame::new(frame, metrics));
        Ok(())
    }

    /// Waits until the last frame has drained, or the link has ended. It is ready at once where no
    /// frame is on its way, and it may be dropped before it is ready.
    ///
    /// A caller that asks [`Outbox::is_empty`] whether to wait may be answered that there is nothing
    /// to wait for, and then wait for something else without end: the frame drains at any time.
    pub async fn drained(&mut self) {
        while !self.is_empty() && !self.passage.is_closed.load(Ordering::Acquire) {
            self.passage.changed.notified().await;
        }
        if self.passage.is_closed.load(Ordering::Acquire) {
            // A session that sends frame after frame would never let its task see the end.
            yield_now().await;
        }
    }
}

impl Passage {
    pub(crate) fn new(metrics: Arc<Metrics>) -> Self {
        Self {
            state: AtomicU8::new(EMPTY),
            is_closed: AtomicBool::new(false),
            parts: AtomicU64::new(0),
            rest: Mutex::default(),
            changed: Notify::new(),
            metrics,
            sink: OnceLock::new(),
        }
    }

    /// The stream has written all bytes that it was given.
    pub(crate) fn flushed(self: &Arc<Self>) {
        if self.state.load(Ordering::Acquire) != ENCRYPTED {
            return;
        }
        if let Some(rest) = locked(&self.rest, Option::take) {
            self.send_part(rest);
        } else {
            self.state.store(EMPTY, Ordering::Release);
            self.changed.notify_one();
        }
    }

    /// Nothing can be sent any more.
    pub(crate) fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
        locked(&self.rest, Option::take);
        self.changed.notify_one();
    }

    /// The number of parts of frames so far.
    pub(crate) fn parts(&self) -> u64 {
        self.parts.load(Ordering::Acquire)
    }

    /// Whether a part of a frame waits for the client's window.
    pub(crate) fn is_waiting(&self) -> bool {
        self.state.load(Ordering::Acquire) == QUEUED
    }

    fn is_empty(&self) -> bool {
        self.state.load(Ordering::Acquire) == EMPTY
    }

    /// Sends the first part of a frame, and keeps the others.
    fn send_part(self: &Arc<Self>, mut frame: Frame) {
        let Some(sink) = self.sink.get() else { return };
        let rest = frame.split_off(PART);
        locked(&self.rest, |kept| *kept = rest);
        self.state.store(QUEUED, Ordering::Release);
        self.parts.fetch_add(1, Ordering::AcqRel);
        sink(Bytes::from_owner(Part { frame, passage: self.clone() }));
    }
}

/// The bytes of a frame or of a part of it, which are counted as long as they are kept.
struct Frame {
    bytes: Vec<u8>,
    metrics: Arc<Metrics>,
}

impl Frame {
    fn new(bytes: Vec<u8>, metrics: Arc<Metrics>) -> Self {
        metrics.held.inc_by(bytes.capacity() as i64);
        Self { bytes, metrics }
    }

    /// Splits off what is behind the first `count` bytes, if anything is. Both have memory of their
    /// own, so that a part which has left takes none.
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

/// A part of a frame. It is dropped when it is encrypted.
struct Part {
    frame: Frame,
    passage: Arc<Passage>,
}

impl AsRef<[u8]> for Part {
    fn as_ref(&self) -> &[u8] {
        &self.frame.bytes
    }
}

impl Drop for Part {
    fn drop(&mut self) {
        self.passage.state.store(ENCRYPTED, Ordering::Release);
    }
}

/// Polls a future once, regardless of the task's budget.
fn at_once<T>(future: impl Future<Output = T>) -> Option<T> {
    match pin!(unconstrained(future)).poll(&mut Context::from_waker(Waker::noop())) {
        Poll::Ready(value) => Some(value),
        Poll::Pending => None,
    }
}
