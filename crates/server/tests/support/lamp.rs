//! Measures the time from a key to the frame that answers it.
//!
//! Frames arrive all the time while other members walk, so the bytes after a key seldom answer it. A client
//! therefore lights its lamp now and then. The room decides about the lamp, in a cluster through its log. The
//! first frame with the lit lamp contains `lamp` in its status line, and no other text contains that word.
//!
//! The server's tests include the tests of this module.

use std::time::{Duration, Instant};

/// The state of a client's lamp.
#[derive(Debug, Default)]
pub(crate) struct Lamp {
    state: State,
    /// The last bytes, which may contain the start of the word.
    tail: Vec<u8>,
}

#[derive(Clone, Copy, Debug, Default)]
enum State {
    #[default]
    Out,
    /// The key to light it was pressed at this time, and no frame has shown the lamp yet.
    Awaited(Instant),
    /// A frame has shown the lamp, and it has not been put out.
    Lit,
}

/// How long a key may go unanswered before it is forgotten.
const TIMEOUT: Duration = Duration::from_secs(5);
const WORD: &[u8] = b"lamp";

impl Lamp {
    /// Records that the key was pressed. Only a key that lights the lamp is timed.
    pub(crate) fn press(&mut self, now: Instant) {
        self.state = match self.state {
            State::Out => State::Awaited(now),
            State::Awaited(_) | State::Lit => State::Out,
        };
        self.tail.clear();
    }

    /// Returns true if the key should be pressed at once to put the lamp out.
    pub(crate) fn is_lit(&self) -> bool {
        matches!(self.state, State::Lit)
    }

    /// Returns true while a key waits for its answer.
    pub(crate) fn is_awaited(&self) -> bool {
        matches!(self.state, State::Awaited(_))
    }

    /// Returns true if a key was not answered in time, and forgets it.
    pub(crate) fn gives_up(&mut self, now: Instant) -> bool {
        let State::Awaited(pressed) = self.state else { return false };
        let gives_up = now.saturating_duration_since(pressed) > TIMEOUT;
        if gives_up {
            self.state = State::Out;
        }
        gives_up
    }

    /// Reads received bytes; returns the time since the key if they answer it.
    pub(crate) fn read(&mut self, bytes: &[u8], now: Instant) -> Option<Duration> {
        let State::Awaited(pressed) = self.state else { return None };
        self.tail.extend_from_slice(bytes);
        if self.tail.windows(WORD.len()).any(|window| window == WORD) {
            self.state = State::Lit;
            return Some(now.saturating_duration_since(pressed));
        }
        self.tail.drain(..self.tail.len().saturating_sub(WORD.len() - 1));
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MILLISECOND: Duration = Duration::from_millis(1);

    #[test]
    fn unrelated_frames_do_not_stop_the_timer() {
        let begun = Instant::now();
        let mut lamp = Lamp::default();
        let lit = b"\x1b[?2026h\x1b[35Dlamp\x1b[?2026l\x1b[5n";
        assert_eq!(lamp.read(lit, begun), None);
        lamp.press(begun);
        assert_eq!(lamp.read(b"\x1b[?2026h\x1b[23H \x1b[?2026l\x1b[5n", begun + MILLISECOND), None);
        let (first, rest) = lit.split_at(15);
        assert_eq!(lamp.read(first, begun + 20 * MILLISECOND), None);
        let now = begun + 30 * MILLISECOND;
        assert_eq!(lamp.read(rest, now), Some(30 * MILLISECOND));
        assert_eq!(lamp.read(lit, now), None);
        assert!(lamp.is_lit());
        lamp.press(now);
        assert_eq!(lamp.read(lit, now), None);
    }

    #[test]
    fn an_unanswered_key_is_forgotten() {
        let begun = Instant::now();
        let mut lamp = Lamp::default();
        lamp.press(begun);
        assert!(!lamp.gives_up(begun + TIMEOUT) && lamp.is_awaited());
        assert!(lamp.gives_up(begun + TIMEOUT + MILLISECOND) && !lamp.is_awaited());
        assert!(!lamp.gives_up(begun + 2 * TIMEOUT));
    }
}
