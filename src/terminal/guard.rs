//! Takes the terminal and restores its previous state.
//!
//! The session, the panic hook and the thread that handles signals share a guard. The first of them
//! that ends gives the terminal back, and the others do nothing. Restoring a part of the state in
//! each was refused: a mode that is pushed or popped twice is worse than neither.

mod output_queue;
mod panic_hook;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crossterm::terminal::LeaveAlternateScreen;

use self::output_queue::OutputQueue;
use super::Error;
use super::input::{Answer, Decoder, Input};
use super::platform::Device;
use super::protocol::Changes;
use super::recorder::{Recorder, Recording};
use super::sequence;

/// The time that a terminal has to accept the bytes that restore its state.
const WRITE_TIMEOUT: Duration = Duration::from_millis(250);

/// The changes to the terminal's state, and the way to undo them.
#[derive(Debug)]
pub(crate) struct Guard {
    device: Device,
    begun_at: Instant,
    state: Mutex<State>,
    given_back: Condvar,
    shutting_down: AtomicBool,
    output_queue: Mutex<OutputQueue>,
    recording: Mutex<Recording>,
}

#[derive(Debug, Default)]
struct State {
    taken: bool,
    changes: Changes,
}

impl Guard {
    /// A guard of `device`, which the panic hook uses from now on.
    ///
    /// # Errors
    /// If the process has a guard already.
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
            recording: Mutex::new(Recording::by(recorder)),
        });
        panic_hook::protect(&guard)?;
        Ok(guard)
    }

    /// Gives the terminal back at the end of the session.
    pub(crate) fn uninstall(&self) {
        self.give_back();
        panic_hook::release(self);
    }

    pub(crate) fn device(&self) -> &Device {
        &self.device
    }

    /// The recorder of the sent bytes.
    pub(crate) fn recording(&self) -> MutexGuard<'_, Recording> {
        self.recording.lock().unwrap_or_else(PoisonError::into_inner)
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

    /// Sets what must be undone.
    pub(crate) fn set_changes(&self, changes: Changes) {
        self.lock().changes = changes;
    }

    /// Whether the terminal is taken, so that the program may write to it.
    pub(crate) fn is_taken(&self) -> bool {
        self.lock().taken
    }

    /// Writes `bytes` after all earlier bytes, as far as the terminal accepts them at once. The
    /// rest is [written later](Self::write_queued). After them, `changes` must be undone.
    pub(crate) fn write(&self, bytes: &[u8], changes: Changes) -> io::Result<()> {
        let mut state = self.lock_taken()?;
        state.changes = changes;
        self.recording().sent(bytes);
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

    /// Whether the terminal has accepted all bytes.
    pub(crate) fn has_written_all(&self) -> bool {
        self.output_queue().is_empty()
    }

    /// Makes all functions stop waiting for a terminal that is not ready for a frame.
    pub(crate) fn shut_down(&self) {
        self.shutting_down.store(true, Ordering::SeqCst);
    }

    /// Whether [`Guard::shut_down`] was called.
    pub(crate) fn is_shutting_down(&self) -> bool {
        self.shutting_down.load(Ordering::SeqCst)
    }

    /// Gives the terminal back, unless that was done before. Takes six seconds at most.
    pub(crate) fn give_back(&self) {
        self.give_back_and(|| ());
    }

    /// Gives the terminal back, unless that was done before, and then calls `end`. Threads that want to
    /// write or read wait until both are done, so that none ends the program in another way.
    pub(crate) fn give_back_and(&self, end: impl FnOnce()) {
        let mut state = self.lock();
        if state.taken {
            state.taken = false;
            self.leave(&mut state);
            self.given_back.notify_all();
        }
        end();
    }

    /// Waits until the terminal is given back; returns whether that happened within `timeout`.
    pub(crate) fn wait_until_given_back(&self, timeout: Duration) -> bool {
        let state = self.lock();
        let waited = self.given_back.wait_timeout_while(state, timeout, |state| state.taken);
        !waited.unwrap_or_else(PoisonError::into_inner).0.taken
    }

    /// Locks the state of the terminal, which is taken: until the lock is released, no thread gives it
    /// back. A thread that only looked before it wrote could write to a terminal that belongs to the
    /// shell again.
    fn lock_taken(&self) -> io::Result<MutexGuard<'_, State>> {
        let state = self.lock();
        if state.taken { Ok(state) } else { Err(io::Error::other(Error::given_back())) }
    }

    fn output_queue(&self) -> MutexGuard<'_, OutputQueue> {
        self.output_queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Ignores poisoning: a panic during the lock leaves the state consistent.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Undoes all changes, in reverse order. After an error in one step, the others are still
    /// tried: nothing better can be done about it.
    fn leave(&self, state: &mut State) {
        if self.output_queue().withholds(sequence::PUSH_KEY_FLAGS) {
            state.changes.forget_key_flags();
        }
        let text = state.changes.end(self.now());
        let accepted = self.write_patiently(&text);
        if !accepted.as_ref().is_ok_and(|&length| length == text.len()) {
            // The frame that the terminal has not accepted gives way.
            if accepted.is_ok_and(|length| length > 0) {
                state.changes.doubt_key_flags();
            }
            _ = self.device.discard_output();
            _ = self.write_patiently(&state.changes.end_after_loss());
        }
        self.discard_answers(&mut state.changes);
        _ = self.write_patiently(&sequence::of(LeaveAlternateScreen));
        _ = self.device.discard_input();
        _ = self.device.restore_attributes();
    }

    /// Writes `text`, and returns the length of the part that the terminal accepts in time.
    fn write_patiently(&self, text: &str) -> io::Result<usize> {
        self.recording().sent(text.as_bytes());
        let deadline = Instant::now() + WRITE_TIMEOUT;
        self.device.write(text.as_bytes(), || Instant::now() < deadline)
    }

    /// Reads until every query is answered, so that the shell receives no answer and no key
    /// release.
    fn discard_answers(&self, changes: &mut Changes) {
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
                    if input == Input::Answer(Answer::Fence) {
                        changes.fences.answered();
                    }
                }),
            }
        }
    }
}
