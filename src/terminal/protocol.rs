//! The protocol between a program and a terminal: bytes in, events and bytes out.
//!
//! A [`Protocol`] has neither a device nor a clock. Times are arguments: durations since any fixed moment. One
//! implementation therefore serves the terminal of the process ([`Session`](super::Session)), a channel of an SSH
//! server, and a test that decides what arrives when.
//!
//! Some control sequences make frames shorter. They are used only if the terminal proves that they work. The program
//! probes two at the beginning. A repeated half block (REP) must move the cursor as far as it should. An entry of the
//! palette, defined in the form that frames use (OSC 4), must be reported as defined, and with its old colour after a
//! reset (OSC 104). No terminal is trusted by its name or version, because some terminals claim to repeat characters
//! and fail on half blocks. A terminal with 256 colours whose palette can be defined and reset shows 24-bit colours
//! as palette entries. Neither sequence is probed in a multiplexer, because it would answer for itself. Neither is
//! probed if a recorder receives the sent bytes, because a recording must play on any terminal.
//!
//! Rejected: a device trait. A server waits for many channels at once, and a device that blocks would need a thread
//! for each of them.

use std::collections::VecDeque;
use std::num::NonZero;
use std::time::Duration;

use crossterm::terminal::LeaveAlternateScreen;
use ratatui::backend::Backend;

use super::event::MouseUnits;
use super::flow::{Flow, Request};
use super::input::{Answer, Decoder, TerminalInput};
use super::known::{TerminalProperties, TrueColorSupport};
use super::sequence::{KeyFlags, TerminalChanges};
use super::{
    CellWriter, ColorSource, Detected, Effort, Event, Fidelity, Key, KeyEvent, Phase, QuitReason,
    Screen, SessionOptions, TmuxClient, WindowSize, sequence,
};
use crate::color::palette::{ColorDepth, ShadeInk};
use crate::tui::GlyphSet;

/// The program's side of the protocol between a program and a terminal: it turns the terminal's bytes into
/// [`Event`]s, and frames into bytes.
///
/// The caller passes the received bytes to [`Protocol::receive`], takes events from [`Protocol::next_event`], sends
/// the bytes in [`Protocol::output`], and reports with [`Protocol::written`] that they were sent. It draws frames
/// while [`Protocol::is_ready`] returns `true`.
///
/// ```
/// use std::time::Duration;
///
/// use cellcaster::tui::canvas::Canvas;
/// use cellcaster::terminal::{Event, Key, Protocol, SessionOptions, WindowSize};
/// use ratatui::style::Color;
///
/// let options = SessionOptions::from_environment(|name| (name == "TERM").then(|| "xterm".to_owned()));
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
    /// The properties of the terminal as far as they are known, and the ways to use it.
    options: SessionOptions,
    /// Bytes that the caller has not taken yet.
    output: Vec<u8>,
    /// Encodes frames; its bytes are moved to `output`.
    writer: CellWriter<Vec<u8>>,
    decoder: Decoder,
    received_at: Duration,
    events: VecDeque<Event>,
    size: WindowSize,
    /// The terminal's properties, derived from its name.
    known: TerminalProperties,
    /// The client of the tmux in which the program runs.
    tmux: Option<TmuxClient>,
    /// `true` while an answer about reports of key releases is expected.
    awaits_key_releases: bool,
    mouse: Mouse,
    flow: Flow,
    /// The kind of the frame that is encoded but not yet in `output`.
    drawn: Option<FrameKind>,
    palette: PaletteProbe,
    changes: TerminalChanges,
    /// `true` once the terminal is being given back. From then on, no report is switched on.
    is_ending: bool,
    /// The number of frames that were sent before the keyboard flags were pushed.
    frames_before_key_flags: u64,
}

/// The kind of a frame.
#[derive(Clone, Copy, Debug)]
enum FrameKind {
    /// A new picture, at this fidelity and with this effort.
    Motion(Fidelity, Effort),
    /// The last picture again, more exact.
    Refinement,
}

/// The state of mouse reports. Their unit is in [`TerminalChanges`].
#[derive(Clone, Copy, Debug, Default)]
struct Mouse {
    /// Whether the terminal can report positions in pixels.
    has_pixels: bool,
    /// `true` while reports may still be in the previous unit.
    is_changing: bool,
}

