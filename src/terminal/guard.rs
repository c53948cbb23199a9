//! Takes the terminal, and gives it back as it was found.
//!
//! A guard is shared by the session, the panic hook and the thread that takes signals. Whichever is
//! first gives the terminal back; for the others there is nothing left to do. Restoring in each of
//! them what it knows of was refused: what is pushed twice or popped twice is worse than neither.

mod fences;
mod outbox;
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
use self::outbox::Outbox;
use self::reports::Reports;
use super::Error;
use super::input::{Answer, Decoder, Input};
use super::mouse::MouseUnits;
use super::platform::Device;
use super::recorder::{Recorder, Recording};
use super::sequence;

/// How long a terminal may take to accept what gives it back.
const WRITE_PATIENCE: Duration = Duration::from_millis(250);

/// What is changed about the terminal, and how to undo it.
#[derive(Debug)]
pub(super) struct Guard {
    device: Device,
    state: Mutex<State>,
    given_back: Condvar,
    hurried: AtomicBool,
    outbox: Mutex<Outbox>,
    recording: Mutex<Recording>,
}

#[derive(Debug)]
struct State {
    taken: bool,
    reports: Reports,
    fences: Fences,
    /// Whether answers to status requests are on their way.
    awaits_statuses: bool,
    /// Whether entries of the palette may have been defined.
    palette_defined: bool,
}

