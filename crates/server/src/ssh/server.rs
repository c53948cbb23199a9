//! A server that listens until it is told to stop.

use std::future::Future;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use tokio::net::{TcpListener, TcpStream};
use tokio::task::JoinSet;
use tokio::time::{MissedTickBehavior, interval, sleep, timeout};

use super::connection::{self, VERSION_TIMEOUT, ssh_config};
use super::gate::{Gate, ShutdownPhase, explain};
use super::host_key::HostKey;
use super::proxy_header;
use super::visitor::Host;
use crate::admission::{Outcome, Refusal};
use crate::config::{Config, LiveConfig};
use crate::logging;
use crate::metrics::Metrics;
use crate::service::listen;

/// A listening server.
#[derive(Debug)]
pub struct Server {
    listener: TcpListener,
    config: LiveConfig,
    key: HostKey,
    metrics: Arc<Metrics>,
}

/// The pause after a failed `accept`, for example when the process has no file descriptors left.
const ACCEPT_RETRY_INTERVAL: Duration = Duration::from_millis(100);
/// The interval over which events are summed for the log.
const SECOND: Duration = Duration::from_secs(1);
/// The size of a socket's send buffer, in bytes. It allows 640 KB per second on a link with a round trip of 0.2 s.
const SEND_BUFFER: u32 = 128 << 10;
/// The maximum number of connections that wait to be accepted.
const BACKLOG: u32 = 1024;
/// The extra time after the drain in which sessions may say their last words.
const FAREWELL_TIMEOUT: Duration = Duration::from_secs(2);
/// How long closed connections may take to end.
const CLOSE_TIMEOUT: Duration = Duration::from_secs(2);

impl Server {
    /// Listens on the address of `config`.
    ///
    /// # Errors
    /// Fails if the address cannot be bound.
    #[expect(clippy::unused_async, reason = "a listener is made within a runtime")]
    pub async fn bind(config: Config, key: HostKey) -> io::Result<Self> {
        let listener = listen(config.listen, SEND_BUFFER, BACKLOG)?;
        Ok(Self { listener, config: LiveConfig::new(config), key, metrics: Arc::default() })
    }

    /// The address that the server listens on.
    ///
    /// # Errors
    /// Fails if the system does not report the address.
    pub fn address(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }

    /// The configuration, which can be replaced while the server runs.
    pub fn config(&self) -> LiveConfig {
        self.config.clone()
    }

    /// The server's metrics.
    pub fn metrics(&self) -> Arc<Metrics> {
        Arc::clone(&self.metrics)
    }

    /// Serves visitors until `stop` is ready. Then it accepts no more connections and tells each session that
    /// the server drains. It waits for the configured time, plus two seconds for last words, and closes the
    /// remaining connections.
    pub async fn run<H: Host>(self, host: H, stop: impl Future<Output = ()> + Send) {
        let Self { listener, config, key, metrics } = self;
        let gate = Arc::new(Gate::new(config.clone(), metrics));
        let (ssh, host) = (Arc::new(ssh_config(&key)), Arc::new(host));
        let mut tasks = JoinSet::new();
        // The connections from proxies whose headers are incomplete. They count apart from the admitted ones, because
        // the addresses that those count by are unknown, but are limited to the same number.
        let mut headers = JoinSet::<ProxiedConnection>::new();
        let enter = |tasks: &mut JoinSet<()>, socket: TcpStream, peer| match gate.admit(peer) {
            Ok(entry) => {
                // Frames are small, and each is written whole.
                _ = socket.set_nodelay(true);
                let (gate, ssh, host) = (gate.clone(), ssh.clone(), host.clone());
                tasks.spawn(connection::serve(gate, ssh, host, socket, entry));
            }
            Err(sentence) => tell(tasks, socket, sentence),
        };
        let mut second = interval(SECOND);
        second.set_missed_tick_behavior(MissedTickBehavior::Delay);
        tokio::pin!(stop);
        loop {
            tokio::select! {
                () = &mut stop => break,
                Some(_) = tasks.join_next(), if !tasks.is_empty() => {}
                _ = second.tick() => gate.end_second(),
                Some(Ok((socket, proxy, visitor))) = headers.join_next(), if !headers.is_empty() => {
                    match visitor {
                        Ok(visitor) => enter(&mut tasks, socket, visitor),
                        Err(outcome) => {
                            let sentence = gate.end_without_header(outcome, proxy.ip());
                            tell(&mut tasks, socket, sentence);
                        }
                    }
                }
                accepted = listener.accept() => match accepted {
                    Ok((socket, peer)) if !gate.is_proxy(peer.ip()) => {
                        enter(&mut tasks, socket, peer);
                    }
                    Ok((socket, proxy)) => {
                        let config = config.get();
                        if headers.len() < config.startups as usize {
                            let time = config.handshake.min(VERSION_TIMEOUT);
                            headers.spawn(read_header(socket, proxy, time));
                        } else {
                            let sentence = gate.refuse_early(Refusal::Startups, proxy.ip());
                            tell(&mut tasks, socket, sentence);
                        }
                    }
                    Err(error) => {
                        logging::fault("accept", error);
                        sleep(ACCEPT_RETRY_INTERVAL).await;
                    }
                },
            }
        }
        drop((listener, headers));
        let drain = config.get().drain;
        logging::draining(drain.as_secs());
        let until_end = drain + FAREWELL_TIMEOUT.min(drain);
        for (next, time) in
            [(ShutdownPhase::Draining, until_end), (ShutdownPhase::Closing, CLOSE_TIMEOUT)]
        {
            gate.enter(next);
            let all = async { while tasks.join_next().await.is_some() {} };
            if timeout(time, all).await.is_ok() {
                break;
            }
        }
        tasks.shutdown().await;
        gate.end_second();
    }
}

/// A connection from a proxy whose header was read: the socket, the proxy, and the visitor's address.
type ProxiedConnection = (TcpStream, SocketAddr, Result<SocketAddr, Outcome>);

/// Reads the header of a connection from `proxy`.
async fn read_header(
    mut socket: TcpStream,
    proxy: SocketAddr,
    time: Duration,
) -> ProxiedConnection {
    let visitor = match timeout(time, proxy_header::read(&mut socket)).await {
        Ok(Ok(visitor)) => Ok(visitor.unwrap_or(proxy)),
        Ok(Err(error)) if error.kind() == io::ErrorKind::InvalidData => Err(Outcome::BrokeProtocol),
        Ok(Err(_)) => Err(Outcome::LeftEarly),
        Err(_) => Err(Outcome::TimedOut),
    };
    (socket, proxy, visitor)
}

/// Closes a refused connection, after the sentence for its client if there is one.
fn tell(tasks: &mut JoinSet<()>, socket: TcpStream, sentence: Option<String>) {
    if let Some(sentence) = sentence {
        tasks.spawn(explain(socket, sentence));
    }
}
