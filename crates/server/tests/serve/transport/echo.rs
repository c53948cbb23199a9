//! A session for tests: it shows its data on the visitor, and their input.
//!
//! `q` ends it with status 7. From `F` to `f`, it sends frames of random colours without a pause, and then
//! shows their total size in bytes. After `T`, a frame is due every tenth of a second; it then shows how many
//! frames were sent in time, and how often the previous frame had not left yet.

use std::time::Duration;

use cellcaster::rng::SplitMix64;
use cellcaster::terminal::{CellWriter, WindowSize};
use cellcaster_server::ssh::{Arrival, Departure, Host, Link, Visitor};
use ratatui::layout::Size;
use ratatui::style::Color;
use ratatui::widgets::{Paragraph, Wrap};
use ratatui::{Terminal, TerminalOptions, Viewport};
use tokio::time::{Interval, interval};

pub(crate) struct Echo;

/// The interval between two due frames.
const TICK: Duration = Duration::from_millis(100);

struct Screen {
    terminal: Terminal<CellWriter<Vec<u8>>>,
    visitor: Visitor,
    typed: Vec<u8>,
    count: usize,
    /// The total size of all frames, in bytes.
    sent: usize,
    size: WindowSize,
    drains: bool,
    noise: Option<SplitMix64>,
    ticks: Option<Ticks>,
    is_stale: bool,
}

/// Frames that are due at regular intervals.
struct Ticks {
    times: Interval,
    sent: u32,
    missed: u32,
}

impl Host for Echo {
    async fn serve(&self, visitor: Visitor, mut link: Link) -> Departure {
        let mut screen = Screen::new(visitor);
        let mut status = 0;
        let mut is_over = false;
        loop {
            if link.outbox.is_empty() {
                if is_over {
                    return Departure { status, ..Departure::default() };
                }
                if screen.is_stale {
                    link.outbox.try_send(screen.frame()).unwrap();
                }
            }
            // `is_empty` is not consulted again, because the frame may drain at any time.
            let waits = screen.is_stale || is_over;
            tokio::select! {
                arrival = link.inbound.next(), if !is_over => match arrival {
                    Arrival::Bytes(bytes) => {
                        if bytes.contains(&b'q') {
                            (status, is_over) = (7, true);
                        }
                        screen.receive(&bytes);
                    }
                    Arrival::Resized(size) => screen.resize(size),
                    Arrival::Drains => {
                        screen.drains = true;
                        screen.is_stale = true;
                        link.outbox.drained().await;
                        link.outbox.try_send(screen.frame()).unwrap();
                        is_over = true;
                    }
                    Arrival::Ended => return Departure { status, ..Departure::default() },
                },
                () = link.outbox.drained(), if waits => {}
                () = tick(&mut screen.ticks) => screen.tick(),
            }
        }
    }
}

impl Screen {
    fn new(visitor: Visitor) -> Self {
        let size = visitor.size;
        let writer = CellWriter::new(Vec::new(), Size::new(size.columns, size.rows));
        let viewport = TerminalOptions { viewport: Viewport::Fullscreen };
        Self {
            terminal: Terminal::with_options(writer, viewport).unwrap(),
            visitor,
            typed: Vec::new(),
            count: 0,
            sent: 0,
            size,
            drains: false,
            noise: None,
            ticks: None,
            is_stale: true,
        }
    }

    fn receive(&mut self, bytes: &[u8]) {
        self.count += bytes.len();
        self.typed.extend(bytes);
        let surplus = self.typed.len().saturating_sub(40);
        self.typed.drain(..surplus);
        if bytes.contains(&b'F') {
            self.noise = Some(SplitMix64::new(1));
        }
        if bytes.contains(&b'T') {
            self.ticks = Some(Ticks { times: interval(TICK), sent: 0, missed: 0 });
        }
        if bytes.contains(&b'f') {
            self.noise = None;
        }
        self.is_stale = true;
    }

    fn tick(&mut self) {
        if let Some(ticks) = &mut self.ticks {
            let count = if self.is_stale { &mut ticks.missed } else { &mut ticks.sent };
            *count += 1;
            self.is_stale = true;
        }
    }

    fn resize(&mut self, size: WindowSize) {
        self.size = size;
        self.terminal.backend_mut().set_size(Size::new(size.columns, size.rows));
        self.terminal.autoresize().unwrap();
        self.is_stale = true;
    }

    fn frame(&mut self) -> Vec<u8> {
        let text = self.text();
        let noise = &mut self.noise;
        let drawn = self.terminal.draw(|frame| {
            let area = frame.area();
            if let Some(noise) = noise {
                for cell in &mut frame.buffer_mut().content {
                    let [red, green, blue, ..] = noise.bits().to_le_bytes();
                    cell.set_char('▀').set_fg(Color::Rgb(red, green, blue));
                }
            }
            frame.render_widget(Paragraph::new(text).wrap(Wrap { trim: true }), area);
        });
        drawn.unwrap();
        self.is_stale = self.noise.is_some();
        let bytes = std::mem::take(self.terminal.backend_mut().output_mut());
        self.sent += bytes.len();
        bytes
    }

    fn text(&self) -> String {
        let Visitor { key, user, term, environment, compresses, notice, .. } = &self.visitor;
        let who = key.map_or_else(|| "guest".to_owned(), |key| key.to_string());
        let environment: Vec<String> =
            environment.iter().map(|(name, value)| format!("{name}={value}")).collect();
        let ticks = self.ticks.as_ref();
        let ticks = ticks.map(|ticks| format!("[due {} {}]", ticks.sent, ticks.missed));
        format!(
            "[{user}]\n[{who}]\n[{term}]\n[{}x{}]\n[compressed {compresses}]\n[{}]\n[typed {}]\n[{}]\n[sent {}]{}\n{}{}",
            self.size.columns,
            self.size.rows,
            environment.join(" "),
            String::from_utf8_lossy(&self.typed),
            self.count,
            self.sent,
            if self.drains { "[drains]" } else { "" },
            notice.unwrap_or_default(),
            ticks.unwrap_or_default(),
        )
    }
}

/// Waits until the next frame is due.
async fn tick(ticks: &mut Option<Ticks>) {
    match ticks {
        Some(ticks) => _ = ticks.times.tick().await,
        None => std::future::pending().await,
    }
}
