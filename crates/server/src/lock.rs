//! Locks that are held for a moment.

use std::sync::{Mutex, PoisonError};

/// Acts on what a lock guards. A panic elsewhere does not close the lock.
pub(crate) fn locked<T, R>(mutex: &Mutex<T>, act: impl FnOnce(&mut T) -> R) -> R {
    act(&mut mutex.lock().unwrap_or_else(PoisonError::into_inner))
}
