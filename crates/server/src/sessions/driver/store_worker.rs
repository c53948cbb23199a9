//! The store on a thread of its own, since its methods block.
//!
//! Calls wait in a bounded queue; if it is full, a call fails at once. What was queued when the server
//! ends is done before the thread ends, so that no result is lost.
//!
//! In simulated time, a task takes the place of the thread, whose time nobody could simulate.

use std::fmt;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::thread::{self, JoinHandle};

use tokio::sync::{mpsc, oneshot};

use crate::accounts::HostStore;

type Call = Box<dyn FnOnce(&mut HostStore) + Send>;

/// The most calls that wait.
const MOST_CALLS: usize = 256;

/// The thread of the store.
pub(crate) struct StoreWorker {
    calls: Option<mpsc::Sender<Call>>,
    thread: Option<JoinHandle<()>>,
}

/// The answer to a call. It is an error if the call was not accepted, or has panicked.
pub(crate) type Answer<T> = oneshot::Receiver<T>;

impl StoreWorker {
    pub(crate) fn start(mut store: HostStore) -> io::Result<Self> {
        let (calls, mut queue) = mpsc::channel::<Call>(MOST_CALLS);
        let thread = thread::Builder::new().name("store".to_owned()).spawn(move || {
            while let Some(call) = queue.blocking_recv() {
                answer(call, &mut store);
            }
        })?;
        Ok(Self { calls: Some(calls), thread: Some(thread) })
    }

    /// A task that takes `time` for each call.
    #[cfg(test)]
    pub(crate) fn simulated(mut store: HostStore, time: std::time::Duration) -> Self {
        let (calls, mut queue) = mpsc::channel::<Call>(MOST_CALLS);
        tokio::spawn(async move {
            while let Some(call) = queue.recv().await {
                tokio::time::sleep(time).await;
                answer(call, &mut store);
            }
        });
        Self { calls: Some(calls), thread: None }
    }

    /// Acts on the store, and answers. The answer is an error if too many calls wait.
    pub(crate) fn call<T: Send + 'static>(
        &self,
        act: impl FnOnce(&mut HostStore) -> T + Send + 'static,
    ) -> Answer<T> {
        let (answer, receiver) = oneshot::channel();
        self.run(move |store| {
            _ = answer.send(act(store));
        });
        receiver
    }

    /// Acts on the store; returns whether it will, which it does not if too many calls wait.
    pub(crate) fn run(&self, act: impl FnOnce(&mut HostStore) + Send + 'static) -> bool {
        let calls = self.calls.as_ref();
        let is_accepted = calls.is_some_and(|calls| calls.try_send(Box::new(act)).is_ok());
        if !is_accepted {
            tracing::warn!("a call of the store was dropped: too many wait");
        }
        is_accepted
    }
}

/// A fault in one call is no reason to answer no other.
fn answer(call: Call, store: &mut HostStore) {
    _ = catch_unwind(AssertUnwindSafe(|| call(store)));
}

impl Drop for StoreWorker {
    fn drop(&mut self) {
        self.calls = None;
        if let Some(thread) = self.thread.take() {
            _ = thread.join();
        }
    }
}

impl fmt::Debug for StoreWorker {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("StoreWorker").finish_non_exhaustive()
    }
}
