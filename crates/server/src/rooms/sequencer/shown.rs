//! The newest snapshot of a room.
//!
//! The snapshot before is dropped before a step, so that the step copies the game only if a session
//! draws from it at that moment. In a `watch` channel, the channel itself would keep it, and each step
//! would copy the game.

use std::sync::{Arc, Mutex};

use tokio::sync::watch;

use crate::lock::locked;
use crate::rooms::room::RoomView;

/// The newest snapshot of a room, and news of the next one.
#[derive(Debug)]
pub(crate) struct Shown {
    view: Mutex<Option<Arc<RoomView>>>,
    state: watch::Sender<State>,
}

/// What sessions wait for.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct State {
    /// The number of snapshots so far.
    pub(crate) snapshots: u64,
    /// Why the room is closed, if it is: a sentence.
    pub(crate) closed: Option<Arc<str>>,
}

impl Shown {
    pub(crate) fn new(view: RoomView) -> Self {
        let view = Mutex::new(Some(Arc::new(view)));
        Self { view, state: watch::Sender::default() }
    }

    /// The newest snapshot. During a step, it waits for the next one. `None` after a fault.
    pub(crate) fn view(&self) -> Option<Arc<RoomView>> {
        locked(&self.view, |view| view.clone())
    }

    /// Waits for the next snapshot, or the end.
    pub(crate) fn state(&self) -> watch::Receiver<State> {
        self.state.subscribe()
    }

    /// Replaces the snapshot by that of `step`.
    pub(crate) fn replace<T>(&self, step: impl FnOnce() -> (RoomView, T)) -> T {
        let result = locked(&self.view, |shown| {
            *shown = None;
            let (view, result) = step();
            *shown = Some(Arc::new(view));
            result
        });
        self.state.send_modify(|state| state.snapshots += 1);
        result
    }

    /// Tells all that the room is closed.
    pub(crate) fn close(&self, sentence: &str) {
        self.state.send_modify(|state| {
            state.closed.get_or_insert_with(|| sentence.into());
        });
    }
}
