//! Takes the terminal and restores its previous state.
//!
//! The session, the panic hook and the thread that handles signals share a guard. The first of them to end gives
//! the terminal back, and the others do nothing.
//!
//! Rejected: restoring a part of the state in each of them. A mode that is pushed or popped twice is worse than a
//! mode that is not.

use std::any::Any;
use std::fmt;
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, Once, PoisonError};
use std::time::{Duration, Instant};

use crossterm::terminal::LeaveAlternateScreen;
use ratatui::layout::Size;

use super::error::TerminalErrorKind;
use super::input::{Answer, Decoder, TerminalInput};
use super::sequence::TerminalChanges;
use super::unix::Device;
use super::{Error, sequence};
use crate::fault::printable;

/// The time within which the terminal must accept the bytes that restore its state.
const WRITE_TIMEOUT: Duration = Duration::from_millis(250);

/// The changes to the terminal's state, and the way to undo them.
#[derive(Debug)]
pub(crate) struct TerminalGuard {
    pub(crate) device: Device,
    begun_at: Instant,
    state: Mutex<TerminalState>,
    given_back: Condvar,
    shutting_down: AtomicBool,
    output_queue: Mutex<OutputQueue>,
    recorder: Option<Mutex<Box<dyn Recorder>>>,
}

#[derive(Debug, Default)]
struct TerminalState {
    taken: bool,
    changes: TerminalChanges,
}

impl TerminalGuard {
    /// A guard for `device`, which the panic hook uses from now on.
    ///
    /// # Errors
    /// If the process already has a guard.
    pub(crate) fn install(
        device: Device,
        recorder: Option<Box<dyn Recorder>>,
    ) -> Result<Arc<Self>, Error> {
        let guard = Arc::new(Self {
            device,
            begun_at: Instant::now(),
            state: Mutex::default(),
            given_back: Condvar::new(),
            shutting_down: AtomicBool::new(false),
            output_queue: Mutex::default(),
            recorder: recorder.map(Mutex::new),
        });
        let mut current = current();
        if current.is_some() {
            return Err(TerminalErrorKind::AlreadyTaken.into());
        }
        *current = Some(Arc::clone(&guard));
        HOOK.call_once(install_hook);
        drop(current);
        Ok(guard)
    }

    /// Gives the terminal back at the end of the session.
    pub(crate) fn uninstall(&self) {
        self.give_back();
        // From here on, panics are handled as before.
        let mut current = current();
        if current.as_ref().is_some_and(|known| std::ptr::eq(Arc::as_ptr(known), self)) {
            *current = None;
        }
    }

    /// Returns true if a recorder receives the sent bytes.
    pub(crate) fn is_recorded(&self) -> bool {
        self.recorder.is_some()
    }

    /// Calls `record` with the recorder of the sent bytes, if there is one.
    pub(crate) fn record(&self, record: impl FnOnce(&mut dyn Recorder)) {
        if let Some(recorder) = &self.recorder {
            record(&mut **recorder.lock().unwrap_or_else(PoisonError::into_inner));
        }
    }

    /// The time since the session began.
    pub(crate) fn now(&self) -> Duration {
        self.begun_at.elapsed()
    }

    /// Takes the terminal, and sets raw mode.
    pub(crate) fn take(&self) -> io::Result<()> {
        let mut state = self.lock();
        self.device.make_raw()?;
        state.taken = true;
        self.output_queue().clear();
        Ok(())
    }

    /// Sets the changes that must be undone.
    pub(crate) fn set_changes(&self, changes: TerminalChanges) {
        self.lock().changes = changes;
    }

    /// Returns true while the terminal is taken, so that the program may write to it.
    pub(crate) fn is_taken(&self) -> bool {
        self.lock().taken
    }

    /// Writes `bytes` after all earlier bytes, as far as the terminal accepts them at once. The rest is [written
    /// later](Self::write_queued). From now on, `changes` must be undone.
    pub(crate) fn write(&self, bytes: &[u8], changes: TerminalChanges) -> io::Result<()> {
        let mut state = self.lock_taken()?;
        state.changes = changes;
        self.record(|recorder| recorder.sent(bytes));
        self.output_queue().send(bytes, &self.device)
    }

