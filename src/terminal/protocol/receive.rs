//! Turns received bytes into events.

use std::time::Duration;

use ratatui::backend::Backend;

use super::reports::KeyFlags;
use super::{KeyReleases, Protocol};
use crate::color::palette::ColorDepth;
use crate::terminal::input::{Answer, Input};
use crate::terminal::known::{Colors, Known};
use crate::terminal::mouse::{MouseReport, MouseUnits};
use crate::terminal::{
    ColorSource, Detected, Event, Key, KeyEvent, Phase, QuitReason, TmuxClient, WindowSize,
    sequence,
};

impl Protocol {
    /// Interprets bytes from the terminal. They may be cut at any place.
    pub fn receive(&mut self, bytes: &[u8], now: Duration) {
        self.received_at = now;
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

    /// Records a new size of the window; the next frame is drawn whole.
    pub fn resize(&mut self, size: WindowSize, now: Duration) {
        self.repaint(size);
        self.update_mouse_units(now);
    }

    /// The time at which to call [`Protocol::wake`], if no bytes arrive before; `None` for never.
    pub fn wakes_at(&self) -> Option<Duration> {
        self.gives_up_at().into_iter().chain(self.opens_at()).min()
    }

    /// Does what is due: ends the wait for the rest of a key, and asks a terminal that answers no
    /// more whether it is still there.
    pub fn wake(&mut self, now: Duration) {
        if self.gives_up_at().is_some_and(|time| time <= now) {
            self.give_up();
        }
        self.probe(now);
    }

    /// Sets whether the mouse is reported, which it is not at first. Positions are in pixels if the
    /// terminal can report them.
    pub fn set_mouse(&mut self, is_reported: bool) {
        if self.mouse.units.is_some() != is_reported && !self.is_ending {
            self.mouse.units = is_reported.then(|| self.mouse_units());
            self.mouse.is_changing = false;
            self.send_mouse_units();
        }
    }

    pub(crate) fn push_event(&mut self, event: Event) {
        self.events.push_back(event);
    }

    /// Whether `is_such` holds for an event that was not taken yet.
    pub(crate) fn has_event(&self, is_such: impl Fn(&Event) -> bool) -> bool {
        self.events.iter().any(is_such)
    }

    /// Whether an event asks the program to end.
    pub(crate) fn is_asked_to_quit(&self) -> bool {
        self.has_event(|event| matches!(event, Event::Quit(_)))
    }

    /// The time at which half a key is taken for a whole one.
    pub(crate) fn gives_up_at(&self) -> Option<Duration> {
        self.decoder.patience().map(|patience| self.received_at + patience)
    }

    /// Stops waiting for the rest of a key.
    pub(crate) fn give_up(&mut self) {
        let events = &mut self.events;
        self.decoder.give_up(|input| {
            // An answer is always a whole unit, never the rest of one.
            if let Input::Key(event) = input {
                events.push_back(meaning(event));
            }
        });
    }

    fn take_input(&mut self, input: Input, now: Duration) {
        match input {
            Input::Key(event) => {
                self.flow.received_input();
                self.events.push_back(meaning(event));
            }
            Input::Focus(true) => self.events.push_back(Event::FocusGained),
            Input::Focus(false) => self.events.push_back(Event::FocusLost),
            Input::Mouse(report) => {
                self.flow.received_input();
                self.events.extend(self.mouse_event(report));
            }
            Input::Answer(answer) => self.take_answer(answer, now),
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
            Answer::Repeats => self.repeats_blocks(),
            Answer::PaletteEntry(color) => self.palette_reported(color),
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

    /// The event of `report`; `None` if the mouse is not reported or its unit is changing.
    fn mouse_event(&self, report: MouseReport) -> Option<Event> {
        let units = self.mouse.units.filter(|_| !self.mouse.is_changing)?;
        report.event(units, self.size).map(Event::Mouse)
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
        if self.mouse.units.is_none_or(|units| units == finest) || self.is_ending {
            return;
        }
        self.mouse.units = Some(finest);
        self.mouse.is_changing = true;
        self.send_mouse_units();
        // Reports after the answer are in the new unit.
        self.queue_queries("", now);
    }

    fn send_mouse_units(&mut self) {
        let mut text = String::new();
        self.changes.reports.change_mouse(self.mouse.units, &mut text);
        self.output.extend_from_slice(text.as_bytes());
    }

    fn settle_key_releases(&mut self, agreed: bool) {
        if self.key_releases == KeyReleases::Asked {
            self.key_releases = KeyReleases::Settled;
            let agreed = agreed && !self.is_ending;
            if agreed {
                self.changes.reports.key_flags = KeyFlags::Pushed;
                self.frames_before_key_flags = self.flow.frames_sent();
                self.output.extend_from_slice(sequence::PUSH_KEY_FLAGS.as_bytes());
                self.confirm_key_flags();
            }
            self.events.push_back(Event::KeyReleases(agreed));
        }
    }

    /// Records that the terminal has received the keyboard flags, if it has answered all frames before
    /// them.
    pub(crate) fn confirm_key_flags(&mut self) {
        let key_flags = &mut self.changes.reports.key_flags;
        if *key_flags == KeyFlags::Pushed
            && self.flow.frames_answered() >= self.frames_before_key_flags
        {
            *key_flags = KeyFlags::Received;
        }
    }

    fn identify(&mut self, known: Known, now: Duration) {
        match known.colors {
            Colors::True => self.raise_color_depth(),
            Colors::Ask => self.ask_for_true_color(now),
            Colors::Unknown => {}
        }
        // In tmux, its answer about the terminal around it says more.
        if self.tmux.is_none() {
            self.set_known(known);
        }
    }

    fn set_known(&mut self, known: Known) {
        if self.known != known {
            self.known = known;
            self.events.push_back(Event::Identified);
        }
    }

    /// Records what tmux says of the client that shows the program. A depth that the user has chosen
    /// stays.
    pub(crate) fn take_tmux_client(&mut self, client: TmuxClient) {
        if let Detected::Guess(before) = self.color_depth {
            let depth =
                if client.has_true_color() { ColorDepth::True } else { ColorDepth::Indexed256 };
            self.color_depth = Detected::Guess(depth);
            self.color_source = ColorSource::Tmux;
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

    fn ask_for_true_color(&mut self, now: Duration) {
        if matches!(self.color_depth, Detected::Guess(_)) {
            self.queue_queries(sequence::QUERY_TRUE_COLOR, now);
        }
    }

    fn raise_color_depth(&mut self) {
        if let Detected::Guess(_) = self.color_depth {
            self.color_depth = Detected::Certain(ColorDepth::True);
            self.color_source = ColorSource::Answer;
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
            self.use_palette();
        }
    }

    /// Forgets the screen, so that the next frame is drawn whole, in a window of this size.
    pub(crate) fn repaint(&mut self, size: WindowSize) {
        self.size = size;
        self.writer.forget();
        self.writer.set_size(self.size.cells());
        // The writer writes only to memory, so that nothing can fail.
        _ = Backend::clear(&mut self.writer);
        if self.events.back() != Some(&Event::Resized) {
            self.events.push_back(Event::Resized);
        }
    }
}

/// The event of a key. In raw mode, Ctrl-C and Ctrl-Z arrive as keys.
fn meaning(event: KeyEvent) -> Event {
    let pressed = event.phase == Phase::Press && event.modifiers.control && !event.modifiers.alt;
    match event.base.unwrap_or(event.key) {
        Key::Char('c') if pressed => Event::Quit(QuitReason::Interrupted),
        Key::Char('z') if pressed => Event::Suspend,
        _ => Event::Key(event),
    }
}
