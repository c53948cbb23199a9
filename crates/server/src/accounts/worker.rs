//! A store on a thread of its own, because its methods block.
//!
//! Calls wait in a bounded queue. If the queue is full, a call fails at once. When the last sender is dropped, the
//! thread makes the waiting calls before it ends, so that no result is lost.
//!
//! A host has one such thread for sessions, and in a cluster one for leases and one for visits. So the replay of a
//! result delays neither leases nor visits.
//!
//! In simulated time, a task takes the place of the thread, because the time of a thread cannot be simulated.

use std::fmt;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::{self, JoinHandle};

use tokio::sync::{mpsc, oneshot};

use super::HostStore;

/// A waiting call.
pub(crate) type Call = Box<dyn FnOnce(&mut HostStore) + Send>;

/// The answer to a call. It is an error if the call was not accepted or has panicked.
pub(crate) type CallResult<T> = oneshot::Receiver<T>;

/// The sender of calls to a store.
pub(crate) struct StoreWorker {
    calls: Option<mpsc::Sender<Call>>,
    thread: Option<JoinHandle<()>>,
}

impl StoreWorker {
    /// Starts a thread called `name`. At most `most` calls wait for it.
    pub(crate) fn start(name: &str, most: usize, mut store: HostStore) -> io::Result<Self> {
        let (mut worker, mut queue) = Self::new(most);
        let thread = thread::Builder::new().name(name.to_owned()).spawn(move || {
            while let Some(call) = queue.blocking_recv() {
                // A panic in one call must not stop the other calls.
                _ = catch_unwind(AssertUnwindSafe(|| call(&mut store)));
            }
        })?;
        worker.thread = Some(thread);
        Ok(worker)
    }

    /// A sender of calls and their receiver.
    pub(crate) fn new(most: usize) -> (Self, mpsc::Receiver<Call>) {
        let (calls, queue) = mpsc::channel(most);
        (Self { calls: Some(calls), thread: None }, queue)
    }

    /// Runs `act` on the store, and returns its answer. The answer is an error if too many calls wait.
    pub(crate) fn call<T: Send + 'static>(
        &self,
        act: impl FnOnce(&mut HostStore) -> T + Send + 'static,
    ) -> CallResult<T> {
        let (answer, receiver) = oneshot::channel();
        self.run(move |store| _ = answer.send(act(store)));
        receiver
    }

    /// Runs `act` on the store. Returns false if it will not run because too many calls wait.
    pub(crate) fn run(&self, act: impl FnOnce(&mut HostStore) + Send + 'static) -> bool {
        let calls = self.calls.as_ref();
        let is_accepted = calls.is_some_and(|calls| calls.try_send(Box::new(act)).is_ok());
        if !is_accepted {
            tracing::warn!("a call to the store was dropped, because too many are waiting");
        }
        is_accepted
    }
}

impl Drop for StoreWorker {
    fn drop(&mut self) {
        self.calls = None;
        // A call may drop the last sender. A thread cannot wait for itself.
        if let Some(thread) = self.thread.take_if(|it| it.thread().id() != thread::current().id()) {
            _ = thread.join();
        }
    }
}

impl fmt::Debug for StoreWorker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StoreWorker").finish_non_exhaustive()
    }
}
