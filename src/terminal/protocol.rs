//! The protocol between a program and a terminal: bytes in, events and bytes out.
//!
//! A [`Protocol`] has neither a device nor a clock: times are arguments, durations since any fixed
//! moment. So one implementation serves the terminal of the process ([`Session`](super::Session)), a
//! channel of an SSH server, and a test that decides what arrives when. A trait of a device was
//! refused: a server waits for many channels at once, and a device that blocks would need a thread
//! for each of them.

mod changes;
mod extensions;
mod fences;
mod receive;
mod reports;
mod show;

use std::collections::VecDeque;
use std::time::Duration;

use crossterm::terminal::LeaveAlternateScreen;

pub(crate) use self::changes::Changes;
use self::extensions::Extensions;
use super::flow::{Flow, Request};
use super::input::Decoder;
use super::known::Known;
use super::mouse::MouseUnits;
use super::{
    CellWriter, ColorSource, Detected, Event, Fidelity, Options, TmuxClient, WindowSize, sequence,
};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::tui::GlyphSet;

/// One side of the protocol between a program and a terminal: it turns the terminal's bytes into
/// [`Event`]s, and frames into bytes.
///
/// The caller passes the received bytes to [`Protocol::receive`], takes events from
/// [`Protocol::next_event`], sends what is in [`Protocol::output`], and reports with
/// [`Protocol::written`] that it was sent. Frames are drawn while [`Protocol::is_ready`].
///
/// ```
/// use std::time::Duration;
///
/// use cellcaster::tui::canvas::Canvas;
/// use cellcaster::terminal::{Event, Key, Options, Protocol, WindowSize};
/// use ratatui::style::Color;
///
/// let options = Options::from_environment(|name| (name == "TERM").then(|| "xterm".to_owned()));
/// let mut protocol = Protocol::new(options, WindowSize::of_cells(80, 24));
/// let now = Duration::ZERO;
/// protocol.begin(now);
/// protocol.output(now).clear(); // sent to the terminal
/// protocol.receive(b"w", now);
/// assert!(matches!(protocol.next_event(), Some(Event::Key(event)) if event.key == Key::Char('w')));
/// protocol.draw(|screen| screen.draw_character(0, 0, '@', [Color::Reset; 2]));
/// assert!(protocol.output(now).contains(&b'@'));
/// protocol.output(now).clear();
/// assert!(!protocol.is_ready(now)); // it waits until the terminal has answered
/// ```
#[derive(Debug)]
pub struct Protocol {
    options: Options,
    /// Bytes that the caller has not taken yet.
    output: Vec<u8>,
    /// Encodes frames; its bytes are moved to `output`.
    writer: CellWriter<Vec<u8>>,
    decoder: Decoder,
    received_at: Duration,
    events: VecDeque<Event>,
    size: WindowSize,
    color_depth: Detected,
    color_source: ColorSource,
    /// What the terminal's name says.
    known: Known,
    /// The client of the tmux in which the program runs.
    tmux: Option<TmuxClient>,
    key_releases: KeyReleases,
    mouse: Mouse,
    flow: Flow,
    /// `None` for the best fidelity that the link allows.
    fidelity: Option<Fidelity>,
    /// The frame that is encoded and not yet in `output`.
    drawn: Option<Drawn>,
    extensions: Extensions,
    changes: Changes,
    /// Whether the terminal is given back, so that no report is switched on any more.
    is_ending: bool,
    /// The number of frames that were sent before the keyboard flags were pushed.
    frames_before_key_flags: u64,
}

/// What a frame shows.
#[derive(Clone, Copy, Debug)]
enum Drawn {
    /// A new picture, at this fidelity.
    Motion(Fidelity),
    /// The last picture, more exactly.
    Refinement,
}

/// The state of mouse reports.
#[derive(Clone, Copy, Debug, Default)]
struct Mouse {
    /// The unit of positions; `None` if the mouse is not reported.
    units: Option<MouseUnits>,
    /// Whether the terminal can report positions in pixels.
    has_pixels: bool,
    /// Whether reports may still be in the previous unit.
    is_changing: bool,
}

/// Whether the terminal reports when keys are released.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum KeyReleases {
    Unasked,
    Asked,
    Settled,
}

impl Protocol {
    /// The protocol with a terminal of which `options` are known. Nothing is sent yet.
    pub fn new(options: Options, size: WindowSize) -> Self {
        let mut writer = CellWriter::new(Vec::new(), size.cells());
        writer.set_ascii(options.is_ascii);
        Self {
            options,
            output: Vec::new(),
            writer,
            decoder: Decoder::default(),
            received_at: Duration::ZERO,
            events: VecDeque::new(),
            size,
            color_depth: options.color_depth,
            color_source: options.color_source,
            known: Known::default(),
            tmux: None,
            key_releases: KeyReleases::Unasked,
            mouse: Mouse::default(),
            flow: Flow::new(options.is_remote),
            fidelity: options.fidelity,
            drawn: None,
            extensions: Extensions::default(),
            changes: Changes::default(),
            is_ending: false,
            frames_before_key_flags: 0,
        }
    }

