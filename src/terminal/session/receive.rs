//! Receives input and signals.

use std::io;
use std::time::Duration;

use super::Session;
use crate::terminal::platform::Signal;
use crate::terminal::{Event, QuitReason};

/// Whether input or a signal arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Received {
    Something,
    Nothing,
}

impl Session {
    /// Whether an event for which `is_such` holds has arrived and was not returned yet. Does not wait. After
    /// an error, which [`Session::next_event`] returns, it is `true`.
    pub fn has_event(&mut self, is_such: impl Fn(&Event) -> bool) -> bool {
        self.receive(Some(Duration::ZERO)).is_err() || self.protocol.has_event(is_such)
    }

    /// Waits until `wake_at` for input, signals, or room for bytes.
    pub(crate) fn receive(&mut self, wake_at: Option<Duration>) -> io::Result<Received> {
        let timeout = wake_at.map(|time| time.saturating_sub(self.guard.now()));
        let has_queued = !self.guard.has_written_all();
        let ready = self.guard.device().wait(&self.signals, has_queued, timeout)?;
        if ready.signals {
            self.receive_signals()?;
        }
        if ready.input {
            self.receive_input()?;
        }
        if ready.output && !self.is_ending() {
            self.send_queued()?;
        }
        let something = ready.input || ready.signals || ready.output;
        Ok(if something { Received::Something } else { Received::Nothing })
    }

    fn receive_signals(&mut self) -> io::Result<()> {
        for signal in self.signals.take() {
            match signal {
                Signal::Resized => {
                    let size = self.measured();
                    self.protocol.resize(size, self.guard.now());
                }
                Signal::Suspend => self.protocol.push_event(Event::Suspend),
                Signal::Continued => {
                    // SIGSTOP cannot be caught, so the terminal was not given back.
                    self.guard.device().make_raw()?;
                    let size = self.measured();
                    self.protocol.repaint(size);
                }
                Signal::Quit(reason) => self.protocol.push_event(Event::Quit(reason)),
            }
        }
        self.send()
    }

    fn receive_input(&mut self) -> io::Result<()> {
        let mut buffer = [0; 1024];
        let Some(count) = self.guard.read(&mut buffer)? else { return Ok(()) };
        if count == 0 {
            self.protocol.push_event(Event::Quit(QuitReason::InputClosed));
            return Ok(());
        }
        self.protocol.receive(&buffer[..count], self.guard.now());
        self.send()
    }
}