impl Guard {
    /// A guard of `device`, which becomes the one that the panic hook uses.
    ///
    /// # Errors
    /// Where the process has a guard already.
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
            hurried: AtomicBool::new(false),
            outbox: Mutex::default(),
            recording: Mutex::new(Recording::by(recorder)),
        });
        panic_hook::protect(&guard)?;
        Ok(guard)
    }

    /// Gives the terminal back for good.
    pub(super) fn uninstall(&self) {
        self.give_back();
        panic_hook::release(self);
    }

    pub(super) fn device(&self) -> &Device {
        &self.device
    }

    /// What takes note of what is sent.
    pub(super) fn recording(&self) -> MutexGuard<'_, Recording> {
        self.recording.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the terminal: raw mode, the alternate screen, no cursor.
    pub(super) fn take(&self) -> io::Result<()> {
        let mut state = self.lock();
        self.device.make_raw()?;
        state.taken = true;
        self.outbox().clear();
        let mut text = sequence::of(EnterAlternateScreen) + &sequence::of(Hide);
        // What is too long for a line is cut, so a window made narrower does not scroll.
        text.push_str(&sequence::of(DisableLineWrap));
        text.push_str(sequence::RESET_STYLE);
        state.reports.push_start(&mut text);
        drop(state);
        self.write(text.as_bytes())
    }

    /// Asks `queries`, and sends a fence after them.
    pub(super) fn ask(&self, queries: &str) -> io::Result<()> {
        self.lock().fences.sent();
        self.write([queries, sequence::QUERY_FENCE].concat().as_bytes())
    }

    /// Takes note that a fence was sent after a frame.
    pub(super) fn fence_sent(&self) {
        self.lock().fences.sent();
    }

    /// Takes note that the terminal has answered all before a fence.
    pub(super) fn fence_answered(&self) {
        self.lock().fences.answered();
    }

    /// Whether the terminal has not answered yet all that it was asked.
    pub(super) fn awaits_answers(&self) -> bool {
        self.lock().fences.are_open()
    }

    /// Has the terminal report the mouse so, now and whenever it is taken.
    pub(super) fn set_mouse(&self, mouse: Option<MouseUnits>) -> io::Result<()> {
        let mut text = String::new();
        self.lock().reports.change_mouse(mouse, &mut text);
        self.write(text.as_bytes())
    }

    /// Makes the terminal report keys in the kitty protocol, now and whenever it is taken.
    pub(super) fn push_key_flags(&self) -> io::Result<()> {
        self.lock().reports.has_key_flags = true;
        self.write(sequence::PUSH_KEY_FLAGS.as_bytes())
    }

    /// Whether the terminal is ours to write to.
    pub(super) fn is_taken(&self) -> bool {
        self.lock().taken
    }

    /// Writes `bytes` after all that was written before, as far as the terminal takes them at once;
    /// the rest when it [has room](Self::write_rest).
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<()> {
        self.check_taken()?;
        self.recording().sent(bytes);
        let mut outbox = self.outbox();
        outbox.push(bytes);
        outbox.write_to(&self.device)
    }

    /// Writes what the terminal has not taken yet, as far as it does now.
    pub(super) fn write_rest(&self) -> io::Result<()> {
        self.check_taken()?;
        self.outbox().write_to(&self.device)
    }

    /// Whether the terminal has taken all that was written.
    pub(super) fn has_written_all(&self) -> bool {
        self.outbox().is_empty()
    }

    /// Takes note whether answers to status requests are on their way.
    pub(super) fn await_statuses(&self, awaits: bool) {
        self.lock().awaits_statuses = awaits;
    }

    /// Takes note that entries of the palette may have been defined.
    pub(super) fn palette_defined(&self) {
        self.lock().palette_defined = true;
    }

    /// From now on, nothing waits for a terminal that is not ready for a frame.
    pub(super) fn hurry(&self) {
        self.hurried.store(true, Ordering::SeqCst);
    }

    /// Whether that is so.
    pub(super) fn is_hurried(&self) -> bool {
        self.hurried.load(Ordering::SeqCst)
    }

    /// Gives the terminal back, if that has not been done. Takes two seconds at the most.
    pub(super) fn give_back(&self) {
        let mut state = self.lock();
        if state.taken {
            state.taken = false;
            self.leave(&mut state);
            self.given_back.notify_all();
        }
    }

    /// Waits until the terminal has been given back; whether it has been by `timeout`.
    pub(super) fn wait_until_given_back(&self, timeout: Duration) -> bool {
        let state = self.lock();
        let waited = self.given_back.wait_timeout_while(state, timeout, |state| state.taken);
        !waited.unwrap_or_else(PoisonError::into_inner).0.taken
    }

    fn check_taken(&self) -> io::Result<()> {
        if self.is_taken() { Ok(()) } else { Err(io::Error::other(Error::given_back())) }
    }

    fn outbox(&self) -> MutexGuard<'_, Outbox> {
        self.outbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A panic while it is held changes nothing that matters: what is left to undo is still told.
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Undoes everything, in the opposite order. Each step is tried whether or not the one before
    /// has worked: there is nothing better to do about an error than the rest.
    fn leave(&self, state: &mut State) {
        let mut text = sequence::of(EndSynchronizedUpdate) + sequence::RESET_STYLE;
        if state.palette_defined {
            text.push_str(&sequence::give_palette_back());
        }
        state.reports.push_end(&mut text);
        if state.has_reports_on_their_way() {
            // The answer to this comes after all of them.
            text.push_str(sequence::QUERY_FENCE);
            state.fences.sent();
            state.awaits_statuses = false;
        }
        text.push_str(&sequence::of(EnableLineWrap));
        text.push_str(&sequence::of(Show));
        if self.write_or_discard(&text).is_ok() {
            self.swallow_answers(&mut state.fences);
            _ = self.write_or_discard(&sequence::of(LeaveAlternateScreen));
        }
        _ = self.device.restore_attributes();
    }

    /// Writes `text`, if need be in the place of a frame that the terminal has not taken.
    fn write_or_discard(&self, text: &str) -> io::Result<()> {
        self.recording().sent(text.as_bytes());
        let patiently = || {
            let deadline = Instant::now() + WRITE_PATIENCE;
            self.device.write(text.as_bytes(), || Instant::now() < deadline)
        };
        patiently().or_else(|_| {
            self.device.discard_output()?;
            patiently()
        })
    }

    /// Reads until every query is answered, so that no answer and no key's release is typed into
    /// the shell.
    fn swallow_answers(&self, fences: &mut Fences) {
        let mut decoder = Decoder::default();
        let mut buffer = [0; 256];
        while let Some(patience) = fences.patience() {
            match self.device.wait_for_input(patience) {
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
    /// Whether the terminal may have sent what nobody has read yet: a key's release, which it sends
    /// until its flags are popped, a motion of the mouse, or the answer to a frame. A report of the
    /// focus is not worth waiting for a terminal that answers nothing.
    fn has_reports_on_their_way(&self) -> bool {
        self.reports.are_frequent() || self.awaits_statuses || self.fences.are_answered()
    }
}