    /// Takes the terminal's screen and queries its capabilities. The answers arrive as events.
    pub fn begin(&mut self, now: Duration) {
        self.take_screen();
        let mut queries = String::new();
        if self.options.ask_for_key_releases {
            queries.push_str(sequence::QUERY_KEY_FLAGS);
            self.key_releases = KeyReleases::Asked;
        }
        if self.options.ask_for_mouse_pixels {
            queries.push_str(sequence::QUERY_MOUSE_PIXELS);
        }
        if self.options.ask_for_version {
            queries.push_str(sequence::QUERY_VERSION);
        }
        if self.options.probe_extensions && !self.options.is_ascii {
            self.probe_extensions(&mut queries);
        }
        // A terminal that does not understand a query may print a part of it.
        queries.push_str(sequence::ERASE);
        // As after a frame: if the fence is answered first, no answer to this request will arrive.
        queries.push_str(sequence::QUERY_STATUS);
        self.flow.sent(now, 0, Request::Status);
        self.queue_queries(&queries, now);
    }

    /// Takes the screen again after others had it; the next frame is drawn whole.
    pub(crate) fn begin_again(&mut self, size: WindowSize) {
        self.take_screen();
        self.repaint(size);
    }

    fn take_screen(&mut self) {
        let mut text = String::new();
        self.is_ending = false;
        self.changes.push_start(&mut text);
        self.frames_before_key_flags = self.flow.frames_sent();
        self.confirm_key_flags();
        self.output.extend_from_slice(text.as_bytes());
    }

    /// Forgets what the terminal has not answered, and half a key: others have the terminal now.
    pub(crate) fn interrupt(&mut self) {
        self.output.clear();
        self.writer.output_mut().clear();
        self.drawn = None;
        self.flow.forget();
        self.changes.fences.forget();
        self.decoder = Decoder::default();
        self.mouse.is_changing = false;
    }

    /// Undoes all changes of the terminal's state, except that it shows the alternate screen until
    /// [`Protocol::finish`]. Between the two, what the terminal still sends is discarded, so that
    /// no answer and no key release reaches a shell.
    pub fn end(&mut self, now: Duration) {
        let text = self.changes.end(now);
        self.output.extend_from_slice(text.as_bytes());
        self.is_ending = true;
    }

    /// Whether nothing is expected from the terminal after [`Protocol::end`] any more.
    pub fn has_ended(&self, now: Duration) -> bool {
        self.changes.fences.time_left(now).is_none()
    }

    /// Leaves the alternate screen, which is the last thing to send.
    pub fn finish(&mut self) {
        self.output.extend_from_slice(sequence::of(LeaveAlternateScreen).as_bytes());
    }

    /// The bytes to send at `now`. The caller removes those that it has taken, and sends them in this
    /// order.
    pub fn output(&mut self, now: Duration) -> &mut Vec<u8> {
        self.queue_frame(now);
        &mut self.output
    }

    /// Records that the system has accepted all bytes so far.
    pub fn written(&mut self, now: Duration) {
        self.flow.written(now);
    }

    /// What must be undone at the end, and which answers may still arrive.
    pub(crate) fn changes(&self) -> Changes {
        self.changes
    }

    /// The size of the window in cells, and in pixels if it is known.
    pub fn size(&self) -> WindowSize {
        self.size
    }

    /// The number of colours that the terminal shows, as far as it is known.
    pub fn color_depth(&self) -> ColorDepth {
        self.color_depth.depth()
    }

    /// The source of [`Protocol::color_depth`].
    pub fn color_source(&self) -> ColorSource {
        self.color_source
    }

    /// The finest block glyphs that the terminal is known to draw.
    pub fn glyph_support(&self) -> GlyphSet {
        self.known.blocks
    }

    /// How the terminal draws shades, as far as it is known.
    pub fn shade_ink(&self) -> ShadeInk {
        self.known.shades
    }

    /// Whether the terminal has answered that it is tmux.
    pub fn is_tmux(&self) -> bool {
        self.known.is_tmux
    }

    /// The client of the tmux in which the program runs, if that has answered.
    pub fn tmux_client(&self) -> Option<&TmuxClient> {
        self.tmux.as_ref()
    }
}

#[cfg(test)]
mod tests;
