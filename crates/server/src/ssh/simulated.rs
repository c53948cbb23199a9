//! Links without a network, for simulations.
//!
//! The far end of a pipe acts like a connection: it passes input on, takes the parts of frames one at a time,
//! and reports when each was written.

use std::sync::{Arc, Weak};

use bytes::Bytes;
use tokio::sync::mpsc::{UnboundedReceiver, unbounded_channel};

use super::Link;
use super::inbound::{InboundSender, inbound};
use super::outbox::{FrameProgress, Outbox};
use super::wire::ByteLimits;
use crate::config::Config;
use crate::metrics::Metrics;
use cellcaster::terminal::WindowSize;

/// The client's end of a pipe. Clones refer to the same end.
#[derive(Clone)]
pub(crate) struct ClientEnd {
    inlet: InboundSender,
    progress: Weak<FrameProgress>,
}

/// The output of a session.
pub(crate) struct Parts {
    parts: UnboundedReceiver<Bytes>,
    progress: Weak<FrameProgress>,
}

/// A link, its far end, and its output. `metrics` counts the frames.
pub(crate) fn pipe(metrics: Arc<Metrics>) -> (Link, ClientEnd, Parts) {
    let progress = Arc::new(FrameProgress::new(metrics));
    let (sender, parts) = unbounded_channel();
    let limits = ByteLimits { before_login: 0, per_second: Config::default().bytes_per_second };
    let (inlet, inbound) = inbound(limits);
    let [for_end, for_parts] = [(); 2].map(|()| Arc::downgrade(&progress));
    let link = Link { inbound, outbox: Outbox::into(move |part| _ = sender.send(part), progress) };
    (link, ClientEnd { inlet, progress: for_end }, Parts { parts, progress: for_parts })
}

impl ClientEnd {
    /// Sends bytes. Waits while the session does not take them.
    pub(crate) async fn send(&self, bytes: &[u8]) {
        self.inlet.bytes(bytes).await;
    }

    pub(crate) fn resize(&self, size: WindowSize) {
        self.inlet.resize(size);
    }

    pub(crate) fn drain(&self) {
        self.inlet.drain();
    }

    /// Ends the link: nothing more arrives, and nothing can be sent.
    pub(crate) fn end(&self) {
        if let Some(progress) = self.progress.upgrade() {
            progress.close();
        }
        self.inlet.end();
    }
}

impl Parts {
    /// Waits for the next part of a frame; `None` after the end of the session. Call [`Parts::written`]
    /// afterwards to tell the session that the part was sent.
    pub(crate) async fn next(&mut self) -> Option<Bytes> {
        self.parts.recv().await
    }

    /// Reports that the last part was written. It must have been dropped.
    pub(crate) fn written(&self) {
        if let Some(progress) = self.progress.upgrade() {
            progress.flushed();
        }
    }
}
