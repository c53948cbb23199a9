//! A panic gives the terminal back before it says anything.

use std::any::Any;
use std::io::{self, Write};
use std::panic::{self, PanicHookInfo};
use std::sync::{Arc, Mutex, MutexGuard, Once, PoisonError};

use super::super::Error;
use super::Guard;

/// The guard of the session that there is. Panics reach the hook from all threads, so it is the
/// process that has it, not the session.
static CURRENT: Mutex<Option<Arc<Guard>>> = Mutex::new(None);

/// Makes `guard` the one that a panic uses.
pub(super) fn protect(guard: &Arc<Guard>) -> Result<(), Error> {
    static HOOK: Once = Once::new();
    let mut current = lock();
    if current.is_some() {
        return Err(Error::already_taken());
    }
    *current = Some(Arc::clone(guard));
    HOOK.call_once(install_hook);
    Ok(())
}

/// After this, a panic is what it was before.
pub(super) fn release(guard: &Guard) {
    let mut current = lock();
    if current.as_ref().is_some_and(|known| std::ptr::eq(Arc::as_ptr(known), guard)) {
        *current = None;
    }
}

/// Puts a hook in front of the one there is, which goes on to serve panics outside of sessions. It
/// is never taken out again: a hook that others have put in front of it would go with it.
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

/// One sentence. There is nobody to tell where standard error is gone as well.
fn report(info: &PanicHookInfo) {
    let message = message(info.payload());
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
