//! Memory that the encoders and the renderers of a thread share.
//!
//! A call of an encoder leaves nothing in it that a later call needs, so each thread has it once. A
//! server keeps an encoder for each of some hundred terminals and calls them on a few threads; with
//! memory of their own, they would keep a hundred kilobytes each. Its renderers share theirs for the
//! same reason.

use std::cell::Cell;
use std::thread::LocalKey;

/// Takes the thread's memory out of its `place`. During a nested call, and at the end of the thread,
/// it is new.
pub fn take<T: Default>(place: &'static LocalKey<Cell<T>>) -> T {
    place.try_with(Cell::take).unwrap_or_default()
}

/// Puts memory back for the next call.
pub fn put_back<T>(place: &'static LocalKey<Cell<T>>, memory: T) {
    // At the end of the thread, it is dropped.
    _ = place.try_with(|place| place.set(memory));
}
