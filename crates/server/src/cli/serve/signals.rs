//! The signals of a server: what ends it, and what makes it read its configuration again.

use std::io;
use std::sync::Arc;

use tokio::sync::{Notify, watch};

/// The signals of this process, caught.
#[derive(Default)]
pub(crate) struct Signals {
    /// How often the server was asked to end.
    count: watch::Sender<u32>,
    drain: Arc<Notify>,
}

/// Hang-ups, one at a time. Elsewhere than on Unix there are none.
pub(crate) struct Hangups {
    #[cfg(unix)]
    signal: tokio::signal::unix::Signal,
}

impl Signals {
    /// Catches signals from now on. Call it within a runtime.
    pub(crate) fn catch() -> io::Result<Self> {
        let signals = Self::default();
        listen(&signals.count)?;
        Ok(signals)
    }

    /// What an operator notifies to end the server as a signal does.
    pub(crate) fn drain(&self) -> Arc<Notify> {
        self.drain.clone()
    }

    /// Ready when a signal or an operator asks the server to end.
    pub(crate) fn first(&self) -> impl Future<Output = ()> + Send + use<> {
        let (count, drain, asked) = (self.count.clone(), self.drain.clone(), self.asked(1));
        async move {
            tokio::select! {
                () = asked => {}
                () = drain.notified() => count.send_modify(|count| *count = 1.max(*count)),
            }
        }
    }

    /// Ready when a signal asks once more.
    pub(crate) fn second(&self) -> impl Future<Output = ()> + Send + use<> {
        self.asked(2)
    }

    fn asked(&self, times: u32) -> impl Future<Output = ()> + Send + use<> {
        let mut count = self.count.subscribe();
        async move { _ = count.wait_for(|count| *count >= times).await }
    }
}

#[cfg(unix)]
fn listen(count: &watch::Sender<u32>) -> io::Result<()> {
    use tokio::signal::unix::{SignalKind, signal};
    for kind in [SignalKind::terminate(), SignalKind::interrupt()] {
        let (mut signal, count) = (signal(kind)?, count.clone());
        tokio::spawn(async move {
            while signal.recv().await.is_some() {
                count.send_modify(|count| *count += 1);
            }
        });
    }
    Ok(())
}

/// Ctrl-C alone.
#[cfg(not(unix))]
fn listen(count: &watch::Sender<u32>) -> io::Result<()> {
    let count = count.clone();
    tokio::spawn(async move {
        while tokio::signal::ctrl_c().await.is_ok() {
            count.send_modify(|count| *count += 1);
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

    fn signal(signals: &Signals) {
        signals.count.send_modify(|count| *count += 1);
    }

    #[test]
    fn the_second_signal_is_told_from_the_first() {
        let signals = Signals::default();
        assert!(!is_ready(signals.first()));
        signal(&signals);
        assert!(is_ready(signals.first()));
        assert!(!is_ready(signals.second()));
        signal(&signals);
        assert!(is_ready(signals.second()));
    }

    #[test]
    fn a_signal_after_an_operator_is_the_second_one() {
        let signals = Signals::default();
        signals.drain().notify_one();
        assert!(is_ready(signals.first()));
        signal(&signals);
        assert!(is_ready(signals.second()));
    }
}
