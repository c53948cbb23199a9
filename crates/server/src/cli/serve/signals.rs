//! The signals of a server: what ends it, and what makes it read its configuration again.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use tokio::sync::Notify;

/// The signals of this process, caught.
pub(crate) struct Signals {
    ends: Arc<Ends>,
    drain: Arc<Notify>,
}

/// Hang-ups, one at a time. Elsewhere than on Unix there are none.
pub(crate) struct Hangups {
    #[cfg(unix)]
    signal: tokio::signal::unix::Signal,
}

/// How often the server was asked to end.
#[derive(Default)]
struct Ends {
    is_draining: AtomicBool,
    first: Notify,
    second: Notify,
}

impl Ends {
    fn ask(&self) {
        let is_second = self.is_draining.swap(true, Ordering::AcqRel);
        if is_second { self.second.notify_one() } else { self.first.notify_one() }
    }
}

impl Signals {
    /// Catches signals from now on. Call it within a runtime.
    pub(crate) fn catch() -> io::Result<Self> {
        let ends = Arc::<Ends>::default();
        listen(&ends)?;
        Ok(Self { ends, drain: Arc::default() })
    }

    /// What an operator notifies to end the server as a signal does.
    pub(crate) fn drain(&self) -> Arc<Notify> {
        self.drain.clone()
    }

    /// Ready when a signal or an operator asks the server to end.
    pub(crate) fn first(&self) -> impl Future<Output = ()> + Send + use<> {
        let (ends, drain) = (self.ends.clone(), self.drain.clone());
        async move {
            tokio::select! {
                () = ends.first.notified() => {}
                () = drain.notified() => ends.is_draining.store(true, Ordering::Release),
            }
        }
    }

    /// Ready when a signal asks once more.
    pub(crate) fn second(&self) -> impl Future<Output = ()> + Send + use<> {
        let ends = self.ends.clone();
        async move { ends.second.notified().await }
    }
}

#[cfg(unix)]
fn listen(ends: &Arc<Ends>) -> io::Result<()> {
    use tokio::signal::unix::{SignalKind, signal};
    for kind in [SignalKind::terminate(), SignalKind::interrupt()] {
        let (mut signal, ends) = (signal(kind)?, ends.clone());
        tokio::spawn(async move {
            while signal.recv().await.is_some() {
                ends.ask();
            }
        });
    }
    Ok(())
}

/// Ctrl-C alone.
#[cfg(not(unix))]
fn listen(ends: &Arc<Ends>) -> io::Result<()> {
    let ends = ends.clone();
    tokio::spawn(async move {
        while tokio::signal::ctrl_c().await.is_ok() {
            ends.ask();
        }
    });
    Ok(())
}

impl Hangups {
    /// Catches them from now on. Call it within a runtime.
    pub(crate) fn catch() -> io::Result<Self> {
        #[cfg(unix)]
        use tokio::signal::unix::{SignalKind, signal};
        Ok(Self {
            #[cfg(unix)]
            signal: signal(SignalKind::hangup())?,
        })
    }

    /// Waits for the next one.
    pub(crate) async fn next(&mut self) {
        #[cfg(unix)]
        if self.signal.recv().await.is_some() {
            return;
        }
        std::future::pending::<()>().await;
    }
}

#[cfg(test)]
mod tests {
    use std::pin::pin;
    use std::task::{Context, Waker};

    use super::*;

    fn is_ready(future: impl Future<Output = ()>) -> bool {
        pin!(future).poll(&mut Context::from_waker(Waker::noop())).is_ready()
    }

    #[test]
    fn the_second_signal_is_told_from_the_first() {
        let signals = Signals { ends: Arc::default(), drain: Arc::default() };
        assert!(!is_ready(signals.first()));
        signals.ends.ask();
        assert!(is_ready(signals.first()));
        assert!(!is_ready(signals.second()));
        signals.ends.ask();
        assert!(is_ready(signals.second()));
    }

    #[test]
    fn a_signal_after_an_operator_is_the_second_one() {
        let signals = Signals { ends: Arc::default(), drain: Arc::default() };
        signals.drain().notify_one();
        assert!(is_ready(signals.first()));
        signals.ends.ask();
        assert!(is_ready(signals.second()));
    }
}
