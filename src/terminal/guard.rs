//! Takes the terminal and restores its previous state.
//!
//! The session, the panic hook and the thread that handles signals share a guard. The first of them
//! that ends gives the terminal back, and the others do nothing. Restoring a part of the state in
//! each was refused: a mode that is pushed or popped twice is worse than neither.

mod fences;
mod output_queue;
mod panic_hook;
mod reports;

use std::io;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use crossterm::cursor::{Hide, Show};
use crossterm::terminal::{
    DisableLineWrap, EnableLineWrap, EndSynchronizedUpdate, EnterAlternateScreen,
    LeaveAlternateScreen,
};

use self::fences::Fences;
use self::output_queue::OutputQueue;
use self::reports::Reports;
use super::Error;
use super::input::{Answer, Decoder, Input};
use super::mouse::MouseUnits;
use super::platform::Device;
use super::recorder::{Recorder, Recording};
use super::sequence;

/// The time that a terminal has to accept the bytes that restore its state.
const WRITE_TIMEOUT: Duration = Duration::from_millis(250);

/// The changes to the terminal's state, and the way to undo them.
#[derive(Debug)]
pub(super) struct Guard {
    device: Device,
    state: Mutex<State>,
    given_back: Condvar,
    shutting_down: AtomicBool,
    output_queue: Mutex<OutputQueue>,
    recording: Mutex<Recording>,
}

#[derive(Debug)]
struct State {
    taken: bool,
    reports: Reports,
    fences: Fences,
    /// Whether answers to status requests may arrive.
    awaits_statuses: bool,
    /// Whether entries of the palette may have been defined.
    palette_defined: bool,
}

impl Guard {
    /// A guard of `device`, which the panic hook uses from now on.
    ///
    /// # Errors
    /// If the process has a guard already.
    pub(super) fn install(
        device: Device,
        recorder: Option<Box<dyn Recorder>>,
    ) -> Result<Arc<Self>, Error> {
        let guard = Arc::new(Self {
            device,
            state: Mutex::new(State {
                taken: false,
                reports: Reports::default(),
                fences: Fences::none(),
                awaits_statuses: false,
                palette_defined: false,
            }),
            given_back: Condvar::new(),
            shutting_down: AtomicBool::new(false),
            output_queue: Mutex::default(),
            recording: Mutex::new(Recording::by(recorder)),
        });
        panic_hook::protect(&guard)?;
        Ok(guard)
    }

    /// Gives the terminal back at the end of the session.
    pub(super) fn uninstall(&self) {
        self.give_back();
        panic_hook::release(self);
    }

    pub(super) fn device(&self) -> &Device {
        &self.device
    }

    /// The recorder of the sent bytes.
    pub(super) fn recording(&self) -> MutexGuard<'_, Recording> {
        self.recording.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the terminal: raw mode, the alternate screen, no cursor.
    pub(super) fn take(&self) -> io::Result<()> {
        let mut state = self.lock();
        self.device.make_raw()?;
        state.taken = true;
        self.output_queue().clear();
        let mut text = sequence::of(EnterAlternateScreen) + &sequence::of(Hide);
        // Long lines are cut, so that a narrower window does not scroll.
        text.push_str(&sequence::of(DisableLineWrap));
        text.push_str(sequence::RESET_STYLE);
        state.reports.push_start(&mut text);
        drop(state);
        self.write(text.as_bytes())
    }

    /// Sends `queries` with a fence after them.
    pub(super) fn ask(&self, queries: &str) -> io::Result<()> {
        self.lock().fences.sent();
        self.write([queries, sequence::QUERY_FENCE].concat().as_bytes())
    }

    /// Records that a fence was sent after a frame.
    pub(super) fn fence_sent(&self) {
        self.lock().fences.sent();
    }

    /// Records that the terminal has answered a fence.
    pub(super) fn fence_answered(&self) {
        self.lock().fences.answered();
    }

    /// Whether a fence is still unanswered.
    pub(super) fn awaits_answers(&self) -> bool {
        self.lock().fences.are_open()
    }

    /// Sets how the terminal reports the mouse, now and after it is taken again.
    pub(super) fn set_mouse(&self, mouse: Option<MouseUnits>) -> io::Result<()> {
        let mut text = String::new();
        self.lock().reports.change_mouse(mouse, &mut text);
        self.write(text.as_bytes())
    }

    /// Makes the terminal report keys in the kitty protocol, now and after it is taken again.
    pub(super) fn push_key_flags(&self) -> io::Result<()> {
        self.lock().reports.has_key_flags = true;
        self.write(sequence::PUSH_KEY_FLAGS.as_bytes())
    }

