//! A player at a terminal: starts a program in a pseudo-terminal, types, and looks at the screen.
#![allow(dead_code, reason = "every test file uses its own share of this")]

use std::ffi::OsStr;
use std::fs;
use std::io::{Read, Write};
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, ExitStatus};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard};
use std::thread;
use std::time::{Duration, Instant};

use pty_process::Size;
use pty_process::blocking::{Command, Pts, Pty};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::process::{Pid, Signal, kill_process};
use rustix::termios::{OptionalActions, Termios, tcgetattr, tcsetattr};

use super::emulator::{Emulator, Modes, Speaks};

/// The longest wait. Expected events take milliseconds, and more on a busy machine.
const TIMEOUT: Duration = Duration::from_secs(20);

/// A program and its terminal.
pub(crate) struct Player {
    child: Child,
    pty: Arc<Pty>,
    /// Kept open, so that the terminal outlives the program.
    terminal: Pts,
    attributes_before: Termios,
    shared: Arc<Shared>,
    /// The program's data folder, unless `environment` names another one.
    data: PathBuf,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

struct State {
    emulator: Emulator,
    reading: bool,
    stall: Option<Stall>,
    /// The time that the terminal takes to answer.
    answer_time: Duration,
}

/// A terminal that stops reading.
struct Stall {
    /// The bytes at which the terminal stops reading. Only then does it answer the queries before
    /// them.
    at: &'static [u8],
    answers: Vec<u8>,
}

impl Player {
    /// Starts `program` in a terminal of `columns` by `rows` that answers according to `speaks`.
    /// The environment of the program consists of `TERM`, an empty data folder, and `environment`.
    pub(crate) fn start<A: AsRef<OsStr>>(
        size: (u16, u16),
        speaks: Speaks,
        program: impl AsRef<OsStr>,
        arguments: impl IntoIterator<Item = A>,
        environment: &[(&str, &str)],
    ) -> Self {
        Self::start_in(size, (speaks, None), program, arguments, environment)
    }

    /// Does the same in a terminal that answers nothing until it has received `stalls_at`. It then
    /// answers, and stops reading.
    pub(crate) fn start_stalling<A: AsRef<OsStr>>(
        size: (u16, u16),
        speaks: Speaks,
        stalls_at: &'static [u8],
        program: impl AsRef<OsStr>,
        arguments: impl IntoIterator<Item = A>,
        environment: &[(&str, &str)],
    ) -> Self {
        let stall = Stall { at: stalls_at, answers: Vec::new() };
        Self::start_in(size, (speaks, Some(stall)), program, arguments, environment)
    }

    fn start_in<A: AsRef<OsStr>>(
        (columns, rows): (u16, u16),
        (speaks, stall): (Speaks, Option<Stall>),
        program: impl AsRef<OsStr>,
        arguments: impl IntoIterator<Item = A>,
        environment: &[(&str, &str)],
    ) -> Self {
        let (pty, terminal) = pty_process::blocking::open().unwrap();
        pty.resize(Size::new(rows, columns)).unwrap();
        let attributes_before = tcgetattr(&pty).unwrap();
        let data = new_data_folder();
        let child = Command::new(program.as_ref())
            .args(arguments)
            .env_clear()
            .env("TERM", "xterm-256color")
            .env("CELLCASTER_DATA", &data)
            .envs(environment.iter().copied())
            .spawn_borrowed(&terminal)
            .unwrap();
        let state = State {
            emulator: Emulator::new(columns, rows, speaks),
            reading: true,
            stall,
            answer_time: Duration::ZERO,
        };
        let shared = Arc::new(Shared { state: Mutex::new(state), changed: Condvar::new() });
        let pty = Arc::new(pty);
        thread::spawn({
            let (pty, shared) = (Arc::clone(&pty), Arc::clone(&shared));
            move || receive(&pty, &shared)
        });
        Self { child, pty, terminal, attributes_before, shared, data }
    }

    /// Sends `bytes`, as the terminal would send them for keys.
    pub(crate) fn send(&self, bytes: impl AsRef<[u8]>) {
        (&*self.pty).write_all(bytes.as_ref()).unwrap();
    }

    /// Waits until the program has read everything that was sent.
    #[track_caller]
    pub(crate) fn wait_until_read(&self) {
        let deadline = Instant::now() + TIMEOUT;
        while is_ready(&self.terminal, PollFlags::IN) {
            assert!(Instant::now() < deadline, "never read; the screen:\n{}", self.text());
            thread::sleep(Duration::from_micros(200));
        }
    }

    /// Changes the size of the window.
    pub(crate) fn resize(&self, columns: u16, rows: u16) {
        self.state().emulator.resize(columns, rows);
        self.pty.resize(Size::new(rows, columns)).unwrap();
    }

    /// Does the same as [`Player::resize`] in a terminal that also reports its size in pixels.
    pub(crate) fn resize_in_pixels(
        &self,
        (columns, rows): (u16, u16),
        (width, height): (u16, u16),
    ) {
        self.state().emulator.resize(columns, rows);
        self.pty.resize(Size::new_with_pixel(rows, columns, width, height)).unwrap();
    }

