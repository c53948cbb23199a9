//! Sending messages to a browser.
//!
//! A browser that does not read holds the messages of one [`Source::next`], because the next ones are made when these
//! have left. Nothing that a browser sends has an effect, except that it ends the connection.

use std::time::Duration;

use futures_util::{SinkExt, StreamExt};
use tokio::io::{AsyncRead, AsyncWrite};
use tokio::time::{Instant, MissedTickBehavior, interval_at, timeout};
use tokio_websockets::{CloseCode, Error, Message, WebSocketStream};

use crate::bucket::Bucket;
use crate::metrics::Metrics;

/// The interval between two pings.
const PING_INTERVAL: Duration = Duration::from_secs(30);
/// The time that a browser may take to accept a message.
pub(crate) const SEND_TIMEOUT: Duration = Duration::from_secs(30);
/// The control frames that a browser may send in a second, and at once.
const CONTROLS: [f64; 2] = [1.0, 10.0];
/// Told to a browser that sends data.
const NO_DATA: &str = "This socket only shows a room.";

/// A source of messages for a browser.
pub(crate) trait Source {
    /// Waits for the next messages. A caller that stops waiting loses nothing.
    ///
    /// # Errors
    /// The reason for the end, as a sentence.
    async fn next(&mut self) -> Result<Vec<Message>, String>;
}

/// Sends messages to a browser until the source ends, or the browser leaves, sends data or does not read.
pub(crate) async fn watch<S: AsyncRead + AsyncWrite + Unpin>(
    mut socket: WebSocketStream<S>,
    source: &mut impl Source,
    metrics: &Metrics,
) {
    metrics.web_watchers.inc();
    let _counted = Counted(metrics);
    if let Some((code, reason)) = send_all(&mut socket, source, metrics).await {
        let goodbye = Message::close(Some(code), &reason);
        _ = timeout(SEND_TIMEOUT, socket.send(goodbye)).await;
    }
}

struct Counted<'a>(&'a Metrics);

impl Drop for Counted<'_> {
    fn drop(&mut self) {
        self.0.web_watchers.dec();
    }
}

/// Sends messages. Returns the code and the reason to tell the browser, unless it has gone.
async fn send_all<S: AsyncRead + AsyncWrite + Unpin>(
    socket: &mut WebSocketStream<S>,
    source: &mut impl Source,
    metrics: &Metrics,
) -> Option<(CloseCode, String)> {
    let begun = Instant::now();
    let [per_second, most] = CONTROLS;
    let mut controls = Bucket::new(per_second, most, Duration::ZERO);
    let mut pings = interval_at(begun + PING_INTERVAL, PING_INTERVAL);
    pings.set_missed_tick_behavior(MissedTickBehavior::Delay);
    let mut is_alive = true;
    let violation = |sentence: &str| Some((CloseCode::POLICY_VIOLATION, sentence.to_owned()));
    loop {
        tokio::select! {
            next = source.next() => match next {
                Ok(messages) => for message in messages {
                    if message.is_binary() {
                        metrics.web_bytes.inc_by(message.as_payload().len() as u64);
                    }
                    send(socket, message).await?;
                },
                Err(reason) => return Some((CloseCode::NORMAL_CLOSURE, reason)),
            },
            message = socket.next() => {
                let message = match message? {
                    Ok(message) => message,
                    Err(Error::Io(_)) => return None,
                    Err(_) => return violation(NO_DATA),
                };
                if !(message.is_ping() || message.is_pong() || message.is_close()) {
                    return violation(NO_DATA);
                }
                is_alive = true;
                if !controls.takes_one(begun.elapsed()) {
                    return violation("There are too many control frames.");
                }
            }
            _ = pings.tick() => {
                if !std::mem::take(&mut is_alive) {
                    return None;
                }
                send(socket, Message::ping("")).await?;
            }
        }
    }
}

/// Sends a message, and waits until the socket has taken it. Returns `None` if the browser has gone or does not read.
async fn send<S: AsyncRead + AsyncWrite + Unpin>(
    socket: &mut WebSocketStream<S>,
    message: Message,
) -> Option<()> {
    timeout(SEND_TIMEOUT, socket.send(message)).await.ok()?.ok()
}
