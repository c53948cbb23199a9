//! The Unix part of a terminal: its device, its attributes, and waiting for it.

use std::io;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::io::Errno;
use rustix::termios::{
    OptionalActions, QueueSelector, Termios, isatty, tcflush, tcgetattr, tcgetwinsize, tcsetattr,
    ttyname,
};

use super::error::TerminalErrorKind;
use super::{Error, WindowSize};

/// The terminal of standard input and output.
///
/// Both are opened again if possible. A descriptor of the process's own can be set not to block, while setting a
/// shared one would also affect the shell. A program that cannot block in a write can still be ended while the
/// link is down. Raw mode and sizes do not use crossterm, because it queries whatever terminal it finds.
#[derive(Debug)]
pub(crate) struct Device {
    input: OwnedFd,
    output: OwnedFd,
    attributes: Termios,
}

/// The results of a wait.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ready {
    /// `true` if there are bytes to read, or the input has ended.
    pub(crate) input: bool,
    /// `true` if there are signals.
    pub(crate) signals: bool,
    /// `true` if there is room for bytes to write, or the output has ended.
    pub(crate) output: bool,
}

impl Device {
    pub(crate) fn open() -> Result<Self, Error> {
        let (input, output) = (rustix::stdio::stdin(), rustix::stdio::stdout());
        for (stream, name) in [(input, "standard input"), (output, "standard output")] {
            if !isatty(stream) {
                return Err(TerminalErrorKind::NotATerminal { stream: name }.into());
            }
        }
        let open = || {
            Ok(Self {
                input: open_again(input, OFlags::RDONLY)?,
                output: open_again(output, OFlags::WRONLY)?,
                attributes: tcgetattr(input)?,
            })
        };
        open().map_err(Error::while_doing("opening the terminal"))
    }

    /// Sets raw mode: keys arrive one by one, without echo or interpretation.
    pub(crate) fn make_raw(&self) -> io::Result<()> {
        let mut raw = self.attributes.clone();
        raw.make_raw();
        Ok(tcsetattr(&self.input, OptionalActions::Now, &raw)?)
    }

    pub(crate) fn size(&self) -> WindowSize {
        tcgetwinsize(&self.output).map_or(WindowSize::UNKNOWN, |size| {
            WindowSize::new((size.ws_col, size.ws_row), (size.ws_xpixel, size.ws_ypixel))
        })
    }

