//! The time of the main loop.
//!
//! It is that of the machine's clock. For tests, a debug build has another one: if the environment
//! variable `CELLCASTER_CLOCK` is `focus`, time stands still until the terminal reports that the
//! window has the focus, and each such report is one step of the game. What happens is then a
//! function of the bytes that the program reads, on a machine under any load. Bytes, keys, screens
//! and the terminal are the same under both clocks.
//!
//! A report of the focus has no other effect, and every terminal can send it. Time as a private
//! sequence was refused: the decoder would have to know it. So was time that a file or a socket
//! gives: it would have no order with the keys.

use std::sync::OnceLock;
use std::time::{Duration, Instant};

/// The time since the main loop began.
#[derive(Debug)]
pub(crate) struct Time {
    start: Instant,
    /// The time, if the terminal gives it.
    #[cfg(debug_assertions)]
    told: Option<std::cell::Cell<Duration>>,
}

impl Time {
    /// Begins at zero.
    pub(crate) fn begin() -> Self {
        Self {
            start: Instant::now(),
            #[cfg(debug_assertions)]
            told: std::env::var_os("CELLCASTER_CLOCK")
                .is_some_and(|clock| clock == "focus")
                .then(std::cell::Cell::default),
        }
    }

    pub(crate) fn now(&self) -> Duration {
        #[cfg(debug_assertions)]
        if let Some(told) = &self.told {
            return told.get();
        }
        self.start.elapsed()
    }

    /// The machine's clock, by which steps that take long are noticed; `None` if the terminal gives
    /// the time.
    pub(crate) fn of_machine(&self) -> Option<fn() -> Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(|| {
            static BEGUN: OnceLock<Instant> = OnceLock::new();
            BEGUN.get_or_init(Instant::now).elapsed()
        })
    }

    /// How long it is until `time`; `None` if time stands still until the terminal reports
    /// something.
    pub(crate) fn until(&self, time: Duration) -> Option<Duration> {
        #[cfg(debug_assertions)]
        if self.told.is_some() {
            return None;
        }
        Some(time.saturating_sub(self.now()))
    }

    /// Handles a report that the window has the focus.
    #[cfg(debug_assertions)]
    pub(crate) fn focus_reported(&self) {
        if let Some(told) = &self.told {
            told.set(told.get() + super::clock::step());
        }
    }
}