    /// Waits until the screen satisfies `condition` between two frames. If it never does, fails and
    /// shows the screen.
    #[track_caller]
    pub(crate) fn wait_until(&self, what: &str, condition: impl Fn(&Emulator) -> bool) {
        let unmet =
            |state: &mut State| state.emulator.modes().synchronized || !condition(&state.emulator);
        let waited = self.shared.changed.wait_timeout_while(self.state(), TIMEOUT, unmet);
        let (state, timeout) = waited.unwrap();
        assert!(!timeout.timed_out(), "never {what}; the screen:\n{}", state.emulator.text());
    }

    /// Waits until the screen shows `text`.
    #[track_caller]
    pub(crate) fn wait_for(&self, text: &str) {
        self.wait_until(&format!("showed {text:?}"), |emulator| emulator.text().contains(text));
    }

    /// Sets whether the terminal reads the program's output. A link that is down does not read.
    pub(crate) fn set_reading(&self, reading: bool) {
        self.state().reading = reading;
        self.shared.changed.notify_all();
    }

    /// Sets the time that the terminal takes to answer.
    pub(crate) fn set_answer_time(&self, time: Duration) {
        self.state().answer_time = time;
    }

    /// Sets whether answers to status requests are lost.
    pub(crate) fn lose_statuses(&self, lost: bool) {
        self.state().emulator.statuses().lost = lost;
    }

    /// The number of lost status requests.
    pub(crate) fn lost_statuses(&self) -> usize {
        self.state().emulator.statuses().unanswered
    }

