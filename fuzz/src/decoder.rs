//! The decoder: bytes that a terminal sends, and the protocol that answers them.
//!
//! The first two bytes choose the terminal and the place where the stream is cut. The others are
//! the stream.
//!
//! - Events and answers do not depend on where the stream is cut. Its length bounds their number,
//!   the memory held, and all allocated memory.
//! - After any stream and a pause, a key is a key.
//! - Among frames, changes of the window and an emulator's own answers, the protocol returns the
//!   terminal to its original state.

use std::time::Duration;

use allocation_counter::measure;
use cellcaster::rng::SplitMix64;
use cellcaster::terminal::{
    Event, Key, KeyEvent, Modifiers, Phase, Protocol, SessionOptions, WindowSize,
};
use cellcaster::tui::canvas::Canvas;
use ratatui::style::Color;

use crate::alacritty::Alacritty;
use crate::bytes::Bytes;

const TERMS: [&str; 8] =
    ["xterm-256color", "xterm-kitty", "linux", "tmux-256color", "dumb", "alacritty", "vt220", ""];
/// Longer than the wait for the rest of any key or answer.
const PAUSE: Duration = Duration::from_secs(20);
/// The largest number of parts into which a stream is cut.
const MAX_PARTS: usize = 64;
/// The number of bytes allocated for a byte that arrives alone, including the answer to it.
const BYTES_OF_A_BYTE: u64 = 4 << 10;
/// The number of events that no byte causes, such as the first size of the window.
const FIRST_EVENTS: usize = 4;

/// Receives the stream as a whole, in parts, and among frames.
pub fn run(data: &[u8]) {
    let mut choices = Bytes::new(data);
    let (kind, seed) = (choices.byte(), choices.byte());
    let stream = choices.take(data.len());
    let whole = received(kind, [stream]);
    let mut rng = SplitMix64::new(seed.into());
    let cut = rng.below(stream.len() + 1);
    assert_eq!(received(kind, [&stream[..cut], &stream[cut..]]), whole, "cut at {cut}");
    assert_eq!(received(kind, stream.chunks(1)), whole, "in single bytes");
    assert_eq!(received(kind, stream.chunks(1 + rng.below(7))), whole, "in parts");
    converse(kind, stream);
}

fn protocol(kind: u8) -> Protocol {
    let term = TERMS[usize::from(kind) % TERMS.len()];
    let options = SessionOptions::from_environment(|name| match name {
        "TERM" => Some(term.to_owned()),
        "SSH_TTY" if kind >> 3 & 1 == 1 => Some("/dev/pts/0".to_owned()),
        "COLORTERM" if kind >> 4 & 1 == 1 => Some("truecolor".to_owned()),
        _ => None,
    });
    let pixels = if kind >> 5 & 1 == 1 { (320, 160) } else { (0, 0) };
    let mut protocol = Protocol::new(options, WindowSize::new((40, 10), pixels));
    protocol.begin(Duration::ZERO);
    protocol.set_mouse(kind >> 6 & 1 == 1);
    protocol
}

/// The result of a stream: events, and bytes to send.
fn received<'a>(kind: u8, parts: impl IntoIterator<Item = &'a [u8]>) -> (Vec<Event>, Vec<u8>) {
    let mut protocol = protocol(kind);
    let mut length = 0;
    let used = measure(|| {
        for part in parts {
            length += part.len();
            protocol.receive(part, Duration::ZERO);
        }
    });
    let most = 64 * 1024 + 512 * length as u64;
    assert!(used.bytes_max <= most, "{} bytes at once for {length}", used.bytes_max);
    let most = 64 * 1024 + BYTES_OF_A_BYTE * length as u64;
    assert!(used.bytes_total <= most, "{} bytes for {length}", used.bytes_total);
    let mut output = take_output(&mut protocol, Duration::ZERO);
    protocol.wake(PAUSE);
    output.extend(take_output(&mut protocol, PAUSE));
    let mut events: Vec<Event> = std::iter::from_fn(|| protocol.next_event()).collect();
    assert!(events.len() <= length + FIRST_EVENTS, "{} events for {length} bytes", events.len());
    protocol.receive(b"w", PAUSE);
    let key = KeyEvent {
        key: Key::Char('w'),
        base: None,
        modifiers: Modifiers { shift: false, control: false, alt: false },
        phase: Phase::Press,
    };
    let last: Vec<Event> = std::iter::from_fn(|| protocol.next_event()).collect();
    assert_eq!(last, [Event::Key(key)], "after the stream");
    events.extend(last);
    (events, output)
}

/// Takes the bytes to send, and marks them as sent.
fn take_output(protocol: &mut Protocol, now: Duration) -> Vec<u8> {
    let output = std::mem::take(protocol.output(now));
    protocol.written(now);
    output
}

/// A terminal, and the bytes that are on the way.
struct Conversation {
    protocol: Protocol,
    terminal: Alacritty,
    now: Duration,
    answers: Vec<u8>,
}

/// Sends the stream in parts, among frames and the terminal's own answers.
fn converse(kind: u8, stream: &[u8]) {
    let mut talk = Conversation {
        protocol: protocol(kind),
        terminal: Alacritty::new(40, 10),
        now: Duration::ZERO,
        answers: Vec::new(),
    };
    let mut rng = SplitMix64::new(u64::from(kind) + 1);
    let length = stream.len().div_ceil(MAX_PARTS).max(1);
    for part in stream.chunks(length) {
        talk.protocol.receive(part, talk.now);
        talk.do_something(rng.below(8), part[0]);
        while talk.protocol.next_event().is_some() {}
    }
    talk.end();
}

impl Conversation {
    fn do_something(&mut self, what: usize, byte: u8) {
        match what {
            0 => self.now += Duration::from_millis(byte.into()),
            1 => {
                let size = (1 + u16::from(byte) % 60, 1 + u16::from(byte) % 13);
                self.terminal.resize(size.0, size.1);
                self.protocol.resize(WindowSize::new(size, (0, 0)), self.now);
            }
            2 => self.protocol.set_mouse(byte & 1 == 1),
            3 => self.answer(),
            4 => self.wake(),
            _ if self.protocol.is_ready(self.now) => {
                self.protocol.draw(|screen| {
                    let color = Color::Rgb(byte, 0, 0);
                    screen.draw_character(u16::from(byte) % 40, 3, '@', [color, Color::Reset]);
                });
            }
            _ => self.answer(),
        }
        self.send();
    }

    /// Lets the terminal read everything that was sent.
    fn send(&mut self) {
        let bytes = take_output(&mut self.protocol, self.now);
        self.answers.extend(self.terminal.process(&bytes));
    }

    /// Delivers the answers of the terminal.
    fn answer(&mut self) {
        let answers = std::mem::take(&mut self.answers);
        self.protocol.receive(&answers, self.now);
    }

    fn wake(&mut self) {
        if let Some(time) = self.protocol.wakes_at() {
            self.now = self.now.max(time);
            self.protocol.wake(self.now);
        }
    }

    /// Ends the protocol, and checks the state of the terminal.
    fn end(mut self) {
        self.protocol.end(self.now);
        self.send();
        self.answer();
        self.now += PAUSE;
        assert!(self.protocol.has_ended(self.now), "the end does not come");
        self.protocol.finish();
        self.send();
        assert_eq!(self.terminal.modes(), Alacritty::new(1, 1).modes(), "modes are left");
        assert_eq!(self.terminal.entries_defined(), std::collections::BTreeSet::new());
    }
}
