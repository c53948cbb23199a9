//! The terminal around tmux, according to tmux.
//!
//! A program in tmux sees a terminal of 256 colours, whatever the terminal around it shows. tmux itself
//! knows which features the attached client has, and which terminal it is.
//!
//! - A thread runs each tmux command and stops it after a timeout. The start of a session never waits
//!   for it.
//! - Only the command in [`remedy`](TmuxClient::remedy) changes tmux, and it runs only for a player who
//!   has seen it.
//! - A client's report is text from a stranger. Names with unusual characters are dropped.
//! - tmux reads a terminal's features only when a client attaches (measured with 3.3a: after
//!   `set -as terminal-features`, an attached client got RGB by attaching again, not before).
//! - If the window keeps its size and `focus-events` is off, which is the default, nothing tells a
//!   program that a client attaches. Therefore a key after a pause may come from another client.
//!
//! Rejected: defining palette entries in a pane without RGB, even if the pane answers OSC 4. For a
//! defined entry, tmux sends the nearest of its client's fixed 256 colours (measured with 3.3a).

use std::io::Read;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::task::Poll;
use std::thread;
use std::time::{Duration, Instant};

use super::known::{TerminalProperties, TrueColorSupport, known};
use crate::tui::GlyphSet;

/// The client of tmux that shows the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TmuxClient {
    has_true_color: bool,
    /// The value of `TERM` outside of tmux. Empty if it contains unusual characters.
    term: String,
    known: TerminalProperties,
}

/// The separator between the parts of the answer. No part contains it.
const SEPARATOR: char = '|';
const FORMAT: &str = "#{client_termfeatures}|#{client_termtype}|#{client_termname}";

impl TmuxClient {
    /// Returns true if tmux sends 24-bit colours to the client.
    pub fn has_true_color(&self) -> bool {
        self.has_true_color
    }

    /// The command that makes tmux send 24-bit colours to the client from the next attachment on. `None`
    /// if tmux does so already, or if the client's terminal is not known to show them.
    pub fn remedy(&self) -> Option<String> {
        let feature = self.missing_feature()?;
        Some(format!("set -as terminal-features '{feature}'"))
    }

    /// The value that the remedy adds to `terminal-features`.
    fn missing_feature(&self) -> Option<String> {
        let is_missing = !self.has_true_color && self.known.colors != TrueColorSupport::Unknown;
        (is_missing && !self.term.is_empty()).then(|| format!(",{}:RGB", self.term))
    }

    /// The properties of the client's terminal, as far as tmux passes them on.
    pub(crate) fn known(&self) -> TerminalProperties {
        // tmux drops characters that its C library does not know, and the rest of the line moves. With
        // glibc 2.36 it drops all octants (measured with 3.3a), with older versions also sextants.
        let blocks = match self.known.blocks {
            GlyphSet::Sextant | GlyphSet::Octant => GlyphSet::Quadrant,
            blocks => blocks,
        };
        TerminalProperties { is_tmux: true, blocks, ..self.known }
    }

    /// The client in tmux's answer. `None` if the answer has another form.
    pub(crate) fn parse(answer: &str) -> Option<Self> {
        let mut parts = answer.trim_end_matches('\n').split(SEPARATOR);
        let (features, name, term) = (parts.next()?, parts.next()?, parts.next()?);
        if parts.next().is_some() || term.is_empty() {
            return None;
        }
        let is_usual =
            |letter: char| letter.is_ascii_alphanumeric() || ['-', '_', '.', '+'].contains(&letter);
        let term = if term.chars().all(is_usual) { term } else { "" };
        Some(Self {
            has_true_color: features.split(',').any(|feature| feature == "RGB"),
            term: term.to_owned(),
            known: known(name),
        })
    }
}

/// A tmux command that may still be running, with the parsed part of its answer.
#[derive(Debug)]
pub(crate) struct TmuxCommand<T>(Receiver<Option<T>>);

