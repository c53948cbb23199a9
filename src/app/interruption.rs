//! Interruption: events that come before a picture which takes long.
//!
//! A picture of many bodies in a large window takes seconds. It is abandoned for an event that ends or
//! stops the program or changes the window, for the key that leaves, and for any key while a panel is
//! shown. After a key, the next frame shows the panel over what there is of the picture, and the frame
//! after that renders the picture again.
//!
//! Other keys wait. Abandoning a picture for each of them was refused: while a key repeats, no picture
//! would ever be complete.

use ratatui::layout::Size;

use super::{App, Screen};
use crate::app::bindings::{Action, Bindings};
use crate::terminal::{Event, Phase};

/// Returns whether an event has arrived for which a function returns `true`.
type HasArrived<'a> = dyn FnMut(&dyn Fn(&Event) -> bool) -> bool + 'a;

/// The result of rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rendered {
    Complete,
    /// Parts of the picture are older. It is painted all the same, since the panel over it is new.
    Partial,
    /// An event comes first, and nothing is painted.
    Interrupted,
}

impl App {
    /// Renders the picture for a window of this size, unless an event comes first. `has_arrived` returns
    /// whether such an event has arrived.
    pub(crate) fn render_unless(
        &mut self,
        window: Size,
        has_arrived: &mut HasArrived<'_>,
    ) -> Rendered {
        if self.is_interrupted {
            let (screen, bindings) = (self.screen, &self.settings.bindings);
            // Other events may have arrived before it.
            if has_arrived(&|event| comes_first(event, screen, bindings)) {
                return Rendered::Interrupted;
            }
            self.is_interrupted = false;
            let is_complete = self.render(window, &mut |_, _| false);
            return if is_complete { Rendered::Complete } else { Rendered::Partial };
        }
        let is_complete = self.render(window, &mut |screen, bindings| {
            !has_arrived(&|event| comes_first(event, screen, bindings))
        });
        self.is_interrupted = !is_complete;
        if is_complete { Rendered::Complete } else { Rendered::Interrupted }
    }
}

/// Whether `event` comes before a picture.
fn comes_first(event: &Event, screen: Screen, bindings: &Bindings) -> bool {
    match event {
        Event::Quit(_) | Event::Suspend | Event::Resized => true,
        Event::Key(event) => {
            let leaves = || {
                let key = bindings.resolve(*event).key;
                bindings.action(key) == Some(Action::Leave)
            };
            event.phase == Phase::Press && (screen != Screen::Playing || leaves())
        }
        _ => false,
    }
}
