//! The one frame on its way to a visitor.
//!
//! A frame has drained when the socket has accepted its last byte, so a session encodes a frame only
//! when the last one has left, and a client that does not read holds the memory of one frame. russh
//! keeps the bytes of a frame until the client's window has room for them, and drops them once they
//! are encrypted; the next flush of the stream then says that they were written. Counting encrypted
//! bytes was refused: compression changes their number.

use std::future::Future;
use std::pin::pin;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::task::{Context, Poll, Waker};

use bytes::Bytes;
use russh::ChannelId;
use russh::server::Handle;
use tokio::sync::Notify;
use tokio::task::unconstrained;

use super::Counters;

/// The place for one frame. The next one has room when the last has drained.
#[derive(Debug)]
pub struct Outbox {
    handle: Handle,
    channel: ChannelId,
    passage: Arc<Passage>,
}

/// The state of the frame, which the outbox, the frame and the stream share.
#[derive(Debug, Default)]
pub(super) struct Passage {
    state: AtomicU8,
    /// Nothing can be sent any more.
    is_closed: AtomicBool,
    /// The number of frames so far.
    frames: AtomicU64,
    changed: Notify,
    counters: OnceLock<Arc<Counters>>,
}

const EMPTY: u8 = 0;
/// The frame waits for the client's window.
const QUEUED: u8 = 1;
/// The frame is encrypted, and not yet written.
const ENCRYPTED: u8 = 2;

impl Outbox {
    pub(super) fn new(handle: Handle, channel: ChannelId, passage: Arc<Passage>) -> Self {
        Self { handle, channel, passage }
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
        let frame = self.passage.frame(frame);
        // The queue has room: at most one frame and the three messages of the end are in it.
        _ = at_once(self.handle.data(self.channel, Bytes::from_owner(frame)));
        Ok(())
    }

    /// Waits until the last frame has drained, or the link has ended.
    ///
    /// It may be dropped before it is ready.
    pub async fn drained(&mut self) {
        while !self.is_empty() && !self.passage.is_closed.load(Ordering::Acquire) {
            self.passage.changed.notified().await;
        }
    }
}

impl Passage {
    pub(super) fn new(counters: Arc<Counters>) -> Self {
        Self { counters: OnceLock::from(counters), ..Self::default() }
    }

    /// The stream has written all bytes that it was given.
    pub(super) fn flushed(&self) {
        let written =
            self.state.compare_exchange(ENCRYPTED, EMPTY, Ordering::AcqRel, Ordering::Acquire);
        if written.is_ok() {
            self.changed.notify_one();
        }
    }

    /// Nothing can be sent any more.
    pub(super) fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
        self.changed.notify_one();
    }

    /// The number of frames so far.
    pub(super) fn frames(&self) -> u64 {
        self.frames.load(Ordering::Acquire)
    }

    /// Whether a frame waits for the client's window.
    pub(super) fn is_waiting(&self) -> bool {
        self.state.load(Ordering::Acquire) == QUEUED
    }

    fn is_empty(&self) -> bool {
        self.state.load(Ordering::Acquire) == EMPTY
    }

    fn frame(self: &Arc<Self>, bytes: Vec<u8>) -> Frame {
        self.state.store(QUEUED, Ordering::Release);
        self.frames.fetch_add(1, Ordering::AcqRel);
        if let Some(counters) = self.counters.get() {
            counters.held.fetch_add(bytes.capacity(), Ordering::Relaxed);
            counters.frames.fetch_add(1, Ordering::Relaxed);
            counters.frame_bytes.fetch_add(bytes.len() as u64, Ordering::Relaxed);
        }
        Frame { bytes, passage: self.clone() }
    }
}

/// The bytes of a frame. They are dropped when they are encrypted.
struct Frame {
    bytes: Vec<u8>,
    passage: Arc<Passage>,
}

impl AsRef<[u8]> for Frame {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        if let Some(counters) = self.passage.counters.get() {
            counters.held.fetch_sub(self.bytes.capacity(), Ordering::Relaxed);
        }
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