    /// Writes the queued bytes, as far as the terminal accepts them at once.
    pub(crate) fn write_queued(&self) -> io::Result<()> {
        let _taken = self.lock_taken()?;
        self.output_queue().write_to(&self.device)
    }

    /// Reads as [`Device::read`] does.
    pub(crate) fn read(&self, buffer: &mut [u8]) -> io::Result<Option<usize>> {
        let _taken = self.lock_taken()?;
        self.device.read(buffer)
    }

    /// Returns true if the terminal has accepted all bytes.
    pub(crate) fn has_written_all(&self) -> bool {
        self.output_queue().is_empty()
    }

    /// Ends all waits for a terminal that is not ready for a frame.
    pub(crate) fn shut_down(&self) {
        self.shutting_down.store(true, Ordering::SeqCst);
    }

    /// Returns true if [`TerminalGuard::shut_down`] was called.
    pub(crate) fn is_shutting_down(&self) -> bool {
        self.shutting_down.load(Ordering::SeqCst)
    }

    /// Gives the terminal back, unless it was given back before. Takes six seconds at most.
    pub(crate) fn give_back(&self) {
        self.give_back_and(|| ());
    }

    /// Gives the terminal back, unless it was given back before, and then calls `end`. Threads that want to write
    /// or read wait until both are done, so that no thread ends the program in another way.
    pub(crate) fn give_back_and(&self, end: impl FnOnce()) {
        let mut state = self.lock();
        if state.taken {
            state.taken = false;
            self.leave(&mut state);
            self.given_back.notify_all();
        }
        end();
    }

    /// Waits until the terminal is given back. Returns true if that happened within `timeout`.
    pub(crate) fn wait_until_given_back(&self, timeout: Duration) -> bool {
        let state = self.lock();
        let waited = self.given_back.wait_timeout_while(state, timeout, |state| state.taken);
        !waited.unwrap_or_else(PoisonError::into_inner).0.taken
    }

    /// Locks the state, or returns an error if the terminal is not taken. Until the lock is released, no thread
    /// gives the terminal back. A thread that only checked before it wrote could write to a terminal that belongs
    /// to the shell again.
    fn lock_taken(&self) -> io::Result<MutexGuard<'_, TerminalState>> {
        let state = self.lock();
        if state.taken {
            Ok(state)
        } else {
            Err(io::Error::other(Error::from(TerminalErrorKind::GivenBack)))
        }
    }

    fn output_queue(&self) -> MutexGuard<'_, OutputQueue> {
        self.output_queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ignores poisoning: a panic during the lock leaves the state consistent.
    fn lock(&self) -> MutexGuard<'_, TerminalState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Undoes all changes, in reverse order. After an error in one step, the others are still tried, because
    /// nothing better can be done.
    fn leave(&self, state: &mut TerminalState) {
        if self.output_queue().withholds(sequence::PUSH_KEY_FLAGS) {
            state.changes.forget_key_flags();
        }
        let text = state.changes.end(self.now());
        let accepted = self.write_within_timeout(&text);
        if !accepted.as_ref().is_ok_and(|&length| length == text.len()) {
            // Discard the frame that the terminal has not accepted, and try again.
            if accepted.is_ok_and(|length| length > 0) {
                state.changes.mark_key_flags_uncertain();
            }
            _ = self.device.discard_output();
            _ = self.write_within_timeout(&state.changes.end_after_loss());
        }
        self.discard_answers(&mut state.changes);
        _ = self.write_within_timeout(&sequence::of(LeaveAlternateScreen));
        self.device.give_back();
    }

    /// Writes `text`, and returns the length of the part that the terminal accepts in time.
    fn write_within_timeout(&self, text: &str) -> io::Result<usize> {
        self.record(|recorder| recorder.sent(text.as_bytes()));
        let deadline = Instant::now() + WRITE_TIMEOUT;
        self.device.write(text.as_bytes(), || Instant::now() < deadline)
    }

    /// Reads until every query is answered, so that the shell receives no answer and no key
    /// release.
    fn discard_answers(&self, changes: &mut TerminalChanges) {
        let mut decoder = Decoder::default();
        let mut buffer = [0; 256];
        while let Some(timeout) = changes.fences.time_left(self.now()) {
            // A signal ends the wait early, and the loop goes on.
            if self.device.wait_for_input(timeout).is_err() {
                return;
            }
            match self.device.read(&mut buffer) {
                Ok(None) => {}
                Ok(Some(0)) | Err(_) => return,
                Ok(Some(count)) => decoder.feed(&buffer[..count], |input| {
                    if input == TerminalInput::Answer(Answer::Fence) {
                        changes.fences.answered();
                    }
                }),
            }
        }
    }
}