impl Protocol {
    /// A protocol for a terminal with these `options`. Nothing is sent yet.
    pub fn new(options: SessionOptions, size: WindowSize) -> Self {
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
            known: TerminalProperties::default(),
            tmux: None,
            awaits_key_releases: false,
            mouse: Mouse::default(),
            flow: Flow::new(options.is_remote),
            drawn: None,
            palette: PaletteProbe::default(),
            changes: TerminalChanges::default(),
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
            self.awaits_key_releases = true;
        }
        if self.options.ask_for_mouse_pixels {
            queries.push_str(sequence::QUERY_MOUSE_PIXELS);
        }
        if self.options.ask_for_version {
            queries.push_str(sequence::QUERY_VERSION);
        }
        if self.options.probe_extensions && !self.options.is_ascii {
            queries.push_str(sequence::PROBE_PALETTE);
            queries.push_str(sequence::PROBE_REPETITION);
            self.changes.palette_defined = true;
        }
        // A terminal that does not understand a query may print a part of it.
        queries.push_str(sequence::ERASE);
        // As after a frame, if the fence is answered first, no answer to this request will arrive.
        queries.push_str(sequence::QUERY_STATUS);
        self.flow.sent(now, 0, Request::Status);
        self.queue_queries(&queries, now);
    }

    /// Takes the screen again after other programs have used it. The next frame is drawn in full.
    pub(crate) fn begin_again(&mut self, size: WindowSize) {
        self.take_screen();
        self.repaint(size);
    }

    fn take_screen(&mut self) {
        let text = self.changes.start();
        self.is_ending = false;
        self.frames_before_key_flags = self.flow.frames_sent();
        self.confirm_key_flags();
        self.output.extend_from_slice(text.as_bytes());
    }

    /// Drops unsent bytes, unanswered requests and the start of a key, because other programs use the terminal now.
    pub(crate) fn interrupt(&mut self) {
        self.output.clear();
        self.writer.output_mut().clear();
        self.drawn = None;
        self.flow.forget();
        self.changes.fences.forget();
        self.decoder = Decoder::default();
        self.mouse.is_changing = false;
    }

    /// Undoes all changes to the terminal's state, but keeps the alternate screen until [`Protocol::finish`]. Between
    /// the two calls, input from the terminal is discarded, so that no answer and no key release reaches a shell.
    pub fn end(&mut self, now: Duration) {
        let text = self.changes.end(now);
        self.output.extend_from_slice(text.as_bytes());
        self.is_ending = true;
    }

    /// Returns true when no more input is expected from the terminal after [`Protocol::end`].
    pub fn has_ended(&self, now: Duration) -> bool {
        self.changes.fences.time_left(now).is_none()
    }

    /// Leaves the alternate screen. These are the last bytes to send.
    pub fn finish(&mut self) {
        self.output.extend_from_slice(sequence::of(LeaveAlternateScreen).as_bytes());
    }

    /// The bytes to send at `now`, in order. The caller removes the bytes that it has taken.
    pub fn output(&mut self, now: Duration) -> &mut Vec<u8> {
        self.queue_frame(now);
        &mut self.output
    }

    /// Records that the system has accepted all bytes of the output.
    pub fn written(&mut self, now: Duration) {
        self.flow.written(now);
    }

    /// The changes to undo at the end, and the answers that may still arrive.
    pub(crate) fn changes(&self) -> TerminalChanges {
        self.changes
    }

    /// The size of the window in cells, and in pixels if it is known.
    pub fn size(&self) -> WindowSize {
        self.size
    }

    /// The number of colours that the terminal shows, as far as it is known.
    pub fn color_depth(&self) -> ColorDepth {
        self.options.color_depth.depth()
    }

    /// The source of [`Protocol::color_depth`].
    pub fn color_source(&self) -> ColorSource {
        self.options.color_source
    }

    /// The finest block glyphs that the terminal is known to draw.
    pub fn glyph_support(&self) -> GlyphSet {
        self.known.blocks
    }

    /// The way in which the terminal draws shades, as far as it is known.
    pub fn shade_ink(&self) -> ShadeInk {
        self.known.shades
    }

    /// Returns true if the terminal has answered that it is tmux.
    pub fn is_tmux(&self) -> bool {
        self.known.is_tmux
    }

    /// The client of the tmux in which the program runs, if tmux has answered.
    pub fn tmux_client(&self) -> Option<&TmuxClient> {
        self.tmux.as_ref()
    }

    /// Interprets bytes from the terminal. They may be cut at any place.
    pub fn receive(&mut self, bytes: &[u8], now: Duration) {
        self.received_at = now;
        self.flow.advance(now);
        let mut inputs = Vec::new();
        self.decoder.feed(bytes, |input| inputs.push(input));
        for input in inputs {
            self.take_input(input, now);
        }
    }

    /// The next event, in the order of arrival.
    pub fn next_event(&mut self) -> Option<Event> {
        self.events.pop_front()
    }

    /// Records a new size of the window. The next frame is drawn in full.
    pub fn resize(&mut self, size: WindowSize, now: Duration) {
        self.repaint(size);
        self.update_mouse_units(now);
    }

    /// The time at which to call [`Protocol::wake`] if no bytes arrive before. `None` means never.
    pub fn wakes_at(&self) -> Option<Duration> {
        self.gives_up_at().into_iter().chain(self.opens_at()).min()
    }

    /// Does the work that is due: ends the wait for the rest of a key, and asks a terminal that has stopped answering
    /// whether it is still there.
    pub fn wake(&mut self, now: Duration) {
        if self.gives_up_at().is_some_and(|time| time <= now) {
            self.give_up();
        }
        self.probe(now);
    }

    /// Turns reports of the mouse on or off. They are off at first. Positions are in pixels if the terminal can
    /// report them.
    pub fn set_mouse(&mut self, is_reported: bool) {
        if self.changes.mouse.is_some() != is_reported && !self.is_ending {
            self.mouse.is_changing = false;
            self.change_mouse(is_reported.then(|| self.mouse_units()));
        }
    }

    pub(crate) fn push_event(&mut self, event: Event) {
        self.events.push_back(event);
    }

    /// Returns true if `is_such` holds for an event that has not been taken yet.
    pub(crate) fn has_event(&self, is_such: impl Fn(&Event) -> bool) -> bool {
        self.events.iter().any(is_such)
    }

    /// Returns true if an event asks the program to end.
    pub(crate) fn is_asked_to_quit(&self) -> bool {
        self.has_event(|event| matches!(event, Event::Quit(_)))
    }

    /// The time at which the start of a key is taken for a whole key.
    pub(crate) fn gives_up_at(&self) -> Option<Duration> {
        self.decoder.timeout().map(|timeout| self.received_at + timeout)
    }

    /// Stops waiting for the rest of a key.
    pub(crate) fn give_up(&mut self) {
        let events = &mut self.events;
        self.decoder.give_up(|input| {
            // An answer is always a whole unit, never the start of one.
            if let TerminalInput::Key(event) = input {
                events.push_back(meaning(event));
            }
        });
    }

    fn take_input(&mut self, input: TerminalInput, now: Duration) {
        match input {
            TerminalInput::Key(event) => {
                self.flow.received_input();
                self.events.push_back(meaning(event));
            }
            TerminalInput::Focus(true) => self.events.push_back(Event::FocusGained),
            TerminalInput::Focus(false) => self.events.push_back(Event::FocusLost),
            TerminalInput::Mouse(report) => {
                self.flow.received_input();
                let units = self.changes.mouse.filter(|_| !self.mouse.is_changing);
                let event = units.and_then(|units| report.event(units, self.size));
                self.events.extend(event.map(Event::Mouse));
            }
            TerminalInput::Answer(answer) => self.take_answer(answer, now),
        }
    }

    fn take_answer(&mut self, answer: Answer, now: Duration) {
        match answer {
            Answer::PixelMouse => {
                self.mouse.has_pixels = true;
                self.update_mouse_units(now);
            }
            Answer::KeyFlags => self.settle_key_releases(true),
            Answer::TrueColor => self.raise_color_depth(),
            Answer::Version(known) => self.identify(known, now),
            // Without a probe, an answer belongs to another program.
            Answer::Repeats if self.changes.palette_defined => self.writer.set_repeats(true),
            Answer::PaletteEntry(color) if self.changes.palette_defined => {
                self.palette = self.palette.after_report(color);
                self.use_palette();
            }
            Answer::Repeats | Answer::PaletteEntry(_) => {}
            Answer::Status => {
                self.flow.answered(now);
                self.changes.awaits_statuses = self.flow.awaits_answers();
                self.confirm_key_flags();
            }
            Answer::Fence => {
                self.changes.fences.answered();
                self.mouse.is_changing &= self.changes.fences.are_open();
                self.flow.fence_answered(now);
                self.changes.awaits_statuses = self.flow.awaits_answers();
                self.confirm_key_flags();
                self.settle_key_releases(false);
                if !self.changes.fences.are_open() {
                    self.use_own_palette();
                }
            }
        }
    }

    /// The finest unit in which the terminal reports positions.
    fn mouse_units(&self) -> MouseUnits {
        if self.mouse.has_pixels && self.size.pixels.is_some() {
            MouseUnits::Pixels
        } else {
            MouseUnits::Cells
        }
    }

    /// If the mouse is reported, switches to the finest unit that is available.
    fn update_mouse_units(&mut self, now: Duration) {
        let finest = self.mouse_units();
        if self.changes.mouse.is_none_or(|units| units == finest) || self.is_ending {
            return;
        }
        self.mouse.is_changing = true;
        self.change_mouse(Some(finest));
        // Reports after the answer are in the new unit.
        self.queue_queries("", now);
    }

    fn change_mouse(&mut self, units: Option<MouseUnits>) {
        let text = self.changes.change_mouse(units);
        self.output.extend_from_slice(text.as_bytes());
    }

    fn settle_key_releases(&mut self, agreed: bool) {
        if std::mem::take(&mut self.awaits_key_releases) {
            let agreed = agreed && !self.is_ending;
            if agreed {
                self.changes.key_flags = KeyFlags::Pushed;
                self.frames_before_key_flags = self.flow.frames_sent();
                self.output.extend_from_slice(sequence::PUSH_KEY_FLAGS.as_bytes());
                self.confirm_key_flags();
            }
            self.events.push_back(Event::KeyReleases(agreed));
        }
    }

    /// Records that the terminal has received the keyboard flags, if it has answered all frames before
    /// them.
    fn confirm_key_flags(&mut self) {
        let key_flags = &mut self.changes.key_flags;
        if *key_flags == KeyFlags::Pushed
            && self.flow.frames_answered() >= self.frames_before_key_flags
        {
            *key_flags = KeyFlags::Received;
        }
    }

    fn identify(&mut self, known: TerminalProperties, now: Duration) {
        match known.colors {
            TrueColorSupport::True => self.raise_color_depth(),
            TrueColorSupport::Ask if matches!(self.options.color_depth, Detected::Guess(_)) => {
                self.queue_queries(sequence::QUERY_TRUE_COLOR, now);
            }
            TrueColorSupport::Ask | TrueColorSupport::Unknown => {}
        }
        // In tmux, tmux itself describes the terminal around it in more detail.
        if self.tmux.is_none() && self.known != known {
            self.known = known;
            self.events.push_back(Event::Identified);
        }
    }

    /// Records tmux's report about the client that shows the program. A depth that the user has chosen stays.
    pub(crate) fn take_tmux_client(&mut self, client: TmuxClient) {
        if let Detected::Guess(before) = self.options.color_depth {
            let depth =
                if client.has_true_color() { ColorDepth::True } else { ColorDepth::Indexed256 };
            self.options.color_depth = Detected::Guess(depth);
            self.options.color_source = ColorSource::Tmux;
            if depth != before {
                self.events.push_back(Event::ColorDepth(depth));
            }
        }
        if self.tmux.as_ref() != Some(&client) {
            self.known = client.known();
            self.tmux = Some(client);
            self.events.push_back(Event::Identified);
        }
    }

    fn raise_color_depth(&mut self) {
        if let Detected::Guess(_) = self.options.color_depth {
            self.options.color_depth = Detected::Certain(ColorDepth::True);
            self.options.color_source = ColorSource::Answer;
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
            self.use_palette();
        }
    }

    /// Forgets the screen and records the size of the window. The next frame is drawn in full.
    pub(crate) fn repaint(&mut self, size: WindowSize) {
        self.size = size;
        self.writer.forget();
        self.writer.set_size(self.size.cells());
        // The writer writes only to memory, so this cannot fail.
        _ = Backend::clear(&mut self.writer);
        if self.events.back() != Some(&Event::Resized) {
            self.events.push_back(Event::Resized);
        }
    }

    /// Draws a frame on a blank screen. The changes since the last frame are added to the
    /// [output](Protocol::output).
    pub fn draw(&mut self, render: impl FnOnce(&mut Screen)) {
        let (fidelity, effort) = match self.options.fidelity {
            Some(fidelity) => (fidelity, self.flow.quality().1),
            None => self.flow.quality(),
        };
        self.writer.set_fidelity(fidelity);
        self.writer.set_effort(effort);
        self.writer.draw_frame(render);
        self.drawn = Some(FrameKind::Motion(fidelity, effort));
    }

    /// Shows the last frame more exactly, unless it is exact.
    pub fn refine(&mut self) {
        self.writer.refine();
        self.drawn = Some(FrameKind::Refinement);
    }

    /// Rings the terminal's bell with the next frame.
    pub fn ring_bell(&mut self) {
        self.writer.output_mut().push(BELL);
    }

    /// Returns true if the terminal shows the last drawn frame exactly. If it does not, a few calls of
    /// [`Protocol::refine`] make it exact.
    pub fn is_settled(&self) -> bool {
        self.writer.is_settled()
    }

    /// Returns true if a frame would be shown at once, not behind other frames in flight.
    pub fn is_ready(&self, now: Duration) -> bool {
        self.output.is_empty() && self.flow.may_send(now)
    }

    /// The time from which on [`Protocol::is_ready`] is true if nothing arrives before. `None` means never.
    pub fn ready_at(&self, now: Duration) -> Option<Duration> {
        self.flow.ready_at(now).filter(|_| self.output.is_empty())
    }

    /// Sets the fidelity of frames of motion. `None` means the best fidelity that the link allows.
    pub fn set_fidelity(&mut self, fidelity: Option<Fidelity>) {
        self.options.fidelity = fidelity;
    }

    /// Limits the bytes per second that frames take on the wire. `None` means no limit.
    pub fn set_budget(&mut self, bytes_per_second: Option<NonZero<u32>>) {
        self.flow.set_budget(bytes_per_second);
    }

    /// The least time between two frames of motion under the budget. Zero if the budget allows exact frames.
    pub fn frame_time(&self) -> Duration {
        self.flow.frame_time()
    }

    /// The time from which on the budget allows the next frame. The caller decides whether to wait.
    pub fn budget_opens_at(&self) -> Duration {
        self.flow.budget_opens_at()
    }

    /// Records that the wire has carried frames of `bytes` bytes with `on_wire` bytes, so that the budget counts the
    /// bytes after compression and encryption.
    pub fn carried(&mut self, bytes: usize, on_wire: usize) {
        self.flow.carried(bytes, on_wire);
    }

    /// Sets the effort to prefer for frames that are not exact. It is greedy if the processor is short.
    pub fn set_effort(&mut self, effort: Effort) {
        self.flow.set_effort(effort);
    }

    /// Sets whether frames are restricted to ASCII. After a change, the next frame is sent in full.
    pub fn set_ascii(&mut self, is_ascii: bool) {
        if self.options.is_ascii != is_ascii {
            self.options.is_ascii = is_ascii;
            self.writer.set_ascii(is_ascii);
        }
    }

    /// The current fidelity of frames of motion.
    pub fn fidelity(&self) -> Fidelity {
        self.options.fidelity.unwrap_or_else(|| self.flow.quality().0)
    }

    /// Returns true if a network makes frames of motion coarser than necessary. In that case, `ssh -C` helps if it is
    /// not in use.
    pub fn is_limited_by_network(&self) -> bool {
        self.options.is_remote
            && self.options.fidelity.is_none()
            && self.flow.quality().0 > Fidelity::EXACT
    }

    /// The round-trip time of the terminal's latest answer. `None` if the terminal does not answer.
    pub fn round_trip(&self) -> Option<Duration> {
        self.flow.round_trip()
    }

    /// The number of frames sent. A frame that changed nothing does not count.
    pub fn frames_sent(&self) -> u64 {
        self.flow.frames_sent()
    }

    /// The number of frames that the terminal shows, as far as is known. These are the frames that it has answered
    /// or, if it never answers, the frames that the system has accepted.
    pub fn frames_answered(&self) -> u64 {
        self.flow.frames_answered()
    }

    /// The total number of bytes of all frames.
    pub fn bytes_drawn(&self) -> u64 {
        self.writer.bytes_written()
    }

    /// The time at which to check again whether a frame may be sent, even if nothing arrives before. `None` means
    /// never.
    pub(crate) fn opens_at(&self) -> Option<Duration> {
        self.flow.opens_at()
    }

    /// Sends a fence alone after a timeout, to find out whether the terminal is still there.
    pub(crate) fn probe(&mut self, now: Duration) {
        if self.output.is_empty() && self.flow.probe_is_due(now) {
            self.queue_queries("", now);
        }
    }

    /// Adds `queries` to the output, and a fence after them.
    fn queue_queries(&mut self, queries: &str, now: Duration) {
        self.flow.sent(now, 0, Request::Fence);
        self.output.extend_from_slice(queries.as_bytes());
        self.queue_fence(now);
    }

    /// Moves the bytes of the drawn frame to the output, with a request after them. An empty frame adds nothing.
    pub(crate) fn queue_frame(&mut self, now: Duration) {
        let Some(drawn) = self.drawn.take() else { return };
        // The writer writes only to memory, so this cannot fail.
        _ = Backend::flush(&mut self.writer);
        let frame = self.writer.output_mut();
        let bytes = frame.len();
        if bytes > 0 {
            if self.output.is_empty() {
                // Hand the frame's buffer over instead of copying it.
                std::mem::swap(&mut self.output, frame);
            } else {
                self.output.append(frame);
            }
            self.queue_request(bytes, now);
        }
        if let FrameKind::Motion(fidelity, effort) = drawn {
            self.flow.sent_motion(bytes, (fidelity, effort));
        }
    }

    /// Adds the request after a frame of this number of bytes.
    fn queue_request(&mut self, bytes: usize, now: Duration) {
        let request = self.flow.request(now, bytes);
        match request {
            Request::Nothing => {}
            Request::Status => self.output.extend_from_slice(sequence::QUERY_STATUS.as_bytes()),
            Request::Fence => self.queue_fence(now),
        }
        self.flow.sent(now, bytes, request);
        self.changes.awaits_statuses = self.flow.awaits_answers();
    }

    fn queue_fence(&mut self, now: Duration) {
        self.output.extend_from_slice(sequence::QUERY_FENCE.as_bytes());
        self.changes.fences.sent(now);
    }

    /// Uses the palette if it can be defined and reset and the terminal shows 24-bit colours.
    fn use_palette(&mut self) {
        let is_true = matches!(self.options.color_depth, Detected::Certain(ColorDepth::True))
            || self.color_depth() == ColorDepth::True
                && self.options.color_source != ColorSource::Palette;
        if self.palette == PaletteProbe::Reset && is_true {
            self.writer.set_palette(true);
        }
    }

    /// Shows all colours as entries of the palette if they can be defined and reset and the terminal has not answered
    /// that it shows 24-bit colours. Called once the terminal has answered all queries.
    fn use_own_palette(&mut self) {
        let shows_few = self.options.color_depth == Detected::Guess(ColorDepth::Indexed256);
        if self.palette == PaletteProbe::Reset && shows_few && !self.is_ending {
            self.writer.set_own_palette();
            self.options.color_depth = Detected::Guess(ColorDepth::True);
            self.options.color_source = ColorSource::Palette;
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
        }
    }
}