impl TmuxCommand<TmuxClient> {
    /// Asks the tmux that the environment names for its client.
    pub(crate) fn client() -> Self {
        Self::begin(|| {
            let text = output(Command::new("tmux").args(["display", "-p", FORMAT]), TIMEOUT)?;
            TmuxClient::parse(&text)
        })
    }
}

impl TmuxCommand<()> {
    /// Runs the remedy for `client`. `None` if there is no remedy.
    pub(crate) fn remedy(client: &TmuxClient) -> Option<Self> {
        let feature = client.missing_feature()?;
        Some(Self::begin(move || {
            let mut command = Command::new("tmux");
            output(command.args(["set", "-as", "terminal-features", &feature]), TIMEOUT).map(drop)
        }))
    }
}

impl<T: Send + 'static> TmuxCommand<T> {
    fn begin(work: impl FnOnce() -> Option<T> + Send + 'static) -> Self {
        let (sender, receiver) = mpsc::channel();
        // If no thread starts, there is no answer, as without tmux.
        _ = thread::Builder::new().name("tmux".to_owned()).spawn(move || {
            // The session may have ended.
            _ = sender.send(work());
        });
        Self(receiver)
    }

    /// The answer, once there is one. It is `None` if the command has failed or its answer is unknown.
    pub(crate) fn reply(&self) -> Poll<Option<T>> {
        match self.0.try_recv() {
            Err(TryRecvError::Empty) => Poll::Pending,
            answer => Poll::Ready(answer.ok().flatten()),
        }
    }
}

/// The time within which tmux must answer.
const TIMEOUT: Duration = Duration::from_secs(2);
/// The largest answer that is read, in bytes.
const MAX: u64 = 4096;

/// The output of `command`. `None` if it fails or runs longer than `timeout`.
fn output(command: &mut Command, timeout: Duration) -> Option<String> {
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::null());
    let mut child = quiet.spawn().ok()?;
    let began = Instant::now();
    let has_ended = loop {
        match child.try_wait() {
            Ok(None) if began.elapsed() < timeout => thread::sleep(Duration::from_millis(3)),
            Ok(Some(status)) => break status.success(),
            Ok(None) | Err(_) => break false,
        }
    };
    if !has_ended {
        // It has ended already, or ends now.
        _ = child.kill();
        _ = child.wait();
        return None;
    }
    let mut text = Vec::new();
    child.stdout.take()?.take(MAX).read_to_end(&mut text).ok()?;
    Some(String::from_utf8_lossy(&text).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_answer_names_features_and_the_terminal() {
        let with = TmuxClient::parse("256,RGB,title|iTerm2 3.5|xterm-256color\n").unwrap();
        assert!(with.has_true_color() && with.remedy().is_none());
        let without = TmuxClient::parse("256,title|kitty(0.42.1)|xterm-kitty\n").unwrap();
        assert!(!without.has_true_color());
        assert_eq!(without.known().blocks, GlyphSet::Quadrant);
        let remedy = "set -as terminal-features ',xterm-kitty:RGB'";
        assert_eq!(without.remedy().as_deref(), Some(remedy));
        let unknown = TmuxClient::parse("title||xterm-256color\n").unwrap();
        assert_eq!(unknown.remedy(), None);
    }

    #[test]
    fn strange_answers_give_no_client_and_no_command() {
        for answer in ["", "\n", "||", "RGB", "RGB|kitty(1)", "RGB|kitty(1)|xterm|more"] {
            assert_eq!(TmuxClient::parse(answer), None, "{answer:?}");
        }
        let client = TmuxClient::parse("title|kitty(1)|x'; kill-server; '\n").unwrap();
        assert_eq!(client.remedy(), None);
        assert!(!TmuxClient::parse("NORGB,RGBA|a|b").unwrap().has_true_color());
    }

    #[test]
    fn a_missing_or_hanging_tmux_is_given_up_in_time() {
        let soon = Duration::from_millis(50);
        assert_eq!(output(&mut Command::new("no-such-program"), soon), None);
        let began = Instant::now();
        assert_eq!(output(Command::new("sleep").arg("60"), soon), None);
        assert!(began.elapsed() < Duration::from_secs(20));
    }
}
