//! What tmux says about the terminal around it.
//!
//! A program in tmux sees a terminal of 256 colours, whatever the terminal around it shows. tmux
//! itself knows which features the attached client has, and which terminal it is.
//!
//! - A thread runs `tmux display` and stops it after a time-out. The start never waits for it.
//! - What a client reports is text from a stranger: names with unusual characters are dropped.
//! - tmux reads a terminal's features only when a client attaches (measured with 3.3a: after
//!   `set -as terminal-features`, an attached client got RGB by attaching again, not before).
//!
//! Rejected: a palette of one's own in a pane without RGB, even if the pane answers OSC 4. tmux
//! sends the nearest of its client's fixed 256 colours for a defined entry (measured with 3.3a).

use std::io::Read;
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, Receiver, TryRecvError};
use std::thread;
use std::time::{Duration, Instant};

use super::known::{Colors, Known, known};

/// The client of tmux that shows the program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TmuxClient {
    has_true_color: bool,
    /// The value of `TERM` outside of tmux; empty if it is unusual.
    term: String,
    known: Known,
}

/// The separator of the answer's parts, which no part contains.
const SEPARATOR: char = '|';
const FORMAT: &str = "#{client_termfeatures}|#{client_termtype}|#{client_termname}";

impl TmuxClient {
    /// Whether tmux sends 24-bit colours to the client.
    pub fn has_true_color(&self) -> bool {
        self.has_true_color
    }

    /// The command that makes tmux send 24-bit colours to the client from the next attachment on; `None`
    /// if it does so already, and if the client's terminal is not known to show them.
    pub fn remedy(&self) -> Option<String> {
        let is_missing = !self.has_true_color && self.known.colors != Colors::Unknown;
        (is_missing && !self.term.is_empty())
            .then(|| format!("set -as terminal-features ',{}:RGB'", self.term))
    }

    pub(super) fn known(&self) -> Known {
        self.known
    }

    /// The client in tmux's answer; `None` if the answer has another form.
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

/// A question to tmux that may still be unanswered.
#[derive(Debug)]
pub(super) struct Question(Receiver<Option<TmuxClient>>);

/// The state of a question.
#[derive(Debug)]
pub(super) enum Reply {
    Pending,
    Client(TmuxClient),
    Nothing,
}

impl Question {
    /// Asks the tmux that the environment names.
    pub(super) fn ask() -> Self {
        let (sender, receiver) = mpsc::channel();
        // Without a thread there is no answer, as without tmux.
        _ = thread::Builder::new().name("tmux".to_owned()).spawn(move || {
            // The session may have ended.
            _ = sender.send(answer(Command::new("tmux").args(["display", "-p", FORMAT]), TIMEOUT));
        });
        Self(receiver)
    }

    pub(super) fn reply(&self) -> Reply {
        match self.0.try_recv() {
            Ok(Some(client)) => Reply::Client(client),
            Err(TryRecvError::Empty) => Reply::Pending,
            Ok(None) | Err(TryRecvError::Disconnected) => Reply::Nothing,
        }
    }
}

/// The time that tmux has to answer.
const TIMEOUT: Duration = Duration::from_secs(2);
/// The largest answer that is read, in bytes.
const MOST: u64 = 4096;

fn answer(command: &mut Command, timeout: Duration) -> Option<TmuxClient> {
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
    child.stdout.take()?.take(MOST).read_to_end(&mut text).ok()?;
    TmuxClient::parse(&String::from_utf8_lossy(&text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::GlyphSet;

    #[test]
    fn the_answer_names_features_and_the_terminal() {
        let with = TmuxClient::parse("256,RGB,title|iTerm2 3.5|xterm-256color\n").unwrap();
        assert!(with.has_true_color() && with.remedy().is_none());
        let without = TmuxClient::parse("256,title|kitty(0.42.1)|xterm-kitty\n").unwrap();
        assert!(!without.has_true_color());
        assert_eq!(without.known().blocks, GlyphSet::Octant);
        let remedy = "set -as terminal-features ',xterm-kitty:RGB'";
        assert_eq!(without.remedy().as_deref(), Some(remedy));
        let unknown = TmuxClient::parse("title||xterm-256color\n").unwrap();
        assert_eq!(unknown.remedy(), None);
    }

    #[test]
    fn strange_answers_are_no_clients_and_give_no_commands() {
        for answer in ["", "\n", "||", "RGB", "RGB|kitty(1)", "RGB|kitty(1)|xterm|more"] {
            assert_eq!(TmuxClient::parse(answer), None, "{answer:?}");
        }
        let client = TmuxClient::parse("title|kitty(1)|x'; kill-server; '\n").unwrap();
        assert_eq!(client.remedy(), None);
        assert!(!TmuxClient::parse("NORGB,RGBA|a|b").unwrap().has_true_color());
    }

    #[test]
    fn a_missing_or_hanging_tmux_gives_no_answer_in_time() {
        let soon = Duration::from_millis(50);
        assert_eq!(answer(&mut Command::new("no-such-program"), soon), None);
        let began = Instant::now();
        assert_eq!(answer(Command::new("sleep").arg("60"), soon), None);
        assert!(began.elapsed() < Duration::from_secs(20));
    }
}