    /// Whether the terminal is taken, so that the program may write to it.
    pub(super) fn is_taken(&self) -> bool {
        self.lock().taken
    }

    /// Writes `bytes` after all earlier bytes, as far as the terminal accepts them at once. The
    /// rest is [written later](Self::write_queued).
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<()> {
        self.check_taken()?;
        self.recording().sent(bytes);
        let mut output_queue = self.output_queue();
        output_queue.push(bytes);
        output_queue.write_to(&self.device)
    }

    /// Writes the queued bytes, as far as the terminal accepts them at once.
    pub(super) fn write_queued(&self) -> io::Result<()> {
        self.check_taken()?;
        self.output_queue().write_to(&self.device)
    }

    /// Whether the terminal has accepted all bytes.
    pub(super) fn has_written_all(&self) -> bool {
        self.output_queue().is_empty()
    }

    /// Sets whether answers to status requests may arrive.
    pub(super) fn await_statuses(&self, awaits: bool) {
        self.lock().awaits_statuses = awaits;
    }

    /// Records that entries of the palette may have been defined.
    pub(super) fn palette_defined(&self) {
        self.lock().palette_defined = true;
    }

    /// Makes all functions stop waiting for a terminal that is not ready for a frame.
    pub(super) fn shut_down(&self) {
        self.shutting_down.store(true, Ordering::SeqCst);
    }

    /// Whether [`Guard::shut_down`] was called.
    pub(super) fn is_shutting_down(&self) -> bool {
        self.shutting_down.load(Ordering::SeqCst)
    }

    /// Gives the terminal back, unless that was done before. Takes two seconds at most.
    pub(super) fn give_back(&self) {
        let mut state = self.lock();
        if state.taken {
            state.taken = false;
            self.leave(&mut state);
            self.given_back.notify_all();
        }
    }

    /// Waits until the terminal is given back; returns whether that happened within `timeout`.
    pub(super) fn wait_until_given_back(&self, timeout: Duration) -> bool {
        let state = self.lock();
        let waited = self.given_back.wait_timeout_while(state, timeout, |state| state.taken);
        !waited.unwrap_or_else(PoisonError::into_inner).0.taken
    }

    fn check_taken(&self) -> io::Result<()> {
        if self.is_taken() { Ok(()) } else { Err(io::Error::other(Error::given_back())) }
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
        let mut text = sequence::of(EndSynchronizedUpdate) + sequence::RESET_STYLE;
        if state.palette_defined {
            text.push_str(&sequence::give_palette_back());
        }
        state.reports.push_end(&mut text);
        if state.has_pending_reports() {
            // The answer to this arrives after all pending reports.
            text.push_str(sequence::QUERY_FENCE);
            state.fences.sent();
            state.awaits_statuses = false;
        }
        text.push_str(&sequence::of(EnableLineWrap));
        text.push_str(&sequence::of(Show));
        if self.write_or_discard(&text).is_ok() {
            self.discard_answers(&mut state.fences);
            _ = self.write_or_discard(&sequence::of(LeaveAlternateScreen));
        }
        _ = self.device.restore_attributes();
    }

    /// Writes `text`, if necessary in place of a frame that the terminal has not accepted.
    fn write_or_discard(&self, text: &str) -> io::Result<()> {
        self.recording().sent(text.as_bytes());
        let patiently = || {
            let deadline = Instant::now() + WRITE_TIMEOUT;
            self.device.write(text.as_bytes(), || Instant::now() < deadline)
        };
        patiently().or_else(|_| {
            self.device.discard_output()?;
            patiently()
        })
    }

    /// Reads until every query is answered, so that the shell receives no answer and no key
    /// release.
    fn discard_answers(&self, fences: &mut Fences) {
        let mut decoder = Decoder::default();
        let mut buffer = [0; 256];
        while let Some(timeout) = fences.time_left() {
            match self.device.wait_for_input(timeout) {
                Ok(true) => {}
                Ok(false) | Err(_) => return,
            }
            match self.device.read(&mut buffer) {
                Ok(None) => {}
                Ok(Some(0)) | Err(_) => return,
                Ok(Some(count)) => decoder.feed(&buffer[..count], |input| {
                    if input == Input::Answer(Answer::Fence) {
                        fences.answered();
                    }
                }),
            }
        }
    }
}

impl State {
    /// Whether the terminal may have sent input that is not read yet: a key release, which it sends
    /// until its flags are popped, a motion of the mouse, or the answer to a frame. Focus reports
    /// do not count: few are sent, and waiting for a terminal that answers nothing takes a second.
    fn has_pending_reports(&self) -> bool {
        self.reports.are_frequent() || self.awaits_statuses || self.fences.are_answered()
    }
}
