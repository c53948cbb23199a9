//! Signals: a thread takes them, passes them on as bytes to poll for, and sees to it that those
//! that end the program do end it.

use std::io::{self, Read, Write};
use std::mem;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags};
use rustix::process::{Signal as ProcessSignal, getpgrp, getsid, kill_current_process_group};
use signal_hook::consts::{SIGCONT, SIGHUP, SIGINT, SIGTERM, SIGTSTP, SIGWINCH};
use signal_hook::iterator::{Handle, Signals as Incoming};
use signal_hook::low_level::emulate_default_handler;

use super::super::QuitReason;
use super::super::guard::Guard;
use super::wait;

/// How long the program has, once it is told to end, before it is ended by force.
const GRACE: Duration = Duration::from_secs(1);

/// Those that change what the program does by default.
const EFFECTIVE: [i32; 4] = [SIGHUP, SIGINT, SIGTERM, SIGTSTP];

/// Those that it ignores by default.
const NOTICES: [i32; 2] = [SIGCONT, SIGWINCH];

/// What a signal means here.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Signal {
    /// The window has another size.
    Resized,
    /// Somebody wants the program to stop for a while.
    Suspend,
    /// It goes on after a stop.
    Continued,
    /// It is to end.
    Quit(QuitReason),
}

/// The signals that arrive during a session. Before and after, they do what they always do.
#[derive(Debug)]
pub(in super::super) struct Signals {
    receiver: UnixStream,
    handle: Handle,
    thread: Option<JoinHandle<()>>,
    /// What arrived while only one signal was of interest.
    deferred: Vec<Signal>,
}

impl Signals {
    /// Takes the signals over. When one says that the program is to end and it does not, gives the
    /// terminal back through `guard`, and ends it.
    pub(in super::super) fn listen(guard: &Arc<Guard>) -> io::Result<Self> {
        let (receiver, sender) = UnixStream::pair()?;
        receiver.set_nonblocking(true)?;
        sender.set_nonblocking(true)?;
        default_effects()?.store(false, Ordering::SeqCst);
        let incoming = Incoming::new(EFFECTIVE.iter().chain(&NOTICES))?;
        let handle = incoming.handle();
        let thread = thread::Builder::new().name("signals".to_owned()).spawn({
            let guard = Arc::clone(guard);
            move || pass_on(incoming, &sender, &guard)
        })?;
        Ok(Self { receiver, handle, thread: Some(thread), deferred: Vec::new() })
    }

    /// Those that have arrived since the last call.
    pub(in super::super) fn take(&mut self) -> Vec<Signal> {
        let mut signals = mem::take(&mut self.deferred);
        let mut numbers = [0; 64];
        while let Ok(count @ 1..) = self.receiver.read(&mut numbers) {
            signals.extend(numbers[..count].iter().filter_map(|number| meaning((*number).into())));
        }
        signals
    }

    /// Stops this program, and those that were started with it, until the shell continues them.
    /// Returns at once where there is no shell that would.
    pub(in super::super) fn stop_until_continued(&mut self) -> io::Result<()> {
        if !is_a_job()? {
            return Ok(());
        }
        kill_current_process_group(ProcessSignal::STOP)?;
        // It may be another thread that takes the signal, a little later than we get here.
        self.wait_until_continued()
    }

    fn wait_until_continued(&mut self) -> io::Result<()> {
        loop {
            let signals = self.take();
            let continued = signals.contains(&Signal::Continued);
            let ends = signals.iter().any(|signal| matches!(signal, Signal::Quit(_)));
            self.deferred.extend(signals.into_iter().filter(|signal| *signal != Signal::Continued));
            if continued || ends {
                return Ok(());
            }
            wait(&mut [PollFd::new(&self.receiver, PollFlags::IN)], None)?;
        }
    }
}

impl AsFd for Signals {
    fn as_fd(&self) -> BorrowedFd<'_> {
        self.receiver.as_fd()
    }
}

impl Drop for Signals {
    fn drop(&mut self) {
        self.handle.close();
        if let Some(thread) = self.thread.take() {
            // It cannot be of use to know that it panicked.
            _ = thread.join();
        }
        if let Ok(default_effects) = default_effects() {
            default_effects.store(true, Ordering::SeqCst);
        }
    }
}

/// Whether a shell has put us in a process group of our own, as it does with every job. In the
/// session's first group, there is nobody above to continue what has stopped.
fn is_a_job() -> io::Result<bool> {
    Ok(getpgrp() != getsid(None)?)
}

/// Whether signals do what they do by default. A handler, once set, stays for as long as the process runs;
/// without this, Ctrl-C would do nothing after a session.
fn default_effects() -> io::Result<&'static AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    if let Some(flag) = FLAG.get() {
        return Ok(flag);
    }
    let flag = Arc::new(AtomicBool::new(false));
    for number in EFFECTIVE {
        signal_hook::flag::register_conditional_default(number, Arc::clone(&flag))?;
    }
    Ok(FLAG.get_or_init(|| flag))
}

fn pass_on(mut incoming: Incoming, mut sender: &UnixStream, guard: &Guard) {
    for number in incoming.forever() {
        // It fails where thousands are waiting already: then nobody listens any more.
        _ = sender.write(&[number as u8]);
        if let Some(Signal::Quit(_)) = meaning(number) {
            guard.shut_down();
            if !guard.wait_until_given_back(GRACE) {
                guard.give_back();
                // Does not return, unless the signal's name is wrong.
                _ = emulate_default_handler(number);
            }
        }
    }
}

fn meaning(number: i32) -> Option<Signal> {
    Some(match number {
        SIGWINCH => Signal::Resized,
        SIGTSTP => Signal::Suspend,
        SIGCONT => Signal::Continued,
        SIGINT => Signal::Quit(QuitReason::Interrupted),
        SIGTERM => Signal::Quit(QuitReason::Terminated),
        SIGHUP => Signal::Quit(QuitReason::HungUp),
        _ => return None,
    })
}