    /// Waits until the terminal has stopped reading.
    #[track_caller]
    pub(crate) fn wait_until_stalled(&self) {
        let deadline = Instant::now() + TIMEOUT;
        while self.state().reading {
            assert!(Instant::now() < deadline, "the terminal never stalled");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Waits until the terminal, which does not read, has no room for another byte.
    #[track_caller]
    pub(crate) fn wait_until_full(&self) {
        let deadline = Instant::now() + TIMEOUT;
        while is_ready(&self.terminal, PollFlags::OUT) {
            assert!(Instant::now() < deadline, "the terminal never was full");
            thread::sleep(Duration::from_millis(5));
        }
    }

    /// Keeps the terminal full for as long as it does not read.
    pub(crate) fn keep_full(&self) {
        let name = rustix::termios::ttyname(&self.terminal, Vec::new()).unwrap();
        let flags = OFlags::WRONLY | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
        let terminal = rustix::fs::open(name, flags, Mode::empty()).unwrap();
        let shared = Arc::clone(&self.shared);
        thread::spawn(move || {
            loop {
                // Locked until the bytes are written: none are written once the terminal reads again.
                let state = shared.state.lock().unwrap();
                if state.reading {
                    return;
                }
                _ = rustix::io::write(&terminal, &[b' '; 8192]);
                drop(state);
                thread::sleep(Duration::from_millis(1));
            }
        });
    }

    /// Makes the terminal interpret and echo keys, as it did before the program.
    pub(crate) fn interpret_keys(&self) {
        tcsetattr(&self.terminal, OptionalActions::Now, &self.attributes_before).unwrap();
    }

    /// Returns whether the program has ended.
    pub(crate) fn has_ended(&mut self) -> bool {
        self.child.try_wait().unwrap().is_some()
    }

    /// Sends the program a signal.
    pub(crate) fn signal(&self, signal: Signal) {
        let id = Pid::from_raw(self.child.id().cast_signed()).unwrap();
        kill_process(id, signal).unwrap();
    }

    /// Sends the program a signal that has only a number.
    #[cfg(target_os = "linux")]
    pub(crate) fn signal_number(&self, number: i32) {
        let (number, id) = (format!("-{number}"), self.child.id().to_string());
        let kill = std::process::Command::new("kill").args([number, id]).status();
        assert!(kill.unwrap().success());
    }

    /// Waits until the program has ended and the terminal has read its output. Returns the ending.
    pub(crate) fn wait_for_end(&mut self) -> Ending {
        let deadline = Instant::now() + TIMEOUT;
        let status = loop {
            if let Some(status) = self.child.try_wait().unwrap() {
                break status;
            }
            assert!(Instant::now() < deadline, "never ended; the screen:\n{}", self.text());
            thread::sleep(Duration::from_millis(5));
        };
        self.set_reading(true);
        // When the terminal has processed this, it has processed everything before it.
        let mark = "\x1b]2;the end\x07";
        rustix::io::write(&self.terminal, mark.as_bytes()).unwrap();
        self.wait_until("reached the end", |emulator| emulator.title() == "the end");
        Ending {
            status,
            modes: self.state().emulator.modes(),
            attributes_restored: self.attributes_restored(),
            leftover_input: self.leftover_input(),
        }
    }

    /// Waits until the program has written nothing for half a second.
    #[track_caller]
    pub(crate) fn wait_for_rest(&self) {
        const REST: Duration = Duration::from_millis(500);
        let deadline = Instant::now() + TIMEOUT;
        let mut seen = None;
        while seen != Some(self.bytes_written()) {
            assert!(Instant::now() < deadline, "never rested; the screen:\n{}", self.text());
            seen = Some(self.bytes_written());
            thread::sleep(REST);
        }
    }

    /// The process id of the program.
    pub(crate) fn process(&self) -> u32 {
        self.child.id()
    }

    /// The result of `look` for the screen.
    pub(crate) fn look<T>(&self, look: impl Fn(&Emulator) -> T) -> T {
        look(&self.state().emulator)
    }

    /// The text of the screen.
    pub(crate) fn text(&self) -> String {
        self.state().emulator.text()
    }

    /// The modes that are set.
    pub(crate) fn modes(&self) -> Modes {
        self.state().emulator.modes()
    }

    /// All bytes that the program has written.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        self.state().emulator.bytes().to_vec()
    }

    /// The number of bytes that the program has written.
    pub(crate) fn bytes_written(&self) -> usize {
        self.state().emulator.bytes().len()
    }

    /// Returns whether the terminal's attributes, such as raw mode, are the same as before the
    /// program.
    pub(crate) fn attributes_restored(&self) -> bool {
        let now = tcgetattr(&*self.pty).unwrap();
        let before = &self.attributes_before;
        now.input_modes == before.input_modes
            && now.output_modes == before.output_modes
            && now.control_modes == before.control_modes
            && now.local_modes == before.local_modes
    }

    /// The unread input, which a shell would receive.
    fn leftover_input(&self) -> Vec<u8> {
        let mut raw = tcgetattr(&self.terminal).unwrap();
        raw.make_raw();
        tcsetattr(&self.terminal, OptionalActions::Now, &raw).unwrap();
        let mut input = vec![0; 4096];
        let length = if is_ready(&self.terminal, PollFlags::IN) {
            rustix::io::read(&self.terminal, &mut input).unwrap()
        } else {
            0
        };
        input.truncate(length);
        input
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.shared.state.lock().unwrap()
    }
}

impl State {
    /// The answers to send now, of which `answers` are the newest, and whether the terminal then
    /// stops reading.
    fn answers_to_send(&mut self, answers: Vec<u8>) -> (Vec<u8>, bool) {
        let Some(stall) = &mut self.stall else { return (answers, false) };
        stall.answers.extend(answers);
        let mut received = self.emulator.bytes().windows(stall.at.len());
        if received.any(|bytes| bytes == stall.at) {
            (self.stall.take().unwrap().answers, true)
        } else {
            (Vec::new(), false)
        }
    }
}

/// A folder that no other player has. The program creates it when it first stores something.
fn new_data_folder() -> PathBuf {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let number = COUNT.fetch_add(1, Ordering::Relaxed);
    let name = format!("player-{}-{number}", std::process::id());
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    // A process with the same id may have been killed early.
    _ = fs::remove_dir_all(&folder);
    folder
}

impl Drop for Player {
    fn drop(&mut self) {
        // The program has ended, unless the test has failed.
        _ = self.child.kill();
        _ = self.child.wait();
        _ = fs::remove_dir_all(&self.data);
    }
}

/// The end of a program, and the state of the terminal after it.
#[derive(Debug)]
pub(crate) struct Ending {
    pub(crate) status: ExitStatus,
    pub(crate) modes: Modes,
    pub(crate) attributes_restored: bool,
    pub(crate) leftover_input: Vec<u8>,
}

impl Ending {
    /// Asserts that the terminal was restored.
    #[track_caller]
    pub(crate) fn assert_given_back(&self) {
        assert_eq!(self.modes, Modes::default());
        assert!(self.attributes_restored, "the terminal's attributes are not as they were");
        let input = self.leftover_input.escape_ascii();
        assert!(self.leftover_input.is_empty(), "the shell would find {input}");
    }

    /// The signal that ended the program.
    pub(crate) fn signal(&self) -> Option<i32> {
        self.status.signal()
    }
}

fn is_ready(terminal: &Pts, for_what: PollFlags) -> bool {
    let mut terminal = [PollFd::new(terminal, for_what)];
    poll(&mut terminal, Some(&Timespec { tv_sec: 0, tv_nsec: 0 })).unwrap() > 0
}

/// Reads and answers the program's output for as long as the terminal exists.
fn receive(mut pty: &Pty, shared: &Shared) {
    let mut buffer = [0; 4096];
    loop {
        let state = shared.state.lock().unwrap();
        drop(shared.changed.wait_while(state, |state| !state.reading).unwrap());
        let Ok(count @ 1..) = pty.read(&mut buffer) else { return };
        let mut state = shared.state.lock().unwrap();
        let answers = state.emulator.process(&buffer[..count]);
        let (answers, stalls) = state.answers_to_send(answers);
        let answer_time = state.answer_time;
        drop(state);
        if !answers.is_empty() {
            thread::sleep(answer_time);
        }
        // The program may have ended without waiting for the answers.
        _ = pty.write_all(&answers);
        if stalls {
            shared.state.lock().unwrap().reading = false;
        }
        shared.changed.notify_all();
    }
}
