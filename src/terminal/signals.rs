//! Signals: a thread receives them, passes them on as bytes that can be polled, and makes sure that the signals that
//! should end the program do end it.
//!
//! If a signal asks the program to end, the program may still save the game. On every other signal that would end it,
//! the thread gives the terminal back and lets the signal have its own effect.
//!
//! Rejected: doing the same for SIGILL, SIGFPE, SIGSEGV and SIGBUS, which report a fault of the program. The faulty
//! instruction would run again and again before the thread is done.

use std::io::{self, Read, Write};
use std::mem;
use std::ops::RangeInclusive;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::net::UnixStream;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags};
use rustix::process::{Signal as ProcessSignal, getpgrp, getsid, kill_current_process_group};
use signal_hook::consts::{
    SIGABRT, SIGALRM, SIGCONT, SIGHUP, SIGINT, SIGPROF, SIGQUIT, SIGSYS, SIGTERM, SIGTRAP, SIGTSTP,
    SIGUSR1, SIGUSR2, SIGVTALRM, SIGWINCH, SIGXCPU, SIGXFSZ,
};
use signal_hook::iterator::exfiltrator::WithRawSiginfo;
use signal_hook::iterator::{Handle, SignalsInfo};
use signal_hook::low_level::{emulate_default_handler, exit};

use super::QuitReason;
use super::guard::TerminalGuard;
use super::unix::wait;

/// The time from a signal that should end the program until the thread ends it by force.
const RESTORE_TIMEOUT: Duration = Duration::from_secs(1);

/// The signals that ask the program to end or to stop. By default, they end or stop it.
const REQUESTS: [i32; 4] = [SIGHUP, SIGINT, SIGTERM, SIGTSTP];

/// The signals that end the program by default and do not ask for anything.
const ENDS: [i32; 10] =
    [SIGABRT, SIGALRM, SIGPROF, SIGQUIT, SIGSYS, SIGTRAP, SIGUSR1, SIGUSR2, SIGVTALRM, SIGXCPU];

/// The signals that end the program by default, and whose default effect the library cannot emulate: SIGSTKFLT,
/// SIGIO, SIGPWR and the real-time signals. After one of them, the program ends with the status [`STATUS`] plus its
/// number, as a shell reports a program that a signal has ended.
#[cfg(any(target_os = "linux", target_os = "android"))]
const NAMELESS: [RangeInclusive<i32>; 4] = [16..=16, 29..=29, 30..=30, 34..=64];
#[cfg(not(any(target_os = "linux", target_os = "android")))]
const NAMELESS: [RangeInclusive<i32>; 0] = [];

/// A shell reports a signal as an exit status: this number plus the number of the signal.
const STATUS: i32 = 128;

/// The signals without an effect. By default, SIGXFSZ has one. Without its effect, a write beyond the largest size of a
/// file fails like a write to a full disk.
const NOTICES: [i32; 3] = [SIGCONT, SIGWINCH, SIGXFSZ];

/// Signals, each with the system's information about it.
type Incoming = SignalsInfo<WithRawSiginfo>;

/// The meaning of a signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Signal {
    /// The size of the window has changed.
    Resized,
    /// The program should stop for a while.
    Suspend,
    /// The program continues after a stop.
    Continued,
    /// The program should end.
    Quit(QuitReason),
}

/// The signals that arrive during a session. Before and after it, they have their default effects.
#[derive(Debug)]
pub(crate) struct Signals {
    receiver: UnixStream,
    handle: Handle,
    thread: Option<JoinHandle<()>>,
    /// Signals that arrived during a wait for another one.
    deferred: Vec<Signal>,
}

impl Signals {
    /// Starts to receive signals. If a signal should end the program and the program continues, the thread gives the
    /// terminal back through `guard` and ends the program.
    pub(crate) fn listen(guard: &Arc<TerminalGuard>) -> io::Result<Self> {
        let (receiver, sender) = UnixStream::pair()?;
        receiver.set_nonblocking(true)?;
        sender.set_nonblocking(true)?;
        default_effects()?.store(false, Ordering::SeqCst);
        let incoming = Incoming::new(REQUESTS.iter().chain(&ENDS).chain(&NOTICES))?;
        let handle = incoming.handle();
        for number in nameless() {
            // The C library may reserve some of them.
            _ = handle.add_signal(number);
        }
        let thread = thread::Builder::new().name("signals".to_owned()).spawn({
            let guard = Arc::clone(guard);
            move || forward_signals(incoming, &sender, &guard)
        })?;
        Ok(Self { receiver, handle, thread: Some(thread), deferred: Vec::new() })
    }

