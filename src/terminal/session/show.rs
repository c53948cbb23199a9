//! Sends frames: when, at which fidelity, and in how many bytes.

use std::io;
use std::time::{Duration, Instant};

use ratatui::backend::Backend;

use super::Session;
use crate::terminal::flow::Request;
use crate::terminal::{Error, Event, Fidelity, Screen, sequence};

/// The byte that rings the bell.
const BELL: u8 = 0x07;

impl Session {
    /// Draws a frame on a blank screen and sends the changes since the last one. Waits until the
    /// terminal is [ready](Self::is_ready) for it. If the program must end during the wait, the
    /// frame is dropped and the next event says so.
    ///
    /// # Errors
    /// If a write to the terminal fails, or a panic in another thread has given the terminal back.
    pub fn draw(&mut self, render: impl FnOnce(&mut Screen)) -> Result<(), Error> {
        let drawn = self.try_draw(render);
        self.unless_shutting_down(drawn)
    }

    /// Shows the last frame more exactly, unless it is exact. Waits as [`Session::draw`] does.
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn refine(&mut self) -> Result<(), Error> {
        let refined = self.try_refine();
        self.unless_shutting_down(refined)
    }

    /// Rings the terminal's bell with the next frame.
    pub fn ring_bell(&mut self) {
        self.writer.output_mut().push(BELL);
    }

    /// Whether the terminal shows exactly the last frame drawn. If it does not, a few calls of
    /// [`Session::refine`] make it exact.
    pub fn is_settled(&self) -> bool {
        self.writer.is_settled()
    }

    /// Whether a frame would be shown at once, not behind others in flight. If it would not,
    /// [`Event::Ready`] follows.
    pub fn is_ready(&mut self) -> bool {
        let is_ready = self.may_send();
        self.awaits_readiness = !is_ready;
        is_ready
    }

    /// The present fidelity of frames of motion.
    pub fn fidelity(&self) -> Fidelity {
        self.fidelity.unwrap_or_else(|| self.flow.fidelity())
    }

    /// Whether a network makes frames of motion coarser than necessary; `ssh -C` then helps if it
    /// is not in use.
    pub fn is_limited_by_network(&self) -> bool {
        self.is_remote && self.fidelity.is_none() && self.flow.fidelity() > Fidelity::EXACT
    }

    /// The round-trip time of the terminal's latest answer; `None` if the terminal does not answer.
    pub fn round_trip(&self) -> Option<Duration> {
        self.flow.round_trip()
    }

    /// The number of bytes written for frames.
    pub fn bytes_written(&self) -> u64 {
        self.writer.bytes_written()
    }

    fn try_draw(&mut self, render: impl FnOnce(&mut Screen)) -> io::Result<()> {
        if self.wait_until_ready()? {
            let fidelity = self.fidelity();
            self.writer.set_fidelity(fidelity);
            self.writer.draw_frame(render);
            Backend::flush(&mut self.writer)?;
            let bytes = self.send()?;
            self.flow.sent_motion(bytes, fidelity);
        }
        Ok(())
    }

    fn try_refine(&mut self) -> io::Result<()> {
        if self.wait_until_ready()? {
            self.writer.refine();
            Backend::flush(&mut self.writer)?;
            self.send()?;
        }
        Ok(())
    }

    fn unless_shutting_down(&self, done: io::Result<()>) -> Result<(), Error> {
        match done {
            Ok(()) => Ok(()),
            // Standard error leads to the same terminal, which may never accept a message.
            Err(_) if self.guard.is_shutting_down() => Ok(()),
            Err(error) => Err(Error::while_doing("drawing a frame")(error)),
        }
    }

    /// Waits until a frame may be sent; returns `false` if the program must end instead.
    fn wait_until_ready(&mut self) -> io::Result<bool> {
        while !self.may_send() {
            if self.is_ending() {
                return Ok(false);
            }
            self.probe()?;
            self.receive(self.opens_at())?;
        }
        Ok(true)
    }

    /// Whether the program has been asked to end.
    pub(super) fn is_ending(&self) -> bool {
        let is_quit = |event: &Event| matches!(event, Event::Quit(_));
        self.guard.is_shutting_down() || self.events.iter().any(is_quit)
    }

    fn may_send(&self) -> bool {
        self.guard.has_written_all() && self.flow.may_send(self.now())
    }

    /// The time at which to check again whether a frame may be sent, even without an event before
    /// then; `None` for never.
    pub(super) fn opens_at(&self) -> Option<Instant> {
        let time = if self.guard.has_written_all() { self.flow.opens_at() } else { None };
        time.map(|time| self.begun_at + time)
    }

    /// Sends the bytes of the frame and returns their number, which may be zero.
    fn send(&mut self) -> io::Result<usize> {
        let now = self.now();
        let frame = self.writer.output_mut();
        let bytes = frame.len();
        if bytes == 0 {
            return Ok(0);
        }
        let request = self.flow.request(now);
        match request {
            Request::Nothing => {}
            Request::Status => frame.extend_from_slice(sequence::QUERY_STATUS.as_bytes()),
            Request::Fence => {
                frame.extend_from_slice(sequence::QUERY_FENCE.as_bytes());
                self.guard.fence_sent();
            }
        }
        let written = self.guard.write(frame);
        frame.clear();
        self.flow.sent(now, bytes, request);
        self.guard.await_statuses(self.flow.awaits_answers());
        written?;
        self.update_written();
        Ok(bytes)
    }

    /// Sends a fence alone after a timeout, to learn whether the terminal is still there.
    pub(super) fn probe(&mut self) -> io::Result<()> {
        if self.guard.has_written_all() && self.flow.probe_is_due(self.now()) {
            self.send_queries("")?;
        }
        Ok(())
    }

    /// Sends `queries` with a fence after them.
    pub(super) fn send_queries(&mut self, queries: &str) -> io::Result<()> {
        self.flow.sent(self.now(), 0, Request::Fence);
        self.guard.ask(queries)
    }

    /// Sends the bytes that the terminal has not accepted yet.
    pub(super) fn send_queued(&mut self) -> io::Result<()> {
        self.guard.write_queued()?;
        self.update_written();
        Ok(())
    }

    fn update_written(&mut self) {
        if self.guard.has_written_all() {
            self.flow.written(self.now());
        }
    }

    /// The present time, for flow control, which has no clock.
    pub(super) fn now(&self) -> Duration {
        self.begun_at.elapsed()
    }
}
