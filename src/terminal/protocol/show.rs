//! Turns frames into bytes: when, at which fidelity, and with which request after them.

use std::time::Duration;

use ratatui::backend::Backend;

use super::{Drawn, Protocol};
use crate::terminal::flow::Request;
use crate::terminal::{Fidelity, Screen, sequence};

/// The byte that rings the bell.
const BELL: u8 = 0x07;

impl Protocol {
    /// Draws a frame on a blank screen. The changes since the last frame are added to the
    /// [output](Protocol::output).
    pub fn draw(&mut self, render: impl FnOnce(&mut Screen)) {
        let fidelity = self.fidelity();
        self.writer.set_fidelity(fidelity);
        self.writer.draw_frame(render);
        self.drawn = Some(Drawn::Motion(fidelity));
    }

    /// Shows the last frame more exactly, unless it is exact.
    pub fn refine(&mut self) {
        self.writer.refine();
        self.drawn = Some(Drawn::Refinement);
    }

    /// Rings the terminal's bell with the next frame.
    pub fn ring_bell(&mut self) {
        self.writer.output_mut().push(BELL);
    }

    /// Whether the terminal shows exactly the last frame drawn. If it does not, a few calls of
    /// [`Protocol::refine`] make it exact.
    pub fn is_settled(&self) -> bool {
        self.writer.is_settled()
    }

    /// Whether a frame would be shown at once, not behind others in flight.
    pub fn is_ready(&self, now: Duration) -> bool {
        self.output.is_empty() && self.flow.may_send(now)
    }

    /// Sets the fidelity of frames of motion; `None` for the best that the link allows.
    pub fn set_fidelity(&mut self, fidelity: Option<Fidelity>) {
        self.fidelity = fidelity;
    }

    /// Sets whether frames are restricted to ASCII. If that changes, the next one is sent whole.
    pub fn set_ascii(&mut self, is_ascii: bool) {
        if self.options.is_ascii != is_ascii {
            self.options.is_ascii = is_ascii;
            self.writer.set_ascii(is_ascii);
        }
    }

    /// The present fidelity of frames of motion.
    pub fn fidelity(&self) -> Fidelity {
        self.fidelity.unwrap_or_else(|| self.flow.fidelity())
    }

    /// Whether a network makes frames of motion coarser than necessary; `ssh -C` then helps if it
    /// is not in use.
    pub fn is_limited_by_network(&self) -> bool {
        self.options.is_remote && self.fidelity.is_none() && self.flow.fidelity() > Fidelity::EXACT
    }

    /// The round-trip time of the terminal's latest answer; `None` if the terminal does not answer.
    pub fn round_trip(&self) -> Option<Duration> {
        self.flow.round_trip()
    }

    /// The number of frames sent so far. One that changed nothing does not count.
    pub fn frames_sent(&self) -> u64 {
        self.flow.frames_sent()
    }

    /// The number of frames that the terminal shows, as far as is known: those that it has answered,
    /// or if it never answers, those that the system has accepted.
    pub fn frames_answered(&self) -> u64 {
        self.flow.frames_answered()
    }

    /// The number of bytes of all frames.
    pub fn bytes_drawn(&self) -> u64 {
        self.writer.bytes_written()
    }

    /// The time at which to check again whether a frame may be sent, even if nothing arrives before
    /// then; `None` for never.
    pub(crate) fn opens_at(&self) -> Option<Duration> {
        self.flow.opens_at()
    }

    /// Sends a fence alone after a timeout, to learn whether the terminal is still there.
    pub(crate) fn probe(&mut self, now: Duration) {
        if self.output.is_empty() && self.flow.probe_is_due(now) {
            self.queue_queries("", now);
        }
    }

    /// Adds `queries` with a fence after them to the output.
    pub(crate) fn queue_queries(&mut self, queries: &str, now: Duration) {
        self.flow.sent(now, 0, Request::Fence);
        self.output.extend_from_slice(queries.as_bytes());
        self.queue_fence(now);
    }

    /// Moves the bytes of the drawn frame to the output, with a request after them. Nothing is added
    /// after a frame of no bytes.
    pub(crate) fn queue_frame(&mut self, now: Duration) {
        let Some(drawn) = self.drawn.take() else { return };
        // The writer writes only to memory, so that nothing can fail.
        _ = Backend::flush(&mut self.writer);
        let frame = self.writer.output_mut();
        let bytes = frame.len();
        if bytes > 0 {
            if self.output.is_empty() {
                // The memory of the frame leaves with it.
                std::mem::swap(&mut self.output, frame);
            } else {
                self.output.append(frame);
            }
            self.queue_request(bytes, now);
        }
        if let Drawn::Motion(fidelity) = drawn {
            self.flow.sent_motion(bytes, fidelity);
        }
    }

    /// Adds the request after a frame of this number of bytes.
    fn queue_request(&mut self, bytes: usize, now: Duration) {
        let request = self.flow.request(now);
        match request {
            Request::Nothing => {}
            Request::Status => self.output.extend_from_slice(sequence::QUERY_STATUS.as_bytes()),
            Request::Fence => self.queue_fence(now),
        }
        self.flow.sent(now, bytes, request);
        self.changes.awaits_statuses = self.flow.awaits_answers();
    }

    fn queue_fence(&mut self, now: Duration) {
        self.output.extend_from_slice(sequence::QUERY_FENCE.as_bytes());
        self.changes.fences.sent(now);
    }
}
