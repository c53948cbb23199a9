//! A panic hook that gives the terminal back before the message is printed.

use std::any::Any;
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};
use std::sync::{Arc, Mutex, MutexGuard, Once, PoisonError};

use super::super::Error;
use super::Guard;
use crate::fault::printable;

/// The guard of the current session. The hook runs in all threads, so that this belongs to the
/// process and not to the session.
static CURRENT: Mutex<Option<Arc<Guard>>> = Mutex::new(None);

/// Sets the guard that the hook uses.
pub(crate) fn protect(guard: &Arc<Guard>) -> Result<(), Error> {
    static HOOK: Once = Once::new();
    let mut current = lock();
    if current.is_some() {
        return Err(Error::already_taken());
    }
    *current = Some(Arc::clone(guard));
    HOOK.call_once(install_hook);
    Ok(())
}

/// Removes `guard`; panics are then handled as before.
pub(crate) fn release(guard: &Guard) {
    let mut current = lock();
    if current.as_ref().is_some_and(|known| std::ptr::eq(Arc::as_ptr(known), guard)) {
        *current = None;
    }
}

/// Installs a hook that calls the previous one for panics outside of sessions. It is never removed:
/// this would also remove a hook installed after it.
fn install_hook() {
    let outside = panic::take_hook();
    panic::set_hook(Box::new(move |info| match lock().clone() {
        Some(guard) => {
            guard.give_back();
            report(info);
        }
        None => outside(info),
    }));
}

/// Prints one sentence. If standard error is closed, nothing can be reported.
fn report(info: &PanicHookInfo) {
    let message = printable(message(info.payload()));
    _ = match info.location() {
        Some(place) => writeln!(
            io::stderr(),
            "This program has a fault, and had to end: {message} (at {}:{}).",
            place.file(),
            place.line()
        ),
        None => writeln!(io::stderr(), "This program has a fault, and had to end: {message}."),
    };
}

fn message(payload: &dyn Any) -> &str {
    payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("it does not say which")
}

fn lock() -> MutexGuard<'static, Option<Arc<Guard>>> {
    CURRENT.lock().unwrap_or_else(PoisonError::into_inner)
}