/// A recorder of all bytes that a [`Session`](super::Session) sends.
pub trait Recorder: Send {
    /// Records the size of the window. Called once before any bytes, and after each change.
    fn resized(&mut self, size: Size);

    /// Records bytes that are sent to the terminal. They are whole characters and whole sequences.
    fn sent(&mut self, bytes: &[u8]);
}

impl fmt::Debug for dyn Recorder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Recorder")
    }
}

/// Bytes that the terminal has not accepted yet. They are few, because no frame is drawn while any are waiting.
#[derive(Debug, Default)]
struct OutputQueue {
    bytes: Vec<u8>,
    /// The number of accepted bytes.
    taken: usize,
}

impl OutputQueue {
    /// Writes `bytes` after the waiting ones, as far as `device` accepts them at once. Keeps the rest.
    fn send(&mut self, bytes: &[u8], device: &Device) -> io::Result<()> {
        if self.is_empty() {
            let accepted = device.write_some(bytes);
            if !accepted.as_ref().is_ok_and(|&count| count == bytes.len()) {
                self.bytes.extend_from_slice(bytes);
                self.taken = accepted?;
            }
            return Ok(());
        }
        self.bytes.extend_from_slice(bytes);
        self.write_to(device)
    }

    /// Writes the waiting bytes, as far as `device` accepts them at once.
    fn write_to(&mut self, device: &Device) -> io::Result<()> {
        self.taken += device.write_some(&self.bytes[self.taken..])?;
        if self.taken == self.bytes.len() {
            self.clear();
        }
        Ok(())
    }

    /// Returns true if `sequence` is among the bytes and the device has not accepted all of it.
    fn withholds(&self, sequence: &str) -> bool {
        let mut places = self.bytes.windows(sequence.len());
        let last = places.rposition(|bytes| bytes == sequence.as_bytes());
        last.is_some_and(|place| place + sequence.len() > self.taken)
    }

    fn is_empty(&self) -> bool {
        self.bytes.is_empty()
    }

    fn clear(&mut self) {
        self.bytes.clear();
        self.taken = 0;
    }
}

/// The guard of the current session. It belongs to the process and not to the session, because the hook runs in all
/// threads.
static CURRENT: Mutex<Option<Arc<TerminalGuard>>> = Mutex::new(None);
static HOOK: Once = Once::new();

/// Installs a panic hook that gives the terminal back before the message is printed. It calls the previous hook for
/// panics outside of sessions. The hook is never removed, because that would also remove a hook installed after it.
fn install_hook() {
    let outside = panic::take_hook();
    panic::set_hook(Box::new(move |info| match current().clone() {
        Some(guard) => {
            guard.give_back();
            report(info);
        }
        None => outside(info),
    }));
}

/// Prints the panic as one sentence. If standard error is closed, nothing can be reported.
fn report(info: &PanicHookInfo) {
    let message = printable(message(info.payload()));
    _ = match info.location() {
        Some(place) => writeln!(
            io::stderr(),
            "This program has a bug and had to stop: {message} (at {}:{}).",
            place.file(),
            place.line()
        ),
        None => writeln!(io::stderr(), "This program has a bug and had to stop: {message}."),
    };
}

fn message(payload: &dyn Any) -> &str {
    payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("it does not say which")
}

fn current() -> MutexGuard<'static, Option<Arc<TerminalGuard>>> {
    CURRENT.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sequence_is_withheld_until_all_of_it_is_accepted() {
        let mut queue = OutputQueue::default();
        assert!(!queue.withholds("flags"));
        queue.bytes.extend_from_slice(b"frame flags frame");
        for (taken, withheld) in [(0, true), (6, true), (10, true), (11, false), (17, false)] {
            queue.taken = taken;
            assert_eq!(queue.withholds("flags"), withheld, "{taken} bytes");
        }
        queue.bytes.extend_from_slice(b" flags");
        assert!(queue.withholds("flags"));
        assert!(!queue.withholds("other"));
    }
}
