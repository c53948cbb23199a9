//! Showing frames: when, how exactly, and what that takes.

use std::io;
use std::time::{Duration, Instant};

use ratatui::backend::Backend;

use super::Session;
use crate::terminal::flow::Request;
use crate::terminal::{Error, Event, Fidelity, Screen, sequence};

impl Session {
    /// Draws a frame on a blank screen, and sends what has changed since the last one. Where the terminal is not
    /// [ready](Self::is_ready) for it, waits until it is, unless the program is asked to end:
    /// then the frame is dropped, and the event that says so comes next.
    ///
    /// # Errors
    /// Where the terminal cannot be written to, or a panic in another thread has given it back.
    pub fn draw(&mut self, render: impl FnOnce(&mut Screen)) -> Result<(), Error> {
        let drawn = self.try_draw(render);
        self.unless_hurried(drawn)
    }

    /// Shows the last frame more exactly, if it is not shown exactly. Waits as [`Session::draw`].
    ///
    /// # Errors
    /// As [`Session::draw`].
    pub fn refine(&mut self) -> Result<(), Error> {
        let refined = self.try_refine();
        self.unless_hurried(refined)
    }

    /// Whether the terminal shows exactly what was drawn last. Where it does not, a few calls of
    /// [`Session::refine`] make it.
    pub fn is_settled(&self) -> bool {
        self.writer.is_settled()
    }

    /// Whether a frame that is drawn now is shown soon, rather than behind others that are still on
    /// their way. Where it is not, [`Event::Ready`] comes when it is.
    pub fn is_ready(&mut self) -> bool {
        let is_ready = self.may_send();
        self.awaits_readiness = !is_ready;
        is_ready
    }

    /// How exact a frame of motion is at present.
    pub fn fidelity(&self) -> Fidelity {
        self.fidelity.unwrap_or_else(|| self.flow.fidelity())
    }

    /// Whether a network makes frames of motion coarser than they need to be; `ssh -C` helps then, if it is
    /// not in use.
    pub fn is_limited_by_network(&self) -> bool {
        self.is_remote && self.fidelity.is_none() && self.flow.fidelity() > Fidelity::EXACT
    }

    /// How long the terminal has taken to answer of late; `None` where it does not.
    pub fn round_trip(&self) -> Option<Duration> {
        self.flow.round_trip()
    }

    /// How many bytes all frames together have taken.
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

    fn unless_hurried(&self, done: io::Result<()>) -> Result<(), Error> {
        match done {
            Ok(()) => Ok(()),
            // To report this on standard error could take for ever: it leads to the same terminal.
            Err(_) if self.guard.is_hurried() => Ok(()),
            Err(error) => Err(Error::while_doing("drawing a frame")(error)),
        }
    }

    /// Whether it is; not where the program is to end meanwhile.
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
        self.guard.is_hurried() || self.events.iter().any(is_quit)
    }

    fn may_send(&self) -> bool {
        self.guard.has_written_all() && self.flow.may_send(self.now())
    }

    /// When a frame may be sent even if nothing happens until then; `None` for never.
    pub(super) fn opens_at(&self) -> Option<Instant> {
        let time = if self.guard.has_written_all() { self.flow.opens_at() } else { None };
        time.map(|time| self.begun_at + time)
    }

    /// Sends what has been written, if anything has, and tells how many bytes that is.
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
        self.note_what_is_taken();
        Ok(bytes)
    }

    /// Asks whether anybody is there, where an answer is overdue.
    pub(super) fn probe(&mut self) -> io::Result<()> {
        if self.guard.has_written_all() && self.flow.probe_is_due(self.now()) {
            self.send_queries("")?;
        }
        Ok(())
    }

    /// Asks `queries`, and sends a fence after them.
    pub(super) fn send_queries(&mut self, queries: &str) -> io::Result<()> {
        self.flow.sent(self.now(), 0, Request::Fence);
        self.guard.ask(queries)
    }

    /// Sends what the terminal has not taken yet.
    pub(super) fn send_rest(&mut self) -> io::Result<()> {
        self.guard.write_rest()?;
        self.note_what_is_taken();
        Ok(())
    }

    fn note_what_is_taken(&mut self) {
        if self.guard.has_written_all() {
            self.flow.written(self.now());
        }
    }

    /// The time for the flow, which has no clock.
    pub(super) fn now(&self) -> Duration {
        self.begun_at.elapsed()
    }
}
