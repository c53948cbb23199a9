//! Receives input and signals and turns them into events.

use std::io;
use std::time::Instant;

use ratatui::backend::Backend;

use super::{KeyReleases, Session};
use crate::color::palette::ColorDepth;
use crate::terminal::input::{Answer, Input};
use crate::terminal::mouse::MouseReport;
use crate::terminal::platform::Signal;
use crate::terminal::{ColorSource, Detected, Event, Key, KeyEvent, Phase, QuitReason, sequence};

/// Whether input or a signal arrived.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Received {
    Something,
    Nothing,
}

impl Session {
    pub(super) fn receive(&mut self, wake_at: Option<Instant>) -> io::Result<Received> {
        let timeout = wake_at.map(|time| time.saturating_duration_since(Instant::now()));
        let has_queued = !self.guard.has_written_all();
        let ready = self.guard.device().wait(&self.signals, has_queued, timeout)?;
        if ready.signals {
            self.receive_signals()?;
        }
        if ready.input {
            self.receive_input()?;
        }
        if ready.output && !self.is_ending() {
            self.send_queued()?;
        }
        let something = ready.input || ready.signals || ready.output;
        Ok(if something { Received::Something } else { Received::Nothing })
    }

    fn receive_signals(&mut self) -> io::Result<()> {
        for signal in self.signals.take() {
            match signal {
                Signal::Resized => {
                    self.repaint();
                    self.update_mouse_units()?;
                }
                Signal::Suspend => self.events.push_back(Event::Suspend),
                Signal::Continued => {
                    // SIGSTOP cannot be caught, so the terminal was not given back.
                    self.guard.device().make_raw()?;
                    self.repaint();
                }
                Signal::Quit(reason) => self.events.push_back(Event::Quit(reason)),
            }
        }
        Ok(())
    }

    fn receive_input(&mut self) -> io::Result<()> {
        let mut buffer = [0; 1024];
        let Some(count) = self.guard.device().read(&mut buffer)? else { return Ok(()) };
        if count == 0 {
            self.events.push_back(Event::Quit(QuitReason::InputClosed));
            return Ok(());
        }
        self.received_at = Instant::now();
        let mut inputs = Vec::new();
        self.decoder.feed(&buffer[..count], |input| inputs.push(input));
        inputs.into_iter().try_for_each(|input| self.take_input(input))
    }

    pub(super) fn stop_waiting_for_more(&mut self) {
        let events = &mut self.events;
        self.decoder.give_up(|input| {
            // An answer is always a whole unit, never the rest of one.
            if let Input::Key(event) = input {
                events.push_back(meaning(event));
            }
        });
    }

    fn take_input(&mut self, input: Input) -> io::Result<()> {
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
            Input::Answer(Answer::PixelMouse) => {
                self.mouse.has_pixels = true;
                self.update_mouse_units()?;
            }
            Input::Answer(Answer::KeyFlags) => self.settle_key_releases(true)?,
            Input::Answer(Answer::TrueColor) => self.raise_color_depth(),
            Input::Answer(Answer::XtermVersion) => self.ask_for_true_color()?,
            Input::Answer(Answer::Repeats) => self.repeats_blocks(),
            Input::Answer(Answer::PaletteEntry(color)) => self.palette_reported(color),
            Input::Answer(Answer::Status) => {
                self.flow.answered(self.now());
                self.guard.await_statuses(self.flow.awaits_answers());
            }
            Input::Answer(Answer::Fence) => {
                self.guard.fence_answered();
                self.mouse.is_changing &= self.guard.awaits_answers();
                self.flow.fence_answered(self.now());
                self.guard.await_statuses(self.flow.awaits_answers());
                self.settle_key_releases(false)?;
            }
        }
        Ok(())
    }

    /// The event of `report`; `None` if the mouse is not reported or its unit is changing.
    fn mouse_event(&self, report: MouseReport) -> Option<Event> {
        let units = self.mouse.units.filter(|_| !self.mouse.is_changing)?;
        report.event(units, self.size).map(Event::Mouse)
    }

    /// If the mouse is reported, switches to the finest unit that is available.
    fn update_mouse_units(&mut self) -> io::Result<()> {
        let finest = self.mouse_units();
        if self.mouse.units.is_none_or(|units| units == finest) {
            return Ok(());
        }
        self.mouse.units = Some(finest);
        self.mouse.is_changing = true;
        self.guard.set_mouse(self.mouse.units)?;
        // Reports after the answer are in the new unit.
        self.send_queries("")
    }

    fn settle_key_releases(&mut self, agreed: bool) -> io::Result<()> {
        if self.key_releases == KeyReleases::Asked {
            self.key_releases = KeyReleases::Settled;
            if agreed {
                self.guard.push_key_flags()?;
            }
            self.events.push_back(Event::KeyReleases(agreed));
        }
        Ok(())
    }

    fn ask_for_true_color(&mut self) -> io::Result<()> {
        if matches!(self.color_depth, Detected::Guess(_)) {
            self.send_queries(sequence::QUERY_TRUE_COLOR)?;
        }
        Ok(())
    }

    fn raise_color_depth(&mut self) {
        if let Detected::Guess(_) = self.color_depth {
            self.color_depth = Detected::Certain(ColorDepth::True);
            self.color_source = ColorSource::Answer;
            self.events.push_back(Event::ColorDepth(ColorDepth::True));
            self.use_palette();
        }
    }

    /// Forgets the screen and reads the window's size, so that the next frame is drawn whole.
    pub(super) fn repaint(&mut self) {
        let size = self.guard.device().size();
        if size.cells() != self.size.cells() {
            self.guard.recording().resized(size.cells());
        }
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
