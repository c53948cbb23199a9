//! Sends frames, as soon as the terminal is ready for them.

use std::io;
use std::time::Duration;

use super::Session;
use crate::terminal::{Error, Fidelity, Screen};

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
        self.protocol.ring_bell();
    }

    /// Whether the terminal shows exactly the last frame drawn. If it does not, a few calls of
    /// [`Session::refine`] make it exact.
    pub fn is_settled(&self) -> bool {
        self.protocol.is_settled()
    }

    /// Whether a frame would be shown at once, not behind others in flight. If it would not,
    /// [`Event::Ready`](crate::terminal::Event::Ready) follows.
    pub fn is_ready(&mut self) -> bool {
        let is_ready = self.may_send();
        self.awaits_readiness = !is_ready;
        is_ready
    }

    /// The present fidelity of frames of motion.
    pub fn fidelity(&self) -> Fidelity {
        self.protocol.fidelity()
    }

    /// Whether a network makes frames of motion coarser than necessary; `ssh -C` then helps if it
    /// is not in use.
    pub fn is_limited_by_network(&self) -> bool {
        self.protocol.is_limited_by_network()
    }

    /// The round-trip time of the terminal's latest answer; `None` if the terminal does not answer.
    pub fn round_trip(&self) -> Option<Duration> {
        self.protocol.round_trip()
    }

    /// The number of bytes written for frames.
    pub fn bytes_written(&self) -> u64 {
        self.protocol.bytes_drawn()
    }

    fn try_draw(&mut self, render: impl FnOnce(&mut Screen)) -> io::Result<()> {
        if self.wait_until_ready()? {
            self.protocol.draw(render);
            self.send()?;
        }
        Ok(())
    }

    fn try_refine(&mut self) -> io::Result<()> {
        if self.wait_until_ready()? {
            self.protocol.refine();
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
    pub(crate) fn is_ending(&self) -> bool {
        self.guard.is_shutting_down() || self.protocol.is_asked_to_quit()
    }

    fn may_send(&self) -> bool {
        self.guard.has_written_all() && self.protocol.is_ready(self.guard.now())
    }

    /// The time at which to check again whether a frame may be sent, even without an event before
    /// then; `None` for never.
    pub(crate) fn opens_at(&self) -> Option<Duration> {
        if self.guard.has_written_all() { self.protocol.opens_at() } else { None }
    }

    /// Sends a fence alone after a timeout, to learn whether the terminal is still there.
    pub(crate) fn probe(&mut self) -> io::Result<()> {
        if self.guard.has_written_all() {
            self.protocol.probe(self.guard.now());
            self.send()?;
        }
        Ok(())
    }

    /// Sends the output of the protocol, as far as the terminal accepts it at once.
    pub(crate) fn send(&mut self) -> io::Result<()> {
        let now = self.guard.now();
        self.protocol.queue_frame(now);
        let changes = self.protocol.changes();
        let output = self.protocol.output(now);
        if output.is_empty() {
            self.guard.set_changes(changes);
            return Ok(());
        }
        let written = self.guard.write(output, changes);
        output.clear();
        written?;
        self.update_written();
        Ok(())
    }

    /// Sends the bytes that the terminal has not accepted yet.
    pub(crate) fn send_queued(&mut self) -> io::Result<()> {
        self.guard.write_queued()?;
        self.update_written();
        Ok(())
    }

    fn update_written(&mut self) {
        if self.guard.has_written_all() {
            self.protocol.written(self.guard.now());
        }
    }
}