    /// Returns the signals since the last call.
    pub(crate) fn take(&mut self) -> Vec<Signal> {
        let mut signals = mem::take(&mut self.deferred);
        let mut numbers = [0; 64];
        while let Ok(count @ 1..) = self.receiver.read(&mut numbers) {
            signals.extend(numbers[..count].iter().filter_map(|number| meaning((*number).into())));
        }
        signals
    }

    /// Stops this program and the programs that were started with it, until the shell continues them. Returns at once
    /// if there is no shell to continue them.
    pub(crate) fn stop_until_continued(&mut self) -> io::Result<()> {
        // A shell gives every job a process group of its own. In the session's first group, no parent can continue a
        // stopped program.
        if getpgrp() == getsid(None)? {
            return Ok(());
        }
        kill_current_process_group(ProcessSignal::STOP)?;
        // Another thread may receive the signal shortly after this point.
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
            // A panic in the thread has no consequences here.
            _ = thread.join();
        }
        if let Ok(default_effects) = default_effects() {
            default_effects.store(true, Ordering::SeqCst);
        }
    }
}

/// The flag that is `true` while signals have their default effects. A handler stays for the life of the process.
/// Without this flag, Ctrl-C would have no effect after a session.
fn default_effects() -> io::Result<&'static AtomicBool> {
    static FLAG: OnceLock<Arc<AtomicBool>> = OnceLock::new();
    if let Some(flag) = FLAG.get() {
        return Ok(flag);
    }
    let flag = Arc::new(AtomicBool::new(false));
    for number in REQUESTS.into_iter().chain(ENDS) {
        signal_hook::flag::register_conditional_default(number, Arc::clone(&flag))?;
    }
    for number in nameless() {
        let (status, flag) = (STATUS + number, Arc::clone(&flag));
        _ = signal_hook::flag::register_conditional_shutdown(number, status, flag);
    }
    Ok(FLAG.get_or_init(|| flag))
}

fn forward_signals(mut incoming: Incoming, mut sender: &UnixStream, guard: &TerminalGuard) {
    for info in incoming.forever() {
        let number = info.si_signo;
        if NAMELESS.iter().any(|numbers| numbers.contains(&number)) {
            guard.give_back_and(|| exit(STATUS + number));
            continue;
        }
        if ENDS.contains(&number) {
            if number != SIGQUIT || !is_from_system(info.si_code) {
                end(number, guard);
            }
            continue;
        }
        // The write fails only if thousands of bytes are waiting. In that case, no session reads them any more.
        _ = sender.write(&[number as u8]);
        if let Some(Signal::Quit(_)) = meaning(number) {
            guard.shut_down();
            if !guard.wait_until_given_back(RESTORE_TIMEOUT) {
                end(number, guard);
            }
        }
    }
}

fn nameless() -> impl Iterator<Item = i32> {
    NAMELESS.into_iter().flatten()
}

/// Gives the terminal back and ends the program by this signal.
fn end(number: i32, guard: &TerminalGuard) {
    // Returns only if the number is not a signal.
    guard.give_back_and(|| _ = emulate_default_handler(number));
}

/// Returns true if the system, not a process, has sent a signal with this code. A SIGQUIT from the system comes from a
/// key that was pressed while the terminal interpreted keys, for a moment before or after a stop. In raw mode, the same
/// key does nothing.
#[cfg(any(target_os = "linux", target_os = "android"))]
fn is_from_system(code: i32) -> bool {
    code > 0
}

/// Always false, because other systems use the codes in other ways.
#[cfg(not(any(target_os = "linux", target_os = "android")))]
fn is_from_system(_: i32) -> bool {
    false
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