/// The byte that rings the bell.
const BELL: u8 = 0x07;

/// The event of a key. In raw mode, Ctrl-C and Ctrl-Z arrive as keys.
fn meaning(event: KeyEvent) -> Event {
    let pressed = event.phase == Phase::Press && event.modifiers.control && !event.modifiers.alt;
    match event.base.unwrap_or(event.key) {
        Key::Char('c') if pressed => Event::Quit(QuitReason::Interrupted),
        Key::Char('z') if pressed => Event::Suspend,
        _ => Event::Key(event),
    }
}

/// The reported state of the probed palette entry. Colours have 16 bits per channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum PaletteProbe {
    #[default]
    Unknown,
    /// The terminal's own colour.
    Own([u16; 3]),
    /// The defined colour, in place of the terminal's own.
    Defined { own: [u16; 3] },
    /// The terminal's own colour, after the reset.
    Reset,
    /// A wrong colour.
    Refused,
}

impl PaletteProbe {
    /// The state after a report of `color`.
    fn after_report(self, color: [u16; 3]) -> Self {
        match self {
            Self::Unknown => Self::Own(color),
            Self::Own(own) if color == sequence::DEFINED => Self::Defined { own },
            Self::Defined { own } if color == own => Self::Reset,
            Self::Own(_) | Self::Defined { .. } | Self::Reset | Self::Refused => Self::Refused,
        }
    }
}

#[cfg(test)]
mod tests;