    /// Writes the part of `bytes` that the terminal accepts at once, and returns its length. If that is not all,
    /// it does not try again, because the terminal would accept nothing.
    pub(crate) fn write_some(&self, bytes: &[u8]) -> io::Result<usize> {
        if bytes.is_empty() {
            return Ok(0);
        }
        loop {
            match rustix::io::write(&self.output, bytes) {
                Ok(count) => return Ok(count),
                Err(Errno::INTR) => {}
                Err(Errno::AGAIN) => return Ok(0),
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Writes `bytes` and returns the length of the accepted part. While the terminal accepts no more,
    /// waits as long as `go_on` returns `true`.
    pub(crate) fn write(&self, bytes: &[u8], go_on: impl Fn() -> bool) -> io::Result<usize> {
        const POLL_INTERVAL: Duration = Duration::from_millis(50);
        let mut written = self.write_some(bytes)?;
        while written < bytes.len() && go_on() {
            wait(&mut [PollFd::new(&self.output, PollFlags::OUT)], Some(POLL_INTERVAL))?;
            written += self.write_some(&bytes[written..])?;
        }
        Ok(written)
    }

    /// Discards written bytes that the terminal has not received.
    pub(crate) fn discard_output(&self) -> io::Result<()> {
        Ok(tcflush(&self.output, QueueSelector::OFlush)?)
    }

    /// Discards received bytes that were not read, and restores the attributes from when the terminal was opened.
    /// After an error in one step, the other is still tried, because nothing better can be done.
    pub(crate) fn give_back(&self) {
        _ = tcflush(&self.input, QueueSelector::IFlush);
        _ = tcsetattr(&self.input, OptionalActions::Now, &self.attributes);
    }

    /// Reads the available bytes into `buffer` and returns their number: zero at the end of input,
    /// `None` if no bytes are available yet.
    pub(crate) fn read(&self, buffer: &mut [u8]) -> io::Result<Option<usize>> {
        match rustix::io::read(&self.input, buffer) {
            Ok(count) => Ok(Some(count)),
            Err(Errno::AGAIN | Errno::INTR) => Ok(None),
            // The error of a terminal that has been hung up.
            Err(Errno::IO) => Ok(Some(0)),
            Err(error) => Err(error.into()),
        }
    }

    /// Waits for bytes to read, for `timeout` at most or until a signal arrives.
    pub(crate) fn wait_for_input(&self, timeout: Duration) -> io::Result<()> {
        wait(&mut [PollFd::new(&self.input, PollFlags::IN)], Some(timeout))
    }

    /// Waits for bytes, for signals or, if `wants_room`, for room to write, for at most `timeout`.
    pub(crate) fn wait(
        &self,
        signals: &impl AsFd,
        wants_room: bool,
        timeout: Option<Duration>,
    ) -> io::Result<Ready> {
        let mut all = [
            PollFd::new(&self.input, PollFlags::IN),
            PollFd::new(signals, PollFlags::IN),
            PollFd::new(&self.output, PollFlags::OUT),
        ];
        // A terminal that has been hung up is always ready for writing.
        let watched = if wants_room { 3 } else { 2 };
        wait(&mut all[..watched], timeout)?;
        let [input, signals, output] = all.map(|one| !one.revents().is_empty());
        Ok(Ready { input, signals, output })
    }
}

/// Replaces standard input, which was read to its end and is no longer needed, by the terminal of standard
/// output. Rejected: "/dev/tty", which cannot be polled on every system.
#[cfg(feature = "cli")]
pub(crate) fn take_keys_from_terminal() -> io::Result<()> {
    let output = rustix::stdio::stdout();
    let name = ttyname(output, Vec::new())?;
    let terminal = rustix::fs::open(name, OFlags::RDONLY | OFlags::NOCTTY, Mode::empty());
    match terminal {
        Ok(terminal) => rustix::stdio::dup2_stdin(terminal)?,
        // The terminal belongs to another user, as after `su`. The open descriptor can still be read.
        Err(_) => rustix::stdio::dup2_stdin(output)?,
    }
    Ok(())
}

/// Returns true as soon as `stream` accepts bytes, and false if it accepts none for a while. A write to a terminal
/// whose link is down would not end.
#[cfg(feature = "cli")]
pub(crate) fn accepts_output(stream: &impl AsFd) -> bool {
    const TIMEOUT: Duration = Duration::from_millis(250);
    let mut streams = [PollFd::new(stream, PollFlags::OUT)];
    wait(&mut streams, Some(TIMEOUT)).is_ok() && !streams[0].revents().is_empty()
}

/// Opens the terminal `stream` again, so that reads and writes do not block. Duplicates it if its name does not
/// lead to the terminal.
fn open_again(stream: BorrowedFd, access: OFlags) -> io::Result<OwnedFd> {
    let flags = access | OFlags::NOCTTY | OFlags::NONBLOCK | OFlags::CLOEXEC;
    let again =
        ttyname(stream, Vec::new()).and_then(|name| rustix::fs::open(name, flags, Mode::empty()));
    again.or_else(|_| stream.try_clone_to_owned())
}

/// Polls `streams`. A signal ends the wait early.
pub(crate) fn wait(streams: &mut [PollFd], timeout: Option<Duration>) -> io::Result<()> {
    // A timeout too long for the system's type is infinite.
    let timeout = timeout.and_then(|timeout| Timespec::try_from(timeout).ok());
    match poll(streams, timeout.as_ref()) {
        Ok(_) => Ok(()),
        Err(Errno::INTR) => {
            streams.iter_mut().for_each(PollFd::clear_revents);
            Ok(())
        }
        Err(error) => Err(error.into()),
    }
}
